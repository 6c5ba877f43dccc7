"""RunningErrors that keep a precise value, and the quadratic, from Python. Judged by arbitrary precision."""

from __future__ import annotations

import pickle
import re
from collections import Counter
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import raybound as rb

f32 = np.float32
INF = float("inf")
SETTINGS = settings(derandomize=True, deadline=None, max_examples=200)
DTYPES = [np.float32, np.float64]
DIGITS = {np.float32: 53, np.float64: np.finfo(np.longdouble).nmant + 1}  # of the precise value


def mp(x: Any) -> mpmath.mpf:
    """Exactly: a long double as two doubles."""
    high = float(x)
    return mpmath.mpf(high) + mpmath.mpf(float(np.longdouble(x) - np.longdouble(high)))


@pytest.mark.parametrize("dtype", DTYPES)
def test_precise_values_are_precise(dtype: type) -> None:
    """Programs of ten operations: the precise value is that of arbitrary precision, but for its own few roundings."""
    rng = np.random.default_rng(61)
    differs = 0
    with mpmath.workprec(300):
        for _ in range(300):
            drawn = (rng.uniform(1, 2, 4)).astype(dtype)
            ours, true = [rb.RunningError(x, precise=True) for x in drawn], [mp(x) for x in drawn]
            for _ in range(10):
                a, b, to = rng.integers(4, size=3)
                name = rng.choice(["+", "*", "/", "sqrt"])
                if name == "sqrt":
                    ours[to], true[to] = rb.sqrt(ours[a]), mpmath.sqrt(true[a])
                else:
                    function = {"+": lambda x, y: x + y, "*": lambda x, y: x * y, "/": lambda x, y: x / y}[name]
                    ours[to], true[to] = function(ours[a], ours[b]), function(true[a], true[b])
            for number, exact in zip(ours, true):
                # Positive numbers do not cancel: ten operations in a row double the error at most each time.
                assert abs(mp(number.precise_value) - exact) <= exact * mpmath.mpf(2) ** (10 - DIGITS[dtype])
                assert number.lower <= number.precise_value <= number.upper
                actual = abs(mp(number.value) - exact) / exact
                assert abs(float(number.actual_relative_error) - actual) <= 2.0 ** (11 - DIGITS[dtype])
                assert number.actual_relative_error <= number.relative_error * (1 + 1e-6)
                differs += number.actual_relative_error > 0
    assert differs > 500


def test_precise_changes_nothing_else() -> None:
    rng = np.random.default_rng(7)
    for dtype in DTYPES:
        x, y = (rng.normal(size=(2, 500)) * 10 ** rng.uniform(-5, 5, (2, 500))).astype(dtype)
        plain, precise = (
            (a / b - rb.exp(-a * a) + 0.1, rb.fma(a, b, 2))
            for a, b in ((rb.RunningError(x, 1e-7), rb.RunningError(y)), (P(x, 1e-7), P(y)))
        )
        for a, b in zip(plain, precise):
            for name in ("value", "lower", "upper", "error", "relative_error"):
                assert np.array_equal(getattr(a, name), getattr(b, name)), name
                assert getattr(a, name).dtype == getattr(b, name).dtype == dtype
            assert a.enclosure == b.enclosure


def P(value: Any, error: Any = 0) -> rb.RunningError:
    return rb.RunningError(value, error, precise=True)


def test_known_errors() -> None:
    third = P(f32(1)) / 3
    assert third.precise_value == 1 / 3
    assert third.precise_value.dtype == np.float64
    assert third.actual_relative_error == abs(1 / 3 - float(f32(1) / f32(3))) * 3
    tenth = P(f32(0)) + 0.1  # a Python number is exact, its float32 is not
    assert tenth.precise_value == 0.1
    assert 0 < tenth.actual_relative_error < 2.0**-24
    assert (P(0) + 0.1).actual_relative_error == 0
    wide = P(1.0) / 3
    assert wide.precise_value.dtype == np.longdouble
    assert Fraction(float(wide.precise_value)) != Fraction(1, 3)
    if np.finfo(np.longdouble).nmant >= 63:
        off = abs(Fraction(*wide.precise_value.as_integer_ratio()) - Fraction(1, 3))
        assert off <= Fraction(1, 2**65)
        assert 2.0**-56 < wide.actual_relative_error <= 2.0**-53
    # What cancels: 1 + 2^-30 - 1 is 0 in float32, and all of it is error.
    lost = (P(f32(1)) + f32(2.0**-30)) - f32(1)
    assert (lost.value, lost.precise_value, lost.actual_relative_error) == (0, 2.0**-30, 1)
    assert (P(f32(1)) - f32(1)).actual_relative_error == 0
    assert (P(f32(2.0**30)) + 1 - f32(2.0**30) - 1).actual_relative_error == INF
    assert np.isnan(rb.sqrt(P(-1.0)).precise_value)
    assert P(2.0, 0.5).precise_value == 2, "it begins as the value, whatever its error"


def test_what_meets_numbers_without_is_without() -> None:
    a, b, c, d = P(f32([1, 2])), P([3.0, 4.0]), rb.RunningError(f32(5)), rb.RunningError(6.0)
    for kept in (a + 1, 1 / a, a * f32(2), a + np.ones(2), a - b, rb.fma(a, b, 3), -b, b[0] ** 3, abs(a)):
        assert kept.precise_value.shape == kept.shape
    for lost in (a + c, c - b, a * d, d / b, rb.fma(a, b, c), rb.fma(c, a, b), rb.fma(a, 1, d), rb.fma(d, a, c)):
        for name in ("precise_value", "actual_relative_error"):
            with pytest.raises(ValueError, match=f"RunningError: {name} needs numbers that are all made with precise"):
                getattr(lost, name)
    assert (a - b).value.dtype == (a * d).value.dtype == np.float64
    assert (a + c).value.dtype == f32
    assert rb.fma(a, b, c).value.tolist() == [8, 13]


def test_precise_numbers_are_values() -> None:
    for a in (P(f32(0.1), 0.25) * 3, P([1.0, 2.0]) / 3):
        again = pickle.loads(pickle.dumps(a))
        assert again == a
        assert np.array_equal(again.precise_value, a.precise_value)
        assert a != rb.RunningError(a.value, a.error)
    assert repr(P(f32([1, 2]))) == "<RunningError array of shape (2,), float32, precise>"
    assert repr(P(2)) == "RunningError(2.0, 0.0, precise=True)"
    assert eval(repr(P(f32(2))), {"RunningError": rb.RunningError, "np": np}) == P(f32(2))
    with pytest.raises(TypeError, match="RunningError: precise must be True or False, got 1"):
        rb.RunningError(1, precise=1)  # type: ignore[arg-type]


# --- The quadratic ---


def true_roots(a: float, b: float, c: float) -> tuple[mpmath.mpf, list[mpmath.mpf]]:
    """The discriminant of exact coefficients, and the roots, the lesser first."""
    x, y, z = (mpmath.mpf(float(v)) for v in (a, b, c))
    discriminant = y * y - 4 * x * z
    root = mpmath.sqrt(max(discriminant, mpmath.mpf(0)))
    return discriminant, sorted([(-y - root) / (2 * x), (-y + root) / (2 * x)])


@pytest.mark.parametrize("precise", [False, True])
@pytest.mark.parametrize("dtype", DTYPES)
def test_roots_are_enclosed(dtype: type, precise: bool) -> None:
    rng = np.random.default_rng(19)
    n = 1500
    value = (rng.normal(size=(3, n)) * 10 ** rng.uniform(-2, 2, (3, n))).astype(dtype)
    cancels = rng.random(n) < 0.3
    value[2, cancels] = (value[1] ** 2 / (4 * value[0]))[cancels]
    error = np.abs(value) * rng.choice([0, 1e-6, 1e-2], n)
    coefficients = [rb.RunningError(v, e, precise=precise) for v, e in zip(value, error)]
    real, *roots = rb.quadratic(*coefficients)
    assert real.dtype == np.uint8
    assert all(root.value.dtype == dtype for root in roots)
    tally: Counter[rb.Verdict] = Counter()
    with mpmath.workprec(400):
        for i in range(n):
            verdict = rb.Verdict(int(real[i]))
            for share in (-1, 0, 1, *rng.uniform(-1, 1, 2)):
                ends = [
                    np.clip(float(x.value[i]) + share * float(x.error[i]), x.lower[i], x.upper[i]) for x in coefficients
                ]
                discriminant, exact = true_roots(*ends)
                assert verdict == rb.Verdict.UNKNOWN or (verdict == rb.Verdict.YES) == (discriminant >= 0)
                for root, t in zip(roots, exact):
                    if discriminant >= 0:
                        assert float(root.lower[i]) <= t <= float(root.upper[i])
            tally[verdict] += 1
            if verdict == rb.Verdict.YES and precise and not error[:, i].any() and discriminant > 1e-9:
                for root, t in zip(roots, exact):
                    assert abs(mp(root.precise_value[i]) - t) <= abs(t) * 1e-3 * 2.0 ** (24 - DIGITS[dtype])
                    tally["compared"] += 1  # type: ignore[index]
            if verdict == rb.Verdict.NO:
                assert roots[0].error[i] == roots[1].error[i] == INF
    assert min(tally[v] for v in rb.Verdict) > 50, tally
    assert not precise or tally["compared"] > 100  # type: ignore[index]


@SETTINGS
@given(st.floats(0.125, 1e3), st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
def test_a_polynomial_with_known_roots(a: float, r: float, s: float) -> None:
    low, high = sorted((r, s))
    x = rb.RunningError(a)
    real, t0, t1 = rb.quadratic(x, -x * (rb.RunningError(r) + s), x * (rb.RunningError(r) * s))
    assert isinstance(real, rb.Verdict)
    assert real != rb.Verdict.NO
    assert low in t0.enclosure
    assert high in t1.enclosure
    if high - low > 1e-3 * max(abs(low), abs(high)) and abs(low) > 1e-100 and abs(high) > 1e-100:
        assert real == rb.Verdict.YES
        assert max(t0.error, t1.error) < 1e-8 * max(abs(low), abs(high))


def test_quadratic_operands() -> None:
    x = rb.RunningError(1.0)
    real, t0, t1 = rb.quadratic(x, [[-3.0], [0.0]], [2.0, 5.0, 0.0])
    assert real.tolist() == [[1, 0, 1], [0, 0, rb.Verdict.YES]]
    assert t0.shape == t1.shape == (2, 3)
    assert (t0.value[0, 0], t1.value[0, 0]) == (1, 2)
    assert rb.quadratic(1, rb.RunningError(f32(0)), -1)[2].value.dtype == f32
    assert rb.quadratic(rb.RunningError(0.0, 0.1), 1, 1)[0] is rb.Verdict.UNKNOWN
    # The seed takes this for a miss: its discriminant is negative, but need not be.
    assert rb.quadratic(1, rb.RunningError(2, 0.125), rb.RunningError(1.03125, 0.03125))[0] is rb.Verdict.UNKNOWN
    with pytest.raises(TypeError, match="quadratic: one of a, b and c must be a RunningError"):
        rb.quadratic(1, 2, 3)
    with pytest.raises(TypeError, match="quadratic: operand must be a number or an array of numbers, got a Interval"):
        rb.quadratic(x, rb.Interval(1, 2), 1)
    with pytest.raises(ValueError, match=re.escape("quadratic: ") + r".*shapes \(\) and \(2,\) and \(3,\)"):
        rb.quadratic(x, [1, 2], [1, 2, 3])
