"""RunningError from Python: how it is made, rounded and printed, and how it flags what is unknown.

What they share with the other numbers is in test_numbers_api.py.
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import raybound as rb

NAN, INF = float("nan"), float("inf")
f32 = np.float32


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((1, -1), ValueError, "error must be >= 0, got -1"),
        (([1, 2], [0, -0.5]), ValueError, "error must be >= 0, got -0.5 at index 1"),
        ((1, NAN), ValueError, "error must be finite, got nan"),
        ((1, INF), ValueError, "error must be finite, got inf"),
        ((NAN,), ValueError, "value must be finite, got nan"),
        (([[1, 2], [3, -INF]],), ValueError, "value must be finite, got -inf at index (1, 1)"),
        (([1, 2], [1, 2, 3]), ValueError, "value and error must broadcast, got shapes (2,) and (3,)"),
        (([[1], [1, 2]],), ValueError, "value must be a number or an array of numbers, got [[1], [1, 2]]"),
        (("1",), TypeError, "value must be a number or an array of numbers, got '1' of type str"),
        ((True,), TypeError, "value must be a number or an array of numbers, got True of type bool"),
        ((1j,), TypeError, "value must be a number or an array of numbers, got 1j of type complex"),
        ((1, None), TypeError, "error must be a number or an array of numbers, got None of type NoneType"),
        ((rb.Interval(1, 2),), TypeError, "value must be a number or an array of numbers, got a Interval"),
        ((1, rb.RunningError(1)), TypeError, "error must be a number or an array of numbers, got a RunningError"),
    ],
)
def test_running_errors_refuse(arguments: tuple[Any, ...], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=re.escape(f"RunningError: {message}")):
        rb.RunningError(*arguments)


def test_parts_of_running_errors() -> None:
    a = rb.RunningError([2.0, -4.0, 0.0], [0.5, 0, 1])
    assert (a.value.tolist(), a.error.tolist()) == ([2, -4, 0], [0.5, 0, 1])
    assert (a.lower.tolist(), a.upper.tolist()) == ([1.5, -4, -1], [2.5, -4, 1])
    assert a.enclosure == rb.Interval([1.5, -4, -1], [2.5, -4, 1])
    assert a.relative_error == pytest.approx([1 / 3, 0, INF], rel=1e-15)
    assert a.relative_error[0] >= 1 / 3
    assert rb.RunningError(0).relative_error == 0
    single = rb.RunningError(1.5, 0.25)
    assert all(isinstance(part, float) for part in (single.value, single.error, single.lower, single.upper))
    with pytest.raises(ValueError, match="read-only"):
        a.value[0] = 1


def test_given_errors_are_rounded_up() -> None:
    for value, error in ((0.1, 0.2), (1.0, 1e-30), (-3.0, 0.1), (f32(0.1), 0.2), (f32(1), 1e-60), (f32(-7), 1e-9)):
        a = rb.RunningError(value, error)
        assert a.value == value
        assert Fraction(float(a.lower)) <= Fraction(float(value)) - Fraction(error)
        assert Fraction(float(a.upper)) >= Fraction(float(value)) + Fraction(error)
        assert a.error >= error
        assert a.error - error <= np.spacing(max(abs(a.value), a.error)), "at most one step wider"
    assert rb.RunningError(f32(3e38), 1e39).error == INF
    assert rb.RunningError(0, f32(3.4028235e38)).error == f32(3.4028235e38)
    assert rb.RunningError(f32(0), f32(3.4028235e38)).upper == f32(3.4028235e38)


def test_precision_of_running_errors() -> None:
    narrow, wide = rb.RunningError(f32(0.1)), rb.RunningError(0.1)
    for number in (
        narrow,
        narrow + 1,
        2 / narrow,
        narrow * f32([1, 2]),
        rb.exp(narrow),
        rb.RunningError(np.float16(1)),
    ):
        parts = (number.value, number.error, number.lower, number.upper, number.enclosure.inf, number.relative_error)
        assert {part.dtype for part in parts} == {np.dtype(f32)}
    for number in (wide, narrow + wide, wide - narrow, narrow * np.array([1.0]), narrow + np.float64(1)):
        assert number.value.dtype == number.error.dtype == np.float64
    assert rb.RunningError(f32(1), 0.1).value.dtype == f32, "the value decides"
    assert rb.RunningError(1, f32(0.1)).value.dtype == np.float64
    assert rb.RunningError(1).value.dtype == rb.RunningError(np.int8([1])).value.dtype == np.float64
    assert narrow != rb.RunningError(np.float64(f32(0.1)))


def test_python_numbers_meet_float32() -> None:
    """Rounded as plain floats round them, and enclosed by their neighbours: 1e60 becomes infinite, flagged."""
    zero = rb.RunningError(f32(0))
    for x in (0.1, 1 / 3, -1e-3, 1e-60, 2**24 + 1, 2, 1e-40):
        a = zero + x
        assert a.value == f32(x)
        assert float(a.lower) <= x <= float(a.upper)
        assert a.upper <= np.nextafter(a.lower, f32(INF))
    assert (zero + 2).error == 0
    for x in (1e60, -1e60):
        a = zero + x
        assert (a.value, a.error) == (f32(np.sign(x) * INF), INF)
        assert float(a.lower) <= x <= float(a.upper)


def test_running_errors_broadcast() -> None:
    column, row = rb.RunningError(np.ones((2, 1)), 0.5), rb.RunningError(np.arange(3.0))
    assert (column + row).shape == rb.fma(column, row, 1).shape == (2, 3)
    assert (column + row).value.tolist() == [[1, 2, 3]] * 2
    assert (column + row)[1, 2].enclosure == rb.Interval(2.5, 3.5)
    assert rb.RunningError([1, 2], [[0], [0.5]]).error.tolist() == [[0, 0], [0.5, 0.5]]
    assert (rb.RunningError([]) + 1).shape == (0,)
    for other in (rb.RunningError([1, 2]), np.ones(2)):
        with pytest.raises(ValueError, match=r"add: .*\(shapes \(3,\) and \(2,\)\)"):
            row + other


def test_running_errors_print_as_expressions() -> None:
    for a in (rb.RunningError(0.1, 0.25), rb.RunningError(f32(0.1), f32(0)), rb.RunningError(-2)):
        again = eval(repr(a), {"RunningError": rb.RunningError, "np": np})
        assert again.value.dtype == a.value.dtype
        assert again.value == a.value
        assert a.enclosure in again.enclosure
    assert repr(rb.RunningError(f32([1, 2]))) == "<RunningError array of shape (2,), float32>"


UNDEFINED = {
    "sqrt": (lambda a: rb.sqrt(a), -1, (0.5, 1)),
    "rsqrt": (lambda a: rb.rsqrt(a), 0, (0.5, 0.5)),
    "log": (lambda a: rb.log(a), -1, (1, 1)),
    "asin": (lambda a: rb.asin(a), 2, (1, 0.125)),
    "acos": (lambda a: rb.acos(a), -1.5, (-1, 0.125)),
    "reciprocal": (lambda a: rb.reciprocal(a), 0, (1, 1)),
    "divide": (lambda a: 1 / a, 0, (-1, 2)),
    "divide itself": (lambda a: a / a, 0, (1, 2)),
    "power": (lambda a: a**-3, 0, (1, 2)),
    "tan": (lambda a: rb.tan(a), None, (1.5, 0.25)),
    "overflow": (lambda a: rb.exp(a), 1000, (700, 100)),
}


@pytest.mark.parametrize("name", UNDEFINED)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_what_may_be_undefined_has_infinite_errors(name: str, dtype: type) -> None:
    """Certainly outside of the domain, and only perhaps: flagged, and so is all that follows."""
    function, outside, (value, error) = UNDEFINED[name]
    doubtful = [rb.RunningError(dtype(value), error)]
    doubtful += [] if outside is None else [rb.RunningError(dtype(outside))]
    for a in doubtful:
        result = function(a)
        followers = [result] if name == "overflow" else [result, result * 0 + 1, rb.atan(result), result - result]
        for flagged in followers:
            assert flagged.error == flagged.relative_error == INF
            assert not np.isnan([flagged.lower, flagged.upper]).any()
            if name != "overflow":
                assert flagged.enclosure == rb.Interval(dtype(-INF), dtype(INF))
    whole = function(rb.RunningError(dtype(0.75), 0.125))
    assert 0 < whole.error < INF
