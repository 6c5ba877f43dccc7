"""CSG against point membership along rays: no inner walls, no missing ones."""

import numpy as np
import pytest
from tests.support.support_csg import check_expression, expression, is_thick
from tests.support.support_hits import Tally
from tests.support.support_oracle import build, exact, first_change, is_member
from tests.support.support_shapes import aimed_rays, f32, unit
from tests.support.support_spawn import spawn

import raybound as rb


@pytest.mark.parametrize("shapes", [160, pytest.param(4000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("distance", [0, 3, 100])
@pytest.mark.parametrize("grid", [False, True])
def test_first_boundary_is_the_first_change_of_membership(grid: bool, distance: float, shapes: int) -> None:
    rng = np.random.default_rng(11 + int(distance) + grid)
    tally = Tally()
    for _ in range(shapes):
        shape = expression(rng, int(rng.integers(1, 4)), grid=grid)
        if is_thick(shape):
            check_expression(tally, shape, *aimed_rays(rng, shape, 40, distance, 1.1))
    assert tally.counts["wrong"] == 0, str(tally)
    assert tally.counts["within rounding"] <= 1e-3 * tally.counts["rays"]  # seen: 1 of 3200
    assert tally.counts["hits"] >= 0.25 * tally.counts["rays"]
    assert tally.counts["from inside"] >= (0.15 * tally.counts["rays"] if distance == 0 else 0)


@pytest.mark.parametrize("shapes", [80, pytest.param(4000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("grid", [False, True])
def test_rays_spawned_from_combinations_meet_the_exact_next_boundary(grid: bool, shapes: int) -> None:
    """No self-hit on curved, concave or joined surfaces: what is met is what the exact solid has next."""
    rng = np.random.default_rng(29 + grid)
    tally = Tally()
    for _ in range(shapes):
        shape = expression(rng, int(rng.integers(1, 4)), grid=grid)
        if not is_thick(shape):
            continue
        spawned = spawn(rng, shape, 12, 2)
        check_expression(tally, shape, f32(spawned.hits["next_origin"]), spawned.directions)
        check_expression(tally, shape, spawned.inner_origins(), -spawned.directions)
    assert tally.counts["wrong"] == 0, str(tally)
    assert tally.counts["within rounding"] <= 1e-2 * tally.counts["rays"]
    assert tally.counts["rays"] >= 15 * shapes
    assert tally.counts["from inside"] >= 0.4 * tally.counts["rays"]


def sampled_change(shape: rb.Shape, o: np.ndarray, d: np.ndarray, reach: float) -> float | None:
    """The first change of membership by fine sampling and bisection: an oracle that knows no roots."""
    model = build(shape, float)
    rays = [leaf.along([np.float64(x) for x in o], [np.float64(x) for x in d]) for leaf in model.leaves]

    def member(t: float) -> bool:
        return is_member(model.member, [all(c + t * (2 * b + a * t) <= 0 for c, b, a in forms) for forms in rays])

    ts = np.linspace(1e-9, reach, 400)
    states = [member(t) for t in ts]
    for i in range(1, len(ts)):
        if states[i] != states[0]:
            low, high = ts[i - 1], ts[i]
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if member(middle) == states[0] else (low, middle)
            return float(high)
    return None


def test_sampling_finds_the_same_boundaries() -> None:
    """Samples can only miss what lies between them: a hit must not be later than the change that they see."""
    rng = np.random.default_rng(3)
    compared = later = 0
    for i in range(60):
        shape = expression(rng, 2, grid=i % 2 == 0)
        if not is_thick(shape):
            continue
        origins, directions = aimed_rays(rng, shape, 12, 2)
        directions = f32(directions / np.linalg.norm(directions, axis=1, keepdims=True))
        reach = 4 * np.linalg.norm(np.ptp(shape.bounds, axis=0))
        for o, d, hit in zip(origins, directions, rb.intersect(shape, origins, directions)):
            t = sampled_change(shape, o, d, float(reach))
            if t is not None:
                compared += 1
                later += not hit["hit"] or hit["t"] > t + 1e-5 * reach
    assert later == 0
    assert compared >= 200  # seen: 331


@pytest.mark.parametrize("operation", [rb.Union, rb.Intersection])
def test_coincident_faces_leave_no_wall(operation: type) -> None:
    """Two boxes that share a face are one: rays from inside see no wall there, however they are turned."""
    rng = np.random.default_rng(8)
    crossed = 0
    for i in range(60):
        turn = rb.Transform.translate(*rng.normal(size=3) * 10 ** rng.uniform(-1, 2)) @ rb.Transform.rotate(
            rng.uniform(0, 360), unit(rng)
        )
        left, right, whole = rb.Box((-1, -1, -1), (0, 1, 1)), rb.Box((0, -1, -1), (1, 1, 1)), rb.Box()
        joint = (
            rb.Union(left, right) if operation is rb.Union else rb.Intersection(whole, rb.Box((-1, -2, -1), (1, 2, 3)))
        )
        if i % 2:
            joint, whole = joint.transformed(turn), whole.transformed(turn)
        origins, directions = aimed_rays(rng, whole, 500, 0 if i % 3 else 4, 1.0)
        ours, plain = rb.intersect(joint, origins, directions), rb.intersect(whole, origins, directions)
        both = ours["hit"] & plain["hit"]
        assert (ours["hit"] != plain["hit"]).sum() <= 1
        assert np.allclose(ours["t"][both], plain["t"][both], rtol=1e-5, atol=1e-5)
        crossed += int(both.sum())
    assert crossed >= 20000


def test_faces_of_parts_count_one_after_the_other() -> None:
    shape = rb.Union(
        rb.Box((-3, -1, -1), (-2, 1, 1)), rb.Cylinder((0, 0, -1), (0, 0, 1), radius=0.5), rb.Sphere((4, 0, 0))
    )
    origins = [(-9, 0, 0), (-1, 0, 0), (0, 0, 9), (0, 0, -9), (9, 0, 0)]
    directions = [(1, 0, 0), (1, 0, 0), (0, 0, -1), (0, 0, 1), (-1, 0, 0)]
    assert rb.intersect(shape, origins, directions)["face_id"].tolist() == [0, 6, 8, 7, 9]


def test_exact_membership_of_the_oracle() -> None:
    """The oracle itself, on a case that one can see: a box with a sphere around one corner."""
    model = build(rb.Box((0, 0, 0), (1, 1, 1)) | rb.Sphere((1, 1, 1), 0.5))
    found = first_change(model, (0.5, 0.5, 0.5), (1, 1, 1))
    assert found is not None
    assert found.inside
    assert found.faces == [6]
    assert abs(float(found.t) - (0.5 + 0.5 / 3**0.5)) < 1e-15
    assert exact((0.1,))[0] != 0.1 + 1e-17
