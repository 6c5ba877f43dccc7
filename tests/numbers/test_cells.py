"""Float and double executions of the shading kernel against Taylor models of whole cells (certified-interpolants.md,
section 9, promise 1)."""

import pytest

from raybound import _core


@pytest.mark.parametrize("cells", [1000, pytest.param(100_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("n", [2, 4])
def test_no_execution_leaves_its_bounds(n: int, cells: int) -> None:
    """Spheres, planes, planes in mirrors; far from the origin, far from the eye, grazing: 130 points of each cell."""
    seen = _core.cell_trials(n=n, cells=cells, points=130, seed=n)
    assert seen["float_outside"] == 0
    assert seen["double_outside"] == 0
    assert seen["bounded"] >= 0.7 * cells  # seen: 0.77
    assert seen["points"] == 130 * seen["bounded"]
    assert seen["far"] >= 0.2 * cells  # more than 1000 sizes from the origin
    assert seen["grazing"] >= 0.08 * cells  # less than 0.1 rad
    assert seen["largest_share"] > 0.9  # of a bound that some result needs: it is not only wide. Seen: 0.997


def test_times_are_measured() -> None:
    plain, taylor = _core.cell_times(n=2, rounds=1)
    assert 0 < plain < taylor
