"""Benches, ropes on posts, clipped trees in pots, pedestals."""

from __future__ import annotations

import itertools
import math

from ..materials import Material
from ..scene import Scene
from ..shapes import Box, Cylinder, Intersection, Shape, Sphere
from ..transform import Transform
from .hall import LEFT, RIGHT
from .kit import Point, Wall, block, frustum, put, rods, shifted, turned
from .palette import Palette

GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))


def build_furniture(scene: Scene, palette: Palette) -> None:
    """Add the furniture where it stands."""
    for k, (x, y, degrees) in enumerate(((12.0, 2.6, 0.0), (12.0, 9.7, 0.0), (1.1, 3.0, 90.0), (1.1, 9.0, 90.0))):
        bench(scene, palette, Transform.translate(x, y, 0) @ Transform.rotate(degrees), f"bench-{k}")
    rope_line(scene, palette, LEFT, [5.7, 7.2, 8.7])
    rope_line(scene, palette, RIGHT, [15.3, 16.8, 18.3])
    rope_line(scene, palette, LEFT, [15.3, 16.8, 18.3])
    rope_line(scene, palette, RIGHT, [5.7, 7.2, 8.7])
    for x, y in ((21.7, 2.7), (21.7, 9.3), (0.75, 0.95), (0.75, 11.05)):
        topiary(scene, palette, (x, y, 0.0))


def bench(scene: Scene, palette: Palette, place: Transform, name: str) -> None:
    """A walnut bench with a domed velvet cushion: the cushion is a box within two wide cylinders."""
    half, depth = 0.85, 0.26
    cushion = Intersection(
        Box((-half, -depth, 0.43), (half, depth, 0.60)),
        Cylinder((-half - 1, 0, -0.42), (half + 1, 0, -0.42), radius=0.97),
        Cylinder((0, -1, -5.22), (0, 1, -5.22), radius=5.77),
    )
    scene.add(cushion, palette.velvet, name=name, transform=place)
    wood: list[Shape] = [Box((-half - 0.03, -depth - 0.03, 0.36), (half + 0.03, depth + 0.03, 0.435))]
    for x in (-half + 0.08, 0.0, half - 0.08):
        for y in (-depth + 0.05, depth - 0.05):
            wood += turned((x, y, -0.002), [(0.0, 0.024), (0.10, 0.038), (0.30, 0.030), (0.365, 0.045)])
    wood += [
        Cylinder((-half + 0.08, y, 0.10), (half - 0.08, y, 0.10), radius=0.014) for y in (0.05 - depth, depth - 0.05)
    ]
    for shape in wood:
        scene.add(shape, palette.walnut, transform=place)
    for x in (-0.5, 0.0, 0.5):
        level = math.sqrt(5.77**2 - x * x) - 5.22  # of the cushion's ridge, into which the buttons are drawn
        scene.add(Sphere((x, 0.0, level - 0.008), 0.018), palette.gilt, transform=place)


def rope_line(scene: Scene, palette: Palette, wall: Wall, places: list[float]) -> None:
    """Brass posts before a wall with a velvet rope between them."""
    tops = []
    for s in places:
        foot = wall.point(s, 1.25, -0.002)
        profile = [(0.0, 0.15), (0.02, 0.15), (0.05, 0.03), (0.05, 0.022), (0.86, 0.022), (0.86, 0.034), (0.90, 0.034)]
        put(scene, palette.dull_brass, turned(foot, profile))
        scene.add(Sphere(shifted(foot, dz=0.935), 0.045), palette.brass)
        tops.append(shifted(foot, dz=0.87))
    for start, end in itertools.pairwise(tops):
        put(scene, palette.velvet, rods(hanging_rope(start, end, 0.22, 7), 0.02))


def hanging_rope(start: Point, end: Point, sag: float, pieces: int) -> list[Point]:
    """Points along a rope that hangs between two points of one height: a parabola."""
    points = []
    for k in range(pieces + 1):
        t = k / pieces
        x, y = start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])
        points.append((x, y, start[2] - 4 * sag * t * (1 - t)))
    return points


def topiary(scene: Scene, palette: Palette, foot: Point) -> None:
    """A box tree clipped to two balls, in a stone pot."""
    pot = [(-0.002, 0.20), (0.04, 0.20), (0.06, 0.17), (0.42, 0.27), (0.42, 0.30), (0.48, 0.30)]
    put(scene, palette.marble, turned(foot, pot))
    scene.add(Cylinder(shifted(foot, dz=0.44), shifted(foot, dz=0.487), radius=0.26), palette.soil)
    scene.add(frustum(shifted(foot, dz=0.45), shifted(foot, dz=1.75), 0.035, 0.025), palette.dark_wood)
    for z, radius, count in ((1.12, 0.34, 22), (1.78, 0.24, 14)):
        leafy_ball(scene, palette.leaf, shifted(foot, dz=z), radius, count)


def leafy_ball(scene: Scene, material: Material, centre: Point, radius: float, count: int) -> None:
    """A ball with tufts on it, set by the golden angle."""
    scene.add(Sphere(centre, radius), material)
    for k in range(count):
        z = 1 - (2 * k + 1) / count
        r, a = math.sqrt(1 - z * z), k * GOLDEN_ANGLE
        tuft = shifted(centre, *(0.86 * radius * v for v in (r * math.cos(a), r * math.sin(a), z)))
        scene.add(Sphere(tuft, 0.33 * radius), material)


def pedestal(scene: Scene, palette: Palette, foot: Point, height: float) -> None:
    """A square pedestal of two marbles with a cushion slab."""
    scene.add(block(shifted(foot, dz=-0.002), (0.56, 0.56, 0.10)), palette.verde)
    scene.add(block(shifted(foot, dz=0.096), (0.44, 0.44, height - 0.16)), palette.marble)
    scene.add(block(shifted(foot, dz=height - 0.066), (0.54, 0.54, 0.066)), palette.verde)
