"""Intervals of real numbers with outward rounding."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from .. import _core
from .base import Number, broadcast, is_weak, operate, plain

KIND = {np.dtype(np.float32): "interval_float32", np.dtype(np.float64): "interval_float64"}


class _Constant:
    """A class attribute that is made when it is first asked for."""

    def __init__(self, inf: float, sup: float) -> None:
        self._ends = (inf, sup)

    def __get__(self, instance: object, owner: type[Interval]) -> Interval:
        return owner._made(KIND[np.dtype(np.float64)], np.array(self._ends))


class Interval(Number):
    """All real numbers from `lo` to `hi`: the set-based intervals of IEEE 1788-2015, or an array of them.

    `lo`, `hi`: numbers or arrays that broadcast; `hi=None` gives points. float32 ends stay float32, all others are
    float64; a Python number takes the precision of the interval that it meets. Ends may be infinite (the interval is
    unbounded), `Interval.empty` has no members, `Interval.entire` all. ValueError for NaN and where lo > hi.

    The results of + - * / and of `square sqrt reciprocal fma abs minimum maximum power` are the tightest of that
    precision; those of `exp log sin cos tan asin acos atan` at most 1 ulp wider at each end; `rsqrt` and `ward_lobe` a
    few. A function sees the part of its argument where it is defined: the root of [-1, 4] is [0, 2], that of [-2, -1]
    is empty. `i & j` is the intersection, `i | j` the hull (the least interval that holds both).
    """

    __slots__ = ()

    empty: ClassVar[_Constant] = _Constant(np.inf, -np.inf)
    entire: ClassVar[_Constant] = _Constant(-np.inf, np.inf)

    def __init__(self, lo: npt.ArrayLike, hi: npt.ArrayLike | None = None) -> None:
        low = plain("Interval", "lo", lo, finite=False)
        high = low if hi is None else plain("Interval", "hi", hi, finite=False)
        dtype = np.result_type(
            *[a.dtype for a, given in ((low, lo), (high, hi)) if not is_weak(given)] or [np.dtype(np.float64)]
        )
        with np.errstate(over="ignore", under="ignore"):
            if dtype == np.float32 and any(not np.array_equal(a, a.astype(dtype)) for a in (low, high)):
                dtype = np.dtype(np.float64)
        low, high = broadcast("Interval", lo=low, hi=high)
        good = (low <= high) & (low < np.inf) & (high > -np.inf)
        if not good.all():
            at = tuple(np.argwhere(~good)[0])
            where = f" at index {', '.join(map(str, at))}" if at else ""
            raise ValueError(f"Interval: lo must be <= hi, got {low[at]:.17g} > {high[at]:.17g}{where}")
        records = np.stack([low, high], axis=-1).astype(dtype)
        records.flags.writeable = False
        self._kind = KIND[np.dtype(dtype)]
        self._records = records

    def _lift(self, value: object, who: str, name: str) -> Number:
        if isinstance(value, Interval):
            if value._kind == self._kind:
                return value
            wide = KIND[np.dtype(np.float64)]
            return Interval._made(wide, value._records.astype(np.float64))
        array = plain(who, name, value)
        if self._records.dtype == np.float32 and (is_weak(value) or array.dtype == np.float32):
            points = _core.interval_points(np.ascontiguousarray(array, np.float64)).reshape(*array.shape, 2)
            return Interval._made(self._kind, points)
        return Interval(np.asarray(array, np.float64))

    @property
    def inf(self) -> Any:
        """The lower end; +infinity if empty."""
        return self._records[..., 0][()]

    @property
    def sup(self) -> Any:
        """The upper end; -infinity if empty."""
        return self._records[..., 1][()]

    def _property(self, index: int) -> Any:
        values = _core.interval_properties(np.ascontiguousarray(self._records))
        return values.reshape(*self.shape, 5)[..., index].copy()[()]

    @property
    def mid(self) -> Any:
        """The midpoint, finite, rounded to nearest; NaN if empty."""
        return self._property(0)

    @property
    def rad(self) -> Any:
        """The radius about `mid`, rounded up; NaN if empty."""
        return self._property(1)

    @property
    def wid(self) -> Any:
        """The width sup - inf, rounded up; NaN if empty."""
        return self._property(2)

    @property
    def mag(self) -> Any:
        """The magnitude, the largest |x| of the members; NaN if empty."""
        return self._property(3)

    @property
    def mig(self) -> Any:
        """The mignitude, the least |x| of the members; NaN if empty."""
        return self._property(4)

    @property
    def is_empty(self) -> Any:
        """Whether there are no members."""
        return (self._records[..., 0] > self._records[..., 1])[()]

    def contains(self, x: npt.ArrayLike) -> Any:
        """Whether `x` lies in the interval, element by element: a number or an array that broadcasts."""
        given = plain("Interval", "x", x, finite=False)
        return ((self._records[..., 0] <= given) & (given <= self._records[..., 1]) & np.isfinite(given))[()]

    def __contains__(self, x: object) -> bool:
        """Whether every element of `x` lies in its interval; an Interval lies in it if it is a subset."""
        if isinstance(x, Interval):
            within = (self._records[..., 0] <= x._records[..., 0]) & (x._records[..., 1] <= self._records[..., 1])
            return bool(np.all(within | x.is_empty))
        return bool(np.all(self.contains(x)))  # type: ignore[arg-type]

    def __and__(self, other: object) -> Interval:
        """The intersection."""
        if not isinstance(other, Interval):
            return NotImplemented
        result: Interval = operate("intersection", self, other)
        return result

    def __or__(self, other: object) -> Interval:
        """The hull."""
        if not isinstance(other, Interval):
            return NotImplemented
        result: Interval = operate("hull", self, other)
        return result

    def __repr__(self) -> str:
        name = type(self).__name__
        if self.ndim:
            return f"<{name} array of shape {self.shape}, {self._records.dtype}>"
        if self.is_empty:
            return f"{name}.empty"
        if self._records.dtype == np.float32:
            return f"{name}(np.float32({self.inf}), np.float32({self.sup}))"
        return f"{name}({float(self.inf)!r}, {float(self.sup)!r})"
