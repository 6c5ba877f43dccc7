"""The list of hard cases: what each is called, what its scale means, how far it reaches and where it is measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...scene import Scene

Maker = Callable[[float], Scene]


@dataclass(frozen=True)
class HardCase:
    """One hard case of ray tracing in floating point.

    Attributes: `name`; `about`, what is hard, in one line; `scale_means`, what the scale is, with its unit; `default`,
    the scale that `hard_case` takes if none is given; `scales`, those at which the case is measured; `lowest` and
    `highest`, the range of scales (ends included); `max_depth`, the depth of ray trees its picture needs; `make`, the
    generator, which does not check its argument.
    """

    name: str
    about: str
    scale_means: str
    default: float
    scales: tuple[float, ...]
    lowest: float
    highest: float
    max_depth: int
    make: Maker


class Group:
    """The cases of one file, entered by `@case(...)` in the order in which they stand there."""

    def __init__(self) -> None:
        self.cases: list[HardCase] = []

    def __call__(
        self,
        name: str,
        about: str,
        *,
        scale: str,
        default: float,
        scales: tuple[float, ...],
        within: tuple[float, float],
        max_depth: int = 5,
    ) -> Callable[[Maker], Maker]:
        """Enters the generator that it decorates."""

        def enter(make: Maker) -> Maker:
            self.cases.append(HardCase(name, about, scale, default, scales, *within, max_depth, make))
            return make

        return enter
