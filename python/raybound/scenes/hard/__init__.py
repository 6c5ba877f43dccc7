"""Hard cases of ray tracing in floating point, each a picture with a scale that makes it harder.

`HARD_CASES` lists them by name; `hard_case` makes one. Their tests say what each must show.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ... import _validate
from ...scene import Scene
from . import edges, grazing, light_paths, meshes, reach, shadows, transforms
from .registry import HardCase

__all__ = ["HARD_CASES", "HardCase", "hard_case"]

_GROUPS = (reach, grazing, meshes, edges, light_paths, shadows, transforms)

HARD_CASES: Mapping[str, HardCase] = MappingProxyType({c.name: c for group in _GROUPS for c in group.case.cases})
"""The hard cases by name: a read-only mapping of `HardCase`."""


def hard_case(name: str, scale: float | None = None) -> Scene:
    """A scene that is hard to trace in floating point, with its camera.

    Parameters
    ----------
    name : str
        One of `rb.scenes.HARD_CASES`, such as "far-mirror".
    scale : float, optional
        How hard it is: a coordinate, an angle, a ratio or a number of steps; what it means, and its range, are in
        `HARD_CASES[name]`. None: the case's default.

    Raises
    ------
    ValueError
        If there is no such case, or the scale is outside the range of this one.
    TypeError
        If the name is not a string or the scale not a number.
    """
    found = HARD_CASES[_validate.choice("hard_case", "name", name, list(HARD_CASES))]
    value = found.default if scale is None else _validate.double("hard_case", "scale", scale)
    if not found.lowest <= value <= found.highest:
        expected = f"within {found.lowest:g} and {found.highest:g} for {name!r} ({found.scale_means})"
        raise ValueError(f"hard_case: scale must be {expected}, got {_validate.describe(scale)}")
    return found.make(value)
