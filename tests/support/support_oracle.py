"""An independent oracle: shapes as users describe them, in arbitrary precision.

Each primitive is a set of points where a few polynomials of degree at most two are <= 0, written from the geometric
definition and scaled so that nothing is divided: they are exact for the floats that describe the shape. A ray is met by
finding the roots of all these polynomials along it and asking on which side of each root the points are members. That
is the same for primitives and for CSG, and has nothing in common with the kernels. Functions are generic: `arb` (with
400 bits) is the reference, NumPy arrays are for many rays at once.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from flint import arb, ctx

import raybound as rb

PRECISION = 400
ctx.prec = PRECISION


def exact(values: Any) -> list[arb]:
    """Floats as arbs, without rounding; arbs stay as they are."""
    return [v if isinstance(v, arb) else arb(float(v)) for v in values]


def dot(a: Any, b: Any) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a: Any, b: Any) -> list[Any]:
    return [x - y for x, y in zip(a, b)]


def along(p: Any, d: Any, t: Any) -> list[Any]:
    return [x + t * y for x, y in zip(p, d)]


def cross(a: Any, b: Any) -> list[Any]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


# A face's polynomial along p + t d is (C, B, A): C + 2 B t + A t^2, <= 0 inside.
Form = tuple[Any, Any, Any]


def sphere_forms(s: Any, p: Any, d: Any) -> list[Form]:
    w = minus(p, s.center)
    return [(dot(w, w) - s.radius * s.radius, dot(w, d), dot(d, d))]


def box_forms(s: Any, p: Any, d: Any) -> list[Form]:
    forms = []
    for i in range(3):
        forms.append((s.min[i] - p[i], -d[i] / 2, 0 * d[i]))
        forms.append((p[i] - s.max[i], d[i] / 2, 0 * d[i]))
    return forms


def cap_forms(length2: Any, s: Any, sd: Any) -> list[Form]:
    return [(-s, -sd / 2, 0 * sd), (s - length2, sd / 2, 0 * sd)]


def cylinder_forms(c: Any, p: Any, d: Any) -> list[Form]:
    axis, w = minus(c.top, c.base), minus(p, c.base)
    l2, s, sd = dot(axis, axis), dot(w, axis), dot(d, axis)
    side = (l2 * dot(w, w) - s * s - c.radius * c.radius * l2, l2 * dot(w, d) - s * sd, l2 * dot(d, d) - sd * sd)
    return [side, *cap_forms(l2, s, sd)]


def cone_forms(c: Any, p: Any, d: Any) -> list[Form]:
    axis, w = minus(c.apex, c.base), minus(p, c.base)
    l2, s, sd, k = dot(axis, axis), dot(w, axis), dot(d, axis), c.radius - c.top_radius
    reach = c.radius * l2 - k * s
    side = (
        l2 * l2 * dot(w, w) - l2 * s * s - reach * reach,
        l2 * l2 * dot(w, d) - l2 * s * sd + reach * k * sd,
        l2 * l2 * dot(d, d) - l2 * sd * sd - k * k * sd * sd,
    )
    return [side, *cap_forms(l2, s, sd)]


def disk_forms(s: Any, p: Any, d: Any) -> list[Form]:
    w = minus(p, s.center)
    return [(dot(w, s.normal), dot(d, s.normal) / 2, 0 * d[0]), (dot(w, w) - s.radius * s.radius, dot(w, d), dot(d, d))]


def newell(vertices: Any) -> list[Any]:
    first = vertices[0]
    parts = [cross(minus(a, first), minus(b, first)) for a, b in itertools.pairwise(vertices[1:])]
    return [sum((part[i] for part in parts[1:]), parts[0][i]) for i in range(3)]


def polygon_forms(s: Any, p: Any, d: Any) -> list[Form]:
    normal = newell(s.vertices)
    w = minus(p, s.vertices[0])
    forms = [(dot(w, normal), dot(d, normal) / 2, 0 * d[0])]
    for a, b in zip(s.vertices, [*s.vertices[1:], s.vertices[0]]):
        outward = cross(minus(b, a), normal)
        forms.append((dot(minus(p, a), outward), dot(d, outward) / 2, 0 * d[0]))
    return forms


def quadric_forms(s: Any, p: Any, d: Any) -> list[Form]:
    a, b, c, yx, zy, zx, *linear, constant = s.coefficients

    def half_gradient(v: Any) -> list[Any]:
        """Of the part of second order."""
        return [
            a * v[0] + (yx * v[1] + zx * v[2]) / 2,
            b * v[1] + (yx * v[0] + zy * v[2]) / 2,
            c * v[2] + (zy * v[1] + zx * v[0]) / 2,
        ]

    at, way = half_gradient(p), half_gradient(d)
    q = (dot(at, p) + dot(linear, p) + constant, dot(at, d) + dot(linear, d) / 2, dot(way, d))
    return [q, *box_forms(s, p, d)]


FORMS: dict[type, tuple[Callable[..., list[Form]], int]] = {
    rb.Sphere: (sphere_forms, 1),
    rb.Box: (box_forms, 6),
    rb.Cylinder: (cylinder_forms, 3),
    rb.Cone: (cone_forms, 3),
    rb.Disk: (disk_forms, 1),
    rb.Polygon: (polygon_forms, 1),
    rb.Quadric: (quadric_forms, 7),
}


class _Numbers:
    """A primitive's arguments in the oracle's numbers."""

    def __init__(self, shape: Any, number: Callable[[float], Any]) -> None:
        for name in ("center", "radius", "min", "max", "base", "top", "apex", "top_radius", "normal"):
            if hasattr(shape, name):
                value = getattr(shape, name)
                setattr(self, name, [number(x) for x in value] if isinstance(value, tuple) else number(value))
        if hasattr(shape, "vertices"):
            self.vertices = [[number(float(x)) for x in v] for v in shape.vertices]
        if hasattr(shape, "coefficients"):
            self.coefficients = [number(x) for x in shape.coefficients]
            self.min, self.max = ([number(x) for x in corner] for corner in (shape.clip.min, shape.clip.max))


@dataclass
class Leaf:
    """A primitive under an affine map, given by its inverse."""

    shape: Any
    numbers: Any
    forms: Callable[..., list[Form]]
    first_face: int
    face_count: int
    linear: list[list[Any]] | None
    offset: list[Any] | None
    inverse: list[list[Any]] | None

    @property
    def is_sheet(self) -> bool:
        return isinstance(self.shape, (rb.Disk, rb.Polygon))

    def local_point(self, p: Any) -> Any:
        return p if self.inverse is None else [dot(row, minus(p, self.offset)) for row in self.inverse]

    def local_direction(self, d: Any) -> Any:
        return d if self.inverse is None else [dot(row, d) for row in self.inverse]

    def along(self, p: Any, d: Any) -> list[Form]:
        """All polynomials along a ray of the world: the faces', then, for sheets, those of the outline."""
        return self.forms(self.numbers, self.local_point(p), self.local_direction(d))

    def value(self, face: int, p: Any) -> Any:
        zero = [0 * p[0]] * 3
        return self.along(p, zero)[face][0]

    def gradient(self, face: int, p: Any) -> list[Any]:
        """The outward gradient of a face's polynomial at a point of the world."""
        one, zero = 0 * p[0] + 1, 0 * p[0]
        axes = [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
        return [2 * self.along(p, axis)[face][1] for axis in axes]


@dataclass
class Model:
    """A shape for the oracle: leaves, and the expression that says which points belong."""

    leaves: list[Leaf] = field(default_factory=list)
    member: Any = None  # ("leaf", i) | ("union" | "intersection" | "difference", [...])

    def leaf_of_face(self, face: int) -> Leaf:
        return next(x for x in self.leaves if x.first_face <= face < x.first_face + x.face_count)


def inverse_of(m: list[list[Any]]) -> list[list[Any]]:
    columns = [[m[i][j] for i in range(3)] for j in range(3)]
    a, b, c = columns
    det = dot(a, cross(b, c))
    return [[x / det for x in row] for row in (cross(b, c), cross(c, a), cross(a, b))]


def compose(outer: Any, matrix: np.ndarray, number: Callable[[float], Any]) -> Any:
    linear = [[number(float(matrix[i, j])) for j in range(3)] for i in range(3)]
    offset = [number(float(matrix[i, 3])) for i in range(3)]
    if outer is None:
        return linear, offset
    rows, shift = outer
    product = [[dot(row, [linear[k][j] for k in range(3)]) for j in range(3)] for row in rows]
    return product, [dot(row, offset) + x for row, x in zip(rows, shift)]


def build(shape: Any, number: Callable[[float], Any] = arb) -> Model:
    model = Model()
    faces = 0

    def visit(s: Any, placement: Any) -> Any:
        nonlocal faces
        if hasattr(s, "transform"):
            return visit(s.shape, compose(placement, s.transform.matrix, number))
        if hasattr(s, "shapes"):
            kind = {rb.Union: "union", rb.Intersection: "intersection", rb.Difference: "difference"}[type(s)]
            return kind, [visit(part, placement) for part in s.shapes]
        forms, count = FORMS[type(s)]
        linear, offset = placement or (None, None)
        inverse = None if linear is None else inverse_of(linear)
        model.leaves.append(Leaf(s, _Numbers(s, number), forms, faces, count, linear, offset, inverse))
        faces += count
        return "leaf", len(model.leaves) - 1

    model.member = visit(shape, None)
    return model


def at(form: Form, t: Any) -> Any:
    c, b, a = form
    return c + t * (2 * b + a * t)


def real_roots(form: Form) -> list[arb]:
    """The roots of a polynomial along a ray, at 400 bits; none where it surely has none."""
    c, b, a = form
    if a == 0 or abs(a) < arb(2) ** -1000:
        return [] if b == 0 or b.contains(0) else [-c / (2 * b)]
    disc = b * b - a * c
    if not disc >= 0:
        return []
    root = disc.sqrt()
    q = -(b + root) if b >= 0 else -(b - root)
    if q.contains(0):
        return [-b / a]
    return [q / a, c / q]


def is_member(member: Any, inside: list[bool]) -> bool:
    kind, parts = member
    if kind == "leaf":
        return inside[parts]
    if kind == "difference":
        return is_member(parts[0], inside) and not any(is_member(part, inside) for part in parts[1:])
    combine = any if kind == "union" else all
    return combine(is_member(part, inside) for part in parts)


@dataclass
class Found:
    """The first change of membership along a ray (t > 0): where, and the faces that are there."""

    t: arb
    faces: list[int]
    inside: bool  # is the origin a member?


def first_change(model: Model, origin: Any, direction: Any, thin: float = 0.0) -> Found | None:
    """Exact first boundary of a solid along an exact ray; gaps and walls shorter than `thin` in t are ignored."""
    o, d = exact(origin), exact(direction)
    lines = [leaf.along(o, d) for leaf in model.leaves]
    roots = [
        (t.mid(), leaf.first_face + face)
        for leaf, forms in zip(model.leaves, lines)
        for face, form in enumerate(forms)
        for t in real_roots(form)
        if t > 0
    ]
    roots.sort(key=lambda r: r[0])

    def inside_at(t: arb) -> bool:
        return is_member(model.member, [all(at(f, t) <= 0 for f in forms) for forms in lines])

    start = inside_at(roots[0][0] / 2 if roots else arb(1))
    i = 0
    while i < len(roots):
        j = i
        while j + 1 < len(roots) and roots[j + 1][0] - roots[j][0] <= thin + roots[j][0] * arb(2) ** -180:
            j += 1
        behind = (roots[j][0] + roots[j + 1][0]) / 2 if j + 1 < len(roots) else roots[j][0] * 2 + 1
        if inside_at(behind) != start:
            return Found(roots[i][0], [face for _, face in roots[i : j + 1]], start)
        i = j + 1
    return None


def sheet_crossing(model: Model, origin: Any, direction: Any) -> Found | None:
    """The crossing of a disk or polygon."""
    o, d = exact(origin), exact(direction)
    plane, *outline = model.leaves[0].along(o, d)
    for t in real_roots(plane):
        if t > 0 and all(at(f, t) <= 0 for f in outline):
            return Found(t.mid(), [0], False)
    return None


def first_hit(model: Model, origin: Any, direction: Any) -> Found | None:
    return (sheet_crossing if model.leaves[0].is_sheet else first_change)(model, origin, direction)
