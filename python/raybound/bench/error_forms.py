"""The surfaces of primitives as users describe them, as polynomials.

A face is where a polynomial of degree at most two vanishes, written from the geometric definition and scaled so that
nothing is divided. Along p + t d it is C + 2 B t + A t^2, negative inside. Numbers are `TwoDoubles`, or float64 arrays
where rounding does not matter.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

import raybound as rb

from . import error_exact as exact
from .error_exact import Doubles, TwoDoubles

Vector = Sequence[Any]  # three numbers, each perhaps an array
Form = tuple[Any, Any, Any]  # C, B, A


def dot(a: Vector, b: Vector) -> Any:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a: Vector, b: Vector) -> list[Any]:
    """The difference."""
    return [x - y for x, y in zip(a, b, strict=True)]


def cross(a: Vector, b: Vector) -> list[Any]:
    """The vector product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def number_like(p: Vector, x: float) -> Any:
    """The number x, of the kind that p has."""
    return exact.of(x) if isinstance(p[0], TwoDoubles) else x


def plane(n: Vector, w: Vector, d: Vector) -> Form:
    """The half-space n . w <= 0."""
    return dot(n, w), dot(n, d) * 0.5, d[0] * 0.0


def _sphere(s: Any, p: Vector, d: Vector) -> list[Form]:
    w = minus(p, s.center)
    return [(dot(w, w) - number_like(p, s.radius) * s.radius, dot(w, d), dot(d, d))]


def _box(s: Any, p: Vector, d: Vector) -> list[Form]:
    forms: list[Form] = []
    for i in range(3):
        forms.append((-(p[i] - s.min[i]), d[i] * -0.5, d[i] * 0.0))
        forms.append((p[i] - s.max[i], d[i] * 0.5, d[i] * 0.0))
    return forms


def _caps(l2: Any, s: Any, sd: Any) -> list[Form]:
    return [(-s, sd * -0.5, sd * 0.0), (s - l2, sd * 0.5, sd * 0.0)]


def _cone(c: Any, p: Vector, d: Vector) -> list[Form]:
    """Of a cone, and of a cylinder: the distance from the axis squared, less (radius - slope s)^2, times l^2 or l^4."""
    cylinder = isinstance(c, rb.Cylinder)
    axis = minus([number_like(p, x) for x in (c.top if cylinder else c.apex)], c.base)
    w = minus(p, c.base)
    l2, s, sd = dot(axis, axis), dot(w, axis), dot(d, axis)
    if cylinder:
        r2 = number_like(p, c.radius) * c.radius
        return [
            (l2 * dot(w, w) - s * s - r2 * l2, l2 * dot(w, d) - s * sd, l2 * dot(d, d) - sd * sd),
            *_caps(l2, s, sd),
        ]
    k = number_like(p, c.radius) - c.top_radius
    reach = l2 * c.radius - k * s
    side = (
        l2 * (l2 * dot(w, w) - s * s) - reach * reach,
        l2 * (l2 * dot(w, d) - s * sd) + reach * k * sd,
        l2 * (l2 * dot(d, d) - sd * sd) - k * k * sd * sd,
    )
    return [side, *_caps(l2, s, sd)]


def _disk(s: Any, p: Vector, d: Vector) -> list[Form]:
    return [plane(s.normal, minus(p, s.center), d)]


def polygon_normal(vertices: Doubles) -> list[TwoDoubles]:
    """Newell's normal, of twice the area."""
    v = [[exact.of(x) for x in vertex] for vertex in vertices.tolist()]
    parts = [cross(minus(a, v[0]), minus(b, v[0])) for a, b in itertools.pairwise(v[1:])]
    return [sum((part[i] for part in parts[1:]), parts[0][i]) for i in range(3)]


def _polygon(s: Any, p: Vector, d: Vector) -> list[Form]:
    vertices = np.asarray(s.vertices, np.float64)
    return [plane(polygon_normal(vertices), minus(p, vertices[0]), d)]


def _quadric(s: Any, p: Vector, d: Vector) -> list[Form]:
    a, b, c, yx, zy, zx, *linear, constant = (float(x) for x in s.coefficients)

    def half_gradient(v: Vector) -> list[Any]:
        return [
            v[0] * a + (v[1] * yx + v[2] * zx) * 0.5,
            v[1] * b + (v[0] * yx + v[2] * zy) * 0.5,
            v[2] * c + (v[1] * zy + v[0] * zx) * 0.5,
        ]

    at, way = half_gradient(p), half_gradient(d)
    form = (dot(at, p) + dot(p, linear) + constant, dot(at, d) + dot(d, linear) * 0.5, dot(way, d))
    return [form, *_box(s.clip, p, d)]


FORMS: dict[type, Callable[[Any, Vector, Vector], list[Form]]] = {
    rb.Sphere: _sphere,
    rb.Box: _box,
    rb.Cylinder: _cone,
    rb.Cone: _cone,
    rb.Disk: _disk,
    rb.Polygon: _polygon,
    rb.Quadric: _quadric,
}
