"""What spawned rays visit under each policy: the seed's reason why origins close to a surface cost time.

Physically Based Rendering 3.9.7 says that rays which start very close to a surface visit more nodes of the hierarchy
than rays which start too far away. They are counted by the search itself, compiled a second time to do so. Hard cases
have few objects, so ready scenes are counted, too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from .. import _core, scenes
from ..scene import Scene
from .error_speed import WAYS, eye_rays, key

READY: dict[str, Callable[[], Scene]] = {"museum": scenes.museum, "sphereflake": lambda: scenes.sphereflake(4)}
COUNTS = ("spawned", "nodes", "primitives")


def measure(names: Sequence[str]) -> dict[str, Any]:
    """Of hard cases at their default scales together, and of ready scenes: by way (`error_speed.key`) how many rays
    were spawned, and how many nodes and primitives they visited. JSON-ready.
    """
    hard = {key(way): Counter[str]() for way in WAYS}
    for name in names:
        for way, counts in of_scene(scenes.hard_case(name)).items():
            hard[way] += Counter(counts)
    together = {way: {name: counts[name] for name in COUNTS} for way, counts in hard.items()}
    return {"hard cases": together, **{name: of_scene(make()) for name, make in READY.items()}}


def of_scene(scene: Scene) -> dict[str, dict[str, int]]:
    """The counts of one scene, by way."""
    snapshot, rays = scene._document.snapshot(), eye_rays(scene)
    found = {}
    for way in WAYS:
        offsets, precision, skips = way
        done: Any = _core.trace_bounces(snapshot, *rays, precision=precision, offsets=offsets, skips=skips, count=True)
        found[key(way)] = {name: done[name] for name in COUNTS}
    return found
