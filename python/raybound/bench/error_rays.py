"""Rays at a body, rays that leave its surface, and points that are certainly inside of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .error_bodies import Body, Rng
from .error_exact import Doubles
from .error_oracle import Flags

PROBES = np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
MARGIN = 4  # float32 steps of the largest coordinate: origins are moved by fewer


@dataclass(frozen=True)
class Rays:
    """Rays with float32 numbers in float64 arrays (n, 3). `sure`: exact arithmetic certainly meets the body.

    `seam`: aimed at an edge or vertex of a mesh.
    """

    origins: Doubles
    directions: Doubles
    sure: Flags
    seam: Flags


def rounded(x: Any) -> Doubles:
    """float32 numbers as float64."""
    return np.asarray(np.asarray(x, np.float32), np.float64)


def toward(origins: Doubles, targets: Doubles) -> Doubles:
    """Unit directions, rounded to float32; +x where the points are the same."""
    ways = targets - origins
    lengths = np.linalg.norm(ways, axis=1, keepdims=True)
    return rounded(np.where(lengths > 0, ways / np.where(lengths > 0, lengths, 1.0), (1.0, 0.0, 0.0)))


def rays_at(rng: Rng, body: Body, eye: Doubles, count: int) -> Rays:
    """Half from the eye, a quarter from up to 100 sizes away, a quarter from within the bounds; and at a mesh as many
    again from within, at its vertices and edges.
    """
    low, high = body.bounds
    near, inner = count // 4, count // 4
    around = rng.normal(size=(near, 3))
    around *= body.size * 10 ** rng.uniform(0.2, 2, (near, 1)) / np.linalg.norm(around, axis=1, keepdims=True)
    from_eye = np.broadcast_to(eye, (count - near - inner, 3))
    origins = rounded(np.concatenate([from_eye, body.middle + around, rng.uniform(low, high, (inner, 3))]))
    targets = rng.uniform(low, high, (count, 3))
    seam = np.zeros(count, bool)
    if body.kind == "mesh":
        inside = np.broadcast_to(rounded(body.middle), (count, 3))
        origins, targets = np.concatenate([origins, inside]), np.concatenate([targets, seam_points(rng, body, count)])
        seam = np.repeat([False, True], count)
    directions = toward(origins, targets)
    return Rays(origins, directions, _meets(body, origins, directions, targets), seam)


def seam_points(rng: Rng, body: Body, count: int) -> Doubles:
    """Points of a mesh where faces meet: a third vertices, others on edges, rounded to float32."""
    leaf = body.oracle.leaves[0]
    vertices, faces = np.asarray(leaf.shape.vertices, np.float64), np.asarray(leaf.shape.faces)
    corners, k = vertices[faces[rng.integers(len(faces), size=count)]], rng.integers(3, size=count)
    share = np.where(rng.random(count) < 1 / 3, 0.0, rng.random(count))[:, None]
    rows = np.arange(count)
    local = corners[rows, k] * (1 - share) + corners[rows, (k + 1) % 3] * share
    return rounded(leaf.world(local))


def _meets(body: Body, origins: Doubles, directions: Doubles, targets: Doubles) -> Flags:
    """Whether rays certainly meet a body: they pass a point that is certainly inside, near the target or the origin."""
    if body.is_sheet:
        return np.zeros(len(origins), bool)
    t = np.sum((targets - origins) * directions, axis=1, keepdims=True) / np.sum(directions**2, axis=1, keepdims=True)
    met: Flags = surely_inside(body, origins + directions * np.maximum(t, 0)) | surely_inside(body, origins)
    return met


def surely_inside(body: Body, points: Doubles) -> Flags:
    """Whether points, and those within `MARGIN` float32 steps of the body's largest coordinate, are inside a solid.

    (The points are within a float64 rounding of where they should be, which is far less.)
    """
    step = MARGIN * float(np.spacing(np.float32(body.reach)))
    within: Flags = np.all((points > body.bounds[0]) & (points < body.bounds[1]), axis=1)
    around = points[within][:, None] + step * PROBES
    within[within] = body.oracle.contains(around.reshape(-1, 3)).reshape(-1, len(PROBES)).all(axis=1)
    return within


def hemisphere(rng: Rng, normals: Doubles) -> Doubles:
    """Unit directions on the side of unit normals: half of them uniform, half at 1e-7 .. 1e-1 rad to the surface."""
    n = len(normals)
    across = rng.normal(size=(n, 3))
    across -= normals * np.sum(across * normals, axis=1, keepdims=True)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = np.where(rng.random(n) < 0.5, np.arcsin(rng.random(n)), 10 ** rng.uniform(-7, -1, n))[:, None]
    return rounded(np.cos(angle) * across + np.sin(angle) * normals)
