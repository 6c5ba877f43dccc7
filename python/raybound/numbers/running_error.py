"""Values with a running bound of their rounding error."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core, _validate
from .base import Number, apply, broadcast, is_weak, plain
from .interval import KIND as INTERVAL
from .interval import Interval

KIND = {np.dtype(np.float32): "running_error_float32", np.dtype(np.float64): "running_error_float64"}


class RunningError(Number):
    """What a computation in floating point gives, with a bound of its error: the EFloat of Physically Based Rendering
    3.9.1, or an array of them.

    `value`: numbers or an array; `error`: a bound >= 0 of their absolute errors, which broadcasts. float32 stays
    float32, all else is float64. Operations give the same `value` as plain floats do, bit for bit, and an enclosure
    [`lower`, `upper`] of the exact result, kept by outward rounding. Where the result may not be defined (the root of
    what may be negative) `error` is infinite. ValueError for NaN, infinities and negative errors.
    """

    __slots__ = ()

    def __init__(self, value: npt.ArrayLike, error: npt.ArrayLike = 0) -> None:
        values = plain("RunningError", "value", value)
        errors = plain("RunningError", "error", error)
        if (errors < 0).any():
            raise ValueError(f"RunningError: error must be >= 0, got {_validate._culprit(errors, errors >= 0)}")
        dtype = np.dtype(np.float32) if values.dtype == np.float32 else np.dtype(np.float64)
        values, errors = broadcast("RunningError", value=values, error=errors)
        with np.errstate(over="ignore", under="ignore"):
            bounds = errors.astype(dtype)
            above = np.nextafter(bounds, dtype.type(np.inf))
        bounds = np.where(bounds < errors, above, bounds)  # never below what was given
        given = np.stack([values.astype(dtype), bounds, np.zeros_like(bounds)], axis=-1)
        records = apply(KIND[dtype], "with_error", [given])
        records.flags.writeable = False
        self._kind = KIND[dtype]
        self._records = records

    def _lift(self, value: object, who: str, name: str) -> Number:
        if isinstance(value, RunningError):
            if value._kind == self._kind:
                return value
            return RunningError._made(KIND[np.dtype(np.float64)], value._records.astype(np.float64))
        array = plain(who, name, value)
        if self._records.dtype == np.float32 and is_weak(value):  # rounded, between its neighbours
            with np.errstate(over="ignore", under="ignore"):
                rounded = array.astype(np.float32)
            ends = _core.interval_points(np.ascontiguousarray(array, np.float64)).reshape(2)
            return RunningError._made(self._kind, np.array([rounded, *ends], np.float32))
        return RunningError(array)

    @property
    def value(self) -> Any:
        """What floating-point arithmetic gives."""
        return self._records[..., 0][()]

    @property
    def lower(self) -> Any:
        """The lower end of the enclosure of the exact number."""
        return self._records[..., 1][()]

    @property
    def upper(self) -> Any:
        """The upper end of the enclosure of the exact number."""
        return self._records[..., 2][()]

    @property
    def error(self) -> Any:
        """A bound of |value - exact|, rounded up; infinite where the result may not be defined."""
        return apply(self._kind, "errors", [self._records])[..., 0].copy()[()]

    @property
    def relative_error(self) -> Any:
        """A bound of |value - exact| / |exact|, rounded up; infinite where the exact number may be 0."""
        return apply(self._kind, "errors", [self._records])[..., 1].copy()[()]

    @property
    def enclosure(self) -> Interval:
        """[lower, upper] as an Interval."""
        return Interval._made(INTERVAL[self._records.dtype], self._records[..., 1:].copy())

    def __repr__(self) -> str:
        if self.ndim:
            return f"<RunningError array of shape {self.shape}, {self._records.dtype}>"
        if self._records.dtype == np.float32:
            return f"RunningError(np.float32({self.value}), {float(self.error)!r})"
        return f"RunningError({float(self.value)!r}, {float(self.error)!r})"
