"""Progress, and frames that end early: by an exception from the callback, or by Ctrl-C."""

import os
import signal
import threading

import numpy as np
import pytest
from tests.support.support_light import core_render

import raybound as rb

SLOW = {"width": 560, "height": 420}


class StopHereError(Exception):
    pass


def slow_scene() -> rb.Scene:
    """Takes a good part of a second on one core, so that progress is reported many times."""
    scene = rb.scenes.three_spheres()
    for item in scene.objects:
        item.material = item.material.replace(reflect=0.5, transmit=0.5)
    scene.camera = scene.camera.replace(**SLOW)
    return scene


DEPTH = 8


def test_progress_is_monotone_and_ends_at_one() -> None:
    fractions: list[float] = []
    scene = slow_scene()
    with rb.Renderer(scene, max_depth=DEPTH, threads=1) as renderer:
        renderer.render(progress=fractions.append)
    assert len(fractions) >= 5
    assert fractions[0] >= 0
    assert fractions[-1] == 1.0
    assert (np.diff(fractions) >= 0).all()
    assert len(set(fractions)) >= 4


def test_progress_of_a_small_frame_still_ends_at_one() -> None:
    fractions: list[float] = []
    scene = rb.scenes.three_spheres()
    rb.Renderer(scene).render(scene.camera.replace(width=8, height=8), progress=fractions.append)
    assert fractions[-1] == 1.0


def test_progress_of_a_sequence_runs_over_all_frames() -> None:
    fractions: list[float] = []
    scene = rb.scenes.three_spheres()
    cameras = [scene.camera.replace(width=16, height=12).orbit(10 * k, 0) for k in range(4)]
    frames = list(rb.Renderer(scene).sequence(cameras, progress=fractions.append))
    assert len(frames) == 4
    assert fractions[-1] == 1.0
    assert (np.diff(fractions) >= 0).all()
    assert {0.25, 0.5, 0.75} <= set(fractions)


def check_partial(renderer: rb.Renderer, scene: rb.Scene, complete: np.ndarray) -> None:
    partial = renderer.partial_frame
    assert partial is not None
    traced = partial.error_bound == 0
    assert np.isinf(partial.error_bound[~traced]).all()
    assert 0 < (~traced).sum()
    assert (partial.image[traced] == complete[traced]).all()
    assert partial.camera == scene.camera
    after = renderer.render()
    assert (after.image == complete).all()
    assert not after.error_bound.any()
    assert renderer.partial_frame is None


@pytest.mark.parametrize("at", [1, 3, 6])
def test_an_exception_from_progress_cancels_and_leaves_a_partial_frame(at: int) -> None:
    scene = slow_scene()
    complete = core_render(scene, scene.camera, max_depth=DEPTH).image
    calls: list[float] = []

    def stop(fraction: float) -> None:
        calls.append(fraction)
        if len(calls) == at:
            raise StopHereError("enough")

    with rb.Renderer(scene, max_depth=DEPTH, threads=1) as renderer:
        with pytest.raises(StopHereError, match="enough"):
            renderer.render(progress=stop)
        assert len(calls) == at
        assert calls[-1] < 1
        assert renderer.stats["frames"] == 0
        check_partial(renderer, scene, complete)


def test_an_exception_at_the_very_end_leaves_a_complete_partial_frame() -> None:
    scene = rb.scenes.three_spheres()
    cam = scene.camera.replace(width=8, height=8)

    def stop(fraction: float) -> None:
        if fraction == 1:
            raise StopHereError

    with rb.Renderer(scene) as renderer:
        with pytest.raises(StopHereError):
            renderer.render(cam, progress=stop)
        assert renderer.partial_frame is not None
        assert not renderer.partial_frame.error_bound.any()
        assert renderer.render(cam).image.tobytes() == renderer.render(cam).image.tobytes()


def interrupted_render(renderer: rb.Renderer, after: int, limit: int) -> list[float]:
    """Renders while a thread sends SIGINT after some progress calls; fails after `limit` more of them."""
    calls: list[float] = []
    enough = threading.Event()

    def progress(fraction: float) -> None:
        calls.append(fraction)
        if len(calls) >= after:
            enough.set()
        if len(calls) > after + limit:
            raise StopHereError("the interrupt was not noticed")

    def interrupt() -> None:
        if enough.wait(120):
            os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            renderer.render(progress=progress)
    finally:
        thread.join()
    return calls


def test_ctrl_c_stops_a_render_within_a_few_progress_calls() -> None:
    scene = slow_scene()
    complete = core_render(scene, scene.camera, max_depth=DEPTH).image
    with rb.Renderer(scene, max_depth=DEPTH, threads=1) as renderer:
        calls = interrupted_render(renderer, after=2, limit=20)  # largest observed: 1 more call
        assert calls[-1] < 1
        check_partial(renderer, scene, complete)


def test_ctrl_c_stops_a_render_without_a_progress_callback() -> None:
    scene = slow_scene()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    with rb.Renderer(scene, max_depth=18) as renderer:  # would take minutes
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            renderer.render()
        timer.join()
        assert renderer.partial_frame is not None
        assert np.isinf(renderer.partial_frame.error_bound).any()


def test_ctrl_c_stops_trace() -> None:
    scene = slow_scene()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    origins, directions = (a.reshape(-1, 3) for a in scene.camera.rays())
    with rb.Renderer(scene, max_depth=18) as renderer:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            renderer.trace(origins, directions)
        timer.join()
        assert renderer.trace([(0, 0, 9)], [(0, 0, 1)]).object_id.tolist() == [-1]


def test_a_cancelled_refine_leaves_the_renderer_usable() -> None:
    scene = rb.scenes.three_spheres()
    cam = scene.camera.replace(width=40, height=30)
    with rb.Renderer(scene) as renderer:
        frames = renderer.refine(cam)
        next(frames)
        frames.close()
        assert not renderer.render(cam).error_bound.any()


def test_exceptions_of_progress_keep_their_type_and_traceback() -> None:
    scene = rb.scenes.three_spheres()

    def bad(fraction: float) -> None:
        raise ZeroDivisionError("from the callback")

    with pytest.raises(ZeroDivisionError, match="from the callback") as caught:
        rb.Renderer(scene).render(scene.camera.replace(width=8, height=8), progress=bad)
    assert any(entry.name == "bad" for entry in caught.traceback)
