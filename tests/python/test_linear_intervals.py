"""LinearInterval from Python: how it is made, what it mixes with, and how it flags what is unknown.

What they share with the other numbers is in test_numbers_api.py.
"""

from __future__ import annotations

import operator
import re
from typing import Any

import numpy as np
import pytest

import raybound as rb

NAN, INF = float("nan"), float("inf")
CENTER, RADII = (1.5, -0.25), (0.25, 0.125)
X, Y = rb.LinearInterval.variables(CENTER, RADII)
OPERATORS = [operator.add, operator.sub, operator.mul, operator.truediv]


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (((0, NAN), 1), ValueError, "centers must be finite, got nan at index 1"),
        ((([0], INF)), ValueError, "radii must be finite, got inf"),
        (((0, 0), (1, -2)), ValueError, "radii must be >= 0, got -2.0 at index 1"),
        (((0, 0), (1, 1, 1)), ValueError, "centers and radii must broadcast, got shapes (2,) and (3,)"),
        (
            (np.zeros(5), 1),
            ValueError,
            "centers must have shape (..., 1) or (..., 2) or (..., 3) or (..., 4), got (5,)",
        ),
        ((0, 1), ValueError, "centers must have shape"),
        ((([], 1)), ValueError, "centers must have shape"),
        ((("a",), 1), TypeError, "centers must be a number or an array of numbers, got ('a',) of type tuple"),
        (((0, 0), None), TypeError, "radii must be a number or an array of numbers, got None of type NoneType"),
    ],
)
def test_linear_variables_refuse(arguments: tuple[Any, ...], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=re.escape(f"LinearInterval: {message}")):
        rb.LinearInterval.variables(*arguments)


def test_rules() -> None:
    hansen, second = (rb.LinearInterval.variables(CENTER, RADII, rule=rule)[0] for rule in ("hansen", "second-order"))
    assert (hansen.rule, second.rule, X.rule) == ("hansen", "second-order", "second-order")
    assert hansen != second
    assert rb.exp(second).corner_bound() < rb.exp(hansen).corner_bound()
    assert (rb.exp(hansen) + 1).rule == "hansen"
    with pytest.raises(TypeError, match="add: operands must be of one kind, got linear_2_hansen and linear_2_second"):
        hansen + second
    choices = "LinearInterval: rule must be one of 'hansen', 'second-order', got"
    with pytest.raises(ValueError, match=f"{choices} 'first'"):
        rb.LinearInterval.variables(CENTER, RADII, rule="first")
    with pytest.raises(TypeError, match=f"{choices} 1 of type int"):
        rb.LinearInterval.variables(CENTER, RADII, rule=1)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="LinearInterval cannot be made directly"):
        rb.LinearInterval(1)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_parts_of_linear_intervals(n: int) -> None:
    center, radii = np.arange(1.0, n + 1), np.full(n, 0.25)
    given = radii.copy()
    variables = rb.LinearInterval.variables(center, given)
    center[:], given[:] = -9, 9  # the caller's arrays stay the caller's
    assert len(variables) == n
    for i, x in enumerate(variables):
        assert x.constant == rb.Interval(i + 1)
        assert x.slopes.shape == (n,)
        assert x.slopes.mid == pytest.approx([0.25 * (i == j) for j in range(n)], rel=1e-9)
        assert rb.Interval(i + 0.75, i + 1.25) in x.range()
        assert x.range().wid == pytest.approx(0.5, rel=1e-9)
        assert x.centers.tolist() == list(range(1, n + 1))
        assert (x.radii >= radii).all()
        assert x.radii == pytest.approx(radii, rel=1e-9)
        assert 0 <= x.interpolation_bound() < 1e-12
        assert 0 <= x.corner_bound() < 1e-12
    curved = rb.exp(variables[0])
    assert 0 < curved.corner_bound() < 0.5
    assert 0 < curved.interpolation_bound() < 0.5
    assert rb.Interval(np.exp(0.75), np.exp(1.25)) in curved.range() * rb.Interval(1 - 1e-15, 1 + 1e-15)


def test_many_cells_at_once() -> None:
    centers = np.array([[[1.0, 2.0]], [[3.0, 4.0]]])  # (2, 1, 2)
    x, y = rb.LinearInterval.variables(centers, 0.5)
    product = x * y
    assert product.shape == product.interpolation_bound().shape == product.corner_bound().shape == (2, 1)
    assert product.slopes.shape == product.centers.shape == product.radii.shape == (2, 1, 2)
    for i in range(2):
        a, b = rb.LinearInterval.variables(centers[i, 0], 0.5)
        assert product[i, 0] == a * b
        assert (product * np.ones(3))[i, 2] == a * b * 1.0
    with pytest.raises(ValueError, match="subtract: both operands must be functions over the same cell"):
        product[0] - product[1]
    empty = rb.LinearInterval.variables(np.zeros((0, 2)), 1)[0]
    assert (rb.exp(empty) + 1).range().shape == (0,)
    with pytest.raises(ValueError, match=r"add: .*\(shapes \(2, 1\) and \(3, 1\)\)"):
        product + np.ones((3, 1))


def test_linear_intervals_of_different_cells_do_not_mix() -> None:
    for centers, radii in ((CENTER, (0.25, 0.25)), ((1.5, -0.375), RADII)):
        other = rb.LinearInterval.variables(centers, radii)[0]
        assert other != X
        for apply in OPERATORS:
            with pytest.raises(ValueError, match="both operands must be functions over the same cell"):
                apply(X, other)
        with pytest.raises(ValueError, match="fma: both operands must be functions over the same cell"):
            rb.fma(X, 2, other)
    with pytest.raises(TypeError, match="got linear_2_second-order and linear_1_second-order"):
        X + rb.LinearInterval.variables((1.5,), 0.25)[0]
    assert X + rb.LinearInterval.variables(CENTER, RADII)[1] == X + Y, "the same cell, made again"


def test_intervals_meet_linear_intervals() -> None:
    a = rb.Interval([1, -3], [2, -2])
    for apply in OPERATORS:
        for left, right in ((X, a), (a, X)):
            result = apply(left, right)
            assert type(result) is rb.LinearInterval
            assert result.shape == (2,)
            exact = apply(*(rb.Interval(1.25, 1.75) if side is X else side for side in (left, right)))
            assert exact in result.range()
    assert (X + rb.Interval(np.float32(1), np.float32(2))).range().sup == pytest.approx(3.75)
    for unbounded in (rb.Interval.empty, rb.Interval.entire, rb.Interval(0, INF)):
        with pytest.raises(ValueError, match="multiply: operand must be bounded and not empty, got Interval"):
            unbounded * X


def test_unknown_linear_intervals_stay_so() -> None:
    straddling = X - 1.5
    unknown = [rb.sqrt(straddling), rb.log(straddling), rb.rsqrt(straddling), 1 / straddling, rb.reciprocal(straddling)]
    unknown += [straddling**-1, rb.asin(X), rb.acos(X), rb.tan(X), rb.exp(X * 1000), rb.sqrt(X - 2), X * 1e300 * 1e300]
    for one in unknown:
        for result in (one, one * 0 + 1, rb.atan(one), one - one, rb.maximum(one, 0)):
            assert result.constant == result.range() == rb.Interval.entire
            assert result.interpolation_bound() == result.corner_bound() == INF
            assert not np.isnan([result.slopes.inf, result.slopes.sup]).any()


# --- Kinds do not mix ---


@pytest.mark.parametrize("apply", OPERATORS)
def test_kinds_do_not_mix(apply: Any) -> None:
    kinds = [rb.RunningError(1), rb.Interval(1, 2), X, rb.TaylorModel.variables(CENTER, RADII)[0]]
    refused = 0
    for a in kinds:
        for b in kinds:
            over_cell = any(isinstance(number, (rb.LinearInterval, rb.TaylorModel)) for number in (a, b))
            has_interval = any(isinstance(number, rb.Interval) for number in (a, b))
            if type(a) is type(b) or (over_cell and has_interval):
                assert apply(a, b) is not None
                continue
            refused += 1
            with pytest.raises(TypeError, match=r"unsupported operand|operands must be of one kind"):
                apply(a, b)
            for function in (rb.minimum, lambda x, y: rb.fma(x, 1, y)):
                with pytest.raises(TypeError, match=r"(minimum|fma): operands? must be "):
                    function(a, b)
    assert refused == 8
    for a in kinds:
        for other in ("2", None, 1j, True, rb.Sphere(), [1, "a"]):
            with pytest.raises(TypeError):
                apply(a, other)
            with pytest.raises(TypeError):
                apply(other, a)
        with pytest.raises(TypeError):
            float(a)
