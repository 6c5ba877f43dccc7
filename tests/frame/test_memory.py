"""Renders and edits leave no memory behind. Each case runs in a process of its own, whose heap holds nothing else."""

import gc
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.support.random_scenes import random_scene

import raybound as rb

ROOT = Path(__file__).parents[2]
STATM = Path("/proc/self/statm")
PAGE = 4096
SLACK = 4 * 2**20  # bytes; largest observed 0.06 MiB. One frame of 96 x 72 has 0.25 MiB: 1000 of them make 250

Step = Callable[[int], object]


def resident() -> int:
    gc.collect()
    return int(STATM.read_text().split()[1]) * PAGE


def growth(work: Step, warm_up: int, count: int) -> int:
    for step in range(warm_up):
        work(step)
    before = resident()
    for step in range(count):
        work(step)
    return resident() - before


def view() -> tuple[rb.Scene, rb.Camera]:
    scene = rb.scenes.three_spheres()
    return scene, scene.camera.replace(width=96, height=72)


def thousand_renders() -> int:
    scene, cam = view()
    renderer = rb.Renderer(scene)
    return growth(lambda step: renderer.render(cam), 100, 1000)


def edits_with_renders() -> int:
    scene = rb.scenes.sphereflake(2)
    cam = scene.camera.replace(width=24, height=18)
    ball, renderer = scene.objects[1], rb.Renderer(scene)

    def edit(step: int) -> None:
        ball.move(rb.Transform.translate(0, 0, 1e-3 * (-1) ** step))
        scene.add(rb.Sphere((0, 0, 5 + step), 0.1), rb.Material()).remove()
        renderer.render(cam)

    return growth(edit, 100, 300)


def new_scenes() -> int:
    def make(step: int) -> None:
        rb.render(random_scene(step % 10, pixels=24)).explain(3, 3)

    return growth(make, 40, 150)


def cancelled_renders() -> int:
    scene, cam = view()
    renderer = rb.Renderer(scene)

    def stop(fraction: float) -> None:
        raise ZeroDivisionError

    def cancel(step: int) -> None:
        with pytest.raises(ZeroDivisionError):
            renderer.render(cam, progress=stop)
        next(renderer.refine(cam))

    return growth(cancel, 60, 300)


def kept_frames() -> int:
    scene, cam = view()
    renderer, kept = rb.Renderer(scene), []
    return growth(lambda step: kept.append(renderer.render(cam)), 5, 100)


def growth_in_new_process(case: Callable[[], int]) -> int:
    code = f"from tests.frame import test_memory; print(test_memory.{case.__name__}())"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return int(done.stdout)


needs_linux = pytest.mark.skipif(not STATM.exists(), reason="needs /proc")


@needs_linux
@pytest.mark.parametrize("case", [thousand_renders, edits_with_renders, new_scenes, cancelled_renders])
def test_memory_does_not_grow(case: Callable[[], int]) -> None:
    assert growth_in_new_process(case) < SLACK


@needs_linux
def test_growth_is_seen_where_frames_are_kept() -> None:
    assert growth_in_new_process(kept_frames) > 3 * SLACK
