"""The renderer: follows a scene and makes frames of it."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from types import TracebackType
from typing import Any, NoReturn, Self

import numpy as np
import numpy.typing as npt

from . import _core, _validate, cells
from . import progress as _progress
from ._job import Job
from ._validate import FloatArray
from .camera import Camera
from .enums import Reason
from .frame import Frame
from .handles import Object
from .progress import Progress, ProgressCall
from .scene import Scene
from .statistics import Totals
from .tolerance import Tolerance, as_tolerance

METHODS = ("auto", "base", "exact", "taylor", "quadrilinear")
AVAILABLE = ("auto", "base", "exact")
BOUNDS = ("constant", "hansen", "second-order", "taylor", "estimate")
QUALITIES = ("bounded", "extrapolate-1", "extrapolate-2", "extrapolate-3", "extrapolate-4")
STRIDES = (8, 4, 2, 1)  # of `refine`: every 8th pixel in x and y, then every 4th, ...
logger = logging.getLogger("raybound")


@dataclass(frozen=True, eq=False)
class TraceResult:
    """What `Renderer.trace` returns for n rays.

    radiance (n, 3), error_bound (n,): float32; path, reason (n,): uint8; object_id (n,): int32, -1 for the background.
    Two results are equal if all arrays are.
    """

    radiance: FloatArray
    error_bound: FloatArray
    path: npt.NDArray[np.uint8]
    reason: npt.NDArray[np.uint8]
    object_id: npt.NDArray[np.int32]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TraceResult):
            return NotImplemented
        pairs = ((getattr(self, field.name), getattr(other, field.name)) for field in fields(self))
        return all(np.array_equal(a, b, equal_nan=True) for a, b in pairs)

    __hash__ = None  # type: ignore[assignment]  # compared by content, like arrays


class Renderer:
    """Renders frames of a scene. Edits made since the last frame take effect at the next one.

    Parameters
    ----------
    scene : Scene
    tolerance : Tolerance or float
        How much a picture may differ from the base image; 0: not at all.
    method : {"auto", "base", "exact"}
        "base" traces everything; "exact" gives the same bytes from short lists that provably hold what rays can meet,
        which it keeps for the next frames; "auto" is the fastest that keeps the tolerance, today "exact". ("taylor" and
        "quadrilinear" are known, but not available in this version: ValueError.)
    bound : {"taylor", "constant", "hansen", "second-order", "estimate"}
        How "quadrilinear" bounds its error (thesis 4.3); no other method looks at it.
    memory : int
        Bytes for what is kept for later frames, a hard limit, > 0. Too little of it is slower, never wrong.
    threads : int
        0 uses the processors that the process may use: those it is bound to (its CPU affinity), or fewer if its control
        group grants less time. The picture's bytes do not depend on it.
    max_depth : int
        1..1000. The eye ray has depth 1; a surface at this depth spawns nothing.
    editable : bool
        Whether to keep what the rays of the last frame have met, up to half of `memory`, some 15 to 25 bytes a pixel:
        the next frame of the same camera then asks only about what edits have touched.

    Calls are safe from any thread, but one at a time: another one while a frame is rendered raises RuntimeError. As a
    context manager a renderer releases its memory at the end; afterwards calls raise RuntimeError. A renderer cannot be
    pickled.
    """

    def __init__(
        self,
        scene: Scene,
        tolerance: Tolerance | float = 0.0,
        *,
        method: str = "auto",
        bound: str = "taylor",
        memory: int = 256 * 2**20,
        threads: int = 0,
        max_depth: int = 5,
        editable: bool = True,
    ) -> None:
        self._scene = _validate.instance("Renderer", "scene", scene, Scene)
        self._tolerance = as_tolerance("Renderer", tolerance)
        self._method = _validate.choice("Renderer", "method", method, METHODS)
        if self._method not in AVAILABLE:
            raise ValueError(
                f"Renderer: method {method!r} is not available in this version (use 'auto', 'exact' or 'base')"
            )
        self._bound = _validate.choice("Renderer", "bound", bound, BOUNDS)
        self._memory = _validate.integer("Renderer", "memory", memory, lowest=1, highest=2**62)
        self._threads = _validate.integer("Renderer", "threads", threads, lowest=0, highest=1024)
        self._max_depth = _validate.integer("Renderer", "max_depth", max_depth, lowest=1, highest=1000)
        self._editable = _validate.flag("Renderer", "editable", editable)
        self._cells = None if self._method == "base" else _core.Cells(self._memory, keeps_blocks=self._editable)
        self._lock = threading.Lock()
        self._closed = False
        self._totals = Totals()
        self._revision: int | None = None  # of the last frame
        self._partial: Frame | None = None

    # Frames

    def render(self, cam: Camera | None = None, quality: str = "bounded", *, progress: Progress = None) -> Frame:
        """Renders a frame.

        Parameters
        ----------
        cam : Camera
            Default: the scene's camera. ValueError if there is neither.
        quality : {"bounded", "extrapolate-1", ..., "extrapolate-4"}
            "bounded" certifies every pixel. The others may extrapolate from cells of earlier frames (thesis 5.3); a
            renderer that has none traces.
        progress : bool or callable
            True shows a tqdm bar; a callable gets the fraction done.

        An exception from `progress`, or Ctrl-C, cancels the frame promptly, leaves the renderer usable, and leaves what
        was done in `partial_frame`. RuntimeError if the renderer is busy or closed.
        """
        camera = self._camera("Renderer.render", cam)
        _validate.choice("Renderer.render", "quality", quality, QUALITIES)
        _progress.check("Renderer.render", progress)
        with self._busy("render"), _progress.reporter(progress) as report:
            return self._render(camera, report)

    def refine(self, cam: Camera | None = None) -> Iterator[Frame]:
        """Progressively better frames of one view: from every 8th pixel in each direction to all of them.

        Pixels that were not traced yet show the colour of a traced one nearby; their path is EXTRAPOLATED and their
        bound inf. The last frame is what `render` gives. All frames show the scene as it is when the first one is asked
        for. Statistics count from the first frame on.
        """
        return self._refine(self._camera("Renderer.refine", cam))

    def sequence(self, cameras: Iterable[Camera], *, progress: Progress = None) -> Iterator[Frame]:
        """Frames for a finite sequence of cameras, such as a walk-through, each rendered when it is asked for.

        `progress` as in `render`, over the whole sequence.
        """
        who = "Renderer.sequence"
        _validate.instance(who, "cameras", cameras, Iterable, "a sequence of Cameras")  # type: ignore[type-abstract]
        views = [_validate.instance(who, f"cameras[{i}]", cam, Camera) for i, cam in enumerate(cameras)]
        _progress.check(who, progress)
        return self._sequence(views, progress)

    def _render(self, camera: Camera, report: ProgressCall | None) -> Frame:
        job = self._start(camera)
        self._advance(job, 1, report)
        return self._finish(job)

    def _refine(self, camera: Camera) -> Iterator[Frame]:
        with self._busy("refine"):
            job = self._start(camera)
        for stride in STRIDES[:-1]:
            with self._busy("refine"):
                self._advance(job, stride, None)
            yield job.frame(final=False)
        with self._busy("refine"):
            if self._cells is not None:
                job.begin_anew()  # whole blocks of pixels, and their paths, as `render` gives them
            self._advance(job, STRIDES[-1], None)
            frame = self._finish(job)
        yield frame

    def _sequence(self, cameras: list[Camera], progress: Progress) -> Iterator[Frame]:
        with _progress.reporter(progress) as report:
            for index, camera in enumerate(cameras):
                with self._busy("sequence"):
                    frame = self._render(camera, _progress.part(report, index, len(cameras)))
                yield frame

    def _camera(self, who: str, cam: object) -> Camera:
        """The camera given, or the scene's."""
        if cam is not None:
            return _validate.instance(who, "cam", cam, Camera)
        camera = self._scene.camera
        if camera is None:
            raise ValueError(f"{who}: cam must be a Camera, got None, and the scene has no camera")
        return camera

    @contextmanager
    def _busy(self, what: str) -> Iterator[None]:
        """Holds the renderer for one call; RuntimeError if another one runs or it is closed."""
        if not self._lock.acquire(blocking=False):
            raise RuntimeError(f"Renderer: busy, {what} was called while another call is running")
        try:
            if self._closed:
                raise RuntimeError(f"Renderer: closed, {what} was called after its end")
            yield
        finally:
            self._lock.release()

    def _start(self, camera: Camera) -> Job:
        """A frame to be: takes a snapshot of the scene."""
        self._partial = None
        job = Job.start(self._scene, camera, self._tolerance, self._max_depth, since=self._revision)
        job.cell_at = None if self._cells is None else self._cell_at
        return job

    def _cell_at(
        self, snapshot: _core.Snapshot, object: int, face: int, point: tuple[float, float, float]
    ) -> dict[str, Any] | None:
        """What a frame's explanation tells of the cell around a point; None while the renderer is busy, or closed."""
        if self._cells is None or not self._lock.acquire(blocking=False):
            return None
        try:
            return cells.described(self._cells.view_at(snapshot, object, face, point))
        finally:
            self._lock.release()

    def _advance(self, job: Job, stride: int, report: ProgressCall | None) -> None:
        """Traces the pixels at multiples of `stride` that are not done yet."""
        try:
            job.trace(threads=self._threads, stride=stride, report=report, cells=self._cells)
        except BaseException:
            self._partial = job.frame(final=True)
            raise

    def _finish(self, job: Job) -> Frame:
        """The frame of a completed job."""
        frame = job.frame(final=True)
        self._revision = frame.revision
        self._totals.add_frame(frame.stats)
        height, width = frame.path.shape
        logger.debug("rendered %d x %d pixels in %.3f s", width, height, frame.stats["seconds"])
        return frame

    @property
    def partial_frame(self) -> Frame | None:
        """What was done of a frame that an exception or Ctrl-C cancelled, else None.

        Pixels that were not traced have bound inf. Its statistics count pixels and time, but no rays.
        """
        return self._partial

    # Rays

    def trace(self, origins: npt.ArrayLike, directions: npt.ArrayLike) -> TraceResult:
        """Traces any rays.

        `origins` (..., 3), or (...) records of hits (see `Scene.intersect`), and `directions` (..., 3), of length
        2**-64 or more, scene units; both broadcast, and the arrays of the result have the shape of the rays. A record
        of a miss sees the background. ValueError as for `Scene.intersect`.
        """
        rays = _validate.rays("Renderer.trace", origins, directions)
        with self._busy("trace"):
            snapshot = self._scene._document.snapshot()
            found = _core.trace(
                snapshot, rays.origins, rays.ends, max_depth=self._max_depth, threads=self._threads, progress=None
            )
        bound, reason = np.zeros(rays.shape, np.float32), np.full(rays.shape, Reason.NONE, np.uint8)
        return TraceResult(
            found["radiance"].reshape((*rays.shape, 3)),
            bound,
            found["path"].reshape(rays.shape),
            reason,
            found["object_id"].reshape(rays.shape),
        )

    def paths(self, origins: npt.ArrayLike, directions: npt.ArrayLike) -> npt.NDArray[np.void]:
        """The ray trees of any rays, for optics: where light that reaches each ray's origin has gone.

        Arguments are those of `trace`; the rays count in C order of their shape. A tree is as deep as the renderer's
        `max_depth`, and has no shadow rays.

        Returns a structured array of segments, those of each ray together, each before those that it sends on:
            ray (int32; the number of the ray), parent (int32; the number of the segment that it comes from, -1 for the
            first), kind (uint8; a `RayKind`), depth (int32; 1 for the first), origin, point (3 float32; where it begins
            and where it hits; for a miss its unit direction), t (float32, scene units; inf for a miss), object_id,
            face_id (int32; -1 for a miss), weight (3 float32; what its radiance counts for in the ray's).
        """
        rays = _validate.rays("Renderer.paths", origins, directions)
        with self._busy("paths"):
            snapshot = self._scene._document.snapshot()
            return _core.paths(snapshot, rays.origins, rays.ends, max_depth=self._max_depth, threads=self._threads)

    def linetrees(self, object: Object) -> npt.NDArray[np.void]:
        """The cells kept for an object, for pictures of the data structure: a structured array (n,).

        Fields: object_id, face_id, depth (int32; 0 for a whole face), lower, upper (4 float32; the first two are
        coordinates in the face's chart), valid (bool; what may block each light that was asked for is known), bound
        (float32), and of surface cells also leaf (bool; not divided further), piece (int32; of the face, by the axis it
        is seen along), outward (bool; rays leave to the outside), patch ((4, 3) float64: the middle of a parallelepiped
        of space around that part of the face, and its three half axes) and candidates (int32, one for each light: the
        number of objects that may block it, -1 where one certainly does, -2 where nothing is known). Empty for methods
        that keep none, and before the first frame after an edit.
        """
        handle = _validate.instance("Renderer.linetrees", "object", object, Object, "an Object of the scene")
        if handle._scene is not self._scene:
            raise ValueError(f"Renderer.linetrees: object must be one of the renderer's scene, got {handle!r}")
        handle._record()
        with self._busy("linetrees"):
            return cells.array(self._cells, self._scene._document.snapshot(), handle.id)

    # State

    @property
    def scene(self) -> Scene:
        """The scene that is followed."""
        return self._scene

    @property
    def tolerance(self) -> Tolerance:
        """How much a picture may differ from the base image."""
        return self._tolerance

    @property
    def stats(self) -> dict[str, Any]:
        """Totals over all completed frames: the keys of `frame.stats`, and "frames". A copy."""
        return self._totals.as_dict()

    @property
    def memory_used(self) -> int:
        """Bytes used for what is kept for later frames; at most `memory`."""
        return 0 if self._cells is None else self._cells.bytes

    def clear(self) -> None:
        """Forgets what was computed for earlier frames, and frees its memory. RuntimeError if busy or closed."""
        with self._busy("clear"):
            self._forget()

    def close(self) -> None:
        """Frees all memory; further calls raise RuntimeError. Closing twice is fine; RuntimeError if busy."""
        if not self._closed:
            with self._busy("close"):
                self._forget()
                self._closed = True

    def _forget(self) -> None:
        self._partial = None
        if self._cells is not None:
            self._cells.clear()

    def __enter__(self) -> Self:
        with self._busy("with"):
            return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __reduce__(self) -> NoReturn:
        raise TypeError("Renderer: cannot be pickled; pickle its scene and make a new renderer")

    def __repr__(self) -> str:
        options = f"method={self._method!r}, threads={self._threads}, max_depth={self._max_depth}"
        return f"<Renderer of {self._scene!r}, {self._tolerance!r}, {options}>"


def render(scene: Scene, cam: Camera | None = None, **renderer_options: Any) -> Frame:
    """Renders one frame: `Renderer(scene, **renderer_options).render(cam)`; `cam=None` takes the scene's camera."""
    with Renderer(scene, **renderer_options) as renderer:
        return renderer.render(cam)
