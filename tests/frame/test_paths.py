"""Optics by `Renderer.paths`, against closed forms."""

import numpy as np
import pytest

import raybound as rb

N = float(np.float32(1.5))
GLASS = rb.Material(0.0, transmit=1.0, ior=1.5)


def exits(
    shape: rb.Shape, origins: np.ndarray, way: tuple[float, ...], depth: int = 8
) -> tuple[np.ndarray, np.ndarray]:
    """Where each ray leaves the glass for good, and its way then."""
    scene = rb.Scene()
    scene.add(shape, GLASS)
    with rb.Renderer(scene, max_depth=depth) as renderer:
        paths = renderer.paths(origins, way)
    last = paths[np.isinf(paths["t"]) & (paths["depth"] > 1)]
    assert (last["ray"] == np.arange(len(origins))).all()
    assert np.allclose(last["weight"], 1)
    return last["origin"].astype(float), last["point"].astype(float)


def meets_axis(points: np.ndarray, ways: np.ndarray) -> np.ndarray:
    return points[:, 0] - points[:, 2] * ways[:, 0] / ways[:, 2]


def test_the_focus_of_a_glass_ball() -> None:
    """A ray at height h turns by 2 (i - r): sin i = h, sin r = h / n; it meets the axis at sin i / sin 2(i - r)."""
    h = np.linspace(0.2, 0.9, 15).astype(np.float32)
    points, ways = exits(rb.Sphere(), np.stack([-5 + 0 * h, 0 * h, h], 1), (1, 0, 0))
    i, r = np.arcsin(h.astype(float)), np.arcsin(h / N)
    assert np.allclose(meets_axis(points, ways), np.sin(i) / np.sin(2 * (i - r)), rtol=1e-5)
    near = np.float32([0.05])
    points, ways = exits(rb.Sphere(), np.stack([-5 + 0 * near, 0 * near, near], 1), (1, 0, 0))
    assert abs(meets_axis(points, ways)[0] - N / (2 * (N - 1))) < 3e-3  # the paraxial focal length, R n / 2(n - 1)


def test_the_focus_of_a_plano_convex_lens() -> None:
    """Cut from a ball of radius 2: the curved side turns a ray by i - r, the flat one by Snell's law again."""
    lens = rb.Sphere((0, 0, 0), 2) & rb.Box((-3, -3, -3), (-1.5, 3, 3))
    h = np.linspace(0.2, 1.2, 11).astype(np.float32)
    points, ways = exits(lens, np.stack([-5 + 0 * h, 0 * h, h], 1), (1, 0, 0))
    i, r = np.arcsin(h.astype(float) / 2), np.arcsin(h / 2 / N)
    drop = (-1.5 + 2 * np.cos(i)) * np.tan(i - r)
    after = np.arcsin(N * np.sin(i - r))
    assert np.allclose(meets_axis(points, ways), -1.5 + (h - drop) / np.tan(after), rtol=1e-5)


@pytest.mark.parametrize("by_csg", [False, True])
def test_the_least_deviation_of_a_prism(by_csg: bool) -> None:
    """delta = 2 asin(n sin(A/2)) - A, where the ray passes level with the base."""
    half = np.pi / 6
    corners = np.array([[0, y, np.sqrt(3)] for y in (-1, 1)] + [[x, y, 0] for x in (-1, 1) for y in (-1, 1)], float)
    faces = [[3, 2, 0], [1, 3, 0], [4, 5, 0], [5, 1, 0], [5, 4, 2], [3, 5, 2], [2, 4, 0], [5, 3, 1]]
    shape: rb.Shape = rb.Mesh(corners, faces)
    if by_csg:
        side = rb.Box((-4, -2, -4), (0, 2, 4))
        left = side.transformed(rb.Transform.translate(-1, 0, 0) @ rb.Transform.rotate(30, axis=(0, 1, 0)))
        right = side.transformed(rb.Transform.rotate(180)).transformed(
            rb.Transform.translate(1, 0, 0) @ rb.Transform.rotate(-30, axis=(0, 1, 0))
        )
        shape = rb.Box((-1, -1, 0), (1, 1, 1.75)) - left - right
    turn = np.arcsin(N * np.sin(half)) - half  # each face's share
    way = np.array([np.cos(turn), 0, np.sin(turn)])
    origins = np.array([[-0.7, 0.1 * k, 0.3 * np.sqrt(3)] - 3 * way for k in range(5)])
    points, ways = exits(shape, origins, tuple(way))
    deviation = np.arccos(np.clip(ways @ way, -1, 1))
    assert np.allclose(deviation, 2 * np.arcsin(N * np.sin(half)) - 2 * half, atol=1e-5)
    assert (points[:, 0] > 0).all()
    for off in (-0.05, 0.05):  # it is the least one
        aside = np.array([np.cos(turn + off), 0, np.sin(turn + off)])
        _, more = exits(shape, origins + 3 * way - 3 * aside, tuple(aside))
        assert (np.arccos(np.clip(more @ aside, -1, 1)) > deviation + 1e-4).all()


@pytest.mark.parametrize("as_mesh", [True, False])
def test_a_corner_cube_sends_rays_back(as_mesh: bool) -> None:
    """Three total reflections turn any ray around."""
    shape: rb.Shape = rb.Mesh(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    )
    if not as_mesh:
        slab = rb.Box((-4, -4, 0), (4, 4, 4)).transformed(
            rb.Transform.translate(1 / 3, 1 / 3, 1 / 3)
            @ rb.Transform.rotate(np.degrees(np.arccos(3**-0.5)), (-1, 1, 0))
        )
        shape = rb.Box((0, 0, 0), (1, 1, 1)) - slab
    rng = np.random.default_rng(6)
    origins = np.array([1.0, 1, 1]) + rng.uniform(-0.08, 0.08, (40, 3)) + 0.3
    way = (-1.0, -1.02, -0.97)
    _, ways = exits(shape, origins, way)
    assert np.allclose(ways, -np.array(way) / np.linalg.norm(way), atol=1e-5)


def test_what_a_path_says() -> None:
    scene = rb.Scene(ambient=1)
    scene.add(rb.Sphere(), rb.Material(0.2, reflect=0.25, transmit=0.5, ior=1.5))
    with rb.Renderer(scene, max_depth=3) as renderer:
        paths = renderer.paths([(-4, 0, 0.5), (-4, 0, 2)], (1, 0, 0))
    assert paths["ray"].tolist() == [0] * (len(paths) - 1) + [1]
    assert paths["depth"][0] == 1
    assert paths["parent"][0] == paths["parent"][-1] == -1
    assert (paths["parent"][1:-1] < np.arange(1, len(paths) - 1)).all()
    for i in range(1, len(paths) - 1):
        parent = paths[paths["parent"][i]]
        assert paths["depth"][i] == parent["depth"] + 1
        assert np.allclose(paths["origin"][i], parent["point"], atol=1e-6)
        share = 0.25 if paths["kind"][i] == rb.RayKind.REFLECTED else 0.5
        assert np.allclose(paths["weight"][i], parent["weight"] * share)
    assert paths["depth"].max() == 3
    assert paths["object_id"][0] == 0
    miss = paths[-1]
    assert np.isinf(miss["t"])
    assert miss["object_id"] == miss["face_id"] == -1
    assert miss["point"].tolist() == [1, 0, 0]
    assert rb.RayKind(paths["kind"][0]) is rb.RayKind.EYE
