"""Rays eight by eight have the same bits as one by one: crossings, points, shadows, light and the rays sent on."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest
from tests.support.random_scenes import random_scene
from tests.support.support_hard import CASES, all_scales, hard, rays_of
from tests.support.support_shapes import Rng, f32, unit

import raybound as rb
from raybound import _core

SEEDS = 24


def eights(*arrays: np.ndarray) -> list[np.ndarray]:
    count = len(arrays[0]) // 8 * 8
    return [f32(a[:count]) for a in arrays]


def snapshot(scene: rb.Scene) -> _core.Snapshot:
    return scene._document.snapshot()


def unit32(v: np.ndarray) -> np.ndarray:
    return f32(v / np.linalg.norm(v, axis=-1, keepdims=True))


def ray_mix(rng: Rng, count: int) -> tuple[np.ndarray, np.ndarray]:
    """From near and far (up to 1e6 away), some along axes and in planes of axes, in random order: packs are mixed."""
    far = 10.0 ** rng.choice([-1, 0.3, 1, 1, 2, 4, 6], size=(count, 1))
    origins = unit(rng, count) * far
    targets = rng.uniform(-3, 3, (count, 3))
    directions = targets - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    zeros = rng.random((count, 3)) < 0.15
    zeros[zeros.all(axis=1)] = False
    directions = np.where(zeros, np.where(rng.random((count, 3)) < 0.5, 0.0, -0.0), directions)
    origins = np.where(zeros, targets, origins)
    directions[rng.random(count) < 0.05] *= 7.5e-3
    return f32(origins), unit32(directions) if rng.random() < 0.7 else f32(directions)


def same(packed: np.ndarray, single: np.ndarray) -> None:
    for name in packed.dtype.names:
        different = np.flatnonzero(
            [a.tobytes() != b.tobytes() for a, b in zip(packed[name], single[name], strict=True)]
        )
        assert different.size == 0, (name, different[:5], packed[different[:3]], single[different[:3]])


def both_hits(scene: rb.Scene, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    view = snapshot(scene)
    single = _core.pack_hits(view, origins, directions, packed=False)
    same(_core.pack_hits(view, origins, directions, packed=True), single)
    return single


def both_blocked(scene: rb.Scene, origins: np.ndarray, ends: np.ndarray, *, directions: bool) -> np.ndarray:
    view = snapshot(scene)
    single = _core.pack_blocked(view, origins, ends, directions=directions, packed=False)
    assert (single == _core.pack_blocked(view, origins, ends, directions=directions, packed=True)).all()
    return single


def spawned(hits: np.ndarray, rng: Rng) -> tuple[np.ndarray, np.ndarray]:
    """Rays from surfaces, outward and inward: most of those from inside solids."""
    at = np.flatnonzero(hits["hit"])
    outward = rng.random(len(at)) < 0.5
    origins = np.where(outward[:, None], hits["outer"][at], hits["inner"][at])
    grazing = 10.0 ** rng.uniform(-4, 0, (len(at), 1))
    sideways = np.cross(hits["normal"][at], unit(rng, len(at)))
    directions = np.where(outward[:, None], 1, -1) * hits["normal"][at] * grazing + sideways
    origins, directions = eights(origins, unit32(directions))
    return origins, directions


def test_random_scenes() -> None:
    seen = dict.fromkeys(["hits", "inside", "faces", "blocked", "free", "textured", "far"], 0)
    kinds: set[int] = set()
    for seed in range(SEEDS):
        rng = np.random.default_rng([seed, 77])
        scene = random_scene(seed)
        origins, directions = eights(*ray_mix(rng, 2000))
        hits = both_hits(scene, origins, directions)
        next_origins, next_directions = spawned(hits, rng)
        further = both_hits(scene, next_origins, next_directions)
        lights = f32(rng.uniform(-6, 6, origins.shape))
        blocked = both_blocked(scene, origins, lights, directions=False)
        near = both_blocked(scene, next_origins, f32(next_origins + 0.3 * next_directions), directions=False)
        both_blocked(scene, next_origins, next_directions, directions=True)
        seen["hits"] += int(hits["hit"].sum() + further["hit"].sum())
        seen["inside"] += int((further["hit"] & (1 - further["entering"])).sum())
        seen["faces"] += int((hits["face"] > 0).sum())
        seen["blocked"] += int(blocked.sum() + near.sum())
        seen["free"] += int((blocked == 0).sum())
        seen["textured"] += int((hits["diffuse"] > 0).any(axis=1).sum())
        seen["far"] += int((np.abs(hits["t"][hits["hit"] > 0]) > 1e5).sum())
        kinds |= set(hits["primitive"][hits["hit"] > 0].tolist())
    assert seen["hits"] > 20000
    assert seen["inside"] > 2000
    assert seen["faces"] > 3000
    assert seen["blocked"] > 5000
    assert seen["free"] > 100000
    assert seen["textured"] > 200
    assert seen["far"] > 500
    assert kinds >= set(range(24))


@all_scales(CASES)
def test_hard_cases(name: str, scale: float) -> None:
    scene, cam = hard(name, scale)
    origins, directions = eights(*rays_of(cam))
    hits = both_hits(scene, origins, directions)
    rng = np.random.default_rng(5)
    if hits["hit"].sum() >= 8:
        next_origins, next_directions = spawned(hits, rng)
        both_hits(scene, next_origins, next_directions)
        ends = hits["point"][np.flatnonzero(hits["hit"])][: len(next_origins)]
        both_blocked(scene, next_origins, f32(ends), directions=False)
        both_blocked(scene, f32(ends), next_origins, directions=False)


def coincident_solid(rng: Rng) -> rb.Shape:
    """A box, cylinder, cone or ball of a few sizes at a few places: faces of several of them coincide."""
    low = rng.integers(-2, 2, 3) / 2
    size = rng.integers(1, 4, 3) / 2
    top, radius = (low[0], low[1], low[2] + size[2]), float(size[0])
    kind = rng.random()
    if kind < 0.4:
        return rb.Box(low, low + size)
    if kind < 0.6:
        return rb.Cylinder(low, top, radius=radius)
    if kind < 0.75:
        return rb.Cone(low, top, radius=radius)
    return rb.Sphere(low, radius)


def nested(rng: Rng, depth: int) -> rb.Shape:
    """An expression of coincident solids, some in twice, and now and then a hollow quadric."""
    if depth == 0:
        if rng.random() < 0.03:
            return rb.Quadric((1, 1, -1, 0, 0, 0, 0, 0, 0, -0.1), rb.Box((-1, -1, -1), (1, 1, 1)))
        return coincident_solid(rng)
    parts = [nested(rng, depth - int(rng.integers(1, depth + 1))) for _ in range(int(rng.integers(2, 6)))]
    if rng.random() < 0.3:
        parts.append(parts[0])
    if rng.random() < 0.4:
        with contextlib.suppress(ValueError):  # that the parts do not overlap
            return rb.Intersection(*parts[:3])
    return rb.Union(*parts)


def test_csg() -> None:
    seen = dict.fromkeys(["hits", "inside", "blocked", "free"], 0)
    for seed in range(40):
        rng = np.random.default_rng([seed, 79])
        scene = rb.Scene()
        turn = rb.Transform.rotate(30, axis=(1, 2, 3)) if seed % 2 else None
        for _ in range(5):
            scene.add(nested(rng, int(rng.integers(1, 4))), rb.Material(0.5), transform=turn)
        origins, directions = eights(*ray_mix(rng, 2000))
        for _ in range(3):
            hits = both_hits(scene, origins, directions)
            seen["hits"] += int(hits["hit"].sum())
            seen["inside"] += int((hits["hit"] & (1 - hits["entering"])).sum())
            if hits["hit"].sum() < 8:
                break
            origins, directions = spawned(hits, rng)
            ends = f32(origins + directions * 10.0 ** rng.uniform(-3, 1, (len(origins), 1)))
            blocked = both_blocked(scene, origins, ends, directions=False)
            both_blocked(scene, origins, directions, directions=True)
            seen["blocked"] += int(blocked.sum())
            seen["free"] += int((blocked == 0).sum())
    assert seen["hits"] > 30000, seen
    assert seen["inside"] > 10000, seen
    assert seen["blocked"] > 5000, seen
    assert seen["free"] > 10000, seen


def lights(rng: Rng) -> rb.Scene:
    """Lights of every kind; materials matte, glossy, rough, mirror, glass."""
    scene = rb.Scene()
    colours = [0.0, 0.3, (0.2, 0.5, 0.9)]
    for roughness in (0.01, 0.05, 0.2, 0.7):
        for k, specular in enumerate(colours):
            transmit = [0, 0.8, (0.1, 0.9, 0.3)][k]
            scene.add(
                rb.Sphere(tuple(rng.uniform(-3, 3, 3).tolist()), 0.5),
                rb.Material(
                    diffuse=float(rng.choice([0.0, 0.4])),
                    specular=specular,
                    roughness=roughness,
                    reflect=[0, 0.2, 1][int(rng.integers(3))],
                    transmit=transmit,
                    ior=float(rng.uniform(0.6, 2.4)),
                ),
            )
    for falloff in (False, True):
        for reach in (1.0, 1e3, 1e-3):
            position = tuple((rng.normal(size=3) * reach).tolist())
            scene.add_light(rb.PointLight(position, 0.7, falloff=falloff))
            aim = tuple((-np.array(position) + rng.normal(size=3) * 0.3).tolist())
            cutoff = float(rng.choice([0.05, 10, 60, 100]))
            scene.add_light(rb.SpotLight(position, aim, cutoff=cutoff, intensity=(0.1, 0.6, 2), falloff=falloff))
    scene.add_light(rb.DirectionalLight(tuple(rng.normal(size=3).tolist()), 0.5))
    return scene


def test_light() -> None:
    seen = dict.fromkeys(["faces", "behind", "outside", "weighs", "weightless", "total", "refracted", "bright"], 0)
    for seed in range(12):
        rng = np.random.default_rng([seed, 78])
        scene = lights(rng)
        view = snapshot(scene)
        n = 400
        points = f32(rng.normal(size=(n, 3)) * 10.0 ** rng.uniform(-4, 3, (n, 1)))
        normals = unit32(rng.normal(size=(n, 3)))
        directions = unit32(rng.normal(size=(n, 3)))
        facing = (normals * directions).sum(axis=1, keepdims=True) > 0
        if seed % 3:
            normals = np.where(facing, -normals, normals)
        if seed % 4 == 1:  # mirrored about the normal toward the first light: in the middle of its lobe
            way = unit32(f32(scene.lights[0].light.position) - points)
            half = unit32(way - directions)
            normals = np.where(rng.random((n, 1)) < 0.5, half, normals)
        for k in range(len(scene.objects)):
            one = _core.pack_light(view, k, points, normals, directions, packed=False)
            eight = _core.pack_light(view, k, points, normals, directions, packed=True)
            same(eight[0], one[0])
            same(eight[1], one[1])
            terms, rays = one
            seen["faces"] += int(terms["faces"].sum())
            seen["behind"] += int((terms["faces"] == 0).sum())
            seen["outside"] += int((terms["faces"] & (terms["shines"] ^ 1)).sum())
            seen["weighs"] += int(terms["weighs"].sum())
            seen["weightless"] += int((terms["faces"] & terms["shines"] & (terms["weighs"] ^ 1)).sum())
            seen["bright"] += int((terms["factor"].max(axis=1) > 1).sum())
            seen["total"] += int(rays["total"].sum())
            seen["refracted"] += int((rays["transmit"].max(axis=1) > 0).sum())
    minimum = {"total": 1000, "refracted": 10000, "bright": 1000}
    for name, count in seen.items():
        assert count > minimum.get(name, 5000), (name, count)


def test_a_light_at_the_point() -> None:
    scene = rb.Scene()
    scene.add(rb.Sphere((0, 0, 0), 1), rb.Material(specular=0.5))
    scene.add_light(rb.PointLight((1, 2, 3), 1, falloff=True))
    scene.add_light(rb.SpotLight((1, 2, 3), (0, 0, 1), cutoff=30, intensity=1))
    points = f32(np.tile([1, 2, 3], (8, 1)))
    points[3:] += f32([0, 0, 1e-3])
    normals = f32(np.tile([0, 0, -1], (8, 1)))
    view = snapshot(scene)
    one = _core.pack_light(view, 0, points, normals, -normals, packed=False)
    eight = _core.pack_light(view, 0, points, normals, -normals, packed=True)
    same(eight[0], one[0])
    assert one[0]["shines"].tolist() == [0, 0] * 3 + [1, 1] * 5


FUNCTIONS = ["sqrt", "rsqrt", "next_float_up", "next_float_down", "power_of_two_below", "copysign", "minimum"]
FUNCTIONS += ["maximum", "step_away", "flush_component"]
FLOAT_FUNCTIONS = ["exp", "acos", "atan2"]


def special(kind: type) -> np.ndarray:
    """Zeros, subnormal, common and the largest numbers, infinities and NaN, of both signs."""
    f = np.finfo(kind)
    x = np.array([0, f.smallest_subnormal, f.tiny, 0.4142, 1, 2.5, 88.72, 103.9, f.max, np.inf, np.nan], kind)
    return np.concatenate([x, -x, np.nextafter(x, kind(0)), np.nextafter(x, kind(9))])


@pytest.mark.parametrize(
    ("name", "kind"),
    [(f, k) for f in FUNCTIONS for k in (np.float32, np.float64)] + [(f, np.float32) for f in FLOAT_FUNCTIONS],
)
@pytest.mark.filterwarnings("ignore:.*:RuntimeWarning")
def test_functions(name: str, kind: type) -> None:
    rng = np.random.default_rng(3)
    unsigned = np.uint32 if kind is np.float32 else np.uint64
    pairs = np.stack(np.meshgrid(special(kind), special(kind))).reshape(2, -1)
    any_bits = np.frombuffer(rng.bytes(2**18 * unsigned().itemsize), unsigned).view(kind).reshape(2, -1)
    common = rng.normal(size=(2, 2**17)) * 10.0 ** rng.uniform(-3, 2, 2**17)
    x, y = (a[: a.size // 8 * 8] for a in np.concatenate([pairs, any_bits, common.astype(kind)], axis=1))
    one = _core.pack_apply(name, x, y, packed=False)
    eight = _core.pack_apply(name, x, y, packed=True)
    assert one.dtype == kind
    nan = np.isnan(one)
    assert (nan == np.isnan(eight)).all()
    assert (one.view(unsigned) == eight.view(unsigned))[~nan].all()
    assert (~nan).mean() > 0.2


def test_rays_come_in_eights() -> None:
    view = snapshot(random_scene(0))
    with pytest.raises(ValueError, match="in eights, got 7"):
        _core.pack_hits(view, np.zeros((7, 3), "f"), np.ones((7, 3), "f"), packed=True)
    with pytest.raises(ValueError, match="same shape"):
        _core.pack_blocked(view, np.zeros((8, 3), "f"), np.ones((16, 3), "f"), directions=False, packed=True)
