"""What the hard cases are made of: a place with its own origin and unit, materials, a still life."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...camera import Camera
from ...lights import PointLight
from ...materials import Material
from ...scene import Scene
from ...shapes import Box, Cone, Cylinder, Polygon, Shape, Sphere

Point = tuple[float, float, float]

SKY = (0.30, 0.42, 0.58)
RED, GREEN, BLUE = Material((0.70, 0.16, 0.10)), Material((0.22, 0.52, 0.20)), Material((0.16, 0.28, 0.66))
YELLOW, GREY, WHITE = Material((0.78, 0.62, 0.16)), Material((0.48, 0.46, 0.43)), Material((0.75, 0.75, 0.72))
COLOURS = (RED, YELLOW, GREEN, BLUE, WHITE)
MIRROR = Material(0.0, reflect=(0.92, 0.93, 0.95))
GLASS = Material(0.0, (0.4, 0.4, 0.4), roughness=0.05, reflect=0.06, transmit=0.92, ior=1.5)


@dataclass(frozen=True)
class Place:
    """Coordinates of a scene that lies anywhere and has any size: `unit` scene units from the point `origin`."""

    origin: Point = (0.0, 0.0, 0.0)
    unit: float = 1.0

    def at(self, x: float, y: float, z: float) -> Point:
        """The point in the scene."""
        a, b, c = self.origin
        return (a + x * self.unit, b + y * self.unit, c + z * self.unit)

    def sphere(self, centre: Point, radius: float) -> Sphere:
        """A sphere; all arguments are in the place's units."""
        return Sphere(self.at(*centre), radius * self.unit)

    def box(self, low: Point, high: Point) -> Box:
        """A box between two corners."""
        return Box(self.at(*low), self.at(*high))

    def cylinder(self, base: Point, top: Point, radius: float) -> Cylinder:
        """A cylinder between the centres of its caps."""
        return Cylinder(self.at(*base), self.at(*top), radius=radius * self.unit)

    def cone(self, base: Point, apex: Point, radius: float) -> Cone:
        """A cone with a point."""
        return Cone(self.at(*base), self.at(*apex), radius=radius * self.unit)

    def polygon(self, vertices: Sequence[Point]) -> Polygon:
        """A convex polygon."""
        return Polygon([self.at(*vertex) for vertex in vertices])

    def floor(self, half: float, z: float = 0.0) -> Polygon:
        """A level square around the origin that faces up."""
        return self.polygon([(-half, -half, z), (half, -half, z), (half, half, z), (-half, half, z)])

    def lamp(self, x: float, y: float, z: float, intensity: float = 0.8) -> PointLight:
        """A point light without falloff."""
        return PointLight(self.at(x, y, z), intensity)

    def camera(self, eye: Point, target: Point, *, fov: float, up: Point = (0.0, 0.0, 1.0)) -> Camera:
        """A camera of 640 by 480 pixels; `fov` in degrees."""
        return Camera(self.at(*eye), self.at(*target), up=up, fov=fov)


def scene_with(*things: tuple[Shape, Material]) -> Scene:
    """A scene under a blue sky that holds the things."""
    scene = Scene(ambient=0.25, background=SKY)
    for shape, material in things:
        scene.add(shape, material)
    return scene


def still_life(place: Place) -> Scene:
    """Balls of mirror, glass and paint, a box, a cone and a cylinder on a floor: 12 units wide, from 0.5 up.

    All numbers are multiples of 1/32, so that a place whose unit is a power of two holds them exactly.
    """
    scene = scene_with(
        (place.floor(8.0), GREY),
        (place.sphere((-1.5, 1.0, 1.0), 1.0), MIRROR),
        (place.sphere((0.5, -1.25, 0.75), 0.75), GLASS),
        (place.sphere((1.75, 1.5, 0.875), 0.875), RED),
        (place.box((-3.0, -1.5, 0.0), (-1.75, -0.5, 0.75)), BLUE),
        (place.cone((3.0, -0.75, 0.0), (3.0, -0.75, 1.75), 0.625), YELLOW),
        (place.cylinder((-0.75, 3.5, 0.0), (-0.75, 3.5, 2.25), 0.5), GREEN),
    )
    scene.add_light(place.lamp(-4.0, -5.0, 8.0))
    scene.add_light(place.lamp(5.0, -2.0, 6.0, 0.4))
    scene.camera = place.camera((-0.5, -7.5, 3.5), (0.0, 0.0, 0.75), fov=42.0)
    return scene


def fov_of(half_angle: float) -> float:
    """The field of view, in degrees, that reaches `half_angle` rad up and down: at least a camera's least, 0.001."""
    return max(0.001, math.degrees(2 * half_angle))


def power_of_two(x: float) -> float:
    """The largest power of two that is <= x."""
    return math.ldexp(0.5, math.frexp(x)[1])


def chequers(place: Place, count: int, size: float, z: float = 0.0) -> list[tuple[Any, Material]]:
    """A floor of count x count tiles that share edges, in two colours."""
    dark = Material((0.13, 0.16, 0.20))
    tiles = []
    for i, j in itertools.product(range(count), repeat=2):
        x, y = ((k - count / 2) * size for k in (i, j))
        corners = [(x, y, z), (x + size, y, z), (x + size, y + size, z), (x, y + size, z)]
        tiles.append((place.polygon(corners), dark if (i + j) % 2 else WHITE))
    return tiles
