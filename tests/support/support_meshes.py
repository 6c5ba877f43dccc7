"""Closed meshes as points and triples, and points of their faces, edges and vertices to aim at."""

from __future__ import annotations

import numpy as np

from .support_shapes import Rng, f32

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
