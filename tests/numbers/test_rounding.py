"""Rounding toward either infinity: exact integers judge it in C++, rationals and a table of special values here."""

import math
from fractions import Fraction

import numpy as np
import pytest

from raybound import _core

INF, NAN = math.inf, math.nan
OPERATIONS = ["add", "subtract", "multiply", "divide", "sqrt", "fma"]
IMPLEMENTATIONS = _core.rounding_implementations()
TYPES = [np.float32, np.float64]

every_implementation = pytest.mark.parametrize("implementation", IMPLEMENTATIONS)
every_type = pytest.mark.parametrize("dtype", TYPES)


def directed(name: str, up: bool, operands: np.ndarray, implementation: str) -> np.ndarray:
    padded = [*operands, *(np.ones_like(operands[0]) for _ in range(3 - len(operands)))]
    return _core.directed(name, up, *padded, implementation)


# --- Trials ---


@pytest.mark.parametrize(
    "count", [100_000, pytest.param(10_000_000, marks=[pytest.mark.soak, pytest.mark.timeout(3000)])]
)
@pytest.mark.parametrize("operation", OPERATIONS)
@pytest.mark.parametrize("wide", [False, True], ids=["float", "double"])
@every_implementation
def test_trials_against_exact_integers(operation: str, wide: bool, implementation: str, count: int) -> None:
    found = _core.rounding_trials(operation, wide, implementation, 101, count)
    assert found["violations"] == 0, found["first_failure"]
    assert found["not_tight"] == 0, found["first_failure"]
    assert found["differences"] == 0
    n = found["trials"]
    assert n >= 2 * count  # both directions
    assert found["inexact"] > 0.4 * n
    assert found["exact"] > 0.03 * n
    assert found["special"] > 0.05 * n
    if operation in ("multiply", "divide", "fma"):
        assert found["underflows"] > 0.05 * n
    if operation != "sqrt":
        assert found["overflows"] > 0.01 * n
    if operation in ("add", "subtract", "fma"):
        assert found["cancellations"] > 0.04 * n


def exact(name: str, a: float, b: float, c: float) -> Fraction:
    x, y, z = Fraction(a), Fraction(b), Fraction(c)
    return {
        "add": lambda: x + y,
        "subtract": lambda: x - y,
        "multiply": lambda: x * y,
        "divide": lambda: x / y,
        "fma": lambda: x * y + z,
    }[name]()


@pytest.mark.parametrize("name", [n for n in OPERATIONS if n != "sqrt"])
@every_type
@every_implementation
def test_neighbours_of_rationals(name: str, dtype: type, implementation: str) -> None:
    """A second judge: the results are the exact rational or the two numbers next to it."""
    rng = np.random.default_rng(5)
    operands = (rng.choice([-1, 1], (3, 2000)) * 10 ** rng.uniform(-6, 6, (3, 2000))).astype(dtype)
    operands[2, ::2] = -(operands[0] * operands[1])[::2]
    low, high = (directed(name, up, operands, implementation) for up in (False, True))
    inexact = 0
    for a, b, c, below, above in zip(*operands.tolist(), low.tolist(), high.tolist()):
        value = exact(name, a, b, c)
        assert Fraction(below) <= value <= Fraction(above)
        if below != above:
            inexact += 1
            assert np.nextafter(dtype(below), dtype(INF)) == above
        else:
            assert value == Fraction(below)
    assert inexact > 900


# --- Special values: the table of rounding.h ---


def limits(dtype: type) -> tuple[float, float, float]:
    info = np.finfo(dtype)
    return float(info.max), float(info.tiny), float(info.smallest_subnormal)


def special_cases(dtype: type) -> list[tuple[str, tuple[float, ...], float, float]]:
    """Operation, operands, the results rounded down and up."""
    big, _, least = limits(dtype)
    return [
        ("add", (big, big), big, INF),
        ("add", (-big, -big), -INF, -big),
        ("add", (big, least), big, INF),
        ("subtract", (-big, least), -INF, -big),
        ("multiply", (big, 2), big, INF),
        ("multiply", (-big, 2), -INF, -big),
        ("divide", (big, 0.5), big, INF),
        ("divide", (-big, least), -INF, -big),
        ("fma", (big, 2, -1), big, INF),
        ("fma", (-big, 2, 1), -INF, -big),
        ("multiply", (least, 0.5), 0.0, least),
        ("multiply", (-least, 0.5), -least, -0.0),
        ("multiply", (least, least), 0.0, least),
        ("multiply", (least, -least), -least, -0.0),
        ("divide", (least, 2), 0.0, least),
        ("divide", (-least, big), -least, -0.0),
        ("fma", (least, 0.5, 0.0), 0.0, least),
        ("fma", (-least, 0.5, -0.0), -least, -0.0),
        ("fma", (least, least, 1.0), 1.0, float(np.nextafter(dtype(1), dtype(2)))),
        ("fma", (least, -least, 1.0), float(np.nextafter(dtype(1), dtype(0))), 1.0),
        ("add", (1, -1), -0.0, 0.0),
        ("add", (0.0, -0.0), -0.0, 0.0),
        ("add", (0.0, 0.0), 0.0, 0.0),
        ("add", (-0.0, -0.0), -0.0, -0.0),
        ("subtract", (0.0, 0.0), -0.0, 0.0),
        ("subtract", (0.0, -0.0), 0.0, 0.0),
        ("fma", (2, 3, -6), -0.0, 0.0),
        ("fma", (0.0, 3, -0.0), -0.0, 0.0),
        ("fma", (-0.0, 3, -0.0), -0.0, -0.0),
        ("multiply", (0.0, -3), -0.0, -0.0),
        ("divide", (-0.0, 3), -0.0, -0.0),
        ("divide", (3, -INF), -0.0, -0.0),
        ("sqrt", (0.0,), 0.0, 0.0),
        ("sqrt", (-0.0,), -0.0, -0.0),
        ("sqrt", (INF,), INF, INF),
        ("sqrt", (-1.0,), NAN, NAN),
        ("divide", (1, 0.0), INF, INF),
        ("divide", (1, -0.0), -INF, -INF),
        ("add", (-INF, 1), -INF, -INF),
        ("add", (INF, -big), INF, INF),
        ("multiply", (-INF, least), -INF, -INF),
        ("fma", (INF, 1, -big), INF, INF),
        ("fma", (1, 1, -INF), -INF, -INF),
        ("add", (INF, -INF), NAN, NAN),
        ("multiply", (0, INF), NAN, NAN),
        ("divide", (0, 0), NAN, NAN),
        ("divide", (INF, INF), NAN, NAN),
        ("fma", (0, INF, 1), NAN, NAN),
        ("fma", (INF, 1, -INF), NAN, NAN),
        ("add", (NAN, 1), NAN, NAN),
        ("fma", (0, 1, NAN), NAN, NAN),
    ]


@every_type
@every_implementation
def test_special_values(dtype: type, implementation: str) -> None:
    cases = special_cases(dtype)
    assert len(cases) > 50
    for name, values, down, up in cases:
        operands = np.array(values, dtype)[:, None]
        for upward, expected in ((False, down), (True, up)):
            found = directed(name, upward, operands, implementation)[0]
            assert np.array_equal(found, dtype(expected), equal_nan=True), (name, values, upward, found)
            assert math.isnan(expected) or np.signbit(found) == np.signbit(expected), (name, values, upward, found)


@every_implementation
def test_rounding_of_the_process_stays_to_nearest(implementation: str) -> None:
    _core.rounding_trials("fma", True, implementation, 3, 1000)
    one, half_ulp = np.float64(1), np.float64(2.0**-53)
    assert one + half_ulp == 1
    assert one - half_ulp / 2 == 1
    assert -one - half_ulp == -1
    assert one + half_ulp * 1.5 > 1


def test_names_that_do_not_exist() -> None:
    with pytest.raises(ValueError, match=r"operation must be 'add'.*got 'modulo'"):
        _core.rounding_trials("modulo", True, "portable", 1, 8)
    with pytest.raises(ValueError, match=r"implementation must be 'portable'.*got 'fast'"):
        _core.interval_trials("add", True, "fast", 1, 8)
    with pytest.raises(ValueError, match=r"kind must be 'double'.*got 'quad'"):
        _core.time_multiply_add("quad", 16, 1)
    with pytest.raises(ValueError, match=r"n must be > 0"):
        _core.time_multiply_add("double", 0, 1)


def test_times_are_measured() -> None:
    kinds = ["double", "interval portable", "interval best", "interval array"]
    assert all(0 < _core.time_multiply_add(kind, 64, 2) < 1e6 for kind in kinds)
