"""The camera: its rays, its moves and its errors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from tests.python.samples import CAMERA, ball_scene

import raybound as rb

STRAIGHT = rb.Camera((0, -5, 0), (0, 0, 0), fov=60, width=8, height=6)


def direction(camera: rb.Camera) -> np.ndarray:
    way = np.subtract(camera.target, camera.eye)
    return way / np.linalg.norm(way)


def test_fields_are_plain_numbers() -> None:
    assert all(type(x) is float for vector in (CAMERA.eye, CAMERA.target, CAMERA.up) for x in vector)
    assert (type(CAMERA.fov), type(CAMERA.width), type(CAMERA.height)) == (float, int, int)
    assert CAMERA.eye == tuple(np.float32((0.1, -7, 3)).tolist())


def test_rays_go_through_pixel_centres() -> None:
    origins, directions = STRAIGHT.rays()
    assert origins.shape == directions.shape == (6, 8, 3)
    assert origins.dtype == directions.dtype == np.float32
    assert (origins == np.float32(STRAIGHT.eye)).all()
    slopes = directions / directions[..., 1:2]
    half = np.tan(np.radians(30))
    x = (np.arange(8) + 0.5 - 4) / 3 * half
    y = -(np.arange(6) + 0.5 - 3) / 3 * half
    np.testing.assert_allclose(slopes[..., 0], np.broadcast_to(x, (6, 8)), rtol=1e-5)
    np.testing.assert_allclose(slopes[..., 2], np.broadcast_to(y[:, None], (6, 8)), rtol=1e-5)


def test_pixel_0_0_is_top_left_and_x_grows_to_the_right() -> None:
    _, directions = STRAIGHT.rays()
    assert directions[0, 0, 0] < 0 < directions[0, -1, 0]
    assert directions[-1, 0, 2] < 0 < directions[0, 0, 2]


def test_rays_are_those_that_are_traced() -> None:
    scene = ball_scene(40, 30)
    frame = rb.render(scene, method="base")
    origins, directions = frame.camera.rays()
    found = rb.Renderer(scene).trace(origins.reshape(-1, 3), directions.reshape(-1, 3))
    assert found.radiance.reshape(frame.image.shape).tobytes() == frame.image.tobytes()
    assert found.object_id.reshape(frame.object_id.shape).tobytes() == frame.object_id.tobytes()
    assert found.path.reshape(frame.path.shape).tobytes() == frame.path.tobytes()
    hits = scene.intersect(origins.reshape(-1, 3), directions.reshape(-1, 3))
    assert (hits["object_id"].reshape(frame.object_id.shape) == frame.object_id).all()
    lengths = np.linalg.norm(directions.astype(float), axis=2)
    np.testing.assert_allclose(hits["t"].reshape(frame.depth.shape) * lengths, frame.depth, rtol=1e-5)


def test_scaling_up_does_not_change_the_rays() -> None:
    camera = rb.Camera((0, -5, 1), (0, 0, 0), width=9, height=7)
    longer = camera.replace(up=(0, 0, 100))
    np.testing.assert_allclose(camera.rays()[1], longer.rays()[1], atol=1e-6)
    assert camera.rays()[0] is not camera.rays()[0]


def test_orbit_keeps_the_distance_and_the_target() -> None:
    camera = STRAIGHT
    for azimuth, elevation in ((30, 0), (0, 20), (-120, -40), (720, 0)):
        moved = camera.orbit(azimuth, elevation)
        assert moved.target == camera.target
        np.testing.assert_allclose(np.linalg.norm(moved.eye), 5, rtol=1e-6)
        np.testing.assert_allclose(moved.eye[2], 5 * np.sin(np.radians(elevation)), atol=1e-5)
    np.testing.assert_allclose(camera.orbit(90, 0).eye, (5, 0, 0), atol=1e-6)
    np.testing.assert_allclose(camera.orbit(30, 10).orbit(0, -10).orbit(-30, 0).eye, camera.eye, atol=1e-5)


def test_dolly_and_pan_move_the_target_along() -> None:
    ahead = STRAIGHT.dolly(2)
    np.testing.assert_allclose((ahead.eye, ahead.target), ((0, -3, 0), (0, 2, 0)), atol=1e-6)
    aside = STRAIGHT.pan(1, 2)
    np.testing.assert_allclose((aside.eye, aside.target), ((1, -5, 2), (1, 0, 2)), atol=1e-6)


def test_look_turns_in_place() -> None:
    for yaw, pitch in ((10, 0), (0, 10), (-30, 20)):
        turned = STRAIGHT.look(yaw, pitch)
        assert turned.eye == STRAIGHT.eye
        cosine = np.cos(np.radians(yaw)) * np.cos(np.radians(pitch))
        np.testing.assert_allclose(direction(turned) @ direction(STRAIGHT), cosine, rtol=1e-5)
        np.testing.assert_allclose(direction(turned)[2], np.sin(np.radians(pitch)), atol=1e-6)


MOVES: list[tuple[Callable[[], object], type[Exception], str]] = [
    (lambda: STRAIGHT.orbit(0, 90), ValueError, "Camera: up must not be parallel to the view"),
    (lambda: STRAIGHT.look(0, -90), ValueError, "Camera: up must not be parallel to the view"),
    (lambda: STRAIGHT.orbit(float("nan"), 0), ValueError, "Camera.orbit: azimuth must be finite, got nan"),
    (lambda: STRAIGHT.orbit(0, "up"), TypeError, "Camera.orbit: elevation must be a number, got 'up'"),
    (lambda: STRAIGHT.dolly(None), TypeError, "Camera.dolly: distance must be a number, got None"),
    (lambda: STRAIGHT.dolly(1e39), ValueError, "Camera: eye must be finite"),
    (lambda: STRAIGHT.pan(1, float("inf")), ValueError, "Camera.pan: up must be finite, got inf"),
    (lambda: STRAIGHT.look([1], 0), ValueError, "Camera.look: yaw must be a number, got [1]"),
    (lambda: STRAIGHT.replace(fov=0), ValueError, "Camera: fov must be > 0, got 0"),
    (lambda: STRAIGHT.replace(fow=10), TypeError, "fow"),
]


@pytest.mark.parametrize(("move", "error", "words"), MOVES)
def test_bad_moves(move: Callable[[], object], error: type[Exception], words: str) -> None:
    before = repr(STRAIGHT)
    with pytest.raises(error) as caught:
        move()
    assert words in str(caught.value)
    assert repr(STRAIGHT) == before


def test_extreme_pictures() -> None:
    for width, height in ((1, 1), (65536, 1), (1, 3000)):
        camera = STRAIGHT.replace(width=width, height=height)
        frame = rb.render(rb.Scene(background=0.5), camera)
        assert frame.image.shape == (height, width, 3)
        assert (frame.image == 0.5).all()
