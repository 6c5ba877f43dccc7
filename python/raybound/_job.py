"""A frame in the making."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from . import _core, statistics
from ._records import Records
from .camera import Camera
from .frame import ARRAYS, CellAt, Frame, Origin
from .progress import ProgressCall
from .scene import Scene
from .tolerance import Tolerance


@dataclass
class Job:
    """A frame in the making: what is rendered, the core's buffers, and statistics so far."""

    snapshot: _core.Snapshot
    camera: Camera
    tolerance: Tolerance
    max_depth: int
    records: Records
    buffers: _core.FrameBuffers
    cell_at: CellAt | None = None
    stats: dict[str, Any] = field(default_factory=statistics.zero)

    @classmethod
    def start(cls, scene: Scene, camera: Camera, tolerance: Tolerance, max_depth: int, *, since: int | None) -> Self:
        """Takes a snapshot of the scene. `since`: the revision of the renderer's previous frame."""
        begin = time.perf_counter()
        snapshot, records = scene._document.snapshot(), scene._committed.copy()
        buffers = _core.FrameBuffers(camera.width, camera.height)
        job = cls(snapshot, camera, tolerance, max_depth, records, buffers)
        job.stats["edits"] = 0 if since is None else snapshot.revision - since
        job._spend("snapshot", begin)
        return job

    def begin_anew(self) -> None:
        """Forgets the pixels that were traced; frames that show them keep their copies."""
        self.buffers = _core.FrameBuffers(self.camera.width, self.camera.height)

    def trace(
        self, *, threads: int, stride: int, report: ProgressCall | None, cells: _core.Cells | None = None
    ) -> None:
        """Traces the pixels at multiples of `stride` that are not done yet, all of them with the help of `cells`."""
        begin = time.perf_counter()
        try:
            counts = _core.render(
                self.snapshot,
                self.camera._native,
                self.buffers,
                max_depth=self.max_depth,
                threads=threads,
                stride=stride,
                precision="float32",
                brute_force=False,
                cells=cells,
                progress=report,
            )
        finally:
            self._spend("trace", begin)
        self.stats["threads"] = counts["threads"]
        statistics.add(self.stats, {"rays": counts["rays"], "tests": counts["tests"]})
        if cells is not None and stride == 1:
            made = counts["cells"]
            known = {"valid": made["lit"] + made["blocked"] + made["listed"], "invalid": {"memory": made["refused"]}}
            statistics.add(self.stats, {"cells": {"made": made["made"], **known}})
            self.stats["bytes"] = cells.bytes

    def _spend(self, phase: str, begin: float) -> None:
        seconds = time.perf_counter() - begin
        statistics.add(self.stats, {"seconds": seconds, "seconds_by_phase": {phase: seconds}})

    def frame(self, *, final: bool) -> Frame:
        """The frame as it is now; if the job goes on (not `final`), with copies of the buffers."""
        arrays: dict[str, npt.NDArray[Any]] = {name: getattr(self.buffers, name) for name in ARRAYS}
        if not final:
            arrays = {name: np.array(values) for name, values in arrays.items()}
        stats = {key: dict(value) if isinstance(value, dict) else value for key, value in self.stats.items()}
        statistics.count_pixels(stats, arrays["path"], arrays["reason"])
        return Frame(
            arrays,
            camera=self.camera,
            tolerance=self.tolerance,
            revision=self.snapshot.revision,
            stats=stats,
            origin=Origin(self.snapshot, self.max_depth, self.records, self.cell_at),
        )
