"""The tables of what `error.measure` returned."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ..floats import OFFSETS, PRECISIONS
from .error_speed import WAYS, YARDSTICKS, Way, key, of_way
from .tables import Table

WORST = 8  # cases that the README shows
# By kind of shape, the closed form of Physically Based Rendering 3.9.4.
CLOSED_FORMS = {"sphere": "γ5", "cylinder": "γ3, caps 0", "disk": "0", "mesh": "γ7"}
CLOSED_SAMPLES = ("point_ulp", "closed_ulp", "point_ratio", "closed_ratio")
WRONG = {
    "self_hits": ("self_hits", "spawned"),
    "inner_hits": ("inner_hits", "entered"),
    "leaks": ("leaks", "enclosed"),
    "missed": ("missed", "sure"),
    "behind": ("behind", "checked"),
    "nans": ("nans", "hits"),
    "broken": ("broken", "bounds"),
    "lost": ("lost", "sent_back"),
}


def tables(result: dict[str, Any]) -> Iterator[Table]:
    """Totals, speeds, then all hard cases and all kinds of shapes."""
    yield _totals(result)
    yield _closed_forms(result)
    yield _visits(result)
    yield _speeds(result)
    yield _by(result["cases"], "case", "By hard case: false self-intersections and leaks", list(result["cases"]))
    kinds = {kind: {"totals": found} for kind, found in result["kinds"].items()}
    yield _by(kinds, "shape", "By kind of shape: false self-intersections and leaks", list(kinds))
    yield _seams(result)


def readme_tables(result: dict[str, Any]) -> Iterator[Table]:
    """Totals, what bounds and spawned rays are beside the seeds', and the worst cases."""
    yield _totals(result)
    yield _closed_forms(result)
    yield _visits(result)
    worst = sorted(result["cases"], key=lambda name: -_worst(result["cases"][name]["totals"]["float32"]))[:WORST]
    yield _by(result["cases"], "case", "The worst hard cases: false self-intersections and leaks", worst)


def _worst(totals: dict[str, Any]) -> float:
    """The larger share of wrong rays of the two epsilons."""
    return max((wrong_share(found) for offsets, found in totals.items() if offsets != "bounded"), default=0.0)


def wrong_share(found: dict[str, Any]) -> float:
    """The share of spawned rays that meet what they leave, or leak."""
    wrong: int = found["self_hits"] + found["inner_hits"] + found["leaks"]
    rays: int = found["spawned"] + found["enclosed"]
    return wrong / max(1, rays)


def share(part: int, whole: int) -> str:
    """A count as a percentage; 0 only where it is 0, and a dash where nothing was counted."""
    if whole == 0:
        return "-"
    return "0" if part == 0 else f"{100 * part / whole:.2g} %"


def _totals(result: dict[str, Any]) -> Table:
    cases, rays = len(result["cases"]), result["totals"]["float32"]["bounded"]["spawned"]
    columns = ["self-hits", "inside", "leaks", "missed", "behind", "NaN", "broken", "lost"]
    columns += ["offset, ulp", "99 %", "bound/error", "ns/ray", "over epsilon", "if all skip"]
    rows = []
    for precision in PRECISIONS:
        for offsets, found in result["totals"][precision].items():
            wrong = [share(found[part], found[whole]) for part, whole in WRONG.values()]
            rows.append(
                [f"{offsets}, {precision}", *wrong, *_spread(found), *_cost(result["speed"], offsets, precision)]
            )
    title = (
        f"Origins of spawned rays on {cases} hard cases and {len(result['kinds'])} kinds of shapes, {rays} rays leaving"
        " surfaces in each row; processor time of one core"
    )
    return Table(title, ["origins", *columns], rows)


def _spread(found: dict[str, Any]) -> list[str]:
    moved, ratio = found["offset_ulp"], found["point_ratio"]
    ulps = ["-", "-"] if moved is None else [f"{moved[name]:.3g}" for name in ("median", "percentile_99")]
    return [*ulps, "-" if ratio is None else f"{ratio['median']:.3g}"]


def _cost(speed: dict[str, Any], offsets: str, precision: str) -> list[str]:
    way = of_way(speed, offsets, precision)
    skipping = [w for w in speed["ways"] if (w["offsets"], w["precision"], w["skips"]) == (offsets, precision, True)]
    fair = f"{skipping[0]['over epsilon float32 skips']:.2f}" if skipping else "-"
    return [f"{way['ns_per_ray']:.0f}", f"{way['over epsilon float32']:.2f}", fair]


def _closed_forms(result: dict[str, Any]) -> Table:
    """Our bounds of hit points beside the seeds'."""
    rows = []
    for kind, form in CLOSED_FORMS.items():
        for precision in PRECISIONS:
            found = result["kinds"].get(kind, {}).get(precision, {}).get("bounded")
            if not found or not found["closed"]:
                continue
            sizes = [f"{found[name]['median']:.3g}" if found[name] else "-" for name in CLOSED_SAMPLES]
            broken = [share(found["own_broken"], found["closed"]), share(found["closed_broken"], found["closed"])]
            rows.append([f"{kind}, {precision}", form, str(found["closed"]), *sizes, *broken])
    columns = ["closed form", "hits", "bound, ulp", "closed, ulp", "bound/error", "closed/error", "broken", "closed"]
    title = (
        "Bounds of hit points along the normal, medians, and how many are below the true error: ours, and closed forms"
    )
    return Table(title, ["shape", *columns], rows)


def _visits(result: dict[str, Any]) -> Table:
    """Nodes and primitives that spawned rays visit."""
    visits = result["visits"]
    rows = []
    for way in WAYS:
        counts = [found[key(way)] for found in visits.values()]
        means = [f"{part[name] / max(1, part['spawned']):.2f}" for name in ("nodes", "primitives") for part in counts]
        rows.append([_name(way), *means])
    columns = [f"{name}, {where}" for name in ("nodes", "primitives") for where in visits]
    return Table("What a spawned ray visits: nodes of hierarchies, and primitives asked", ["origins", *columns], rows)


def _name(way: Way) -> str:
    offsets, precision, skips = way
    return f"{offsets}, {precision}{', skips' if skips else ''}"


def _speeds(result: dict[str, Any]) -> Table:
    """All ways that were timed."""
    over = [key(way) for way in YARDSTICKS]
    rows = [
        [
            _name((way["offsets"], way["precision"], way["skips"])),
            f"{way['ns_per_ray']:.1f}",
            *(f"{way[f'over {other}']:.2f}" for other in over),
        ]
        for way in result["speed"]["ways"]
    ]
    title = (
        f"Nanoseconds a ray and ratios, medians of {result['repeat']} rounds in turn, geometric means over cases"
        " (skips: rays do not ask the shape that they have left for good)"
    )
    return Table(title, ["origins", "ns/ray", *(f"over {other}" for other in over)], rows)


def _by(found: dict[str, Any], what: str, title: str, names: Sequence[str]) -> Table:
    rows = []
    for name in names:
        parts = [found[name]["totals"][precision].get(offsets) for precision in PRECISIONS for offsets in OFFSETS]
        rows.append([name, *(_pair(part) for part in parts)])
    columns = [f"{offsets}, {precision}" for precision in PRECISIONS for offsets in OFFSETS]
    return Table(title, [what, *columns], rows)


def _pair(part: dict[str, Any] | None) -> str:
    if part is None:
        return "-"
    return f"{share(part['self_hits'], part['spawned'])}, {share(part['leaks'], part['enclosed'])}"


def _seams(result: dict[str, Any]) -> Table:
    rows = []
    for name, case in result["cases"].items():
        if case["seams"][PRECISIONS[0]][0]:
            rows.append([name, *(str(n) for precision in PRECISIONS for n in case["seams"][precision])])
    columns = [text for precision in PRECISIONS for text in (f"rays, {precision}", "through")]
    return Table("Rays at edges that boxes or polygons share, and how many met neither", ["case", *columns], rows)
