"""Scenes far away, very large and very small."""

from __future__ import annotations

import itertools
import math

import numpy as np

from ...camera import Camera
from ...lights import DirectionalLight
from ...scene import Scene
from ...shapes import Cone, Cylinder, Shape, Sphere
from .registry import Group
from .stage import (
    BLUE,
    COLOURS,
    GREEN,
    GREY,
    MIRROR,
    RED,
    WHITE,
    YELLOW,
    Place,
    fov_of,
    power_of_two,
    scene_with,
    still_life,
)

case = Group()


@case(
    "far-mirror",
    "A mirror far from the origin: reflected rays must leave it, and the images must be in their places.",
    scale="the coordinate c of the mirror's foot (c, c, c), scene units, rounded to float32",
    default=1e5,
    scales=(1e3, 1e4, 1e5, 1e6, 1e7),
    within=(1.0, 1e9),
)
def far_mirror(scale: float) -> Scene:
    """A mirror in the plane x = y, whose reflection swaps x and y, which is exact in floats.

    The scene is 20 units wide, or 2560 float32 steps where these are larger: then it grows with the coordinate.
    """
    c = float(np.float32(scale))
    place = Place((c, c, c), max(1.0, power_of_two(c) * 2.0**-16))
    scene = scene_with(
        (place.polygon([(-5, -5, 0), (5, 5, 0), (5, 5, 6), (-5, -5, 6)]), MIRROR),
        (place.polygon([(-5, -5, 0), (5, -15, 0), (15, -5, 0), (5, 5, 0)]), GREY),
        (place.sphere((3.5, -0.5, 1.0), 1.0), RED),
        (place.box((0.0, -3.5, 0.0), (1.5, -2.0, 1.5)), BLUE),
        (place.cone((4.0, -3.5, 0.0), (4.0, -3.5, 2.5), 0.75), YELLOW),
        (place.cylinder((1.0, -1.0, 0.0), (1.0, -1.0, 2.0), 0.375), GREEN),
    )
    scene.add_light(place.lamp(4.0, -12.0, 14.0))
    scene.camera = place.camera((9.0, -6.0, 4.0), (1.0, -1.0, 1.5), fov=45.0)
    return scene


@case(
    "scene-scale",
    "A still life of any size: nothing may depend on a length of its own.",
    scale="the unit of the scene, which is 16 units wide",
    default=1.0,
    scales=(1e-6, 1e-3, 1.0, 1e3, 1e6),
    within=(1e-9, 1e9),
)
def scene_scale(scale: float) -> Scene:
    """The still life."""
    return still_life(Place(unit=scale))


@case(
    "huge",
    "The largest scenes: coordinates near 2**60, beyond which shapes are refused.",
    scale="the unit of the scene, which is 16 units wide; at 2**57 its floor reaches 2**60",
    default=2.0**57,
    scales=(1e12, 1e15, 2.0**57),
    within=(1.0, 2.0**57),
)
def huge(scale: float) -> Scene:
    """The still life."""
    return still_life(Place(unit=scale))


@case(
    "tiny",
    "The smallest scenes: sizes near 2**-60, below which shapes are refused.",
    scale="the unit of the scene, whose smallest radius is half a unit",
    default=2.0**-59,
    scales=(1e-12, 1e-15, 2.0**-59),
    within=(2.0**-59, 1.0),
)
def tiny(scale: float) -> Scene:
    """The still life."""
    return still_life(Place(unit=scale))


@case(
    "two-scales",
    "A tiny ball on a vast floor under towers: two scales in one picture.",
    scale="the radius r of the ball, scene units; the floor's half side is 1/r",
    default=1e-4,
    scales=(1e-1, 1e-2, 1e-3, 1e-4),
    within=(1e-8, 0.1),
)
def two_scales(scale: float) -> Scene:
    """The ball rests on the origin; the camera stands 6 of its radii away and sees the towers behind it."""
    near, far = Place(unit=scale), Place(unit=1 / scale)
    scene = scene_with(
        (far.floor(1.0), GREY),
        (near.sphere((0.0, 0.0, 1.0), 1.0), RED),
        (near.box((-3.5, 1.0, 0.0), (-2.0, 2.5, 1.25)), BLUE),
        (far.cylinder((-0.25, 0.75, 0.0), (-0.25, 0.75, 0.25), 0.0625), WHITE),
        (far.cone((0.25, 0.625, 0.0), (0.25, 0.625, 0.25), 0.125), YELLOW),
        (far.box((-0.75, 0.5, 0.0), (-0.5, 0.75, 0.1875)), GREEN),
    )
    scene.add_light(DirectionalLight((0.5, 0.375, -1.0), 0.8))
    scene.camera = near.camera((0.0, -6.0, 2.0), (0.0, 0.0, 1.0), fov=55.0)
    return scene


@case(
    "far-eye",
    "Shapes seen from afar: the discriminant of a quadratic is a small difference of large numbers.",
    scale="the distance of the eye from shapes of radius 1",
    default=1e4,
    scales=(1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7),
    within=(10.0, 1e7),
)
def far_eye(scale: float) -> Scene:
    """Balls, cylinders and cones side by side around the origin, as many as the narrowest view shows."""
    half_angle = math.radians(fov_of(5.0 / scale)) / 2
    rows = math.ceil(half_angle * scale / 4)
    scene = Scene(ambient=0.25, background=(0.05, 0.07, 0.10))
    for i, j in itertools.product(range(-math.ceil(rows * 4 / 3), math.ceil(rows * 4 / 3) + 1), range(-rows, rows + 1)):
        scene.add(_round_shape((i + j) % 3, 4.0 * i, 4.0 * j), COLOURS[(i + 2 * j) % len(COLOURS)])
    scene.add_light(DirectionalLight((-0.5, 0.625, -0.75), 0.9))
    scene.camera = Camera((0.0, -scale, 0.0), (0.0, 0.0, 0.0), fov=2 * math.degrees(half_angle))
    return scene


def _round_shape(kind: int, x: float, z: float) -> Shape:
    """One of three shapes of radius 1 around (x, 0, z)."""
    if kind == 0:
        return Sphere((x, 0.0, z), 1.0)
    if kind == 1:
        return Cylinder((x, 0.25, z - 1.0), (x, -0.25, z + 1.0), radius=1.0)
    return Cone((x, 0.25, z - 1.0), (x, -0.25, z + 1.0), radius=1.0)
