"""Renderers and threads: Ctrl-C, refusing a second call at once, sharing a scene, letting others run."""

from __future__ import annotations

import os
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest
from tests.python.samples import ball_scene, small_scene

import raybound as rb


def test_ctrl_c_stops_a_frame_and_its_threads_promptly() -> None:
    scene = small_scene()
    camera = scene.camera.replace(width=3200, height=2400) if scene.camera else None
    renderer = rb.Renderer(scene, threads=1)
    begun, sent, fractions = threading.Event(), [0], [0.0]

    def watch(fraction: float) -> None:
        fractions.append(fraction)
        begun.set()

    def interrupt() -> None:
        assert begun.wait(30)
        time.sleep(0.05)
        sent[0] = len(fractions)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        renderer.render(camera, progress=watch)
    thread.join()
    assert len(fractions) - sent[0] <= 2  # one look may be under way at the signal, the next one raises
    assert fractions[-1] < 0.5
    partial = renderer.partial_frame
    assert partial is not None
    assert 0.5 < np.isinf(partial.error_bound).mean() < 1  # its threads stopped too, long before the end
    assert renderer.render().error_bound.max() == 0


def test_a_busy_renderer_refuses_other_threads() -> None:
    renderer = rb.Renderer(ball_scene())
    calls: dict[str, Any] = {
        "render": renderer.render,
        "trace": lambda: renderer.trace([(0, 0, 9)], [(0, 0, -1)]),
        "clear": renderer.clear,
        "close": renderer.close,
        "refine": lambda: next(renderer.refine()),
    }
    errors: dict[str, str] = {}

    def try_all(fraction: float) -> None:
        for name, call in calls.items():
            thread = threading.Thread(target=attempt, args=(name, call))
            thread.start()
            thread.join()

    def attempt(name: str, call: Any) -> None:
        try:
            call()
        except RuntimeError as error:
            errors[name] = str(error)

    renderer.render(progress=try_all)
    assert errors == {name: f"Renderer: busy, {name} was called while another call is running" for name in calls}
    assert renderer.render().error_bound.max() == 0


def test_two_renderers_in_two_threads_share_a_scene() -> None:
    scene = small_scene()
    expected = rb.render(scene)
    frames: list[rb.Frame] = []
    threads = [threading.Thread(target=lambda: frames.append(rb.render(scene))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert len(frames) == 4
    assert all(frame == expected for frame in frames)


def test_rendering_lets_other_threads_run() -> None:
    ticks: list[float] = []
    stop = threading.Event()

    def tick() -> None:
        while not stop.wait(0.005):
            ticks.append(time.perf_counter())

    scene = small_scene()
    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    rb.render(scene, scene.camera.replace(width=1600, height=1200) if scene.camera else None)
    end = time.perf_counter()
    stop.set()
    thread.join()
    assert len([t for t in ticks if begin < t < end]) >= 5
