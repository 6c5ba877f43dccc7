"""Shadows at contacts, under grazing light, and of surfaces that carry a light."""

from __future__ import annotations

from ...camera import Camera
from ...lights import DirectionalLight, PointLight
from ...scene import Scene
from ...shapes import Box, Cone, Cylinder, Sphere
from .registry import Group
from .stage import BLUE, GREEN, GREY, RED, WHITE, YELLOW, Place, fov_of, scene_with

case = Group()


@case(
    "contact-shadow",
    "A ball rests on a plane: its shadow begins at the point of contact, however near one looks.",
    scale="half the height of what is seen at the contact, over the radius of the ball",
    default=1e-2,
    scales=(1.0, 1e-1, 1e-2, 1e-3, 1e-4),
    within=(2e-5, 2.0),
)
def contact_shadow(scale: float) -> Scene:
    """The contact is the origin, the ball has radius 1, the light comes from the right; one looks into the gap."""
    scene = scene_with((Place().floor(8.0), WHITE), (Sphere((0.0, 0.0, 1.0), 1.0), RED))
    scene.add_light(DirectionalLight((-1.0, 0.25, -0.5), 0.8))
    lift = min(0.25, scale / 2)  # flat enough to see below the ball
    scene.camera = Camera((0.0, -2.0, lift), (0.0, 0.0, 0.0), fov=fov_of(scale / 2))
    return scene


@case(
    "grazing-light",
    "Light that grazes a floor: all of it is lit but for long shadows, without speckles.",
    scale="the slope of the light to the floor",
    default=1e-2,
    scales=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7),
    within=(1e-9, 0.5),
)
def grazing_light(scale: float) -> Scene:
    """A low wall, a ball and a cone stand on the floor; the light is as bright as its slope leaves it."""
    height = min(1.0, 5 * scale)
    scene = scene_with((Place().floor(8.0), GREY), (Box((-4.0, -1.0, 0.0), (-3.75, 3.0, height)), BLUE))
    scene.add(Sphere((-1.0, -2.0, 0.5), 0.5), RED)
    scene.add(Cone((-1.0, 4.0, 0.0), (-1.0, 4.0, 1.0), radius=0.5), YELLOW)
    scene.add_light(DirectionalLight((1.0, 0.0, -scale), 0.8 / scale))
    scene.camera = Camera((0.0, -9.0, 7.0), (0.0, 0.0, 0.0), fov=50.0)
    return scene


@case(
    "light-on-surface",
    "Point lights all but on a ball, a box and a disk: they light what they face and do not shine through.",
    scale="the height of the lights above the surfaces, scene units",
    default=1e-4,
    scales=(1e-1, 1e-2, 1e-4, 1e-6),
    within=(1e-7, 0.5),
)
def light_on_surface(scale: float) -> Scene:
    """The lights are exactly above the tops of a ball, a box and a cylinder; the floor is in their shadow."""
    scene = scene_with((Place().floor(8.0), GREY), (Place().polygon(WALL), WHITE))
    scene.add(Sphere((-2.0, 0.0, 0.5), 0.5), RED)
    scene.add(Box((-0.5, -0.5, 0.0), (0.5, 0.5, 1.0)), BLUE)
    scene.add(Cylinder((2.0, 0.0, 0.0), (2.0, 0.0, 1.0), radius=0.5), GREEN)
    for x in (-2.0, 0.0, 2.0):
        scene.add_light(PointLight((x, 0.0, 1.0 + scale), 0.5))
    scene.camera = Camera((0.5, -6.0, 3.5), (0.0, 0.5, 1.0), fov=50.0)
    return scene


WALL = [(-8.0, 2.5, 0.0), (8.0, 2.5, 0.0), (8.0, 2.5, 8.0), (-8.0, 2.5, 8.0)]
