"""The museum's walk-through: the thesis's pace (7.2), and a way that is clear."""

from __future__ import annotations

import numpy as np
import pytest

import raybound as rb

LENGTH = 24.0  # metres of the hall, which 300 frames cross
FRAMES = 700  # more than one round


@pytest.fixture(scope="module")
def museum() -> rb.Scene:
    return rb.scenes.museum()


@pytest.fixture(scope="module")
def cameras() -> list[rb.Camera]:
    return rb.scenes.walkthrough(frames=FRAMES)


def eyes(cameras: list[rb.Camera]) -> np.ndarray:
    return np.array([camera.eye for camera in cameras])


def views(cameras: list[rb.Camera]) -> np.ndarray:
    ways = np.array([np.subtract(camera.target, camera.eye) for camera in cameras])
    return ways / np.linalg.norm(ways, axis=1, keepdims=True)


def test_the_hall_has_the_length_that_the_pace_is_for(museum: rb.Scene) -> None:
    floor = museum["floor"].bounds
    assert floor[1, 0] - floor[0, 0] >= LENGTH
    assert floor[1, 0] - floor[0, 0] < 1.3 * LENGTH


def test_pace(cameras: list[rb.Camera]) -> None:
    steps = np.linalg.norm(np.diff(eyes(cameras), axis=0), axis=1)
    cosines = (views(cameras)[1:] * views(cameras)[:-1]).sum(axis=1)
    turns = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    step, turn = LENGTH / 300, 360 / 150
    assert steps.max() <= step * 1.001
    assert turns.max() <= turn * 1.01
    busy = (steps > 0.9 * step) | (turns > 0.9 * turn)
    assert busy.mean() > 0.9  # never slower than it must be
    assert (steps > 0.9 * step).any()
    assert (turns > 0.9 * turn).any()


def test_the_first_camera_is_the_museums(museum: rb.Scene, cameras: list[rb.Camera]) -> None:
    assert cameras[0] == museum.camera
    assert {(camera.width, camera.height, camera.fov) for camera in cameras} == {(1200, 900, 55.0)}


def test_lengths() -> None:
    assert len(rb.scenes.walkthrough()) == 60
    assert rb.scenes.walkthrough(frames=5) == rb.scenes.walkthrough(60)[:5]
    assert len(rb.scenes.walkthrough(1)) == 1
    with pytest.raises(ValueError, match="walkthrough: frames must be >= 1, got 0"):
        rb.scenes.walkthrough(0)
    with pytest.raises(TypeError, match=r"walkthrough: frames must be an int, got 2\.5"):
        rb.scenes.walkthrough(2.5)


def test_a_long_walk_goes_round(cameras: list[rb.Camera]) -> None:
    returns = [index for index, camera in enumerate(cameras[1:], start=1) if camera == cameras[0]]
    assert returns
    assert cameras[returns[0] + 1] == cameras[1]
    assert np.ptp(eyes(cameras)[:, 0]) > 0.5 * LENGTH


def test_no_object_lies_between_consecutive_eyes(museum: rb.Scene, cameras: list[rb.Camera]) -> None:
    places = eyes(cameras)
    moved = np.flatnonzero(np.linalg.norm(np.diff(places, axis=0), axis=1) > 0)
    assert len(moved) > 200
    starts, ends = places[moved], places[moved + 1]
    for a, b in ((starts, ends), (ends, starts)):
        hits = museum.intersect(a, b - a)
        assert (hits["t"] > 1).all()
        assert not museum.occluded(a, b).any()


def test_eyes_keep_clear_of_objects(museum: rb.Scene, cameras: list[rb.Camera]) -> None:
    places = np.unique(eyes(cameras), axis=0)
    rng = np.random.default_rng(3)
    directions = rng.normal(size=(300, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    solid = {item.id for item in museum if item.shape._native.is_solid}
    for place in places[::4]:
        hits = museum.intersect(np.broadcast_to(place, directions.shape), directions)
        seen = hits["hit"]
        assert seen.mean() > 0.9  # indoors
        assert hits["t"][seen].min() > 0.15
        # Inside a solid, the first hit would be its far side, whose outward normal points along the ray.
        facing = (hits["normal"] * directions).sum(axis=1)[seen]
        is_solid = np.array([id in solid for id in hits["object_id"][seen]])
        assert (facing[is_solid] < 1e-3).all()
        assert is_solid.any()


def test_every_frame_shows_something(museum: rb.Scene, cameras: list[rb.Camera]) -> None:
    small = [camera.replace(width=40, height=30) for camera in cameras[:640:20]]
    with rb.Renderer(museum) as renderer:
        for frame in renderer.sequence(small):
            assert 30 < frame.to_srgb().mean() < 220
            assert (frame.object_id >= 0).mean() > 0.7
            assert len(np.unique(frame.object_id)) > 8
