"""orbit, dolly, pan and look against closed forms in float64."""

import numpy as np
import pytest
from tests.support.support_light import f32, unit

import raybound as rb

LIMIT = 1e-5  # of lengths of about 10; largest observed 1.9e-6


def basis(cam: rb.Camera) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    forward = unit(f32(cam.target) - f32(cam.eye))
    right = unit(np.cross(forward, f32(cam.up)))
    return forward, right, np.cross(right, forward)


def turned(v: np.ndarray, axis: np.ndarray, degrees: float) -> np.ndarray:
    """Rodrigues's formula."""
    a, k = np.radians(degrees), unit(axis)
    return v * np.cos(a) + np.cross(k, v) * np.sin(a) + k * (k @ v) * (1 - np.cos(a))


def cameras(n: int = 60) -> list[rb.Camera]:
    rng = np.random.default_rng(150)
    made = []
    while len(made) < n:
        eye, target, up = rng.normal(size=(3, 3)) * [[4], [4], [1]]
        if abs(unit(target - eye) @ unit(up)) < 0.8:
            made.append(rb.Camera(eye, target, up=up, fov=50, width=32, height=20))
    return made


def assert_camera(cam: rb.Camera, eye: np.ndarray, target: np.ndarray, before: rb.Camera) -> None:
    assert np.abs(np.subtract(cam.eye, eye)).max() < LIMIT
    assert np.abs(np.subtract(cam.target, target)).max() < LIMIT
    assert (cam.up, cam.fov, cam.width, cam.height) == (before.up, before.fov, before.width, before.height)


@pytest.mark.parametrize("distance", [0.0, 1.5, -2.25])
def test_dolly_moves_along_the_view(distance: float) -> None:
    for cam in cameras():
        forward, _, _ = basis(cam)
        step = forward * distance
        assert_camera(cam.dolly(distance), cam.eye + step, cam.target + step, cam)


@pytest.mark.parametrize(("right", "up"), [(0, 0), (1.5, 0), (0, -2), (-0.5, 0.75)])
def test_pan_moves_within_the_picture(right: float, up: float) -> None:
    for cam in cameras():
        _, to_right, upward = basis(cam)
        step = to_right * right + upward * up
        assert_camera(cam.pan(right, up), cam.eye + step, cam.target + step, cam)


@pytest.mark.parametrize(("azimuth", "elevation"), [(0, 0), (30, 0), (0, 20), (-75, -15), (180, 10)])
def test_orbit_turns_the_eye_around_the_target(azimuth: float, elevation: float) -> None:
    for cam in cameras():
        _, right, _ = basis(cam)
        arm = f32(cam.eye) - f32(cam.target)
        raised = turned(arm, right, -elevation)
        if np.linalg.norm(np.cross(unit(raised), unit(f32(cam.up)))) < 0.05:
            continue  # over the pole
        eye = f32(cam.target) + turned(raised, f32(cam.up), azimuth)
        assert_camera(cam.orbit(azimuth, elevation), eye, f32(cam.target), cam)


@pytest.mark.parametrize(("yaw", "pitch"), [(0, 0), (25, 0), (0, 20), (-60, -10)])
def test_look_turns_the_view_in_place(yaw: float, pitch: float) -> None:
    for cam in cameras():
        _, right, _ = basis(cam)
        arm = turned(f32(cam.target) - f32(cam.eye), right, pitch)
        if np.linalg.norm(np.cross(unit(arm), unit(f32(cam.up)))) < 0.05:
            continue
        target = f32(cam.eye) + turned(arm, f32(cam.up), yaw)
        assert_camera(cam.look(yaw, pitch), f32(cam.eye), target, cam)


CAM = rb.Camera((0, -5, 0), (0, 0, 0), width=8, height=8)


def test_the_directions_of_the_moves_in_plain_words() -> None:
    """Looking along y with z up: right is x."""
    assert CAM.pan(1, 2).eye == pytest.approx((1, -5, 2))
    assert CAM.dolly(1).eye == pytest.approx((0, -4, 0))
    assert CAM.dolly(1).target == pytest.approx((0, 1, 0))
    assert CAM.orbit(90, 0).eye == pytest.approx((5, 0, 0), abs=1e-6)  # counter-clockwise from above
    assert CAM.orbit(0, 30).eye == pytest.approx((0, -5 * np.cos(np.pi / 6), 2.5))  # upward
    assert CAM.look(90, 0).target == pytest.approx((-5, -5, 0), abs=1e-6)  # to the left
    assert CAM.look(0, 30).target[2] == pytest.approx(2.5)  # upward


def test_orbits_keep_the_distance_and_come_round() -> None:
    cam = rb.Camera((3, -4, 2), (1, 1, 0.5), width=8, height=8)
    distance = np.linalg.norm(np.subtract(cam.eye, cam.target))
    round_trip = cam
    for _ in range(36):
        round_trip = round_trip.orbit(10, 0)
        assert np.linalg.norm(np.subtract(round_trip.eye, round_trip.target)) == pytest.approx(distance, rel=1e-5)
    assert np.subtract(round_trip.eye, cam.eye) == pytest.approx(np.zeros(3), abs=LIMIT)


def test_moves_make_new_cameras() -> None:
    before = repr(CAM)
    for moved in (CAM.dolly(1), CAM.pan(1, 0), CAM.orbit(5, 0), CAM.look(5, 0), CAM.replace(fov=20)):
        assert moved != CAM
    assert repr(CAM) == before


def test_a_look_straight_up_is_refused() -> None:
    with pytest.raises(ValueError, match="parallel"):
        CAM.look(0, 90)
    with pytest.raises(ValueError, match="parallel"):
        CAM.orbit(0, 90)
