"""Meshes as values and in scene files: what they keep, when they are equal, and what they refuse."""

from __future__ import annotations

import base64
import copy
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import raybound as rb

CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
FACES = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
NORMALS = CORNERS - 0.25
UVS = CORNERS[:, :2] * 2


def full() -> rb.Mesh:
    return rb.Mesh(CORNERS, FACES, normals=NORMALS, uvs=UVS)


def test_arrays_are_kept_rounded_and_read_only() -> None:
    mesh = rb.Mesh(CORNERS * 0.1, FACES, normals=NORMALS, uvs=UVS)
    assert (mesh.vertices == (CORNERS * 0.1).astype(np.float32)).all()
    for name, dtype, given in (("faces", np.int32, FACES), ("normals", np.float32, NORMALS), ("uvs", np.float32, UVS)):
        assert (getattr(mesh, name) == given).all()
        assert getattr(mesh, name).dtype == dtype
    for array in (mesh.vertices, mesh.faces, mesh.normals, mesh.uvs):
        assert array is not None
        assert array.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    plain = rb.Mesh(CORNERS, FACES)
    assert plain.normals is None
    assert plain.uvs is None


def test_arrays_are_copies() -> None:
    vertices, faces = CORNERS.astype(np.float32), FACES.astype(np.int32)
    mesh = rb.Mesh(vertices, faces)
    vertices[:], faces[:] = 7, 0
    assert mesh == rb.Mesh(CORNERS, FACES)


@pytest.mark.parametrize("dtype", [np.int8, np.uint8, np.int32, np.uint32, np.int64, np.uint64, np.float32, np.float64])
def test_any_dtype_and_strides(dtype: type) -> None:
    expected = rb.Mesh(CORNERS, FACES)
    assert rb.Mesh(CORNERS.astype(np.float32)[::1], FACES.astype(dtype)) == expected
    wide = np.zeros((8, 6), dtype)
    wide[::2, ::2] = FACES
    assert rb.Mesh(np.asfortranarray(CORNERS), wide[::2, ::2]) == expected
    assert rb.Mesh(CORNERS.tolist(), FACES.tolist()) == expected
    assert rb.Mesh(CORNERS.astype(dtype), FACES) == expected


def test_equality_and_hashes() -> None:
    same = rb.Mesh(CORNERS * -1 * -1 + [0.0, -0.0, 0.0], FACES, normals=NORMALS, uvs=UVS)
    assert same == full()
    assert hash(same) == hash(full())
    others = [
        rb.Mesh(CORNERS, FACES),
        rb.Mesh(CORNERS * 2, FACES),
        rb.Mesh(CORNERS, FACES[:, [1, 2, 0]]),
        rb.Mesh(CORNERS, FACES[:3]),
        rb.Mesh(CORNERS, FACES, normals=NORMALS),
        rb.Mesh(CORNERS, FACES, uvs=UVS),
        rb.Mesh(CORNERS, FACES, normals=3 * NORMALS + 0.01),
    ]
    assert len({full(), *others}) == len(others) + 1
    assert full() != rb.Sphere()


def test_zeros_of_both_signs_are_equal() -> None:
    signed = np.where(CORNERS == 0, -0.0, CORNERS)
    assert rb.Mesh(signed, FACES) == rb.Mesh(CORNERS, FACES)
    assert hash(rb.Mesh(signed, FACES)) == hash(rb.Mesh(CORNERS, FACES))


def test_printing_is_short() -> None:
    assert repr(rb.Mesh(CORNERS, FACES)) == "Mesh(<4 vertices, 4 faces>)"
    assert repr(full()) == "Mesh(<4 vertices, 4 faces, normals, uvs>)"


def test_copies_pickles_and_replace() -> None:
    for again in (pickle.loads(pickle.dumps(full())), copy.deepcopy(full()), full().replace()):
        assert again == full()
        assert not again.vertices.flags.writeable
    assert full().replace(normals=None, uvs=None) == rb.Mesh(CORNERS, FACES)
    with pytest.raises(AttributeError, match=r"Mesh: faces is read-only; use replace\(\)"):
        full().faces = FACES  # type: ignore[misc]


def test_a_mesh_is_a_shape() -> None:
    mesh = full()
    np.testing.assert_allclose(mesh.bounds, [(0, 0, 0), (1, 1, 1)], atol=1e-6)
    scene = rb.Scene(ambient=1)
    scene.add(mesh, rb.Material(1), transform=rb.Transform.translate(3, 0, 0))
    scene.add(mesh.transformed(rb.Transform.scale(2)), rb.Material(1))
    hits = scene.intersect([(3.2, 0.2, 5), (0.9, 0.9, 5), (3.9, 0.9, 5)], [(0, 0, -1)] * 3)
    assert hits["object_id"].tolist() == [0, 1, -1]
    np.testing.assert_allclose(hits["point"][0], (3.2, 0.2, 0.6), atol=1e-5)


BAD: list[tuple[dict[str, Any], type[Exception], str]] = [
    ({"vertices": CORNERS[:, :2]}, ValueError, r"vertices must be an array of numbers with shape \(n, 3\), got shape"),
    ({"vertices": np.zeros((0, 3))}, ValueError, "vertices must be at least 3 points, got 0"),
    (
        {"vertices": [(0, 0, 0), (1, 0, np.nan), (0, 1, 0)]},
        ValueError,
        r"vertices must be finite, got nan at index \(1, 2",
    ),
    ({"vertices": CORNERS * 1e39}, ValueError, "vertices must fit in float32"),
    ({"vertices": "abc"}, TypeError, "vertices must be an array"),
    ({"vertices": None}, TypeError, "vertices must be an array"),
    (
        {"faces": [(0, 1)]},
        ValueError,
        r"faces must be an array of whole numbers with shape \(m, 3\), got shape \(1, 2\)",
    ),
    ({"faces": [0, 1, 2]}, ValueError, r"got shape \(3,\)"),
    ({"faces": np.zeros((0, 3), int)}, ValueError, "faces must be at least 1 triangle, got 0"),
    ({"faces": [(0, 1, 2.5)]}, ValueError, r"faces must be whole numbers that fit in int32, got 2.5 at index \(0, 2\)"),
    ({"faces": [(0, 1, np.nan)]}, ValueError, "faces must be whole numbers that fit in int32, got nan"),
    ({"faces": [(0, 1, 2**31)]}, ValueError, "faces must be whole numbers that fit in int32, got 2147483648"),
    ({"faces": np.array([(0, 1, 2**64 - 1)], np.uint64)}, ValueError, "faces must be whole numbers that fit in int32"),
    ({"faces": [(0, 1, 2**70)]}, ValueError, "faces must be whole numbers that fit in int32"),
    ({"faces": [(True, False, True)]}, TypeError, "faces must be an array of whole numbers"),
    ({"faces": np.array([(True, False, True)])}, TypeError, "faces must be an array of whole numbers"),
    (
        {"normals": NORMALS[:3]},
        ValueError,
        r"normals must be an array of numbers with shape \(4, 3\), got shape \(3, 3\)",
    ),
    ({"normals": np.full((4, 3), np.inf)}, ValueError, "normals must be finite"),
    ({"uvs": CORNERS}, ValueError, r"uvs must be an array of numbers with shape \(4, 2\), got shape \(4, 3\)"),
    ({"uvs": [(0, 0)] * 3 + [(0, np.nan)]}, ValueError, r"uvs must be finite, got nan at index \(3, 1\)"),
    # what the core looks at
    ({"faces": [(0, 1, 4)]}, ValueError, "faces"),
    ({"faces": [(0, 1, -1)]}, ValueError, "faces"),
    ({"faces": [(0, 1, 2), (0, 1, 1)]}, ValueError, ""),
    ({"vertices": [(0, 0, 0), (1, 0, 0), (2, 0, 0)], "faces": [(0, 1, 2)]}, ValueError, ""),
]


@pytest.mark.parametrize(
    ("changes", "error", "words"), BAD, ids=[f"{i} {words[:30]}" for i, (_, _, words) in enumerate(BAD)]
)
def test_bad_input(changes: dict[str, Any], error: type[Exception], words: str) -> None:
    arguments: dict[str, Any] = {"vertices": CORNERS, "faces": FACES, **changes}
    with pytest.raises(error, match=f"Mesh: .*{words}"):
        rb.Mesh(arguments.pop("vertices"), arguments.pop("faces"), **arguments)


def test_normals_are_keyword_only() -> None:
    with pytest.raises(TypeError, match="positional"):
        rb.Mesh(CORNERS, FACES, NORMALS)  # type: ignore[misc]


# Scene files


def mesh_scene() -> rb.Scene:
    scene = rb.Scene(ambient=0.5)
    other = rb.Mesh(CORNERS * 0.1, FACES)
    for i, shape in enumerate((full(), other, full(), other.transformed(rb.Transform.rotate(30, axis=(0, 0, 1))))):
        scene.add(shape, rb.Material(0.1 * i), transform=rb.Transform.translate(2 * i, 0, 0))
    scene.camera = rb.Camera((3, -9, 2), (3, 0, 0), width=32, height=16)
    return scene


def test_scene_files_keep_meshes(tmp_path: Path) -> None:
    scene = mesh_scene()
    d = json.loads(json.dumps(scene.to_dict(), allow_nan=False))
    assert rb.Scene.from_dict(d) == scene
    scene.save(tmp_path / "scene.json")
    again = rb.load_scene(tmp_path / "scene.json")
    assert again == scene
    assert again.to_dict() == d
    assert (rb.render(again).image == rb.render(scene).image).all()
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_meshes_that_are_shared_are_written_once() -> None:
    d = mesh_scene().to_dict()
    assert len(d["meshes"]) == 2
    assert [item["shape"].get("mesh") for item in d["objects"]] == [0, 1, 0, None]
    assert d["objects"][3]["shape"]["shape"] == {"type": "Mesh", "mesh": 1}
    first, _, third, _ = rb.Scene.from_dict(d).objects
    assert first.shape is third.shape


def test_arrays_may_be_lists_by_hand() -> None:
    d = {
        "meshes": [{"vertices": CORNERS.tolist(), "faces": FACES.tolist()}],
        "materials": [{}],
        "objects": [{"shape": {"type": "Mesh", "mesh": 0}, "material": 0}],
    }
    (item,) = rb.Scene.from_dict(d).objects
    assert item.shape == rb.Mesh(CORNERS, FACES)


def encoded(values: list[float], shape: list[int], dtype: str = "<f4") -> dict[str, Any]:
    return {"shape": shape, "base64": base64.b64encode(np.array(values, dtype).tobytes()).decode()}


TRIANGLE = {"vertices": CORNERS[:3].tolist(), "faces": [[0, 1, 2]]}
BAD_FILES: list[tuple[dict[str, Any], type[Exception], str]] = [
    ({"meshes": [{"faces": [[0, 1, 2]]}]}, ValueError, "meshes[0] lacks the key 'vertices'"),
    ({"meshes": [{**TRIANGLE, "normal": 1}]}, ValueError, "meshes[0] has the unknown key 'normal'"),
    ({"meshes": [TRIANGLE, {**TRIANGLE, "faces": [[0, 1]]}]}, ValueError, "meshes[1]: Mesh: faces must be"),
    (
        {"meshes": [{**TRIANGLE, "vertices": encoded([0] * 8, [3, 3])}]},
        ValueError,
        "meshes[0].vertices must be float32 numbers of that shape in base64",
    ),
    (
        {"meshes": [{**TRIANGLE, "faces": encoded([0, 1], [1, 3], "<i4")}]},
        ValueError,
        "meshes[0].faces must be int32 numbers of that shape in base64",
    ),
    (
        {"meshes": [{**TRIANGLE, "vertices": {"shape": [3, 3]}}]},
        ValueError,
        "meshes[0].vertices lacks the key 'base64'",
    ),
    (
        {"objects": [{"shape": {"type": "Mesh", "mesh": 0}, "material": 0}], "materials": [{}]},
        ValueError,
        "objects[0].shape.mesh refers to an empty list",
    ),
    (
        {"objects": [{"shape": {"type": "Mesh"}, "material": 0}], "materials": [{}]},
        ValueError,
        "objects[0].shape lacks the key 'mesh'",
    ),
]


@pytest.mark.parametrize(("d", "error", "words"), BAD_FILES, ids=[words[:40] for _, _, words in BAD_FILES])
def test_errors_in_scene_files_say_where(d: dict[str, Any], error: type[Exception], words: str) -> None:
    with pytest.raises(error) as caught:
        rb.Scene.from_dict(d)
    assert words in str(caught.value)
