"""The elementary functions in arbitrary precision, the tightest doubles around them, and arguments that are hard."""

from __future__ import annotations

import math
from collections.abc import Callable

import flint
import numpy as np

NAMES = ("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan")
INF = math.inf
LARGEST = np.finfo(np.float64).max
PRECISION = 400  # bits; the ball functions reduce 2^1024 with more by themselves
PRECISION_OF_TINY = 2400  # for sin(2^-1074), which differs from its argument by 2^-2150 of it

Ball = flint.arb
Pair = tuple[float, float]

# Where the function's value is a double: no others, by Lindemann's theorem.
EXACT = {
    ("exp", 0.0): 1.0,
    ("log", 1.0): 0.0,
    ("sin", 0.0): 0.0,
    ("cos", 0.0): 1.0,
    ("tan", 0.0): 0.0,
    ("asin", 0.0): 0.0,
    ("acos", 1.0): 0.0,
    ("atan", 0.0): 0.0,
}


def ball(name: str, x: float) -> Ball:
    """The value at a double of the domain, within 2^-300 of itself."""
    with flint.ctx.workprec(PRECISION if abs(x) > 2.0**-60 else PRECISION_OF_TINY):
        value = getattr(Ball(x), name)()
    assert value == 0 or value.rel_accuracy_bits() > 300
    return value


def tightest(value: Ball) -> Pair:
    """The doubles next to a number that is not a double."""
    if value > LARGEST:
        return LARGEST, INF
    down = float(value.mid())
    while not down < value:
        down = math.nextafter(down, -INF)
    while math.nextafter(down, INF) < value:
        down = math.nextafter(down, INF)
    up = math.nextafter(down, INF)
    assert value < up
    return down, up


def tightest_at(name: str, x: float) -> Pair:
    exact = EXACT.get((name, x))
    if exact is not None:
        return exact, exact
    if name == "exp" and abs(x) > 750:  # balls have large exponents, but not that large
        return (LARGEST, INF) if x > 0 else (0.0, 5e-324)
    return tightest(ball(name, x))


# --- Over intervals ---


def last_multiple(x: float) -> int:
    """The largest n with n pi/2 <= x: only 0 is a multiple itself."""
    if x == 0:
        return 0
    with flint.ctx.workprec(1400):
        return int((2 * Ball(x) / Ball.pi()).floor().unique_fmpz())


def multiples(lo: float, hi: float) -> range:
    """All n with n pi/2 in [lo, hi]."""
    return range(last_multiple(lo) + (lo != 0), last_multiple(hi) + 1)


def tightest_of_sine(name: str, lo: float, hi: float) -> Pair:
    if math.isinf(lo) or math.isinf(hi):
        return -1.0, 1.0
    phases = {(n + (name == "cos")) % 4 for n in multiples(lo, hi)[:4]}
    ends = (*tightest_at(name, lo), *tightest_at(name, hi))
    return -1.0 if 3 in phases else min(ends), 1.0 if 1 in phases else max(ends)


def tightest_of_tangent(lo: float, hi: float) -> Pair:
    if math.isinf(lo) or math.isinf(hi) or any(n % 2 for n in multiples(lo, hi)[:2]):
        return -INF, INF
    return tightest_at("tan", lo)[0], tightest_at("tan", hi)[1]


LIMITS = {
    ("exp", -INF): 0.0,
    ("exp", INF): INF,
    ("log", 0.0): -INF,
    ("log", INF): INF,
}
DOMAIN = {"log": (0.0, INF), "asin": (-1.0, 1.0), "acos": (-1.0, 1.0)}


def tightest_end(name: str, x: float, side: int) -> float:
    if (name, x) in LIMITS:
        return LIMITS[name, x]
    if math.isinf(x):
        return math.copysign(tightest(Ball.pi() / 2)[side], x) if x > 0 else -tightest(Ball.pi() / 2)[1 - side]
    return tightest_at(name, x)[side]


def tightest_range(name: str, lo: float, hi: float) -> Pair:
    """The tightest doubles around the range over [lo, hi]; (inf, -inf) where that is empty."""
    if name in ("sin", "cos"):
        return tightest_of_sine(name, lo, hi)
    if name == "tan":
        return tightest_of_tangent(lo, hi)
    least, greatest = DOMAIN.get(name, (-INF, INF))
    lo, hi = max(lo, least), min(hi, greatest)
    if lo > hi or (name == "log" and hi == 0):
        return INF, -INF
    if name == "acos":
        lo, hi = hi, lo
    return tightest_end(name, lo, 0), tightest_end(name, hi, 1)


# --- Hard arguments ---


def steps_away(x: np.ndarray, rng: np.random.Generator, most: int = 4) -> np.ndarray:
    """Each number moved by up to `most` doubles."""
    return (x.view(np.int64) + rng.integers(-most, most + 1, x.shape)).view(np.float64)


def all_exponents(n: int, rng: np.random.Generator) -> np.ndarray:
    """Bit patterns of finite doubles; one in eight is subnormal."""
    bits = rng.integers(0, 0x7FF << 52, n, dtype=np.uint64)
    bits[::8] >>= rng.integers(11, 63, len(bits[::8]), dtype=np.uint64)
    return bits.view(np.float64) * rng.choice([-1.0, 1.0], n)


def near_multiples_of_half_pi(n: int, rng: np.random.Generator) -> np.ndarray:
    with flint.ctx.workprec(1400):
        half_pi = Ball.pi() / 2
        counts = [int(2 ** rng.uniform(0, 53)) << int(rng.choice([0, 0, rng.integers(0, 970)])) for _ in range(n)]
        return steps_away(np.array([float((Ball(k) * half_pi).mid()) for k in counts]), rng, 2)


WORST = float(6381956970095103) * 2.0**797  # the double closest to a multiple of pi/2, relatively: 2^-61.5 pi/2


def special_arguments() -> np.ndarray:
    """Thresholds of overflow, underflow and of our own branches, with their neighbours."""
    powers = [
        2.0**k for k in (-1074, -1073, -1022, -600, -300, -100, -75, -74, -73, -54, -53, -27, -26, -25, 100, 1023)
    ]
    thresholds = [709.782712893384, 708.3964185322641, 744.4400719213812, 745.1332191019412, 746.0, 750.0]
    others = [0.75, 1.0, 1.4142, 0.7071, math.pi / 4, math.pi / 2, math.pi, WORST, LARGEST, 2.0**52 * 3, 5e-324, 1e22]
    around = np.array([*powers, *thresholds, *others])
    around = np.concatenate([around, np.nextafter(around, 0), np.nextafter(np.minimum(around, LARGEST / 2), INF)])
    return np.concatenate([around, -around, [0.0, -0.0]])


def table_edges(name: str, n: int, rng: np.random.Generator) -> np.ndarray:
    """Where the argument's reduction goes from one table entry to the next."""
    if name == "exp":
        return steps_away((rng.integers(-47600, 45400, n) + 0.5) * (math.log(2) / 64), rng)
    if name == "log":
        return steps_away((rng.integers(45, 91, n) + 0.5) / 64, rng) * 2.0 ** rng.integers(-1000, 1000, n)
    edges = (rng.integers(0, 32, n) + 0.5) / 32
    if name in ("asin", "acos"):
        edges = np.sin(np.arctan(edges))
    x = steps_away(edges, rng) * rng.choice([-1.0, 1.0], n)
    return x ** rng.choice([-1.0, 1.0], n) if name == "atan" else x


MIDDLE: dict[str, Callable[[int, np.random.Generator], np.ndarray]] = {
    "exp": lambda n, rng: rng.uniform(-746, 710, n),
    "log": lambda n, rng: 1 + 2.0 ** rng.uniform(-53, 0, n) * rng.choice([-0.5, 1.0], n),
    "asin": lambda n, rng: (1 - 2.0 ** rng.uniform(-53, 0, n)) * rng.choice([-1.0, 1.0], n),
    "acos": lambda n, rng: (1 - 2.0 ** rng.uniform(-53, 0, n)) * rng.choice([-1.0, 1.0], n),
    "atan": lambda n, rng: rng.choice([-1.0, 1.0], n) * 2.0 ** rng.uniform(-30, 60, n),
}


def in_domain(name: str, x: np.ndarray) -> np.ndarray:
    """The arguments with values: those outside are folded into the domain or, with no value, dropped."""
    if name == "log":
        return np.abs(x[x != 0])
    if name in ("asin", "acos"):
        x = x.copy()
        x[np.abs(x) > 1] = 1 / x[np.abs(x) > 1]
    return x


def arguments(name: str, n: int, rng: np.random.Generator) -> np.ndarray:
    """About n arguments of the domain, of every kind above."""
    quarter = n // 4
    middle = MIDDLE.get(name, lambda m, r: r.normal(0, 2.0 ** r.uniform(-20, 20, m)))
    parts = [
        all_exponents(quarter, rng),
        near_multiples_of_half_pi(quarter, rng) if name in ("sin", "cos", "tan") else rng.normal(0, 1, quarter),
        middle(quarter, rng),
        table_edges(name, quarter, rng),
        special_arguments(),
    ]
    return in_domain(name, np.concatenate(parts))


def intervals(name: str, n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Ends of about n intervals: of a few doubles to everything, some infinite, some outside of the domain."""
    x = np.concatenate([arguments(name, n // 2, rng), all_exponents(n // 8, rng)])
    widths = 2.0 ** rng.uniform(-60, 8, len(x))
    with np.errstate(over="ignore"):
        others = [steps_away(x, rng, 3), rng.permutation(x), -x, x * (1 + widths), *[x + widths] * 2, *[x - widths] * 2]
    y = np.choose(rng.integers(0, len(others), len(x)), others)
    y = np.where(np.isnan(y), x, y)  # a step beyond the subnormals or the largest
    lo, hi = np.minimum(x, y), np.maximum(x, y)
    edges = np.array([-INF, -LARGEST, -1.0, -0.0, 0.0, 5e-324, 0.5, 1.0, 1.5, 2.0, 10.0, 800.0, LARGEST, INF])
    a, b = (g.ravel() for g in np.meshgrid(edges, edges))
    keep = (a <= b) & (a < INF) & (b > -INF)
    return np.concatenate([lo, a[keep]]), np.concatenate([hi, b[keep]])
