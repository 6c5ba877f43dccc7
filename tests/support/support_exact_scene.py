"""What exact arithmetic sees in a scene: objects, distances, shadows; for the shapes that the oracle knows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb

import raybound as rb

from .support_oracle import Model, along, build, exact, first_hit

UNIT = 2.0**-24
START = arb(2) ** -120  # how far from a surface, in lengths of the direction, shadow rays start
KNOWN = (rb.Sphere, rb.Box, rb.Cylinder, rb.Cone, rb.Disk, rb.Polygon)


@dataclass
class Thing:
    """An object, with a ball around it that culls."""

    id: int
    model: Model
    middle: np.ndarray
    radius: float


def is_known(shape: Any) -> bool:
    """Whether the oracle knows the shape and its parts."""
    if isinstance(shape, (rb.Union, rb.Intersection, rb.Difference)):
        return all(is_known(part) for part in shape.shapes)
    return is_known(shape.shape) if hasattr(shape, "transform") else isinstance(shape, KNOWN)


class ExactScene:
    """The objects of a scene at 400 bits."""

    def __init__(self, scene: rb.Scene) -> None:
        self.things = []
        for item in scene.objects:
            moved = item.transform != rb.Transform()
            low, high = item.bounds
            model = build(item.shape.transformed(item.transform) if moved else item.shape)
            self.things.append(Thing(item.id, model, (low + high) / 2, float(np.linalg.norm(high - low)) / 2))

    def near(self, origin: Any, direction: Any) -> list[Thing]:
        """The objects that a line may meet."""
        o, d = np.array([float(x) for x in origin]), np.array([float(x) for x in direction])
        d = d / np.linalg.norm(d)

        def distance(thing: Thing) -> float:
            w = thing.middle - o
            return float(np.linalg.norm(w - (w @ d) * d)) - thing.radius - 1e-6 * float(np.linalg.norm(w))

        return [thing for thing in self.things if distance(thing) < 1e-3 * thing.radius]

    def first(self, origin: Any, direction: Any) -> tuple[int, arb | None]:
        """The object that an exact ray meets first, and t; (-1, None) for none. Ties go to the lower id."""
        best: tuple[int, arb | None] = (-1, None)
        for thing in self.near(origin, direction):
            found = first_hit(thing.model, origin, direction)
            if found is not None and (best[1] is None or found.t < best[1]):
                best = (thing.id, found.t)
        return best

    def is_lit(self, point: Any, light: Any) -> bool:
        """Whether nothing is between a point of a surface and the light, which faces it."""
        p = exact(point)
        if isinstance(light, rb.DirectionalLight):
            toward, end = [-x for x in exact(light.direction)], None
        else:
            toward, end = [x - y for x, y in zip(exact(light.position), p)], arb(1)
        start = along(p, toward, START)
        for thing in self.near(start, toward):
            found = first_hit(thing.model, start, toward)
            if found is not None and (end is None or found.t < end):
                return False
        return True


def moved(rng: np.random.Generator, values: Any, reach: Any) -> np.ndarray:
    """The values, each moved by at most `reach`, by very little as often as by much."""
    values = np.array([float(v) for v in values])
    return values + np.asarray(reach) * 2 ** rng.uniform(-8, 0) * rng.uniform(-1, 1, 3)
