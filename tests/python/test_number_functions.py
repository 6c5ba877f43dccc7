"""The functions of numbers on plain floats, and that a RunningError's value is what plain floats give, bit for bit."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import raybound as rb

NAN, INF = float("nan"), float("inf")
f32 = np.float32
UNARY = ["sqrt", "rsqrt", "square", "reciprocal", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "abs"]
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{name: getattr(rb, name) for name in UNARY},
    "power": lambda x: rb.power(x, 3),
    "ward_lobe": lambda cosine: rb.ward_lobe(cosine, 0.25),
}
each_function = pytest.mark.parametrize("name", FUNCTIONS)

# --- Plain floats ---


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rb.sqrt(-1.0), "sqrt: not defined for x = -1"),
        (lambda: rb.sqrt([[1, 2], [3, -4]]), "sqrt: not defined for x = -4 at index 1, 1"),
        (lambda: rb.rsqrt(f32([1, -2])), "rsqrt: not defined for x = -2 at index 1"),
        (lambda: rb.log(-0.5), "log: not defined for x = -0.5"),
        (lambda: rb.asin(1.125), "asin: not defined for x = 1.125"),
        (lambda: rb.acos([0, -2]), "acos: not defined for x = -2 at index 1"),
        (lambda: rb.minimum(0, NAN), "minimum: b must be finite, got nan"),
        (lambda: rb.fma(1, [2, INF], 3), "fma: b must be finite, got inf at index 1"),
        (lambda: rb.maximum([1, 2], [1, 2, 3]), "maximum: a and b must broadcast, got shapes (2,) and (3,)"),
        (lambda: rb.fma(f32(1), 1e60, 0), "fma: b must fit in float32 (at most 3.4028235e+38), got 1e+60"),
        (lambda: rb.power(2.0, 2**20 + 1), "power: n must be an integer in -1048576..1048576, got 1048577"),
        (lambda: rb.power(2.0, -(2**20) - 1), "power: n must be an integer in -1048576..1048576, got -1048577"),
        (lambda: rb.ward_lobe(0.5, 0), "ward_lobe: sigma must be > 0, got 0"),
        (lambda: rb.ward_lobe(0.5, -0.25), "ward_lobe: sigma must be > 0, got -0.25"),
        (lambda: rb.ward_lobe(0.5, NAN), "ward_lobe: sigma must be finite, got nan"),
        (lambda: rb.ward_lobe(0.5, [0.25]), "ward_lobe: sigma must be a number, got [0.25]"),
        (lambda: rb.ward_lobe(NAN, 0.25), "ward_lobe: cosine must be finite, got nan"),
    ],
)
def test_values_refused(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        call()


@each_function
def test_types_refused(name: str) -> None:
    function, argument = FUNCTIONS[name], "cosine" if name == "ward_lobe" else "x"
    for wrong in ("1", None, True, [True, 1.0], 1j, {}, [1, "a"], rb.Sphere()):
        with pytest.raises(TypeError, match=f"^{name}: {argument} must be a number or an array of numbers, got "):
            function(wrong)
    for bad in (NAN, INF, f32(-INF), [0.5, NAN]):
        with pytest.raises(ValueError, match=f"^{name}: {argument} must be finite, got -?(nan|inf)"):
            function(bad)


def test_parameters_of_other_types_refused() -> None:
    for n in (1.0, "2", True, None, [2]):
        with pytest.raises(TypeError, match="power: n must be an integer, got"):
            rb.power(2.0, n)  # type: ignore[arg-type]
    for sigma in ("a", None, True, rb.RunningError(1)):
        with pytest.raises(TypeError, match="ward_lobe: sigma must be a number, got"):
            rb.ward_lobe(0.5, sigma)  # type: ignore[arg-type]


@each_function
def test_precision_and_shape_of_results(name: str) -> None:
    function = FUNCTIONS[name]
    assert isinstance(function(0.5), float)
    assert isinstance(function(1), float)
    assert type(function(f32(0.5))) is type(function(np.float16(0.5))) is f32
    for x in (f32([0.25, 0.5]), np.full((2, 3), 0.5, f32), np.zeros((0, 3), f32), f32([[0.5, 1], [1, 0.5]]).T):
        assert function(x).dtype == f32
        assert function(x).shape == x.shape
    for x in ([0.25, 0.5], np.array([[0.5]]), np.int32([1, 1]), [1, 1], []):
        assert function(x).dtype == np.float64
        assert function(x).shape == np.shape(x)
    both = function([0.25, 0.75])
    assert both.tolist() == [function(0.25), function(0.75)]


def test_precision_of_operands_that_meet() -> None:
    """As in NumPy: Python's own numbers take the precision of what they meet, lists and NumPy's scalars do not."""
    for other in (0.1, 2, 1e-60):
        assert type(rb.minimum(f32(1), other)) is type(rb.fma(other, f32(1), other)) is f32
        assert rb.maximum(f32(0), other) == f32(other)
    for wide in (np.float64(2), [2.0], np.int64(2)):
        assert rb.minimum(f32(1), wide).dtype == np.float64
    a, b = np.array([[1.0], [3.0]]), np.array([2.0, 3.0, 0.0])
    assert rb.maximum(a, b).tolist() == np.maximum(a, b).tolist()
    assert rb.fma(a, b, 1).tolist() == (a * b + 1).tolist()
    assert rb.fma(1 + 2.0**-30, 1 - 2.0**-30, -1) == -(2.0**-60), "one rounding"


def test_limits_of_power() -> None:
    assert rb.power(1.0, 2**20) == rb.power(-1.0, -(2**20)) == rb.power(0.0, 0) == 1
    assert rb.power(2.0, 2**20) == rb.power(0.0, -1) == INF
    assert rb.power(-0.0, -1) == -INF
    assert rb.power(np.array([2, -3]), np.int8(3)).tolist() == [8, -27]
    assert rb.power(f32(2), -126) == f32(2.0**-126)
    assert rb.power(f32(2), -149) == 0, "the reciprocal of what overflows"


def test_ends_of_domains() -> None:
    assert rb.sqrt(0) == rb.asin(0) == rb.acos(1) == rb.log(1) == rb.ward_lobe(0, 0.25) == 0
    assert rb.ward_lobe(1, 0.25) == rb.ward_lobe(-1, 0.25) == 1
    assert np.signbit(rb.sqrt(-0.0))
    assert rb.rsqrt(0) == rb.reciprocal(0) == rb.exp(1000) == INF
    assert rb.log(0) == rb.reciprocal(-0.0) == -INF
    assert rb.ward_lobe(0.75, 0.1) == rb.ward_lobe(0.75, f32(0.1)), "sigma is a float32"
    sigma = float(f32(0.1))
    assert rb.ward_lobe(0.75, 0.1) == pytest.approx(np.exp((1 - 1 / 0.75**2) / sigma**2), rel=1e-12)


def test_no_warning_at_either_end_of_float32() -> None:
    with np.errstate(all="raise"):
        assert rb.minimum(f32(1), 1e-60) == 0
        assert rb.RunningError(f32(1), 1e-60).error < 2e-7
        assert rb.RunningError(f32(1), 1e60).error == INF
        assert (rb.RunningError(f32(1)) + 1e60).error == INF
        assert (rb.RunningError(1e308) * 10).error == INF
        assert rb.Interval(f32(0), 1e-60).sup == 1e-60
        assert rb.Interval(f32(0), 1e60).sup == 1e60
        assert (rb.Interval(f32(1)) * 1e-60).sup == f32(2.0**-149)


# --- Values of running errors ---

DEPTH, WIDTH = 6, 64
NUMPY: dict[str, Callable[..., Any]] = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "negate": np.negative,
    "sqrt": np.sqrt,
    "square": np.square,
    "abs": np.abs,
}
RUNNING: dict[str, Callable[..., Any]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "negate": lambda a: -a,
}
BINARY = ["+", "-", "*", "/", "minimum", "maximum"]
OTHERS = ["negate", *FUNCTIONS, "fma"]


def arguments_of(name: str) -> int:
    return 2 if name in BINARY else 3 if name == "fma" else 1


def bits(x: np.ndarray) -> np.ndarray:
    return np.where(np.isnan(x), x.dtype.type(NAN), x).view(np.uint32 if x.dtype == f32 else np.uint64)


def plain(name: str, arguments: list[np.ndarray]) -> np.ndarray:
    """What plain floats give: NumPy where it rounds correctly, this package's functions of floats elsewhere."""
    with np.errstate(all="ignore"):
        if name in NUMPY:
            return np.asarray(NUMPY[name](*arguments))
    result = np.full(arguments[0].shape, NAN, arguments[0].dtype)
    function = FUNCTIONS.get(name) or getattr(rb, name)
    for i, operands in enumerate(zip(*arguments)):
        if np.isfinite(operands).all():
            with contextlib.suppress(ValueError):  # not defined: NaN, as the core has it
                result[i] = function(*operands)
    return result


def draw_leaf(random: np.random.Generator, dtype: type) -> np.ndarray:
    size = random.choice([0, 1, 8, 40], WIDTH, p=[0.5, 0.3, 0.15, 0.05])
    x = random.normal(size=WIDTH) * np.exp2(random.uniform(-size, size))
    x[random.random(WIDTH) < 0.05] = 0.0
    return np.asarray(x, dtype)


def check_values(seed: int, dtype: type, seen: dict[str, int]) -> None:
    """A random straight-line program; each line is compared, and its plain result goes on."""
    random = np.random.default_rng(seed)
    values = [draw_leaf(random, dtype) for _ in range(3)]
    numbers = [rb.RunningError(v, np.abs(v) * random.choice([0, 0, 1e-6, 0.5])) for v in values]
    for _ in range(DEPTH):
        name = str(random.choice(BINARY if random.random() < 0.5 else OTHERS))
        chosen = [int(random.integers(len(values))) for _ in range(arguments_of(name))]
        operands = [values[i] for i in chosen]
        function = RUNNING.get(name) or FUNCTIONS.get(name) or getattr(rb, name)
        number, value = function(*[numbers[i] for i in chosen]), plain(name, operands)
        finite = np.isfinite(operands).all(axis=0)
        comparable = finite if name not in NUMPY else np.ones(WIDTH, bool)
        assert number.value.dtype == value.dtype == dtype
        np.testing.assert_array_equal(bits(number.value)[comparable], bits(value)[comparable], err_msg=name)
        assert not np.isnan([number.lower, number.upper, number.error, number.relative_error]).any()
        assert (number.error[~np.isfinite(number.value)] == INF).all()
        seen[name] = seen.get(name, 0) + int(np.isfinite(value[comparable]).sum())
        seen["flagged"] = seen.get("flagged", 0) + int((~np.isfinite(value)).sum())
        values.append(np.where(comparable, value, number.value))
        numbers.append(number)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("programs", [60, pytest.param(6000, marks=pytest.mark.soak)])
def test_values_are_those_of_plain_floats(dtype: type, programs: int) -> None:
    seen: dict[str, int] = {}
    for seed in range(programs):
        check_values(seed, dtype, seen)
    assert set(seen) == {*BINARY, *OTHERS, "flagged"}
    assert min(seen.values()) > 2 * programs, seen
    assert sum(seen.values()) > 0.5 * WIDTH * DEPTH * programs
