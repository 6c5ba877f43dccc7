"""Shapes that a loop has wrapped thousands of times: everything that works for shallow ones works for them."""

import copy
import functools
import json
import operator
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import raybound as rb

STEP = rb.Transform.translate(0.001, 0, 0)
BIG = rb.Sphere(radius=3.0)
Maker = Callable[[int], rb.shapes.Shape]


def moved(n: int) -> rb.shapes.Shape:
    return functools.reduce(lambda shape, _: shape.transformed(STEP), range(n), rb.Sphere())


def balls(n: int) -> list[rb.Sphere]:
    return [rb.Sphere((0.5 * i, 0, 0)) for i in range(n + 1)]


def left(n: int) -> rb.shapes.Shape:
    return functools.reduce(operator.or_, balls(n))


def right(n: int) -> rb.shapes.Shape:
    return functools.reduce(lambda shape, ball: ball | shape, balls(n)[::-1])


def cut(n: int) -> rb.shapes.Shape:
    return functools.reduce(operator.and_, [rb.Sphere((0.5 * i / n, 0, 0)) for i in range(n + 1)])


def mixed(n: int) -> rb.shapes.Shape:
    """Operations in turns, and parts on either side."""
    shape: rb.shapes.Shape = rb.Sphere()
    for i in range(n // 2):
        shape = (shape | rb.Sphere((0, 1e-5 * i, 0))) & BIG
        if i % 50 == 0:
            shape = shape.transformed(rb.Transform.rotate(3))
    return shape


def doubled(n: int) -> rb.shapes.Shape:
    """The same part on both sides: few nodes, and very many paths to them, were they walked one by one."""
    shape: rb.shapes.Shape = rb.Sphere()
    for _ in range(min(n, 12)):
        shape = rb.Union(shape, shape.transformed(STEP))
    return shape


MAKERS: dict[str, Maker] = {m.__name__: m for m in (moved, left, right, cut, mixed, doubled)}


# Those of one kind each are enough for every run.
QUICK = [(name, 1500) for name in MAKERS] + [("moved", 20000), ("left", 20000)]
ALL = [(name, 20000) for name in MAKERS]
CASES = [*QUICK, *(pytest.param(*case, marks=pytest.mark.soak) for case in ALL if case not in QUICK)]


def scene_of(shape: rb.shapes.Shape) -> rb.Scene:
    scene = rb.Scene()
    scene.add(shape, rb.Material())
    return scene


def same_json(scene: rb.Scene) -> rb.Scene:
    return rb.Scene.from_dict(json.loads(json.dumps(scene.to_dict())))


@pytest.mark.parametrize(("name", "n"), CASES)
def test_deep_shapes_are_values(name: str, n: int) -> None:
    shape, again = MAKERS[name](n), MAKERS[name](n)
    other = MAKERS[name](n - 3 if name != "doubled" else 11)
    assert shape == again
    assert hash(shape) == hash(again)
    assert shape != other
    assert copy.copy(shape) is shape
    assert copy.deepcopy(shape) is shape
    assert shape.replace() == shape
    assert len({shape, again, other}) == 2
    text = repr(shape)
    assert text == repr(again) == str(shape)
    assert text.count("Sphere(") >= min(n // 3, 2) or name == "moved"
    assert np.isfinite(shape.bounds).all()
    assert pickle.loads(pickle.dumps(shape)) == shape


@pytest.mark.parametrize(("name", "n"), CASES)
def test_scenes_of_deep_shapes(name: str, n: int, tmp_path: Path) -> None:
    shape = MAKERS[name](n)
    scene = scene_of(shape)
    hit = scene.intersect([(0.1, 0.05, 5)], [(0, 0, -1)])
    assert hit["hit"].all() or name == "moved"
    scene.save(tmp_path / "deep.json")
    for restored in (same_json(scene), pickle.loads(pickle.dumps(scene)), rb.load_scene(tmp_path / "deep.json")):
        assert restored == scene
        assert restored.objects[0].shape == shape
        assert np.array_equal(restored.intersect([(0.1, 0.05, 5)], [(0, 0, -1)]), hit)


def test_what_is_shared_stays_shared() -> None:
    shape = doubled(12)
    restored = pickle.loads(pickle.dumps(shape))
    assert len(pickle.dumps(shape)) < 20000
    assert len(json.dumps(scene_of(left(3000)).to_dict())) < 1_000_000
    assert restored.shapes[0] is restored.shapes[1].shape


@pytest.mark.parametrize("name", ["left", "right", "cut", "mixed"])
@pytest.mark.parametrize("n", [100, 400, 1200])
def test_the_picture_does_not_depend_on_how_deep_parts_are(name: str, n: int) -> None:
    """Packs of rays recurse where that is not deep; where it is, rays go one by one. A flat union is the same solid."""
    shape = MAKERS[name](n)
    scene = scene_of(shape)
    rng = np.random.default_rng(5)
    width = 0.5 * n if name in ("left", "right") else 1
    targets = np.stack([rng.uniform(0, width, 500), rng.uniform(-0.8, 0.8, 500), rng.uniform(-0.4, 0.4, 500)], axis=1)
    origins = targets + rng.normal(size=(500, 3)) * 3 + (0, 0, 4)
    hits = scene.intersect(origins, targets - origins)
    assert hits["hit"].sum() > 300
    camera = rb.Camera((0.5, -6, 1), (0.5, 0, 0), fov=25, width=48, height=32)
    base = rb.render(scene, camera, method="base").image
    assert np.array_equal(base, rb.render(scene, camera, method="exact").image)
    assert (rb.render(scene, camera, method="base").object_id >= 0).sum() > 100
    if name in ("left", "right"):
        flat = scene_of(rb.Union(*balls(n))).intersect(origins, targets - origins)
        assert np.array_equal(flat["hit"], hits["hit"])
        assert np.allclose(flat["t"][hits["hit"]], hits["t"][hits["hit"]], rtol=1e-5)


def test_nested_intersections_are_bounded_at_once() -> None:
    """Bounds of each part are asked once, not twice at each level."""
    assert cut(60).bounds == pytest.approx(np.array([(-0.5, -1, -1), (1, 1, 1)]), abs=0.1)


def test_small_documents_are_written_as_before() -> None:
    document = scene_of(left(10)).to_dict()
    assert "shapes" not in document
    assert document["objects"][0]["shape"]["type"] == "Union"


def nested_description(n: int) -> dict[str, object]:
    description: dict[str, object] = {"type": "Sphere"}
    for _ in range(n):
        description = {"type": "Union", "shapes": [description, {"type": "Sphere", "center": [0, 0, 1]}]}
    return description


def document_of(shape: object, **others: object) -> dict[str, object]:
    return {"materials": [{}], "objects": [{"shape": shape, "material": 0}], **others}


def test_descriptions_that_nest_deep_are_read(tmp_path: Path) -> None:
    scene = rb.Scene.from_dict(document_of(nested_description(5000)))
    assert repr(scene.objects[0].shape).count("Sphere") == 5001
    path = tmp_path / "nested.json"
    path.write_text('{"objects": ' + "[" * 100_000 + "]" * 100_000 + "}")
    with pytest.raises(ValueError, match=r"load_scene: .*nested\.json' nests too deep for JSON"):
        rb.load_scene(path)


def test_faults_in_deep_descriptions_are_found() -> None:
    inner: dict[str, object] = {"type": "Union", "shapes": [{"type": "Sphere", "radius": -1}]}
    description: dict[str, object] = inner
    for _ in range(3):
        description = {"type": "Union", "shapes": [{"type": "Box"}, description]}
    place = r"objects\[0\]\.shape: shapes\[1\]: shapes\[1\]: shapes\[1\]: shapes\[0\]: Sphere: radius must be > 0"
    with pytest.raises(ValueError, match=place):
        rb.Scene.from_dict(document_of(description))
    first = {"type": "Union", "shapes": [{"shape": 1}]}
    with pytest.raises(ValueError, match=r"shapes\[0\]: shapes\[0\]\.shape refers to an empty list, got 1"):
        rb.Scene.from_dict(document_of({"shape": 0}, shapes=[first]))
    with pytest.raises(ValueError, match=r"objects\[0\]\.shape\.shape: index must be an integer in 0\.\.0, got 1"):
        rb.Scene.from_dict(document_of({"shape": 1}, shapes=[{"type": "Sphere"}]))
    scene = rb.Scene.from_dict(
        document_of({"shape": 1}, shapes=[{"type": "Sphere"}, {"type": "Union", "shapes": [{"shape": 0}]}])
    )
    assert scene.objects[0].shape == rb.Union(rb.Sphere())


VERY_DEEP = """
import functools, operator, pickle
import raybound as rb
step = rb.Transform.translate(1e-6, 0, 0)
n = 200_000
for make in (
    lambda: functools.reduce(lambda shape, _: shape.transformed(step), range(n), rb.Sphere()),
    lambda: functools.reduce(lambda shape, _: rb.Union(shape), range(n), rb.Sphere()),
    lambda: functools.reduce(lambda shape, _: shape & ball, range(n), ball),
):
    ball = rb.Sphere()
    shape = make()
    scene = rb.Scene()
    scene.add(shape, rb.Material(), transform=rb.Transform.scale(2))
    print(scene.intersect([(0.1, 0, 5)], [(0, 0, -1)])["hit"][0], scene.bounds[1, 2], isinstance(hash(shape), int))
    assert rb.render(scene, rb.Camera((0, 0, 9), (0, 0, 0), up=(0, 1, 0), width=4, height=4)).object_id.max() == 0
    del scene, shape
print("done")
"""


def test_two_hundred_thousand_levels_neither_overflow_nor_abort() -> None:
    run = subprocess.run([sys.executable, "-c", VERY_DEEP], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[-2000:]
    assert run.stdout.split() == ["True", "2.0", "True"] * 3 + ["done"]
