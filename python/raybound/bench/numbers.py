"""Speed of numbers that carry their error beside plain double: a multiply-add, and the shading of a sphere's cell."""

from __future__ import annotations

import statistics as _statistics
from collections.abc import Iterator
from typing import Any

from .. import _core, reporting
from .tables import Table

WANTED = {  # at most so many times plain double's time
    "interval portable": 12.0,
    "interval hardware": 4.0,
    "interval best": None,
    "interval array": 1.5,
    "TaylorModel<2>": 8.0,
    "TaylorModel<4>": 16.0,
}
PLAIN = "double"
INTERVALS = [name for name in WANTED if name.startswith("interval")]
MODELS = {"TaylorModel<2>": 2, "TaylorModel<4>": 4}
WHAT = {
    PLAIN: "double, one by one",
    "interval portable": "interval, portable rounding",
    "interval hardware": "interval, directed rounding per instruction",
    "interval best": "interval, as `Interval` rounds here",
    "interval array": "arrays of intervals, per element",
}
ELEMENTS = 1000  # of each array: all of them fit into the second-level cache
INNER = 5  # of a run, measurements of which the least counts


def measure(*, repeat: int = 9) -> dict[str, Any]:
    """Measures multiply-adds of intervals, and Ward shading of a sphere's cell with Taylor models, beside double.

    Each of `repeat` runs takes all kinds in turn; ratios are of times of one run.

    Returns a JSON-ready dictionary: "machine" (as `report`), the argument, "multiply_add" and "cell" by kind, and
    "left_out". A kind has "ns" (per multiply-add, or per evaluation of a cell), "plain_ns" (the same in double),
    "ratio", all medians over the runs, "least" and "most" (ratios), and "wanted", the greatest ratio aimed at, or
    None. Cells are evaluated in double at a point, and over all of them with float32's rounding included.
    """
    kinds, left_out = [PLAIN, *INTERVALS], {}
    try:
        _core.time_multiply_add("interval hardware", 1, 1)
    except ValueError:
        kinds.remove("interval hardware")
        left_out["interval hardware"] = "compiled without AVX-512"
    runs = [{kind: _core.time_multiply_add(kind, ELEMENTS, 20 * INNER) for kind in kinds} for _ in range(repeat)]
    cells = [{name: _core.cell_times(n, INNER) for name, n in MODELS.items()} for _ in range(repeat)]
    return {
        "machine": dict(reporting.report()),
        "repeat": repeat,
        "multiply_add": {kind: _summary(kind, [(run[PLAIN], run[kind]) for run in runs]) for kind in kinds},
        "cell": {name: _summary(name, [run[name] for run in cells]) for name in MODELS},
        "left_out": left_out,
    }


def _summary(kind: str, times: list[tuple[float, float]]) -> dict[str, float | None]:
    """Of pairs of times, plain and this kind's."""
    ratios = [other / plain for plain, other in times]
    return {
        "ns": _statistics.median(other for _, other in times),
        "plain_ns": _statistics.median(plain for plain, _ in times),
        "ratio": _statistics.median(ratios),
        "least": min(ratios),
        "most": max(ratios),
        "wanted": WANTED.get(kind),
    }


def tables(result: dict[str, Any]) -> Iterator[Table]:
    """Tables of what `measure` returned."""
    runs = f"medians of {result['repeat']} runs, instruction level {result['machine']['instruction_level']}"
    rows = [[WHAT[kind], *_row(found)] for kind, found in result["multiply_add"].items()]
    columns = ["ns", "times double", "least", "most", "wanted"]
    yield Table(f"A multiply-add, {runs}", ["number", *columns], rows)
    yield Table(
        f"Ward shading of a sphere's cell, float32 rounding included, {runs}",
        ["number", "ns in double", *columns],
        [[name, f"{found['plain_ns']:.0f}", *_row(found)] for name, found in result["cell"].items()],
    )


def _row(found: dict[str, Any]) -> list[str]:
    wanted = "-" if found["wanted"] is None else f"{found['wanted']:g}"
    time = f"{found['ns']:.2f}" if found["ns"] < 100 else f"{found['ns']:.0f}"
    return [time, *(f"{found[key]:.2f}" for key in ("ratio", "least", "most")), wanted]
