"""One run of `exact.measure`: two renderers, one of each method, make the same frames in turn."""

from __future__ import annotations

import statistics
import time
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..camera import Camera
from ..frame import Frame
from ..handles import Object
from ..lights import DirectionalLight
from ..renderer import Renderer
from ..scene import Scene
from ..transform import Transform

METHODS = ("base", "exact")
PAINT = (0.3, 0.55, 0.25)
DIMMED = 0.8
SHIFT = 0.25  # of the diagonal of an object's bounds
ARRAYS = ("image", "depth", "object_id", "error_bound")


@dataclass
class Made:
    """Frames of one kind: seconds of each by method, what the exact ones were, and searches of the base ones."""

    seconds: dict[str, list[float]] = field(default_factory=lambda: {method: [] for method in METHODS})
    stats: list[dict[str, Any]] = field(default_factory=list)
    base_searches: int = 0
    block_bytes: int = 0  # of what image blocks keep, after the last one
    equal: bool = True

    def mean(self, method: str) -> float:
        """Seconds a frame."""
        return statistics.fmean(self.seconds[method])


class Run:
    """Two renderers of one scene, each with its own copy, as both are edited; `made` by kind of frame."""

    def __init__(self, scene: Scene, threads: int) -> None:
        self.made: defaultdict[str, Made] = defaultdict(Made)
        self.scenes = {method: scene.copy() for method in METHODS}
        self.renderers = {
            method: Renderer(copy, method=method, threads=threads) for method, copy in self.scenes.items()
        }
        for copy in self.scenes.values():
            copy._document.snapshot()

    def close(self) -> None:
        """Frees what was kept."""
        for renderer in self.renderers.values():
            renderer.close()

    def frame(self, kind: str, camera: Camera) -> None:
        """Makes a frame with both methods and counts it."""
        made, frames = self.made[kind], {}
        for method, renderer in self.renderers.items():
            begin = time.perf_counter()
            frames[method] = renderer.render(camera)
            made.seconds[method].append(time.perf_counter() - begin)
        made.base_searches += sum(frames["base"].stats["rays"].values())
        made.stats.append(frames["exact"].stats)
        cells = self.renderers["exact"]._cells
        assert cells is not None
        made.block_bytes = cells.block_bytes
        made.equal &= same_bytes(frames["base"], frames["exact"])

    def walk(self, cameras: Sequence[Camera]) -> None:
        """The first frame of new renderers, the same again, and the walk."""
        self.frame("first", cameras[0])
        self.frame("again", cameras[0])
        for camera in cameras[1:]:
            self.frame("walk", camera)

    def edits(self, camera: Camera, painted: int, moved: int) -> None:
        """The frame after each edit; before them one that is not counted, as the walk has gone elsewhere."""
        for renderer in self.renderers.values():
            renderer.render(camera)
        for scene in self.scenes.values():
            _paint(scene, painted)
        self.frame("colour", camera)
        if next(iter(self.scenes.values())).lights:
            for scene in self.scenes.values():
                _dim(scene)
            self.frame("light", camera)
        places = {method: _object(scene, moved).transform for method, scene in self.scenes.items()}
        for scene in self.scenes.values():
            _shift(scene, moved)
        self.frame("move", camera)
        for method, scene in self.scenes.items():
            _object(scene, moved).transform = places[method]
        self.frame("back", camera)


def _object(scene: Scene, id: int) -> Object:
    return next(item for item in scene.objects if item.id == id)


def _paint(scene: Scene, id: int) -> None:
    item = _object(scene, id)
    item.material = item.material.replace(diffuse=PAINT)


def _dim(scene: Scene) -> None:
    """The first light, of less power."""
    lamp = scene.lights[0]
    name = "radiance" if isinstance(lamp.light, DirectionalLight) else "intensity"
    lamp.light = lamp.light.replace(**{name: DIMMED * np.asarray(getattr(lamp.light, name))})


def _shift(scene: Scene, id: int) -> None:
    """Upward."""
    item = _object(scene, id)
    item.move(Transform.translate(0.0, 0.0, SHIFT * float(np.linalg.norm(np.ptp(item.bounds, axis=0)))))


def same_bytes(a: Frame, b: Frame) -> bool:
    """Whether two frames show the same, byte for byte."""
    return all(np.ascontiguousarray(getattr(a, name)).tobytes() == getattr(b, name).tobytes() for name in ARRAYS)
