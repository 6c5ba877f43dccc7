"""Coincident surfaces: the lowest object id wins, whatever the order in which things entered."""

import itertools

import numpy as np
import pytest
from tests.support.support_light import EMITTER_AMBIENT, Picture, core_render, emitter

import raybound as rb

COLOURS = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0)]
CAM = rb.Camera((1.3, -4, 2.2), (0, 0, 0), fov=35, width=48, height=48)
BOX = rb.Box((-1, -1, -1), (1, 1, 1))
COINCIDENT = {
    "spheres": [rb.Sphere()] * 4,
    "boxes": [BOX] * 4,
    "cylinders": [rb.Cylinder((0, 0, -1), (0, 0, 1))] * 4,
    "cones": [rb.Cone((0, 0, -1), (0, 0, 1))] * 4,
    "disks": [rb.Disk((0, 0, 0), (0.2, -1, 1), radius=1.2)] * 4,
    "polygons": [rb.Polygon([(-1, -1, 0), (1, -1, 0.5), (1, 1, 1), (-1, 1, 0.5)])] * 4,
    "unions": [rb.Sphere() | rb.Box((0, -1, -1), (1, 0, 1))] * 4,
    "intersections": [rb.Sphere((0, 0, 0), 1.2) & BOX] * 4,
}


def render_both(scene: rb.Scene) -> Picture:
    plain, brute = core_render(scene, CAM), core_render(scene, CAM, brute_force=True)
    assert (plain.object_id == brute.object_id).all()
    assert (plain.image == brute.image).all()
    return plain


@pytest.mark.parametrize("name", COINCIDENT)
def test_the_lowest_id_wins_pixel_by_pixel(name: str) -> None:
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    for shape, colour in zip(COINCIDENT[name], COLOURS, strict=True):
        scene.add(shape, emitter(colour))
    seen = render_both(scene).object_id
    assert (seen == 0).sum() > 300
    assert set(np.unique(seen)) == {-1, 0}
    scene.objects[0].remove()
    assert set(np.unique(render_both(scene).object_id)) == {-1, 1}


@pytest.mark.parametrize("order", list(itertools.permutations(range(3))))
def test_edits_in_any_order_do_not_change_who_wins(order: tuple) -> None:
    """Shapes enter elsewhere, and come to coincide in this order; others of other ids are removed between."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    others = [scene.add(rb.Sphere((0, 0, 50)), emitter()) for _ in range(3)]
    handles = [scene.add(rb.Sphere((9, 9, 9), 0.1), emitter(COLOURS[k])) for k in range(3)]
    for k in order:
        handles[k].shape = BOX
        others[k].remove()
        render_both(scene)
    shown = render_both(scene)
    assert set(np.unique(shown.object_id)) == {-1, handles[0].id}
    assert (shown.image[shown.object_id >= 0] == (1, 0, 0)).all()


def test_a_common_face_of_different_shapes() -> None:
    """A slab, a plate and a disk that share the plane z = 1: the lowest id within each one's outline."""
    shapes = [
        rb.Disk((0, 0, 1), (0, 0, 1), radius=0.4),
        rb.Polygon([(-0.7, -0.7, 1), (0.7, -0.7, 1), (0.7, 0.7, 1), (-0.7, 0.7, 1)]),
        rb.Box((-1, -1, 0), (1, 1, 1)),
        rb.Cylinder((0, 0, 0.5), (0, 0, 1), radius=1.5),
    ]
    cam = rb.Camera((0, 0, 5), (0, 0, 0), up=(0, 1, 0), fov=50, width=64, height=64)
    for order in itertools.permutations(range(4)):
        scene = rb.Scene(ambient=EMITTER_AMBIENT)
        for k in order:
            scene.add(shapes[k], emitter(COLOURS[k]))
        seen = core_render(scene, cam).object_id
        assert (seen == core_render(scene, cam, brute_force=True).object_id).all()
        x, y = (cam.rays()[1][..., :2] / -cam.rays()[1][..., 2:] * 4).transpose(2, 0, 1)
        inside = [
            x**2 + y**2 < 0.16,
            np.maximum(abs(x), abs(y)) < 0.7,
            np.maximum(abs(x), abs(y)) < 1,
            x**2 + y**2 < 2.25,
        ]
        expected = np.full(seen.shape, -1)
        for place in reversed(range(4)):
            expected = np.where(inside[order[place]], place, expected)
        assert (seen == expected).mean() > 0.99  # all but pixels whose ray meets a rim or a wall below it
        assert (seen == expected)[np.maximum(abs(x), abs(y)) < 0.35].all()


def test_faces_of_one_object_tie_by_face() -> None:
    """The union of two boxes with a common top: one object, whose lower face id is reported."""
    shape = rb.Box((-1, -1, -1), (0.25, 1, 1)) | rb.Box((-0.25, -1, -1), (1, 1, 1))
    scene = rb.Scene()
    scene.add(shape, emitter())
    x = np.linspace(-0.9, 0.9, 37)
    hits = scene.intersect(np.column_stack([x, 0 * x, 0 * x + 3]), np.broadcast_to([0.0, 0, -1], (37, 3)))
    assert hits["hit"].all()
    assert (hits["t"] == 2).all()
    assert set(hits["face_id"][x < 0.2]) == {5}
    assert set(hits["face_id"][x > 0.3]) == {11}


def test_shadows_and_mirrors_settle_ties_alike() -> None:
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    scene.add(rb.Box((-9, -9, -3), (9, 9, -1.1)), rb.Material(0.2, reflect=0.8))
    for colour in COLOURS:
        scene.add(BOX, emitter(colour))
    scene.add_light(rb.PointLight((3, -3, 6)))
    shown = render_both(scene)
    reflected = (shown.object_id == 0) & (shown.image[..., 0] > shown.image[..., 1] + 0.3)
    assert reflected.sum() > 50, "the mirror shows red"
    assert not ((shown.object_id == 0) & (shown.image[..., 1] > shown.image[..., 0])).any()
