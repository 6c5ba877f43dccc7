"""The kinds of numbers, each an entry of a table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from tests.numbers.conformance.cell_kinds import LinearKind, TaylorKind
from tests.numbers.conformance.interval_kinds import IntervalKind, RunningErrorKind
from tests.numbers.conformance.kind import Kind


@dataclass
class FloatKind:
    """Plain floating point: no enclosure, but a bound of error in units in the last place."""

    name: str
    dtype: type

    def __repr__(self) -> str:
        return self.name


FLOATS = [FloatKind("float32", np.float32), FloatKind("float64", np.float64)]
KINDS: list[Kind] = [
    IntervalKind("interval_float64"),
    IntervalKind("interval_float32", dtype=np.float32),
    IntervalKind("interval_float64_executed", executed=True),
    IntervalKind("interval_float32_executed", dtype=np.float32, executed=True),
    RunningErrorKind("running_error_float64", np.float64),
    RunningErrorKind("running_error_float32", np.float32),
    *(LinearKind(f"linear_{n}_{rule}", variables=n) for n in (1, 2, 3, 4) for rule in ("hansen", "second-order")),
    TaylorKind("taylor_2_real", variables=2),
    TaylorKind("taylor_4_real", variables=4),
    TaylorKind("taylor_2_float32", variables=2, executed=True),
    TaylorKind("taylor_4_float32", variables=4, executed=True),
]
