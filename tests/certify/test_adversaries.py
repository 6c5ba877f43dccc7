"""Scenes made for each way in which a certificate might say yes wrongly (certified-interpolants 9, the table)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from tests.support.support_exact import Tally, compare

import raybound as rb

WHITE = rb.Material((0.8, 0.7, 0.6), specular=0.3)
MIRROR = rb.Material(0.2, reflect=0.7)
GLASS = rb.Material(0.1, transmit=0.8, reflect=0.1)
FLOOR = rb.Polygon([(-4, -4, 0), (4, -4, 0), (4, 4, 0), (-4, 4, 0)])
LAMP = rb.PointLight((1.0, -0.5, 3.0))
SUN = rb.DirectionalLight((0.4, 0.2, -1.0))


def faces_at_an_edge(scene: rb.Scene) -> None:
    """A cell beyond a face's edge must not serve the neighbour; eyes inside and outside."""
    scene.add(rb.Box((-1, -1, 0), (1, 1, 1)), WHITE)
    scene.add(rb.Box((0.999, -1, 1), (1.2, 1, 1.4)), WHITE)


def the_object_itself(scene: rb.Scene) -> None:
    """What is exempt from the outside only: insides of spheres, unions, quadrics that see themselves."""
    scene.add(rb.Sphere((0, 0, 1), 0.9), GLASS)
    scene.add(rb.Union(rb.Box((-2.4, -0.5, 0), (-1.4, 0.5, 1)), rb.Box((-2, -0.2, 0.8), (-1.7, 0.2, 1.8))), WHITE)
    saddle = rb.Quadric((1, 1, -1, 0, 0, 0, 0, 0, 0, -0.05), rb.Box((-0.7, -0.7, -0.7), (0.7, 0.7, 0.7)))
    scene.add(saddle, WHITE, transform=rb.Transform.translate(2, 0, 0.8))
    scene.add(rb.Quadric((1, 2, 3, 0, 0, 0, 0, 0, 0, -0.3), rb.Box((-1, -1, -1), (1, 1, 1))), WHITE).move(
        rb.Transform.translate(0, 2, 0.6)
    )


def behind_the_light(scene: rb.Scene) -> None:
    """Objects just behind lights and just behind origins block nothing."""
    scene.add(rb.Box((0.5, -1, 3.0005), (1.5, 0, 3.2)), WHITE)  # half a millimetre above the lamp
    scene.add(rb.Sphere((1.0, -0.5, 3.05), 0.0499), WHITE)
    scene.add(rb.Box((-1, -1, -0.3), (1, 1, -1e-6)), WHITE)  # below the floor
    scene.add(rb.Disk((1.0, -0.5, 2.999), (0, 0, 1), radius=0.02), WHITE)  # and this one does


def coincident_surfaces(scene: rb.Scene) -> None:
    """Faces in one plane: whoever comes first by id is hit, in lists as in searches."""
    scene.add(rb.Box((-1, -1, 0), (0, 0, 0.7)), WHITE)
    scene.add(rb.Box((0, -1, 0), (1, 0, 0.7)), MIRROR)
    scene.add(rb.Box((-0.5, -1, 0), (0.5, 0, 0.7)), rb.Material((0.9, 0.1, 0.1)))
    scene.add(FLOOR, rb.Material((0.1, 0.1, 0.9)))


def lights_in_the_way(scene: rb.Scene) -> None:
    """Lights on a surface, inside a solid, in the plane of a polygon, and all but in it."""
    scene.add(rb.Sphere((-1, 0, 0.6), 0.5), WHITE)
    scene.add_light(rb.PointLight((-1, 0, 1.1)))
    scene.add_light(rb.PointLight((-1, 0, 0.6)))
    scene.add(rb.Polygon([(0.5, -1, 0.5), (2, -1, 0.5), (2, 1, 0.9), (0.5, 1, 0.9)]), WHITE)
    scene.add_light(rb.PointLight((1, 2, 1.1)))
    scene.add_light(rb.PointLight((1, 2.0000002, 1.1000001)))
    scene.add_light(rb.PointLight((0, 0, 0)))
    scene.add_light(rb.SpotLight((0, 0, 2), (0, 0.2, -1), cutoff=12))


def inner_walls(scene: rb.Scene) -> None:
    """Walls within unions hide nothing, and intersections only what all parts hide."""
    bar = rb.Cylinder((-1, 0, 0.6), (1, 0, 0.6), radius=0.4)
    other = rb.Cylinder((0, -1, 0.6), (0, 1, 0.6), radius=0.4)
    scene.add(rb.Union(bar, other, rb.Sphere((0, 0, 0.6), 0.5)), GLASS)
    scene.add(rb.Intersection(rb.Sphere((2, 0, 0.6), 0.6), rb.Sphere((2.5, 0, 0.6), 0.6)), WHITE)


def mirrors_face_to_face(scene: rb.Scene) -> None:
    """Cells seen at great depths, and from both sides of a sheet."""
    scene.add(rb.Polygon([(-2, 2, 0), (2, 2, 0), (2, 2, 2), (-2, 2, 2)]), MIRROR)
    scene.add(rb.Polygon([(-2, -2.2, 0), (2, -2, 0), (2, -2, 2), (-2, -2.2, 2)]), MIRROR)
    scene.add(rb.Sphere((0, 0.5, 0.5), 0.4), MIRROR)
    scene.add(rb.Disk((0.8, 0, 0.8), (0.5, 0.5, 1), radius=0.6), WHITE)


def crowds(scene: rb.Scene) -> None:
    """Lists that stay long, of needles, coins and crumbs."""
    rng = np.random.default_rng(9)
    for k in range(150):
        stretch = rb.Transform.scale(tuple((10.0 ** rng.uniform(-2.5, -0.3, 3)).tolist()))
        turn = rb.Transform.rotate(float(rng.uniform(0, 360)), axis=tuple(rng.normal(size=3).tolist()))
        place = rb.Transform.translate(*rng.uniform((-2, -2, 0.1), (2, 2, 2)).tolist())
        shapes = (rb.Sphere((0, 0, 0), 1), rb.Box((-1, -1, -1), (1, 1, 1)), rb.Cone((0, 0, -1), (0, 0, 1), radius=1))
        scene.add(shapes[k % 3], WHITE, transform=place @ turn @ stretch)


def touching_spheres(scene: rb.Scene) -> None:
    """Balls that touch, like those in which a blocker was lost once."""
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            scene.add(rb.Sphere((x * 0.8, y * 0.8, 0.4), 0.4), rb.Material((0.7, 0.5, 0.3), reflect=0.3))


SCENES = (
    faces_at_an_edge,
    the_object_itself,
    behind_the_light,
    coincident_surfaces,
    lights_in_the_way,
    inner_walls,
    mirrors_face_to_face,
    crowds,
    touching_spheres,
)


@pytest.mark.parametrize("where", [(0.0, 1.0), (1000.0, 1.0), (0.0, 2.0**-40), (0.0, 2.0**40)], ids=str)
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_adversaries(make: Callable[[rb.Scene], None], where: tuple[float, float]) -> None:
    """At home, far from the origin, tiny and huge; from outside and from within; after each object has moved."""
    far, scale = where
    scene, tally = rb.Scene(ambient=0.1, background=(0.2, 0.3, 0.4)), Tally()
    scene.add(FLOOR, rb.Material((0.6, 0.6, 0.5)))
    scene.add_light(LAMP)
    scene.add_light(SUN)
    make(scene)
    move = rb.Transform.scale(scale) @ rb.Transform.translate(far, -far, far)
    for handle in scene.objects:
        handle.move(move)
    matrix = np.asarray(move.matrix)

    def placed(p: object) -> tuple[float, ...]:
        return tuple((matrix @ np.append(np.asarray(p, float), 1))[:3].tolist())

    for lamp in scene.lights:
        if not isinstance(lamp.light, rb.DirectionalLight):
            lamp.light = lamp.light.replace(position=placed(lamp.light.position))
    views = [((0, -6, 3.5), (0, 0, 0.6), 45), ((3, -2, 0.8), (0, 0, 0.5), 60), ((0.05, 0.02, 0.9), (1, 0.3, 0.5), 80)]
    cameras = [rb.Camera(placed(e), placed(t), fov=f, width=128, height=96) for e, t, f in views]
    with rb.Renderer(scene, max_depth=6) as exact, rb.Renderer(scene, method="base", max_depth=6) as base:
        for camera in cameras:
            compare(exact, base, camera, tally, make.__name__)
        for handle in scene.objects[:12]:
            handle.move(rb.Transform.translate(*(np.array((0.11, -0.07, 0.05)) * scale).tolist()))
            compare(exact, base, cameras[0], tally, f"{make.__name__}, moved {handle.id}")
    assert tally.certified > 0
