"""The functions of all numbers: floats, arrays, and the types that carry their error.

On floats and arrays they are the operations that the kernels of light and geometry consist of: float32 stays float32
(`exp`, `acos` and `ward_lobe` within 0.51 ulp, the same bits on every machine), everything else is float64. On an
`Interval`, `RunningError`, `LinearInterval` or `TaylorModel` they enclose. Arrays broadcast. What is not defined (the
root of a negative number) is a ValueError for floats, and never a silent NaN for the others: an Interval loses the part
of itself that has no result, the other types become unbounded.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _validate
from .base import Number, apply, broadcast, is_weak, narrowed, operate, plain


def _evaluate(name: str, operands: dict[str, object], parameter: float = 0.0) -> Any:
    if any(isinstance(value, Number) for value in operands.values()):
        return operate(name, *operands.values(), parameter=parameter)
    arrays = {key: plain(name, key, value, rounded=True) for key, value in operands.items()}
    strong = [array.dtype for key, array in arrays.items() if not is_weak(operands[key])]
    dtype = np.result_type(*strong) if strong else np.dtype(np.float64)
    broadcast(name, **arrays)
    records = [narrowed(name, key, array, dtype)[..., np.newaxis] for key, array in arrays.items()]
    result = apply(str(dtype), name, records, parameter)[..., 0]
    if np.isnan(result).any():
        at = tuple(np.argwhere(np.isnan(result))[0])
        where = f" at index {', '.join(map(str, at))}" if at else ""
        given = ", ".join(f"{key} = {np.broadcast_to(array, result.shape)[at]:.9g}" for key, array in arrays.items())
        raise ValueError(f"{name}: not defined for {given}{where}")
    return result[()]


def sqrt(x: Any) -> Any:
    """The square root."""
    return _evaluate("sqrt", {"x": x})


def rsqrt(x: Any) -> Any:
    """1 / sqrt(x), as the kernels compute it: a root and a division."""
    return _evaluate("rsqrt", {"x": x})


def square(x: Any) -> Any:
    """The square, x * x with both the same: that of [-1, 1] is [0, 1]."""
    return _evaluate("square", {"x": x})


def reciprocal(x: Any) -> Any:
    """1 / x."""
    return _evaluate("reciprocal", {"x": x})


def exp(x: Any) -> Any:
    """The exponential, e to the power of x."""
    return _evaluate("exp", {"x": x})


def log(x: Any) -> Any:
    """The natural logarithm."""
    return _evaluate("log", {"x": x})


def sin(x: Any) -> Any:
    """The sine of x, in radians."""
    return _evaluate("sin", {"x": x})


def cos(x: Any) -> Any:
    """The cosine of x, in radians."""
    return _evaluate("cos", {"x": x})


def tan(x: Any) -> Any:
    """The tangent of x, in radians."""
    return _evaluate("tan", {"x": x})


def asin(x: Any) -> Any:
    """The angle in [-pi/2, pi/2] whose sine is x."""
    return _evaluate("asin", {"x": x})


def acos(x: Any) -> Any:
    """The angle in [0, pi] whose cosine is x."""
    return _evaluate("acos", {"x": x})


def atan(x: Any) -> Any:
    """The angle in (-pi/2, pi/2) whose tangent is x."""
    return _evaluate("atan", {"x": x})


def abs(x: Any) -> Any:
    """The absolute value."""
    return _evaluate("abs", {"x": x})


def minimum(a: Any, b: Any) -> Any:
    """The smaller of two numbers."""
    return _evaluate("minimum", {"a": a, "b": b})


def maximum(a: Any, b: Any) -> Any:
    """The larger of two numbers."""
    return _evaluate("maximum", {"a": a, "b": b})


def power(x: Any, n: int) -> Any:
    """The power of x to an integer -2^20 <= n <= 2^20; x^0 is 1. Floats by repeated squaring: at most |n| roundings.

    A negative power is the reciprocal of the positive one, and so 0 where that overflows.
    """
    exponent = _validate.integer("power", "n", n, lowest=-(2**20), highest=2**20)
    return _evaluate("power", {"x": x}, exponent)


def fma(a: Any, b: Any, c: Any) -> Any:
    """The sum a * b + c; of floats and Intervals with one rounding."""
    return _evaluate("fma", {"a": a, "b": b, "c": c})


def ward_lobe(cosine: Any, sigma: float) -> Any:
    """Ward's lobe exp((1 - 1/cosine^2) / sigma^2) of the angle between normal and half vector (thesis 4.3.7).

    As one operator: nothing cancels where the lobe is bright, and its derivatives are bounded as a whole. An even
    function of `cosine`, 0 at 0. `sigma`: the roughness, > 0, rounded to float32 as that of a Material is.
    """
    return _evaluate("ward_lobe", {"cosine": cosine}, _validate.positive("ward_lobe", "sigma", sigma))
