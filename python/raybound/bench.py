"""Speed of the base tracer, as tables and JSON."""

from __future__ import annotations

import statistics as _statistics
import time
from collections.abc import Callable, Iterator
from typing import Any

from . import reporting, scenes
from .renderer import Renderer
from .scene import Scene
from .statistics import RAYS

SCENES: dict[str, Callable[[], Scene]] = {
    "museum": scenes.museum,
    "sphereflake:4": lambda: scenes.sphereflake(4),
}
THREADS = (1, 2)


def base(*, width: int = 1200, height: int = 900, repeat: int = 5) -> dict[str, Any]:
    """Measures the base tracer on the museum and on a sphereflake of 4 levels, from their own cameras.

    Returns a JSON-ready dictionary: "machine" (as `report`), "width", "height", "repeat", and "scenes" by name. Each
    has "objects", "seconds_to_make", "seconds_to_build" (the first snapshot, with its BVH), "rays" by kind (of one
    frame), "threads" by number with the medians "seconds", "ns_per_pixel" and "ns_per_ray", and "speedup" from one
    thread to two.
    """
    results = {name: _scene(maker, width, height, repeat) for name, maker in SCENES.items()}
    return {
        "machine": dict(reporting.report()),
        "width": width,
        "height": height,
        "repeat": repeat,
        "scenes": results,
    }


def _scene(maker: Callable[[], Scene], width: int, height: int, repeat: int) -> dict[str, Any]:
    """The measurements of one scene."""
    begin = time.perf_counter()
    scene = maker()
    made = time.perf_counter() - begin
    begin = time.perf_counter()
    scene._document.snapshot()
    built = time.perf_counter() - begin
    rays: dict[str, int] = {}
    by_threads: dict[str, dict[str, float]] = {}
    for threads in THREADS:
        rays, by_threads[str(threads)] = _threads(scene, width, height, repeat, threads)
    first, second = (times["seconds"] for times in by_threads.values())
    return {
        "objects": len(scene),
        "seconds_to_make": made,
        "seconds_to_build": built,
        "rays": rays,
        "threads": by_threads,
        "speedup": first / second,
    }


def _threads(
    scene: Scene, width: int, height: int, repeat: int, threads: int
) -> tuple[dict[str, int], dict[str, float]]:
    """The rays of a frame, and medians over `repeat` frames after one that is not counted."""
    if scene.camera is None:
        raise ValueError("bench: the scene has no camera")
    camera = scene.camera.replace(width=width, height=height)
    with Renderer(scene, method="base", threads=threads) as renderer:
        frames = [renderer.render(camera).stats for _ in range(repeat + 1)][1:]
    seconds = _statistics.median(stats["seconds_by_phase"]["trace"] for stats in frames)
    rays: dict[str, int] = frames[0]["rays"]
    return rays, {
        "seconds": seconds,
        "ns_per_pixel": seconds / (width * height) * 1e9,
        "ns_per_ray": seconds / sum(rays.values()) * 1e9,
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """The lines of a table of `base`'s result."""
    yield f"base tracer, {result['width']} x {result['height']} pixels, median of {result['repeat']} frames"
    yield f"{'scene':<14}{'objects':>8}{'build ms':>10}{'threads':>8}{'ns/pixel':>10}{'ns/ray':>8}{'speedup':>9}"
    for name, scene in result["scenes"].items():
        for threads, times in scene["threads"].items():
            speedup = scene["threads"]["1"]["seconds"] / times["seconds"]
            yield (
                f"{name:<14}{scene['objects']:>8}{scene['seconds_to_build'] * 1e3:>10.1f}{threads:>8}"
                f"{times['ns_per_pixel']:>10.1f}{times['ns_per_ray']:>8.1f}{speedup:>9.2f}"
            )
    pixels = result["width"] * result["height"]
    yield f"{'rays a pixel':<14}" + "".join(f"{kind:>12}" for kind in (*RAYS, "all"))
    for name, scene in result["scenes"].items():
        counts = [scene["rays"][kind] for kind in RAYS]
        yield f"{name:<14}" + "".join(f"{count / pixels:>12.3f}" for count in (*counts, sum(counts)))
