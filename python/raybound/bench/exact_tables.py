"""The tables of what `exact.measure` returned."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..statistics import RAYS
from .tables import Table

KINDS = {  # of frames, as tables and the plot name them
    "first": "first",
    "again": "again",
    "walk": "walk",
    "colour": "colour",
    "light": "light",
    "move": "moved",
    "back": "moved back",
}


def tables(result: dict[str, Any]) -> Iterator[Table]:
    """Speed by kind of frame, then with more threads, and what the frames of each kind did."""
    yield from _times(result)
    if result["scenes"]:
        yield _work(result, list(KINDS), "What the frames did")


def readme_tables(result: dict[str, Any]) -> Iterator[Table]:
    """The same, but of what they did only the walk's."""
    yield from _times(result)
    if result["scenes"]:
        yield _work(result, ["walk"], "What a frame of the walk does")


def _times(result: dict[str, Any]) -> Iterator[Table]:
    if result["scenes"]:
        yield _speeds(result)
        scaling = _scaling(result)
        if scaling.rows:
            yield scaling


def _speeds(result: dict[str, Any]) -> Table:
    """How many times as fast each kind of frame is, and a frame's time in the walk."""
    threads = next(iter(next(iter(result["scenes"].values()))["threads"]))
    title = (
        f"How many times as fast as the base tracer frames are, {result['width']} x {result['height']} pixels, "
        f"depth 5, {threads} thread{'' if threads == '1' else 's'}, medians of {result['repeat']} runs in turn, "
        f"instruction level {result['machine']['instruction_level']}"
    )
    rows = []
    for name, scene in result["scenes"].items():
        frames = scene["frames"]
        walk = [f"{frames['walk'][method] * 1e3:.1f}" for method in ("base", "exact")]
        rows.append([name, *(_number(frames, kind, "speedup") for kind in KINDS), *walk, _agreement(scene)])
    columns = ["scene", *KINDS.values(), "walk, base ms", "exact ms", "bytes equal"]
    return Table(title, columns, rows)


def _number(frames: dict[str, Any], kind: str, key: str) -> str:
    return f"{frames[kind][key]:.2f}" if kind in frames else "-"


def _agreement(scene: dict[str, Any]) -> str:
    kinds = [*scene["frames"].values(), *(kind for times in scene["threads"].values() for kind in times.values())]
    return "all" if all(kind["equal"] for kind in kinds) else "NOT ALL"


def _scaling(result: dict[str, Any]) -> Table:
    """With more threads, how many times as fast as the base tracer, and each method as with the first number."""
    rows = []
    for name, scene in result["scenes"].items():
        for threads, kinds in [*scene["threads"].items()][1:]:
            speedups = [f"{times['speedup']:.2f}" for times in kinds.values()]
            scaling = [f"{times['scaling'][method]:.2f}" for times in kinds.values() for method in ("base", "exact")]
            rows.append([name, threads, *speedups, *scaling])
    title = "With more threads: times as fast as the base tracer, and each method as with the first number of threads"
    columns = ["scene", "threads", "first", "walk", "first, base", "exact", "walk, base", "exact"]
    return Table(title, columns, rows)


def _work(result: dict[str, Any], kinds: list[str], title: str) -> Table:
    """Searches and tests a pixel, and what is kept."""
    rows = []
    for name, scene in result["scenes"].items():
        for kind in kinds:
            if kind in scene["frames"]:
                rows.append([name, *([KINDS[kind]] if len(kinds) > 1 else []), *_done(scene["frames"][kind])])
    columns = ["scene", *(["frame"] if len(kinds) > 1 else []), "searches, base", "exact", *RAYS, "tests"]
    return Table(f"{title}, a pixel", [*columns, "cells made", "cells, MB", "blocks, MB", "certified"], rows)


def _done(frame: dict[str, Any]) -> list[str]:
    counts = [frame["searches"][kind] for kind in RAYS]
    return [
        f"{frame['base_searches']:.3f}",
        *(f"{count:.3f}" for count in (sum(counts), *counts)),
        f"{frame['tests']:.1f}",
        f"{frame['made']:.0f}",
        f"{(frame['bytes'] - frame['block_bytes']) / 1e6:.1f}",
        f"{frame['block_bytes'] / 1e6:.1f}",
        f"{100 * frame['certified']:.1f} %",
    ]
