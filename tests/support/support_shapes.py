"""Random shapes, transforms and rays with fixed seeds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import raybound as rb

Rng = np.random.Generator
Array = np.ndarray[Any, np.dtype[np.float64]]


def unit(rng: Rng, n: int | None = None) -> Array:
    """Uniform unit vectors, float64."""
    v = rng.normal(size=3 if n is None else (n, 3))
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def f32(x: Any) -> np.ndarray:
    return np.asarray(x, np.float32)


def convex_outline(rng: Rng, n: int) -> Array:
    """n points in order around an ellipse: a strictly convex polygon in the plane z = 0."""
    gaps = 0.4 + rng.random(n)
    angles = np.cumsum(gaps) * (2 * np.pi / gaps.sum())
    return np.stack([np.cos(angles), rng.uniform(0.5, 1) * np.sin(angles), 0 * angles], axis=1)


def basis(rng: Rng) -> Array:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.diag(r))


def sphere(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Sphere(center, size)


def box(rng: Rng, size: float, center: Array) -> rb.Shape:
    half = size * rng.uniform(0.2, 1, 3)
    return rb.Box(center - half, center + half)


def cylinder(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Cylinder(center, center + size * rng.uniform(0.3, 2) * unit(rng), radius=size * rng.uniform(0.3, 1))


def cone(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Cone(center, center + size * rng.uniform(0.3, 2) * unit(rng), radius=size * rng.uniform(0.3, 1))


def truncated(rng: Rng, size: float, center: Array) -> rb.Shape:
    radius = size * rng.uniform(0.3, 1)
    apex = center + size * rng.uniform(0.3, 2) * unit(rng)
    return rb.Cone(center, apex, radius=radius, top_radius=radius * rng.uniform(0.02, 0.98))


def flared(rng: Rng, size: float, center: Array) -> rb.Shape:
    radius = size * rng.uniform(0.1, 0.5)
    apex = center + size * rng.uniform(0.3, 2) * unit(rng)
    return rb.Cone(center, apex, radius=radius, top_radius=radius * rng.uniform(1.02, 4))


def disk(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Disk(center, unit(rng) * 10 ** rng.uniform(-1, 1), radius=size)


def polygon(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Polygon(center + size * convex_outline(rng, int(rng.integers(3, 13))) @ basis(rng).T)


def needle(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Cone(center, center + size * unit(rng), radius=size * 10 ** rng.uniform(-6, -1))


def flat_cone(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Cone(center, center + size * 10 ** rng.uniform(-6, -1) * unit(rng), radius=size)


def nearly_cylinder(rng: Rng, size: float, center: Array) -> rb.Shape:
    top = 1 + rng.choice([-1, 1]) * 10 ** rng.uniform(-7, -2)
    return rb.Cone(center, center + size * unit(rng), radius=size / 2, top_radius=size / 2 * top)


def nearly_pointed(rng: Rng, size: float, center: Array) -> rb.Shape:
    top = 10 ** rng.uniform(-9, -2)
    return rb.Cone(center, center + size * unit(rng), radius=size / 2, top_radius=size / 2 * top)


def nearly_inverted(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Cone(center, center + size * unit(rng), radius=size * 10 ** rng.uniform(-9, -2), top_radius=size)


def rod(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Cylinder(center, center + size * unit(rng), radius=size * 10 ** rng.uniform(-6, -1))


def coin(rng: Rng, size: float, center: Array) -> rb.Shape:
    return rb.Cylinder(center, center + size * 10 ** rng.uniform(-6, -1) * unit(rng), radius=size)


def plate(rng: Rng, size: float, center: Array) -> rb.Shape:
    half = size * 10 ** rng.uniform(-6, 0, 3)
    return rb.Box(center - half, center + half)


def sliver(rng: Rng, size: float, center: Array) -> rb.Shape:
    corners = np.array([[0, 0, 0], [1, 0, 0], [rng.random(), 10 ** rng.uniform(-5, -1), 0]])
    return rb.Polygon(center + size * corners @ basis(rng).T)


Maker = Callable[[Rng, float, Array], rb.Shape]
SOLIDS: dict[str, Maker] = {
    "sphere": sphere,
    "box": box,
    "cylinder": cylinder,
    "cone": cone,
    "truncated": truncated,
    "flared": flared,
}
SHEETS: dict[str, Maker] = {"disk": disk, "polygon": polygon}
PRIMITIVES: dict[str, Maker] = SOLIDS | SHEETS
EXTREMES: dict[str, Maker] = {
    "needle": needle,
    "flat_cone": flat_cone,
    "nearly_cylinder": nearly_cylinder,
    "nearly_pointed": nearly_pointed,
    "nearly_inverted": nearly_inverted,
    "rod": rod,
    "coin": coin,
    "plate": plate,
    "sliver": sliver,
}


def affine(rng: Rng, *, stretch: float = 3.0, mirror: bool | None = None) -> np.ndarray:
    """A 3x3 map: rotation, non-uniform scale within 1/stretch .. stretch, shear, and, half of the time, a mirror."""
    scale = np.diag(stretch ** rng.uniform(-1, 1, 3))
    shear = np.eye(3) + np.triu(rng.uniform(-0.5, 0.5, (3, 3)), 1)
    m = basis(rng) @ scale @ shear
    wants = rng.random() < 0.5 if mirror is None else mirror
    return m if (np.linalg.det(m) < 0) == wants else m @ np.diag([1.0, 1.0, -1.0])


def transform_about(linear: np.ndarray, center: Array, target: Array) -> rb.Transform:
    """x -> linear (x - center) + target."""
    m = np.eye(4)
    m[:3, :3] = linear
    m[:3, 3] = target - linear @ center
    return rb.Transform(m)


def make(kind: str, rng: Rng, size: float, center: Array) -> rb.Shape:
    """A shape of a kind, about as large as `size`, near `center`; kinds "x+affine" are transformed there."""
    name, _, change = kind.partition("+")
    if not change:
        return (PRIMITIVES | EXTREMES)[name](rng, size, center)
    inner = PRIMITIVES[name](rng, 1.0, rng.normal(size=3))
    return inner.transformed(transform_about(size * affine(rng), np.zeros(3), center))


KINDS = [*PRIMITIVES, *(f"{name}+affine" for name in PRIMITIVES)]
SOLID_KINDS = [*SOLIDS, *(f"{name}+affine" for name in SOLIDS)]


def middle_and_size(shape: rb.Shape) -> tuple[Array, float]:
    low, high = shape.bounds
    return (low + high) / 2, float(np.max(high - low) / 2)


def aimed_rays(
    rng: Rng, shape: rb.Shape, n: int, distance: float, spread: float = 1.2
) -> tuple[np.ndarray, np.ndarray]:
    """n rays from `distance` sizes away (0: from within the bounds) toward points around the shape, as float32."""
    center, size = middle_and_size(shape)
    low, high = shape.bounds
    inner = rng.uniform(low, high, (n, 3)) if distance == 0 else center + size * distance * unit(rng, n)
    origins = f32(inner)
    targets = center + spread * (rng.uniform(low, high, (n, 3)) - center)
    lengths = 10 ** rng.uniform(-1, 1, (n, 1)) if n else 1.0
    directions = targets - origins
    directions[~directions.any(axis=1)] = (1.0, 0.0, 0.0)  # a target that rounds to the origin
    directions = f32(directions / np.linalg.norm(directions, axis=1, keepdims=True) * lengths)
    return origins, directions
