"""Float utilities, robust ray origins, and intersections with one shape."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _validate
from .shapes import Shape

PRECISIONS = ("float32", "float64")
OFFSETS = ("bounded", "epsilon", "scaled-epsilon", "whole-epsilon")
_FLOAT_OF: dict[np.dtype[Any], np.dtype[Any]] = {
    np.dtype(np.uint32): np.dtype(np.float32),
    np.dtype(np.uint64): np.dtype(np.float64),
}


def next_float_up(x: npt.ArrayLike) -> Any:
    """The next larger float (Physically Based Rendering 3.9.1).

    Scalars or arrays of any shape; float32 (and float16, as float32) gives float32, everything else float64. A scalar
    gives a scalar. Infinity stays, NaN stays; TypeError for other dtypes than floats and integers.
    """
    return _next("next_float_up", x, _core.next_float_up)


def next_float_down(x: npt.ArrayLike) -> Any:
    """The next smaller float; see `next_float_up`."""
    return _next("next_float_down", x, _core.next_float_down)


def _next(who: str, x: npt.ArrayLike, function: Callable[[npt.NDArray[Any]], npt.NDArray[Any]]) -> Any:
    given = _validate.numeric(who, "x", x, "a number or an array of numbers")
    kind = np.float32 if given.dtype in (np.float16, np.float32) else np.float64
    result = function(np.array(given, kind, order="C", ndmin=1)).reshape(given.shape)
    return float(result) if type(x) in (int, float) else result[()]


def epsilon(x: npt.ArrayLike, scale: float) -> Any:
    """A scaled epsilon, |x| 2^-23 `scale` in float32: Epsilon(x, scale) of Greiner's EpsilonProgramming (2010).

    `x`: finite numbers of any shape, and `scale`: a number > 1; both are rounded to float32. Returns float32 of the
    shape of `x`, in its units; infinite where the product is beyond float32.

    In float32 x + epsilon > x and x - epsilon < x, whatever normal number x is. This fails for 0, whose epsilon is 0,
    and for subnormal x with |x| scale <= 2^-127, whose epsilon is rounded to 0: what lies at a coordinate of 0 is not
    moved. Scales in (1/2, 1] would do for |x| >= 2^-102; at 1/2 the powers of two stay, below 1/2 more numbers do, and
    below 1/4 the negative powers of two, too. Nothing is promised of the error of x, which may be any number of
    epsilons: `spawn_origin` is the way to leave a surface.

    Raises ValueError for `scale` <= 1 and for NaN and infinities, TypeError for what is no number.
    """
    given = _validate.numeric("epsilon", "x", x, "a number or an array of numbers")
    numbers = _validate._round("epsilon", "x", given, copy=False)
    factor = _validate.number("epsilon", "scale", scale)
    if factor <= 1:
        raise ValueError(f"epsilon: scale must be > 1, got {_validate.describe(scale)}")
    return _core.epsilon(np.atleast_1d(numbers), factor).reshape(given.shape)[()]


def float_bits(x: npt.ArrayLike) -> Any:
    """The bits of floats as unsigned integers (FloatToBits, Physically Based Rendering 3.9.1).

    Scalars or arrays of any shape: float32 (and float16, as float32) gives uint32, everything else, as float64, uint64.
    NaNs keep their bits. TypeError for other dtypes than floats and integers.
    """
    given = _validate.numeric("float_bits", "x", x, "a number or an array of numbers")
    kind = np.float32 if given.dtype in (np.float16, np.float32) else np.float64
    return _core.float_bits(np.array(given, kind, order="C", ndmin=1)).reshape(given.shape)[()]


def float_from_bits(bits: npt.ArrayLike, dtype: npt.DTypeLike | None = None) -> Any:
    """The floats that have these bits (BitsToFloat, Physically Based Rendering 3.9.1); `float_bits` undoes it.

    `bits`: integers >= 0 of any shape. `dtype`: float32 or float64, of the result; None takes float32 for uint32 and
    float64 for uint64. ValueError for integers that do not fit in 32 or 64 bits, TypeError for other dtypes than
    integers, or if `dtype` is needed.
    """
    given = _validate.numeric("float_from_bits", "bits", bits, "an integer or an array of integers")
    if given.dtype.kind not in "iu":
        raise TypeError(f"float_from_bits: bits must be an integer or an array of integers, got dtype {given.dtype}")
    kind = _FLOAT_OF.get(given.dtype) if dtype is None else np.dtype(dtype)
    if kind is None or kind not in _FLOAT_OF.values():
        raise TypeError(
            "float_from_bits: dtype must be float32 or float64 (or None, for bits of dtype uint32 or uint64), got "
            f"{dtype} for bits of dtype {given.dtype}"
        )
    word = np.dtype(f"uint{8 * kind.itemsize}")
    good = (given >= 0) & (given <= np.iinfo(word).max)
    if not good.all():
        raise ValueError(f"float_from_bits: bits must fit in {word}, got {_validate._culprit(given, good)}")
    words = np.array(given, word, order="C", ndmin=1)
    return _core.float_from_bits(words, kind == np.float64).reshape(given.shape)[()]


def gamma(n: npt.ArrayLike, dtype: npt.DTypeLike = np.float32) -> Any:
    """The bound of `n` roundings, gamma_n = n u / (1 - n u) (Physically Based Rendering 3.9.1), rounded up.

    `dtype`: float32 (u = 2^-24) or float64 (u = 2^-53); of the result as well. `n`: an integer >= 0 or an array of
    them, below 2^24 for float32 and below 2^31 for float64; ValueError otherwise.
    """
    kind = np.dtype(dtype)
    if kind not in (np.float32, np.float64):
        raise TypeError(f"gamma: dtype must be float32 or float64, got {kind}")
    given = _validate.numeric("gamma", "n", n, "an integer or an array of integers")
    if given.dtype.kind not in "iu":
        raise TypeError(f"gamma: n must be an integer or an array of integers, got dtype {given.dtype}")
    highest = 2**24 - 1 if kind == np.float32 else 2**31 - 1  # n u < 1
    counts = [_validate.integer("gamma", "n", item, lowest=0, highest=highest) for item in given.flat]
    return np.array([_core.gamma(count, kind == np.float64) for count in counts], kind).reshape(given.shape)[()]


def spawn_origin(p: npt.ArrayLike, p_error: npt.ArrayLike, n: npt.ArrayLike, w: npt.ArrayLike) -> _validate.FloatArray:
    """Origins of rays that leave a surface without meeting it again (Physically Based Rendering 3.9.5).

    `p`: hit points; `p_error`: bounds of their absolute errors, >= 0; `n`: normals; `w`: directions of the rays. Each
    is (3,) or (m, 3), all of one shape. Returns the origins in that shape, float32, scene units.
    """
    given = {"p": p, "p_error": p_error, "n": n, "w": w}
    single = np.ndim(_validate.numeric("spawn_origin", "p", p, "an array of numbers")) == 1
    shape = (3,) if single else (None, 3)
    arrays = {name: _validate.array("spawn_origin", name, value, shape=shape) for name, value in given.items()}
    for name, values in arrays.items():
        if values.shape != arrays["p"].shape:
            raise ValueError(f"spawn_origin: {name} must have the shape of p, {arrays['p'].shape}, got {values.shape}")
    if (arrays["p_error"] < 0).any():
        raise ValueError(f"spawn_origin: p_error must be >= 0, got {arrays['p_error'].min()}")
    points, errors, normals, ways = (np.atleast_2d(values) for values in arrays.values())
    result = _core.spawn_origin(points, errors, normals, ways)
    return result[0] if single else result


def intersect(
    shape: Shape,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike,
    *,
    precision: str = "float32",
    offsets: str = "bounded",
) -> npt.NDArray[np.void]:
    """Intersects rays with one shape.

    Parameters
    ----------
    shape : Shape
    origins, directions : (n, 3) array_like
        Scene units, rounded to float32; directions of length 2**-64 or more.
    precision : {"float32", "float64"}
        In which the intersection is computed.
    offsets : {"bounded", "epsilon", "scaled-epsilon", "whole-epsilon"}
        How `next_origin` leaves the surface: by the error bound of the hit point, or by the epsilons that it is
        measured against. These are 1e-5 along the normal; the normal times `epsilon(p, 10)`, coordinate by coordinate;
        and `epsilon(p, 10)` itself, with the sign of the normal's component.

    Returns a structured array (n,): hit, t, t_error, point, point_error, normal (outward), uv, face_id, next_origin
    (the origin of a ray spawned along the normal). t +- t_error holds where the ray exactly meets the surface; the box
    point +- point_error holds a point of the surface, not always the one where the ray meets it.
    """
    checked = _validate.instance("intersect", "shape", shape, Shape, "a Shape")
    rays = _validate.rays("intersect", origins, directions)
    if rays.origins.dtype.names:
        raise ValueError("intersect: origins must be points, got records of hits (Scene.intersect takes them)")
    _validate.choice("intersect", "precision", precision, PRECISIONS)
    _validate.choice("intersect", "offsets", offsets, OFFSETS)
    points = np.asarray(rays.origins, np.float32)
    return _core.intersect_shape(checked._native, points, rays.ends, precision, offsets).reshape(rays.shape)
