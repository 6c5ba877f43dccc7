"""`method="exact"` gives the base image, byte for byte (certified-interpolants 9, promises 0, 5 and 6)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.support_exact import EDITS, Tally, check_scene, compare
from tests.support.support_hard import all_scales, hard

import raybound as rb
from raybound.bench import workloads

CORPUS = json.loads((Path(__file__).parents[1] / "corpus" / "exact.json").read_text())


def scaled(scene: rb.Scene, width: int) -> rb.Camera:
    assert scene.camera is not None
    return scene.camera.replace(width=width, height=width * 3 // 4)


@pytest.mark.parametrize("first", range(0, 120, 20))
def test_random_scenes_and_edits(first: int) -> None:
    tally = Tally()
    for seed in range(first, first + 20):
        check_scene(seed, tally)
    assert set(tally.edits) == set(EDITS)
    assert tally.frames == 120
    assert tally.share > 0.5  # certifying nothing is no way to be right


@pytest.mark.soak
@pytest.mark.parametrize("first", range(0, 1000, 50))
def test_a_thousand_random_scenes(first: int) -> None:
    tally = Tally()
    for seed in range(first, first + 50):
        check_scene(seed, tally, pixels=96)
    assert tally.frames == 300
    assert tally.share > 0.5


def off_its_plane(far: float, lamp: tuple[float, float, float], up: float) -> rb.Scene:
    """A quad with a corner a few ulp above the others, and a light between the plane of that corner and the others."""
    ulp, height = float(np.spacing(np.float32(far))), 0.0
    for k in range(1, 40):
        try:
            quad = rb.Polygon([(far, far, k * ulp / 2), (far + 1, far, 0), (far + 1, far + 1, 0), (far, far + 1, 0)])
        except ValueError:
            break
        height = k * ulp / 2
    assert height > 0
    scene = rb.Scene(ambient=0.1)
    scene.add(quad, rb.Material())
    scene.add(rb.Box((far - 1, far - 1, up), (far + 2, far + 2, up + 0.2)), rb.Material((0.8, 0.8, 0.8)))
    scene.add_light(rb.PointLight((far + lamp[0], far + lamp[1], height * lamp[2])))
    eye, target = (far + 2.5, far - 2, up * 0.3), (far + 0.5, far + 0.5, up)
    scene.camera = rb.Camera(eye, target, fov=60, width=160, height=120)
    return scene


def steep_cone(ratio: int, seed: int) -> rb.Scene:
    """A funnel whose base is 2**ratio times narrower than its top, over a floor."""
    rng = np.random.default_rng(seed)
    radius = 3.0 * 2.0**-ratio
    scene = rb.Scene(ambient=0.1)
    scene.add(rb.Box((-40, -40, -4.3), (40, 40, -4)), rb.Material((0.8, 0.8, 0.8)))
    turn = rb.Transform.rotate(float(rng.uniform(0, 360)), axis=tuple(rng.normal(size=3).tolist()))
    height = radius * 2.0 ** int(rng.integers(-2, 3))
    scene.add(rb.Cone((0, 0, 0), (0, 0, height), radius=radius, top_radius=3), rb.Material(), transform=turn)
    scene.add_light(rb.PointLight((2, 1, 9)))
    scene.add_light(rb.DirectionalLight((0.2, -0.3, -1)))
    scene.camera = rb.Camera((8, -8 / 3, 4), (-2, 0, -4), fov=50, width=160, height=120)
    return scene


def scenes_of(case: dict[str, Any]) -> list[rb.Scene]:
    if "polygon_off_its_plane" in case:
        lamps = [(0.90625, 0.0625, 0.3), (0.90625, 0.125, 0.35), (0.0625, 0.90625, 0.3), (0.9375, 0.0625, 0.25)]
        return [off_its_plane(case["polygon_off_its_plane"], lamp, up) for lamp in lamps for up in (1.0, 0.05)]
    if "steep_cone" in case:
        return [steep_cone(case["steep_cone"], seed) for seed in range(6)]
    try:
        scene = workloads.load(case["spd"])
    except workloads.UnavailableError as reason:
        pytest.skip(f"RAYBOUND_DATA: {reason}")
    scene.camera = scaled(scene, case["width"])
    return [scene]


@pytest.mark.parametrize("case", CORPUS, ids=lambda case: "-".join(map(str, list(case.items())[1])))
def test_scenes_that_were_wrong(case: dict[str, Any]) -> None:
    if "random_scene" in case:
        check_scene(case["random_scene"], Tally())
        return
    for scene in scenes_of(case):
        with rb.Renderer(scene) as exact, rb.Renderer(scene, method="base") as base:
            assert scene.camera is not None
            compare(exact, base, scene.camera, Tally(), case["why"])
            compare(exact, base, scene.camera.dolly(0.3), Tally(), case["why"])


@pytest.mark.parametrize("threads", [1, 2])
def test_the_museum_walk(threads: int) -> None:
    scene, tally = rb.scenes.museum(), Tally()
    with rb.Renderer(scene, threads=threads) as exact, rb.Renderer(scene, method="base") as base:
        for camera in rb.scenes.walkthrough(60)[:: 12 // threads]:
            compare(exact, base, camera.replace(width=480, height=360), tally, "museum")
    assert tally.share > 0.75


@pytest.mark.parametrize("name", workloads.SPD)
def test_spd_scenes(name: str) -> None:
    try:
        scene = workloads.load(name)
    except workloads.UnavailableError as reason:
        pytest.skip(f"RAYBOUND_DATA: {reason}")
    tally = Tally()
    with rb.Renderer(scene) as exact, rb.Renderer(scene, method="base") as base:
        for azimuth in (0, 2, 35):
            compare(exact, base, scaled(scene, 320).orbit(azimuth, 0), tally, name)
    assert tally.certified > 0


@pytest.mark.soak
@pytest.mark.parametrize("name", ["museum", *workloads.SPD])
def test_whole_size(name: str) -> None:
    """At 1200 x 900, where cells are divided further; the museum all along its walk."""
    try:
        scene = workloads.load(name)
    except workloads.UnavailableError as reason:
        pytest.skip(f"RAYBOUND_DATA: {reason}")
    cameras = rb.scenes.walkthrough(60) if name == "museum" else [scaled(scene, 1200).orbit(a, 0) for a in (0, 1, 20)]
    with rb.Renderer(scene) as exact, rb.Renderer(scene, method="base") as base:
        for camera in cameras:
            compare(exact, base, camera, Tally(), name)


@all_scales(rb.scenes.HARD_CASES)
def test_hard_cases(name: str, scale: float) -> None:
    scene, _ = hard(name, scale)
    with rb.Renderer(scene) as exact, rb.Renderer(scene, method="base") as base:
        compare(exact, base, scaled(scene, 120), Tally(), f"{name} at {scale}")
        compare(exact, base, scaled(scene, 120).orbit(7, 3), Tally(), f"{name} at {scale}, turned")


def test_meshes_are_searched_for() -> None:
    scene = rb.Scene(ambient=0.1)
    scene.add(rb.Polygon([(-3, -3, -1), (3, -3, -1), (3, 3, -1), (-3, 3, -1)]), rb.Material(reflect=0.3))
    vertices, faces = workloads.bumpy_sphere(20, 40)
    mesh = scene.add(rb.Mesh(vertices, faces), rb.Material(specular=0.2))
    quadric = scene.add(rb.Quadric((1, 1, -1, 0, 0, 0, 0, 0, 0, -0.01), rb.Box((-1, -1, -1), (1, 1, 1))), rb.Material())
    quadric.move(rb.Transform.translate(2, 0, 0))
    scene.add_light(rb.PointLight((2, -3, 4)))
    scene.add_light(rb.DirectionalLight((1, 0.3, -1)))
    camera = rb.Camera((0, -6, 3), (0, 0, 0), fov=50, width=160, height=120)
    with rb.Renderer(scene) as exact, rb.Renderer(scene, method="base") as base:
        frame = compare(exact, base, camera, Tally(), "mesh")
        for handle in (mesh, quadric):
            mine = frame.object_id == handle.id
            assert mine.sum() > 100
            assert (frame.reason[mine] == rb.Reason.UNSUPPORTED).mean() > 0.3
        mesh.move(rb.Transform.translate(0, 0, 0.4))
        compare(exact, base, camera, Tally(), "mesh moved")


def test_deep_ray_trees() -> None:
    scene = rb.Scene()
    for x in (-1, 1):
        scene.add(rb.Box((x - 0.05, -3, -3), (x + 0.05, 3, 3)), rb.Material(reflect=0.95))
    scene.add(rb.Sphere((0, 0.3, 0), 0.4), rb.Material(reflect=0.8))
    scene.add_light(rb.PointLight((0, -1, 2)))
    camera = rb.Camera((0.6, -2, 0.2), (-0.5, 0, 0), width=48, height=36)
    options = {"max_depth": 300}
    with rb.Renderer(scene, **options) as exact, rb.Renderer(scene, method="base", **options) as base:
        compare(exact, base, camera, Tally(), "mirrors")


def test_paths_do_not_depend_on_threads() -> None:
    scene = rb.scenes.museum()
    frames = []
    for threads in (1, 2, 4):
        with rb.Renderer(scene, threads=threads) as renderer:
            walk = [c.replace(width=160, height=120) for c in rb.scenes.walkthrough(60)[:3]]
            frames.append(list(renderer.sequence(walk)))
    for others in frames[1:]:
        for one, other in zip(frames[0], others, strict=True):
            assert one == other  # path and reason, too
            assert np.array_equal(one.reason, other.reason)
