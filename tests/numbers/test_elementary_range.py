"""Ranges of exp, log, sin, cos, tan, asin, acos, atan over doubles, against balls of 400 bits: sound and tight."""

import math
import os
import re
from pathlib import Path

import flint
import numpy as np
import pytest
from tests.support import support_elementary as exact
from tests.support.support_elementary import INF, LARGEST, NAMES, Ball

from raybound import _core

SHORT_AND_LONG = [4000, pytest.param(100_000, marks=[pytest.mark.soak, pytest.mark.timeout(3600)])]


@pytest.fixture(autouse=True)
def _precision():
    with flint.ctx.workprec(exact.PRECISION):
        yield


def ranges(name: str, lo: np.ndarray, hi: np.ndarray) -> list[tuple[float, float]]:
    inf, sup = _core.elementary_range(name, np.asarray(lo, np.float64), np.asarray(hi, np.float64))
    assert not np.isnan(inf).any()
    assert not np.isnan(sup).any()
    return list(zip(inf.tolist(), sup.tolist()))


def one(name: str, lo: float, hi: float | None = None) -> tuple[float, float]:
    return ranges(name, np.array([lo]), np.array([lo if hi is None else hi]))[0]


def wider_sides(found: tuple[float, float], tight: tuple[float, float]) -> int:
    """How many sides are an ulp wider than the tightest; fails where a side is tighter, or wider than that."""
    assert found[0] <= tight[0], "not enclosed below"
    assert found[1] >= tight[1], "not enclosed above"
    assert found[0] >= math.nextafter(tight[0], -INF)
    assert found[1] <= math.nextafter(tight[1], INF)
    return (found[0] < tight[0]) + (found[1] > tight[1])


# --- Points ---


@pytest.mark.parametrize("n", SHORT_AND_LONG)
@pytest.mark.parametrize("name", NAMES)
def test_points(name: str, n: int) -> None:
    x = exact.arguments(name, n, np.random.default_rng(41))
    wide = 0
    for value, found in zip(x.tolist(), ranges(name, x, x)):
        sides = wider_sides(found, exact.tightest_at(name, value))
        assert sides <= 1, f"{name} at {value.hex()}"
        wide += sides
    assert len(x) > 0.95 * n
    assert np.sum(np.abs(x) < 2.0**-1022) > n / 60
    # Hard by design: ln(1 + 2^-52) and cos(2^-26) are within 2^-100 of a double. Seen: WIDE.
    assert wide <= 0.04 * n


@pytest.mark.parametrize("n", SHORT_AND_LONG)
@pytest.mark.parametrize("name", NAMES)
def test_points_at_random_are_the_tightest(name: str, n: int) -> None:
    """All but one in 2^20: those within 2^-74 of a double."""
    rng = np.random.default_rng(59)
    x = rng.uniform(-1, 1, n) if name in ("asin", "acos") else rng.uniform(0 if name == "log" else -50, 50, n)
    wide = sum(
        wider_sides(found, exact.tightest_at(name, value)) for value, found in zip(x.tolist(), ranges(name, x, x))
    )
    assert wide <= 1  # seen: WIDE_RANDOM


@pytest.mark.parametrize("name", ["sin", "cos", "tan"])
def test_the_double_closest_to_a_multiple_of_half_pi(name: str) -> None:
    for x in (exact.WORST, -exact.WORST):
        assert one(name, x) == exact.tightest_at(name, x)
    assert abs(float(exact.ball("cos", exact.WORST))) < 2.0**-60.8
    assert abs(one("cos", exact.WORST)[1]) < 2.0**-60.8


@pytest.mark.parametrize(("name", "x"), exact.EXACT)
def test_exact_values_are_points(name: str, x: float) -> None:
    assert one(name, x) == (exact.EXACT[name, x],) * 2
    assert one(name, -0.0) == one(name, 0.0)


@pytest.mark.parametrize("name", ["sin", "tan", "asin", "atan"])
def test_tiny_arguments_lie_beside_their_value(name: str) -> None:
    x = 2.0 ** np.arange(-1074.0, -26)
    away = name in ("tan", "asin")
    for value, found in zip(x.tolist(), ranges(name, x, x)):
        beside = math.nextafter(value, INF if away else 0)
        assert found == (min(value, beside), max(value, beside))
        assert one(name, -value) == (-found[1], -found[0])


def test_overflow_and_underflow_of_exp() -> None:
    last = float.fromhex("0x1.62e42fefa39efp+9")
    assert one("exp", last)[1] < INF
    assert one("exp", math.nextafter(last, INF)) == (LARGEST, INF)
    assert one("exp", LARGEST) == (LARGEST, INF)
    least = float.fromhex("-0x1.74385446d71c3p+9")  # the least x with e^x > 2^-1074
    assert one("exp", least) == (5e-324, 1e-323)
    for x in (math.nextafter(least, -INF), -745.13, -745.14, -745.2, -746.0, -747.0, -1e300):
        assert one("exp", x) == (0, 5e-324)
    for x in np.arange(-745, -707, 0.03125).tolist():
        assert one("exp", x) == exact.tightest_at("exp", x)


# --- Intervals ---


@pytest.mark.parametrize("n", SHORT_AND_LONG)
@pytest.mark.parametrize("name", NAMES)
def test_intervals(name: str, n: int) -> None:
    lo, hi = exact.intervals(name, n, np.random.default_rng(43))
    counts = {"empty": 0, "unbounded": 0, "extremum": 0, "strict": 0}
    wide = 0
    for a, b, found in zip(lo.tolist(), hi.tolist(), ranges(name, lo, hi)):
        tight = exact.tightest_range(name, a, b)
        if tight == (INF, -INF):
            assert found == tight, f"{name} of [{a.hex()}, {b.hex()}]"
            counts["empty"] += 1
            continue
        wide += wider_sides(found, tight)
        counts["unbounded"] += INF in (-tight[0], tight[1])
        counts["extremum"] += -1 == tight[0] or tight[1] == 1
        counts["strict"] += a < b
    assert counts["strict"] > 0.5 * n
    assert counts["empty"] > (n / 50 if name in exact.DOMAIN else -1)
    assert counts["unbounded"] > (n / 50 if name in ("exp", "log", "tan") else -1)
    assert counts["extremum"] > (n / 10 if name in ("sin", "cos") else -1)
    assert wide <= 0.02 * n  # see test_points; seen: WIDE_INTERVALS


@pytest.mark.parametrize("n", SHORT_AND_LONG)
@pytest.mark.parametrize("name", ["sin", "cos", "tan"])
def test_intervals_that_just_hold_a_multiple_of_half_pi(name: str, n: int) -> None:
    """Between neighbouring doubles around a multiple, and a step to either side of it."""
    rng = np.random.default_rng(47)
    near = exact.near_multiples_of_half_pi(n, rng)
    lo, hi = near, exact.steps_away(near, rng, 2)
    lo, hi = np.minimum(lo, hi), np.maximum(lo, hi)
    turns = rng.integers(0, 6, n)
    hi = np.where(np.abs(hi) < 1e12, hi + turns * (math.pi / 2), hi)
    held = 0
    for a, b, found in zip(lo.tolist(), hi.tolist(), ranges(name, lo, hi)):
        held += bool(exact.multiples(a, b))
        assert wider_sides(found, exact.tightest_range(name, a, b)) == 0
    assert 0.3 * n < held < 0.95 * n


@pytest.mark.parametrize("name", ["sin", "cos", "tan"])
def test_whole_turns(name: str) -> None:
    everything = (-INF, INF) if name == "tan" else (-1, 1)
    for x in (0.0, 1.0, -1e5, 1e15, 1e300, -exact.WORST):
        for width in (6.3, 6.4999, 6.5, 7.0, 100.0, 1e308):
            assert one(name, x, x + max(width, 8 * math.ulp(x))) == everything
    assert one(name, -INF, INF) == everything
    assert one(name, -INF, 0) == everything
    assert one(name, 0, INF) == everything


def test_unbounded_ends() -> None:
    up = math.nextafter(math.pi / 2, INF)
    assert one("exp", -INF, 0) == (0, 1)
    assert one("exp", 0, INF) == (1, INF)
    assert one("log", 0, 1) == (-INF, 0)
    assert one("log", 1, INF) == (0, INF)
    assert one("log", -INF, INF) == (-INF, INF)
    assert one("atan", -INF, INF) == (-up, up)
    assert one("asin", -INF, INF) == (-up, up)
    assert one("acos", -INF, INF) == (0, math.nextafter(math.pi, INF))
    assert one("atan", INF) == (math.pi / 2, up)


def test_outside_of_the_domain_is_empty() -> None:
    for name, lo, hi in [("log", -2, -1), ("log", -1, 0), ("log", 0, 0), ("log", -INF, -5e-324)]:
        assert one(name, lo, hi) == (INF, -INF)
    for name in ("asin", "acos"):
        beyond = math.nextafter(1, 2)
        assert one(name, beyond, 2) == one(name, -INF, -beyond) == one(name, beyond) == (INF, -INF)


def test_refuses() -> None:
    x = np.zeros(3)
    with pytest.raises(ValueError, match="elementary_range: name must be"):
        _core.elementary_range("sinh", x, x)
    with pytest.raises(ValueError, match="elementary_range: lo and hi must have the same shape"):
        _core.elementary_range("sin", x, np.zeros((3, 1)))
    for lo, hi in ((1.0, 0.0), (math.nan, 0.0), (0.0, math.nan)):
        with pytest.raises(ValueError, match="elementary_range: lo must be <= hi"):
            _core.elementary_range("sin", np.array([0, lo]), np.array([0, hi]))
    assert _core.elementary_range("sin", np.zeros((2, 0, 3)), np.zeros((2, 0, 3)))[0].shape == (2, 0, 3)


# --- What they are made of ---


@pytest.mark.parametrize("n", SHORT_AND_LONG)
@pytest.mark.parametrize("name", NAMES)
def test_error_of_the_values_that_are_rounded(name: str, n: int) -> None:
    """|computed - exact| <= 2^-74 |exact| (cpp/derivations.md, D10)."""
    x = exact.arguments(name, n, np.random.default_rng(53))
    x = x[(np.abs(x) >= 2.0**-26) & ((name != "exp") | (np.abs(x) < 600))]
    worst = 0.0
    for value, high, low in zip(x.tolist(), *(part.tolist() for part in _core.elementary_range_values(name, x))):
        if (name, value) in exact.EXACT:
            assert (high, low) == (exact.EXACT[name, value], 0)
            continue
        true = exact.ball(name, value)
        worst = max(worst, float(abs((Ball(high) + Ball(low) - true) / true).mid()))
        assert high == high + low
    assert len(x) > 0.4 * n
    assert 2.0**-110 < worst <= 2.0**-74, f"{worst * 2.0**74} of the bound"  # seen: ERROR


def worst_of(table: np.ndarray, values: list[Ball]) -> float:
    assert len(table) == len(values)
    return max(
        float(abs((Ball(h) + Ball(low) - v) / v).mid()) if v != 0 else abs(h) + abs(low)
        for (h, low), v in zip(table.tolist(), values)
    )


def test_constants_and_tables() -> None:
    t = _core.elementary_range_tables()
    pi = Ball.pi()
    assert worst_of(np.array([t["pi"], t["ln_2"]]), [pi, Ball.const_log2()]) < 2.0**-107
    assert (t["pi_down"], t["pi_up"]) == exact.tightest(pi)
    tables = {
        "atan": [(Ball(j) / 32).atan() for j in range(33)],
        "log": [(Ball(j) / 64).log() for j in range(45, 92)],
        "exp2": [(Ball(j) / 64 * Ball.const_log2()).exp() for j in range(64)],
    }
    for name, values in tables.items():
        assert worst_of(t[name], values) < 2.0**-97  # seen: TABLE
    with flint.ctx.workprec(1500):
        bits = int((2 / Ball.pi() * Ball(2) ** 1280).floor().unique_fmpz())
    assert t["two_over_pi"] == [bits >> 64 * i & (2**64 - 1) for i in range(20, -1, -1)]


def test_coefficients() -> None:
    t = _core.elementary_range_tables()
    wanted = {
        "exp_minus_one": (2, [Ball(1) / math.factorial(i) for i in range(1, 9)]),
        "sine_over_angle": (4, [(-1) ** i * Ball(1) / math.factorial(2 * i + 1) for i in range(1, 12)]),
        "cosine_minus_one": (4, [(-1) ** i * Ball(1) / math.factorial(2 * i) for i in range(1, 12)]),
        "arc_over_tangent": (1, [Ball(1) / (2 * i + 1) for i in range(1, 7)]),
    }
    for name, (leading, values) in wanted.items():
        assert worst_of(t[name][:leading], values[:leading]) < 2.0**-101
        assert worst_of(t[name][leading:], values[leading:]) < 2.0**-53


def closest_to_an_integer(a: int, bits: int, most: int) -> float:
    """The least |m a/2^bits - k| over 1 <= m <= most: that of the last convergent with a denominator in this range."""
    x, y, before, k = a, 1 << bits, 1, 0
    p_before, p = 0, 1
    closest = INF
    while y:
        quotient, (x, y) = x // y, (y, x % y)
        before, k = k, quotient * k + before
        p_before, p = p, quotient * p + p_before
        if k > most:
            break
        closest = abs(k * a - (p << bits)) / (1 << bits)
    return closest


@pytest.mark.soak
def test_how_close_doubles_come_to_multiples_of_half_pi() -> None:
    """What the reduction rests on: 2^-61.6 of pi/2, over all doubles m 2^e."""
    bits = 400
    with flint.ctx.workprec(2000):
        two_over_pi = int((2 / Ball.pi() * Ball(2) ** 1600).floor().unique_fmpz())
    found = {}
    for e in range(-53, 972):
        fraction = (two_over_pi >> (1600 - bits - e)) & ((1 << bits) - 1)
        found[e] = closest_to_an_integer(fraction, bits, 2**53 - 1)
    assert 2.0**-61.6 < min(found.values()) < 2.0**-61.5  # seen: 2^-61.54 at e = 797
    assert min(found, key=found.__getitem__) == 797


# --- Third-party vectors ---

DATA = Path(os.environ.get("RAYBOUND_DATA", "nowhere")) / "itl"
CASE = re.compile(r"^\s*(" + "|".join(NAMES) + r")\s*\[(.*?)\]\s*=\s*\[(.*?)\];", re.MULTILINE)


def ends(text: str) -> tuple[float, float]:
    if text in ("empty", "entire"):
        return {"empty": (INF, -INF), "entire": (-INF, INF)}[text]
    bounds = [float.fromhex(part) if "x" in part.lower() else float(part) for part in text.split(",")]
    return bounds[0], bounds[-1]


@pytest.mark.skipif(not DATA.is_dir(), reason="RAYBOUND_DATA does not name the folder with itl/*.itl")
def test_itf1788_vectors() -> None:
    cases = wide = 0
    for path in sorted(DATA.glob("*.itl")):
        for name, argument, result in CASE.findall(path.read_text(encoding="utf-8")):
            wide += wider_sides(one(name, *ends(argument)), ends(result))
            cases += 1
    assert cases >= 230
    assert wide == 0
