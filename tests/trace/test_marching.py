"""Inside is inside: crossings of a closed solid alternate along any chain of rays, near and far, at edges and tips."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.marching import KINDS, Chains, march, random_march

import raybound as rb

CORPUS = json.loads((Path(__file__).parents[1] / "corpus" / "inside.json").read_text())
ORIGINS = json.loads((Path(__file__).parents[1] / "corpus" / "origins.json").read_text())
NAMES = {name: getattr(rb, name) for name in ("Sphere", "Box", "Cylinder", "Cone", "Quadric", "Transform")}


def report(seed: int, found: Chains) -> str:
    return f"seed {seed}: " + ", ".join(f"ray {i} {why}" for i, why in zip(found.broken[:3], found.why[:3]))


@pytest.mark.parametrize("rounds", [25, pytest.param(2500, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", KINDS)
def test_marched_rays_enter_and_leave(kind: str, rounds: int) -> None:
    """10^5 rays here, 10^7 in the soak: half of them aimed at edges, rims, tips and tangents."""
    hits = left = 0
    for seed in range(rounds):
        found = random_march(kind, np.random.default_rng([seed, KINDS.index(kind)]), 500)
        chains = march(found.scene(), found.origins, found.directions)
        assert not len(chains.broken), report(seed, chains)
        hits += chains.hits
        left += chains.passed
    assert hits >= 0.5 * 500 * rounds
    assert left >= 0.2 * 500 * rounds


@pytest.mark.parametrize("rounds", [6, pytest.param(300, marks=pytest.mark.soak)])
@pytest.mark.parametrize("kind", KINDS)
def test_refracted_rays_end_outside(kind: str, rounds: int) -> None:
    """Through glass, with reflections: a ray that is inside meets the solid, whatever it has gone through before."""
    inside = 0
    for seed in range(rounds):
        found = random_march(kind, np.random.default_rng([seed, 7, KINDS.index(kind)]), 300)
        scene = found.scene()
        with rb.Renderer(scene, max_depth=6) as renderer:
            paths = renderer.paths(found.origins, found.directions)
        within = np.zeros(len(paths), bool)
        starts = np.diff(scene.containing(found.origins)[1]) == 1
        for i, path in enumerate(paths):  # parents come first
            parent = path["parent"]
            within[i] = starts[path["ray"]] if parent < 0 else within[parent] ^ (path["kind"] == rb.RayKind.REFRACTED)
        assert np.isfinite(paths["t"][within]).all(), f"seed {seed}"
        inside += int(within.sum())
    assert inside >= 100 * rounds


@pytest.mark.parametrize("case", CORPUS, ids=[case["why"] for case in CORPUS])
def test_chains_that_were_broken(case: dict[str, Any]) -> None:
    if "march" in case:
        kind, seed, count = case["march"]
        found = random_march(kind, np.random.default_rng(seed), count)
        chains = march(found.scene(), found.origins, found.directions)
    else:
        scene = rb.Scene()
        scene.add(eval(case["shape"], {"__builtins__": {}}, NAMES), rb.Material(transmit=0.9, ior=1.5))
        chains = march(scene, np.float32([case["origin"]]), np.float32([case["direction"]]))
        assert chains.hits > 0
    assert not len(chains.broken), chains.why


@pytest.mark.parametrize("case", ORIGINS, ids=[case["why"] for case in ORIGINS])
def test_rays_into_a_far_sphere_leave_it_next(case: dict[str, Any]) -> None:
    scene = rb.Scene()
    scene.add(eval(case["shape"], {"__builtins__": {}}, NAMES), rb.Material())
    hit = scene.intersect(case["origin"], case["direction"])
    way = np.float32(case["way"])
    assert hit["hit"]
    assert np.dot(way, hit["normal"]) < -0.1
    after = scene.intersect(hit, way)
    assert after["hit"]
    assert not after["entering"]
    assert np.dot(after["normal"], way) > 0
    assert not scene.intersect(after, way)["hit"]


def test_eye_level_with_the_base_of_a_glass_cone() -> None:
    """A ray in the plane of the base enters through the acute rim and leaves by total reflection, not straight on."""
    scene = rb.Scene()
    scene.add(rb.Cone((0, 0, 0), (0, 0, 2)), rb.Material(0.0, transmit=1.0, ior=1.5))
    eyes = np.float32([[x, -6, z] for x in np.linspace(-0.6, 0.6, 13) for z in (0.0, 1e-6)])
    with rb.Renderer(scene, max_depth=8) as renderer:
        paths = renderer.paths(eyes, (0, 1, 0))
    last = paths[np.isinf(paths["t"])]
    ways = np.zeros((len(eyes), 3))
    ways[last["ray"]] = last["point"]
    assert len(last) == len(eyes)
    assert np.abs(ways[0::2] - ways[1::2]).max() < 1e-4


@pytest.mark.parametrize("kind", KINDS)
def test_normals_face_the_ray_that_enters(kind: str) -> None:
    seen = 0
    for seed in range(20):
        found = random_march(kind, np.random.default_rng([seed, 11]), 400)
        scene = found.scene()
        directions = found.directions
        hits = scene.intersect(found.origins, directions)
        for _ in range(4):
            alive = hits["hit"]
            hits, directions = hits[alive], directions[alive]
            along = np.einsum("ij,ij->i", hits["normal"].astype(float), directions.astype(float))
            assert ((along < 0) == hits["entering"]).all()
            seen += len(hits)
            hits = scene.intersect(hits, directions)
    assert seen > 4000
