"""The shapes to measure in a hard case: the case's own, and one of every kind in the place and size of one of these."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

import raybound as rb

from ..scene import Scene
from ..scenes.hard.meshes import globe
from .error_exact import Doubles
from .error_oracle import Oracle

Rng = np.random.Generator
OWN = 3  # objects of one kind that are taken from a scene
CONVEX = ("box", "cone", "cylinder", "disk", "ellipsoid", "polygon", "sphere", "truncated cone")
SHEETS = ("disk", "polygon")


@dataclass(frozen=True)
class Body:
    """A shape of a kind, with its bounds (2, 3) and what is known of its surface."""

    kind: str
    shape: Any
    oracle: Oracle
    bounds: Doubles
    is_sheet: bool
    is_convex: bool

    @property
    def middle(self) -> Doubles:
        """The middle of the bounds."""
        middle: Doubles = self.bounds.mean(axis=0)
        return middle

    @property
    def size(self) -> float:
        """Half the longest side of the bounds."""
        return float(np.ptp(self.bounds, axis=0).max() / 2)

    @property
    def reach(self) -> float:
        """The largest coordinate."""
        return float(np.abs(self.bounds).max())


def body_of(shape: Any) -> Body:
    """A body of a shape."""
    kind = kind_of(shape)
    is_sheet = kind in SHEETS
    return Body(kind, shape, Oracle(shape), np.asarray(shape.bounds, np.float64), is_sheet, kind in CONVEX)


def kind_of(shape: Any) -> str:
    """What a shape is called in the tables; transforms do not change it."""
    while hasattr(shape, "transform"):
        shape = shape.shape
    if isinstance(shape, rb.Quadric):
        return quadric_kind(np.asarray(shape.coefficients, np.float64))
    if isinstance(shape, rb.Cone):
        return "truncated cone" if shape.top_radius > 0 else "cone"
    return type(shape).__name__.lower()


def quadric_kind(coefficients: Doubles) -> str:
    """The kind of the surface A x^2 + B y^2 + C z^2 + D x y + E y z + F x z + G x + H y + I z + J = 0."""
    a, b, c, yx, zy, zx, *linear, constant = coefficients
    second = np.array([[a, yx / 2, zx / 2], [yx / 2, b, zy / 2], [zx / 2, zy / 2, c]])
    values = np.linalg.eigvalsh(second)
    if np.abs(values).min() <= 1e-12 * np.abs(values).max():
        return "paraboloid"
    if (values > 0).all() or (values < 0).all():
        return "ellipsoid"
    at_centre = constant - np.dot(linear, np.linalg.solve(second, linear)) / 4
    return "double cone" if at_centre == 0 else "hyperboloid"


def bodies(scene: Scene, rng: Rng) -> Iterator[Body]:
    """A few of a scene's own objects of each kind, the first and last, and one of every kind in place of one of them.

    A kind that cannot stand there (a quadric far below its own rounding) is left out.
    """
    own = [
        item.shape if item.transform == rb.Transform() else item.shape.transformed(item.transform)
        for item in scene.objects
    ]
    seats = []
    for _, group in itertools.groupby(sorted(own, key=kind_of), kind_of):
        members = list(group)
        chosen = members if len(members) <= OWN else [members[0], members[len(members) // 2], members[-1]]
        seats += [body_of(shape) for shape in chosen]
    yield from seats
    for make in ZOO.values():
        seat = seats[int(rng.integers(len(seats)))]
        try:
            yield body_of(make(rng, seat.middle, seat.size))
        except ValueError:
            continue


def _unit(rng: Rng) -> Doubles:
    v = rng.normal(size=3)
    return np.asarray(v / np.linalg.norm(v))


def _sphere(rng: Rng, p: Doubles, r: float) -> Any:
    return rb.Sphere(p, r)


def _box(rng: Rng, p: Doubles, r: float) -> Any:
    half = r * rng.uniform(0.25, 1, 3)
    return rb.Box(p - half, p + half)


def _cylinder(rng: Rng, p: Doubles, r: float) -> Any:
    axis = r * _unit(rng)
    return rb.Cylinder(p - axis, p + axis, radius=r * rng.uniform(0.25, 1))


def _cone(rng: Rng, p: Doubles, r: float) -> Any:
    axis = r * _unit(rng)
    return rb.Cone(p - axis, p + axis, radius=r * rng.uniform(0.25, 1))


def _truncated(rng: Rng, p: Doubles, r: float) -> Any:
    axis, radius = r * _unit(rng), r * rng.uniform(0.25, 1)
    return rb.Cone(p - axis, p + axis, radius=radius, top_radius=radius * rng.uniform(0.05, 0.95))


def _disk(rng: Rng, p: Doubles, r: float) -> Any:
    return rb.Disk(p, _unit(rng), radius=r)


def _basis(rng: Rng) -> Doubles:
    q: Doubles = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turned: Doubles = q * np.sign(np.linalg.det(q))
    return turned


def _polygon(rng: Rng, p: Doubles, r: float) -> Any:
    turn = np.sort(rng.uniform(0, 2 * np.pi, 5)) * 0.5 + np.arange(5) * (np.pi / 5)
    outline = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    return rb.Polygon(p + r * outline @ _basis(rng).T)


def _mesh(rng: Rng, p: Doubles, r: float) -> Any:
    """A closed mesh of 96 faces with bumps."""
    vertices, faces = globe(np.arange(1, 5) * (np.pi / 5), np.arange(12) * (np.pi / 6))
    return rb.Mesh(p + r * rng.uniform(0.85, 1.15, (len(vertices), 1)) * (vertices @ _basis(rng).T), faces)


def _union(rng: Rng, p: Doubles, r: float) -> Any:
    q = p + r * np.array([0.5, 0.25, 0.125])
    return rb.Union(_box(rng, p, 0.75 * r), rb.Sphere(q, r / 2), _cone(rng, p, 0.75 * r))


def _intersection(rng: Rng, p: Doubles, r: float) -> Any:
    q = p + r * np.array([0.5, 0.25, 0.125])
    return rb.Intersection(rb.Sphere(p, r), rb.Box(q - r, q + r), _cylinder(rng, p, r))


def _quadric(*form: float) -> Callable[[Rng, Doubles, float], Any]:
    """A quadric in the box from -1 to 1, turned, scaled and moved."""

    def make(rng: Rng, p: Doubles, r: float) -> Any:
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = r * rng.uniform(0.5, 1, 3) * _basis(rng), p
        return rb.Quadric(form, rb.Box((-1, -1, -1), (1, 1, 1))).transformed(rb.Transform(matrix))

    return make


ZOO: dict[str, Callable[[Rng, Doubles, float], Any]] = {
    "sphere": _sphere,
    "box": _box,
    "cylinder": _cylinder,
    "cone": _cone,
    "truncated cone": _truncated,
    "disk": _disk,
    "polygon": _polygon,
    "mesh": _mesh,
    "union": _union,
    "intersection": _intersection,
    "ellipsoid": _quadric(1.0, 1.5, 2.0, 0, 0, 0, 0, 0, 0, -0.75),
    "paraboloid": _quadric(1.0, 1.5, 0, 0, 0, 0, 0, 0, -1.0, -0.5),
    "hyperboloid of one sheet": _quadric(1.0, 1.5, -1.0, 0, 0, 0, 0, 0, 0, -0.1),
    "hyperboloid of two sheets": _quadric(1.0, 1.5, -1.0, 0, 0, 0, 0, 0, 0, 0.1),
    "double cone": _quadric(1.0, 1.5, -1.0, 0, 0, 0, 0, 0, 0, 0),
}
