"""Shapes: immutable values. Their geometry is the core's; here are their names, arguments and printing."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _validate
from ._nest import Nest
from ._validate import DoubleArray, FloatArray, Vector, packed
from ._value import Value
from .transform import Transform, rounded


class Shape(Value):
    """The base of all shapes: immutable values that can be compared, hashed, printed and pickled.

    Shapes of shapes may nest to any depth.
    """

    _native: _core.Shape

    @property
    def bounds(self) -> DoubleArray:
        """The box around the shape: (2, 3) float64, lower and upper corner, scene units, to within double rounding."""
        return self._native.bounds()

    def transformed(self, t: Transform) -> Transformed:
        """The shape moved by the transform `t`, whose entries are rounded to float32."""
        return Transformed(self, t)

    def __or__(self, other: object) -> Union:
        """`a | b` is `Union(a, b)`; ValueError if one of them is not solid."""
        return Union(self, other) if isinstance(other, Shape) else NotImplemented

    def __and__(self, other: object) -> Intersection:
        """`a & b` is `Intersection(a, b)`; ValueError if one of them is not solid."""
        return Intersection(self, other) if isinstance(other, Shape) else NotImplemented

    def __sub__(self, other: object) -> Difference:
        """`a - b` is `Difference(a, b)`; ValueError if one of them is not solid, or nothing is left."""
        return Difference(self, other) if isinstance(other, Shape) else NotImplemented

    def contains(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Which points lie inside: `points` is (..., 3), scene units, float64; returns a (...) bool array.

        ValueError for open surfaces: disks, polygons, and meshes with a border. Points within rounding of the surface
        may count either way.
        """
        given = _validate.points(f"{type(self).__name__}.contains", "points", points)
        rows = np.ascontiguousarray(given.reshape(-1, 3))
        try:
            return _core.shape_contains(self._native, rows).reshape(given.shape[:-1])
        except ValueError:
            raise ValueError(
                f"{type(self).__name__}.contains: the shape must be closed, got {_validate.describe(self)}"
            ) from None


class Sphere(Shape):
    """A solid sphere. `center`: 3 numbers; `radius` > 0; scene units. ValueError, TypeError on bad input."""

    center: Vector
    radius: float

    def __init__(self, center: npt.ArrayLike = (0.0, 0.0, 0.0), radius: float = 1.0) -> None:
        self._set(center=_validate.vector("Sphere", "center", center))
        self._set(radius=_validate.positive("Sphere", "radius", radius))
        self._set(_native=_core.sphere(packed(self.center), self.radius))


class Box(Shape):
    """A solid box along the axes, from corner `min` to corner `max` (3 numbers each, min below max); scene units."""

    min: Vector
    max: Vector

    def __init__(self, min: npt.ArrayLike = (-1.0, -1.0, -1.0), max: npt.ArrayLike = (1.0, 1.0, 1.0)) -> None:
        self._set(min=_validate.vector("Box", "min", min), max=_validate.vector("Box", "max", max))
        self._set(_native=_core.box(packed(self.min), packed(self.max)))


class Cylinder(Shape):
    """A solid cylinder with caps. `base`, `top`: the centres of its caps, different; `radius` > 0; scene units."""

    base: Vector
    top: Vector
    radius: float

    def __init__(
        self, base: npt.ArrayLike = (0.0, 0.0, 0.0), top: npt.ArrayLike = (0.0, 0.0, 1.0), *, radius: float = 1.0
    ) -> None:
        self._set(base=_validate.vector("Cylinder", "base", base), top=_validate.vector("Cylinder", "top", top))
        self._set(radius=_validate.positive("Cylinder", "radius", radius))
        self._set(_native=_core.cylinder(packed(self.base), packed(self.top), self.radius))


class Cone(Shape):
    """A solid cone with caps, truncated if `top_radius` > 0.

    `base`, `apex`: the centres of its ends, different; `radius` > 0 at the base, `top_radius` >= 0 at the apex; scene
    units.
    """

    base: Vector
    apex: Vector
    radius: float
    top_radius: float

    def __init__(
        self,
        base: npt.ArrayLike = (0.0, 0.0, 0.0),
        apex: npt.ArrayLike = (0.0, 0.0, 1.0),
        *,
        radius: float = 1.0,
        top_radius: float = 0.0,
    ) -> None:
        self._set(base=_validate.vector("Cone", "base", base), apex=_validate.vector("Cone", "apex", apex))
        self._set(radius=_validate.positive("Cone", "radius", radius))
        self._set(top_radius=_validate.number("Cone", "top_radius", top_radius))
        self._set(_native=_core.cone(packed(self.base), packed(self.apex), self.radius, self.top_radius))


class Disk(Shape):
    """A flat disk. `normal`: 3 numbers, non-zero, of any length; `radius` > 0; scene units. Not a solid."""

    center: Vector
    normal: Vector
    radius: float

    def __init__(
        self, center: npt.ArrayLike = (0.0, 0.0, 0.0), normal: npt.ArrayLike = (0.0, 0.0, 1.0), *, radius: float = 1.0
    ) -> None:
        self._set(
            center=_validate.vector("Disk", "center", center), normal=_validate.direction("Disk", "normal", normal)
        )
        self._set(radius=_validate.positive("Disk", "radius", radius))
        self._set(_native=_core.disk(packed(self.center), packed(self.normal), self.radius))


class Polygon(Shape):
    """A convex planar polygon. Not a solid.

    `vertices`: (n, 3) array_like, n >= 3, planar up to the rounding of its vertices to float32, counter-clockwise as
    seen from outside; scene units. Reading them gives a read-only (n, 3) float32 array. ValueError if not convex or not
    planar.
    """

    vertices: FloatArray

    def __init__(self, vertices: npt.ArrayLike) -> None:
        kept = _validate.array("Polygon", "vertices", vertices, shape=(None, 3))
        if len(kept) < 3:
            raise ValueError(f"Polygon: vertices must be at least 3 points, got {len(kept)}")
        native = _core.polygon(kept)
        kept.flags.writeable = False
        self._set(vertices=kept, _native=native)


class Quadric(Shape):
    """The solid q <= 0 of a quadric within a box: paraboloids, hyperboloids, ellipsoids, saddles, ...

    `coefficients`: ten numbers (A, B, C, D, E, F, G, H, I, J), not all of A to I zero, in
    q = A x^2 + B y^2 + C z^2 + D xy + E yz + F xz + G x + H y + I z + J; `clip`: a Box; scene units. Face 0 is the
    quadric, faces 1 to 6 are the box's (-x, +x, -y, +y, -z, +z). On face 0 u is the longitude about the middle of the
    box, from +x, and v the height in the box; the others carry (u, v) as a Box does. `bounds` are those of the solid,
    wider by at most 1e-6 of the box but for very thin solids. ValueError if nothing is inside.
    """

    coefficients: tuple[float, ...]
    clip: Box

    def __init__(self, coefficients: npt.ArrayLike, clip: Box = Box()) -> None:  # noqa: B008  # immutable
        kept = _validate.array("Quadric", "coefficients", coefficients, shape=(10,))
        box = _validate.instance("Quadric", "clip", clip, Box, "a Box")
        native = _core.quadric(kept, packed(box.min), packed(box.max))
        self._set(coefficients=tuple(kept.tolist()), clip=box, _native=native)


class _Combination(Nest, Shape):
    """What unions, intersections and differences share: a tuple of shapes."""

    _nested = "shapes"
    shapes: tuple[Shape, ...]

    def _combine(self, shapes: tuple[object, ...]) -> list[_core.Shape]:
        who = type(self).__name__
        checked = tuple(_validate.instance(who, f"shape {i}", s, Shape, "a Shape") for i, s in enumerate(shapes))
        if not checked:
            raise ValueError(f"{who}: shapes must be one or more, got none")
        for i, shape in enumerate(checked):
            if not shape._native.is_solid:
                raise ValueError(f"{who}: shape {i} must be a solid, got {_validate.describe(shape)}")
        self._set(shapes=checked)
        return [shape._native for shape in checked]

    def _arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        return self.shapes, {}

    def replace(self, **changes: Any) -> Any:
        """A copy with other `shapes` (a sequence of shapes)."""
        unknown = sorted(changes.keys() - {"shapes"})
        if unknown:
            raise TypeError(f"{type(self).__name__}.replace: unknown argument {unknown[0]!r} (expected 'shapes')")
        return type(self)(*changes.get("shapes", self.shapes))

    def _pieces(self) -> list[str | Value]:
        inside = [piece for shape in self.shapes for piece in (", ", shape)][1:]
        return [f"{type(self).__name__}(", *inside, ")"]


class Union(_Combination):
    """The union of solids, itself a solid without inner walls: `Union(a, b, ...)` or `a | b`.

    `shapes` is the tuple of its parts. ValueError if a part is not solid; TypeError if it is not a shape.
    """

    def __init__(self, *shapes: Shape) -> None:
        self._set(_native=_core.csg_union(self._combine(shapes)))


class Intersection(_Combination):
    """The intersection of solids, itself a solid: `Intersection(a, b, ...)` or `a & b`.

    `shapes` is the tuple of its parts. ValueError if a part is not solid; TypeError if it is not a shape.
    """

    def __init__(self, *shapes: Shape) -> None:
        self._set(_native=_core.csg_intersection(self._combine(shapes)))


class Difference(_Combination):
    """The first solid without the others, itself a solid: `Difference(a, b, ...)` or `a - b`.

    `shapes` is the tuple of its parts. Faces count as for a union: those of the first part, then of the others, whose
    normals point out of what is left. ValueError if a part is not solid, or if one of the others certainly holds all of
    the first; TypeError if a part is not a shape.
    """

    def __init__(self, *shapes: Shape) -> None:
        parts = self._combine(shapes)
        for i, shape in enumerate(shapes[1:], 1):
            if shape == shapes[0]:
                raise ValueError(f"Difference: shape {i} must differ from shape 0, the difference encloses nothing")
        self._set(_native=_core.csg_difference(parts))


class Transformed(Nest, Shape):
    """A shape moved by a transform: `shape.transformed(t)`. Fields: `shape`, `transform` (rounded to float32)."""

    _nested = "shape"
    shape: Shape
    transform: Transform

    def __init__(self, shape: Shape, transform: Transform) -> None:
        inner = _validate.instance("transformed", "shape", shape, Shape, "a Shape")
        by = _validate.instance("transformed", "t", transform, Transform)
        by = rounded("transformed", "t", by)
        self._set(shape=inner, transform=by, _native=_core.transformed(inner._native, np.array(by.matrix)))

    def _pieces(self) -> list[str | Value]:
        return [self.shape, f".transformed({self.transform!r})"]
