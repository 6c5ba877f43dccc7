"""A snapshot that follows its scene's edits shows what one built anew shows, byte for byte."""

import itertools

import numpy as np
import pytest
from tests.support import random_scenes
from tests.support.random_scenes import random_scene

import raybound as rb


def assert_as_built_anew(scene: rb.Scene, renderer: rb.Renderer, cam: rb.Camera) -> np.ndarray:
    frame = renderer.render(cam)
    anew = rb.render(rb.Scene.from_dict(scene.to_dict()), cam, method="base")
    assert np.array_equal(frame.image, anew.image)
    assert frame.stats["rays"] == anew.stats["rays"]
    return frame.image


def edit(rng: np.random.Generator, scene: rb.Scene) -> None:
    """Any edit of one object."""
    thing = scene.objects[int(rng.integers(len(scene)))]
    choice = rng.integers(8)
    if choice < 3:
        thing.move(rb.Transform.translate(*rng.normal(size=3) * 0.3))
    elif choice == 3:
        thing.move(rb.Transform.scale(float(rng.uniform(0.8, 1.2))))
    elif choice == 4:
        thing.transform = rb.Transform.rotate(float(rng.uniform(0, 360)), axis=rng.normal(size=3).tolist())
    elif choice == 5:
        thing.shape = random_scenes.MAKERS[int(rng.integers(len(random_scenes.MAKERS)))](rng)
    elif choice == 6:
        thing.material = random_scenes.material(rng)
    elif rng.random() < 0.5:
        scene.add(random_scenes.sphere(rng), random_scenes.material(rng))
    else:
        thing.remove()


@pytest.mark.parametrize("seed", range(8))
def test_random_edits(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = random_scene(seed, objects=30)
    cam = scene.camera.replace(width=48, height=36)
    pictures = []
    with rb.Renderer(scene, method="base") as renderer:
        for _ in range(12):
            pictures.append(assert_as_built_anew(scene, renderer, cam))
            for _ in range(int(rng.integers(1, 4))):
                edit(rng, scene)
    changed = sum(not np.array_equal(a, b) for a, b in itertools.pairwise(pictures))
    assert changed >= 6


def test_spheres_and_triangles_that_move_far() -> None:
    """Packs of both kinds; the tree becomes bad and is built anew."""
    rng = np.random.default_rng(3)
    scene = rb.Scene(ambient=1.0)
    for k in range(300):
        at = rng.uniform(-2, 2, 3)
        shape = rb.Sphere(at, 0.1) if k % 2 else rb.Polygon(at + rng.normal(size=(3, 3)) * 0.2)
        scene.add(shape, rb.Material(rng.random(3).tolist()))
    cam = rb.Camera((0, -9, 0), (0, 0, 0), width=60, height=60, fov=50)
    with rb.Renderer(scene, method="base") as renderer:
        for _ in range(8):
            for _ in range(60):
                scene.objects[int(rng.integers(300))].move(rb.Transform.translate(*rng.normal(size=3)))
            shown = renderer.render(cam)
            assert_as_built_anew(scene, renderer, cam)
            assert len(np.unique(shown.object_id)) > 60


def test_what_an_earlier_frame_knows_stays() -> None:
    scene = rb.scenes.sphereflake(2)
    cam = scene.camera.replace(width=40, height=30)
    with rb.Renderer(scene, method="base") as renderer:
        before = renderer.render(cam)
        y, x = np.argwhere(before.object_id >= 0)[300]
        told = str(before.explain(int(x), int(y)))
        for thing in scene.objects:
            thing.move(rb.Transform.translate(0, 0, 0.25))
        after = renderer.render(cam)
    assert str(before.explain(int(x), int(y))) == told
    assert not np.array_equal(before.image, after.image)


def test_a_move_that_fails_changes_nothing() -> None:
    scene = rb.scenes.sphereflake(1)
    cam = scene.camera.replace(width=40, height=30)
    scene.objects[1].move(rb.Transform.scale(2.0**40))
    with rb.Renderer(scene, method="base") as renderer:
        before = renderer.render(cam)
        with pytest.raises(ValueError, match=r"2\*\*60"):
            scene.objects[1].move(rb.Transform.scale(2.0**40))
        assert np.array_equal(renderer.render(cam).image, before.image)


@pytest.mark.parametrize("what", ["spheres", "mesh"])
def test_bytes(what: str) -> None:
    """Scene and hierarchy together: under 200 bytes for each sphere and triangle."""
    if what == "spheres":
        scene, count = rb.scenes.sphereflake(4), 7382
    else:
        side = 150
        x, y = np.meshgrid(np.arange(side), np.arange(side))
        vertices = np.stack([x, y, np.sin(x * 0.3) * np.cos(y * 0.2)], -1).reshape(-1, 3)
        a = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1)
        faces = np.concatenate([np.stack([a, a + 1, a + side + 1], -1), np.stack([a, a + side + 1, a + side], -1)])
        scene, count = rb.Scene(), len(faces)
        scene.add(rb.Mesh(vertices, faces), rb.Material())
    used = scene._document.snapshot().bytes / count
    assert 30 < used < 200
