"""How tight the numbers are: radiance over cells, against the table of certified-interpolants.md, section 2."""

import itertools

import numpy as np
import pytest
from tests.support.support_cells import CASES, Case

import raybound as rb

CORNERS = np.array(list(itertools.product([-1, 1], repeat=4)))


def points_of_cell(n: int) -> np.ndarray:
    rng = np.random.default_rng(1)
    points = rng.uniform(-1, 1, (n, 4))
    on_edges = rng.random(n) < 0.3
    points[on_edges] = np.where(np.abs(points[on_edges]) > 0.3, np.sign(points[on_edges]), points[on_edges])
    return points


def sampled(case: Case, points: np.ndarray) -> np.ndarray:
    return np.asarray(case.kernel(*(np.array(case.center) + case.h * points).T, case.light))


def quadrilinear_error(case: Case, points: np.ndarray) -> float:
    weights = np.prod(1 + CORNERS[np.newaxis] * points[:, np.newaxis], axis=2) / 16
    return float(np.abs(sampled(case, points) - weights @ sampled(case, CORNERS)).max())


def bounds(case: Case) -> dict[str, float]:
    center, radii = np.array(case.center), [case.h] * 4
    constant = case.kernel(*[rb.Interval(x - case.h, x + case.h) for x in center], case.light)
    linear = {
        rule: case.kernel(*rb.LinearInterval.variables(center, radii, rule=rule), case.light)
        for rule in ("hansen", "second-order")
    }
    model = case.kernel(*rb.TaylorModel.variables(center, radii), case.light)
    return {
        "interval": constant.wid,
        "hansen": linear["hansen"].interpolation_bound(),
        "second_order": linear["second-order"].interpolation_bound(),
        "taylor": model.interpolation_bound(),
        "remainder": model.remainder,
    }


@pytest.mark.parametrize("name", CASES)
def test_bounds_are_those_of_the_table_or_tighter(name: str) -> None:
    """Bound over true error, each at most the table's. Seen: 0.5, 0.7, 0.6, 0.7, 0.45 of it beside the highlight; less
    elsewhere but for 0.9 and 0.9 of the last two for the plane in the mirror."""
    case = CASES[name]
    true = quadrilinear_error(case, points_of_cell(20_000))
    assert 0.75 < true / case.true < 1.25
    for bound, value in bounds(case).items():
        assert true * (bound != "remainder") < value
        assert value / true <= getattr(case, bound) / case.true, bound


@pytest.mark.parametrize("name", CASES)
def test_sampled_radiance_lies_within(name: str) -> None:
    case = CASES[name]
    points = points_of_cell(20_000)
    x, radii = np.array(case.center) + case.h * points, [case.h] * 4
    values = sampled(case, points)
    model = case.kernel(*rb.TaylorModel.variables(case.center, radii), case.light)
    slack = 1e-12  # the samples are computed in double
    assert (np.abs(values - model(x).mid) <= model(x).rad + slack).all()
    for rule in ("hansen", "second-order"):
        linear = case.kernel(*rb.LinearInterval.variables(case.center, radii, rule=rule), case.light).range()
        assert linear.inf - slack <= values.min()
        assert values.max() <= linear.sup + slack
    constant = case.kernel(*[rb.Interval(c - case.h, c + case.h) for c in case.center], case.light)
    assert constant.inf - slack <= values.min()
    assert values.max() <= constant.sup + slack


@pytest.mark.parametrize("name", CASES)
def test_halving_a_cell_divides_the_remainder_by_eight(name: str) -> None:
    """The remainder is of third order. Seen: 8.09 to 8.24."""
    case = CASES[name]
    sizes = [
        case.kernel(*rb.TaylorModel.variables(case.center, [h] * 4), case.light).remainder
        for h in (case.h / 4, case.h / 8)
    ]
    assert 7.5 < sizes[0] / sizes[1] < 10
