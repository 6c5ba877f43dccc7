"""What is seen of meshes: (u,v), normals, bounds, lights on them; and that any ray has an answer."""

import time

import numpy as np
import pytest
from tests.shapes.test_extremes import any_rays, check_answers
from tests.support.support_hits import UNIT
from tests.support.support_light import core_render, single_ray_tree
from tests.support.support_meshes import MESHES, globe, kinds_of, mesh_or_none, placed_corners, random_mesh
from tests.support.support_shapes import aimed_rays, f32, unit

import raybound as rb

KINDS = kinds_of(MESHES)


@pytest.mark.parametrize("kind", kinds_of(["blob", "gem"]))
def test_bounds_hold_all_points(kind: str) -> None:
    rng = np.random.default_rng(92)
    hits = 0
    for _ in range(60):
        size = 10 ** rng.uniform(-4, 4)
        shape = random_mesh(rng, kind, size, size * rng.normal(size=3))
        answers = rb.intersect(shape, *aimed_rays(rng, shape, 100, 3))
        points, (low, high) = answers["point"][answers["hit"]], shape.bounds
        reach = np.abs(shape.bounds).max()
        assert np.maximum(low - points, points - high).max(initial=-1) <= 4 * UNIT * reach
        corners = np.array(placed_corners(shape), float).reshape(-1, 3)
        assert np.abs(corners.min(axis=0) - low).max() <= 4 * UNIT * reach
        assert np.abs(corners.max(axis=0) - high).max() <= 4 * UNIT * reach
        hits += len(points)
    assert hits >= 1000


@pytest.mark.parametrize("meshes", [150, pytest.param(10_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", [f"{kind}{smooth}" for kind in KINDS for smooth in ("", "+smooth")])
def test_every_ray_has_a_clean_answer(kind: str, meshes: int) -> None:
    """Any finite ray at meshes from 2**-58 to 2**58: no NaN, nothing infinite where there is a hit."""
    rng = np.random.default_rng(93)
    rays = hits = 0
    for _ in range(meshes):
        place = rng.normal(size=3) * 2 ** rng.uniform(-58, 57) * (rng.random() < 0.7)
        shape = mesh_or_none(rng, kind, 2 ** rng.uniform(-58, 58), place)
        if shape is not None:
            answers = check_answers(shape, *any_rays(rng, shape, 60))
            rays, hits = rays + len(answers), hits + int(answers["hit"].sum())
    assert rays >= 20 * meshes
    assert hits >= 2 * meshes


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_convex_mirrors_reflect_once(precision: str) -> None:
    """All that a convex mesh reflects leaves it: as many reflected rays as hits, at any depth allowed."""
    rng = np.random.default_rng(94)
    hits = 0
    for _ in range(40):
        size = 10 ** rng.uniform(-5, 5)
        center = size * rng.normal(size=3) * 10 ** rng.uniform(-2, 2)
        kind = str(rng.choice(["gem", "crate", "tetrahedron"])) + str(rng.choice(["", "+affine"]))
        scene = rb.Scene(ambient=0.1)
        scene.add(random_mesh(rng, kind, size, center), rb.Material(0.2, reflect=0.7))
        cam = rb.Camera(tuple(center + 6 * size * unit(rng)), tuple(center), width=40, height=30, up=(0.3, 1, 0.2))
        picture = core_render(scene, cam, precision=precision, max_depth=6)
        seen = int((picture.object_id == 0).sum())
        assert picture.rays["reflected"] == seen
        hits += seen
    assert hits >= 2000


def quad(**extra: object) -> rb.Mesh:
    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
    return rb.Mesh(corners, [(0, 1, 2), (0, 2, 3)], **extra)


def test_uv_is_interpolated() -> None:
    rng = np.random.default_rng(95)
    points = rng.uniform(0, 2, (500, 2))
    rays = np.insert(points, 2, 3.0, axis=1), np.broadcast_to((0.0, 0.0, -1.0), (500, 3))
    mapped = rb.intersect(quad(uvs=[(0, 0), (1, 0), (1, 1), (0, 1)]), *rays)
    assert np.abs(mapped["uv"] - f32(points) / 2).max() < 1e-6
    plain = rb.intersect(quad(), *rays)
    first = plain["face_id"] == 0
    expected = np.where(first[:, None], points @ [[0.5, 0], [-0.5, 0.5]], points @ [[0.5, -0.5], [0, 0.5]])
    assert np.abs(plain["uv"] - expected).max() < 1e-6
    assert 100 < first.sum() < 400
    wide = rb.intersect(quad(uvs=[(0, 0), (7, 0), (7, -5), (0, -5)]), *rays)
    assert np.abs(wide["uv"] - points * (3.5, -2.5)).max() < 1e-5


@pytest.mark.parametrize("stretch", [(1, 1, 1), (-1, 1, 1), (0.5, 3, -2)])
def test_normals_are_smooth_two_sided_and_stay_outside(stretch: tuple[float, ...]) -> None:
    """A ball of triangles with the normals of the ball: its shading is that of an ellipsoid, in mirrors too."""
    rng = np.random.default_rng(96)
    points, faces = smooth_ball(24)
    ball = rb.Mesh(points, faces, normals=points).transformed(rb.Transform.scale(stretch))
    ways = unit(rng, 2000)
    hits = rb.intersect(ball, f32(ways * stretch * 3), f32(-ways * stretch))
    assert hits["hit"].all()
    true = hits["point"] / np.square(stretch)
    true /= np.linalg.norm(true, axis=1, keepdims=True)
    assert np.sum(hits["normal"] * true, axis=1).min() > 0.995
    inner = rb.intersect(ball, np.zeros((2000, 3)), f32(ways * stretch))
    assert np.sum(inner["normal"] * ways * stretch, axis=1).min() > 0  # outward, from inside too
    near = f32(ways + 1e-3 * unit(rng, 2000)) * f32(stretch)
    beside = rb.intersect(ball, near * 3, -near)
    step = np.abs(beside["normal"] - hits["normal"]).max(axis=1)
    crossed = beside["face_id"] != hits["face_id"]
    assert step.max() < 0.02  # across edges as well
    assert crossed.sum() >= 3
    flat = rb.intersect(rb.Mesh(points, faces), f32(ways * 3), f32(-ways))["normal"]
    assert len(np.unique(np.round(flat, 4), axis=0)) <= len(faces)


def smooth_ball(n: int) -> tuple[np.ndarray, np.ndarray]:
    points, faces = globe(np.random.default_rng(0), n, (0, 0, 0), 1.0)
    return points / np.linalg.norm(points, axis=1, keepdims=True), faces


def test_normals_against_the_face_are_turned_and_opposite_ones_ignored() -> None:
    down = quad(normals=[(0, 0, -3)] * 4)
    split = quad(normals=[(0, 0, 1), (0, 0, -1), (0, 0, 1), (0, 0, -1)])
    for mesh in (down, split):
        hits = rb.intersect(mesh, [(1.5, 0.5, 1), (0.5, 1.5, -1), (1, 0.5, 1)], [(0, 0, -1), (0, 0, 1), (0, 0, -1)])
        assert hits["normal"].tolist() == [[0, 0, 1]] * 3


def test_lights_on_a_mesh_and_beside_it() -> None:
    """A light exactly on a mesh lights both of its sides; one a float above lights one."""
    for height, lit in ((0.0, (True, True)), (float(np.float32(1e-6)), (True, False)), (-1e-6, (False, True))):
        for side, expected in zip((1, -1), lit):
            scene = rb.Scene()
            scene.add(quad(), rb.Material(0))
            wall = rb.Box((-9, -9, 3), (9, 9, 4)) if side > 0 else rb.Box((-9, -9, -4), (9, 9, -3))
            scene.add(wall, rb.Material(1))
            scene.add_light(rb.PointLight((1.3, 0.4, height), 1))
            tree = single_ray_tree(scene, (7, 3, side * 1.0), (7, 3, side * 3.0))
            assert (tree["lights"][0]["verdict"] == "lit") == expected, (height, side)


def test_scales_beyond_2_to_60_are_refused() -> None:
    mesh = quad()
    for scale in (2.0**31, 2.0**-31):
        half = rb.Transform.scale((1, 1, scale))
        rb.intersect(mesh.transformed(half), [(0, 0, 1)], [(0, 0, -1)])
        with pytest.raises(ValueError, match="Mesh: transforms must"):
            rb.intersect(mesh.transformed(half).transformed(half), [(0, 0, 1)], [(0, 0, -1)])
    scene = rb.Scene()
    added = scene.add(mesh.transformed(half), rb.Material())
    with pytest.raises(ValueError, match="Mesh: transforms must"):
        added.transform = half
    assert scene.intersect([(1, 0.5, 1)], [(0, 0, -1)])["hit"].all()


def test_moving_a_large_mesh_is_cheap() -> None:
    """Placed again and again, its vertices are not looked at anew beyond their bounds."""
    points, faces = smooth_ball(150)
    scene = rb.Scene()
    start = time.perf_counter()
    added = scene.add(rb.Mesh(points, faces), rb.Material())
    scene.intersect([(0, 0, 9)], [(0, 0, -1)])
    built = time.perf_counter() - start
    start = time.perf_counter()
    for k in range(5):
        added.transform = rb.Transform.translate(0, 0, k)
        assert scene.intersect([(0, 0, 9)], [(0, 0, -1)])["t"][0] == pytest.approx(8 - k, abs=1e-3)
    assert (time.perf_counter() - start) / 5 < built / 3
