"""Random nested CSG expressions, and solids against point membership along rays."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import numpy as np

import raybound as rb

from .support_hits import Tally, explained
from .support_oracle import Found, build, first_change
from .support_shapes import QUADRICS, SOLIDS, Rng, affine, transform_about, unit


def free_solid(rng: Rng) -> rb.Shape:
    makers = [*SOLIDS.values(), *QUADRICS.values()]
    solid = makers[rng.integers(len(makers))](rng, rng.uniform(0.5, 1.5), rng.normal(size=3) * 0.5)
    if rng.random() < 0.4:
        solid = solid.transformed(transform_about(affine(rng, stretch=1.5), np.zeros(3), rng.normal(size=3) * 0.3))
    return solid


def grid_solid(rng: Rng) -> rb.Shape:
    """On small whole numbers, so that many faces coincide."""
    corner, kind = rng.integers(-2, 3, 3), rng.integers(4)
    if kind < 2:
        return rb.Box(corner, corner + rng.integers(1, 4, 3))
    if kind == 2:
        return rb.Sphere(corner, int(rng.integers(1, 3)))
    axis = np.eye(3)[rng.integers(3)] * rng.integers(1, 4)
    return rb.Cylinder(corner, corner + axis, radius=int(rng.integers(1, 3)))


def expression(rng: Rng, depth: int, *, grid: bool) -> rb.Shape:
    if depth == 0 or rng.random() < 0.2:
        return grid_solid(rng) if grid else free_solid(rng)
    parts = [expression(rng, depth - 1, grid=grid) for _ in range(rng.integers(2, 4))]
    shape: rb.Shape = rb.Union(*parts)
    choice = rng.random()
    if choice < 0.6:
        with contextlib.suppress(ValueError):  # disjoint, or nothing left
            shape = rb.Intersection(*parts) if choice < 0.3 else rb.Difference(*parts)
    if rng.random() < 0.3:
        shape = shape.transformed(rb.Transform.rotate(rng.uniform(0, 360), unit(rng)))
    return shape


def is_thick(shape: rb.Shape) -> bool:
    """Has it an inside, as far as its bounds tell?"""
    return bool((shape.bounds[1] > shape.bounds[0]).all())


def thick_expressions(rng: Rng, count: int) -> Iterator[rb.Shape]:
    """Of so many random expressions of two levels, those that have an inside."""
    for _ in range(count):
        shape = expression(rng, 2, grid=False)
        if is_thick(shape):
            yield shape


def close(found: Found | None, hit: np.void) -> bool:
    """The first change of membership is the hit: the same face, within the error of t."""
    if found is None or not hit["hit"]:
        return (found is None) == (not hit["hit"])
    return hit["face_id"] in found.faces and abs(float(found.t) - hit["t"]) <= max(
        1.001 * hit["t_error"], 1e-6 * hit["t"]
    )


def check_expression(tally: Tally, shape: rb.Shape, origins: np.ndarray, directions: np.ndarray) -> None:
    model = build(shape)
    for o, d, hit in zip(origins, directions, rb.intersect(shape, origins, directions)):
        found = first_change(model, o, d)
        tally.counts["rays"] += 1
        tally.counts["hits"] += bool(hit["hit"])
        tally.counts["from inside"] += found is not None and found.inside
        if close(found, hit):
            continue
        if explained(model, o, d, lambda f, h=hit: close(f, h)):
            tally.counts["within rounding"] += 1
        else:
            tally.fail("wrong", shape, o, d, found, hit)
