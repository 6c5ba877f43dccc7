"""Taylor models where a bound once did not hold, or hangs on a constant of cpp/derivations.md, D30 to D33."""

from __future__ import annotations

import flint
import numpy as np
import pytest

import raybound as rb

U = 2.0**-24  # float32's unit roundoff


def model(center: float, radius: float, arithmetic: str = "real") -> rb.TaylorModel:
    return rb.TaylorModel.variables([center, 0.0], [radius, 0.0], arithmetic=arithmetic)[0]


def test_plain_numbers_are_rounded_by_a_float32_execution() -> None:
    rng = np.random.default_rng(5)
    numbers, cases, widest = rng.uniform(1, 2, 2000), 0, 0.0
    for c, v in zip(numbers, rng.uniform(1, 2, 2000).astype(np.float32), strict=True):
        bound, executed = model(float(v), 0.0, "float32") * float(c), float(v * np.float32(c))
        assert float(executed) in bound.range()
        cases += abs(executed - float(v) * c) > U * executed  # more than the product's own rounding
        widest = max(widest, bound.remainder / (executed * U))
    assert cases > 100
    assert widest < 2.1
    assert (model(1.0, 0.0, "float32") + 0.5).remainder <= 1.5 * U * 1.001  # a float is exact
    assert (model(1.0, 0.0) * 0.1).remainder < 1e-16
    assert (model(1.0, 0.0, "float32") * 1e39).remainder == np.inf


def test_cells_leave_their_arguments_alone() -> None:
    centers, radii = np.zeros(2), np.ones(2)
    (x, _), (line, _) = rb.TaylorModel.variables(centers, radii), rb.LinearInterval.variables(centers, radii)
    centers[0], radii[0] = 5.0, 7.0
    assert x.centers[0] == line.centers[0] == 0
    assert x.radii[0] == pytest.approx(1)


@pytest.mark.parametrize("n", [3, 50, 2**20, -(2**20)])
def test_powers_with_a_remainder_larger_than_the_linear_part(n: int) -> None:
    """The rounding of a high power's derivative grows with n: it counts for the argument's remainder, too (D31)."""
    rng = np.random.default_rng(abs(n))
    for _ in range(200):
        c, r = rng.uniform(1, 1 + 40 / abs(n)), rng.uniform(0, 1e-3 / abs(n))
        bound = rb.power(model(c, 0.0) + rb.Interval(-r, r), n).range()
        for x in (c - r, c + r):
            truth = flint.arb(x) ** n
            assert flint.arb(bound.inf) <= truth * (1 + flint.arb(2) ** -50)
            assert flint.arb(bound.sup) >= truth * (1 - flint.arb(2) ** -50)
        assert bound.wid <= 2.2 * abs(n) * r * float(truth) * (1 + 40 / abs(n)) + 1e-9 * float(truth)


def test_values_next_to_overflow() -> None:
    top = np.finfo(float).max
    for share in (0.25, 0.5, 0.7, 0.85):
        x = model(top * (1 - share) * 0.5, top * share)
        ends = [x.constant - top * share, x.constant + top * share]
        for f, values in ((x, ends), (rb.abs(x), np.abs(ends))):
            assert all(value in f.range() for value in values)
        assert all(end in x([end, 0.0]) for end in ends)
        assert x.range().inf >= ends[0] - 1e-9 * top
        assert x.range().sup <= ends[1] + 1e-9 * top
