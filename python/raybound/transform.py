"""Affine transforms."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _core, _validate
from ._validate import DoubleArray
from ._value import Value


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

    def _rounded(self) -> Transform:
        """The transform as shapes and scenes keep it: entries rounded to float32."""
        return Transform._of(_core.transform_round(self._matrix))

    def __repr__(self) -> str:
        return "Transform()" if np.array_equal(self._matrix, np.eye(4)) else super().__repr__()


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
