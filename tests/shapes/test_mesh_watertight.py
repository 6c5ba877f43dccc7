"""Closed meshes let nothing through: rays from inside at faces, edges and vertices, near and far."""

from collections.abc import Iterator

import numpy as np
import pytest
from tests.support.support_meshes import FAR, globe, on_grid, targets_on
from tests.support.support_shapes import Rng, f32, unit

import raybound as rb
from raybound.scenes.hard import meshes

KINDS = ("face", "edge", "vertex")
CHUNK = 200_000
NEAR_AND_FAR = [((0, 0, 0), 1.0), (FAR, 100.0), (FAR, 10.0)]


def chunks(total: int) -> Iterator[int]:
    """The number of rays in each of several calls."""
    for first in range(0, total, CHUNK):
        yield min(CHUNK, total - first)


def inner_points(rng: Rng, center: tuple[float, ...], size: float, n: int) -> np.ndarray:
    """Origins well inside a globe, as float64, on the grid of its vertices: differences to those are exact."""
    return on_grid(np.asarray(center) + 0.3 * size * rng.uniform(-1, 1, (n, 3)), center, size).astype(float)


def in_scene(mesh: rb.Shape, transform: rb.Transform | None = None) -> rb.Scene:
    scene = rb.Scene()
    scene.add(mesh, rb.Material(), transform=transform)
    return scene


def count_misses(scene: rb.Scene, origins: np.ndarray, directions: np.ndarray) -> int:
    answers = scene.intersect(f32(origins), f32(directions))
    assert np.isfinite(answers["t"][answers["hit"]]).all()
    assert (answers["t"] > 0).all()
    return int((~answers["hit"]).sum())


@pytest.mark.parametrize("kind", KINDS)
def test_rays_from_inside_a_globe_with_moved_vertices(kind: str) -> None:
    """100000 rays anywhere, and as many exactly at edges and at vertices; the shape alone answers as the scene does."""
    rng = np.random.default_rng(70)
    points, faces = globe(rng, 16, (0, 0, 0), 1.0)
    mesh = rb.Mesh(points, faces)
    origins = inner_points(rng, (0, 0, 0), 1.0, 100_000)
    directions = targets_on(rng, kind, points, faces, 100_000) - origins
    assert count_misses(in_scene(mesh), origins, directions) == 0
    alone = rb.intersect(mesh, f32(origins[:5000]), f32(directions[:5000]))
    assert alone["hit"].all()
    distances = np.linalg.norm(alone["point"], axis=1)
    assert ((distances > 0.75) & (distances < 1.15)).all()
    if kind == "vertex":
        aimed = f32(origins[:5000] + directions[:5000])
        assert np.abs(alone["point"] - aimed).max() < 1e-5
        assert (f32(directions) == directions).all()  # they are exact


@pytest.mark.parametrize("rays", [100_000, pytest.param(10_000_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", ["edge", "vertex"])
@pytest.mark.parametrize(("center", "size"), NEAR_AND_FAR, ids=["origin", "far", "far and small"])
def test_no_ray_at_an_edge_or_a_vertex_misses(center: tuple[float, ...], size: float, kind: str, rays: int) -> None:
    """Zero misses: also where float32 steps are 1/64 and the mesh is 10 wide."""
    rng = np.random.default_rng(71)
    misses = tested = 0
    for n in chunks(rays):
        points, faces = globe(rng, 16, center, size)
        origins = inner_points(rng, center, size, n)
        directions = targets_on(rng, kind, points, faces, n) - origins
        keep = np.abs(directions).max(axis=1) > 0
        misses += count_misses(in_scene(rb.Mesh(points, faces)), origins[keep], directions[keep])
        tested += int(keep.sum())
    assert misses == 0
    assert tested >= 0.99 * rays


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", [1e-15, 1e-6, 1e8, 1e15])
def test_globes_of_all_sizes(kind: str, size: float) -> None:
    rng = np.random.default_rng(72)
    points, faces = globe(rng, 16, (0, 0, 0), size)
    origins = inner_points(rng, (0, 0, 0), size, 20_000)
    directions = targets_on(rng, kind, points, faces, 20_000) - origins
    assert count_misses(in_scene(rb.Mesh(points, faces)), origins, directions) == 0


def test_faces_turned_inside_out_are_as_tight() -> None:
    rng = np.random.default_rng(73)
    points, faces = globe(rng, 16, FAR, 100.0)
    faces[::3] = faces[::3, ::-1]
    origins = inner_points(rng, FAR, 100.0, 20_000)
    for kind in KINDS:
        directions = targets_on(rng, kind, points, faces, 20_000) - origins
        assert count_misses(in_scene(rb.Mesh(points, faces)), origins, directions) == 0


TRANSFORMS = {
    "rotated": rb.Transform.rotate(33.0, (1, 2, 3)),
    "scaled": rb.Transform.scale((1e-3, 1e3, 2.0)),
    "mirrored and tiny": rb.Transform.scale((-1e-9, 1e-9, 1e-9)),
    "far": rb.Transform.translate(*FAR) @ rb.Transform.scale(10.0),
    "sheared": rb.Transform([[1, 5, 0, 2], [0, 1, -3, 1], [0.5, 0, 1, 0], [0, 0, 0, 1]]),
    "all": rb.Transform.translate(*FAR) @ rb.Transform.rotate(77, (3, 1, 2)) @ rb.Transform.scale((50, 2, 400)),
}


@pytest.mark.parametrize("name", TRANSFORMS)
@pytest.mark.parametrize("as_shape", [False, True], ids=["object", "shape"])
def test_transformed_globes(name: str, as_shape: bool) -> None:
    """Placed by the object's transform or by the shape's; rays at the moved vertices and edges, to within rounding."""
    rng = np.random.default_rng(74)
    points, faces = globe(rng, 16, (0, 0, 0), 1.0)
    t, mesh = TRANSFORMS[name], rb.Mesh(points, faces)
    scene = in_scene(mesh.transformed(t)) if as_shape else in_scene(mesh, t)
    linear, offset = t.matrix[:3, :3], t.matrix[:3, 3]
    tested = 0
    for kind in KINDS:
        origins = f32(inner_points(rng, (0, 0, 0), 1.0, 20_000) @ linear.T + offset).astype(float)
        targets = f32(targets_on(rng, kind, points, faces, 20_000) @ linear.T + offset).astype(float)
        keep = np.abs(targets - origins).max(axis=1) > 0
        assert count_misses(scene, origins[keep], (targets - origins)[keep]) == 0
        tested += int(keep.sum())
    assert tested > 59_000


@pytest.mark.parametrize(
    ("center", "width"),
    [((0, 0, 0), 1e-1), ((0, 0, 0), 1e-3), ((0, 0, 0), 1e-5), ((1e3, -2e3, 500.0), 1e-1), ((1e3, -2e3, 500.0), 1e-3)],
)
def test_needle_triangles(center: tuple[float, ...], width: float) -> None:
    """Between wide faces there are needles from pole to pole, whose sides are 1 / width as long as they are wide."""
    rng = np.random.default_rng(75)
    sides = np.arange(24) * (2 * np.pi / 24)
    turn = np.sort(np.concatenate([sides, sides + width]))
    points, faces = meshes.globe(np.array([0.4, 1.2, 2.2]), turn)
    points = on_grid(np.asarray(center) + 4 * points, center, 4.0)
    whole = in_scene(rb.Mesh(points, faces))
    for kind in KINDS:
        origins = inner_points(rng, center, 4.0, 20_000)
        directions = targets_on(rng, kind, points, faces, 20_000) - origins
        assert count_misses(whole, origins, directions) == 0
    corners = points.astype(float)[faces]
    sizes = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert sizes.max() > sizes.min() / width / 20


@pytest.mark.parametrize("least", [1e-2, 1e-4, 1e-6])
def test_triangles_of_all_sizes_around_a_pole(least: float) -> None:
    """T-free: rings of triangles that shrink by a constant factor toward the poles; rays at all their vertices."""
    rng = np.random.default_rng(76)
    half = np.geomspace(least, 1.25, 16)
    points, faces = meshes.globe(np.concatenate([half, np.pi - half[::-1]]), np.arange(24) * (2 * np.pi / 24))
    points = f32(points)
    scene = in_scene(rb.Mesh(points, faces))
    for kind in KINDS:
        origins = f32(rng.uniform(-0.3, 0.3, (40_000, 3))).astype(float)
        directions = targets_on(rng, kind, points, faces, 40_000) - origins
        assert count_misses(scene, origins, directions) == 0
    edges = np.linalg.norm(points[faces[:, 1]] - points[faces[:, 2]], axis=1)
    assert edges.max() / edges.min() > 0.2 / least


def test_rays_along_the_axes_and_within_planes_of_vertices() -> None:
    """Direction components of zero: exactly at the poles, at vertices of the planes y = 0 and x = 0, along edges."""
    rng = np.random.default_rng(77)
    points, faces = globe(rng, 16, (0, 0, 0), 1.0)
    points = np.where(np.abs(points) < 1e-6, 0, points)
    scene = in_scene(rb.Mesh(points, faces))
    flat = points[(points == 0).any(axis=1)].astype(float)
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    height = on_grid(rng.uniform(-0.5, 0.5, (2000, 3)), (0, 0, 0), 1.0).astype(float)
    for k, axis in enumerate(axes):
        origins = height * np.abs(axis)  # on the axis itself
        assert count_misses(scene, origins, np.broadcast_to(axis, origins.shape)) == 0, k
    within = rng.integers(len(flat), size=20_000)
    origins = np.where(flat[within] == 0, 0, on_grid(rng.uniform(-0.3, 0.3, (20_000, 3)), (0, 0, 0), 1.0))
    directions = flat[within] - origins
    assert (directions == 0).any(axis=1).all()
    for tiny in (0.0, -0.0, 1e-45, -1e-40):
        assert count_misses(scene, origins, np.where(directions == 0, tiny, directions)) == 0
    assert len(flat) >= 50


@pytest.mark.parametrize(("center", "size"), NEAR_AND_FAR, ids=["origin", "far", "far and small"])
def test_rays_from_outside_through_vertices(center: tuple[float, ...], size: float) -> None:
    """The line from a vertex to the middle is inside: from its far side, the ray exactly at the vertex hits."""
    rng = np.random.default_rng(78)
    points, faces = globe(rng, 16, center, size)
    middle = on_grid(np.asarray(center)[None], center, size).astype(float)
    outward = points.astype(float) - middle
    scene = in_scene(rb.Mesh(points, faces))
    for far in (1.0, 2.0, 4.0):
        origins = points + far * outward
        same = (f32(origins) == origins).all(axis=1)
        answers = scene.intersect(f32(origins[same]), f32(-outward[same]))
        assert answers["hit"].all()
        assert np.abs(answers["t"] - far).max() < 0.02 + far * 1e-3
        assert same.sum() > 100


def test_tiles_of_a_tilted_plane() -> None:
    """An open mesh, far away: rays at inner vertices and edges, grazing ones too."""
    rng = np.random.default_rng(79)
    n = 24
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    points = f32(np.stack([3 * i, 3 * j, 0.75 * i + 1.5 * j], axis=-1).reshape(-1, 3) + np.round(FAR))
    at = (i * n + j)[:-1, :-1].ravel()
    faces = np.concatenate([np.stack([at, at + n, at + n + 1], axis=1), np.stack([at, at + n + 1, at + 1], axis=1)])
    inner = points.reshape(n, n, 3)[1:-1, 1:-1].reshape(-1, 3).astype(float)
    targets = np.repeat(inner, 60, axis=0)
    along = rng.random(len(targets)) < 0.5
    targets[along] += rng.uniform(-0.9, 0.9, (int(along.sum()), 1)) * np.array([3.0, 0, 0.75])
    height = 10 ** rng.uniform(-3, 2, (len(targets), 1))
    origins = f32(targets + 20 * unit(rng, len(targets)) * [1, 1, 0] + height * [0, 0, 1] + [0, 0, 30]).astype(float)
    assert count_misses(in_scene(rb.Mesh(points, faces)), origins, targets - origins) == 0
    assert len(targets) > 20_000
