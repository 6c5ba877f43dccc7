"""What every operation promises on every kind of number, checked against balls of arbitrary precision."""

from __future__ import annotations

from collections import Counter

import flint
import numpy as np
from tests.numbers.conformance.kinds import Balls, Kind, Records
from tests.numbers.conformance.operations import PRECISION, Ball, Operation

from raybound import _core

Box = list[list[tuple[Ball, Ball]]]


def describe(kind: Kind, operation: Operation, operands: list[Records], parameter: float, i: int, what: str) -> str:
    lines = [f"{kind}: {operation.name}, parameter {parameter!r}: {what}"]
    lines += [f"    np.array({[float(x).hex() for x in operand[i]]})" for operand in operands]
    return "\n".join(lines)


def check_canonical(
    kind: Kind, operation: Operation, operands: list[Records], parameter: float, results: Records
) -> None:
    """No NaN, ends in order."""
    bad = ~kind.is_canonical(results)
    i = int(np.argmax(bad))
    assert not bad.any(), describe(kind, operation, operands, parameter, i, f"gives {results[i].tolist()}")


def check_values(
    kind: Kind,
    operation: Operation,
    operands: list[Records],
    parameter: float,
    points: np.ndarray,
    rng: np.random.Generator,
    tally: Counter[str],
) -> Records:
    """The exact result of whatever the operands may be lies within the result, at every point.

    `tally` counts what was inside, on which the results promise nothing, what had no value, and what 256 bits cannot
    decide.
    """
    with flint.ctx.workprec(PRECISION):
        n, shape = len(operands[0]), (len(operands[0]), len(points))
        results = kind.apply(operation.name, operands, parameter)
        check_canonical(kind, operation, operands, parameter, results)
        bounded, empty = kind.is_bounded(results), kind.is_empty(results)
        offsets = [
            np.where(rng.random(shape) < 0.6, rng.integers(-1, 2, shape), rng.uniform(-1, 1, shape)) for _ in operands
        ]
        values = [kind.values(operand, points, t) for operand, t in zip(operands, offsets)]
        box = kind.ends(results, points)
        for i in range(n):
            if not kind.is_set and not bounded[i]:
                tally["unbounded"] += 1
                continue
            tally["bounded"] += bool(bounded[i])
            for j in range(len(points)):
                given = tuple(value[i][j] for value in values)
                if not all(v.is_finite() for v in given):
                    continue
                if operation.is_outside(given, parameter):
                    assert kind.is_set, describe(kind, operation, operands, parameter, i, f"not defined at {given}")
                    tally["outside"] += 1
                    continue
                value = operation.value(given, parameter)
                low, high = box[i][j]
                if value < low or value > high or (empty[i] and value.is_finite()):
                    what = f"{value.str(20)} outside of [{low.str(20)}, {high.str(20)}] at {points[j].tolist()}"
                    raise AssertionError(describe(kind, operation, operands, parameter, i, what))
                inside = low <= value <= high
                tally["inside" if inside else "undecided"] += 1
        if kind.executed:
            check_executions(kind, operation, operands, parameter, points, values, box, tally)
    return results


def floats_within(kind: Kind, operand: Records, points: np.ndarray, values: Balls) -> np.ndarray:
    """For each value a float32 number next to it that the operand may be as well; NaN where there is none."""
    box = kind.ends(operand, points)
    with np.errstate(over="ignore"):  # to infinity, which stands for executions that overflow
        near = np.array([[np.nan if v.is_nan() else float(v) for v in row] for row in values]).astype(np.float32)
    for i, row in enumerate(near.tolist()):
        for j, x in enumerate(row):
            low, high = box[i][j]
            if not (low <= x and x <= high):
                near[i, j] = np.nan
    return near


def check_executions(
    kind: Kind,
    operation: Operation,
    operands: list[Records],
    parameter: float,
    points: np.ndarray,
    values: list[Balls],
    box: Box,
    tally: Counter[str],
) -> None:
    """What float32 arithmetic makes of float32 operands within theirs lies within the result, unless it is NaN."""
    floats = [floats_within(kind, operand, points, value) for operand, value in zip(operands, values)]
    flat = [np.ascontiguousarray(f.reshape(-1, 1)) for f in floats]
    with np.errstate(all="ignore"):
        executed = np.asarray(_core.apply("float32", operation.name, flat, parameter)).reshape(floats[0].shape)
    if operation.name == "power" and parameter == 0:
        executed = np.where(np.isnan(floats[0]), np.nan, executed)
    if operation.name in ("minimum", "maximum"):  # of which one operand alone would survive
        executed = np.where(np.isnan(floats[0]) | np.isnan(floats[1]), np.nan, executed)
    for i, row in enumerate(executed.tolist()):
        for j, value in enumerate(row):
            low, high = box[i][j]
            if value != value or high.is_nan():
                continue
            if not (low <= value and value <= high) and (value < low or value > high):
                given = tuple(float(f[i, j]).hex() for f in floats)
                what = f"float32 {value.hex()} of {given} outside of [{low.str(20)}, {high.str(20)}]"
                raise AssertionError(describe(kind, operation, operands, parameter, i, what))
            tally["executions"] += 1
