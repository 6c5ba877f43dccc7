"""A call that fails changes nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from tests.python.samples import ball_scene

import raybound as rb

PLAIN = rb.Material()
NAN = float("nan")
HUGE = rb.Transform.scale(2.0**60)

Call = Callable[[rb.Scene], object]
CALLS: dict[str, tuple[Call, type[Exception], str]] = {
    "add no shape": (lambda s: s.add(PLAIN, PLAIN), TypeError, "Scene.add: shape must be a Shape, got Material()"),
    "add no material": (
        lambda s: s.add(rb.Sphere(), 0.5),
        TypeError,
        "Scene.add: material must be a Material, got 0.5",
    ),
    "add a class": (lambda s: s.add(rb.Sphere, PLAIN), TypeError, "Scene.add: shape must be a Shape"),
    "add a handle": (lambda s: s.add(s["ball"], PLAIN), TypeError, "Scene.add: shape must be a Shape, got <Object 1"),
    "add an empty name": (lambda s: s.add(rb.Sphere(), PLAIN, name=""), ValueError, "Scene.add: name must be"),
    "add no name": (lambda s: s.add(rb.Sphere(), PLAIN, name=3), TypeError, "Scene.add: name must be a string or None"),
    "add a taken name": (lambda s: s.add(rb.Sphere(), PLAIN, name="lamp"), ValueError, "got 'lamp', which is taken"),
    "add a matrix": (
        lambda s: s.add(rb.Sphere(), PLAIN, transform=np.eye(4)),
        TypeError,
        "Scene.add: transform must be a Transform, got an array of shape (4, 4)",
    ),
    "add too far away": (lambda s: s.add(rb.Sphere((9, 0, 0)), PLAIN, transform=HUGE), ValueError, "within 2**60"),
    "add a light as object": (lambda s: s.add(rb.PointLight((0, 0, 0)), PLAIN), TypeError, "shape must be a Shape"),
    "add positional name": (lambda s: s.add(rb.Sphere(), PLAIN, "name"), TypeError, "positional"),
    "add unknown": (lambda s: s.add(rb.Sphere(), PLAIN, nam="a"), TypeError, "nam"),
    "add_light": (
        lambda s: s.add_light(rb.Sphere()),
        TypeError,
        "Scene.add_light: light must be a Light, got Sphere()",
    ),
    "add_light name": (lambda s: s.add_light(s["lamp"].light, "ball"), ValueError, "Scene.add_light: name"),
    "shape": (lambda s: setattr(s["ball"], "shape", 3), TypeError, "Object: shape must be a Shape, got 3"),
    "material": (
        lambda s: setattr(s["ball"], "material", rb.Sphere()),
        TypeError,
        "Object: material must be a Material",
    ),
    "transform": (lambda s: setattr(s["ball"], "transform", 3), TypeError, "Object: transform must be a Transform"),
    "transform far": (lambda s: setattr(s["floor"], "transform", HUGE), ValueError, "within 2**60"),
    "move": (lambda s: s["ball"].move(None), TypeError, "Object.move: t must be a Transform, got None"),
    "move far": (lambda s: s["floor"].move(HUGE), ValueError, "within 2**60"),
    "light": (lambda s: setattr(s["lamp"], "light", PLAIN), TypeError, "LightHandle: light must be a Light"),
    "ambient": (lambda s: setattr(s, "ambient", -1), ValueError, "Scene: ambient must be >= 0, got -1"),
    "background": (lambda s: setattr(s, "background", (0, NAN, 0)), ValueError, "Scene: background must be finite"),
    "camera": (lambda s: setattr(s, "camera", 3), TypeError, "Scene: camera must be a Camera or None, got 3"),
    "save": (lambda s: s.save("scene.obj"), ValueError, "Scene.save: path must end in .json, got 'scene.obj'"),
    "save to no folder": (lambda s: s.save("no/such/folder.json"), FileNotFoundError, "no/such/folder.json"),
    "save to a number": (lambda s: s.save(3), TypeError, "Scene.save: path must be a path"),
    "intersect": (lambda s: s.intersect([(0, 0, 0)], [(0, 0, 0)]), ValueError, "Scene.intersect: directions"),
    "occluded": (lambda s: s.occluded([(0, 0, 0)], [3]), ValueError, "Scene.occluded: targets"),
    "render": (lambda s: rb.render(s, quality="best"), TypeError, "quality"),
}


@pytest.mark.parametrize("name", CALLS)
def test_nothing_changed(name: str) -> None:
    call, error, words = CALLS[name]
    scene = ball_scene()
    ball, lamp = scene["ball"], scene["lamp"]
    before = (scene.to_dict(), scene.revision, scene.objects, scene.lights, hash(ball))
    hit = scene.intersect([(0, -9, 1)], [(0, 1, 0)])
    with pytest.raises(error) as caught:
        call(scene)
    assert words in str(caught.value)
    assert (scene.to_dict(), scene.revision, scene.objects, scene.lights, hash(ball)) == before
    assert (scene.intersect([(0, -9, 1)], [(0, 1, 0)]) == hit).all()
    assert (ball.name, lamp.name) == ("ball", "lamp")
    added = scene.add(rb.Sphere(), PLAIN, name="added")
    assert added.id == 2  # a failed `add` uses up no id
    assert scene.add_light(rb.PointLight((0, 0, 0))).id == 1


@pytest.mark.parametrize("name", CALLS)
def test_nothing_changed_inside_a_block(name: str) -> None:
    call, error, _ = CALLS[name]
    scene = ball_scene()
    twin = scene.copy()
    with scene.edit():
        scene["ball"].material = PLAIN
        with pytest.raises(error):
            call(scene)
    twin["ball"].material = PLAIN
    assert scene == twin


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"cam": 3}, "Renderer.render: cam must be a Camera, got 3"),
        ({"quality": 3}, "Renderer.render: quality must be one of 'bounded'"),
        ({"progress": "yes"}, "Renderer.render: progress must be True, None or a callable"),
    ],
)
def test_bad_arguments_of_render_leave_the_renderer_as_it_was(arguments: dict[str, Any], words: str) -> None:
    renderer = rb.Renderer(ball_scene())
    renderer.render()
    before = renderer.stats
    with pytest.raises(TypeError) as caught:
        renderer.render(**arguments)
    assert words in str(caught.value)
    assert renderer.stats == before
    assert renderer.partial_frame is None
    with pytest.raises(ValueError, match=r"Renderer\.render: quality must be one of .*, got 'best'"):
        renderer.render(quality="best")
    with pytest.raises(TypeError, match=r"Renderer\.sequence: cameras\[1\] must be a Camera, got 3"):
        renderer.sequence([renderer.render().camera, 3])
    with pytest.raises(TypeError, match=r"Renderer\.sequence: cameras must be a sequence"):
        renderer.sequence(3)


def test_a_scene_without_a_camera_cannot_render_without_one() -> None:
    scene = rb.Scene()
    renderer = rb.Renderer(scene)
    for name, call in (("render", renderer.render), ("refine", renderer.refine)):
        with pytest.raises(ValueError, match=f"Renderer.{name}: cam must be a Camera, got None, and the scene has no"):
            call()
