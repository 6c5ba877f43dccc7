"""The rays of a camera against the pinhole's closed form, and that they are what is traced."""

import numpy as np
import pytest
from tests.support.random_scenes import random_scene
from tests.support.support_light import EMITTER_AMBIENT, emitter, f32, unit

import raybound as rb

# Of a component of a unit direction, times 1 + the picture's half width at distance 1; largest observed 1.1e-7.
LIMIT = 2e-7


def exact_directions(cam: rb.Camera) -> np.ndarray:
    forward = unit(f32(cam.target) - f32(cam.eye))
    right = unit(np.cross(forward, f32(cam.up)))
    up = np.cross(right, forward)
    half = np.tan(np.radians(float(f32(cam.fov))) / 2)
    x = (2 * (np.arange(cam.width) + 0.5) / cam.width - 1) * half * cam.width / cam.height
    y = (1 - 2 * (np.arange(cam.height) + 0.5) / cam.height) * half
    return unit(forward + right * x[None, :, None] + up * y[:, None, None])


def random_camera(rng: np.random.Generator) -> rb.Camera:
    eye, target = rng.normal(size=(2, 3)) * 10 ** rng.uniform(-1, 2)
    width, height = (int(n) for n in rng.integers(1, 40, 2))
    return rb.Camera(eye, target, up=rng.normal(size=3), fov=float(rng.uniform(1, 150)), width=width, height=height)


def test_rays_pass_through_the_pixels_centres() -> None:
    rng = np.random.default_rng(140)
    for _ in range(100):
        cam = random_camera(rng)
        origins, directions = cam.rays()
        assert origins.shape == directions.shape == (cam.height, cam.width, 3)
        assert origins.dtype == directions.dtype == np.float32
        assert (origins == np.float32(cam.eye)).all()
        half = np.tan(np.radians(cam.fov) / 2) * max(1, cam.width / cam.height)
        assert np.abs(unit(directions.astype(float)) - exact_directions(cam)).max() < LIMIT * (1 + half)


def test_pixel_zero_is_top_left_and_x_grows_to_the_right() -> None:
    cam = rb.Camera((0, -5, 0), (0, 0, 0), fov=90, width=4, height=2)
    _, d = cam.rays()
    d = d / d[..., 1:2]
    assert d[0, 0] == pytest.approx([-1.5, 1, 0.5])
    assert d[0, 3] == pytest.approx([1.5, 1, 0.5])
    assert d[1, 0] == pytest.approx([-1.5, 1, -0.5])


def test_fov_is_vertical_whatever_the_width() -> None:
    for width in (1, 7, 100):
        cam = rb.Camera((0, -5, 0), (0, 0, 0), fov=60, width=width, height=101)
        _, d = cam.rays()
        top = d[0, width // 2]
        assert top[2] / top[1] == pytest.approx(np.tan(np.radians(30)) * 100 / 101, rel=1e-5)


def test_pictures_show_left_and_right_and_up_and_down() -> None:
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    for k, (x, z) in enumerate([(-1, 1), (1, 1), (-1, -1), (1, -1)]):
        scene.add(rb.Sphere((x, 0, z), 0.8), emitter())
        assert scene.objects[k].id == k
    ids = rb.render(scene, rb.Camera((0, -5, 0), (0, 0, 0), fov=50, width=40, height=40)).object_id
    assert [ids[10, 10], ids[10, 30], ids[30, 10], ids[30, 30]] == [0, 1, 2, 3]


@pytest.mark.parametrize("seed", range(8))
def test_tracing_the_rays_is_rendering_the_picture(seed: int) -> None:
    scene = random_scene(seed)
    rng = np.random.default_rng([141, seed])
    cameras = [scene.camera, scene.camera.orbit(40, 10), random_camera(rng).replace(width=30, height=20)]
    seen = 0
    with rb.Renderer(scene, max_depth=6, method="base") as renderer:
        for cam in cameras:
            frame = renderer.render(cam)
            traced = renderer.trace(*(a.reshape(-1, 3) for a in cam.rays()))
            assert traced.radiance.tobytes() == frame.image.tobytes()
            assert (traced.object_id == frame.object_id.ravel()).all()
            assert (traced.path == frame.path.ravel()).all()
            assert not traced.error_bound.any()
            assert not frame.error_bound.any()
            seen += len(np.unique(frame.object_id))
    assert seen >= 8


def test_depth_is_the_distance_along_the_ray() -> None:
    scene = rb.Scene()
    scene.add(rb.Sphere((0, 0, 0), 1.0), emitter())
    cam = rb.Camera((0, -5, 0), (0, 0, 0), fov=30, width=64, height=48)
    frame = rb.render(scene, cam, method="base")
    d = exact_directions(cam)
    along = -(d @ f32(cam.eye))
    inside = along**2 - 24
    seen = frame.object_id == 0
    assert seen.sum() > 500
    assert np.isinf(frame.depth[~seen]).all()
    clear = seen & (inside > 1e-3)
    exact = along - np.sqrt(np.maximum(inside, 0))
    assert np.abs(frame.depth - exact, where=clear, out=np.zeros_like(exact)).max() < 3e-5  # largest observed 3.6e-6
    assert (frame.path == np.where(seen, rb.Path.TRACED, rb.Path.BACKGROUND)).all()


@pytest.mark.parametrize("size", [(1, 1), (1, 65), (129, 1), (33, 31)])
def test_every_pixel_of_odd_sizes_is_traced(size: tuple) -> None:
    scene = rb.Scene(background=(3, 2, 1))
    frame = rb.render(scene, rb.Camera((0, 0, 0), (1, 0, 0), width=size[0], height=size[1]), method="base")
    assert frame.image.shape == (size[1], size[0], 3)
    assert (frame.image == (3, 2, 1)).all()
    assert frame.stats["rays"]["eye"] == size[0] * size[1]
    assert frame.stats["pixels"]["BACKGROUND"] == size[0] * size[1]
