"""Failures of the past (tests/corpus/numbers.json), played again on the corners and inside."""

import itertools
import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.numbers.conformance.checks import check_values
from tests.numbers.conformance.kinds import KINDS
from tests.numbers.conformance.operations import BY_NAME

CASES = json.loads((Path(__file__).parents[2] / "corpus" / "numbers.json").read_text())


@pytest.mark.parametrize("case", CASES, ids=[c["why"] for c in CASES])
def test_past_failure(case: dict[str, Any]) -> None:
    kind = next(k for k in KINDS if k.name == case["kind"])
    operands = [np.array([[float.fromhex(x) for x in record]], kind.dtype) for record in case["operands"]]
    points = np.array(list(itertools.product([-1.0, 1.0, 0.0, 0.5], repeat=kind.variables)))
    tally: Counter[str] = Counter()
    rng = np.random.default_rng(3)
    check_values(kind, BY_NAME[case["operation"]], operands, case.get("parameter", 0.0), points, rng, tally)
    assert tally["inside"] or case.get("expect") == "unbounded", tally
