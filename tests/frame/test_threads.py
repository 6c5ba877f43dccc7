"""The picture and the counts do not depend on the number of threads."""

import numpy as np
import pytest
from tests.support.random_scenes import random_scene
from tests.support.support_light import assert_same_picture, core_render

import raybound as rb

THREADS = (1, 2, 3, 7)
ARRAYS = ("image", "error_bound", "path", "reason", "object_id", "depth")


def comparable(stats: dict) -> dict:
    return {key: value for key, value in stats.items() if key not in ("seconds", "seconds_by_phase", "threads")}


def assert_equal_frames(a: rb.Frame, b: rb.Frame, what: object) -> None:
    for name in ARRAYS:
        assert getattr(a, name).tobytes() == getattr(b, name).tobytes(), (name, what)
    assert comparable(a.stats) == comparable(b.stats), what


@pytest.mark.parametrize("name", ["museum", "three_spheres", "random"])
def test_threads_make_the_same_bytes(name: str) -> None:
    scene = random_scene(7) if name == "random" else getattr(rb.scenes, name)()
    cam = scene.camera.replace(width=203, height=97)  # no multiple of a tile
    frames = {n: rb.render(scene, cam, threads=n, max_depth=6) for n in THREADS}
    assert frames[1].stats["rays"]["reflected"] > 100
    for n in THREADS[1:]:
        assert_equal_frames(frames[1], frames[n], n)
        assert frames[n].stats["threads"] == n


def test_threads_zero_uses_the_cores_and_makes_the_same_bytes() -> None:
    scene = rb.scenes.three_spheres()
    cam = scene.camera.replace(width=120, height=90)
    assert_equal_frames(rb.render(scene, cam, threads=0), rb.render(scene, cam, threads=1), "zero")


def test_threads_in_many_repetitions() -> None:
    """What is shared shows up as a difference sooner or later."""
    scene = random_scene(11, pixels=40)
    first = core_render(scene, scene.camera, threads=1)
    for repetition in range(60):
        picture = core_render(scene, scene.camera, threads=2 + repetition % 6)
        assert_same_picture(first, picture, f"repetition {repetition}")


def test_threads_for_pictures_smaller_than_a_tile() -> None:
    scene = rb.scenes.three_spheres()
    for width, height in ((1, 1), (1, 70), (33, 1), (32, 32), (31, 33)):
        cam = scene.camera.replace(width=width, height=height)
        for method in ("exact", "base"):
            frames = [rb.render(scene, cam, threads=n, method=method) for n in THREADS]
            for frame in frames[1:]:
                assert_equal_frames(frames[0], frame, (method, width, height))
        assert frames[0].stats["rays"]["eye"] == width * height


@pytest.mark.parametrize("count", [0, 1, 255, 256, 257, 5000])
def test_threads_of_trace(count: int) -> None:
    scene = random_scene(13)
    rng = np.random.default_rng(120)
    origins, directions = rng.normal(size=(count, 3)) * 3, rng.normal(size=(count, 3))
    results = []
    for n in THREADS:
        with rb.Renderer(scene, threads=n) as renderer:
            results.append(renderer.trace(origins, directions))
    for result in results[1:]:
        for name in ("radiance", "error_bound", "path", "reason", "object_id"):
            assert getattr(result, name).tobytes() == getattr(results[0], name).tobytes()
    assert len(results[0].radiance) == count


def test_threads_of_refine() -> None:
    scene = rb.scenes.three_spheres()
    cam = scene.camera.replace(width=70, height=50)
    runs = [list(rb.Renderer(scene, threads=n).refine(cam)) for n in (1, 3)]
    for a, b in zip(*runs, strict=True):
        assert_equal_frames(a, b, "refine")
