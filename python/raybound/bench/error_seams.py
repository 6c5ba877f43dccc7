"""Rays at edges that solids or polygons of a scene share: no light may come through."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

import numpy as np

import raybound as rb

from .. import _core
from ..scene import Scene
from .error_bodies import Rng
from .error_exact import Doubles
from .error_rays import rounded, toward

Edge = tuple[tuple[float, ...], tuple[float, ...]]
FLAT = 1e-3  # rays nearer to the plane of a joint may pass beside it


def shared_edges(scene: Scene) -> list[tuple[Any, Any, Edge, Doubles]]:
    """Pairs of shapes with an edge that they share, and the normal of the flat surface that they form there."""
    found: list[tuple[Any, Any, Edge, Doubles]] = []
    whole = [item.shape for item in scene.objects if item.transform == rb.Transform()]
    parts = [part for shape in whole for part in _parts(shape)]
    for a, b in itertools.combinations([part for part in parts if isinstance(part, rb.Box)], 2):
        found += [(a, b, edge, normal) for edge, normal in _box_edges(a, b)]
    by_edge: dict[frozenset[tuple[float, ...]], list[Any]] = {}
    for polygon in (part for part in parts if isinstance(part, rb.Polygon)):
        corners = [tuple(map(float, v)) for v in polygon.vertices]
        for pair in zip(corners, corners[1:] + corners[:1], strict=True):
            by_edge.setdefault(frozenset(pair), []).append(polygon)
    for ends, owners in by_edge.items():
        if len(owners) == 2:
            first, second = ends
            normal = _normal(owners[0])
            if np.abs(np.cross(normal, _normal(owners[1]))).max() < 1e-6:
                found.append((*owners, (first, second), normal))
    return found


def _parts(shape: Any) -> Iterator[Any]:
    """What a union is made of."""
    if isinstance(shape, rb.Union):
        for part in shape.shapes:
            yield from _parts(part)
    else:
        yield shape


def _normal(polygon: Any) -> Doubles:
    v = np.asarray(polygon.vertices, np.float64)
    n = np.cross(v[1] - v[0], v[2] - v[0])
    normal: Doubles = n / np.linalg.norm(n)
    return normal


def _box_edges(a: Any, b: Any) -> list[tuple[Edge, Doubles]]:
    """Of a common face of two boxes, its edges, each with the normal of the two faces that meet flat in it."""
    for i in range(3):
        others = [k for k in range(3) if k != i]
        for low, high in ((a, b), (b, a)):
            if low.max[i] == high.min[i] and all(a.min[k] == b.min[k] and a.max[k] == b.max[k] for k in others):
                return [_box_edge(low, i, along, across, s) for along, across in (others, others[::-1]) for s in (0, 1)]
    return []


def _box_edge(box: Any, i: int, along: int, across: int, side: int) -> tuple[Edge, Doubles]:
    ends = []
    for end in (box.min, box.max):
        corner = [0.0, 0.0, 0.0]
        corner[i], corner[along], corner[across] = box.max[i], end[along], (box.min, box.max)[side][across]
        ends.append(tuple(corner))
    return (ends[0], ends[1]), np.eye(3)[across]


def leaks(scene: Scene, precision: str, count: int, rng: Rng) -> tuple[int, int]:
    """How many rays from the eye were aimed at shared edges, `count` at each of up to 32, and how many met neither
    shape.
    """
    edges = shared_edges(scene)
    if not edges or scene.camera is None:
        return 0, 0
    tried = through = 0
    for index in rng.permutation(len(edges))[:32]:
        a, b, ends, normal = edges[index]
        share = rng.uniform(0.01, 0.99, (count, 1))
        targets = rounded(np.asarray(ends[0]) * (1 - share) + np.asarray(ends[1]) * share)
        origins = rounded(np.broadcast_to(np.asarray(scene.camera.eye, np.float64), targets.shape))
        directions = toward(origins, targets)
        facing = np.abs(directions @ normal) > FLAT
        met = np.zeros(count, bool)
        for shape in (a, b):
            answers = _core.intersect_shape(shape._native, origins, directions, precision, "bounded", False)
            met |= answers["hit"]
        tried, through = tried + int(facing.sum()), through + int((facing & ~met).sum())
    return tried, through
