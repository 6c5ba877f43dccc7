"""Radiance along lines, written once for floats and for all numbers that carry their error: the four cases of the table
in certified-interpolants.md, section 2."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import raybound as rb

Vector = tuple[Any, Any, Any]


def dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def plus(a: Vector, b: Vector, factor: Any = 1.0) -> Vector:
    return tuple(x + y * factor for x, y in zip(a, b))  # type: ignore[return-value]


def scaled(a: Vector, factor: Any) -> Vector:
    return tuple(x * factor for x in a)  # type: ignore[return-value]


def unit(a: Vector) -> Vector:
    return scaled(a, rb.rsqrt(squared(a)))


def line(a: Any, b: Any, c: Any, d: Any) -> tuple[Vector, Vector]:
    """From (a, b) on the plane z = 1 to (c, d) on z = -1."""
    return (a, b, 1.0), unit((c - a, d - b, -2.0 + 0 * a))


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def squared(a: Vector) -> Any:
    return rb.square(a[0] + 0.0) + rb.square(a[1] + 0.0) + rb.square(a[2] + 0.0)


def meet_sphere(origin: Vector, way: Vector) -> tuple[Vector, Vector]:
    """The unit sphere about the origin: point and normal, by the base tracer's formulas."""
    root = rb.sqrt(1.0 - squared(cross(origin, way)))
    point = plus(origin, way, (squared(origin) - 1.0) / (root - dot(origin, way)))
    return point, point


def meet_plane(origin: Vector, way: Vector, axis: int, level: float) -> Vector:
    return plus(origin, way, (level - origin[axis]) / way[axis])


def ward(point: Vector, normal: Vector, way: Vector, light: Vector, sigma: float = 0.2) -> Any:
    """rho_d = 0.5, rho_s = 0.3, a point light (thesis eq. 4.1, 4.2)."""
    toward = unit(plus(light, point, -1.0))
    cosine, view = dot(normal, toward), -dot(normal, way)
    half = unit(plus(toward, way, -1.0))
    lobe = rb.ward_lobe(dot(normal, half), sigma)
    return 0.5 * cosine + (0.3 / (4 * sigma**2)) * lobe * rb.sqrt(cosine / view)


def on_sphere(a: Any, b: Any, c: Any, d: Any, light: Vector) -> Any:
    origin, way = line(a, b, c, d)
    point, normal = meet_sphere(origin, way)
    return ward(point, normal, way, light)


def on_plane(a: Any, b: Any, c: Any, d: Any, light: Vector) -> Any:
    origin, way = line(a, b, c, d)
    return ward(meet_plane(origin, way, 2, -1.0), (0.0, 0.0, 1.0), way, light)


def in_mirror(a: Any, b: Any, c: Any, d: Any, light: Vector) -> Any:
    """The plane x = 1.36, seen in the sphere."""
    origin, way = line(a, b, c, d)
    point, normal = meet_sphere(origin, way)
    reflected = plus(way, normal, -2.0 * dot(way, normal))
    return ward(meet_plane(point, reflected, 0, 1.36), (-1.0, 0.0, 0.0), reflected, light)


@dataclass(frozen=True)
class Case:
    """A kernel, a cell and a light; and the table's row: the true error of quadrilinear interpolation, and bounds.

    The table does not say where its cells lay: these are cells of the same kind and size with the same true error
    (within a quarter), found at random; of such cells between a tenth (beside the highlight) and all (in it) meet every
    one of the table's bounds.
    """

    kernel: Callable[..., Any]
    center: tuple[float, ...]
    h: float
    light: Vector
    true: float
    interval: float
    hansen: float
    second_order: float
    taylor: float  # for the quadrilinear interpolant
    remainder: float


CASES = {
    "sphere beside the highlight": Case(
        on_sphere,
        (0.04, -0.446, 0.045, -0.454),
        0.04,
        (6.03, 4.52, 12.06),
        5.6e-4,
        1.7e-1,
        1.1e-2,
        1.1e-2,
        1.2e-3,
        3.2e-4,
    ),
    "sphere in the highlight": Case(
        on_sphere, (0.208, 0.146, 0.252, 0.15), 0.01, (5.19, 3.89, 10.38), 5.1e-3, 2.0e1, 2.4e-1, 2.0e-1, 1.2e-2, 3.5e-3
    ),
    "plane": Case(
        on_plane, (1.821, 1.09, 0.765, 1.739), 0.02, (52.9, 39.7, 105.7), 5.3e-5, 1.9e-2, 1.5e-3, 9.9e-4, 1.8e-4, 6.6e-5
    ),
    "plane in a mirror sphere": Case(
        in_mirror,
        (-0.243, 0.286, -0.474, 0.507),
        0.005,
        (4.84, 9.69, 14.5),
        6.9e-4,
        3.0e2,
        1.6e-1,
        1.5e-1,
        2.7e-3,
        1.0e-3,
    ),
}
