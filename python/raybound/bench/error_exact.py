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
    """a + b as rounded, and its rounding error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def _split(a: Doubles) -> tuple[Doubles, Doubles]:
    """Two halves of 26 bits."""
    spread = SPLITTER * a
    high = spread - (spread - a)
    return high, a - high


def _two_product(a: Doubles, b: Doubles) -> tuple[Doubles, Doubles]:
    """a b as rounded, and its rounding error."""
    product = a * b
    (a1, a2), (b1, b2) = _split(a), _split(b)
    return product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2


class TwoDoubles:
    """An array of unevaluated sums high + low, |low| at most half an ulp of high."""

    __array_ufunc__ = None  # so that NumPy leaves array + TwoDoubles to this class

    def __init__(self, high: Any, low: Any = 0.0) -> None:
        self.high, self.low = _two_sum(np.asarray(high, np.float64), np.asarray(low, np.float64))

    def __add__(self, other: Number) -> TwoDoubles:
        b = of(other)
        (high, low), (below, last) = _two_sum(self.high, b.high), _two_sum(self.low, b.low)
        high, low = _two_sum(high, low + below)
        return TwoDoubles(high, low + last)

    def __neg__(self) -> TwoDoubles:
        return TwoDoubles(-self.high, -self.low)

    def __sub__(self, other: Number) -> TwoDoubles:
        return self + -of(other)

    def __mul__(self, other: Number) -> TwoDoubles:
        b = of(other)
        high, low = _two_product(self.high, b.high)
        return TwoDoubles(high, low + (self.high * b.low + self.low * b.high))

    def __truediv__(self, other: Number) -> TwoDoubles:
        b = of(other)
        first = self.high / b.high
        rest = self - b * first
        second = rest.high / b.high
        rest = rest - b * second
        return TwoDoubles(first, second) + rest.high / b.high

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Number) -> TwoDoubles:
        return of(other) - self

    def __getitem__(self, index: Any) -> TwoDoubles:
        return TwoDoubles(np.asarray(self.high)[index], np.asarray(self.low)[index])

    def sqrt(self) -> TwoDoubles:
        """The square root; 0 where the value is <= 0."""
        root = np.sqrt(np.maximum(self.high, 0.0))
        rest = self - TwoDoubles(root) * root
        return TwoDoubles(root, np.where(root > 0, rest.high / np.where(root > 0, 2 * root, 1.0), 0.0))

    def value(self) -> Doubles:
        """Rounded to float64."""
        return np.asarray(self.high + self.low)


def of(x: Number) -> TwoDoubles:
    """A number or array, exactly."""
    return x if isinstance(x, TwoDoubles) else TwoDoubles(x)


def where(condition: npt.NDArray[np.bool_], a: TwoDoubles, b: TwoDoubles) -> TwoDoubles:
    """As np.where."""
    return TwoDoubles(np.where(condition, a.high, b.high), np.where(condition, a.low, b.low))
