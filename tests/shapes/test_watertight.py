"""Polygons that share edges and vertices let nothing through."""

import numpy as np
import pytest
from tests.support.support_meshes import FAR, globe, on_grid, targets_on
from tests.support.support_shapes import Rng, f32, unit

import raybound as rb


def count_hits(points: np.ndarray, faces: np.ndarray, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    return np.sum([rb.intersect(rb.Polygon(points[f]), origins, directions)["hit"] for f in faces], axis=0)


@pytest.mark.parametrize("rays", [3000, pytest.param(100_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize(
    ("center", "size"), [((0, 0, 0), 1), ((0, 0, 0), 1e-6), ((0, 0, 0), 1e8), (FAR, 100), (FAR, 10)]
)
@pytest.mark.parametrize("kind", ["face", "edge", "vertex"])
def test_nothing_leaves_a_closed_globe(kind: str, center: tuple[float, ...], size: float, rays: int) -> None:
    rng = np.random.default_rng(7)
    points, faces = globe(rng, 16, center, size)
    origins = on_grid(np.asarray(center) + 0.3 * size * rng.uniform(-1, 1, (rays, 3)), center, size)
    directions = f32(targets_on(rng, kind, points, faces, rays) - origins)
    counts = count_hits(points, faces, origins, directions)
    assert (counts == 0).sum() == 0
    if kind == "vertex":
        assert (counts > 1).sum() >= 0.5 * rays  # these rays do meet a vertex
    elif size > 20:
        assert (counts > 1).mean() <= 0.01  # edges are hit twice only when the ray is exact


def test_needle_triangles_leave_no_crack() -> None:
    """A fan of slivers around one point, seen from the side: rays within its outline always hit."""
    rng = np.random.default_rng(12)
    tested = 0
    for _ in range(40):
        size, center = 10 ** rng.uniform(-2, 3), np.array(FAR) * 10 ** rng.uniform(-6, 0)
        angles = np.sort(rng.uniform(0, 2 * np.pi, 40)) + np.repeat([0, 1e-3], 20)
        ring = np.sort(angles % (2 * np.pi))
        outline = f32(center + size * np.stack([np.cos(ring), np.sin(ring), 0 * ring], axis=1))
        outline[:, 2] = np.float32(center[2])
        middle = f32(center)
        origins = f32(center + size * np.array([0.3, 0.2, 2]) + 0.1 * size * unit(rng, 200))
        targets = center + 0.5 * size * np.sqrt(rng.random((200, 1))) * np.pad(unit_circle(rng, 200), ((0, 0), (0, 1)))
        hit = np.zeros(200, int)
        wide_enough = np.diff(np.append(ring, ring[0] + 2 * np.pi)).max() < np.pi
        try:
            for i in range(40):
                hit += rb.intersect(
                    rb.Polygon([middle, outline[i], outline[(i + 1) % 40]]), origins, f32(targets - origins)
                )["hit"]
        except ValueError:
            continue  # two outline points have become one
        if wide_enough:
            near_middle = np.linalg.norm(targets - center, axis=1) < 0.2 * size
            assert (hit[near_middle] > 0).all()
            tested += int(near_middle.sum())
    assert tested >= 400


def unit_circle(rng: Rng, n: int) -> np.ndarray:
    angle = rng.uniform(0, 2 * np.pi, n)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


@pytest.mark.parametrize("tiles", [8, pytest.param(40, marks=pytest.mark.soak)])
def test_tiles_of_a_plane_meet_at_edges_and_corners(tiles: int) -> None:
    """Squares side by side, tilted, far from the origin; rays at shared corners and edges, grazing ones too."""
    rng = np.random.default_rng(13)
    grid = np.arange(tiles + 1) * 3.0
    x, y = np.meshgrid(grid, grid, indexing="ij")
    corners = f32(np.stack([x, y, 0.25 * x + 0.5 * y], axis=-1) + np.array(FAR).round())
    quads = [
        [corners[i, j], corners[i + 1, j], corners[i + 1, j + 1], corners[i, j + 1]]
        for i in range(tiles)
        for j in range(tiles)
    ]
    inner = corners[1:-1, 1:-1].reshape(-1, 3).astype(float)
    targets = np.repeat(inner, 60, axis=0)
    along_edge = rng.random(len(targets)) < 0.5
    targets[along_edge] += rng.uniform(-0.9, 0.9, (along_edge.sum(), 1)) * np.array([3.0, 0, 0.75])
    height = 10 ** rng.uniform(-3, 2, (len(targets), 1))
    origins = f32(targets + 20 * unit(rng, len(targets)) * [1, 1, 0] + height * [0, 0, 1] + [0, 0, 20])
    hits = np.sum([rb.intersect(rb.Polygon(q), origins, f32(targets - origins))["hit"] for q in quads], axis=0)
    assert (hits > 0).all()
    assert len(hits) >= 2000
    assert (hits > 1).sum() >= 100
