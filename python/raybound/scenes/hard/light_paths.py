"""Glass and mirrors: touching dielectrics, total internal reflection, and many bounces."""

from __future__ import annotations

import math

from ...camera import Camera
from ...lights import DirectionalLight
from ...materials import Material
from ...scene import Scene
from ...shapes import Box, Sphere
from .registry import Group
from .stage import BLUE, COLOURS, GLASS, GREEN, GREY, RED, SKY, WHITE, YELLOW, Place, chequers, fov_of, scene_with

IOR = 1.5
CLEAR = Material(0.0, transmit=1.0, ior=IOR)

case = Group()


@case(
    "touching-glass",
    "Glass blocks and balls that touch one another and the floor: rays leave one where they enter the next.",
    scale="the unit of the scene, which is 8 units wide",
    default=1.0,
    scales=(1e-3, 1.0, 1e3),
    within=(1e-9, 1e9),
    max_depth=16,
)
def touching_glass(scale: float) -> Scene:
    """Two blocks with a common face, a ball that rests on them, another that touches the first; they cast shadows."""
    place = Place(unit=scale)
    scene = scene_with(*chequers(place, 12, 1.0))
    for shape in (
        place.box((-1.5, 0.0, 0.0), (-0.25, 1.25, 1.0)),
        place.box((-0.25, 0.0, 0.0), (1.0, 1.25, 1.0)),
        place.sphere((-0.25, 0.625, 1.5), 0.5),
        place.sphere((1.0, -0.75, 0.5), 0.5),
        place.sphere((2.0, -0.75, 0.5), 0.5),
    ):
        scene.add(shape, GLASS)
    scene.add(place.sphere((-2.25, 1.5, 0.75), 0.75), RED)
    scene.add_light(place.lamp(-3.0, -4.0, 7.0))
    scene.camera = place.camera((0.5, -5.5, 3.0), (0.0, 0.5, 0.625), fov=42.0)
    return scene


@case(
    "critical-angle",
    "The surface of glass from below, around the critical angle: on one side all light passes, on the other none.",
    scale="the half angle of the view, rad",
    default=1e-1,
    scales=(3e-1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5),
    within=(8.8e-6, 0.5),
)
def critical_angle(scale: float) -> Scene:
    """Steep rays see the sky and a few balls above, flat ones the image of the striped bottom."""
    critical = math.asin(1 / IOR)
    scene = scene_with((Box((-64.0, -64.0, -8.0), (64.0, 64.0, 0.0)), CLEAR))
    for k in range(-24, 64):
        scene.add(Box((k, -60.0, -7.75), (k + 0.5, 60.0, -7.5)), COLOURS[k % len(COLOURS)])
    for k in range(5):
        scene.add(Sphere((0.5 + 1.5 * k, 0.75 * (k % 3 - 1), 0.75), 0.5), (YELLOW, GREEN, RED)[k % 3])
    scene.add_light(DirectionalLight((0.25, 0.5, 1.0), 0.5))
    eye = (-math.tan(critical), 0.0, -1.0)
    scene.camera = Camera(eye, (0.0, 0.0, 0.0), fov=fov_of(scale))
    return scene


@case(
    "light-pipe",
    "A long glass rod: rays that enter at one end go on to the other by total reflection, many times.",
    scale="the length of the rod over its width",
    default=20.0,
    scales=(2.0, 10.0, 30.0, 60.0),
    within=(1.0, 100.0),
    max_depth=64,
)
def light_pipe(scale: float) -> Scene:
    """One looks into the near end; the panel of four colours behind the far end shows in kaleidoscopic order."""
    near, far = 0.0, scale
    scene = Scene(ambient=1.0, background=(0.02, 0.02, 0.03))
    scene.add(Box((-0.5, near, -0.5), (0.5, far, 0.5)), CLEAR)
    for (x, z), material in zip(((-8, -8), (0, -8), (-8, 0), (0, 0)), (RED, YELLOW, BLUE, GREEN), strict=True):
        scene.add(Box((x, far + 0.25, z), (x + 8, far + 0.5, z + 8)), material)
    scene.camera = Camera((0.0625, -0.75, 0.03125), (0.0, 0.0, 0.0), fov=75.0)
    return scene


@case(
    "mirror-corridor",
    "Two parallel mirrors face each other: an image of an image of an image, each in its place.",
    scale="the number of bounces on the way to the end of the corridor, straight ahead",
    default=50.0,
    scales=(5.0, 20.0, 50.0),
    within=(1.0, 64.0),
    max_depth=128,
)
def mirror_corridor(scale: float) -> Scene:
    """Mirrors at x = 0 and 1; a view at 45 degrees to them passes a row of balls and ends in a striped wall."""
    silver = Material(0.0, reflect=(0.985, 0.99, 0.98))
    scene = Scene(ambient=0.9, background=SKY)
    high = 4.0 + scale / 2  # no ray of the view leaves over the mirrors
    for x in (0.0, 1.0):
        corners = [(x, -1.0, -high), (x, scale, -high), (x, scale, high), (x, -1.0, high)]
        scene.add(Place().polygon(corners), silver)
    for k, y in enumerate((1.25, 2.875, 5.125)):
        scene.add(Sphere((0.5, min(y, 0.75 * scale), -0.375), 0.125), COLOURS[k])
    scene.add(Box((-1.0, scale + 0.5, -high), (2.0, scale + 1.0, 0.0)), GREY)
    scene.camera = Camera((0.5, 0.0, 0.0), (1.5, 1.0, 0.0), fov=20.0)
    return scene


@case(
    "mirror-sphere",
    "The inside of a mirrored sphere: errors grow with every bounce of fifty.",
    scale="the radius of the sphere, scene units",
    default=1.0,
    scales=(1e-3, 1.0, 1e4),
    within=(1e-9, 1e9),
    max_depth=50,
)
def mirror_sphere(scale: float) -> Scene:
    """Three small balls within it, and the mirror takes a little light at each bounce."""
    place = Place(unit=scale)
    scene = scene_with((place.sphere((0.0, 0.0, 0.0), 1.0), Material(0.01, reflect=0.95)))
    scene.add(place.sphere((0.25, 0.5, -0.125), 0.125), RED)
    scene.add(place.sphere((-0.375, 0.375, 0.25), 0.0625), WHITE)
    scene.add(place.sphere((-0.25, 0.0, -0.375), 0.1875), BLUE)
    scene.add_light(place.lamp(0.25, -0.5, 0.5))
    scene.camera = place.camera((0.0625, -0.625, 0.0), (0.0, 0.25, 0.0), fov=70.0)
    return scene
