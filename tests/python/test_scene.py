"""The scene document: handles, names, ids, edits by assignment, revisions, bounds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.python.samples import TILT, TURN, ball_scene, small_scene

import raybound as rb

PLAIN = rb.Material()
MOVE = rb.Transform.translate(1, 2, 3)


def test_a_new_scene_is_empty() -> None:
    scene = rb.Scene()
    assert (len(scene), scene.objects, scene.lights, scene.revision, scene.camera) == (0, (), (), 0, None)
    assert (scene.ambient, scene.background) == ((0, 0, 0), (0, 0, 0))
    with pytest.raises(ValueError, match="Scene: bounds of an empty scene"):
        _ = scene.bounds
    assert repr(scene) == "<Scene: 0 objects, 0 lights, revision 0>"


def test_handles_read_what_was_added() -> None:
    scene = rb.Scene()
    ball = scene.add(rb.Sphere(), PLAIN, name="ball", transform=MOVE)
    lamp = scene.add_light(rb.PointLight((0, 0, 9)), name="lamp")
    assert (ball.shape, ball.material, ball.transform, ball.name, ball.id) == (rb.Sphere(), PLAIN, MOVE, "ball", 0)
    assert (lamp.light, lamp.name, lamp.id) == (rb.PointLight((0, 0, 9)), "lamp", 0)
    assert isinstance(ball, rb.Object)
    assert isinstance(lamp, rb.LightHandle)
    assert repr(ball) == "<Object 0 'ball': Sphere>"
    assert repr(lamp) == "<LightHandle 0 'lamp': PointLight>"


def test_looking_up() -> None:
    scene = small_scene()
    named = [item for item in (*scene.objects, *scene.lights) if item.name is not None]
    assert len(named) > 5
    for item in named:
        assert scene[item.name or ""] == item
        assert item.name in scene
        assert item in scene
    assert list(scene) == list(scene.objects)
    assert len(scene) == len(scene.objects) == 11
    assert [item.id for item in scene.objects] == list(range(11))
    assert "nothing" not in scene
    assert small_scene().objects[0] not in scene
    with pytest.raises(KeyError, match="no object or light is named 'nothing'"):
        scene["nothing"]
    with pytest.raises(TypeError, match="a key must be the name of an object or light, got 0"):
        scene[0]


def test_names_are_unique_until_they_are_free_again() -> None:
    scene = rb.Scene()
    first = scene.add(rb.Sphere(), PLAIN, name="it")
    for taken in (
        lambda: scene.add(rb.Box(), PLAIN, name="it"),
        lambda: scene.add_light(rb.PointLight((0, 0, 0)), "it"),
    ):
        with pytest.raises(ValueError, match=r"Scene\.add.*: name must be unique in the scene, got 'it'"):
            taken()
    assert (len(scene), len(scene.lights), scene.revision) == (1, 0, 1)
    first.remove()
    lamp = scene.add_light(rb.PointLight((0, 0, 0)), name="it")
    assert scene["it"] == lamp


def test_ids_are_never_reused() -> None:
    scene = rb.Scene()
    seen: set[int] = set()
    for _ in range(5):
        ball = scene.add(rb.Sphere(), PLAIN)
        assert ball.id not in seen
        seen.add(ball.id)
        ball.remove()
    lamps: set[int] = set()
    for _ in range(5):
        lamp = scene.add_light(rb.PointLight((0, 0, 0)))
        assert lamp.id not in lamps
        lamps.add(lamp.id)
        lamp.remove()


USES: list[Any] = [
    lambda ball: ball.shape,
    lambda ball: ball.material,
    lambda ball: ball.transform,
    lambda ball: ball.name,
    lambda ball: ball.id,
    lambda ball: ball.bounds,
    lambda ball: ball.move(MOVE),
    lambda ball: ball.remove(),
    lambda ball: setattr(ball, "shape", rb.Box()),
    lambda ball: setattr(ball, "material", PLAIN),
    lambda ball: setattr(ball, "transform", MOVE),
]


@pytest.mark.parametrize("use", USES)
def test_removed_objects(use: Any) -> None:
    scene = ball_scene()
    ball, same = scene["ball"], scene["ball"]
    ball.remove()
    before = (scene.to_dict(), scene.revision)
    for handle in (ball, same):
        with pytest.raises(ReferenceError, match="Object 1 was removed from its scene"):
            use(handle)
    assert (scene.to_dict(), scene.revision) == before
    assert ball not in scene
    assert repr(ball) == "<removed Object 1>"


@pytest.mark.parametrize(
    "use",
    [
        lambda lamp: lamp.light,
        lambda lamp: lamp.name,
        lambda lamp: lamp.id,
        lambda lamp: lamp.remove(),
        lambda lamp: setattr(lamp, "light", rb.PointLight((0, 0, 0))),
    ],
)
def test_removed_lights(use: Any) -> None:
    scene = ball_scene()
    lamp = scene["lamp"]
    lamp.remove()
    with pytest.raises(ReferenceError, match="LightHandle 0 was removed from its scene"):
        use(lamp)
    assert scene.lights == ()


def test_every_edit_is_one_revision() -> None:
    scene = rb.Scene()
    ball = scene.add(rb.Sphere(), PLAIN)
    lamp = scene.add_light(rb.PointLight((0, 0, 0)))
    edits: list[Any] = [
        lambda: setattr(ball, "shape", rb.Box()),
        lambda: setattr(ball, "material", rb.Material(0.1)),
        lambda: setattr(ball, "transform", MOVE),
        lambda: setattr(ball, "transform", None),
        lambda: ball.move(MOVE),
        lambda: setattr(lamp, "light", rb.PointLight((1, 0, 0))),
        lambda: setattr(scene, "ambient", 0.5),
        lambda: setattr(scene, "background", (0.1, 0.2, 0.3)),
        lambda: lamp.remove(),
        lambda: ball.remove(),
    ]
    assert scene.revision == 2
    for count, edit in enumerate(edits, start=3):
        edit()
        assert scene.revision == count
    scene.camera = rb.Camera((1, 0, 0), (0, 0, 0))
    _ = scene.objects, scene.to_dict(), scene.copy()
    assert scene.revision == 12


def test_assigning_reads_back() -> None:
    scene = ball_scene()
    ball, lamp = scene["ball"], scene["lamp"]
    ball.shape, ball.material, ball.transform = rb.Cone(), rb.Material(0.9), MOVE
    lamp.light = rb.DirectionalLight((0, 0, -1))
    scene.ambient, scene.background = 0.5, (0.25, 0.5, 1)
    assert (ball.shape, ball.material, ball.transform) == (rb.Cone(), rb.Material(0.9), MOVE)
    assert scene["lamp"].light == rb.DirectionalLight((0, 0, -1))
    assert (scene.ambient, scene.background) == ((0.5, 0.5, 0.5), (0.25, 0.5, 1))
    ball.transform = None
    assert ball.transform == rb.Transform()


def test_move_multiplies_from_the_left() -> None:
    ball = rb.Scene().add(rb.Sphere(), PLAIN, transform=MOVE)
    turn = rb.Transform.rotate(90)
    ball.move(turn)
    expected = (turn @ MOVE).matrix
    np.testing.assert_allclose(ball.transform.matrix, expected, atol=1e-6)
    np.testing.assert_allclose(ball.transform.matrix[:3, 3], (-2, 1, 3), atol=1e-6)
    assert (ball.transform.matrix == expected.astype(np.float32)).all()


def test_transforms_compose_as_matrices() -> None:
    for a, b in ((TILT, TURN), (TURN, TILT), (MOVE, TILT)):
        np.testing.assert_allclose((a @ b).matrix, a.matrix @ b.matrix, rtol=1e-14, atol=1e-14)
        np.testing.assert_allclose((a @ a.inverse()).matrix, np.eye(4), atol=1e-14)
    np.testing.assert_allclose(rb.Transform.rotate(90).matrix[:3, :3] @ (1, 0, 0), (0, 1, 0), atol=1e-15)
    assert (rb.Transform.scale(2).matrix == np.diag([2, 2, 2, 1])).all()
    assert (rb.Transform.translate(1, 2, 3).matrix @ (0, 0, 0, 1) == (1, 2, 3, 1)).all()


def test_bounds_contain_what_rays_hit() -> None:
    scene = small_scene()
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(4000, 3))
    lower, upper = scene.bounds
    origins = rng.uniform(lower, upper, (4000, 3)) - 60 * directions
    hits = scene.intersect(origins, directions)
    points = hits["point"][hits["hit"]]
    assert len(points) > 200
    assert (points >= lower).all()
    assert (points <= upper).all()
    for item in scene.objects:
        assert (item.bounds[0] >= lower).all()
        assert (item.bounds[1] <= upper).all()
        own = hits["point"][hits["object_id"] == item.id]
        assert ((own >= item.bounds[0]) & (own <= item.bounds[1])).all()


def test_intersections_and_occlusions_of_a_known_scene() -> None:
    scene = rb.Scene()
    ball = scene.add(rb.Sphere(), PLAIN, transform=rb.Transform.translate(0, 0, 5))
    found = scene.intersect([(0, 0, 0), (0, 0, 0), (0, 0, 5)], [(0, 0, 2), (0, 0, -1), (1, 0, 0)])
    assert found["hit"].tolist() == [True, False, True]
    assert found["object_id"].tolist() == [ball.id, -1, ball.id]
    assert found["face_id"][1] == -1
    np.testing.assert_allclose(found["t"], [2, np.inf, 1], rtol=1e-6)
    np.testing.assert_allclose(found["point"], [(0, 0, 4), (0, 0, 0), (1, 0, 5)], atol=1e-6)
    np.testing.assert_allclose(found["normal"], [(0, 0, -1), (0, 0, 0), (1, 0, 0)], atol=1e-6)
    assert (np.abs(found["t"][[0, 2]] - [2, 1]) <= found["t_error"][[0, 2]]).all()
    assert scene.occluded([(0, 0, 0)] * 3, [(0, 0, 9), (0, 0, 3), (9, 0, 0)]).tolist() == [True, False, False]
    assert set(found.dtype.names or ()) == {
        *("hit", "t", "t_error", "point", "point_error", "normal", "uv", "object_id", "face_id", "entering"),
        *("within_id", "touching", "direction", "seal"),
    }


def test_misspelt_attributes_are_errors() -> None:
    scene = ball_scene()
    for target, name in ((scene, "camra"), (scene["ball"], "colour"), (scene["ball"], "name"), (scene, "revision")):
        with pytest.raises(AttributeError, match=name):
            setattr(target, name, None)
