"""Where surfaces really are, and which points are inside: what bounds and hits are judged by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

import raybound as rb

from . import error_exact as exact
from .error_exact import Doubles, TwoDoubles
from .error_forms import FORMS, Form, Vector, cross, dot, minus, plane, polygon_normal

Faces = npt.NDArray[np.integer[Any]]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Place:
    """An affine map x -> linear x + offset, and the inverse of its linear part."""

    linear: list[list[TwoDoubles]]
    inverse: list[list[TwoDoubles]]
    offset: list[TwoDoubles]


@dataclass(frozen=True)
class Leaf:
    """A primitive and its place in the world; None where it stays."""

    shape: Any
    first_face: int
    place: Place | None

    def local(self, p: Vector, d: Vector) -> tuple[Vector, Vector]:
        """A ray in the primitive's own coordinates."""
        if self.place is None:
            return p, d
        rows: Any = self.place.inverse
        offset: Any = self.place.offset
        if not isinstance(p[0], TwoDoubles):
            rows, offset = [[x.value() for x in row] for row in rows], [x.value() for x in offset]
        w = minus(p, offset)
        return [dot(row, w) for row in rows], [dot(row, d) for row in rows]

    def world(self, points: Doubles) -> Doubles:
        """Points (n, 3) of the primitive's own coordinates in the world's."""
        if self.place is None:
            return points
        p = [TwoDoubles(points[:, i]) for i in range(3)]
        rows = zip(self.place.linear, self.place.offset, strict=True)
        return np.stack([(dot(row, p) + shift).value() for row, shift in rows], axis=1)

    def forms(self, p: Vector, d: Vector) -> list[Form]:
        """The polynomials of all faces; not for meshes."""
        return FORMS[type(self.shape)](self.shape, *self.local(p, d))

    def mesh_form(self, faces: Faces, p: Vector, d: Vector) -> Form:
        """The planes of a mesh's faces, one for each ray."""
        local, way = self.local(p, d)
        corners = np.asarray(self.shape.vertices, np.float64)[np.asarray(self.shape.faces)[faces]]
        a, b, c = ([TwoDoubles(corners[:, k, i]) for i in range(3)] for k in range(3))
        return plane(cross(minus(b, a), minus(c, a)), minus(local, a), way)

    def contains(self, p: Vector) -> Flags:
        """Whether points, of float64 numbers, are inside of a solid."""
        zero = [x * 0.0 for x in p]
        if isinstance(self.shape, rb.Mesh):
            return winding_number(self.shape, np.stack(self.local(p, zero)[0], axis=1)) > 0.5
        inside: Flags = np.all([form[0] <= 0 for form in self.forms(p, zero)], axis=0)
        return inside

    def levels(self) -> tuple[float, float]:
        """The values of a polygon's plane at its vertices, which are not quite in one: lowest and highest."""
        if not isinstance(self.shape, rb.Polygon):
            return 0.0, 0.0
        vertices = np.asarray(self.shape.vertices, np.float64)
        normal = polygon_normal(vertices)
        values = dot(normal, minus([TwoDoubles(vertices[:, i]) for i in range(3)], vertices[0])).value()
        return float(values.min()), float(values.max())


@dataclass(frozen=True)
class Tree:
    """The primitives of a shape in the order of their faces, and how they are combined."""

    leaves: list[Leaf]
    member: Any  # ("leaf", index) | ("union" | "intersection", [members])


def tree_of(shape: Any) -> Tree:
    """A shape taken apart."""
    found: list[Leaf] = []
    count = 0

    def visit(s: Any, place: Place | None) -> Any:
        nonlocal count
        if hasattr(s, "transform"):
            return visit(s.shape, placed(place, np.asarray(s.transform.matrix, np.float64)))
        if hasattr(s, "shapes"):
            kind = "union" if isinstance(s, rb.Union) else "intersection"
            return kind, [visit(part, place) for part in s.shapes]
        found.append(Leaf(s, count, place))
        count += s._native.face_count
        return "leaf", len(found) - 1

    member = visit(shape, None)
    return Tree(found, member)


def placed(outer: Place | None, matrix: Doubles) -> Place:
    """The map of a matrix, then that of `outer`."""
    linear = [[exact.of(x) for x in row] for row in matrix[:3, :3].tolist()]
    offset = [exact.of(x) for x in matrix[:3, 3].tolist()]
    if outer is not None:
        offset = [dot(row, offset) + x for row, x in zip(outer.linear, outer.offset, strict=True)]
        linear = [[dot(row, [linear[k][j] for k in range(3)]) for j in range(3)] for row in outer.linear]
    return Place(linear, inverse(linear), offset)


def inverse(m: list[list[TwoDoubles]]) -> list[list[TwoDoubles]]:
    """Of a 3 x 3 matrix, by Cramer's rule."""
    a, b, c = ([m[i][j] for i in range(3)] for j in range(3))
    rows = [cross(b, c), cross(c, a), cross(a, b)]
    determinant = dot(a, rows[0])
    return [[x / determinant for x in row] for row in rows]


class Oracle:
    """The faces of one shape."""

    def __init__(self, shape: Any) -> None:
        tree = tree_of(shape)
        self.leaves, self.member = tree.leaves, tree.member
        self.firsts = np.array([leaf.first_face for leaf in self.leaves])
        self.levels = [leaf.levels() for leaf in self.leaves]

    def along(self, face: Faces, p: Doubles, d: Doubles) -> tuple[Form, Doubles, Doubles]:
        """The polynomial of each ray's face, and the levels between which it counts as the surface: rays (n, 3)."""
        c, b, a = (TwoDoubles(np.zeros(len(face))) for _ in range(3))
        low, high = np.zeros(len(face)), np.zeros(len(face))
        which = np.searchsorted(self.firsts, face, side="right") - 1
        for index in np.unique(which):
            leaf, mine = self.leaves[index], which == index
            local = face[mine] - leaf.first_face
            ray = [TwoDoubles(p[mine, i]) for i in range(3)], [TwoDoubles(d[mine, i]) for i in range(3)]
            form = leaf.mesh_form(local, *ray) if isinstance(leaf.shape, rb.Mesh) else _chosen(leaf.forms(*ray), local)
            for total, part in zip((c, b, a), form, strict=True):
                total.high[mine], total.low[mine] = part.high, part.low
            low[mine], high[mine] = self.levels[index]
        return (c, b, a), low, high

    def contains(self, points: Doubles) -> Flags:
        """Whether each point (n, 3) is inside of a solid, decided in float64."""
        p = list(points.T)
        inside = [leaf.contains(p) for leaf in self.leaves]

        def evaluate(member: Any) -> Flags:
            kind, parts = member
            if kind == "leaf":
                flags: Flags = inside[parts]
                return flags
            values = [evaluate(part) for part in parts]
            combined: Flags = (np.any if kind == "union" else np.all)(values, axis=0)
            return combined

        return evaluate(self.member)


def _chosen(forms: list[Form], face: Faces) -> Form:
    """Of several polynomials for each ray, that of its face."""
    parts = []
    for k in range(3):
        candidates = [exact.of(form[k]) for form in forms]
        high, low = (
            np.stack([np.broadcast_to(half, face.shape) for half in halves])
            for halves in ([x.high for x in candidates], [x.low for x in candidates])
        )
        rays = np.arange(len(face))
        parts.append(TwoDoubles(high[face, rays], low[face, rays]))
    return parts[0], parts[1], parts[2]


def nearest_root(form: Form, level: Doubles, t: Doubles) -> TwoDoubles:
    """The root of C + 2 B t + A t^2 = level nearest to t; without a real one, where the polynomial is nearest to it."""
    c, b, a = form[0] - level, form[1], form[2]
    square = b * b - a * c
    q = b + exact.where(b.value() < 0, -square.sqrt(), square.sqrt())
    with np.errstate(all="ignore"):
        near, far = -c / q, -q / a
        linear, flat = a.value() == 0, q.value() == 0
        far = exact.where(linear, near, far)
        near = exact.where(flat, far, near)
        distance = [np.abs((root - t).value()) for root in (near, far)]
    return exact.where(~(distance[1] < distance[0]), near, far)


def winding_number(mesh: Any, points: Doubles) -> Doubles:
    """How often a closed mesh goes around each point: the solid angles of its faces (Van Oosterom and Strackee)."""
    corners = np.asarray(mesh.vertices, np.float64)[np.asarray(mesh.faces)]
    a, b, c = (corners[None, :, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=2) for v in (a, b, c))
    volume = np.sum(a * np.cross(b, c), axis=2)
    below = la * lb * lc + lc * np.sum(a * b, axis=2) + la * np.sum(b * c, axis=2) + lb * np.sum(c * a, axis=2)
    total: Doubles = np.arctan2(volume, below).sum(axis=1) / (2 * np.pi)
    return total
