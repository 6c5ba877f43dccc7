"""Rays from hits, every crossing of a ray, and the solids around points."""

import numpy as np
import pytest
from tests.support.marching import KINDS, random_march
from tests.support.random_scenes import random_scene
from tests.support.support_shapes import unit

import raybound as rb

LAMP = (3.0, 4.0, 9.0)


def ball_scene() -> rb.Scene:
    scene = rb.Scene()
    scene.add(rb.Sphere(), rb.Material())
    return scene


def test_a_picture_of_records() -> None:
    scene = ball_scene()
    camera = rb.Camera((0, -4, 0), (0, 0, 0), width=20, height=10)
    hits = scene.intersect(*camera.rays())
    assert hits.shape == (10, 20)
    assert hits["hit"].any()
    assert not hits["hit"].all()
    assert (hits["entering"] == hits["hit"]).all()
    assert (hits["within_id"] == -1).all()
    flat = scene.intersect(camera.rays()[0].reshape(-1, 3), camera.rays()[1].reshape(-1, 3))
    assert (flat == hits.ravel()).all()
    assert scene.intersect((0, -4, 0), camera.rays()[1]).shape == (10, 20)
    assert scene.occluded(hits, LAMP).shape == (10, 20)
    assert scene.intersect((0, -4, 0), (0, 1, 0)).shape == ()


@pytest.mark.parametrize("points", [100_000, pytest.param(1_000_000, marks=pytest.mark.soak)])
def test_convex_solids_never_hide_a_point_from_its_own_side(points: int) -> None:
    """The near side sees the lamp, the far side does not: by the sign of the normal's angle to it alone."""
    rng = np.random.default_rng(2)
    convex = {
        "sphere": rb.Sphere(),
        "box": rb.Box(),
        "cylinder": rb.Cylinder(),
        "cone": rb.Cone(),
        "frustum": rb.Cone(top_radius=0.4),
    }
    for shape in convex.values():
        for far, least in ((0, 1e-3), (4e4, 0.02)):  # (far away points are rounded along the surface, too)
            scene = rb.Scene()
            scene.add(shape, rb.Material(), transform=rb.Transform.translate(far / 40, -far, far / 500))
            count = points // (2 * len(convex))
            middle = np.mean(scene.bounds, axis=0)
            origins = middle + 6 * unit(rng, count)
            hits = scene.intersect(origins, middle + rng.uniform(-0.4, 0.4, (count, 3)) - origins)
            lamps = middle + 20 * unit(rng, count)
            toward = lamps.astype(np.float32).astype(float) - hits["point"]
            facing = np.einsum("ij,ij->i", hits["normal"].astype(float), toward) / 20
            sure = hits["hit"] & (np.abs(facing) > least)
            hidden = scene.occluded(hits, lamps)
            assert sure.sum() > 0.5 * count
            assert not hidden[sure & (facing > 0)].any()  # no false self-hit
            assert hidden[sure & (facing < 0)].all()  # the far side always
            back = scene.intersect(hits, origins - hits["point"])
            assert not back["hit"].any()


def test_rays_from_hits_go_to_either_side() -> None:
    scene = ball_scene()
    hit = scene.intersect((0, -4, 0), (0, 1, 0))
    assert not scene.intersect(hit, (0, -1, 0))["hit"]
    inner = scene.intersect(hit, (0, 1, 0))
    assert inner["hit"]
    assert not inner["entering"]
    assert inner["within_id"] == 0
    assert abs(inner["t"] - 2) < 1e-6
    out = scene.intersect(inner, (0, 1, 0))
    assert not out["hit"]
    assert not scene.intersect(out, (0, 1, 0))["hit"]  # a miss starts no ray
    assert not scene.occluded(out, LAMP)
    with rb.Renderer(scene) as renderer:
        assert renderer.trace(hit, (0, -1, 0)).object_id == -1
        assert renderer.trace(hit, (0, 1, 0)).object_id == 0
        assert renderer.trace(np.stack([hit, out]), (0, 1, 0)).object_id.tolist() == [0, -1]


@pytest.mark.parametrize("empty", [[], np.empty((0, 3)), np.empty((4, 0, 3))])
def test_empty_lists_give_empty_answers(empty: object) -> None:
    scene = ball_scene()
    shape = np.shape(empty)[:-1] if np.ndim(empty) > 1 else (0,)
    assert scene.intersect(empty, empty).shape == shape
    assert scene.occluded(empty, empty).shape == shape
    records, offsets = scene.intersect_all(empty, empty)
    assert len(records) == 0
    assert offsets.tolist() == [0]
    ids, offsets = scene.containing(empty)
    assert len(ids) == 0
    assert offsets.tolist() == [0]
    with rb.Renderer(scene) as renderer:
        assert renderer.trace(empty, empty).radiance.shape == (*shape, 3)
        assert len(renderer.paths(empty, empty)) == 0
    assert rb.Sphere().contains(empty).shape == shape


def test_every_crossing_in_order() -> None:
    scene = rb.Scene()
    glass = rb.Material(transmit=0.9)
    scene.add(rb.Box((0, -1, -1), (1, 1, 1)), glass)
    scene.add(rb.Box((1, -1, -1), (2, 1, 1)), glass)
    scene.add(rb.Disk((3, 0, 0), (1, 0, 0)), glass)
    scene.add(rb.Sphere((6, 0, 0)) - rb.Sphere((6, 0, 0), 0.5), glass)
    records, offsets = scene.intersect_all([(-1, 0, 0), (1.5, 0, 0), (0, 5, 0)], (2, 0, 0))
    assert offsets.tolist() == [0, 9, 15, 15]
    assert records["object_id"].tolist() == [0, 0, 1, 1, 2, 3, 3, 3, 3, 1, 2, 3, 3, 3, 3]
    assert np.allclose(records["t"][:9], np.array([1, 2, 2, 3, 4, 6, 6.5, 7.5, 8]) / 2, atol=1e-6)
    assert records["entering"][:9].tolist() == [True, False, True, False, False, True, False, True, False]
    assert records["touching"].sum() == 1
    assert records["within_id"][2] == 0
    again = scene.intersect(records[2:3], (1, 0, 0))
    assert again["object_id"] == 1
    assert not again["entering"]


@pytest.mark.parametrize("kind", KINDS)
def test_all_crossings_alternate(kind: str) -> None:
    """For each solid; and a ray's first one is the closest hit, its count that of a march."""
    crossings = 0
    for seed in range(12):
        found = random_march(kind, np.random.default_rng([seed, 5]), 300)
        scene = found.scene()
        records, offsets = scene.intersect_all(found.origins, found.directions)
        starts = np.diff(scene.containing(found.origins)[1]) == 1
        first = scene.intersect(found.origins, found.directions)
        assert (np.diff(offsets) > 0).tolist() == first["hit"].tolist()
        for i in range(len(starts)):
            row = records[offsets[i] : offsets[i + 1]]
            expected = np.arange(len(row)) % 2 == (1 if starts[i] else 0)
            assert (row["entering"] == expected).all(), f"seed {seed}, ray {i}"
            assert (np.diff(row["t"]) >= 0).all()
            assert len(row) % 2 == starts[i]
            if len(row):
                assert row[0]["t"] == first[i]["t"]
        crossings += len(records)
    assert crossings > 1500


def test_points_in_solids() -> None:
    scene = rb.Scene()
    scene.add(rb.Box(), rb.Material())
    scene.add(rb.Sphere((1, 0, 0)), rb.Material())
    scene.add(rb.Disk(), rb.Material())
    points = [[(0, 0, 0.5), (0.5, 0, 0.1)], [(1.5, 0, 0), (9, 9, 9)]]
    ids, offsets = scene.containing(points)
    assert offsets.tolist() == [0, 1, 3, 4, 4]
    assert ids.tolist() == [0, 0, 1, 1]
    assert rb.Sphere().contains(points).tolist() == [[True, True], [False, False]]
    assert (rb.Box() - rb.Sphere()).contains([(0.9, 0.9, 0.9), (0, 0, 0)]).tolist() == [True, False]
    for sheet in (rb.Disk(), rb.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])):
        with pytest.raises(ValueError, match=r"contains: the shape must be closed, got"):
            sheet.contains((0, 0, 0))
    with pytest.raises(ValueError, match=r"Sphere\.contains: points must be .*\(\.\.\., 3\)"):
        rb.Sphere().contains((0, 0))
    with pytest.raises(ValueError, match=r"Scene\.containing: points must be finite"):
        scene.containing((0, 0, np.nan))


def test_containing_is_the_parity_of_crossings() -> None:
    inside = 0
    for seed in (2, 5, 8, 11):
        scene = random_scene(seed)
        rng = np.random.default_rng(seed)
        points = rng.uniform(-3, 3, (600, 3)).astype(np.float32)
        ids, offsets = scene.containing(points)
        records, ends = scene.intersect_all(points, unit(rng, 600))
        for i in range(600):
            row = records[ends[i] : ends[i + 1]]
            balance = {int(k): 0 for k in row["object_id"]}
            for record in row:
                balance[int(record["object_id"])] += -1 if record["entering"] else 1
            closed = {k for k, count in balance.items() if count == 1 and not is_open(scene, k)}
            assert closed == set(ids[offsets[i] : offsets[i + 1]].tolist()), f"seed {seed}, point {i}"
            inside += len(closed)
    assert inside > 100


def is_open(scene: rb.Scene, id: int) -> bool:
    shape = next(item.shape for item in scene.objects if item.id == id)
    while hasattr(shape, "transform"):
        shape = shape.shape
    return isinstance(shape, (rb.Disk, rb.Polygon))


def refused(scene: rb.Scene, records: object, what: str, kind: type = ValueError) -> None:
    for who, call in (
        ("Scene.intersect", lambda: scene.intersect(records, (0, 0, 1))),
        ("Scene.intersect_all", lambda: scene.intersect_all(records, (0, 0, 1))),
        ("Scene.occluded", lambda: scene.occluded(records, LAMP)),
        ("Renderer.trace", lambda: rb.Renderer(scene).trace(records, (0, 0, 1))),
        ("Renderer.paths", lambda: rb.Renderer(scene).paths(records, (0, 0, 1))),
    ):
        with pytest.raises(kind) as caught:
            call()
        assert who in str(caught.value), str(caught.value)
        assert what in str(caught.value), str(caught.value)


def test_records_that_are_not_hits_of_the_scene() -> None:
    scene = ball_scene()
    hits = scene.intersect(-4 * np.eye(3), np.eye(3))
    for name in ("point", "object_id", "face_id", "entering", "normal", "t", "uv", "direction"):
        changed = hits.copy()
        changed[name][1] = 1 - changed[name][1]
        refused(scene, changed, "record 1 has been changed")
    other = rb.Scene()
    other.add(rb.Sphere((0, 0, 0), 2), rb.Material())
    refused(other, hits, "record 0 lies")
    refused(rb.Scene(), hits, "object_id 0")
    scene.objects[0].move(rb.Transform.translate(1, 0, 0))
    refused(scene, hits, "off face 0 of object 0")
    scene.objects[0].remove()
    refused(scene, hits, "object_id 0")
    refused(scene, np.zeros(3, [("x", float)]), "records with the fields x")


def test_shapes_that_do_not_broadcast() -> None:
    scene = ball_scene()
    with pytest.raises(
        ValueError, match=r"Scene\.intersect: origins and directions must broadcast, got shapes \(2, 3\)"
    ):
        scene.intersect(np.ones((2, 3)), np.ones((3, 3)))
    with pytest.raises(ValueError, match=r"Scene\.occluded: origins and targets must broadcast"):
        scene.occluded(scene.intersect(-4 * np.eye(3), np.eye(3)), np.ones((2, 3)))
    with pytest.raises(ValueError, match=r"directions must be non-zero.* at index \(1, 0\)"):
        scene.intersect((0, 0, 0), [[(1, 0, 0)], [(0, 0, 0)]])
    with pytest.raises(
        ValueError, match=r"Renderer\.trace: origins must be an array of numbers with shape \(\.\.\., 3\)"
    ):
        rb.Renderer(scene).trace((0, 0), (1, 0, 0))
