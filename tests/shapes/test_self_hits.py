"""Spawned rays do not meet the surface that they leave, and meet what they should."""

import numpy as np
import pytest
from tests.support.support_hits import explained
from tests.support.support_oracle import build, first_change
from tests.support.support_shapes import CONVEX_KINDS, EXTREMES, KINDS, SOLID_KINDS, aimed_rays, f32, make, unit
from tests.support.support_spawn import as_ulps, hemisphere, shape_or_none, spawn, wild_shape

import raybound as rb

# Shapes of each kind; 40 rays at each, 25 spawned from each hit: 1.2e6 and 1e7 candidates.
POPULATIONS = [1200, pytest.param(10000, marks=pytest.mark.soak)]


@pytest.mark.parametrize("shapes", POPULATIONS)
@pytest.mark.parametrize("kind", CONVEX_KINDS)
def test_convex_shapes_never_hit_themselves(kind: str, shapes: int) -> None:
    rng = np.random.default_rng(KINDS.index(kind))
    tested, violations = 0, []
    for _ in range(shapes):
        shape = wild_shape(rng, kind)
        if shape is None:
            continue
        spawned = spawn(rng, shape, 40, 25)
        tested += len(spawned.hits)
        for i in np.flatnonzero(spawned.outside()["hit"])[:1]:
            violations.append((shape, spawned.hits["next_origin"][i], spawned.directions[i]))
    assert not violations, f"{len(violations)} shapes, first {violations[0]}"
    assert tested >= 120 * shapes  # seen: 159 (polygon+affine) to 668 (box) for each shape


@pytest.mark.parametrize("shapes", [600, pytest.param(10000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", EXTREMES)
def test_needles_and_plates_never_hit_themselves(kind: str, shapes: int) -> None:
    rng = np.random.default_rng(list(EXTREMES).index(kind))
    tested, violations = 0, []
    for _ in range(shapes):
        size = 10 ** rng.uniform(-4, 4)
        shape = shape_or_none(kind, rng, size, size * rng.normal(size=3) * 10 ** rng.uniform(-3, 3))
        if shape is None:
            continue
        spawned = spawn(rng, shape, 60, 25)
        tested += len(spawned.hits)
        violations += [
            (shape, spawned.hits[i], spawned.directions[i]) for i in np.flatnonzero(spawned.outside()["hit"])[:1]
        ]
    assert not violations, f"{len(violations)} shapes, first {violations[0]}"
    assert tested >= 15 * shapes  # seen: 20 (sliver) to 1100 (nearly_cylinder) for each shape


@pytest.mark.parametrize("shapes", [60, pytest.param(4000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", SOLID_KINDS)
def test_rays_into_a_solid_find_its_far_side(kind: str, shapes: int) -> None:
    """From the inner origin the next hit is the one of the exact solid, not the surface that was just left."""
    rng = np.random.default_rng(SOLID_KINDS.index(kind) + 50)
    inside = wrong = 0
    for _ in range(shapes):
        shape = wild_shape(rng, kind)
        if shape is None:
            continue
        model, spawned = build(shape), spawn(rng, shape, 10, 2)
        origins = spawned.inner_origins()
        for o, w, hit in zip(origins, -spawned.directions, spawned.inside()):
            found = first_change(model, o, w)
            inside += found is not None and found.inside
            close = found is not None and abs(float(found.t) - hit["t"]) <= 1.001 * hit["t_error"]
            if hit["hit"] and not close and not explained(model, o, w, lambda f, t=hit["t"]: same_place(f, t)):
                wrong += 1
    assert wrong == 0
    assert inside >= 2 * shapes  # seen: 2.8 (sphere) to 9.7 (box) for each shape


def same_place(found: object, t: float) -> bool:
    return found is not None and abs(float(found.t) - t) <= 1e-3 * t  # type: ignore[attr-defined]


@pytest.mark.parametrize("shapes", [100, pytest.param(10000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", KINDS)
def test_offsets_are_small_enough_to_come_back(kind: str, shapes: int) -> None:
    """Distance/size <= 100, angle > 1 degree: from the far side the surface is hit again, 99 % of the time."""
    rng = np.random.default_rng(KINDS.index(kind) + 25)
    back = total = 0
    offsets = []
    for _ in range(shapes):
        size = 10 ** rng.uniform(-4, 4)
        shape = make(kind, rng, size, size * unit(rng) * 10 ** rng.uniform(-2, 2))
        origins, directions = aimed_rays(rng, shape, 60, 10 ** rng.uniform(0.2, 2))
        hits = rb.intersect(shape, origins, directions)
        steep = np.abs(np.sum(directions * hits["normal"], axis=1)) > np.sin(np.radians(1)) * np.linalg.norm(
            directions, axis=1
        )
        hits, ways = hits[hits["hit"] & steep], directions[hits["hit"] & steep]
        far = rb.spawn_origin(hits["point"], hits["point_error"], hits["normal"], ways)
        again = rb.intersect(shape, far, -ways)["hit"]
        back, total = back + again.sum(), total + len(again)
        reach = np.maximum(np.abs(hits["point"]).max(axis=1), np.abs(shape.bounds).max())
        offsets.append(as_ulps(np.abs(far - hits["point"]).max(axis=1), reach))
    moved = np.concatenate(offsets)
    assert total >= 15 * shapes
    assert back >= 0.99 * total  # seen: all of them
    assert np.median(moved) <= 8  # seen: 0.5 (box), 1 (all others)
    assert moved.max() <= 16  # seen: 3 (polygon)


def test_next_origin_is_what_spawn_origin_gives() -> None:
    rng = np.random.default_rng(4)
    for kind in KINDS:
        shape = make(kind, rng, 3.0, rng.normal(size=3))
        hits = rb.intersect(shape, *aimed_rays(rng, shape, 200, 5))
        hits = hits[hits["hit"]]
        ways = hemisphere(rng, hits["normal"])
        ways = np.where(np.sum(ways * hits["normal"], axis=1, keepdims=True) > 0, ways, f32(hits["normal"]))
        given = rb.spawn_origin(hits["point"], hits["point_error"], hits["normal"], ways)
        assert np.array_equal(given, f32(hits["next_origin"]))
        assert len(hits) > 30


def test_epsilon_offsets_do_fail() -> None:
    """What the bounds are measured against: a fixed epsilon meets the surface again, so the test above can see it."""
    rng = np.random.default_rng(9)
    center = np.array([1e5, 1e5, 1e5])
    again = 0
    for offsets in ("epsilon", "scaled-epsilon", "whole-epsilon"):
        sphere = rb.Sphere(center, 100)
        hits = rb.intersect(sphere, *aimed_rays(rng, sphere, 5000, 50), offsets=offsets)
        hits = hits[hits["hit"]]
        ways = hemisphere(rng, hits["normal"])
        again += rb.intersect(sphere, f32(hits["next_origin"]), ways)["hit"].sum()
    assert again >= 100
