"""The plot of what `exact.measure` returned: how many times as fast each kind of frame is, scene by scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .exact_tables import KINDS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {
    "first": "#d62728",
    "again": "#1f4e9c",
    "walk": "#5aa0dc",
    "colour": "#2c8c4a",
    "light": "#8fce9b",
    "move": "#ff9f4a",
    "back": "#ffd3a6",
}


TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10, 20, 50, 100)


def figure(result: dict[str, Any]) -> Figure:
    """Bars of speed-up over the base tracer, by matplotlib (imported here). Raises ImportError without it."""
    from matplotlib import pyplot

    scenes = result["scenes"]
    made = pyplot.figure(figsize=(max(7.5, 2.5 + 1.1 * len(scenes)), 4.2), layout="constrained")
    pyplot.close(made)
    axes = made.subplots()
    width = 0.84 / len(KINDS)
    for k, (kind, label) in enumerate(KINDS.items()):
        found = {i: scene["frames"].get(kind) for i, scene in enumerate(scenes.values())}
        places = [i + (k - (len(KINDS) - 1) / 2) * width for i, times in found.items() if times]
        heights = [times["speedup"] - 1 for times in found.values() if times]
        axes.bar(places, heights, width, bottom=1, color=COLOURS[kind], label=label)
    _decorate(axes, list(scenes))
    made.legend(loc="outside lower center", ncols=len(KINDS), frameon=False, columnspacing=1.2, handlelength=1.2)
    return made


def _decorate(axes: Axes, names: list[str]) -> None:
    """A logarithmic scale of times, with the base tracer as its line 1."""
    axes.set(yscale="log", ylabel="times as fast as the base tracer", xlim=(-0.55, len(names) - 0.45))
    low, high = axes.get_ylim()
    low, high = min(low, 0.8), max(high, 1.25)
    ticks = [tick for tick in TICKS if low <= tick <= high]
    axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_ylim(low, high)
    axes.grid(axis="y", color="0.9")
    axes.set_axisbelow(True)
    axes.axhline(1.0, color="black", linewidth=1)
    axes.set_xticks(range(len(names)), names)
    axes.tick_params(axis="x", length=0)
    axes.spines[["top", "right"]].set_visible(False)
