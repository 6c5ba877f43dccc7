"""Speed against error: what each way to move the origins of spawned rays does wrong on hard cases, and what it costs.

Every hard case, at all its scales, has shapes of every kind in it: some of its own, and one of each kind in the place
and size of one of these. All are asked with float32 and float64 kernels, and origins by bounds, by a fixed epsilon and
by a scaled one; `error_oracle` knows, in double-double numbers, what is true.
"""

from __future__ import annotations

import zlib
from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import reporting, scenes
from ..floats import OFFSETS, PRECISIONS
from ..scenes import HARD_CASES
from . import error_seams, error_speed, error_visits
from .error_bodies import Rng, bodies
from .error_probe import Policy, probe
from .error_rays import rays_at
from .error_tables import readme_tables, tables
from .error_tally import Tally

__all__ = ["POLICIES", "measure", "measure_scene", "readme_tables", "tables"]

POLICIES = tuple(Policy(offsets, precision) for precision in PRECISIONS for offsets in OFFSETS)
Tallies = dict[tuple[str, Policy], Tally]  # by kind and policy


def measure(*, names: Sequence[str] | None = None, rays: int = 32, repeat: int = 9) -> dict[str, Any]:
    """Measures all kinds of shapes, policies and precisions on hard cases.

    `names` are among `HARD_CASES`; None takes all. `rays` are aimed at each shape (twice as many at meshes); `repeat`
    rounds are timed. The rays depend on the arguments alone. ValueError for other names.

    Returns a JSON-ready dictionary: "machine" (as `report`), the arguments, "totals", "kinds" and "cases" with the
    summaries of `error_tally.Tally` by precision and offsets ("totals"), before that by kind ("kinds"), and before that
    by case ("cases", each with its "scales" and "seams": by precision, rays at shared edges and how many met nothing);
    "speed" (`error_speed.measure`), in nanoseconds; "visits" (`error_visits.measure`); and "left_out", which is empty.
    """
    chosen = list(HARD_CASES) if names is None else list(names)
    for name in chosen:
        if name not in HARD_CASES:
            raise ValueError(f"bench error: scenes must be among {', '.join(HARD_CASES)}, got {name!r}")
    if not chosen:
        raise ValueError("bench error: scenes must name at least one hard case")
    overall: Tallies = defaultdict(Tally)
    cases = {}
    for name in chosen:
        tallies: Tallies = defaultdict(Tally)
        seams = {precision: [0, 0] for precision in PRECISIONS}
        for scale in HARD_CASES[name].scales:
            for where, tally in measure_scene(name, scale, rays).items():
                tallies[where].add(tally)
                overall[where].add(tally)
            for precision in PRECISIONS:
                found = error_seams.leaks(scenes.hard_case(name, scale), precision, rays, _rng(name, scale))
                seams[precision] = [a + b for a, b in zip(seams[precision], found, strict=True)]
        cases[name] = {"scales": list(HARD_CASES[name].scales), "seams": seams, **_by_kind(tallies)}
    return {
        "machine": dict(reporting.report()),
        "rays": rays,
        "repeat": repeat,
        **_by_kind(overall),
        "cases": cases,
        "speed": error_speed.measure(chosen, repeat),
        "visits": error_visits.measure(chosen),
        "left_out": {},
    }


def measure_scene(name: str, scale: float, rays: int, policies: Sequence[Policy] = POLICIES) -> Tallies:
    """What the shapes of one hard case at one scale show, by kind and policy: the same rays for each policy."""
    scene, rng = scenes.hard_case(name, scale), _rng(name, scale)
    if scene.camera is None:
        raise ValueError("bench: the scene has no camera")
    bounds = np.concatenate([item.bounds for item in scene.objects])
    size, eye = float(np.ptp(bounds, axis=0).max()), np.asarray(scene.camera.eye, np.float64)
    tallies: Tallies = defaultdict(Tally)
    for body in bodies(scene, rng):
        aimed, seed = rays_at(rng, body, eye, rays), int(rng.integers(2**32))
        for policy in policies:
            tallies[body.kind, policy].add(probe(body, aimed, policy, size, np.random.default_rng(seed)))
    return tallies


def _rng(name: str, scale: float) -> Rng:
    return np.random.default_rng(zlib.crc32(f"{name} {scale!r}".encode()))


def _by_kind(tallies: Tallies) -> dict[str, Any]:
    """Summaries by kind, precision and offsets, and "totals" by precision and offsets."""
    kinds: dict[str, Any] = {kind: _by_policy(tallies, kind) for kind in sorted({kind for kind, _ in tallies})}
    return {"totals": _by_policy(tallies, None), "kinds": kinds}


def _by_policy(tallies: Tallies, kind: str | None) -> dict[str, Any]:
    sums: dict[Policy, Tally] = defaultdict(Tally)
    for (name, policy), tally in tallies.items():
        if kind in (None, name):
            sums[policy].add(tally)
    return {
        precision: {o: sums[Policy(o, precision)].summary() for o in OFFSETS if Policy(o, precision) in sums}
        for precision in PRECISIONS
    }
