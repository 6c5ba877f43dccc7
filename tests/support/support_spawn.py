"""Rays that are spawned from hits: where they start, where they go."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import raybound as rb

from .support_shapes import QUADRICS, Rng, aimed_rays, f32, make


def hemisphere(rng: Rng, normals: np.ndarray) -> np.ndarray:
    """Directions on the side of the normals: half of them uniform, half grazing at 1e-7 .. 1e-1 rad."""
    n = len(normals)
    across = rng.normal(size=(n, 3))
    across -= normals * np.sum(across * normals, axis=1, keepdims=True)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = np.where(rng.random(n) < 0.5, np.arcsin(rng.random(n)), 10 ** rng.uniform(-7, -1, n))[:, None]
    return f32(np.cos(angle) * across + np.sin(angle) * normals)


def hits_of(rng: Rng, shape: rb.Shape, n: int) -> np.ndarray:
    """Hits from rays that start up to 1e5 sizes away, or within the bounds."""
    distance = 0 if rng.random() < 0.3 else 10 ** rng.uniform(0, 5)
    hits = rb.intersect(shape, *aimed_rays(rng, shape, n, distance))
    return hits[hits["hit"]]


@dataclass
class Spawned:
    """Hits with, for each, a direction on the side of the normal."""

    shape: rb.Shape
    hits: np.ndarray
    directions: np.ndarray

    def outside(self) -> np.ndarray:
        return rb.intersect(self.shape, self.hits["next_origin"], self.directions)

    def inner_origins(self) -> np.ndarray:
        h = self.hits
        return rb.spawn_origin(h["point"], h["point_error"], h["normal"], -self.directions)

    def inside(self) -> np.ndarray:
        return rb.intersect(self.shape, self.inner_origins(), -self.directions)


def spawn(rng: Rng, shape: rb.Shape, rays: int, fan: int) -> Spawned:
    hits = np.repeat(hits_of(rng, shape, rays), fan)
    normals = hits["normal"]
    directions = hemisphere(rng, normals)
    # A normal rounded to float32 is off by at most sqrt(3) 2^-25 rad: these are above the true surface, surely.
    keep = np.einsum("ij,ij->i", directions.astype(float), normals) > 3**0.5 * 2.0**-25
    return Spawned(shape, hits[keep], directions[keep])


def wild_shape(rng: Rng, kind: str) -> rb.Shape | None:
    """Sizes and coordinates over sixteen orders of magnitude; None where rounding leaves no such shape."""
    size = 10 ** rng.uniform(-8, 8)
    rounds = kind.startswith("polygon") or kind in QUADRICS  # far from its place rounding leaves none
    reach = size * 10 ** rng.uniform(-8, 3) if rounds else 10 ** rng.uniform(-8, 8)
    return shape_or_none(kind, rng, size, reach * rng.normal(size=3))


def shape_or_none(kind: str, rng: Rng, size: float, center: np.ndarray) -> rb.Shape | None:
    try:
        return make(kind, rng, size, center)
    except ValueError:
        return None


def as_ulps(moves: np.ndarray, reach: Any) -> np.ndarray:
    return moves / np.spacing(f32(reach)).astype(float)
