"""Float32 pictures against float64 ones: they differ only where a decision flips, next to a discontinuity."""

import numpy as np
import pytest
from tests.support.random_scenes import random_scene
from tests.support.support_precision import is_explained, pictures

import raybound as rb

SCENES = {
    "museum": (lambda: rb.scenes.museum(), 160, 120, 5, 0.004),  # largest observed share 0.00042
    "three spheres": (lambda: rb.scenes.three_spheres(), 200, 150, 6, 0.002),  # largest observed 0.00087
    "sphereflake": (lambda: rb.scenes.sphereflake(2), 160, 160, 6, 0.002),  # largest observed 0.00004
}


@pytest.mark.parametrize("name", SCENES)
def test_ready_scenes(name: str) -> None:
    make, width, height, depth, limit = SCENES[name]
    scene = make()
    cam = scene.camera.replace(width=width, height=height)
    single, double, differs = pictures(scene, cam, depth)
    assert differs.mean() < limit
    assert (single.image != double.image).mean() > 0.01  # they are computed apart
    for y, x in np.argwhere(differs):
        assert is_explained(scene, cam, depth, int(x), int(y)), (name, x, y)


def test_random_scenes() -> None:
    differing = pixels = 0
    for seed in range(300, 360):
        scene = random_scene(seed, pixels=64)
        _, _, differs = pictures(scene, scene.camera, 6)
        differing, pixels = differing + int(differs.sum()), pixels + differs.size
        for y, x in np.argwhere(differs):
            assert is_explained(scene, scene.camera, 6, int(x), int(y)), (seed, x, y)
    assert pixels > 150_000
    assert differing / pixels < 2e-4  # largest observed 5e-6


def test_object_ids_and_depths_agree_but_on_outlines() -> None:
    flips = pixels = 0
    for seed in range(360, 390):
        scene = random_scene(seed, pixels=64)
        single, double, _ = pictures(scene, scene.camera, 1)
        same = single.object_id == double.object_id
        flips, pixels = flips + int((~same).sum()), pixels + same.size
        seen = same & (double.object_id >= 0)
        relative = np.abs(single.depth[seen] / double.depth[seen] - 1)
        assert relative.max() < 1e-5  # largest observed 1.2e-7
    assert flips / pixels < 1e-4  # largest observed 0
    assert pixels > 80_000


def test_an_unexplained_difference_would_be_found() -> None:
    """In the middle of a flat floor nothing flips within reach."""
    scene = rb.Scene(ambient=0.5)
    scene.add(rb.Box((-9, -9, -1), (9, 9, 0)), rb.Material(0.5))
    cam = rb.Camera((0, -3, 2), (0, 0, 0), width=9, height=9)
    assert not is_explained(scene, cam, 5, 4, 4)
    scene.add(rb.Sphere((0, 0, 2**-0.5), 2**-0.5), rb.Material(0.25))
    grid = [(x, y) for x in range(9) for y in range(9) if is_explained(scene, cam, 5, x, y)]
    assert len(grid) <= 6  # its outline, within 1/50 of a pixel
