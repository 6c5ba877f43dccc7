"""`hits(Bundle, Object)`: never a wrong no or yes about the float tracer's own shadow rays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from tests.support.random_scenes import MAKERS, transform

import raybound as rb
from raybound import _core

NO, YES = 0, 1
Rng = np.random.Generator


@dataclass
class Tally:
    asked: int = 0
    no: int = 0
    yes: int = 0
    none_blocked: int = 0
    all_blocked: int = 0
    beyond_boxes: int = 0  # no, where the box alone could not tell


def random_patch(rng: Rng, middle: np.ndarray, size: float) -> np.ndarray:
    """A parallelepiped (4, 3): flat ones, needles and cubes, in any direction."""
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    half = size * 10 ** rng.uniform(-3, 0, 3)
    axes = turn * half[:, None]
    axes[0] += axes[1] * rng.uniform(-1, 1)  # sheared
    return np.concatenate([middle[None], axes])


def float_origins(rng: Rng, patch: np.ndarray, count: int) -> np.ndarray:
    """Floats in a patch: at random, at its corners and edges, rounded into it where it is thick enough."""
    r = rng.uniform(-1, 1, (count, 3))
    sharp = rng.random((count, 3)) < 0.4
    r[sharp] = np.sign(r[sharp])
    points = (patch[0] + (r * (1 - 1e-5)) @ patch[1:]).astype(np.float32)
    inside = np.abs(np.linalg.solve(patch[1:].T, (points.astype(np.float64) - patch[0]).T)) <= 1
    return points[inside.all(axis=0)]


def blocked(scene: rb.Scene, origins: np.ndarray, light: np.ndarray, *, directional: bool) -> np.ndarray:
    if directional:
        return scene.intersect(origins, np.broadcast_to(light, origins.shape))["hit"]
    return scene.occluded(origins, np.broadcast_to(light, origins.shape))


def check(rng: Rng, maker: int, far: float, tally: Tally) -> None:
    scene = rb.Scene()
    shape = MAKERS[maker](rng)
    place = transform(rng) or rb.Transform.translate(0, 0, 0)
    scene.add(shape, rb.Material(), transform=rb.Transform.translate(far, -far, far / 2) @ place)
    bounds = np.asarray(scene.bounds)
    middle, size = bounds.mean(axis=0), float(np.linalg.norm(bounds[1] - bounds[0]))
    directional = bool(rng.random() < 0.3)
    for _ in range(40):
        way = rng.normal(size=3)
        way *= size * 10 ** rng.uniform(-0.3, 1) / np.linalg.norm(way)
        patch = random_patch(rng, middle + way, size * 10 ** rng.uniform(-4, -0.3))
        aim = middle + rng.normal(size=3) * size * rng.choice([0.05, 0.4])
        beyond = aim + (aim - patch[0]) * 10 ** rng.uniform(-1.5, 1)
        light = (aim - patch[0] if directional else beyond).astype(np.float32)
        if directional:
            light /= np.float32(np.linalg.norm(light))
        origins = float_origins(rng, patch, 60)
        if len(origins) < 20:
            continue
        answer = _core.bundle_hits(scene._document.snapshot(), patch, light[None], directional=directional)
        verdict = int(answer["verdict"][0])
        found = blocked(scene, origins, light, directional=directional)
        tally.asked += 1
        tally.none_blocked += not found.any()
        tally.all_blocked += bool(found.all())
        tally.no += verdict == NO
        tally.yes += verdict == YES
        wrong = found.any() if verdict == NO else verdict == YES and not found.all()
        assert not wrong, f"a wrong verdict {verdict}: {shape}, patch {patch.tolist()}, light {light.tolist()}"


@pytest.mark.parametrize("far", [0.0, 30.0, 1e4, 1e6])
@pytest.mark.parametrize("maker", range(len(MAKERS)))
def test_no_verdict_is_wrong(maker: int, far: float) -> None:
    rng, tally = np.random.default_rng([maker, int(far)]), Tally()
    for _ in range(25):
        check(rng, maker, far, tally)
    assert tally.asked > 0  # (patches far below the rounding of their surroundings hold few floats, or none)
    if far > 100:
        return
    assert tally.asked > 300
    assert tally.no > 0.6 * tally.none_blocked
    convex = MAKERS[maker].__name__ in ("sphere", "box", "cylinder", "cone", "polygon")
    if convex:
        assert tally.all_blocked > 50
        assert tally.yes > 0.3 * tally.all_blocked


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(40))
def test_no_verdict_is_wrong_at_length(seed: int) -> None:
    rng, tally = np.random.default_rng([seed, 77]), Tally()
    for maker in range(len(MAKERS)):
        for far in (0.0, 30.0, 1e4, 1e6):
            for _ in range(100):
                check(rng, maker, far, tally)
    assert tally.no > 1000
    assert tally.yes > 1000
