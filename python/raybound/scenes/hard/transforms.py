"""Transforms whose rounding adds up, that undo huge scales, or that are nearly singular."""

from __future__ import annotations

from ...camera import Camera
from ...scene import Scene
from ...shapes import Box, Cone, Cylinder, Shape, Sphere
from ...transform import Transform
from .registry import Group
from .stage import BLUE, GREEN, GREY, RED, YELLOW, Place, scene_with

case = Group()
AXIS = (1.0, 2.0, 3.0)


def _table(*things: Shape) -> Scene:
    """Four shapes, each about 2 units wide, side by side on a floor; the camera sees them from the front."""
    scene = scene_with((Place().floor(12.0, -1.25), GREY))
    for k, (shape, material) in enumerate(zip(things, (RED, YELLOW, BLUE, GREEN), strict=True)):
        scene.add(shape.transformed(Transform.translate(2.5 * (k - 1.5), 0.0, 0.0)), material)
    scene.add_light(Place().lamp(-3.0, -6.0, 6.0))
    scene.camera = Camera((0.0, -10.0, 2.5), (0.0, 0.0, -0.25), fov=40.0)
    return scene


SHAPES = (
    Box((-0.75, -0.5, -0.875), (0.75, 0.5, 0.875)),
    Cone((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), radius=0.75),
    Cylinder((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), radius=0.5),
    Sphere((0.25, 0.0, 0.0), 0.875),
)


@case(
    "rotation-chain",
    "A full turn in many steps, each rounded to float32: shapes come back to where they were.",
    scale="the number of steps, rounded to an integer",
    default=1000.0,
    scales=(1.0, 10.0, 100.0, 1000.0),
    within=(1.0, 10000.0),
)
def rotation_chain(scale: float) -> Scene:
    """Every object is turned about the axis (1, 2, 3) by moves of its handle, as an animation would do it."""
    steps = round(scale)
    scene = _table(*SHAPES)
    turn = Transform.rotate(360.0 / steps, AXIS)
    for item in scene.objects[1:]:
        for _ in range(steps):
            item.move(turn)
    return scene


@case(
    "transform-scales",
    "Shapes of any size that a transform brings back to size one.",
    scale="the size of the shapes before their transforms",
    default=1e-6,
    scales=(1e-6, 1e-3, 1.0, 1e3, 1e6),
    within=(1e-12, 1e12),
)
def transform_scales(scale: float) -> Scene:
    """Each shape is made at that size, by the shape's own arguments, turned and scaled by its inverse."""
    place, s = Place(unit=scale), scale
    shapes = (
        place.box((-0.75, -0.5, -0.875), (0.75, 0.5, 0.875)),
        place.cone((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), 0.75),
        place.cylinder((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), 0.5),
        place.sphere((0.25, 0.0, 0.0), 0.875),
    )
    back = Transform.rotate(25.0, AXIS) @ Transform.scale(1 / s)
    return _table(*(shape.transformed(back) for shape in shapes))


@case(
    "near-singular",
    "Shapes that a transform squashes flat: its inverse has entries as large as it is singular.",
    scale="the factor by which shapes are squashed along one direction",
    default=1e-3,
    scales=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
    within=(1e-7, 1.0),
)
def near_singular(scale: float) -> Scene:
    """Squashed along their own z axes, then turned toward the viewer: flat ellipses and rectangles."""
    flat = Transform.rotate(65.0, (1.0, 0.25, 0.0)) @ Transform.scale((1.0, 1.0, scale))
    return _table(*(shape.transformed(flat) for shape in SHAPES))
