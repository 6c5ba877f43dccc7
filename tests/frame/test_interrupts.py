"""Ctrl-C while something big is made or prepared: the call stops soon, and what was there before is as it was."""

import signal
import threading
import time
from collections.abc import Callable
from types import FrameType

import numpy as np
import pytest

import raybound as rb

pytestmark = pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs signal.setitimer")
SOON = 0.5  # seconds; generous: 0.02 to 0.06 were seen on an idle machine


def grid(n: int) -> tuple[np.ndarray, np.ndarray]:
    """A rough square of 2 (n - 1)^2 triangles."""
    x, y = np.meshgrid(np.arange(n, dtype=float), np.arange(n, dtype=float))
    points = np.stack([x, y, np.random.default_rng(0).random((n, n))], -1).reshape(-1, 3)
    i = np.arange(n * n).reshape(n, n)
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt


def seconds_late(call: Callable[[], object], after: float) -> float | None:
    """How long after the signal the call stopped; None if it was done before."""
    before = signal.signal(signal.SIGALRM, interrupt)
    start = time.perf_counter()
    signal.setitimer(signal.ITIMER_REAL, after)
    try:
        call()
    except KeyboardInterrupt:
        return time.perf_counter() - start - after
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    return None


def test_a_mesh_in_the_making_stops_soon() -> None:
    points, faces = grid(700)
    start = time.perf_counter()
    whole = rb.Mesh(points, faces)
    seconds = time.perf_counter() - start
    late = [seconds_late(lambda: rb.Mesh(points, faces), share * seconds) for share in (0.1, 0.3, 0.5, 0.7, 0.85)]
    stopped = [seconds for seconds in late if seconds is not None]
    assert len(stopped) >= 3
    assert max(stopped) < SOON
    assert rb.Mesh(points, faces) == whole


def scene_of_many(n: int) -> rb.Scene:
    scene = rb.Scene()
    ball, material = rb.Sphere(radius=0.01), rb.Material()
    rng = np.random.default_rng(1)
    with scene.edit():
        for place in rng.random((n, 3)):
            scene.add(ball, material, transform=rb.Transform.translate(*place))
    return scene


def test_a_scene_in_preparation_stops_soon_and_is_prepared_next_time() -> None:
    scene = scene_of_many(60_000)
    above = np.random.default_rng(2).random((50, 3)) + np.array((0, 0, 3))
    rays = (above, np.tile([0, 0, -1.0], (50, 1)))
    expected = scene.copy().intersect(*rays)
    start = time.perf_counter()
    scene.copy().intersect(*rays)
    seconds = time.perf_counter() - start
    stopped = 0
    for share in (0.1, 0.3, 0.6):
        copy = scene.copy()
        late = seconds_late(lambda copy=copy: copy.intersect(*rays), share * seconds)
        stopped += late is not None
        assert late is None or late < SOON
        assert np.array_equal(copy.intersect(*rays), expected)
        copy.objects[0].move(rb.Transform.translate(0, 0, 9))
        moved = seconds_late(lambda copy=copy: copy.intersect(*rays), 1e-4)
        assert moved is None or moved < SOON
        assert copy.intersect(*rays)["hit"].sum() > 0
    assert stopped >= 1


def test_a_thread_that_waits_for_another_one_stops_soon() -> None:
    scene = scene_of_many(60_000)
    rays = (np.zeros((1, 3)), np.ones((1, 3)))
    thread = threading.Thread(target=lambda: scene.intersect(*rays))
    thread.start()
    late = seconds_late(lambda: scene.intersect(*rays), 0.005)
    thread.join()
    assert late is None or late < SOON
    assert len(scene.intersect(*rays)) == 1


def test_a_signal_handler_may_not_ask_the_scene_that_is_being_prepared() -> None:
    scene = scene_of_many(60_000)
    rays = (np.zeros((1, 3)), np.ones((1, 3)))
    errors: list[str] = []

    def ask(_number: int, _frame: FrameType | None) -> None:
        try:
            scene.intersect(*rays)
        except RuntimeError as error:
            errors.append(str(error))

    before = signal.signal(signal.SIGALRM, ask)
    signal.setitimer(signal.ITIMER_REAL, 0.01)
    try:
        answer = scene.intersect(*rays)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert np.array_equal(answer, scene.intersect(*rays))
    assert errors in ([], ["Scene: it cannot be rendered or asked while it is being prepared for that"])
