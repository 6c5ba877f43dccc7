"""Points, rims, coincident faces, faces that touch, and rays along them."""

from __future__ import annotations

import itertools

from ...camera import Camera
from ...lights import DirectionalLight, PointLight
from ...scene import Scene
from ...shapes import Box, Cone, Cylinder, Quadric, Sphere
from ...transform import Transform
from .registry import Group
from .stage import BLUE, COLOURS, GREEN, GREY, RED, WHITE, YELLOW, Place, fov_of, power_of_two, scene_with

case = Group()
ZOOMS = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5)


@case(
    "slab-planes",
    "An eye in the planes of many faces: direction components that are zero or denormal, and 0 times infinity.",
    scale="the slope of the view to the plane z = 0; below 1e-38 it is denormal and its reciprocal infinite",
    default=1e-40,
    scales=(1e-45, 1e-40, 1e-30, 1e-15, 1e-7),
    within=(1e-45, 1e-3),
)
def slab_planes(scale: float) -> Scene:
    """Boxes of side 1 that meet at the x axis, along which one looks; an odd picture has rays exactly along it."""
    scene = scene_with()
    cells = itertools.product(range(3), range(-2, 2), range(-2, 2))
    boxes = [(x, y, z) for x, y, z in cells if (x + y + z) % 2 and (x > 0 or abs(2 * y + 1) > 1 or abs(2 * z + 1) > 1)]
    for n, (x, y, z) in enumerate(boxes):
        scene.add(Box((x, y, z), (x + 1, y + 1, z + 1)), COLOURS[n % len(COLOURS)])
    scene.add_light(PointLight((-6.0, 0.0, 0.0), 0.8))  # it too is in the planes of the faces
    scene.camera = Camera((-5.0, 0.0, 0.0), (0.0, 0.0, 5.0 * scale), fov=52.0)
    return scene


@case(
    "cone-apex",
    "The point of a cone from near: there the surface has no normal and the quadratic's coefficients vanish.",
    scale="half the height of what is seen at the apex, over the height of the cone",
    default=1e-2,
    scales=ZOOMS,
    within=(1e-5, 2.0),
)
def cone_apex(scale: float) -> Scene:
    """The apex of the large cone is the origin; a second one's is there too, from above."""
    scene = scene_with(
        (Cone((0.0, 0.0, -1.0), (0.0, 0.0, 0.0), radius=0.5), YELLOW),
        (Cone((0.25, 0.0, 1.0), (0.0, 0.0, 0.0), radius=0.25), BLUE),
        (Box((-2.0, -2.0, -1.25), (2.0, 2.0, -1.0)), GREY),
    )
    scene.add_light(DirectionalLight((0.5, 1.0, -0.5), 0.8))
    scene.camera = Camera((0.0, -4.0, 0.5), (0.0, 0.0, 0.0), fov=fov_of(scale / 4))
    return scene


@case(
    "cylinder-rim",
    "The edge between the cap and the side of a cylinder from near: no gap, and light on the cap only.",
    scale="half the height of what is seen at the rim, over the radius of the cylinder",
    default=1e-2,
    scales=ZOOMS,
    within=(1e-5, 2.0),
)
def cylinder_rim(scale: float) -> Scene:
    """The rim passes through the origin; the sun shines along the cylinder."""
    scene = scene_with(
        (Cylinder((0.0, 1.0, -1.0), (0.0, 1.0, 0.0), radius=1.0), RED),
        (Cylinder((0.0, 1.0, 0.0), (0.0, 1.0, 0.5), radius=0.5), GREEN),
    )
    scene.add_light(DirectionalLight((0.0, 0.0, -1.0), 0.7))
    scene.camera = Camera((-0.5, -4.0, 2.0), (0.0, 0.0, 0.0), fov=fov_of(scale / 4.5))
    return scene


@case(
    "csg-coincident",
    "Unions and intersections whose parts share faces: one surface, without inner walls or speckles.",
    scale="the coordinate x at which all of it lies, scene units",
    default=1.0,
    scales=(1.0, 1e2, 1e4, 1e6),
    within=(0.0, 1e9),
)
def csg_coincident(scale: float) -> Scene:
    """Boxes with common faces, a cylinder that ends in a box's face, a ball that touches a box's faces from inside."""
    place = Place((scale, 0.0, 0.0), max(1.0, power_of_two(max(scale, 1.0)) * 2.0**-14))
    box = place.box
    stairs = box((-3.5, 0, 0), (-2.5, 1, 1)) | box((-2.5, 0, 0), (-1.5, 1, 1)) | box((-3.5, 0, 1), (-2.5, 1, 2))
    pillar = box((-0.5, 0, 0), (0.5, 1, 1)) | place.cylinder((0, 0.5, 1), (0, 0.5, 2.25), 0.375)
    slice_ = place.sphere((2.0, 0.5, 1.0), 1.0) & box((1.0, -0.5, 0.0), (3.0, 0.5, 2.0))
    same = box((3.5, 0, 0), (4.5, 1, 1)) & box((3.5, 0, 0), (4.5, 1, 1.5)) & box((3.0, 0, 0), (4.5, 1, 1))
    scene = scene_with((stairs, RED), (pillar, YELLOW), (slice_, BLUE), (same, GREEN), (place.floor(12.0), GREY))
    scene.add_light(place.lamp(-2.0, -6.0, 7.0))
    scene.camera = place.camera((-1.0, -6.5, 3.5), (0.5, 0.5, 0.75), fov=48.0)
    return scene


@case(
    "touching-boxes",
    "A wall of boxes that touch at coordinates which are not exact: no light comes through, and the joints are hit.",
    scale="the side of a box, scene units; three of them make 1 only in exact arithmetic",
    default=1 / 3,
    scales=(1e-6 / 3, 1e-3 / 3, 1 / 3, 1e3 / 3, 1e6 / 3),
    within=(1e-9, 1e9),
)
def touching_boxes(scale: float) -> Scene:
    """Seen in the shadow of a light behind it; a floor before it shows any light that leaks."""
    place = Place(unit=scale)
    scene = scene_with((place.polygon([(-9, -9, -3), (9, -9, -3), (9, 0, -3), (-9, 0, -3)]), WHITE))
    for n, (i, k) in enumerate(itertools.product(range(-4, 4), range(-3, 3))):
        scene.add(place.box((i, 0, k), (i + 1, 0.5, k + 1)), COLOURS[(n + n // 6) % len(COLOURS)])
    scene.add_light(place.lamp(0.375, 4.0, -0.25))
    scene.camera = place.camera((0.0, -7.0, 1.0), (0.0, 0.0, -0.5), fov=55.0)
    return scene


@case(
    "quadric-clip",
    "Quadrics cut by the planes of their boxes: a double cone's apex, a waist that nearly closes, a shallow bowl.",
    scale="the waist of the hyperboloid and the depth of the bowl, over their width",
    default=1e-2,
    scales=(0.5, 1e-1, 1e-2, 1e-4, 1e-6),
    within=(1e-7, 1.0),
)
def quadric_clip(scale: float) -> Scene:
    """Solids {A x^2 + B y^2 + C z^2 + D x y + E y z + F x z + G x + H y + I z + J <= 0} within a box."""
    unit = Box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
    double_cone = Quadric((1, 1, -1, 0, 0, 0, 0, 0, 0, 0), clip=unit)
    waist = Quadric((1, 1, -1, 0, 0, 0, 0, 0, 0, -scale * scale), clip=unit)
    bowl = Quadric((-scale, -scale, 0, 0, 0, 0, 0, 0, 1, 0), clip=Box((-1.0, -1.0, -0.5), (1.0, 1.0, 1.0)))
    scene = scene_with((Place().floor(12.0, -1.0), GREY), (Sphere((2.5, -1.5, -0.625), 0.375), RED))
    for shape, x, material in ((double_cone, -2.5, YELLOW), (waist, 0.0, GREEN), (bowl, 2.5, BLUE)):
        scene.add(shape, material, transform=Transform.translate(x, 0.5, 0.0))
    scene.add_light(DirectionalLight((0.5, 1.0, -1.25), 0.8))
    scene.camera = Camera((0.0, -7.0, 2.0), (0.0, 0.0, -0.25), fov=45.0)
    return scene
