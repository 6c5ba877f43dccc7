"""The plot of what `error.measure` returned: how often rays go wrong, and how far origins move, against their cost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .error_speed import key, of_way
from .error_tables import wrong_share

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {"bounded": "#1f4e9c", "epsilon": "#d62728", "scaled-epsilon": "#ff9f4a", "whole-epsilon": "#8c564b"}
MARKERS = {"float32": "o", "float64": "s"}
FLOOR = 1e-6  # shares below are drawn on the line "none"


def figure(result: dict[str, Any]) -> Figure:
    """Speed against error, by matplotlib (imported here): on the left each hard case is a faint dot, with its own time.

    Raises ImportError without matplotlib.
    """
    from matplotlib import pyplot

    made = pyplot.figure(figsize=(11, 4.6), layout="constrained")
    pyplot.close(made)
    wrong, moved = made.subplots(1, 2)
    for offsets in COLOURS:
        for precision in MARKERS:
            _draw_wrong(wrong, result, precision, offsets)
            _draw_moved(moved, result, precision, offsets)
    _decorate_wrong(wrong)
    moved.set(yscale="log", xlabel="ns per ray", ylabel="distance that origins move / size of the scene")
    moved.set_title("How far origins move: median, 99th percentile above", fontsize=10)
    handles, labels = moved.get_legend_handles_labels()
    made.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return made


def _style(precision: str, offsets: str) -> dict[str, Any]:
    return {"color": COLOURS[offsets], "marker": MARKERS[precision], "linestyle": "none"}


def _draw_wrong(axes: Axes, result: dict[str, Any], precision: str, offsets: str) -> None:
    """The share of wrong rays of every case, and of all."""
    way = of_way(result["speed"], offsets, precision)
    times = {name: rounds[key((offsets, precision, way["skips"]))] for name, rounds in result["speed"]["cases"].items()}
    medians = [sorted(rounds)[len(rounds) // 2] for rounds in times.values()]
    shares = [max(FLOOR, wrong_share(result["cases"][name]["totals"][precision][offsets])) for name in times]
    style = _style(precision, offsets)
    axes.plot(medians, shares, **style, markersize=4, alpha=0.3, markeredgewidth=0)
    total = max(FLOOR, wrong_share(result["totals"][precision][offsets]))
    axes.plot(way["ns_per_ray"], total, **style, markersize=11, markeredgecolor="black", zorder=3)


def _decorate_wrong(axes: Axes) -> None:
    axes.set(yscale="log", xscale="log", ylim=(FLOOR / 2, 2), xlabel="ns per ray", ylabel="share of spawned rays")
    axes.set_title("False self-intersections and leaks: all cases, and each", fontsize=10)
    ticks = [FLOOR, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1]
    axes.set_yticks(ticks, ["none", *(f"{100 * tick:g} %" for tick in ticks[1:])])
    axes.minorticks_off()
    times = [50, 100, 200, 400]
    axes.set_xticks(times, [str(t) for t in times])
    axes.axhline(FLOOR, color="0.8", linewidth=1, zorder=0)


def _draw_moved(axes: Axes, result: dict[str, Any], precision: str, offsets: str) -> None:
    spread, way = result["totals"][precision][offsets]["offset_relative"], of_way(result["speed"], offsets, precision)
    if spread is None or spread["median"] <= 0:
        return
    up = [[0.0], [spread["percentile_99"] - spread["median"]]]
    style = _style(precision, offsets)
    axes.errorbar(
        way["ns_per_ray"], spread["median"], yerr=up, **style, markersize=9, capsize=4, label=f"{offsets}, {precision}"
    )
