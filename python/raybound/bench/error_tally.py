"""What is counted and sampled about the rays of one policy, added up over bodies."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from .error_exact import Doubles

COUNTS = (
    "rays",  # at bodies
    "sure",  # of these, certainly meet the body in exact arithmetic
    "missed",  # of these, without a hit
    "hits",
    "nans",  # hits with a NaN in any number
    "spawned",  # rays from hits, on the side to which they leave
    "self_hits",  # of these, meet the surface that they leave
    "entered",  # rays from hits into a convex solid, through its certain interior
    "inner_hits",  # of these, meet the surface that they leave
    "enclosed",  # spawned or aimed from within a solid: must come out
    "leaks",  # of these, meet nothing
    "sent_back",  # from the far side, where distance/size <= 100 and the angle > 1 degree
    "lost",  # of these, do not meet the surface
    "checked",  # hits of spawned rays whose exact crossing was looked at
    "behind",  # of these, behind the origin
    "bounds",  # bounds that were compared with the true error
    "broken",  # of these, below it
    "closed",  # hits of shapes with a closed form of the point's bound
    "closed_broken",  # of these, where that form is below its point's true error
    "own_broken",  # of these, where our bound is below ours
)
FAILURES = ("missed", "nans", "self_hits", "inner_hits", "leaks", "behind", "broken")
SAMPLES = ("offset_ulp", "offset_relative", "point_ratio", "t_ratio", "point_ulp", "closed_ulp", "closed_ratio")


class Tally:
    """Counts, and samples as lists of arrays."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.samples: dict[str, list[Doubles]] = {name: [] for name in SAMPLES}

    def count(self, **flags: Any) -> None:
        """Adds numbers, or how many flags are true."""
        for name, value in flags.items():
            self.counts[name] += int(np.sum(value))

    def sample(self, name: str, values: Doubles) -> None:
        """Adds measured values."""
        self.samples[name].append(values)

    def add(self, other: Tally) -> None:
        """Adds another tally."""
        self.counts += other.counts
        for name, values in other.samples.items():
            self.samples[name] += values

    def summary(self) -> dict[str, Any]:
        """JSON-ready: all counts, and of the samples their medians, 99th percentiles, and ends."""
        result: dict[str, Any] = {name: self.counts[name] for name in COUNTS}
        result["failures"] = sum(self.counts[name] for name in FAILURES)
        for name, parts in self.samples.items():
            values = np.concatenate([np.zeros(0), *parts])
            result[name] = None if not len(values) else spread(values)
        return result


def spread(values: Doubles) -> dict[str, float]:
    """Where values lie."""
    low, middle, high, top = np.quantile(values, [0, 0.5, 0.99, 1], method="nearest")
    return {"least": float(low), "median": float(middle), "percentile_99": float(high), "largest": float(top)}
