"""The demonstration: the museum walk-through and two pictures, with statistics."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from . import scenes
from .frame import Frame
from .renderer import Renderer, render
from .statistics import RAYS

HEADER = f"{'picture':<24}{'seconds':>9}{'ns/pixel':>10}" + "".join(f"{kind:>11}" for kind in RAYS)


def make_demo(out: Path, *, frames: int, width: int, height: int) -> Iterator[str]:
    """Writes `walk/000.png` and so on, `three_spheres.png`, `museum.png` (1200 x 900) and `statistics.json` into `out`.

    Yields the lines of a table while it works. ValueError for sizes or a number of frames that make no sense.
    """
    if frames < 1:
        raise ValueError(f"frames must be >= 1, got {frames}")
    scene = scenes.museum()
    cameras = [camera.replace(width=width, height=height) for camera in scenes.walkthrough(frames=frames)]
    (out / "walk").mkdir(parents=True, exist_ok=True)
    statistics: dict[str, dict[str, Any]] = {}
    yield HEADER
    with Renderer(scene) as renderer:
        for index, frame in enumerate(renderer.sequence(cameras)):
            yield _save(frame, out, f"walk/{index:03d}.png", statistics)
        total = renderer.stats
        yield _row(f"walk, all {frames}", total, frames * width * height)
        if scene.camera is not None:
            large = renderer.render(scene.camera.replace(width=1200, height=900))
            yield _save(large, out, "museum.png", statistics)
    yield _save(render(scenes.three_spheres()), out, "three_spheres.png", statistics)
    text = json.dumps({"walk": total, "pictures": statistics}, indent=1)
    (out / "statistics.json").write_text(text + "\n", encoding="utf-8")
    yield f"pictures and statistics.json are in {out}"


def _save(frame: Frame, out: Path, name: str, statistics: dict[str, dict[str, Any]]) -> str:
    """Saves a picture, keeps its statistics, and returns its row of the table."""
    frame.save(out / name)
    statistics[name] = frame.stats
    return _row(name, frame.stats, frame.path.size)


def _row(name: str, stats: dict[str, Any], pixels: int) -> str:
    rays = "".join(f"{stats['rays'][kind]:>11}" for kind in RAYS)
    return f"{name:<24}{stats['seconds']:>9.3f}{stats['seconds'] / pixels * 1e9:>10.1f}{rays}"
