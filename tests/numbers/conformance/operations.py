"""The operations of all numbers, each declared once: where it is defined, its exact value, where it is smooth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import flint
import numpy as np

Ball = flint.arb
Numbers = np.ndarray
Centers = Callable[[np.random.Generator, int], Numbers]

PRECISION = 256  # bits
HUGE = 1e6  # e to this power is beyond all floating-point numbers
FAR = Ball("inf")  # stands for a number beyond them


# --- Exact values: of balls that hold the operands, a ball that holds the result; not finite if undecided ---


def exact_exp(x: Ball) -> Ball:
    return FAR if x > HUGE else Ball(2) ** -(10**6) if x < -HUGE else x.exp()


def exact_power(x: Ball, n: float) -> Ball:
    return Ball(1) if n == 0 else x ** int(n)


def exact_lobe(x: Ball, sigma: float) -> Ball:
    return Ball(0) if x == 0 else exact_exp((1 - 1 / (x * x)) / (Ball(sigma) * Ball(sigma)))


def larger(x: Ball, y: Ball) -> Ball:
    return (x + y + abs(x - y)) / 2 if not (x <= y or y <= x) else y if x <= y else x


# --- Where operands are drawn from: ordinary places, and places that are hard for the operation ---


def anywhere(rng: np.random.Generator, n: int) -> Numbers:
    """Of both signs; a third within 10^+-2, a third within float32's range, a sixth in float64's, the rest whole."""
    size = np.choose(
        rng.integers(0, 6, n),
        [10.0 ** rng.uniform(-2, 2, n)] * 2
        + [10.0 ** rng.uniform(-45, 38.5, n)] * 2
        + [10.0 ** rng.uniform(-323, 308.2, n), rng.integers(0, 5, n).astype(float)],
    )
    return size * rng.choice([-1.0, 1.0], n)


def positive(rng: np.random.Generator, n: int) -> Numbers:
    return np.abs(anywhere(rng, n)) * np.where(rng.random(n) < 0.05, -1, 1)


def mixed(*parts: Centers) -> Centers:
    def draw(rng: np.random.Generator, n: int) -> Numbers:
        return np.choose(rng.integers(0, len(parts), n), [part(rng, n) for part in parts])

    return draw


def between(low: float, high: float) -> Centers:
    return lambda rng, n: rng.uniform(low, high, n)


def beside(x: float, closest: float = -16.0) -> Centers:
    """Within 10^closest to 1 of x, relative to it."""
    return lambda rng, n: x * (1 + rng.choice([-1.0, 1.0], n) * 10.0 ** rng.uniform(closest, 0, n))


def multiples(step: float) -> Centers:
    return lambda rng, n: step * rng.integers(-9, 10, n) + rng.choice([-1.0, 1.0], n) * 10.0 ** rng.uniform(-16, 0, n)


def angles(rng: np.random.Generator, n: int) -> Numbers:
    return mixed(multiples(np.pi / 2), between(-10, 10), anywhere)(rng, n)


arcs = mixed(beside(1), beside(-1), between(-1, 1), anywhere)


@dataclass(frozen=True)
class Operation:
    """`outside` says of balls that the operation is certainly not defined there. `smooth_at` is a place where it is
    smooth, monotone in each operand, and where `cubic` says that its third derivative is not 0."""

    name: str
    arity: int
    exact: Callable[..., Ball]
    outside: Callable[..., bool]
    centers: Centers
    smooth_at: tuple[float, ...]
    cubic: bool = True
    parameters: tuple[float, ...] = (0.0,)
    kink: Callable[..., Ball] | None = None  # of the operands: where this is 0 it is not smooth
    # Units in the last place by which floats may be off, from the parameter and the result.
    roundings: Callable[[float, float], float] = lambda parameter, result: 1

    def value(self, operands: tuple[Ball, ...], parameter: float) -> Ball:
        if len(self.parameters) > 1:
            return self.exact(*operands, parameter)
        return self.exact(*operands)

    def is_outside(self, operands: tuple[Ball, ...], parameter: float) -> bool:
        if len(self.parameters) > 1:
            return self.outside(*operands, parameter)
        return self.outside(*operands)


def nowhere(*_: object) -> bool:
    return False


FLOAT = np.float32
SIGMAS = tuple(float(FLOAT(s)) for s in (0.2, 2.0**-12, 0.01, 0.05, 0.5, 1.0, 3.0, 2.0**30))
EXPONENTS = (3, -(2**20), -1000, -17, -4, -3, -2, -1, 0, 1, 2, 4, 5, 8, 33, 100, 1001, 2**20)


def cosines(rng: np.random.Generator, n: int) -> Numbers:
    """Some far from being any; but their squares do not overflow."""
    return np.clip(mixed(between(0, 1), beside(1, -12), between(-1.2, 1.2), anywhere)(rng, n), -1e150, 1e150)


def powers(rng: np.random.Generator, n: int) -> Numbers:
    return mixed(anywhere, between(-2, 2), beside(1, -8), beside(-1, -8))(rng, n)


OPERATIONS = [
    Operation("negative", 1, lambda x: -x, nowhere, anywhere, (1.3,), cubic=False),
    Operation("abs", 1, abs, nowhere, anywhere, (-1.3,), cubic=False, kink=lambda x: x),
    Operation("square", 1, lambda x: x * x, nowhere, anywhere, (1.3,)),
    Operation("sqrt", 1, lambda x: x.sqrt(), lambda x: x < 0, positive, (1.3,)),
    Operation(
        "rsqrt", 1, lambda x: 1 / x.sqrt(), lambda x: x <= 0, positive, (1.3,), roundings=lambda parameter, result: 2
    ),
    Operation("reciprocal", 1, lambda x: 1 / x, lambda x: x == 0, anywhere, (1.3,)),
    Operation(
        "exp", 1, exact_exp, nowhere, mixed(between(-750, 750), between(-110, 90), between(-3, 3), anywhere), (0.3,)
    ),
    Operation("log", 1, lambda x: x.log(), lambda x: x <= 0, mixed(positive, beside(1)), (1.3,)),
    Operation("sin", 1, lambda x: x.sin(), nowhere, angles, (0.4,)),
    Operation("cos", 1, lambda x: x.cos(), nowhere, angles, (0.4,)),
    Operation("tan", 1, lambda x: x.tan(), nowhere, angles, (0.4,)),
    Operation("asin", 1, lambda x: x.asin(), lambda x: abs(x) > 1, arcs, (0.4,)),
    Operation("acos", 1, lambda x: x.acos(), lambda x: abs(x) > 1, arcs, (0.4,)),
    Operation("atan", 1, lambda x: x.atan(), nowhere, mixed(between(-3, 3), anywhere), (0.4,)),
    Operation("add", 2, lambda x, y: x + y, nowhere, anywhere, (1.3, 0.7), cubic=False),
    Operation("subtract", 2, lambda x, y: x - y, nowhere, anywhere, (1.3, 0.7), cubic=False),
    Operation("multiply", 2, lambda x, y: x * y, nowhere, anywhere, (1.3, 0.7)),
    Operation("divide", 2, lambda x, y: x / y, lambda _, y: y == 0, anywhere, (1.3, 0.7)),
    Operation(
        "minimum", 2, lambda x, y: -larger(-x, -y), nowhere, anywhere, (1.3, 0.7), cubic=False, kink=lambda x, y: x - y
    ),
    Operation("maximum", 2, larger, nowhere, anywhere, (1.3, 0.7), cubic=False, kink=lambda x, y: x - y),
    Operation("fma", 3, lambda x, y, z: x * y + z, nowhere, anywhere, (1.3, 0.7, -0.4)),
    Operation(
        "power",
        1,
        exact_power,
        lambda x, n: n < 0 and x == 0,
        powers,
        (1.3,),
        parameters=EXPONENTS,
        roundings=lambda n, result: max(abs(n), 1),
    ),
    Operation(
        "ward_lobe",
        1,
        exact_lobe,
        nowhere,
        cosines,
        (0.93,),
        parameters=SIGMAS,
        roundings=lambda sigma, result: 2 + 4 * abs(np.log(result)) + 4 / sigma**2,  # of the exponent, mostly
    ),
]
BY_NAME = {operation.name: operation for operation in OPERATIONS}
