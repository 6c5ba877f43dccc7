"""What happened at a pixel, as a tree that prints well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._records import Kind
from .enums import Path, Reason


@dataclass(frozen=True, repr=False)
class Explanation:
    """What happened at a pixel. Prints as an indented tree.

    Attributes
    ----------
    x, y : int
        The pixel.
    object_id : int
        What is seen there, -1 for the background.
    object : str or None
        Its name and shape.
    path, reason : Path, Reason
        How the pixel was made, and why it was traced.
    error_bound : float
        Its certified bound.
    cell : dict or None
        The smallest surface cell around the point: its face, piece and depth in the quadtree, and what it knows of each
        light, by id: "lit", "blocked", "n candidates" or "unknown". None if its renderer keeps none for this revision.
    tree : dict
        The ray tree: kind, origin, direction, hit, object_id, face_id, t, point, normal, radiance, lights,
        total_internal_reflection and children (more such trees).
    labels : dict
        Names and kinds of objects and lights, by ("object" or "light", id).
    """

    x: int
    y: int
    object_id: int
    object: str | None
    path: Path
    reason: Reason
    error_bound: float
    cell: dict[str, Any] | None
    tree: dict[str, Any]
    labels: Mapping[tuple[Kind, int], str]

    def __str__(self) -> str:
        seen = "the background" if self.object is None else f"object {self.object_id}, {self.object}"
        made = f"path {self.path.name}, reason {self.reason.name}, error bound {_number(self.error_bound)}"
        cell = [] if self.cell is None else [f"  cell: {self.cell}"]
        rays = (line for level, ray in walk(self.tree) for line in self._ray(ray, "  " * (level + 1)))
        return "\n".join([f"pixel ({self.x}, {self.y}) shows {seen}; {made}", *cell, *rays])

    __repr__ = __str__

    def _ray(self, ray: Mapping[str, Any], indent: str) -> Iterator[str]:
        """The lines of one ray."""
        yield f"{indent}{ray['kind']} ray from {_vector(ray['origin'])} along {_vector(ray['direction'])}"
        indent += "  "
        if ray["hit"]:
            target = self._name("object", ray["object_id"])
            yield f"{indent}hits {target}, face {ray['face_id']}, at t = {_number(ray['t'])}"
            yield f"{indent}point {_vector(ray['point'])}, normal {_vector(ray['normal'])}"
        else:
            yield f"{indent}meets nothing"
        yield f"{indent}radiance {_vector(ray['radiance'])}"
        for lamp in ray["lights"]:
            yield indent + self._light(lamp)
        if ray["total_internal_reflection"]:
            yield f"{indent}total internal reflection"

    def _light(self, lamp: Mapping[str, Any]) -> str:
        blocker = f" by {self._name('object', lamp['blocker'])}" if lamp["blocker"] >= 0 else ""
        return f"{self._name('light', lamp['id'])}: {lamp['verdict']}{blocker}"

    def _name(self, kind: Kind, id: int) -> str:
        label = self.labels.get((kind, id))
        return f"{kind} {id}" if label is None else f"{kind} {id}, {label}"


def _number(value: float) -> str:
    return str(np.float32(value))


def _vector(values: tuple[float, ...]) -> str:
    return "(" + ", ".join(_number(value) for value in values) + ")"


def walk(tree: Mapping[str, Any]) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Every ray of a tree with its level, parents first. (No recursion: trees may be a thousand rays deep.)"""
    stack = [(0, tree)]
    while stack:
        level, ray = stack.pop()
        yield level, ray
        stack += [(level + 1, child) for child in reversed(ray["children"])]


def ids(tree: Mapping[str, Any]) -> set[tuple[Kind, int]]:
    """Every ("object" or "light", id) in a ray tree; an id of -1 stands for nothing."""
    found: set[tuple[Kind, int]] = set()
    for _, ray in walk(tree):
        found.add(("object", int(ray["object_id"])))
        for lamp in ray["lights"]:
            found |= {("light", int(lamp["id"])), ("object", int(lamp["blocker"]))}
    return found
