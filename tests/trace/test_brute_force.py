"""The picture through the hierarchy is the picture by testing everything, byte for byte."""

import numpy as np
import pytest
from tests.support.random_scenes import random_scene
from tests.support.support_light import (
    EMITTER_AMBIENT,
    Picture,
    assert_same_picture,
    core_render,
    differing_pixels,
    emitter,
)
from tests.support.support_meshes import MESHES, kinds_of, mesh_or_none

import raybound as rb


def both(scene: rb.Scene, cam: rb.Camera, what: str, **options: object) -> Picture:
    plain = core_render(scene, cam, **options)
    assert_same_picture(plain, core_render(scene, cam, brute_force=True, **options), what)
    assert np.isfinite(plain.image).all()
    return plain


def interesting(scene: rb.Scene) -> int:
    """Kinds of objects a scene's picture shows."""
    return len(np.unique(core_render(scene, scene.camera).object_id))


@pytest.mark.parametrize("view", [0, 20, 41])
def test_museum(view: int) -> None:
    scene = rb.scenes.museum()
    cam = rb.scenes.walkthrough(60)[view].replace(width=100, height=75)
    shown = both(scene, cam, "museum")
    assert len(np.unique(shown.object_id)) > 60
    assert shown.rays["reflected"] > 100


def test_three_spheres() -> None:
    scene = rb.scenes.three_spheres()
    shown = both(scene, scene.camera.replace(width=240, height=180), "three spheres", max_depth=8)
    assert set(np.unique(shown.object_id)) == {-1, 0, 1, 2, 3}


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_sphereflake(precision: str) -> None:
    scene = rb.scenes.sphereflake(2)
    shown = both(scene, scene.camera.replace(width=160, height=160), "sphereflake", precision=precision)
    assert len(np.unique(shown.object_id)) > 40


@pytest.mark.parametrize("first", range(0, 40, 5))
def test_random_scenes(first: int) -> None:
    shadows = 0
    for seed in range(first, first + 5):
        scene = random_scene(seed)
        shown = both(scene, scene.camera, f"random scene {seed}", max_depth=6)
        assert interesting(scene) >= 3
        shadows += shown.rays["shadow"]
    assert shadows > 3000


def test_random_scenes_use_everything() -> None:
    reflected = refracted = 0
    kinds = set()
    for seed in range(8):
        scene = random_scene(seed)
        rays = core_render(scene, scene.camera).rays
        reflected, refracted = reflected + rays["reflected"], refracted + rays["refracted"]
        kinds |= {type(item.shape).__name__ for item in scene.objects}
    assert min(reflected, refracted) > 1000
    assert kinds >= {"Sphere", "Box", "Cylinder", "Cone", "Disk", "Polygon", "Union", "Intersection"}


def test_many_small_things_in_one_place() -> None:
    """More primitives with one centre than the builder can separate."""
    scene = rb.Scene(ambient=0.1)
    for k in range(150):
        scene.add(rb.Sphere((0, 0, 0), 0.5 + k * 1e-3), emitter((k / 150, 0.5, 0)))
        scene.add(rb.Disk((0, 0, 0), (np.cos(k), np.sin(k), 0.2), radius=1.2), emitter((0, k / 150, 0.5)))
    scene.add_light(rb.PointLight((2, -3, 2)))
    shown = both(scene, rb.Camera((0, -4, 1), (0, 0, 0), width=64, height=48), "concentric")
    assert len(np.unique(shown.object_id)) > 20


def test_widely_different_sizes() -> None:
    scene = rb.Scene(ambient=0.1, background=0.5)
    rng = np.random.default_rng(80)
    scene.add(rb.Box((-1e5, -1e5, -1), (1e5, 1e5, 0)), rb.Material(0.5, reflect=0.2))
    for _ in range(60):
        size = float(10 ** rng.uniform(-4, 3))
        x, y = rng.normal(size=2) * size * 3
        scene.add(rb.Sphere((x, y, size), size), rb.Material(0.4, reflect=0.3))
    scene.add_light(rb.PointLight((3, -10, 1e4)))
    for distance in (0.01, 3.0, 5e3):
        cam = rb.Camera((0, -distance, distance * 0.4), (0, 0, 0), width=80, height=60)
        assert len(np.unique(both(scene, cam, f"from {distance}").object_id)) > 4


def test_the_comparison_sees_a_moved_sphere() -> None:
    scene = rb.scenes.three_spheres()
    cam = scene.camera.replace(width=80, height=60)
    before = core_render(scene, cam)
    scene["mirror"].move(rb.Transform.translate(0, 0, 1e-5))
    assert differing_pixels(before, core_render(scene, cam)).any()


def test_planes_in_common() -> None:
    """Meshes and polygons in one plane: which of them comes first must not depend on the order they are asked in,
    though the rounded entry into a flat box may lie beyond the rounded crossing."""
    rng = np.random.default_rng(81)
    shown = 0
    for seed in range(12):
        scene = rb.Scene(ambient=EMITTER_AMBIENT)
        z = float(rng.uniform(1, 30))
        for k in range(8):
            low, high = z * rng.uniform(-1, -0.3, 2), z * rng.uniform(0.3, 1, 2)
            corners = [(low[0], low[1], z), (high[0], low[1], z), (high[0], high[1], z), (low[0], high[1], z)]
            turned = np.roll(corners, seed, axis=1)
            quad = rb.Polygon(turned) if rng.random() < 0.3 else rb.Mesh(turned, [(0, 1, 2), (0, 2, 3)])
            scene.add(quad, emitter((k / 8, 0.5, 0)))
        aim = np.roll((0.1, 0.2, z), seed)
        cam = rb.Camera((0, 0, 0), tuple(aim.tolist()), up=(1, 1, 0.5), width=96, height=72)
        for precision in ("float32", "float64"):
            shown += len(np.unique(both(scene, cam, f"planes {seed}", precision=precision).object_id))
    assert shown >= 100


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_full_packs_far_from_the_origin(precision: str) -> None:
    """Spheres and triangles by the dozen whose places no float holds: packs hold them rounded, and must say so."""
    rng = np.random.default_rng(82)
    for _ in range(4):
        scene = rb.Scene(ambient=EMITTER_AMBIENT)
        place = rb.Transform.translate(*np.round(rng.normal(size=3) * 2e4).tolist())
        for k in range(40):
            scene.add(rb.Sphere(0.01 * rng.normal(size=3), 2e-3), emitter((k / 40, 1, 0)), transform=place)
            corners = 0.01 * rng.normal(size=3) + 3e-3 * rng.normal(size=(3, 3))
            scene.add(rb.Polygon(corners), emitter((0, k / 40, 1)), transform=place)
        base = place.matrix[:3, 3]
        cam = rb.Camera(tuple(np.add(base, (0.03, 0.02, 0.0)).tolist()), tuple(base.tolist()), width=192, height=144)
        assert len(np.unique(both(scene, cam, "far packs", precision=precision).object_id)) > 50


def mesh_scene(seed: int) -> rb.Scene:
    """Meshes of all kinds, some in the same place twice, among spheres and triangles: mirrors, glass, any scale."""
    rng = np.random.default_rng([seed, 83])
    scene = rb.Scene(ambient=0.3)
    scale = 10 ** rng.uniform(-6, 6)
    middle = rng.normal(size=3) * 10 ** rng.uniform(-3, 3) * scale * (rng.random() < 0.6)

    def coat() -> rb.Material:
        reflect, transmit = rng.uniform(0, 0.6), rng.uniform(0, 0.4)
        return rb.Material(tuple(rng.uniform(0, 1, 3)), reflect=reflect, transmit=transmit, ior=rng.uniform(1, 2))

    for kind in rng.permutation(kinds_of(MESHES)):
        at = middle + scale * rng.normal(size=3) * rng.choice([0.0, 1.0])
        mesh = mesh_or_none(rng, kind + str(rng.choice(["", "+smooth"])), scale * 10 ** rng.uniform(-1, 0.3), at)
        for _ in range(0 if mesh is None else int(rng.integers(1, 3))):
            scene.add(mesh, coat())
    for _ in range(12):
        at = middle + scale * rng.normal(size=3)
        scene.add(rb.Sphere(at, scale * 10 ** rng.uniform(-1.5, -0.3)), coat())
        scene.add(rb.Polygon(at + scale * rng.normal(size=(3, 3))), coat())
    scene.add_light(rb.PointLight(tuple(middle + 4 * scale * rng.normal(size=3)), 0.8))
    scene.add_light(rb.DirectionalLight(tuple(rng.normal(size=3)), 0.5))
    eye = middle + 5 * scale * rng.normal(size=3)
    scene.camera = rb.Camera(tuple(eye), tuple(middle), up=(1, 0.5, 0.2), width=48, height=36)
    return scene


def meshes_agree(seeds: range) -> int:
    seen = 0
    for seed in seeds:
        scene = mesh_scene(seed)
        for precision in ("float32", "float64"):
            shown = both(scene, scene.camera, f"meshes {seed}", precision=precision, max_depth=5)
            seen += len(np.unique(shown.object_id))
    return seen


@pytest.mark.parametrize("first", range(0, 16, 4))
def test_random_meshes(first: int) -> None:
    assert meshes_agree(range(first, first + 4)) >= 30


@pytest.mark.soak
@pytest.mark.parametrize("first", range(1000, 3000, 100))
def test_soak_random_meshes(first: int) -> None:
    assert meshes_agree(range(first, first + 100)) >= 1000


@pytest.mark.soak
@pytest.mark.parametrize("first", range(10_000, 14_000, 100))
def test_soak_random_scenes(first: int) -> None:
    for seed in range(first, first + 100):
        scene = random_scene(seed, objects=30, pixels=80)
        both(scene, scene.camera, f"random scene {seed}", max_depth=6)


def test_ambient_pictures_through_both_show_every_object_id() -> None:
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    for k in range(100):
        scene.add(rb.Box((k % 10, 0, k // 10), (k % 10 + 0.9, 1, k // 10 + 0.9)), emitter())
    cam = rb.Camera((5, -12, 5), (5, 0, 5), fov=50, width=100, height=100)
    assert len(np.unique(both(scene, cam, "grid").object_id)) == 101
