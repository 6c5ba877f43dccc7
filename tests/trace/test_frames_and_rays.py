"""Frames begin the search for what an eye ray hits where the tree parts for a block of pixels, and ask the last blocker
of a light first: the same bytes as rays that are traced one by one, from the root, without a past."""

import numpy as np
import pytest
from tests.support.random_scenes import random_scene

import raybound as rb


def assert_same_as_single_rays(scene: rb.Scene, cam: rb.Camera) -> rb.Frame:
    origins, directions = cam.rays()
    shuffled = np.random.default_rng(1).permutation(cam.width * cam.height)
    with rb.Renderer(scene, method="base") as renderer:
        frame = renderer.render(cam)
        single = renderer.trace(origins.reshape(-1, 3)[shuffled], directions.reshape(-1, 3)[shuffled])
    assert np.array_equal(frame.image.reshape(-1, 3)[shuffled], single.radiance)
    assert np.array_equal(frame.object_id.reshape(-1)[shuffled], single.object_id)
    return frame


@pytest.mark.parametrize("seed", range(12))
def test_random_scenes(seed: int) -> None:
    scene = random_scene(seed, objects=60)
    shown = 0
    for size in ((61, 47), (8, 8), (3, 200)):  # blocks cut at the edges of the picture
        cam = scene.camera.replace(width=size[0], height=size[1])
        shown += len(np.unique(assert_same_as_single_rays(scene, cam).object_id))
    assert shown > 8


@pytest.mark.parametrize("name", ["museum", "three_spheres", "sphereflake"])
def test_ready_scenes(name: str) -> None:
    scene = rb.scenes.sphereflake(3) if name == "sphereflake" else getattr(rb.scenes, name)()
    frame = assert_same_as_single_rays(scene, scene.camera.replace(width=150, height=110))
    assert frame.stats["rays"]["shadow"] > 1000


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("toward", [-1, 1])
def test_eyes_on_planes_of_boxes_looking_along_axes(axis: int, toward: int) -> None:
    """Direction components of both signs and zero in one block, and origins on the planes of boxes."""
    scene = rb.Scene(background=(0.1, 0.2, 0.3), ambient=1.0)
    rng = np.random.default_rng(axis)
    for corner in rng.integers(-6, 6, (80, 3)):
        scene.add(
            rb.Box(corner.tolist(), (corner + rng.integers(1, 3, 3)).tolist()), rb.Material(rng.random(3).tolist())
        )
    eye, target, up = np.zeros(3), np.zeros(3), np.zeros(3)
    eye[axis], target[axis], up[(axis + 1) % 3] = -8 * toward, 8 * toward, 1
    for size in (40, 41):  # with 41 there is a ray exactly along the axis
        cam = rb.Camera(eye.tolist(), target.tolist(), up=up.tolist(), fov=40, width=size, height=size)
        frame = assert_same_as_single_rays(scene, cam)
        assert len(np.unique(frame.object_id)) > 10


def test_views_of_nothing() -> None:
    scene = rb.Scene(background=(0.1, 0.2, 0.3))
    cam = rb.Camera((0, 0, 0), (0, 1, 0), width=20, height=20)
    assert (assert_same_as_single_rays(scene, cam).object_id == -1).all()
    scene.add(rb.Sphere((0, -5, 0), 1), rb.Material())
    assert (assert_same_as_single_rays(scene, cam).object_id == -1).all()
