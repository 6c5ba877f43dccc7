"""Meshes as points and triples, points of their faces, edges and vertices to aim at, and exact answers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, product
from typing import Any

import numpy as np

import raybound as rb

from .support_oracle import cross, dot, minus
from .support_shapes import Rng, affine, f32, transform_about, unit

FAR = (148376.0, 1234.0, -223423.0)


def globe(rng: Rng, n: int, center: tuple[float, ...], size: float) -> tuple[np.ndarray, np.ndarray]:
    """A closed sphere of triangles, n rings of n, with randomly moved vertices: (points, triples)."""
    angle, turn = np.meshgrid(np.arange(1, n) * np.pi / n, np.arange(n) * 2 * np.pi / n, indexing="ij")
    ring = np.stack([np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), np.cos(angle)], axis=-1)
    points = np.concatenate([[(0, 0, 1), (0, 0, -1)], ring.reshape(-1, 3)])
    points = np.asarray(center) + size * points * rng.uniform(0.9, 1.1, (len(points), 1))

    def at(i: int, j: int) -> int:
        return 2 + i * n + j % n

    faces = [(0, at(0, j), at(0, j + 1)) for j in range(n)] + [(1, at(n - 2, j + 1), at(n - 2, j)) for j in range(n)]
    for i in range(n - 2):
        for j in range(n):
            faces += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    return on_grid(points, center, size), np.array(faces)


def on_grid(points: np.ndarray, center: tuple[float, ...], size: float) -> np.ndarray:
    """Rounded so that differences of such points are float32 exactly: a ray can be aimed at a vertex without error."""
    step = 2.0 ** np.ceil(np.log2((np.abs(center).max() + 2 * size) * 2.0**-22))
    return f32(np.round(points / step) * step)


def targets_on(rng: Rng, kind: str, points: np.ndarray, faces: np.ndarray, n: int) -> np.ndarray:
    corners = points.astype(float)[faces[rng.integers(len(faces), size=n)]]
    if kind == "vertex":
        return corners[:, 0]
    weights = rng.dirichlet((1, 1, 1), n)
    if kind == "edge":
        weights[:, 2] = 0
        weights /= weights.sum(axis=1, keepdims=True)
    return np.einsum("ij,ijk->ik", weights, corners)


def tube(sides: int, radius: float, height: float) -> tuple[np.ndarray, np.ndarray]:
    """A closed tessellated cylinder about the z axis: vertices at the rims and the middles of the caps."""
    turn = np.arange(sides) * 2 * np.pi / sides
    ring = radius * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    points = np.concatenate([[(0, 0, 0), (0, 0, height)], ring, ring + np.array([0, 0, height])])
    low, high = 2 + np.arange(sides), 2 + sides + np.arange(sides)
    next_low, next_high = np.roll(low, -1), np.roll(high, -1)
    zero, one = np.zeros(sides, int), np.ones(sides, int)
    parts = [(zero, next_low, low), (one, high, next_high), (low, next_low, next_high), (low, next_high, high)]
    return points, np.concatenate([np.stack(p, axis=1) for p in parts])


def box_faces() -> tuple[np.ndarray, np.ndarray]:
    """The cube from 0 to 1 of twelve triangles."""
    return np.array(list(product((0.0, 1.0), repeat=3))), np.array(
        [
            *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
            *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
        ]
    )


def hull(rng: Rng, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A convex closed mesh around a few points in general position: facets have all points on one side."""
    faces = []
    for i, j, k in combinations(range(len(points)), 3):
        normal = np.cross(points[j] - points[i], points[k] - points[i])
        sides = np.delete((points - points[i]) @ normal, [i, j, k])
        if (sides < 0).all():
            faces.append((i, j, k))
        elif (sides > 0).all():
            faces.append((i, k, j))
    return points, np.array(faces)[rng.permutation(len(faces))]


def tetrahedron(rng: Rng) -> tuple[np.ndarray, np.ndarray]:
    return hull(rng, rng.normal(size=(4, 3)))


def gem(rng: Rng) -> tuple[np.ndarray, np.ndarray]:
    points = rng.normal(size=(10, 3))
    return hull(rng, points / np.linalg.norm(points, axis=1, keepdims=True))


def splinter(rng: Rng) -> tuple[np.ndarray, np.ndarray]:
    """A tetrahedron stretched into a needle or pressed flat."""
    points, faces = tetrahedron(rng)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return points @ np.diag([1, 10 ** rng.uniform(-4, 0), 10 ** rng.uniform(-4, -1)]) @ turn, faces


def crate(rng: Rng) -> tuple[np.ndarray, np.ndarray]:
    points, faces = box_faces()
    return (points - 0.5) * rng.uniform(0.3, 2, 3), faces


def triangle(rng: Rng) -> tuple[np.ndarray, np.ndarray]:
    return rng.normal(size=(3, 3)), np.array([(0, 1, 2)])


def blob(rng: Rng) -> tuple[np.ndarray, np.ndarray]:
    return globe(rng, int(rng.integers(3, 10)), (0, 0, 0), 1.0)


def terrain(rng: Rng, n: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """An open height field."""
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    points = np.stack([i, j, rng.uniform(-0.6, 0.6, (n, n))], axis=-1).reshape(-1, 3) * (2 / (n - 1)) - (1, 1, 0)
    at = (i * n + j)[:-1, :-1].ravel()
    return points, np.concatenate(
        [np.stack([at, at + n, at + n + 1], axis=1), np.stack([at, at + n + 1, at + 1], axis=1)]
    )


CONVEX = {"tetrahedron": tetrahedron, "gem": gem, "crate": crate, "splinter": splinter, "triangle": triangle}
MESHES = CONVEX | {"blob": blob, "terrain": terrain}


def random_mesh(rng: Rng, kind: str, size: float, center: np.ndarray) -> rb.Shape:
    """A mesh about as large as `size` near `center`; kinds "x+affine" are placed there by a transform, kinds "x+smooth"
    have normals of their own. Half of them have (u,v)."""
    name, *changes = kind.split("+")
    placed = "affine" in changes
    points, faces = MESHES[name](rng)
    extra = {}
    if "smooth" in changes:
        extra["normals"] = points + 0.2 * unit(rng, len(points))
    if rng.random() < 0.5:
        extra["uvs"] = rng.random((len(points), 2))
    if not placed:
        return rb.Mesh(center + size * points, faces, **extra)
    inner = rb.Mesh(points + rng.normal(size=3), faces, **extra)
    return inner.transformed(transform_about(size * affine(rng), np.zeros(3), center))


def mesh_or_none(rng: Rng, kind: str, size: float, center: np.ndarray) -> rb.Shape | None:
    """None where rounding leaves a face without area."""
    try:
        return random_mesh(rng, kind, size, center)
    except ValueError:
        return None


def kinds_of(names: Iterable[str]) -> list[str]:
    return [*names, *(f"{name}+affine" for name in names)]


# Exact answers. Floats are integers over a power of two, and all below is homogeneous: Python's integers are exact.


@dataclass
class Crossed:
    """What a line has to do with a face: t, and the edge functions over their sum (the weights of the corners)."""

    t: Fraction
    weights: list[Fraction]
    rising: bool  # leaves on the side of the outward normal


def exact_vector(v: Any) -> list[Fraction]:
    return [Fraction(float(x)) for x in v]


def placed_corners(shape: Any) -> list[list[list[Fraction]]]:
    """The corners of each face in the world, exactly."""
    mesh, matrix = (shape, None) if isinstance(shape, rb.Mesh) else (shape.shape, shape.transform.matrix)
    points = [exact_vector(v) for v in mesh.vertices]
    if matrix is not None:
        rows = [exact_vector(row) for row in matrix[:3]]
        points = [[row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] for row in rows] for p in points]
    return [[points[i] for i in face] for face in mesh.faces.tolist()]


def is_mirrored(shape: Any) -> bool:
    return not isinstance(shape, rb.Mesh) and np.linalg.det(shape.transform.matrix[:3, :3]) < 0


def cross_face(corners: list[list[Fraction]], o: list[Fraction], d: list[Fraction]) -> Crossed | None:
    """Where the line crosses the face, its border included; None where it does not, or lies in its plane."""
    a, b, c = (minus(v, o) for v in corners)
    sides = [dot(cross(q, p), d) for p, q in ((b, c), (c, a), (a, b))]
    total = sum(sides)
    if total == 0 or not (min(sides) >= 0 or max(sides) <= 0):
        return None
    return Crossed(dot(cross(b, c), a) / -total, [s / total for s in sides], total < 0)


def first_faces(all_corners: list[Any], o: Any, d: Any) -> dict[int, Crossed]:
    """The faces that the exact ray meets first, all at the same t > 0."""
    origin, direction = exact_vector(o), exact_vector(d)
    found = {i: cross_face(corners, origin, direction) for i, corners in enumerate(all_corners)}
    ahead = {i: x for i, x in found.items() if x is not None and x.t > 0}
    first = min((x.t for x in ahead.values()), default=None)
    return {i: x for i, x in ahead.items() if x.t == first}


def moved_first_faces(all_corners: list[Any], o: Any, d: Any) -> dict[int, Crossed]:
    """The faces that the line meets first, up to e, when it is moved across its direction by (e, e^2).

    So closed meshes decide about lines through edges and corners: what is entered is left."""
    size = np.abs(np.asarray(d, float))
    z = 2 if size[2] >= max(size[0], size[1]) else 1 if size[1] >= size[0] else 0
    origin, direction = exact_vector(o), exact_vector(d)
    least = Fraction(1, 2**400)
    origin[(z + 1) % 3] += least
    origin[(z + 2) % 3] += least * least
    found = {i: cross_face(corners, origin, direction) for i, corners in enumerate(all_corners)}
    ahead = {i: x for i, x in found.items() if x is not None and x.t > Fraction(1, 2**200)}
    first = min((x.t for x in ahead.values()), default=None)
    return {i: x for i, x in ahead.items() if first is not None and x.t - first < Fraction(1, 2**200)}


def is_closed(shape: rb.Shape) -> bool:
    try:
        shape.contains([0.0, 0.0, 0.0])
    except ValueError:
        return False
    return True


def expected_faces(shape: rb.Shape, all_corners: list[Any], o: Any, d: Any) -> dict[int, Crossed]:
    """The faces that a mesh in its own coordinates may be said to meet first."""
    first = first_faces(all_corners, o, d)
    if is_closed(shape) and any(min(x.weights) == 0 for x in first.values()):
        return moved_first_faces(all_corners, o, d)
    return first
