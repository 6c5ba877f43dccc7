"""Speed of certified candidate lists beside searching: methods "exact" and "base" make the same frames in turn."""

from __future__ import annotations

import statistics as _statistics
from collections.abc import Sequence
from contextlib import closing
from functools import partial
from typing import Any

import numpy as np

from .. import reporting, scenes
from ..camera import Camera
from ..enums import Path
from ..renderer import Renderer
from ..scene import Scene
from ..statistics import RAYS
from . import workloads
from .exact_run import METHODS, Made, Run
from .exact_tables import readme_tables, tables

__all__ = ["measure", "readme_tables", "tables"]

MUSEUM_FRAMES, ORBIT_FRAMES = 12, 6  # of a walk, after its first frame
ORBIT = 1.0  # degrees a frame
MOVED = {"museum": "sculpture-top"}  # elsewhere the object that is seen in most pixels after the painted one
SCALED = ("first", "walk")  # kinds of frames that are measured with every number of threads
REPAINTED = ("colour", "light")  # kinds after which nothing that is kept has changed


def measure(
    *,
    width: int = 1200,
    height: int = 900,
    repeat: int = 3,
    threads: Sequence[int] = (1, 2),
    names: Sequence[str] | None = None,
) -> dict[str, Any]:
    """Measures frames of both methods, one after the other, with the clock around the whole of `render`.

    `names` are among `workloads.NAMES`; None takes `workloads.default_names()`. A run makes the "first" frame of new
    renderers, the same frame "again", a "walk" (through the museum, or around a scene a degree a frame), and the frame
    after each of four edits: an object's "colour", the intensity of a "light", a "move" of an object, and its way
    "back". Each method has its own copy of the scene. The scene's snapshot is there before the first frame; bringing it
    up to date after an edit counts.

    Returns a JSON-ready dictionary: "machine" (as `report`), the arguments, "scenes" by name, and "left_out", the
    reasons why some are missing. A scene has "objects", "painted" and "moved" (ids), "frames" by kind, with the first
    number of threads, "cells_made_by_repainting" (after edits of colour and light, in all runs: 0), and "threads" by
    number, each with the kinds "first" and "walk". A kind has "base" and "exact" (seconds a frame) and "speedup",
    medians over `repeat` runs, and "equal", whether all bytes were; in "threads" also "scaling" of both methods, over
    the first number; and in "frames" what the exact ones of the last run did: their number "frames", "searches" by kind
    of ray, "base_searches" and "tests" (all a pixel), "made" (cells, a frame), "bytes" (at the end), "block_bytes"
    (those of image blocks among them), and "certified", the share of pixels that needed no search.
    """
    result: dict[str, Any] = {
        "machine": dict(reporting.report()),
        "width": width,
        "height": height,
        "repeat": repeat,
        "scenes": {},
        "left_out": {},
    }
    for name in workloads.default_names() if names is None else names:
        part = partial(_scene, name, width, height, repeat, threads)
        workloads.keep(result, result["scenes"], name, part)
    return result


def _scene(name: str, width: int, height: int, repeat: int, threads: Sequence[int]) -> dict[str, Any]:
    """The measurements of one scene."""
    scene = workloads.load(name)
    cameras = _walk(name, scene, width, height)
    painted, moved = _edited(name, scene, cameras[0])
    runs: dict[int, list[dict[str, Made]]] = {count: [] for count in threads}
    for _ in range(repeat):
        for count, done in runs.items():  # in turn, as machines are not equally fast all the time
            done.append(_run(scene, count, cameras, painted, moved, edits=count == threads[0]))
    full, first = runs[threads[0]], {kind: [run[kind] for run in runs[threads[0]]] for kind in SCALED}
    return {
        "objects": len(scene),
        "painted": painted,
        "moved": moved,
        "frames": {kind: {**_times([run[kind] for run in full]), **_work(made)} for kind, made in full[-1].items()},
        "cells_made_by_repainting": sum(
            made.stats[0]["cells"]["made"] for run in full for kind, made in run.items() if kind in REPAINTED
        ),
        "threads": {
            str(count): {kind: _scaled([run[kind] for run in done], first[kind]) for kind in SCALED}
            for count, done in runs.items()
        },
    }


def _run(
    scene: Scene, threads: int, cameras: Sequence[Camera], painted: int, moved: int, *, edits: bool
) -> dict[str, Made]:
    """One run: the frames that were made, by kind."""
    with closing(Run(scene, threads)) as run:
        run.walk(cameras)
        if edits:
            run.edits(cameras[0], painted, moved)
    return dict(run.made)


def _times(runs: Sequence[Made]) -> dict[str, Any]:
    """Medians over runs: seconds a frame, and how many times as fast exact frames were; and whether all agreed."""
    seconds = {method: _statistics.median(made.mean(method) for made in runs) for method in METHODS}
    speedup = _statistics.median(made.mean("base") / made.mean("exact") for made in runs)
    return {**seconds, "speedup": speedup, "equal": all(made.equal for made in runs)}


def _scaled(runs: Sequence[Made], first: Sequence[Made]) -> dict[str, Any]:
    """The same, and of each method how many times as fast it was as in the first runs."""
    pairs = list(zip(first, runs, strict=True))
    scaling = {method: _statistics.median(a.mean(method) / b.mean(method) for a, b in pairs) for method in METHODS}
    return {**_times(runs), "scaling": scaling}


def _work(made: Made) -> dict[str, Any]:
    """What the exact frames of a kind did, on average."""
    pixels = sum(sum(stats["pixels"].values()) for stats in made.stats)
    certified = sum(stats["pixels"][path.name] for stats in made.stats for path in (Path.EXACT, Path.BACKGROUND))
    return {
        "frames": len(made.stats),
        "searches": {kind: sum(stats["rays"][kind] for stats in made.stats) / pixels for kind in RAYS},
        "base_searches": made.base_searches / pixels,
        "tests": sum(stats["tests"] for stats in made.stats) / pixels,
        "made": _statistics.fmean(stats["cells"]["made"] for stats in made.stats),
        "bytes": made.stats[-1]["bytes"],
        "block_bytes": made.block_bytes,
        "certified": certified / pixels,
    }


def _walk(name: str, scene: Scene, width: int, height: int) -> list[Camera]:
    """The first camera and those of the walk."""
    if scene.camera is None:
        raise ValueError("bench: the scene has no camera")
    if name == "museum":
        cameras = scenes.walkthrough(60)[: MUSEUM_FRAMES + 1]
    else:
        cameras = [scene.camera, *(scene.camera.orbit(ORBIT * (k + 1), 0.0) for k in range(ORBIT_FRAMES))]
    return [camera.replace(width=width, height=height) for camera in cameras]


def _edited(name: str, scene: Scene, camera: Camera) -> tuple[int, int]:
    """Ids of the object to paint, which is seen in most pixels, and of the one to move."""
    seen = Renderer(scene, method="base").render(camera).object_id
    ids, pixels = np.unique(seen[seen >= 0], return_counts=True)
    if not len(ids):
        raise workloads.UnavailableError("its camera sees no object")
    largest = ids[np.argsort(-pixels, kind="stable")]
    return int(largest[0]), scene[MOVED[name]].id if name in MOVED else int(largest[:2][-1])
