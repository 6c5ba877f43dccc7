"""What a ray costs under each policy and precision: the same rays of hard cases, all ways in turn on one core."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import _core, scenes
from ..scene import Scene
from .error_exact import Doubles
from .yardstick import pinned

WIDTH, HEIGHT = 96, 72
# (offsets, precision, whether rays skip the primitive that they have left for good). The tracer skips, which needs to
# know on which side of it a ray starts; a tracer with epsilons does not know. Both ways are measured of both.
WAYS = (
    ("bounded", "float32", True),
    ("epsilon", "float32", False),
    ("scaled-epsilon", "float32", False),
    ("whole-epsilon", "float32", False),
    ("bounded", "float64", True),
    ("epsilon", "float64", False),
    ("scaled-epsilon", "float64", False),
    ("whole-epsilon", "float64", False),
    ("epsilon", "float32", True),
    ("scaled-epsilon", "float32", True),
    ("whole-epsilon", "float32", True),
    ("bounded", "float32", False),
)
Way = tuple[str, str, bool]
YARDSTICKS = tuple(
    way for way in WAYS if way[0] != "bounded" and way[1] == "float32"
)  # what all ways are compared with


def measure(names: Sequence[str], repeat: int) -> dict[str, Any]:
    """Times of hard cases at their default scales; JSON-ready, see `error.measure`."""
    by_case = {}
    with pinned() as core:
        for name in names:
            by_case[name] = _case(name, repeat)
    return {"core": core, "repeat": repeat, "cases": by_case, "ways": [_over_cases(by_case, way) for way in WAYS]}


def _case(name: str, repeat: int) -> dict[str, list[float]]:
    """Nanoseconds a ray, for each of `WAYS`: of each round, after one that is not counted."""
    scene = scenes.hard_case(name)
    origins, directions = eye_rays(scene)
    snapshot = scene._document.snapshot()
    rounds = [[_once(snapshot, origins, directions, way) for way in WAYS] for _ in range(repeat + 1)][1:]
    return {key(way): [times[i] for times in rounds] for i, way in enumerate(WAYS)}


def eye_rays(scene: Scene) -> tuple[Doubles, Doubles]:
    """Origins and directions (n, 3) of a small picture of a scene."""
    if scene.camera is None:
        raise ValueError("bench: the scene has no camera")
    rays = scene.camera.replace(width=WIDTH, height=HEIGHT).rays()
    origins, directions = (np.asarray(part, np.float64).reshape(-1, 3) for part in rays)
    return origins, directions


def _once(snapshot: _core.Snapshot, origins: Doubles, directions: Doubles, way: Way) -> float:
    offsets, precision, skips = way
    done = _core.trace_bounces(snapshot, origins, directions, precision=precision, offsets=offsets, skips=skips)
    return done["seconds"] / done["rays"] * 1e9


def key(way: Way) -> str:
    """A way's name in the JSON."""
    offsets, precision, skips = way
    return f"{offsets} {precision}{' skips' if skips else ''}"


def _over_cases(by_case: dict[str, dict[str, list[float]]], way: Way) -> dict[str, Any]:
    """The geometric mean of the cases' medians, and of their median ratios to the epsilons in the same rounds."""
    offsets, precision, skips = way
    result: dict[str, Any] = {"offsets": offsets, "precision": precision, "skips": skips}
    result["ns_per_ray"] = statistics.geometric_mean(statistics.median(times[key(way)]) for times in by_case.values())
    for other in map(key, YARDSTICKS):
        ratios = [
            statistics.median(a / b for a, b in zip(times[key(way)], times[other], strict=True))
            for times in by_case.values()
        ]
        result[f"over {other}"] = statistics.geometric_mean(ratios)
    return result


def of_way(speed: dict[str, Any], offsets: str, precision: str, skips: bool | None = None) -> dict[str, Any]:
    """One of the ways; by default, bounded origins skip and epsilons do not."""
    skip = offsets == "bounded" if skips is None else skips
    return next(
        way for way in speed["ways"] if (way["offsets"], way["precision"], way["skips"]) == (offsets, precision, skip)
    )
