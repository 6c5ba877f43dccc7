"""How much a picture may differ from the base image."""

from __future__ import annotations

from . import _validate
from ._value import Value


class Tolerance(Value):
    """The error that a renderer may make. An immutable value.

    At each pixel `error_bound <= max(absolute, relative * max over channels of the base radiance)`. 0 means equal to
    the base image, byte for byte. `Tolerance(None)` guards only discontinuities, and bounds are inf (thesis figure
    4-27, top row).

    `relative`: a number >= 0, or None. `absolute`: a radiance >= 0; default `relative / 10`.
    """

    _is_double = True
    relative: float | None
    absolute: float | None

    def __init__(self, relative: float | None, absolute: float | None = None) -> None:
        if relative is None:
            if absolute is not None:
                raise ValueError(f"Tolerance: absolute must be None if relative is, got {absolute!r}")
            self._set(relative=None, absolute=None)
            return
        first = _check("relative", relative)
        self._set(relative=first, absolute=first / 10 if absolute is None else _check("absolute", absolute))

    def __repr__(self) -> str:
        if self.relative is None or self.absolute == self.relative / 10:
            return f"Tolerance({self.relative!r})"
        return f"Tolerance({self.relative!r}, {self.absolute!r})"


def _check(name: str, value: object) -> float:
    number = _validate.double("Tolerance", name, value)
    if number < 0:
        raise ValueError(f"Tolerance: {name} must be >= 0, got {_validate.describe(value)}")
    return number


def as_tolerance(who: str, value: object) -> Tolerance:
    """A `Tolerance`, from one or from a number."""
    if isinstance(value, Tolerance):
        return value
    if value is None:
        raise TypeError(f"{who}: tolerance must be a Tolerance or a number, got None (use Tolerance(None))")
    return Tolerance(_validate.double(who, "tolerance", value))
