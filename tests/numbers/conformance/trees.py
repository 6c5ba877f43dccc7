"""Random expressions over all operations, that any kind of number can evaluate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from tests.numbers.conformance.operations import OPERATIONS, Ball, Operation

from raybound import _core

T = TypeVar("T")
PARAMETERS = {"power": (-4, -3, -2, -1, 2, 3, 4, 5, 8), "ward_lobe": (0.25, 0.5, 1.0, 3.0)}


@dataclass(frozen=True)
class Node:
    """A variable (`index`), a constant, or an operation on others."""

    index: int = -1
    constant: float = 0.0
    operation: Operation | None = None
    parameter: float = 0.0
    operands: tuple[Node, ...] = ()

    def __str__(self) -> str:
        if self.operation is None:
            return f"x{self.index}" if self.index >= 0 else self.constant.hex()
        further = [repr(self.parameter)] if self.operation.name in PARAMETERS else []
        return f"{self.operation.name}({', '.join([*map(str, self.operands), *further])})"


def evaluate(
    node: Node,
    variable: Callable[[int], T],
    constant: Callable[[float], T],
    apply: Callable[[Operation, list[T], float], T],
) -> T:
    if node.operation is None:
        return variable(node.index) if node.index >= 0 else constant(node.constant)
    operands = [evaluate(operand, variable, constant, apply) for operand in node.operands]
    return apply(node.operation, operands, node.parameter)


def in_float64(operation: Operation, operands: list[float], parameter: float) -> float:
    records = [np.array([[x]]) for x in operands]
    return float(_core.apply("float64", operation.name, records, parameter)[0, 0])


def grow(rng: np.random.Generator, depth: int, centers: np.ndarray) -> tuple[Node, float]:
    """An expression of this depth, whose parts are of ordinary size at the centers, and its value there."""
    if depth == 0:
        if rng.random() < 0.2:
            constant = float(np.float32(rng.choice([0.5, 1.0, 2.0, rng.uniform(-3, 3)])))
            return Node(constant=constant), constant
        index = int(rng.integers(0, len(centers)))
        return Node(index=index), float(centers[index])
    while True:
        operation = OPERATIONS[rng.integers(0, len(OPERATIONS))]
        depths = [depth - 1, *rng.integers(0, depth, operation.arity - 1)]
        grown = [grow(rng, int(d), centers) for d in rng.permutation(depths)]
        parameter = float(rng.choice(PARAMETERS.get(operation.name, (0.0,))))
        value = in_float64(operation, [v for _, v in grown], parameter)
        if 1e-3 < abs(value) < 1e3:
            return Node(operation=operation, parameter=parameter, operands=tuple(n for n, _ in grown)), value


class UndefinedError(ValueError):
    """An operation certainly outside of its domain."""


def exactly(operation: Operation, operands: list[Ball], parameter: float) -> Ball:
    if operation.is_outside(tuple(operands), parameter):
        raise UndefinedError
    return operation.value(tuple(operands), parameter)
