"""Interval against the ITF1788 vectors: tightest in arithmetic, an ulp wider at most in the elementary functions."""

import math
from collections import Counter

import numpy as np
import pytest
from tests.support import support_itl as itl

from raybound import _core

pytestmark = pytest.mark.skipif(itl.folder() is None, reason="set RAYBOUND_DATA to a folder that holds itl/*.itl")

# Vectors' name: ours. The rule: what is not here does not apply, as Interval has no such operation (powers: below).
ARITHMETIC = {
    "neg": "negate",
    "add": "add",
    "sub": "subtract",
    "mul": "multiply",
    "div": "divide",
    "sqr": "square",
    "sqrt": "sqrt",
    "convexHull": "hull",
    "intersection": "intersection",
}
ELEMENTARY = {name: name for name in ("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan")}
INAPPLICABLE = {
    "pos", "tanh", "sinh", "cosh", "coth", "cot", "acot", "asinh", "acosh", "atanh", "acoth", "logp1", "expm1",
    "log2", "log10", "exp2", "exp10", "rootn", "interior", "subset", "equal",
}  # fmt: skip


def all_cases() -> list[itl.Case]:
    found = [case for path in sorted(itl.folder().glob("*.itl")) for case in itl.cases(path)]
    assert len(found) == 1023
    return found


def ours(name: str, inputs: tuple, kind: str, parameter: float = 0.0) -> itl.Ends:
    operands = np.array(inputs, np.float64).reshape(len(inputs), 2, 1)
    ends = _core.interval_operation(name, operands, kind, parameter)
    return float(ends[0, 0]), float(ends[1, 0])


def widened(ends: itl.Ends) -> itl.Ends:
    return math.nextafter(ends[0], -math.inf), math.nextafter(ends[1], math.inf)


@pytest.mark.parametrize("kind", ["double", "double portable"])
def test_arithmetic_is_the_tightest(kind: str) -> None:
    tested: Counter[str] = Counter()
    for case in all_cases():
        if case.operation in ARITHMETIC:
            assert ours(ARITHMETIC[case.operation], case.inputs, kind) == case.outputs[0], case
            tested[case.operation] += 1
    assert tested == {
        "neg": 1, "add": 21, "sub": 21, "mul": 61, "div": 37, "sqr": 33, "sqrt": 33,
        "convexHull": 24, "intersection": 18,
    }  # fmt: skip


def test_elementary_functions_hold_the_tightest_and_are_at_most_an_ulp_wider() -> None:
    tested: Counter[str] = Counter()
    wider = 0
    for case in all_cases():
        if case.operation not in ELEMENTARY:
            continue
        low, high = ours(case.operation, case.inputs, "double")
        (tight_low, tight_high), (loose_low, loose_high) = case.outputs[0], widened(case.outputs[0])
        if case.outputs[0] == itl.EMPTY:
            assert (low, high) == itl.EMPTY, case
        else:
            assert loose_low <= low <= tight_low, case
            assert tight_high <= high <= loose_high, case
        wider += (low < tight_low) + (high > tight_high)
        tested[case.operation] += 1
    assert dict(tested) == {name: 26 if name == "exp" else 30 for name in ELEMENTARY}
    assert wider <= 4  # seen: 0


def test_powers_with_integer_exponents() -> None:
    """Real powers of positive bases, where the exponent is an integer, are ours."""
    cases = [case for case in all_cases() if case.operation == "pow" and case.inputs[0][0] > 0]
    for case in cases:
        low, high = case.inputs[1]
        assert low == high == int(low)
        assert ours("power", case.inputs[:1], "double", low) == case.outputs[0], case
    assert len(cases) == 3


def test_which_cases_do_not_apply() -> None:
    names = Counter(case.operation for case in all_cases())
    inapplicable = {name: n for name, n in names.items() if name not in [*ARITHMETIC, *ELEMENTARY, "pow"]}
    assert set(inapplicable) == INAPPLICABLE
    assert sum(inapplicable.values()) == 535
    assert sum(names[name] for name in [*ARITHMETIC, *ELEMENTARY]) == 485
