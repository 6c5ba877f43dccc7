"""Checks hits against the oracle and keeps the worst of what was seen."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from flint import arb

import raybound as rb

from .support_oracle import Found, Leaf, Model, along, build, dot, exact, first_change, first_hit, real_roots

UNIT = 2.0**-24  # float32's unit roundoff
CORNERS = list(product((-1, 1), repeat=3))


@dataclass
class Tally:
    """Counts, the largest ratios of error to bound, and what went wrong."""

    counts: Counter = field(default_factory=Counter)
    worst: dict[str, float] = field(default_factory=dict)
    failures: list[tuple[Any, ...]] = field(default_factory=list)

    def see(self, name: str, ratio: float) -> None:
        self.worst[name] = max(self.worst.get(name, 0.0), ratio)

    def fail(self, what: str, *details: Any) -> None:
        self.counts[what] += 1
        if len(self.failures) < 5:
            self.failures.append((what, *details))

    def __str__(self) -> str:
        return f"{dict(self.counts)}, worst {self.worst}, first failures {self.failures[:2]}"


def offsets_of_plane(leaf: Leaf) -> list[arb]:
    """A polygon is planar up to rounding: the values of its plane's polynomial at its vertices; 0 for other shapes."""
    if not isinstance(leaf.shape, rb.Polygon):
        return [arb(0)]
    zero = [arb(0)] * 3
    return [leaf.forms(leaf.numbers, v, zero)[0][0] for v in leaf.numbers.vertices]


def ratio_of(error: arb, bound: arb) -> float:
    """error / bound, infinite where a bound of zero is exceeded."""
    if bound == 0:
        return 0.0 if error == 0 else float("inf")
    return float(error / bound)


def t_ratio(leaf: Leaf, face: int, o: list[arb], d: list[arb], t: arb, t_error: arb) -> float:
    c, b, a = leaf.along(o, d)[face]
    roots = [r.mid() for offset in offsets_of_plane(leaf) for r in real_roots((c - offset, b, a))]
    if not roots:
        return float("inf")
    if isinstance(leaf.shape, rb.Polygon) and any(r > t for r in roots) and any(r < t for r in roots):
        return 0.0  # between the planes through its vertices
    return ratio_of(min((abs(r - t) for r in roots), key=float), t_error)


def corners(p: list[arb], e: list[arb]) -> list[list[arb]]:
    return [[x + s * y for x, s, y in zip(p, signs, e)] for signs in CORNERS]


def holds_surface(leaf: Leaf, face: int, p: list[arb], e: list[arb]) -> bool:
    """Does the box p +- e surely hold a point where the face's polynomial vanishes?"""
    values = [leaf.value(face, c) for c in [p, *corners(p, e)]]
    levels = offsets_of_plane(leaf)
    return any(v >= min(levels, key=float) for v in values) and any(v <= max(levels, key=float) for v in values)


def reaches_face(leaf: Leaf, face: int, p: list[arb], slack: float) -> bool:
    """Is p, up to `slack` in each coordinate, within the other polynomials: on the face, not on its extension?"""
    spread = corners(p, [arb(slack)] * 3)
    forms = [leaf.along(c, [arb(0)] * 3) for c in spread]
    return all(any(f[i][0] <= 0 for f in forms) for i in range(len(forms[0])) if i != face)


def numerical_normal(leaf: Leaf, face: int, p: list[arb]) -> list[float]:
    """The unit outward normal by central differences, which are exact for polynomials of degree two."""
    gradient = []
    for i in range(3):
        step = [arb(1) if j == i else arb(0) for j in range(3)]
        gradient.append(leaf.value(face, along(p, step, arb(1))) - leaf.value(face, along(p, step, arb(-1))))
    size = dot(gradient, gradient).sqrt()
    return [0.0, 0.0, 0.0] if not size > 0 else [float(g / size) for g in gradient]


def normal_error(leaf: Leaf, face: int, p: list[arb], e: list[arb], normal: np.ndarray) -> float:
    """How far the normal is outside the hull of the true normals in the box p +- e."""
    seen = np.array([numerical_normal(leaf, face, c) for c in [p, *corners(p, e)]])
    return float(np.max(np.maximum(seen.min(axis=0) - normal, normal - seen.max(axis=0))))


def explained(model: Model, origin: Any, direction: Any, accepts: Any, *, ulps: float = 64, tries: int = 256) -> bool:
    """Would a ray that is moved by some rounding errors have an answer that `accepts`? The moves are at most `ulps`
    float32 roundings of the distance to the shape and of its coordinates."""
    rng = np.random.default_rng(5)
    leaf = model.leaves[0]
    center = [0.0] * 3 if leaf.offset is None else [float(x) for x in leaf.offset]
    reach = float(np.max(np.abs(np.asarray(origin, float)))) + max(map(abs, center))
    size = float(np.max(np.abs(direction)))
    if not leaf.is_sheet and accepts(first_change(model, origin, direction, ulps * UNIT * reach / size)):
        return True
    for _ in range(tries):
        shift = ulps * 2 ** rng.uniform(-7, 0) * UNIT * reach * rng.uniform(-1, 1, 3)
        turn = 8 * UNIT * size * rng.uniform(-1, 1, 3)
        if accepts(first_hit(model, np.asarray(origin, float) + shift, np.asarray(direction, float) + turn)):
            return True
    return False


def normal_limit(leaf: Leaf, shape: rb.Shape) -> float:
    """Four roundings; a polygon's vertices are rounded where they are placed, which tilts it."""
    tilt = np.abs(shape.bounds).max() / np.ptp(shape.bounds, axis=0).max() if isinstance(leaf.shape, rb.Polygon) else 1
    return 4 * UNIT * max(1.0, float(tilt))


def check_hit(tally: Tally, model: Model, o: Any, d: Any, hit: Any, context: Any) -> None:
    """The bounds of one hit, against the polynomial of the face that it names."""
    face = int(hit["face_id"])
    leaf = model.leaf_of_face(face)
    local = face - leaf.first_face
    p, e = exact(hit["point"]), exact(hit["point_error"])
    ratio = t_ratio(leaf, local, exact(o), exact(d), arb(float(hit["t"])), arb(float(hit["t_error"])))
    tally.see("t", ratio)
    if ratio > 1:
        tally.fail("t outside its error", ratio, context, o, d)
    if not holds_surface(leaf, local, p, e):
        tally.fail("no surface in the box", context, o, d, hit)
    slack = 8 * UNIT * float(max(np.max(np.abs(hit["point"])), np.max(np.abs(context.bounds))))
    if not reaches_face(leaf, local, p, slack):
        tally.fail("point beside its face", context, o, d, hit)
    error = normal_error(leaf, local, p, e, hit["normal"])
    tally.see("normal", error)
    if error > normal_limit(leaf, context):
        tally.fail("normal", error, context, o, d, hit)


def check_rays(tally: Tally, shape: rb.Shape, origins: Any, directions: Any, precision: str = "float32") -> np.ndarray:
    """All rays of one shape: hit or miss, face, bounds."""
    model = build(shape)
    hits = rb.intersect(shape, origins, directions, precision=precision)
    for o, d, hit in zip(origins, directions, hits):
        found = first_hit(model, o, d)
        tally.counts["rays"] += 1
        if agrees(found, hit):
            tally.counts["agree"] += 1
        elif explained(model, o, d, lambda f, h=hit: agrees(f, h)):
            tally.counts["within rounding"] += 1
        else:
            tally.fail("wrong", shape, o, d, found, hit)
        if hit["hit"]:
            tally.counts["hits"] += 1
            check_hit(tally, model, o, d, hit, shape)
    return hits


def agrees(found: Found | None, hit: Any) -> bool:
    return (found is not None) == bool(hit["hit"]) and (found is None or int(hit["face_id"]) in found.faces)
