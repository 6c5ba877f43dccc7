"""Affine transforms."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _validate
from ._validate import DoubleArray
from ._value import Value

PRECISIONS = ("float32", "float64")


class Transform(Value):
    """An affine transform of points, `p -> matrix @ (p, 1)`. An immutable value.

    Parameters
    ----------
    matrix : (4, 4) array_like, any float or integer dtype
        The last row is (0, 0, 0, 1). Default: the identity. Kept in float64; a shape or a scene that takes a transform
        rounds its entries to float32 once, and reading it back there gives the rounded transform.

    Raises
    ------
    ValueError
        If the shape is wrong, an entry is not finite, the last row is not (0, 0, 0, 1), or the matrix is singular.
    TypeError
        If the dtype is not a float or integer one.
    """

    _is_double = True
    _matrix: DoubleArray

    def __init__(self, matrix: npt.ArrayLike | None = None) -> None:
        self._adopt(np.eye(4) if matrix is None else _matrix("Transform", matrix), "Transform")

    def _adopt(self, matrix: DoubleArray, who: str) -> None:
        _core.transform_check(who, matrix)
        matrix.flags.writeable = False
        self._set(_matrix=matrix)

    @classmethod
    def _of(cls, matrix: DoubleArray, who: str = "Transform") -> Transform:
        """From a checked float64 matrix that nobody else writes to."""
        result = object.__new__(cls)
        result._adopt(np.array(matrix, np.float64, order="C"), who)
        return result

    @property
    def matrix(self) -> DoubleArray:
        """The matrix: (4, 4) float64, read-only."""
        return self._matrix

    @classmethod
    def translate(cls, x: float, y: float, z: float) -> Transform:
        """Moves by (x, y, z), in scene units."""
        matrix = np.eye(4)
        matrix[:3, 3] = [_validate.double("Transform.translate", n, v) for n, v in zip("xyz", (x, y, z), strict=True)]
        return cls._of(matrix, "Transform.translate")

    @classmethod
    def rotate(cls, degrees: float, axis: npt.ArrayLike = (0.0, 0.0, 1.0)) -> Transform:
        """Turns by `degrees` about an axis through the origin, counter-clockwise as seen from its tip.

        `axis`: 3 numbers, non-zero, of any length.
        """
        angle = _validate.double("Transform.rotate", "degrees", degrees)
        _validate.direction("Transform.rotate", "axis", axis)
        about = np.array(axis, np.float64, order="C")
        return cls._of(_core.transform_rotate(angle, about), "Transform.rotate")

    @classmethod
    def scale(cls, s: npt.ArrayLike) -> Transform:
        """Scales by `s`, a number or three (x, y, z), about the origin. Zero is singular: ValueError."""
        expected = "a number or three numbers, none of them 0"
        factors = _validate.numeric("Transform.scale", "s", s, expected)
        factors = _doubles("Transform.scale", "s", s, (3,) if factors.ndim else ())
        if not factors.all():
            raise ValueError(f"Transform.scale: s must be {expected}, got {_validate.describe(s)}")
        return cls._of(np.diag(np.append(np.broadcast_to(factors, 3), 1.0)), "Transform.scale")

    def __matmul__(self, other: object) -> Transform:
        """`(a @ b)` applies `b` first, then `a`."""
        if not isinstance(other, Transform):
            return NotImplemented
        return Transform._of(_core.transform_multiply(self._matrix, other._matrix))

    def inverse(self) -> Transform:
        """The inverse transform."""
        return Transform._of(_core.transform_inverse(self._matrix))

    def points(
        self, p: npt.ArrayLike, error: npt.ArrayLike = 0.0, *, precision: str = "float32"
    ) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
        """Points transformed, with bounds of the rounding error (Physically Based Rendering 3.9.4, eq. 3.15, 3.16).

        Parameters
        ----------
        p : (..., 3) array_like
            Scene units, rounded to `precision`.
        error : array_like
            Bounds >= 0 of the absolute errors of `p`, which broadcast to its shape. Rounded up.
        precision : {"float32", "float64"}
            In which all is computed. The matrix's entries are rounded to it first, and count as exact from there.

        Returns
        -------
        The points and the bounds of their absolute errors, both of the shape of `p` and of dtype `precision`: each
        component is within its bound of the exact image of any point that is within `error` of `p`. The bound is
        (gamma_3 + 1) |M| error + gamma_3 (|M| |p| + |translation|), rounded up, and two subnormals; infinite where the
        image overflows. The identity keeps points and errors as they are.

        Raises
        ------
        ValueError
            If a shape is wrong, a number is not finite or does not fit, or an error is negative.
        TypeError
            If a dtype is not a float or integer one.
        """
        return self._images("Transform.points", "p", p, error, precision, vectors=False)

    def vectors(
        self, v: npt.ArrayLike, error: npt.ArrayLike = 0.0, *, precision: str = "float32"
    ) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
        """Vectors transformed, with bounds of the rounding error: as `points`, but without the translation."""
        return self._images("Transform.vectors", "v", v, error, precision, vectors=True)

    def rays(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        origin_error: npt.ArrayLike = 0.0,
        direction_error: npt.ArrayLike = 0.0,
        *,
        t_max: npt.ArrayLike = np.inf,
        precision: str = "float32",
    ) -> npt.NDArray[np.void]:
        """Rays transformed, their origins moved out of their error boxes (Physically Based Rendering 3.9.4, 3.9.5).

        Parameters
        ----------
        origins, directions : (n, 3) array_like
            Scene units, rounded to `precision`; directions are of any length but zero.
        origin_error, direction_error : array_like
            Bounds >= 0 of their absolute errors, which broadcast to (n, 3).
        t_max : array_like
            Where the rays end, >= 0, in units of the directions' lengths; broadcasts to (n,).
        precision : {"float32", "float64"}
            As for `points`.

        Returns
        -------
        A structured array (n,) of dtype `precision`: origin, direction, origin_error, direction_error (3 each), moved,
        t_max. The image's origin is moved by `moved` along its direction, to the front of its error box, and `t_max`
        comes nearer by as much, rounded down (below 0, nothing of the ray is left). With o + t d the exact image of any
        ray within the given errors, `origin` is within `origin_error` of o + moved d, and `direction` within
        `direction_error` of d. Where the error is infinite nothing is moved.

        Raises ValueError and TypeError as `points`, and ValueError for a zero direction.
        """
        who = "Transform.rays"
        matrix, kind = self._in_precision(who, precision)
        starts = _numbers(who, "origins", origins, kind, rows=True)
        ways = _numbers(who, "directions", directions, kind, rows=True)
        if len(starts) != len(ways):
            raise ValueError(f"{who}: origins and directions must have one length, got {len(starts)} and {len(ways)}")
        zero = np.flatnonzero(~ways.any(axis=1))
        if zero.size:
            raise ValueError(f"{who}: directions must be non-zero, got (0.0, 0.0, 0.0) at index {zero[0]}")
        errors = [
            _bounds(who, name, value, starts.shape)
            for name, value in (("origin_error", origin_error), ("direction_error", direction_error))
        ]
        ends = _bounds(who, "t_max", t_max, (len(starts),), finite=False)
        columns = _core.transform_rays(matrix, [starts, ways, *errors], ends, kind == np.float64)
        names = ("origin", "direction", "origin_error", "direction_error", "moved", "t_max")
        fields = [(name, kind, column.shape[1:]) for name, column in zip(names, columns, strict=True)]
        result = np.empty(len(starts), fields)
        for name, column in zip(names, columns, strict=True):
            result[name] = column
        return result

    def _images(
        self, who: str, name: str, value: object, error: object, precision: str, *, vectors: bool
    ) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
        matrix, kind = self._in_precision(who, precision)
        values = _numbers(who, name, value, kind, rows=False)
        errors = _bounds(who, "error", error, values.shape)
        given = values.reshape(-1, 3), errors.reshape(-1, 3)
        images, bounds = _core.transform_points(matrix, vectors, given[0], given[1], kind == np.float64)
        return images.reshape(values.shape), bounds.reshape(values.shape)

    def _in_precision(self, who: str, precision: str) -> tuple[DoubleArray, np.dtype[Any]]:
        """The matrix with its entries rounded to a precision, and its dtype."""
        kind = np.dtype(_validate.choice(who, "precision", precision, PRECISIONS))
        return (self._rounded() if kind == np.float32 else self)._matrix, kind

    def _rounded(self) -> Transform:
        """The transform as shapes and scenes keep it: entries rounded to float32."""
        return Transform._of(_core.transform_round(self._matrix))

    def __repr__(self) -> str:
        return "Transform()" if np.array_equal(self._matrix, np.eye(4)) else super().__repr__()


def _numbers(who: str, name: str, value: object, kind: np.dtype[Any], *, rows: bool) -> DoubleArray:
    """Finite numbers rounded to a dtype, in float64: an array (n, 3) if `rows`, else (..., 3)."""
    given = _validate.numeric(who, name, value, "an array of numbers")
    expected = "(n, 3)" if rows else "(..., 3)"
    if given.shape[-1:] != (3,) or (rows and given.ndim != 2):
        raise ValueError(f"{who}: {name} must be an array of numbers with shape {expected}, got shape {given.shape}")
    with np.errstate(over="ignore", under="ignore"):
        rounded = given.astype(kind)
    good = np.isfinite(rounded)
    if not good.all():
        raise ValueError(f"{who}: {name} must be finite and fit in {kind}, got {_validate._culprit(given, good)}")
    return np.array(rounded, np.float64, order="C")


def _bounds(who: str, name: str, value: object, shape: tuple[int, ...], *, finite: bool = True) -> DoubleArray:
    """Numbers >= 0 in float64, broadcast to a shape."""
    given = _validate.numeric(who, name, value, "a number or an array of numbers")
    good = (given >= 0) & (np.isfinite(given) if finite else True)
    if not good.all():
        expected = ">= 0 and finite" if finite else ">= 0"
        raise ValueError(f"{who}: {name} must be {expected}, got {_validate._culprit(given, good)}")
    try:
        return np.array(np.broadcast_to(given, shape), np.float64, order="C")
    except ValueError:
        raise ValueError(f"{who}: {name} must broadcast to shape {shape}, got shape {given.shape}") from None


def _doubles(who: str, name: str, value: object, shape: tuple[int, ...]) -> DoubleArray:
    """Finite numbers of that shape, in float64."""
    _validate.array(who, name, value, shape=shape)  # type, shape, finiteness, range
    return np.array(value, np.float64, order="C")


def _matrix(who: str, value: object) -> DoubleArray:
    matrix = _doubles(who, "matrix", value, (4, 4))
    if matrix[3].tolist() != [0, 0, 0, 1]:
        raise ValueError(f"{who}: matrix must have the last row (0, 0, 0, 1), got {tuple(matrix[3].tolist())}")
    return matrix


def rounded(who: str, name: str, value: object) -> Transform:
    """The transform given as an argument (None: identity), rounded to float32."""
    if value is None:
        return Transform()
    return _validate.instance(who, name, value, Transform)._rounded()
