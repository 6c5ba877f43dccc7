"""Edit blocks are all or nothing, and renderers see the scene as it was before until they end."""

# ruff: noqa: PT012  (blocks that an exception leaves are what is tested)

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from tests.python.samples import ball_scene, small_scene

import raybound as rb

PLAIN = rb.Material()
UP = rb.Transform.translate(0, 0, 1)


class Stop(Exception):
    """What ends blocks here."""


def change_everything(scene: rb.Scene) -> None:
    """One edit of every kind."""
    first, second, *_ = scene.objects
    first.remove()
    second.move(UP)
    second.material = rb.Material(0.9)
    second.shape = rb.Box()
    scene.lights[0].light = rb.PointLight((9, 9, 9))
    scene.lights[-1].remove()
    scene.add(rb.Sphere(), PLAIN, name="new", transform=UP)
    scene.add_light(rb.PointLight((0, 0, 0)), name="new lamp")
    scene.ambient, scene.background = 0.7, 0.8
    scene.camera = rb.Camera((1, 0, 0), (0, 0, 0))


def state(scene: rb.Scene) -> Any:
    return scene.to_dict(), scene.revision, [o.id for o in scene.objects], [o.id for o in scene.lights]


def test_a_block_is_one_revision() -> None:
    scene, twin = small_scene(), small_scene()
    before = scene.revision
    with scene.edit() as same:
        assert same is scene
        change_everything(scene)
        assert scene.revision == before
    assert scene.revision == before + 1
    change_everything(twin)
    assert scene == twin
    assert twin.revision == before + 10


def test_an_empty_block_is_no_revision() -> None:
    scene = small_scene()
    before = scene.revision
    with scene.edit():
        scene.camera = None
    assert scene.revision == before


@pytest.mark.parametrize("error", [Stop, KeyboardInterrupt, GeneratorExit])
def test_an_exception_undoes_the_whole_block(error: type[BaseException]) -> None:
    scene = small_scene()
    before, copy = state(scene), scene.copy()
    hits = scene.intersect([(0, -30, 0)], [(0, 1, 0)])
    old = scene.objects[0]
    with pytest.raises(error), scene.edit():
        change_everything(scene)
        made, lamp = scene["new"], scene["new lamp"]
        raise error
    assert state(scene) == before
    assert scene == copy
    assert (scene.intersect([(0, -30, 0)], [(0, 1, 0)]) == hits).all()
    assert old.shape == copy.objects[0].shape
    assert "new" not in scene
    for handle in (made, lamp):
        with pytest.raises(ReferenceError):
            _ = handle.name
    again = scene.add(rb.Sphere(), PLAIN, name="new")
    assert again != made
    with pytest.raises(ReferenceError):
        _ = made.name


def test_a_failed_call_inside_a_block_need_not_end_it() -> None:
    scene = ball_scene()
    with scene.edit():
        scene["ball"].move(UP)
        with pytest.raises(TypeError):
            scene["ball"].move(3)
        scene["floor"].remove()
    assert len(scene) == 1
    assert scene["ball"].transform == UP


def test_nested_blocks_join_the_outer_one() -> None:
    scene = ball_scene()
    before = state(scene)
    with pytest.raises(Stop), scene.edit():
        with scene.edit():
            scene["ball"].move(UP)
        assert scene.revision == before[1]
        raise Stop
    assert state(scene) == before
    with scene.edit():
        scene["ball"].move(UP)
        with pytest.raises(Stop), scene.edit():
            scene["floor"].remove()
            raise Stop
    assert scene.revision == before[1] + 1
    assert (len(scene), scene["ball"].transform) == (1, UP)


def test_reading_inside_a_block_shows_the_edits_but_queries_do_not() -> None:
    scene = ball_scene()
    ray = [(0, -9, 21)], [(0, 1, 0)]
    with scene.edit():
        scene["ball"].transform = rb.Transform.translate(0, 0, 20)
        tall = scene.add(rb.Box((30, 0, 0), (31, 1, 1)), PLAIN)
        assert tall in scene.objects
        assert scene["ball"].bounds[1, 2] > 21
        assert scene.bounds[1, 0] >= 31
        assert not scene.intersect(*ray)["hit"][0]
        copy = scene.copy()
        assert copy == scene
        assert copy.intersect(*ray)["hit"][0]
    assert scene.intersect(*ray)["hit"][0]


def run_threads(*works: Callable[[], object]) -> None:
    """Runs all at the same time, and raises what one of them raised."""
    failures: list[BaseException] = []

    def guarded(work: Callable[[], object]) -> None:
        try:
            work()
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=guarded, args=(work,)) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    if failures:
        raise failures[0]


def test_a_render_in_another_thread_sees_the_state_before() -> None:
    scene = ball_scene()
    before = rb.render(scene)
    inside, rendered = threading.Event(), threading.Event()
    frames: list[rb.Frame] = []

    def edit() -> None:
        with scene.edit():
            scene["ball"].material = rb.Material((0.9, 0, 0))
            scene["floor"].remove()
            inside.set()
            assert rendered.wait(30)  # the render must not wait for the block

    def look() -> None:
        assert inside.wait(30)
        try:
            frames.append(rb.render(scene, before.camera))
        finally:
            rendered.set()

    run_threads(edit, look)
    assert frames[0].image.tobytes() == before.image.tobytes()
    assert frames[0].revision == before.revision
    after = rb.render(scene)
    assert after.revision == before.revision + 1
    assert after.image.tobytes() != before.image.tobytes()


def test_edits_of_other_threads_wait_for_the_block() -> None:
    scene = ball_scene()
    inside = threading.Event()
    order: list[str] = []

    def edit() -> None:
        with pytest.raises(Stop), scene.edit():
            scene["floor"].remove()
            inside.set()
            threading.Event().wait(0.1)
            order.append("block ends")
            raise Stop

    def other() -> None:
        assert inside.wait(30)
        scene.add(rb.Sphere(), PLAIN, name="other")
        order.append("other added")

    run_threads(edit, other)
    assert order == ["block ends", "other added"]
    assert (len(scene), "floor" in scene, "other" in scene) == (3, True, True)


def test_threads_that_edit_and_render_at_once() -> None:
    scene = ball_scene(16, 12)
    camera = scene.camera
    count, first = 60, scene.revision

    def add(name: str) -> None:
        for i in range(count):
            ball = scene.add(rb.Sphere((i, 0, 0), 0.1), PLAIN, name=f"{name} {i}")
            if i % 3 == 0:
                ball.remove()

    def block() -> None:
        for i in range(count):
            try:
                with scene.edit():
                    scene.add(rb.Sphere((0, i, 0), 0.1), PLAIN)
                    scene.add(rb.Sphere((0, 0, i), 0.1), PLAIN)
                    if i % 2:
                        raise Stop
            except Stop:
                pass

    def render() -> None:
        with rb.Renderer(scene, threads=2) as renderer:
            for frame in renderer.sequence([camera] * 20 if camera else []):
                assert frame.error_bound.max() == 0
                frame.explain(8, 6)

    def read() -> None:
        for _ in range(count):
            assert len(scene.objects) >= 2
            scene.to_dict()
            scene.copy()
            assert scene.bounds.shape == (2, 3)

    run_threads(lambda: add("a"), lambda: add("b"), block, render, render, read)
    assert len(scene) == 2 + 2 * count - 2 * (count // 3) + count
    assert scene.revision == first + 2 * count + 2 * (count // 3) + count // 2
    assert len({item.id for item in scene.objects}) == len(scene)
    np.testing.assert_array_equal(rb.render(scene.copy()).image, rb.render(scene).image)
