"""Values with a running bound of their rounding error."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core, _validate
from ..enums import Verdict
from .base import KINDS, Number, applied, apply, broadcast, is_weak, plain, together
from .interval import KIND as INTERVAL
from .interval import Interval

F32, F64 = np.dtype(np.float32), np.dtype(np.float64)
# By dtype and whether numbers keep their precise value. Where kinds meet, the last by name is taken (`base.operate`):
# the wider one, and the one that does not keep it.
KIND = {
    (dtype, precise): f"{'precise_' if precise else ''}running_error_{dtype}"
    for dtype in (F32, F64)
    for precise in (False, True)
}
MEANING = {kind: meaning for meaning, kind in KIND.items()}


class RunningError(Number):
    """What a computation in floating point gives, with a bound of its error: the EFloat of Physically Based Rendering
    3.9.1, or an array of them.

    `value`: numbers or an array; `error`: a bound >= 0 of their absolute errors, which broadcasts. float32 stays
    float32, all else is float64. Operations give the same `value` as plain floats do, bit for bit, and an enclosure
    [`lower`, `upper`] of the exact result, kept by outward rounding. Where the result may not be defined (the root of
    what may be negative) `error` is infinite. ValueError for NaN, infinities and negative errors.

    With `precise`, which costs time and memory, the same is computed in higher precision beside it (double for float32,
    long double for float64), as EFloat does in debug builds: see `precise_value` and `actual_relative_error`. It starts
    from `value`. What is computed from a number without it has none. RuntimeError if it leaves the enclosure, which
    would be an error of this package.

    Four numbers may be added in two ways. By eq. 3.9 the error of ((a + b) + c) + d is at most 4 u |a + b| + 3 u |c| +
    2 u |d|, u = 2^-24; that of (a + b) + (c + d) is at most 3 u |a + b| + 3 u |c + d|. The second bound is less where
    |a + b| is large, and more where |d| is. Running errors tell as much without a derivation:

    >>> import numpy as np
    >>> import raybound as rb
    >>> def both_ways(*numbers):
    ...     a, b, c, d = (rb.RunningError(np.float32(x), precise=True) for x in numbers)
    ...     p, q, r, s = (float(x.precise_value) for x in (a + b, c, d, c + d))
    ...     bounds = (4 * abs(p) + 3 * abs(q) + 2 * abs(r)) / 2**24, (3 * abs(p) + 3 * abs(s)) / 2**24
    ...     for total, bound in zip((((a + b) + c) + d, (a + b) + (c + d)), bounds):
    ...         error = abs(float(total.value) - total.precise_value)
    ...         print(f"{total.value:.5f}: off by {error:.1e}, at most {total.error:.1e}; eq. 3.9 {bound:.1e}")
    >>> both_ways(195.2, 669.2, 0.4, 0.7)  # |a + b| is large
    865.50006: off by 5.2e-05, at most 1.8e-04; eq. 3.9 2.1e-04
    865.50000: off by 9.1e-06, at most 6.1e-05; eq. 3.9 1.5e-04
    >>> both_ways(0.3, 0.4, 0.4, 618.5)  # |d| is large
    619.59998: off by 2.4e-05, at most 6.1e-05; eq. 3.9 7.4e-05
    619.60004: off by 3.7e-05, at most 1.2e-04; eq. 3.9 1.1e-04
    """

    __slots__ = ()

    def __init__(self, value: npt.ArrayLike, error: npt.ArrayLike = 0, *, precise: bool = False) -> None:
        values = plain("RunningError", "value", value)
        errors = plain("RunningError", "error", error)
        kept = _validate.flag("RunningError", "precise", precise)
        if (errors < 0).any():
            raise ValueError(f"RunningError: error must be >= 0, got {_validate._culprit(errors, errors >= 0)}")
        dtype = F32 if values.dtype == F32 else F64
        values, errors = broadcast("RunningError", value=values, error=errors)
        with np.errstate(over="ignore", under="ignore"):
            bounds = errors.astype(dtype)
            above = np.nextafter(bounds, dtype.type(np.inf))
        bounds = np.where(bounds < errors, above, bounds)  # never below what was given
        kind = KIND[dtype, kept]
        given = [values.astype(dtype), bounds, *[np.zeros_like(bounds)] * (KINDS[kind][0] - 2)]
        records = apply(kind, "with_error", [np.stack(given, axis=-1)])
        records.flags.writeable = False
        self._kind = kind
        self._records = records

    def _lift(self, value: object, who: str, name: str) -> Number:
        dtype, precise = MEANING[self._kind]
        if isinstance(value, RunningError):
            other, known = MEANING[value._kind]
            return value._as(max(dtype, other), precise and known)
        array = plain(who, name, value)
        if dtype == F32 and is_weak(value):  # rounded, between its neighbours
            with np.errstate(over="ignore", under="ignore"):
                rounded = array.astype(np.float32)
            ends = _core.interval_points(np.ascontiguousarray(array, np.float64)).reshape(2)
            exactly = [array, 0] if precise else []
            return RunningError._made(self._kind, np.array([rounded, *ends, *exactly], F64 if precise else F32))
        return RunningError(array, precise=precise)

    def _as(self, dtype: np.dtype[Any], precise: bool) -> RunningError:
        """The same numbers, of no narrower dtype, perhaps without their precise values."""
        if MEANING[self._kind] == (dtype, precise):
            return self
        width = KINDS[KIND[dtype, precise]][0]
        return RunningError._made(KIND[dtype, precise], self._records[..., :width].astype(F64 if precise else dtype))

    def _part(self, index: int) -> Any:
        return self._records[..., index].astype(MEANING[self._kind][0], copy=False)[()]

    @property
    def value(self) -> Any:
        """What floating-point arithmetic gives."""
        return self._part(0)

    @property
    def lower(self) -> Any:
        """The lower end of the enclosure of the exact number."""
        return self._part(1)

    @property
    def upper(self) -> Any:
        """The upper end of the enclosure of the exact number."""
        return self._part(2)

    @property
    def error(self) -> Any:
        """A bound of |value - exact|, rounded up; infinite where the result may not be defined."""
        return self._errors()[..., 0].astype(MEANING[self._kind][0])[()]

    @property
    def relative_error(self) -> Any:
        """A bound of |value - exact| / |exact|, rounded up; infinite where the exact number may be 0."""
        return self._errors()[..., 1].astype(MEANING[self._kind][0])[()]

    @property
    def precise_value(self) -> Any:
        """The number computed in higher precision (PreciseValue, 3.9.1): float64 for float32, else a long double.

        No bound: higher precision rounds, too. NaN where the result is not defined. ValueError without `precise`.
        """
        self._check_precise("precise_value")
        if MEANING[self._kind][0] == F32:
            return self._records[..., 3].copy()[()]
        return (self._records[..., 3].astype(np.longdouble) + self._records[..., 4])[()]

    @property
    def actual_relative_error(self) -> Any:
        """|precise_value - value| / |precise_value| (GetRelativeError, 3.9.1; eq. 3.8), float64.

        An estimate of what `relative_error` bounds. 0 where both are equal, infinite where only `precise_value` is 0,
        NaN where the result is not defined. ValueError without `precise`.
        """
        self._check_precise("actual_relative_error")
        return self._errors()[..., 2].copy()[()]

    def _errors(self) -> npt.NDArray[Any]:
        return apply(self._kind, "errors", [self._records])

    def _check_precise(self, name: str) -> None:
        if not MEANING[self._kind][1]:
            raise ValueError(f"RunningError: {name} needs numbers that are all made with precise=True")

    @property
    def enclosure(self) -> Interval:
        """[lower, upper] as an Interval."""
        dtype = MEANING[self._kind][0]
        return Interval._made(INTERVAL[dtype], self._records[..., 1:3].astype(dtype))

    def __repr__(self) -> str:
        dtype, precise = MEANING[self._kind]
        if self.ndim:
            return f"<RunningError array of shape {self.shape}, {dtype}{', precise' if precise else ''}>"
        value = f"np.float32({self.value})" if dtype == F32 else repr(float(self.value))
        return f"RunningError({value}, {float(self.error)!r}{', precise=True' if precise else ''})"


def quadratic(a: Any, b: Any, c: Any) -> tuple[Any, RunningError, RunningError]:
    """The roots of a t^2 + b t + c with running errors: Quadratic on EFloat, Physically Based Rendering 3.9.1.

    `a`, `b`, `c`: RunningErrors, of which there must be one at least, numbers and arrays; they broadcast. Returns
    (real, t0, t1), in the common shape: `real` is a `Verdict`, or an array of its values (uint8), and says whether both
    roots are real for all coefficients that the errors leave open, for none, or for some only. It is UNKNOWN where `a`
    may be 0. t0 <= t1 are RunningErrors: their values are those of the float kernel, and their enclosures hold the
    exact roots if these are real. Where `real` is NO their errors are infinite. The seed takes the sign of the
    discriminant's value instead, and may so take a hit for a miss.

    Raises TypeError if none is a RunningError, ValueError if they do not broadcast.
    """
    if not any(isinstance(value, RunningError) for value in (a, b, c)):
        raise TypeError("quadratic: one of a, b and c must be a RunningError")
    lifted = together("quadratic", a, b, c)
    kind = lifted[0]._kind
    width = KINDS[kind][0]
    found = applied("quadratic", lifted, width=2 * width + 2)
    real = found[..., 2 * width].astype(np.uint8)
    low, high = (np.ascontiguousarray(found[..., k * width : (k + 1) * width]) for k in range(2))
    answer = Verdict(int(real)) if real.ndim == 0 else real
    return answer, RunningError._made(kind, low), RunningError._made(kind, high)
