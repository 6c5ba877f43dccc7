"""Any finite ray against any shape: an answer, never NaN, never infinity where there is a hit."""

import numpy as np
import pytest
from tests.support.support_shapes import EXTREMES, KINDS, Rng, aimed_rays, f32, unit
from tests.support.support_spawn import shape_or_none, wild_shape

import raybound as rb

FIELDS = ("t", "t_error", "point", "point_error", "normal", "uv", "next_origin")
LARGEST = 3.4e38


def any_rays(rng: Rng, shape: rb.Shape, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Far and near, of all lengths, in all octants, with zero, subnormal and huge components."""
    kind = rng.integers(5)
    origins, directions = aimed_rays(rng, shape, n, 10 ** rng.uniform(-8, 8))
    origins, directions = origins.astype(float), directions.astype(float)
    if kind == 1:
        origins = rng.normal(size=(n, 3)) * 10 ** rng.uniform(-38, 38, (n, 1))
        directions = unit(rng, n) * 10 ** rng.uniform(-45, 38, (n, 1))
    elif kind == 2:
        directions = directions * 10 ** rng.uniform(-45, 38, (n, 3))
    elif kind == 3:
        directions = np.where(rng.random((n, 3)) < 0.4, 1e-45 * rng.integers(-5, 5, (n, 3)), directions)
    elif kind == 4:
        low, high = shape.bounds
        corners = np.where(rng.random((n, 3)) < 0.5, low, high)
        origins = np.where(rng.random((n, 3)) < 0.5, corners, (low + high) / 2)
        directions = rng.integers(-1, 2, (n, 3)) * 1.0
    origins, directions = f32(np.clip(origins, -LARGEST, LARGEST)), f32(np.clip(directions, -LARGEST, LARGEST))
    keep = np.linalg.norm(directions.astype(float), axis=1) >= 2.0**-64
    return origins[keep], directions[keep]


def check_answers(shape: rb.Shape, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    answers = rb.intersect(shape, origins, directions)
    hit = answers["hit"]
    for name in FIELDS:
        finite = np.isfinite(answers[name]).reshape(len(hit), -1).all(axis=1)
        for i in np.flatnonzero(hit & ~finite)[:1]:
            pytest.fail(f"{name} is {answers[name][i]} for {shape!r}, {origins[i].tolist()}, {directions[i].tolist()}")
        assert not np.isnan(answers[name]).any()
    found = answers[hit]
    assert (found["t"] > 0).all()
    assert (found["t_error"] >= 0).all()
    assert (found["point_error"] >= 0).all()
    assert np.abs(np.linalg.norm(found["normal"], axis=1) - 1).max(initial=0) < 4e-7  # seen: 1.2e-7
    assert np.isposinf(answers["t"][~hit]).all()
    assert (answers["face_id"][~hit] == -1).all()
    return answers


@pytest.mark.parametrize("shapes", [600, pytest.param(12000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", [*KINDS, *EXTREMES])
def test_every_ray_has_a_clean_answer(kind: str, shapes: int) -> None:
    """100 rays at each of many shapes, sizes and coordinates over sixteen orders of magnitude."""
    rng = np.random.default_rng([*KINDS, *EXTREMES].index(kind))
    rays = hits = 0
    for _ in range(shapes):
        shape = (
            wild_shape(rng, kind) if kind in KINDS else shape_or_none(kind, rng, 10 ** rng.uniform(-8, 8), np.zeros(3))
        )
        if shape is not None:
            answers = check_answers(shape, *any_rays(rng, shape, 100))
            rays, hits = rays + len(answers), hits + answers["hit"].sum()
    assert rays >= 60 * shapes
    assert hits >= 4 * shapes  # seen: 5.3 (sliver) to 40 (box) for each shape


def test_limits_of_size() -> None:
    """The largest and least shapes that are allowed."""
    for size in (2.0**60, 2.0**-60):
        for shape in (rb.Sphere(radius=size), rb.Box((0, 0, 0), (size,) * 3), rb.Cone(apex=(0, 0, size), radius=size)):
            origins = f32(size * np.array([(3, 0.1, 0.2), (0.2, 0.1, 4), (0.1, 0.1, 0.1)]))
            answers = check_answers(shape, origins, f32([(-1, 0, 0), (0, 0, -1), (1, 1, 1)]))
            assert answers["hit"].all()


@pytest.mark.parametrize("ratio", [1e8, 1e12, 1e16, 1e18])
def test_spheres_much_smaller_than_their_coordinates(ratio: float) -> None:
    """All points near such a sphere round to its centre: an answer without NaN, or a miss."""
    for shape in (
        rb.Sphere((1, 2, 3), 1 / ratio),
        rb.Sphere().transformed(rb.Transform.translate(1, 2, 3) @ rb.Transform.scale(1 / ratio)),
    ):
        origins = f32([(1, 2, 3), (0, 2, 3), (1, 2, 9), (0, 0, 0)])
        check_answers(shape, origins, f32([(1, 0, 0), (1, 0, 0), (0, 0, -1), (1, 2, 3)]))


def test_coordinates_of_1e30_are_refused_or_answered() -> None:
    with pytest.raises(ValueError, match=r"Sphere: center .*1.*e\+?30"):
        rb.Sphere((1e30, 0, 0))
    answers = rb.intersect(rb.Sphere(), [(1e30, 0, 0), (-1e30, 1e30, 0)], [(-1, 0, 0), (1, -1, 0)])
    for name in FIELDS:
        assert not np.isnan(answers[name]).any()


def test_nothing_depends_on_the_length_of_a_direction() -> None:
    """Powers of two scale t, and nothing else, as long as no component is subnormal."""
    rng = np.random.default_rng(6)
    for kind in KINDS:
        shape = shape_or_none(kind, rng, 1.0, np.zeros(3))
        assert shape is not None
        origins, directions = aimed_rays(rng, shape, 300, 4)
        first = rb.intersect(shape, origins, directions)
        assert first["hit"].sum() > 50
        for exponent in (-60, -3, 5, 90):
            other = rb.intersect(shape, origins, np.ldexp(directions, exponent))
            for name in ("hit", "point", "point_error", "normal", "uv", "face_id", "next_origin"):
                assert np.array_equal(first[name], other[name]), name
            assert np.array_equal(np.ldexp(first["t"], -exponent), other["t"])
