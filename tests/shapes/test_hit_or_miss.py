"""Rays through the middle of a solid hit it, rays well beside it miss it, from any distance that float32 resolves."""

import numpy as np
import pytest
from tests.support.support_oracle import build, first_change
from tests.support.support_shapes import HOLLOW_KINDS, SOLID_KINDS, Rng, f32, make, unit

import raybound as rb

STAR_KINDS = [kind for kind in SOLID_KINDS if kind not in HOLLOW_KINDS]  # scaled up they hold themselves


def depth_of(shape: rb.Shape, points: np.ndarray, margin: float) -> np.ndarray:
    """Which points have themselves and all eight corners of a cube of half width `margin` inside the shape."""
    leaf = build(shape, np.float64).leaves[0]
    deep = np.full(len(points), True)
    corners = np.stack(np.meshgrid(*[[-1, 1]] * 3), axis=-1).reshape(-1, 3)
    for corner in [*corners, np.zeros(3)]:
        columns = list((points + margin * corner).T)
        forms = leaf.along(columns, [np.zeros(len(points))] * 3)
        deep &= np.all([form[0] <= 0 for form in forms], axis=0)
    return deep


def deep_points(rng: Rng, shape: rb.Shape, n: int, margin: float) -> np.ndarray:
    points = rng.uniform(*shape.bounds, (n, 3))
    return points[depth_of(shape, points, margin)]


@pytest.mark.parametrize("rays", [4000, pytest.param(100_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("distance", [2, 100, 1e3, 1e4, 1e5])
@pytest.mark.parametrize("kind", SOLID_KINDS)
def test_rays_through_the_middle_hit(kind: str, distance: float, rays: int) -> None:
    """At 1e5 sizes the rounding of the origin moves a ray by 0.01 sizes: the target is 0.05 deep."""
    rng = np.random.default_rng(SOLID_KINDS.index(kind))
    missed, shapes, tested = [], 0, 0
    while shapes < 25 or tested < rays:  # needles and thin sheets have few points so deep: more shapes then
        shape = make(kind, rng, 1.0, rng.normal(size=3))
        targets = deep_points(rng, shape, rays, 0.05)
        origins = f32(targets + distance * unit(rng, len(targets)))
        directions = f32(targets - origins)
        hit = rb.intersect(shape, origins, directions)["hit"]
        missed += [(shape, origins[i].tolist(), directions[i].tolist()) for i in np.flatnonzero(~hit)[:1]]
        tested += len(targets)
        shapes += 1
        assert shapes <= 250, f"only {tested} rays in {shapes} shapes"
    assert not missed, f"{len(missed)} of {shapes} shapes, first {missed[0]}"


@pytest.mark.parametrize("distance", [2, 100, 1e4])
@pytest.mark.parametrize("kind", STAR_KINDS)
def test_rays_beside_a_solid_miss(kind: str, distance: float) -> None:
    """Rays that miss the solid when it is a tenth larger, by the oracle."""
    rng = np.random.default_rng(SOLID_KINDS.index(kind) + 7)
    beside = 0
    for _ in range(12):
        shape = make(kind, rng, 1.0, np.zeros(3))
        center = deep_points(rng, shape, 2000, 0.01).mean(axis=0)
        grown = np.eye(4)
        grown[:3, :3] *= 1.1
        grown[:3, 3] = -0.1 * center
        larger = build(shape.transformed(rb.Transform(grown)))
        targets = rng.uniform(*(center + 1.3 * (shape.bounds - center)), (40, 3))
        origins = f32(targets + distance * unit(rng, 40))
        directions = f32(targets - origins)
        hit = rb.intersect(shape, origins, directions)["hit"]
        for i in range(40):
            if first_change(larger, origins[i], directions[i]) is None:
                beside += 1
                assert not hit[i], (shape, origins[i], directions[i])
    assert beside >= 60
