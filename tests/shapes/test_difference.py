"""What is left of a solid without others. (Membership along rays: test_csg.py.)"""

import pickle
from itertools import pairwise

import numpy as np
import pytest
from tests.support.support_csg import thick_expressions
from tests.support.support_shapes import aimed_rays, unit

import raybound as rb

BOX, BALL = rb.Box(), rb.Sphere((0, 0, 0), 1.2)


def test_closed_forms() -> None:
    cut = BOX - BALL  # eight corners
    assert isinstance(cut, rb.Difference)
    assert cut == rb.Difference(BOX, BALL)
    assert cut.shapes == (BOX, BALL)
    assert np.allclose(cut.bounds, [(-1, -1, -1), (1, 1, 1)])
    hits = rb.intersect(cut, [(0.9, 0.9, -5), (0, 0, -5), (0.9, 0.9, 0.0), (0, -5, 0)], [(0, 0, 1)] * 3 + [(0, 1, 0)])
    assert hits["hit"].tolist() == [True, False, True, False]
    assert hits["face_id"].tolist() == [4, -1, 5, -1]
    bowl = rb.Sphere() - rb.Sphere((0, 0, 0.5))
    into = rb.intersect(bowl, (0, 0, 5), (0, 0, -1))
    assert abs(into["t"] - 5.5) < 1e-6
    assert into["face_id"] == 1
    assert np.allclose(into["normal"], (0, 0, 1))  # out of what is left, into the ball that is gone
    assert rb.Difference(BOX) == rb.Difference(BOX)
    assert rb.intersect(rb.Difference(BOX), (0, 0, 5), (0, 0, -1))["t"] == 4


def test_coincident_faces_leave_no_skin() -> None:
    half = BOX - rb.Box((-1, -1, 0), (1, 1, 1))
    origins, directions = aimed_rays(np.random.default_rng(1), BOX, 3000, 4, 1.2)
    ours = rb.intersect(half, origins, directions)
    plain = rb.intersect(rb.Box((-1, -1, -1), (1, 1, 0)), origins, directions)
    assert (ours["hit"] != plain["hit"]).sum() <= 1
    both = ours["hit"] & plain["hit"]
    assert both.sum() > 500
    assert np.allclose(ours["t"][both], plain["t"][both], rtol=1e-6)


def test_taking_away_what_is_taken_away_gives_it_back() -> None:
    """a - (a - b) is a & b, and a - (b - c) is (a - b) | (a & b & c)."""
    rng = np.random.default_rng(2)
    a, b, c = rb.Box(), rb.Sphere((0.5, 0.2, 0.1)), rb.Cylinder((0, 0, -2), (0.3, 0.2, 2), radius=0.6)
    points = rng.uniform(-1.5, 1.5, (20000, 3))
    assert ((a - (a - b)).contains(points) == (a & b).contains(points)).all()
    left, right = a - (b - c), (a - b) | (a & b & c)
    assert (left.contains(points) == right.contains(points)).all()
    origins, directions = aimed_rays(rng, a, 4000, 3, 1.1)
    x, y = rb.intersect(left, origins, directions), rb.intersect(right, origins, directions)
    assert (x["hit"] == y["hit"]).mean() > 0.999
    both = x["hit"] & y["hit"]
    assert np.allclose(x["t"][both], y["t"][both], atol=1e-5)
    assert np.allclose(x["normal"][both], y["normal"][both], atol=1e-4)


def test_normals_point_out_of_what_is_left() -> None:
    rng = np.random.default_rng(3)
    seen = 0
    for shape in thick_expressions(rng, 60):
        extent = float(np.ptp(shape.bounds, axis=0).max())
        hits = rb.intersect(shape, *aimed_rays(rng, shape, 60, 3, 1.0))
        hits = hits[hits["hit"]]
        step = 1e-4 * extent * hits["normal"].astype(float)
        outside, inside = shape.contains(hits["point"] + step), shape.contains(hits["point"] - step)
        assert (inside & ~outside).mean() > 0.9 if len(hits) else True  # but at edges and thin walls
        assert (outside & ~inside).sum() == 0
        seen += len(hits)
    assert seen > 800


def test_values() -> None:
    cut = BOX - BALL - rb.Cylinder()
    assert pickle.loads(pickle.dumps(cut)) == cut
    assert eval(repr(cut), {name: getattr(rb, name) for name in ("Box", "Sphere", "Cylinder", "Difference")}) == cut
    assert hash(cut) == hash(BOX - BALL - rb.Cylinder())
    assert cut != BOX - rb.Cylinder() - BALL
    assert cut.replace(shapes=(BOX, BALL)) == BOX - BALL
    scene = rb.Scene()
    scene.add(cut, rb.Material())
    assert rb.Scene.from_dict(scene.to_dict()) == scene


def test_faces_and_uv_are_those_of_the_parts() -> None:
    cut = BOX - rb.Sphere((0, 0, 1), 0.5)
    hit = rb.intersect(cut, (0.1, 0.2, 5), (0, 0, -1))
    alone = rb.intersect(rb.Sphere((0, 0, 1), 0.5), (0.1, 0.2, -5), (0, 0, 1))
    assert hit["face_id"] == 6
    assert np.allclose(hit["uv"], alone["uv"], atol=1e-6)
    assert np.allclose(hit["normal"], -alone["normal"], atol=1e-6)


@pytest.mark.parametrize("away", [BOX, rb.Box((-2, -2, -2), (2, 2, 2)), rb.Sphere((0, 0, 0), 2)])
def test_differences_that_enclose_nothing(away: rb.Shape) -> None:
    with pytest.raises(ValueError, match=r"Difference: .*encloses nothing"):
        BOX - away
    with pytest.raises(ValueError, match=r"Difference: .*1.*encloses nothing|Difference: .*2.*encloses nothing"):
        rb.Difference(BOX, rb.Sphere((5, 0, 0)), away)
    assert (away - rb.Sphere((0.9, 0.9, 0.9), 0.5)).contains((-0.5, -0.5, -0.5))


def test_rays_alternate_through_differences() -> None:
    rng = np.random.default_rng(5)
    crossings = 0
    for shape in thick_expressions(rng, 40):
        scene = rb.Scene()
        scene.add(shape, rb.Material())
        middle, extent = np.mean(shape.bounds, axis=0), float(np.ptp(shape.bounds, axis=0).max())
        ways = unit(rng, 100)
        records, offsets = scene.intersect_all(middle - 3 * extent * ways + rng.normal(size=3) * extent * 0.2, ways)
        for begin, end in pairwise(offsets):
            assert records["entering"][begin:end].tolist() == [True, False] * ((end - begin) // 2)
        crossings += len(records)
    assert crossings > 3000
