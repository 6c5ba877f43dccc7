"""Copies and pickles of scenes and handles, and equality of scenes."""

from __future__ import annotations

import copy
import pickle

import pytest
from tests.python.samples import ball_scene, small_scene

import raybound as rb

PLAIN = rb.Material()
UP = rb.Transform.translate(0, 0, 1)


def worn_scene() -> rb.Scene:
    """A scene whose ids have gaps, at the end as well."""
    scene = small_scene()
    for index in (0, 4, len(scene) - 1):
        scene.objects[index if index < len(scene) else -1].remove()
    scene.lights[0].remove()
    scene.add(rb.Sphere(), PLAIN).remove()
    scene.add_light(rb.PointLight((0, 0, 0))).remove()
    return scene


def test_copies_are_equal_and_independent() -> None:
    scene = worn_scene()
    for twin in (scene.copy(), copy.copy(scene), copy.deepcopy(scene)):
        assert twin == scene
        assert twin is not scene
        assert twin.revision == scene.revision
        assert [o.id for o in twin.objects] == [o.id for o in scene.objects]
        assert [o.id for o in twin.lights] == [o.id for o in scene.lights]
        before = scene.to_dict()
        twin.objects[0].move(UP)
        twin.objects[1].remove()
        twin.add(rb.Sphere(), PLAIN, name="added")
        twin.ambient = 0.9
        twin.camera = None
        assert scene.to_dict() == before
        assert twin != scene
    other = scene.copy()
    scene.objects[0].move(UP)
    assert other != scene


def test_handles_of_a_copy_are_its_own() -> None:
    scene = ball_scene()
    twin = scene.copy()
    mine, its = scene["ball"], twin["ball"]
    its.remove()
    assert mine.shape == rb.Sphere((0, 0, 1))
    with pytest.raises(ReferenceError):
        _ = its.shape
    assert mine in scene
    assert mine not in twin


def test_next_ids_of_copies_and_pickles() -> None:
    scene = worn_scene()
    twins = [scene.copy(), pickle.loads(pickle.dumps(scene))]
    with scene.edit():
        twins.append(scene.copy())
    expected = scene.add(rb.Sphere(), PLAIN).id, scene.add_light(rb.PointLight((0, 0, 0))).id
    assert expected == (12, 4)
    for twin in twins:
        assert (twin.add(rb.Sphere(), PLAIN).id, twin.add_light(rb.PointLight((0, 0, 0))).id) == expected


def test_pickling_scenes() -> None:
    scene = worn_scene()
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene
    assert again.to_dict() == scene.to_dict()
    assert [o.id for o in again.objects] == [o.id for o in scene.objects]
    a, b = rb.render(scene), rb.render(again)
    for name in ("image", "object_id", "depth", "path"):
        assert getattr(a, name).tobytes() == getattr(b, name).tobytes()
    assert len(set(a.object_id.ravel().tolist())) > 4


def test_pickling_handles_pickles_their_scene() -> None:
    scene = small_scene()
    removed = scene.add(rb.Sphere(), PLAIN)
    removed.remove()
    handles = (scene.objects[1], scene.objects[2], scene.lights[0], removed)
    a, b, lamp, gone = pickle.loads(pickle.dumps(handles))
    assert (a, b, lamp) == handles[:3]
    assert {a, b, lamp} == set(handles[:3])
    a.move(UP)
    lamp.remove()
    assert a._scene is b._scene is lamp._scene
    assert scene.objects[1].transform != a.transform
    new = a._scene.add(rb.Box(), PLAIN)
    assert new.id > removed._id
    for handle in (gone, lamp):
        with pytest.raises(ReferenceError):
            handle.remove()


def test_handles_are_equal_if_they_mean_the_same() -> None:
    scene = ball_scene()
    assert scene["ball"] == scene["ball"] == scene.objects[1]
    assert len({scene["ball"], scene.objects[1], scene["floor"]}) == 2
    assert scene["ball"] != scene["floor"]
    assert scene.objects[0] != scene.lights[0]
    assert scene["ball"] != "ball"


def test_equality_looks_at_contents_and_order() -> None:
    a, b = ball_scene(), ball_scene()
    assert a == b
    assert (a != b) is False
    assert a != 3
    a["ball"].move(UP)
    a["ball"].move(UP.inverse())
    assert a == b
    assert a.revision != b.revision
    changes = [
        lambda s: setattr(s, "ambient", 1),
        lambda s: setattr(s, "background", 1),
        lambda s: setattr(s, "camera", None),
        lambda s: s["ball"].move(UP),
        lambda s: setattr(s["ball"], "shape", rb.Sphere()),
        lambda s: setattr(s["ball"], "material", PLAIN),
        lambda s: setattr(s["lamp"], "light", rb.PointLight((0, 0, 0))),
        lambda s: s.add(rb.Sphere(), PLAIN),
        lambda s: s.add_light(rb.PointLight((0, 0, 0))),
        lambda s: s["lamp"].remove(),
    ]
    for change in changes:
        changed = b.copy()
        change(changed)
        assert changed != b
    named, unnamed = rb.Scene(), rb.Scene()
    named.add(rb.Sphere(), PLAIN, name="a")
    unnamed.add(rb.Sphere(), PLAIN)
    assert named != unnamed
    first, second = rb.Scene(), rb.Scene()
    for scene, shapes in ((first, (rb.Sphere(), rb.Box())), (second, (rb.Box(), rb.Sphere()))):
        for shape in shapes:
            scene.add(shape, PLAIN)
    assert first != second
    with pytest.raises(TypeError, match="unhashable"):
        hash(first)
