"""Lights: immutable values. Colours are linear RGB, lengths scene units, angles degrees."""

from __future__ import annotations

import numpy.typing as npt

from . import _core, _validate
from ._validate import Vector, packed
from ._value import Value


class Light(Value):
    """The base of all lights."""

    _native: _core.Light


class DirectionalLight(Light):
    """The thesis's infinite light: parallel light from far away.

    `direction`: where the light travels, 3 numbers, non-zero, of any length. `radiance`: RGB (or a scalar), >= 0.
    """

    direction: Vector
    radiance: Vector

    def __init__(self, direction: npt.ArrayLike, radiance: npt.ArrayLike = (1.0, 1.0, 1.0)) -> None:
        self._set(direction=_validate.direction("DirectionalLight", "direction", direction))
        self._set(radiance=_validate.rgb("DirectionalLight", "radiance", radiance))
        self._set(_native=_core.directional_light(packed(self.direction), packed(self.radiance)))


class PointLight(Light):
    """A light that shines from a point in all directions.

    `position`: 3 numbers. `intensity`: RGB (or a scalar), >= 0. `falloff`: True divides by the squared distance.
    """

    position: Vector
    intensity: Vector
    falloff: bool

    def __init__(
        self, position: npt.ArrayLike, intensity: npt.ArrayLike = (1.0, 1.0, 1.0), *, falloff: bool = False
    ) -> None:
        self._set(position=_validate.vector("PointLight", "position", position))
        self._set(intensity=_validate.rgb("PointLight", "intensity", intensity))
        self._set(falloff=_validate.flag("PointLight", "falloff", falloff))
        self._set(_native=_core.point_light(packed(self.position), packed(self.intensity), self.falloff))


class SpotLight(Light):
    """A point light that shines into a sharp cone only.

    `position`: 3 numbers. `direction`: the cone's axis, non-zero, of any length. `cutoff`: the cone's half angle in
    degrees, 0 < cutoff <= 180. `intensity`: RGB (or a scalar), >= 0. `falloff`: True divides by the squared distance.
    """

    position: Vector
    direction: Vector
    cutoff: float
    intensity: Vector
    falloff: bool

    def __init__(
        self,
        position: npt.ArrayLike,
        direction: npt.ArrayLike,
        *,
        cutoff: float = 30.0,
        intensity: npt.ArrayLike = (1.0, 1.0, 1.0),
        falloff: bool = False,
    ) -> None:
        self._set(position=_validate.vector("SpotLight", "position", position))
        self._set(direction=_validate.direction("SpotLight", "direction", direction))
        self._set(cutoff=_validate.positive("SpotLight", "cutoff", cutoff))
        if self.cutoff > 180:
            raise ValueError(f"SpotLight: cutoff must be at most 180 degrees, got {_validate.describe(cutoff)}")
        self._set(intensity=_validate.rgb("SpotLight", "intensity", intensity))
        self._set(falloff=_validate.flag("SpotLight", "falloff", falloff))
        self._set(_native=self._make())

    def _make(self) -> _core.Light:
        position, direction = packed(self.position), packed(self.direction)
        return _core.spot_light(position, direction, self.cutoff, packed(self.intensity), self.falloff)
