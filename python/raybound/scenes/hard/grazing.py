"""Rays that graze a surface."""

from __future__ import annotations

import math

from ...camera import Camera
from ...lights import DirectionalLight
from ...materials import Material
from ...scene import Scene
from ...shapes import Box, Cone, Cylinder, Polygon, Shape, Sphere
from .registry import Group
from .stage import BLUE, GREEN, RED, YELLOW, fov_of, scene_with

case = Group()
SHINY = Material((0.42, 0.40, 0.37), reflect=0.35)
ANGLES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)


def _along(surface: Shape, angle: float) -> Scene:
    """A look along the straight line y = z = 0 of a surface, at an angle, at small things that stand on it.

    The eye is at x = -1 and the things at x = 0; they are `angle` high.
    The view is the narrowest that a camera has where `angle` is below 4e-6 rad: things look small then.
    """
    a, foot = angle, -angle / 4
    scene = scene_with((surface, SHINY))
    scene.add(Sphere((0.0, 0.0, a / 2), a / 2), RED)
    scene.add(Box((-a / 4, -1.75 * a, foot), (a / 4, -1.0 * a, a)), BLUE)
    scene.add(Cone((0.0, 1.375 * a, foot), (0.0, 1.375 * a, a), radius=0.4 * a), YELLOW)
    scene.add(Cylinder((2.0 * a, -0.5 * a, foot), (2.0 * a, -0.5 * a, 1.5 * a), radius=0.2 * a), GREEN)
    scene.add_light(DirectionalLight((0.5, 0.25, -1.0), 0.8))
    scene.camera = Camera((-1.0, 0.0, a), (0.0, 0.0, a * 0.5), fov=fov_of(2.0 * a))
    return scene


def _grazing(kind: str, surface: Shape) -> None:
    """Enters the case of one kind of surface."""

    @case(
        f"grazing-{kind}",
        f"A {kind} seen at a grazing angle, with small things that stand on it and mirror in it.",
        scale="the angle of the view to the surface, rad",
        default=1e-3,
        scales=ANGLES,
        within=(1e-8, 0.125),
    )
    def make(scale: float) -> Scene:
        return _along(surface, scale)


_grazing("plane", Polygon([(-2.0, -2.0, 0.0), (2.0, -2.0, 0.0), (2.0, 2.0, 0.0), (-2.0, 2.0, 0.0)]))
_grazing("cylinder", Cylinder((-2.0, 0.0, -1.0), (2.0, 0.0, -1.0), radius=1.0))
# Sides of 3, 4, 5: the axis rises by 3 over 4 and the radius is 3/4 of the height, so that one line on it is level.
_grazing("cone", Cone((-1.0, 0.0, -3.0), (3.0, 0.0, 0.0), radius=3.75))


@case(
    "grazing-sphere",
    "The limb of a sphere: rays that miss or graze it within a few units in the last place.",
    scale="the angle to the surface, rad, of rays a fifth of the picture below the limb",
    default=1e-2,
    scales=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5),
    within=(1e-6, 0.5),
)
def grazing_sphere(scale: float) -> Scene:
    """The eye is on the horizontal tangent of the unit sphere below the origin: the middle row of an odd picture is
    tangent to it.

    A ray that starts at the distance D from the point of contact and leans by e grazes the sphere at sqrt(2 D e). A
    view cannot be narrower than 0.001 degrees, so small angles need a small D.
    """
    half = max(math.radians(0.0005), scale * scale * 1.25)  # e is 2/5 of it
    distance = scale * scale / (0.8 * half)
    scene = scene_with((Sphere((0.0, 0.0, -1.0), 1.0), SHINY))
    scene.add_light(DirectionalLight((0.25, 0.25, -1.0), 0.7))
    scene.camera = Camera((-distance, 0.0, 0.0), (1.0, 0.0, 0.0), fov=math.degrees(2 * half))
    return scene
