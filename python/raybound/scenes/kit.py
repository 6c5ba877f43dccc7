"""Building blocks of the ready scenes: pictures as textures, turned solids, rods and walls to build against."""

from __future__ import annotations

import itertools
import math
import pathlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from ..materials import Material, Texture
from ..scene import Scene
from ..shapes import Box, Cone, Cylinder, Polygon, Shape, Sphere

PICTURES = pathlib.Path(__file__).parent / "paintings"
SUNK = 0.002  # metres by which a thing sinks into what carries it, so that no two faces coincide

Point = tuple[float, float, float]


def picture(name: str, scale: tuple[float, float] = (1.0, 1.0)) -> Texture:
    """One of the stored pictures, repeated `scale` times over u and v."""
    return Texture(PICTURES / f"{name}.png", scale)


def shifted(point: Point, dx: float = 0.0, dy: float = 0.0, dz: float = 0.0) -> Point:
    """The point moved by the offsets."""
    return (point[0] + dx, point[1] + dy, point[2] + dz)


def frustum(base: Point, top: Point, radius: float, top_radius: float) -> Shape:
    """A round solid between two circles: a cylinder, or a cone that stands on its larger end."""
    if radius == top_radius:
        return Cylinder(base, top, radius=radius)
    if radius > top_radius:
        return Cone(base, top, radius=radius, top_radius=top_radius)
    return Cone(top, base, radius=top_radius, top_radius=radius)


def turned(foot: Point, profile: Sequence[tuple[float, float]]) -> Iterator[Shape]:
    """A solid turned on a lathe: frusta through the (height above foot, radius) points.

    Two points of one height make a step. Each piece sinks a little into the one below.
    """
    for (low, radius), (high, top_radius) in itertools.pairwise(profile):
        if high > low:
            yield frustum(shifted(foot, dz=low - SUNK), shifted(foot, dz=high), radius, top_radius)


def rods(points: Sequence[Point], radius: float) -> Iterator[Shape]:
    """A bent rod: cylinders through the points with balls at the inner joints."""
    for start, end in itertools.pairwise(points):
        yield Cylinder(start, end, radius=radius)
    for joint in points[1:-1]:
        yield Sphere(joint, radius)


def ring(centre: Point, radius: float, count: int, phase: float = 0.0) -> Iterator[Point]:
    """Points evenly around a level circle; phase in degrees."""
    for k in range(count):
        angle = math.radians(phase) + 2 * math.pi * k / count
        yield shifted(centre, radius * math.cos(angle), radius * math.sin(angle))


def block(centre: Point, size: Point) -> Box:
    """A box that stands on the point `centre`, which is the middle of its lower face."""
    x, y, z = centre
    return Box((x - size[0] / 2, y - size[1] / 2, z), (x + size[0] / 2, y + size[1] / 2, z + size[2]))


def put(scene: Scene, material: Material, shapes: Iterable[Shape]) -> None:
    """Add all the shapes with one material."""
    for shape in shapes:
        scene.add(shape, material)


@dataclass(frozen=True)
class Wall:
    """A wall's own coordinates: s runs to the right as one faces it, d out of it into the room, z up."""

    origin: tuple[float, float]
    along: tuple[int, int]
    inward: tuple[int, int]
    length: float

    def point(self, s: float, d: float, z: float) -> Point:
        """The point in the scene."""
        x = self.origin[0] + s * self.along[0] + d * self.inward[0]
        y = self.origin[1] + s * self.along[1] + d * self.inward[1]
        return (x, y, z)

    def box(self, s: tuple[float, float], d: tuple[float, float], z: tuple[float, float]) -> Box:
        """A box over the three ranges."""
        a, b = self.point(s[0], d[0], z[0]), self.point(s[1], d[1], z[1])
        return Box((min(a[0], b[0]), min(a[1], b[1]), z[0]), (max(a[0], b[0]), max(a[1], b[1]), z[1]))

    def panel(self, s: tuple[float, float], d: float, z: tuple[float, float]) -> Polygon:
        """A rectangle parallel to the wall that faces the room; u runs along s, v up."""
        return Polygon([self.point(u, d, v) for u, v in ((s[0], z[0]), (s[1], z[0]), (s[1], z[1]), (s[0], z[1]))])
