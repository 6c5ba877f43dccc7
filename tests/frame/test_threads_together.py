"""Several Python threads: renderers at once, edits during renders, busy renderers, the interpreter left free."""

import threading
from collections.abc import Callable

import numpy as np
import pytest
from tests.support.random_scenes import random_scene

import raybound as rb

GENEROUS = 120.0  # seconds that no wait comes near: a hang fails instead of stopping the suite


def run_together(*calls: Callable[[], object]) -> list[object]:
    """Runs each call in its own thread, starting at once; returns results or raises the first exception."""
    results: list[object] = [None] * len(calls)
    gate = threading.Barrier(len(calls))

    def run(index: int, call: Callable[[], object]) -> None:
        gate.wait(GENEROUS)
        try:
            results[index] = call()
        except BaseException as error:
            results[index] = error

    threads = [threading.Thread(target=run, args=pair) for pair in enumerate(calls)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(GENEROUS)
        assert not thread.is_alive()
    for result in results:
        if isinstance(result, BaseException):
            raise result
    return results


class Paused:
    """A render that waits in its progress callback, so that a test can act in the middle of it."""

    def __init__(self, renderer: rb.Renderer, cam: rb.Camera) -> None:
        self.entered, self.go_on = threading.Event(), threading.Event()
        self.frame: rb.Frame | None = None
        self._thread = threading.Thread(target=self._render, args=(renderer, cam))

    def _render(self, renderer: rb.Renderer, cam: rb.Camera) -> None:
        self.frame = renderer.render(cam, progress=self._progress)

    def _progress(self, fraction: float) -> None:
        self.entered.set()
        assert self.go_on.wait(GENEROUS)

    def __enter__(self) -> "Paused":
        self._thread.start()
        assert self.entered.wait(GENEROUS)
        return self

    def __exit__(self, *_: object) -> None:
        self.go_on.set()
        self._thread.join(GENEROUS)
        assert not self._thread.is_alive()


def small(scene: rb.Scene, width: int = 120) -> rb.Camera:
    return scene.camera.replace(width=width, height=width * 3 // 4)


def test_two_renderers_of_one_scene_in_two_threads() -> None:
    scene = rb.scenes.three_spheres()
    cam = small(scene)
    alone = rb.render(scene, cam)
    frames = run_together(*[lambda: [rb.render(scene, cam, threads=2) for _ in range(10)]] * 3)
    assert all((frame.image == alone.image).all() for run in frames for frame in run)


def test_renderers_of_different_scenes_in_many_threads() -> None:
    scenes = [random_scene(seed, pixels=40) for seed in range(4)]
    alone = [rb.render(scene) for scene in scenes]
    together = run_together(*[lambda s=scene: [rb.render(s, threads=2) for _ in range(8)] for scene in scenes])
    for expected, run in zip(alone, together, strict=True):
        assert all(frame.image.tobytes() == expected.image.tobytes() for frame in run)


def test_threads_that_trace_and_intersect_during_renders() -> None:
    scene = random_scene(5, pixels=64)
    rng = np.random.default_rng(130)
    rays = rng.normal(size=(2, 2000, 3)) * 3
    expected, alone = scene.intersect(*rays), rb.render(scene)
    hits, frames = run_together(
        lambda: [scene.intersect(*rays) for _ in range(20)], lambda: [rb.render(scene) for _ in range(10)]
    )
    assert all((hit == expected).all() for hit in hits)
    assert all(frame.image.tobytes() == alone.image.tobytes() for frame in frames)


def test_a_frame_shows_the_scene_of_its_revision_while_another_thread_edits() -> None:
    """The ball has one of two colours in both channels at once: no frame may mix two revisions."""
    scene = rb.Scene(ambient=1.0)
    first = scene.add(rb.Sphere((-1, 0, 0), 0.8), rb.Material(0.0))
    second = scene.add(rb.Sphere((1, 0, 0), 0.8), rb.Material(0.0))
    cam = rb.Camera((0, -5, 0), (0, 0, 0), width=96, height=72)
    revisions, stop = {}, threading.Event()

    def edit() -> int:
        for step in range(1, 100_000):
            with scene.edit():
                first.material = rb.Material(step)
                second.material = rb.Material(step)
            revisions[scene.revision] = step
            if stop.is_set():
                break
        return step

    def render() -> int:
        try:
            with rb.Renderer(scene, threads=2) as renderer:
                frames = [renderer.render(cam) for _ in range(40)]
        finally:
            stop.set()
        for frame in frames:
            values = np.unique(frame.image[frame.object_id >= 0])
            assert len(values) == 1, values
            assert revisions.get(frame.revision, values[0]) == values[0]
        return len({frame.revision for frame in frames})

    steps, seen = run_together(edit, render)
    assert steps >= 10
    assert seen >= 5


def test_an_edit_during_a_render_takes_effect_at_the_next_frame() -> None:
    scene = rb.scenes.three_spheres()
    cam = small(scene, 640)
    with rb.Renderer(scene) as renderer:
        before = renderer.render(cam)
        with Paused(renderer, cam) as paused:
            scene["mirror"].remove()
            scene.background = (9, 9, 9)
        assert paused.frame is not None
        assert paused.frame.image.tobytes() == before.image.tobytes()
        assert paused.frame.revision == before.revision
        after = renderer.render(cam)
        assert after.revision == scene.revision
        assert (after.image == 9).all(axis=-1).sum() > (before.image == 9).all(axis=-1).sum() + 1000


@pytest.mark.parametrize(
    "call",
    [
        lambda r, cam: r.render(cam),
        lambda r, cam: r.trace([(0, 0, 0)], [(0, 0, 1)]),
        lambda r, cam: next(r.refine(cam)),
        lambda r, cam: next(r.sequence([cam])),
        lambda r, cam: r.clear(),
        lambda r, cam: r.close(),
    ],
    ids=["render", "trace", "refine", "sequence", "clear", "close"],
)
def test_a_busy_renderer_refuses_other_threads(call: Callable[[rb.Renderer, rb.Camera], object]) -> None:
    scene = rb.scenes.three_spheres()
    cam = small(scene)
    renderer = rb.Renderer(scene)
    with Paused(renderer, cam) as paused:
        with pytest.raises(RuntimeError, match="busy"):
            call(renderer, cam)
        assert renderer.stats["frames"] == 0  # reading is allowed
        assert "Renderer" in repr(renderer)
    assert paused.frame is not None
    assert renderer.render(cam).image.tobytes() == paused.frame.image.tobytes()


def test_render_from_its_own_progress_callback_is_refused() -> None:
    scene = rb.scenes.three_spheres()
    renderer = rb.Renderer(scene)
    with pytest.raises(RuntimeError, match="busy"):
        renderer.render(small(scene), progress=lambda fraction: renderer.render(small(scene)))
    assert renderer.render(small(scene)).error_bound.max() == 0


@pytest.mark.parametrize("what", ["render", "trace", "intersect"])
def test_other_threads_run_while_the_core_works(what: str) -> None:
    """Counted between the start and the end of long calls in this thread, which makes no Python calls meanwhile."""
    scene = rb.scenes.sphereflake(2)
    cam = small(scene, 500)
    origins, directions = (a.reshape(-1, 3) for a in cam.rays())
    renderer = rb.Renderer(scene, threads=1)
    calls = {
        "render": lambda: renderer.render(cam),
        "trace": lambda: renderer.trace(origins, directions),
        "intersect": lambda: scene.intersect(origins, directions),
    }
    count, stop = [0], threading.Event()

    def work() -> None:
        while not stop.is_set():
            count[0] += 1

    thread = threading.Thread(target=work)
    thread.start()
    try:
        progress = []
        for _ in range(5):
            before = count[0]
            calls[what]()
            progress.append(count[0] - before)
    finally:
        stop.set()
        thread.join(GENEROUS)
    assert max(progress) > 5000  # largest observed: hundreds of thousands; a held lock lets 0 to 100 through
