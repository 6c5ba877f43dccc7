"""Expressions of depth 3 to 6: what each kind of number says of a whole cell holds at each of its points."""

from __future__ import annotations

from collections import Counter

import flint
import numpy as np
import pytest
from tests.numbers.conformance.kinds import KINDS, Kind, Records
from tests.numbers.conformance.operations import PRECISION, Ball, Operation
from tests.numbers.conformance.trees import Node, UndefinedError, evaluate, exactly, grow

from raybound import _core

SHORT_AND_LONG = [120, pytest.param(12_000, marks=[pytest.mark.soak, pytest.mark.timeout(3600)])]
RADII = np.array([0.0, 1e-7, 1e-5, 1e-3, 0.03, 0.3])  # of the centers
POINTS = 5


def exact_value(tree: Node, x: np.ndarray) -> Ball | None:
    """Not finite where 256 bits cannot decide; None where the expression is not defined."""
    try:
        return evaluate(tree, lambda i: Ball(float(x[i])), Ball, exactly)
    except UndefinedError:
        return None


def executed_values(tree: Node, x: np.ndarray) -> np.ndarray:
    """What float32 arithmetic gives at points (n, variables), (n,): NaN where it meets one on its way."""
    met = np.zeros(len(x), bool)

    def apply(operation: Operation, operands: list[np.ndarray], parameter: float) -> np.ndarray:
        result = np.asarray(_core.apply("float32", operation.name, operands, parameter))
        met[np.isnan(result[:, 0])] = True
        return result

    result = evaluate(
        tree,
        lambda i: np.ascontiguousarray(x[:, i : i + 1], np.float32),
        lambda c: np.full((len(x), 1), c, np.float32),
        apply,
    )
    return np.where(met, np.nan, result[:, 0])


def enclosures(kind: Kind, tree: Node, low: np.ndarray, high: np.ndarray) -> tuple[Records, np.ndarray, np.ndarray]:
    """The expression over cells (n, variables); and the cells' centers and radii."""
    v = low.shape[1]
    leaves = [kind.variable(i, low[:, i], high[:, i]) for i in range(v)]
    nothing = np.zeros((len(low), max(kind.variables, 1)))
    result = evaluate(
        tree,
        lambda i: leaves[i][0],
        lambda c: kind.cells(np.full(len(low), c), nothing, nothing[:, 0]),
        lambda operation, operands, parameter: kind.apply(operation.name, operands, parameter),
    )
    return result, np.stack([leaf[1] for leaf in leaves], -1), np.stack([leaf[2] for leaf in leaves], -1)


def normalised(x: np.ndarray, center: np.ndarray, radius: np.ndarray) -> list[Ball]:
    return [
        (Ball(a) - Ball(c)) / Ball(r) if r else Ball(0) for a, c, r in zip(x.tolist(), center.tolist(), radius.tolist())
    ]


def check_tree(kind: Kind, tree: Node, low: np.ndarray, high: np.ndarray, x: np.ndarray, tally: Counter[str]) -> None:
    """`x`: float32 points of the cells, (cells, points, variables)."""
    results, centers, radii = enclosures(kind, tree, low, high)
    assert kind.is_canonical(results).all(), tree
    bounded, ranges = kind.is_bounded(results), kind.ranges(results)
    for i in range(len(low)):
        if not bounded[i]:
            tally["unbounded"] += 1
            continue
        tally["varying"] += ranges[i, 0] < ranges[i, 1] and low[i].tolist() != high[i].tolist()
        executed = executed_values(tree, x[i]).tolist() if kind.executed else [np.nan] * len(x[i])
        points = [normalised(p, centers[i], radii[i]) for p in x[i]]
        for j, (low_end, high_end) in enumerate(kind.ends(results[i : i + 1], points)[0]):
            where = (
                f"{kind}: {tree}\n    at {[float(c).hex() for c in x[i, j]]} of {low[i].tolist()}, {high[i].tolist()}"
            )
            exact = exact_value(tree, x[i, j])
            if exact is None:
                assert kind.is_set, where
                tally["undefined"] += 1
                continue
            if executed[j] == executed[j]:
                is_outside = executed[j] < low_end or executed[j] > high_end
                assert not is_outside, f"{where}: float32 {executed[j].hex()}"
                tally["executions"] += 1
            is_outside = exact < low_end or exact > high_end
            assert not is_outside, f"{where}: {exact.str(20)}"
            tally["inside"] += bool(low_end <= exact <= high_end)


@pytest.mark.parametrize("kind", KINDS, ids=str)
@pytest.mark.parametrize("n", SHORT_AND_LONG)
def test_expressions(kind: Kind, n: int) -> None:
    rng = np.random.default_rng([101, n])
    v = kind.variables or 3
    tally: Counter[str] = Counter()
    with flint.ctx.workprec(PRECISION):
        for _ in range(n):
            centers = rng.choice([-1.0, 1.0], v) * 10.0 ** rng.uniform(-2, 2, v)
            tree, _ = grow(rng, int(rng.integers(3, 7)), centers.astype(np.float32))
            reach = RADII[:, None] * np.abs(centers)
            low, high = ((centers + s * reach).astype(np.float32).astype(float) for s in (-1, 1))
            t = np.where(
                rng.random((len(RADII), POINTS, v)) < 0.5,
                rng.integers(0, 2, (len(RADII), POINTS, v)),
                rng.random((len(RADII), POINTS, v)),
            )
            x = (low[:, None] * (1 - t) + high[:, None] * t).astype(np.float32).astype(float)
            check_tree(kind, tree, low, high, np.clip(x, low[:, None], high[:, None]), tally)
    cells = n * len(RADII)
    assert tally["varying"] > 0.4 * cells, tally
    assert tally["inside"] > 0.5 * cells * POINTS, tally
    assert tally["executions"] > (0.4 * cells * POINTS if kind.executed else -1), tally
