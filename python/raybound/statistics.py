"""Statistics of frames and of renderers: plain dictionaries, JSON-ready."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from .enums import Path, Reason

RAYS = ("eye", "shadow", "reflected", "refracted")


def zero() -> dict[str, Any]:
    """Statistics of nothing, with every key."""
    return {
        "seconds": 0.0,
        "seconds_by_phase": {},
        "threads": 0,
        "rays": dict.fromkeys(RAYS, 0),
        "tests": 0,
        "pixels": {path.name: 0 for path in Path},
        "reasons": {reason.name: 0 for reason in Reason},
        "cells": {"made": 0, "valid": 0, "invalid": {}},
        "bytes": 0,
        "edits": 0,
    }


def count_pixels(stats: dict[str, Any], path: npt.NDArray[np.uint8], reason: npt.NDArray[np.uint8]) -> None:
    """Fills in how many pixels took each path, and for each reason."""
    stats["pixels"] = {item.name: _count(path, item) for item in Path}
    stats["reasons"] = {item.name: _count(reason, item) for item in Reason}


def _count(codes: npt.NDArray[np.uint8], code: int) -> int:
    """How often a code stands in an array. (np.bincount would make 8 bytes of each first: ten times as slow.)"""
    return int(np.count_nonzero(codes == np.uint8(code)))


def add(total: dict[str, Any], part: Mapping[str, Any]) -> None:
    """Adds the numbers of `part` to those of `total`, level by level."""
    for key, value in part.items():
        if isinstance(value, Mapping):
            add(total.setdefault(key, {}), value)
        else:
            total[key] = total.get(key, 0) + value


class Totals:
    """What a renderer has done so far."""

    def __init__(self) -> None:
        self._stats = {"frames": 0, **zero()}

    def add_frame(self, stats: Mapping[str, Any]) -> None:
        """Counts one more frame."""
        total = self.as_dict()  # a new one each time, as another thread may be reading
        add(total, {"frames": 1, **stats})
        total.update(threads=stats["threads"], bytes=stats["bytes"])  # states, not amounts
        self._stats = total

    def as_dict(self) -> dict[str, Any]:
        """A copy: the keys of a frame's statistics, added up, and the number of "frames"."""
        return copy.deepcopy(self._stats)
