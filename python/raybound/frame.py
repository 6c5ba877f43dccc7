"""A frame: a rendered picture with its certificates."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _validate, images
from ._records import Records
from ._validate import FloatArray
from .camera import Camera
from .enums import Path, Reason
from .explain import Explanation, ids
from .tolerance import Tolerance

# Asks the renderer for the cell around a point: snapshot, object, face, point.
CellAt = Callable[[_core.Snapshot, int, int, tuple[float, float, float]], dict[str, Any] | None]
ARRAYS = ("image", "error_bound", "path", "reason", "object_id", "depth")


@dataclass(frozen=True)
class Origin:
    """What a frame was rendered from: what `explain` needs. Not pickled with the frame."""

    snapshot: _core.Snapshot
    max_depth: int
    records: Records
    cell_at: CellAt | None = None


class Frame:
    """A rendered picture. Made by renderers; never changes.

    Attributes
    ----------
    image : (h, w, 3) float32
        Linear RGB radiance, unclamped; row 0 is the top.
    error_bound : (h, w) float32
        Certified bound on the maximum over channels of |image - base image|; 0 where traced or exact, inf where
        extrapolated or, in a cancelled frame, not reached.
    path, reason : (h, w) uint8
        How each pixel was made (`Path`) and why it was traced (`Reason`).
    object_id : (h, w) int32
        What is seen, -1 for the background.
    depth : (h, w) float32
        Distance along the ray, scene units; inf for the background.
    camera, tolerance, revision
        What was rendered: the camera, the tolerance, and the scene's revision.
    stats : dict
        Plain and JSON-ready: "seconds", "seconds_by_phase", "threads", "rays" (searches of the scene: "eye", "shadow",
        "reflected", "refracted"), "tests", "pixels" by path, "reasons", "cells", "bytes", "edits" since the renderer's
        previous frame.

    Arrays are read-only and owned by the frame. Frames are equal if arrays, camera, tolerance and revision are.
    """

    __slots__ = (*ARRAYS, "camera", "tolerance", "revision", "stats", "_origin")

    image: FloatArray
    error_bound: FloatArray
    path: npt.NDArray[np.uint8]
    reason: npt.NDArray[np.uint8]
    object_id: npt.NDArray[np.int32]
    depth: FloatArray
    camera: Camera
    tolerance: Tolerance
    revision: int
    stats: dict[str, Any]
    _origin: Origin | None

    def __init__(
        self,
        arrays: Mapping[str, npt.NDArray[Any]],
        *,
        camera: Camera,
        tolerance: Tolerance,
        revision: int,
        stats: dict[str, Any],
        origin: Origin | None = None,
    ) -> None:
        for name in ARRAYS:
            arrays[name].flags.writeable = False
            object.__setattr__(self, name, arrays[name].view())  # a view cannot be made writeable again
        others = {"camera": camera, "tolerance": tolerance, "revision": revision, "stats": stats, "_origin": origin}
        for name, value in others.items():
            object.__setattr__(self, name, value)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"Frame: {name} is read-only")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"Frame: {name} is read-only")

    # Pictures

    def to_srgb(self) -> npt.NDArray[np.uint8]:
        """The picture as sRGB bytes, (h, w, 3) uint8; radiance outside [0, 1] is clipped."""
        return images.srgb_bytes(self.image)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture with OpenImageIO.

        .exr keeps float32 channels R, G, B (linear), error_bound, Z (the depth), object_id and path; every other format
        gets 8-bit sRGB. ValueError for an unknown extension or a file that cannot be written, FileNotFoundError for a
        missing folder.
        """
        target = _validate.file_path("Frame.save", "path", path)
        if target.lower().endswith(".exr"):
            planes = (*np.moveaxis(self.image, 2, 0), self.error_bound, self.depth, self.object_id, self.path)
            layers = dict(zip(images.EXR_CHANNELS, planes, strict=True))
            images.write_layers(target, layers, "Frame.save")
        else:
            images.write_srgb(target, self.image, "Frame.save")

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        """The image, for NumPy; read-only unless it is copied or converted."""
        wanted = self.image.dtype if dtype is None else np.dtype(dtype)
        if wanted != self.image.dtype:
            if copy is False:
                raise ValueError(f"Frame: an image of dtype float32 cannot become {wanted} without a copy")
            return self.image.astype(wanted)
        return self.image.copy() if copy else self.image

    def _repr_png_(self) -> bytes:
        """The picture as a PNG file, for notebooks."""
        return images.png_bytes(self.image)

    # Explanations

    def explain(self, x: int, y: int) -> Explanation:
        """What happened at the pixel in column `x` and row `y`: object, path, reason, cell and ray tree. Prints well.

        ValueError if the pixel lies outside, or if the frame was unpickled: explaining traces the pixel again, in the
        scene that was rendered (later edits do not matter), and that is not pickled.
        """
        height, width = self.path.shape
        x = _validate.integer("Frame.explain", "x", x, lowest=0, highest=width - 1)
        y = _validate.integer("Frame.explain", "y", y, lowest=0, highest=height - 1)
        if self._origin is None:
            raise ValueError("Frame.explain: needs the scene, which a frame loses when it is pickled; render it again")
        tree = _core.explain(self._origin.snapshot, self.camera._native, x, y, self._origin.max_depth)
        found = {key: self._origin.records.get(*key) for key in ids(tree)}
        labels = {key: record.label for key, record in found.items() if record is not None}
        id = int(self.object_id[y, x])
        return Explanation(
            x=x,
            y=y,
            object_id=id,
            object=None if id < 0 else labels.get(("object", id), f"object {id}"),
            path=Path(int(self.path[y, x])),
            reason=Reason(int(self.reason[y, x])),
            error_bound=float(self.error_bound[y, x]),
            cell=self._cell(tree),
            tree=tree,
            labels=labels,
        )

    def _cell(self, tree: Mapping[str, Any]) -> dict[str, Any] | None:
        """The surface cell around the point that is seen, as long as its renderer keeps it."""
        if self._origin is None or self._origin.cell_at is None or not tree["hit"]:
            return None
        return self._origin.cell_at(self._origin.snapshot, tree["object_id"], tree["face_id"], tree["point"])

    # Comparison, pickling, printing

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Frame):
            return NotImplemented
        mine, its = (self.camera, self.tolerance, self.revision), (other.camera, other.tolerance, other.revision)
        pairs = ((getattr(self, name), getattr(other, name)) for name in ARRAYS)
        return mine == its and all(np.array_equal(a, b, equal_nan=True) for a, b in pairs)

    __hash__ = None  # type: ignore[assignment]  # compared by content, like arrays

    def __reduce__(self) -> tuple[Any, ...]:
        arrays = {name: np.array(getattr(self, name)) for name in ARRAYS}
        return _restore_frame, (arrays, self.camera, self.tolerance, self.revision, self.stats)

    def __copy__(self) -> Frame:
        return self

    def __deepcopy__(self, memo: object) -> Frame:
        return self

    def __repr__(self) -> str:
        height, width = self.path.shape
        pixels = {name: count for name, count in self.stats["pixels"].items() if count}
        return f"<Frame {width} x {height}, revision {self.revision}, {self.tolerance}, pixels {json.dumps(pixels)}>"


def _restore_frame(
    arrays: dict[str, npt.NDArray[Any]], camera: Camera, tolerance: Tolerance, revision: int, stats: dict[str, Any]
) -> Frame:
    """A frame from a pickle."""
    return Frame(arrays, camera=camera, tolerance=tolerance, revision=revision, stats=copy.deepcopy(stats))
