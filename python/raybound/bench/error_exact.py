"""Double-double arithmetic over arrays: about 106 bits, enough to measure the errors of float64 with.

Sums and products are error-free transformations (Knuth's TwoSum; Dekker's product, for want of a fused operation in
NumPy), renormalised: +, - and * have a relative error below 2^-100, / and sqrt below 2^-96 (of the operands' magnitude
for sums that cancel; tests/python/test_bench_error.py compares them with exact rationals: largest seen 2^-102). Values
between 2^-400 and 2^400, which the coordinates and sizes that shapes may have never leave here.
"""

from __future__ import annotations

from typing import Any, Union

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]
Number = Union["TwoDoubles", Doubles, float]
SPLITTER = 2.0**27 + 1


def _two_sum(a: Doubles, b: Doubles) -> tuple[Doubles, Doubles]:
    """The rounded a + b, and its rounding error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def _split(a: Doubles) -> tuple[Doubles, Doubles]:
    """Two halves of 26 bits."""
    spread = SPLITTER * a
    high = spread - (spread - a)
    return high, a - high


def _two_product(a: Doubles, b: Doubles) -> tuple[Doubles, Doubles]:
    """The rounded a b, and its rounding error."""
    product = a * b
    (a1, a2), (b1, b2) = _split(a), _split(b)
    return product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2


def _quick_two_sum(a: Doubles, b: Doubles) -> TwoDoubles:
    """The rounded a + b, and its rounding error, for |a| >= |b|."""
    total = a + b
    return _made(total, b - (total - a))


def _made(high: Doubles, low: Doubles) -> TwoDoubles:
    """A pair that is normalised already."""
    pair = object.__new__(TwoDoubles)
    pair.high, pair.low = high, low
    return pair


class TwoDoubles:
    """An array of unevaluated sums high + low, |low| at most half an ulp of high."""

    __array_ufunc__ = None  # so that NumPy leaves array + TwoDoubles to this class

    high: Doubles
    low: Doubles

    def __init__(self, high: Any, low: Any = 0.0) -> None:
        self.high, self.low = _two_sum(np.asarray(high, np.float64), np.asarray(low, np.float64))

    def __add__(self, other: Number) -> TwoDoubles:
        if not isinstance(other, TwoDoubles):
            high, low = _two_sum(self.high, np.asarray(other))
            return _quick_two_sum(high, low + self.low)
        (high, low), (below, last) = _two_sum(self.high, other.high), _two_sum(self.low, other.low)
        total = _quick_two_sum(high, low + below)
        return _quick_two_sum(total.high, total.low + last)

    def __neg__(self) -> TwoDoubles:
        return _made(-self.high, -self.low)

    def __sub__(self, other: Number) -> TwoDoubles:
        return self + -other

    def __mul__(self, other: Number) -> TwoDoubles:
        if not isinstance(other, TwoDoubles):
            high, low = _two_product(self.high, np.asarray(other))
            return _quick_two_sum(high, low + self.low * other)
        high, low = _two_product(self.high, other.high)
        return _quick_two_sum(high, low + (self.high * other.low + self.low * other.high))

    def __truediv__(self, other: Number) -> TwoDoubles:
        b = of(other)
        first = self.high / b.high
        rest = self - b * first
        second = rest.high / b.high
        rest = rest - b * second
        return _quick_two_sum(first, second) + rest.high / b.high

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Number) -> TwoDoubles:
        return -self + other

    def sqrt(self) -> TwoDoubles:
        """The square root; 0 where the value is <= 0."""
        root = np.sqrt(np.maximum(self.high, 0.0))
        rest = self - TwoDoubles(root) * root
        return _quick_two_sum(root, np.where(root > 0, rest.high / np.where(root > 0, 2 * root, 1.0), 0.0))

    def value(self) -> Doubles:
        """Rounded to float64."""
        return self.high


def of(x: Number) -> TwoDoubles:
    """A number or array, exactly."""
    return x if isinstance(x, TwoDoubles) else TwoDoubles(x)


def where(condition: npt.NDArray[np.bool_], a: TwoDoubles, b: TwoDoubles) -> TwoDoubles:
    """As np.where."""
    return _made(np.where(condition, a.high, b.high), np.where(condition, a.low, b.low))
