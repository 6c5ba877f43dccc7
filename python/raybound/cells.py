"""Surface cells as arrays: what `Renderer.linetrees` returns."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core


def dtype(lights: int) -> np.dtype[np.void]:
    """The fields of a cell in a scene with so many lights."""
    fields: list[Any] = [
        ("object_id", np.int32),
        ("face_id", np.int32),
        ("depth", np.int32),
        ("lower", np.float32, (4,)),
        ("upper", np.float32, (4,)),
        ("valid", np.bool_),
        ("bound", np.float32),
        ("leaf", np.bool_),
        ("piece", np.int32),
        ("outward", np.bool_),
        ("patch", np.float64, (4, 3)),
        ("candidates", np.int32, (lights,)),
    ]
    return np.dtype(fields)


def array(kept: _core.Cells | None, snapshot: _core.Snapshot, object_id: int) -> npt.NDArray[np.void]:
    """The cells kept for an object of a snapshot: a structured array (n,)."""
    if kept is None:
        return np.empty(0, dtype(0))
    views = kept.views(snapshot, object_id)
    candidates = views["candidates"]
    result = np.zeros(len(candidates), dtype(candidates.shape[1]))
    result["object_id"] = object_id
    result["face_id"] = views["face"]
    middle, half = views["rectangle"][:, :2], views["rectangle"][:, 2:]
    result["lower"][:, :2], result["upper"][:, :2] = middle - half, middle + half
    result["valid"] = (candidates > -2).any(axis=1)
    for name in ("depth", "leaf", "piece", "outward", "patch", "candidates"):
        result[name] = views[name]
    return result


def described(view: _core._CellView | None) -> dict[str, Any] | None:
    """A cell in words: "lights" tells, by the id of each light, what may block it."""
    if view is None:
        return None
    lights = dict(zip(view["lights"], map(_verdict, view["candidates"]), strict=True))
    return {"face": view["face"], "piece": view["piece"], "depth": view["depth"], "bound": 0.0, "lights": lights}


def _verdict(candidates: int) -> str:
    """What is known of one light: see `Renderer.linetrees`."""
    words = {-2: "unknown", -1: "blocked", 0: "lit", 1: "1 candidate"}
    return words.get(candidates, f"{candidates} candidates")
