"""The Python classes of numbers that carry their error: how they are made, combined, indexed, compared and refused."""

from __future__ import annotations

import copy
import operator
import pickle
from typing import Any

import numpy as np
import pytest

import raybound as rb

NAN, INF = float("nan"), float("inf")
ONE = (1.5, -0.25)
X, Y = rb.TaylorModel.variables(ONE, (0.25, 0.125))
U, V = rb.LinearInterval.variables(ONE, (0.25, 0.125))
CELLS = rb.LinearInterval.variables([[1.5], [3], [5]], 0.25, rule="hansen")[0]
SAMPLES: list[Any] = [
    rb.Interval(1, 2),
    rb.Interval(np.float32([1, 2]), np.float32([3, 4])),
    rb.Interval([[1.0], [2.0]], [3.0, 4.0]),
    X * Y,
    rb.exp(X * np.array([0.5, 1.5, 2.5])),
    rb.RunningError(1.5, 0.25),
    rb.RunningError(np.float32([1, 2]), np.float32(0.1)),
    rb.RunningError([[1.0], [2.0]], [0.5, 0]),
    rb.sqrt(rb.RunningError([-1, 0, 1])),
    U * V,
    rb.exp(U * np.array([0.5, 1.5, 2.5])),
    CELLS,
]
each_sample = pytest.mark.parametrize("number", SAMPLES, ids=repr)

# --- Intervals ---


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((2, 1), "Interval: lo must be <= hi, got 2 > 1"),
        (([0, 2], [1, 1]), "Interval: lo must be <= hi, got 2 > 1 at index 1"),
        ((NAN,), "Interval: lo must be a number, got nan"),
        ((0, NAN), "Interval: hi must be a number, got nan"),
        ((INF, INF), "Interval: lo must be <= hi"),
        (([0, 1], [1, 2, 3]), r"Interval: lo and hi must broadcast, got shapes \(2,\) and \(3,\)"),
    ],
)
def test_intervals_refuse(arguments: tuple[Any, ...], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        rb.Interval(*arguments)


def test_intervals_refuse_other_types() -> None:
    for wrong in ("1", None, [1, "a"], {}):
        with pytest.raises(TypeError, match="Interval: lo must be a number"):
            rb.Interval(wrong)


def test_precision_of_intervals() -> None:
    narrow, wide = rb.Interval(np.float32(0.1)), rb.Interval(0.1)
    assert narrow.inf.dtype == np.float32
    assert wide.inf.dtype == np.float64
    assert (narrow + 1).inf.dtype == (2 / narrow).inf.dtype == np.float32
    assert (narrow * np.float32([1, 2])).inf.dtype == np.float32
    assert (narrow + wide).inf.dtype == (narrow * np.array([1.0])).inf.dtype == np.float64
    assert rb.Interval(np.float32(1), 2).inf.dtype == np.float32
    assert rb.Interval(np.float32(1), 2.1).inf.dtype == np.float64, "2.1 is no float32 number"
    tenth = narrow * 0 + 0.1  # a Python number that is no float32: the interval that holds it
    assert float(tenth.inf) < 0.1 < float(tenth.sup)
    assert 0.1 in tenth
    assert tenth.sup == np.nextafter(tenth.inf, np.float32(1))


def test_parts_of_intervals() -> None:
    a = rb.Interval([-1, 2], [3, 5])
    assert a.mid.tolist() == [1, 3.5]
    assert a.rad.tolist() == [2, 1.5]
    assert a.wid.tolist() == [4, 3]
    assert a.mag.tolist() == [3, 5]
    assert a.mig.tolist() == [0, 2]
    assert not a.is_empty.any()
    assert isinstance(float(a[0].inf), float)


def test_sets() -> None:
    a, b, empty, entire = rb.Interval(0, 2), rb.Interval(1, 3), rb.Interval.empty, rb.Interval.entire
    assert (a & b, a | b) == (rb.Interval(1, 2), rb.Interval(0, 3))
    assert (a & rb.Interval(5, 6)) == empty
    assert (a | empty, a & entire) == (a, a)
    assert 1 in a
    assert 2.5 not in a
    assert rb.Interval(1, 2) in a
    assert b not in a
    assert empty in a
    assert a in entire
    assert INF not in entire, "the ends are no members"
    assert a.contains([0, 1, 2, 3]).tolist() == [True, True, True, False]
    assert empty.is_empty
    assert np.isnan([empty.mid, empty.rad, empty.wid, empty.mag, empty.mig]).all()
    assert rb.sqrt(rb.Interval(-2, -1)) == empty
    assert rb.sqrt(rb.Interval(-1, 4)) == rb.Interval(0, 2)
    assert rb.log(rb.Interval(0, 1)) == rb.Interval(-INF, 0)
    assert 1 / rb.Interval(0, 1) == rb.Interval(1, INF)
    with pytest.raises(TypeError):
        a & 1


# --- What both have in common ---


@pytest.mark.parametrize("apply", [operator.add, operator.sub, operator.mul, operator.truediv])
@each_sample
def test_operators_on_either_side(number: Any, apply: Any) -> None:
    for other in (2, 0.5, np.float32(0.5), np.float64(4), np.full(number.shape, 2.0), np.full((2, *number.shape), 2.0)):
        left, right = apply(number, other), apply(other, number)
        shape = np.broadcast_shapes(number.shape, np.shape(other))
        assert type(left) is type(right) is type(number)
        assert left.shape == right.shape == shape
    with pytest.raises(TypeError):
        apply(number, "2")
    with pytest.raises(TypeError):
        apply(None, number)
    with pytest.raises(ValueError, match="must be finite, got nan"):
        apply(number, NAN)


@each_sample
def test_functions_keep_type_and_shape(number: Any) -> None:
    for function in (rb.square, rb.sqrt, rb.rsqrt, rb.reciprocal, rb.exp, rb.log, rb.sin, rb.cos, rb.tan, rb.atan, abs):
        result = function(number)
        assert type(result) is type(number)
        assert result.shape == number.shape
    assert rb.power(number, 2).shape == (number**3).shape == (-number).shape == (+number).shape == number.shape
    assert rb.fma(number, 2, number).shape == rb.minimum(number, 1).shape == rb.maximum(0, number).shape == number.shape
    assert rb.ward_lobe(number, 0.5).shape == number.shape
    with pytest.raises(TypeError):
        number**0.5
    with pytest.raises(ValueError, match="ward_lobe: sigma must be"):
        rb.ward_lobe(number, 0)
    with pytest.raises(ValueError, match="power: n must be"):
        rb.power(number, 2**21)


@each_sample
def test_indexing(number: Any) -> None:
    if not number.shape:
        for use in (len, iter, lambda n: n[0]):
            with pytest.raises(TypeError, match=f"a single {type(number).__name__}"):
                list(use(number))
        return
    assert len(number) == number.shape[0]
    assert [part.shape for part in number] == [number.shape[1:]] * len(number)
    assert number[-1] == list(number)[-1]
    assert number[...] == number
    assert number[:1].shape == (1, *number.shape[1:])
    assert number[np.newaxis].shape == (1, *number.shape)
    assert number[np.ones(len(number), bool)] == number
    if len(number) > 1 and number is not CELLS:  # its elements are functions over different cells
        assert (number[:1] - number[1:2]).shape == (1, *number.shape[1:])
    with pytest.raises(IndexError):
        number[len(number)]


@each_sample
def test_copies_are_equal(number: Any) -> None:
    for other in (pickle.loads(pickle.dumps(number)), copy.copy(number), copy.deepcopy(number)):
        assert other == number
        assert hash(other) == hash(number)
    assert number != number + 1
    assert number != 1
    assert type(number).__name__ in repr(number)


@each_sample
def test_numbers_cannot_be_changed(number: Any) -> None:
    with pytest.raises((AttributeError, TypeError)):
        number._records = None
    for one in (number, pickle.loads(pickle.dumps(number)), number[[0]] if number.shape else number):
        parts = (one._records, *getattr(one, "_cell", ()))
        for part in parts:
            with pytest.raises(ValueError, match="read-only"):
                part[...] = 0


def test_equal_numbers_have_equal_hashes() -> None:
    for make in (rb.Interval, rb.RunningError, lambda x: rb.RunningError(np.float32(x)), lambda x: U * x):
        plus, minus = make(0.0), make(-0.0)
        assert plus == minus
        assert hash(plus) == hash(minus)


@pytest.mark.parametrize("inexact", [2**53 + 1, -(10**30), np.uint64(2**64 - 1), [0, 2**53 + 1]], ids=repr)
def test_what_rounding_would_lose_is_refused(inexact: Any) -> None:
    """float64 does not hold these: an enclosure of what it makes of them would not hold them either."""
    uses = [rb.Interval, rb.RunningError, lambda x: rb.RunningError(0, np.abs(x)), rb.Interval.entire.contains]
    uses += [lambda x, number=number: number + x for number in (rb.Interval(1), rb.RunningError(1), X, U)]
    for use in uses:
        with pytest.raises(ValueError, match=r"must be a float64 exactly, got -?\d{16,}"):
            use(inexact)
    assert 2**60 in rb.Interval(2**60)
    assert rb.RunningError([2**200, 1]).value.tolist() == [2.0**200, 1]


def test_repr_is_an_expression() -> None:
    for i in (rb.Interval(0.1, INF), rb.Interval.empty, rb.Interval(np.float32(0.1), np.float32(3))):
        assert eval(repr(i), {"Interval": rb.Interval, "np": np, "inf": INF}) == i


# --- Taylor models ---


def test_variables() -> None:
    assert X.constant == 1.5
    assert X.linear == pytest.approx([0.25, 0], rel=1e-9)
    assert not X.quadratic.any()
    assert X.remainder == 0
    assert (X.centers.tolist(), X.arithmetic) == (list(ONE), "real")
    assert (X.radii >= [0.25, 0.125]).all()
    many = rb.TaylorModel.variables(np.zeros((3, 4)), 0.5, arithmetic="float32")
    assert [v.shape for v in many] == [(3,)] * 4
    assert many[0].arithmetic == "float32"


@pytest.mark.parametrize(
    ("centers", "radii", "message"),
    [
        ((0, 0, 0), 1, r"TaylorModel: centers must have shape \(..., 2\) or \(..., 4\), got \(3,\)"),
        (0, 1, r"centers must have shape"),
        ((0, 0), -1, "TaylorModel: radii must be >= 0, got -1"),
        ((0, NAN), 1, "TaylorModel: centers must be finite, got nan"),
        ((0, 0), INF, "TaylorModel: radii must be finite, got inf"),
        ((0, 0), (1, 1, 1), "TaylorModel: centers and radii must broadcast"),
    ],
)
def test_variables_refuse(centers: Any, radii: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        rb.TaylorModel.variables(centers, radii)


def test_models_are_made_by_operations_only() -> None:
    with pytest.raises(TypeError, match="TaylorModel cannot be made directly"):
        rb.TaylorModel(1)
    with pytest.raises(ValueError, match="TaylorModel: arithmetic must be"):
        rb.TaylorModel.variables(ONE, 1, arithmetic="float16")


def test_models_of_different_cells_do_not_mix() -> None:
    other = rb.TaylorModel.variables(ONE, (0.25, 0.25))[0]
    with pytest.raises(ValueError, match="multiply: both operands must be functions over the same cell"):
        X * other
    executed = rb.TaylorModel.variables(ONE, (0.25, 0.125), arithmetic="float32")[0]
    with pytest.raises(TypeError, match="add: operands must be of one kind"):
        X + executed
    assert (X + rb.TaylorModel.variables(ONE, (0.25, 0.125))[1]).shape == ()


def function(x: Any, y: Any) -> Any:
    return rb.exp(x * y) / (x + 2) - rb.sqrt(x)


def grid(centers: Any, radii: Any, n: int = 5) -> np.ndarray:
    axes = [np.linspace(c - r, c + r, n) for c, r in zip(centers, radii)]
    return np.stack(np.meshgrid(*axes), -1)


def test_values_on_a_grid() -> None:
    model, points = function(X, Y), grid(ONE, (0.25, 0.125))
    values, exact = model(points), function(points[..., 0], points[..., 1])
    assert values.shape == (5, 5)
    assert values.contains(exact).all()
    assert values.wid.max() <= 2.1 * model.remainder
    assert values in model.range()
    assert 0 < model.interpolation_bound() < 0.05
    with pytest.raises(ValueError, match="TaylorModel: x must lie in the cell"):
        model([1.8, -0.25])
    with pytest.raises(ValueError, match=r"TaylorModel: x must have shape \(..., 2\), got \(3,\)"):
        model([1.5, 0, 0])


def test_restriction() -> None:
    model = function(X, Y)
    part = model.restrict((1.4, -0.2), (0.125, 0.0625))
    points = grid((1.4, -0.2), (0.125, 0.0625))
    assert part(points).contains(function(points[..., 0], points[..., 1])).all()
    assert part.range() in model.range()
    assert part.remainder < model.remainder * (1 + 1e-9) + 1e-14
    assert model.restrict(ONE, (0.25, 0.125))(ONE).contains(function(*ONE))
    for centers, radii in (((1.8, -0.25), (0.1, 0.1)), (ONE, (0.3, 0.1))):
        with pytest.raises(ValueError, match="TaylorModel: centers and radii must be a part of the cell"):
            model.restrict(centers, radii)


def test_substitution() -> None:
    """y = (x0 + 0.1 u, y0 + 0.05 u - 0.05 v), u and v in [-1, 1]."""
    model = function(X, Y)
    slopes = np.array([[0.1, 0], [0.05, -0.05]])
    moved = model.substitute(ONE, slopes, (0, 0), (1, 1))
    u = grid((0, 0), (1, 1))
    points = np.array(ONE) + u @ slopes.T
    assert moved(u).contains(function(points[..., 0], points[..., 1])).all()
    assert moved(u).wid.max() <= 2.1 * model.remainder
    four = model.substitute(ONE, np.hstack([slopes, np.zeros((2, 2))]), np.zeros(4), np.ones(4))
    assert four.linear.shape == (4,)
    with pytest.raises(ValueError, match="the image of the new cell must lie in the cell"):
        model.substitute(ONE, 10 * slopes, (0, 0), (1, 1))
    with pytest.raises(ValueError, match=r"constants must have shape \(2,\) and slopes \(2, 2\)"):
        model.substitute(ONE, slopes[:1], (0, 0), (1, 1))


def test_what_is_not_known_stays_so() -> None:
    unknown = rb.sqrt(X - 2)
    assert unknown.remainder == INF
    assert (unknown * 0 + 1).range() == rb.Interval.entire
    assert unknown(ONE) == rb.Interval.entire
    assert unknown.interpolation_bound() == INF


def test_floats_refuse_what_is_not_defined() -> None:
    for call in (lambda: rb.sqrt(-1), lambda: rb.log(-2.0), lambda: rb.asin([0, 2]), lambda: rb.acos(np.float32(1.5))):
        with pytest.raises(ValueError, match="not defined for x ="):
            call()
    assert rb.exp(np.float32([0, 1])).dtype == np.float32
    assert rb.exp(1) == pytest.approx(np.e)
    with pytest.raises(ValueError, match="must broadcast"):
        rb.fma([1, 2], [1, 2, 3], 0)
