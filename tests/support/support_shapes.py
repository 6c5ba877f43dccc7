"""Random shapes, transforms and rays with fixed seeds."""

from __future__ import annotations

from collections.abc import Callable, Iterable
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


def quadric(
    rng: Rng, size: float, center: Array, form: tuple[float, ...], *, turned: bool, half: Any = 1.0
) -> rb.Shape:
    """The quadric (A .. J) of unit coordinates, which are scaled by `size`, perhaps turned, and moved to `center`,
    within the box of `half` sizes; all coefficients times some factor of 1e-15 .. 1e15."""
    a, b, c, d, e, f, g, h, i, j = form
    matrix = np.array([[a, d / 2, f / 2, g / 2], [d / 2, b, e / 2, h / 2], [f / 2, e / 2, c, i / 2]])
    matrix = np.vstack([matrix, [g / 2, h / 2, i / 2, j]])
    to_unit = np.eye(4)
    to_unit[:3, :3] = (basis(rng).T if turned else np.eye(3)) / size
    to_unit[:3, 3] = -to_unit[:3, :3] @ center
    m = to_unit.T @ matrix @ to_unit * min(size, 1.0) * max(1.0, size) ** 2 * 10 ** rng.uniform(-15, 15)
    coefficients = [m[0, 0], m[1, 1], m[2, 2], *(2 * m[[0, 1, 0, 0, 1, 2], [1, 2, 2, 3, 3, 3]]), m[3, 3]]
    reach = size * np.asarray(half) * np.ones(3)
    return rb.Quadric(coefficients, rb.Box(center - reach, center + reach))


def ellipsoid(rng: Rng, size: float, center: Array) -> rb.Shape:
    a, b, c = rng.uniform(0.3, 1, 3) ** -2.0
    return quadric(rng, size, center, (a, b, c, 0, 0, 0, 0, 0, 0, -1), turned=True, half=rng.uniform(0.7, 1.1, 3))


def paraboloid(rng: Rng, size: float, center: Array) -> rb.Shape:
    """Along z, or its matrix of second order would be indefinite after rounding."""
    a, b = rng.uniform(0.5, 3, 2)
    return quadric(rng, size, center, (a, b, 0, 0, 0, 0, 0, 0, -1, -0.8), turned=False)


def parabolic_cylinder(rng: Rng, size: float, center: Array) -> rb.Shape:
    return quadric(rng, size, center, (rng.uniform(0.5, 3), 0, 0, 0, 0, 0, 0, 0.3, -1, -0.5), turned=False)


def saddle(rng: Rng, size: float, center: Array) -> rb.Shape:
    a, b = rng.uniform(0.5, 2, 2)
    return quadric(rng, size, center, (a, -b, 0, 0, 0, 0, 0, 0, -1, 0), turned=True)


def one_sheet(rng: Rng, size: float, center: Array) -> rb.Shape:
    a, b, c = rng.uniform(0.5, 2, 3)
    return quadric(rng, size, center, (a, b, -c, 0, 0, 0, 0, 0, 0, -rng.uniform(0.01, 0.4)), turned=True)


def two_sheets(rng: Rng, size: float, center: Array) -> rb.Shape:
    a, b, c = rng.uniform(0.5, 2, 3)
    return quadric(rng, size, center, (a, b, -c, 0, 0, 0, 0, 0, 0, rng.uniform(0.01, 0.2)), turned=True)


def double_cone(rng: Rng, size: float, center: Array) -> rb.Shape:
    a, b, c = rng.uniform(0.5, 2, 3)
    return quadric(rng, size, center, (a, b, -c, 0, 0, 0, 0, 0, 0, 0), turned=bool(rng.integers(2)))


def shell(rng: Rng, size: float, center: Array) -> rb.Shape:
    """Outside of an ellipsoid, within the box."""
    a, b, c = rng.uniform(1, 3, 3)
    return quadric(rng, size, center, (-a, -b, -c, 0, 0, 0, 0, 0, 0, 1), turned=True)


def thin_ellipsoid(rng: Rng, size: float, center: Array) -> rb.Shape:
    a, b, c = (10 ** rng.uniform([-3, -2, 0], 0)) ** -2.0
    return quadric(rng, size, 0.1 * center, (a, b, c, 0, 0, 0, 0, 0, 0, -1), turned=False)


def dish(rng: Rng, size: float, center: Array) -> rb.Shape:
    """A paraboloid in a flat box."""
    depth = 10 ** rng.uniform(-4, -1)
    form = (1, rng.uniform(0.5, 2), 0, 0, 0, 0, 0, 0, -1 / depth, 0)
    return quadric(rng, size, 0.1 * center, form, turned=False, half=(1, 1, depth))


def slab(rng: Rng, size: float, center: Array) -> rb.Shape:
    """Between two parallel planes."""
    return quadric(rng, size, 0.01 * center, (0, 0, 1, 0, 0, 0, 0, 0, 0, -(10 ** rng.uniform(-6, -1))), turned=False)


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
    "thin_ellipsoid": thin_ellipsoid,
    "dish": dish,
    "slab": slab,
}
CONVEX_QUADRICS: dict[str, Maker] = {
    "ellipsoid": ellipsoid,
    "paraboloid": paraboloid,
    "parabolic_cylinder": parabolic_cylinder,
}
# A line may be inside of these twice.
HOLLOWS: dict[str, Maker] = {
    "saddle": saddle,
    "one_sheet": one_sheet,
    "two_sheets": two_sheets,
    "double_cone": double_cone,
    "shell": shell,
}
QUADRICS: dict[str, Maker] = CONVEX_QUADRICS | HOLLOWS
MAKERS: dict[str, Maker] = PRIMITIVES | EXTREMES | QUADRICS


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
        return MAKERS[name](rng, size, center)
    inner = MAKERS[name](rng, 1.0, rng.normal(size=3))
    return inner.transformed(transform_about(size * affine(rng), np.zeros(3), center))


def with_affine(names: Iterable[str]) -> list[str]:
    return [*names, *(f"{name}+affine" for name in names)]


CONVEX_KINDS = [*with_affine(PRIMITIVES), *with_affine(CONVEX_QUADRICS)]
HOLLOW_KINDS = with_affine(HOLLOWS)
KINDS = [*CONVEX_KINDS, *HOLLOW_KINDS]
SOLID_KINDS = [*with_affine(SOLIDS), *with_affine(CONVEX_QUADRICS), *HOLLOW_KINDS]


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
