"""Scenes as JSON: round trips, textures by path and by array, and errors that say where."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.python.samples import ball_scene, small_scene

import raybound as rb


def picture(path: Path) -> Path:
    """A small image file, made by the package itself."""
    path.parent.mkdir(parents=True, exist_ok=True)
    rb.render(ball_scene(12, 8)).save(path)
    return path


def textured_scene(path: Path) -> rb.Scene:
    scene = small_scene()
    for item in scene.objects[::3]:
        item.material = rb.Material(rb.Texture(path, (2, 3), wrap="clamp"), reflect=0.1)
    return scene


def same_pictures(a: rb.Scene, b: rb.Scene) -> bool:
    first, second = rb.render(a), rb.render(b)
    return all(
        getattr(first, name).tobytes() == getattr(second, name).tobytes()
        for name in ("image", "object_id", "depth", "path")
    )


def test_round_trip_by_dict_is_plain_json() -> None:
    scene = small_scene()
    d = scene.to_dict()
    text = json.dumps(d, allow_nan=False)
    for again in (rb.Scene.from_dict(d), rb.Scene.from_dict(json.loads(text))):
        assert again == scene
        assert again.to_dict() == d
        assert again.camera == scene.camera
        assert same_pictures(again, scene)
    assert rb.Scene.from_dict(rb.Scene().to_dict()) == rb.Scene()


def test_round_trip_by_file(tmp_path: Path) -> None:
    scene = textured_scene(picture(tmp_path / "pictures" / "wood.png"))
    for path in (tmp_path / "scene.json", str(tmp_path / "again.JSON")):
        scene.save(path)
        again = rb.load_scene(path)
        assert again == scene
        assert same_pictures(again, scene)


def test_textures_in_the_files_folder_move_with_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = textured_scene(picture(tmp_path / "one" / "pictures" / "wood.png"))
    scene.save(tmp_path / "one" / "scene.json")
    assert '"pictures/wood.png"' in (tmp_path / "one" / "scene.json").read_text()
    (tmp_path / "one").rename(tmp_path / "two")
    monkeypatch.chdir(tmp_path)
    assert rb.load_scene("two/scene.json") == scene
    monkeypatch.chdir(tmp_path / "two")
    assert rb.load_scene("scene.json") == scene


def test_textures_elsewhere_keep_their_absolute_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    picture(tmp_path / "wood.png")
    monkeypatch.chdir(tmp_path)
    scene = textured_scene(Path("wood.png"))
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    scene.save("scene.json")
    assert json.dumps(str(tmp_path / "wood.png")) in Path("scene.json").read_text()
    assert rb.load_scene("scene.json") == scene
    assert rb.Scene.from_dict(scene.to_dict()) == scene


def test_a_lost_texture_file_is_named(tmp_path: Path) -> None:
    scene = textured_scene(picture(tmp_path / "wood.png"))
    scene.save(tmp_path / "scene.json")
    (tmp_path / "wood.png").unlink()
    with pytest.raises(FileNotFoundError, match=r"wood\.png"):
        rb.load_scene(tmp_path / "scene.json")
    (tmp_path / "wood.png").write_text("no picture")
    with pytest.raises(ValueError, match=r"scene\.json.*textures\[0\].*cannot read the image file.*wood\.png"):
        rb.load_scene(tmp_path / "scene.json")


def test_what_is_shared_is_written_once() -> None:
    scene = rb.Scene()
    texture = rb.Texture(np.ones((2, 2, 3)))
    for reflect in (0, 0, 0.5):
        scene.add(rb.Sphere(), rb.Material(texture, reflect=reflect))
    d = scene.to_dict()
    assert (len(d["textures"]), len(d["materials"])) == (1, 2)
    assert [item["material"] for item in d["objects"]] == [0, 0, 1]


def test_the_least_that_a_description_needs() -> None:
    d = {
        "objects": [{"shape": {"type": "Sphere"}, "material": 0}],
        "materials": [{}],
        "lights": [{"light": {"type": "PointLight", "position": [0, 0, 3]}}],
        "camera": {"eye": [0, -5, 0], "target": [0, 0, 0]},
    }
    expected = rb.Scene()
    expected.add(rb.Sphere(), rb.Material())
    expected.add_light(rb.PointLight((0, 0, 3)))
    expected.camera = rb.Camera((0, -5, 0), (0, 0, 0))
    assert rb.Scene.from_dict(d) == expected
    assert rb.Scene.from_dict({}) == rb.Scene()


ONE: dict[str, Any] = {"type": "PointLight", "position": [0, 0, 0]}
BAD: list[tuple[dict[str, Any], type[Exception], str]] = [
    ({"objcts": []}, ValueError, "Scene.from_dict has the unknown key 'objcts'"),
    ({"format": "obj"}, ValueError, "format and version must be 'raybound scene', 1, got 'obj'"),
    ({"version": 2}, ValueError, "format and version"),
    ({"objects": {}}, TypeError, "objects must be a list, got {}"),
    ({"objects": [3]}, TypeError, "objects[0] must be an object"),
    ({"objects": [{"material": 0}]}, ValueError, "objects[0] lacks the key 'shape'"),
    ({"objects": [{"shape": {"type": "Ball"}, "material": 0}], "materials": [{}]}, ValueError, "objects[0].shape"),
    ({"objects": [{"shape": {"type": "Sphere"}, "material": 0}]}, ValueError, "objects[0].material"),
    ({"objects": [{"shape": {"type": "Sphere"}, "material": 1}], "materials": [{}]}, ValueError, "objects[0].material"),
    (
        {"objects": [{"shape": {"type": "Sphere"}, "material": "a"}], "materials": [{}]},
        TypeError,
        "objects[0].material",
    ),
    (
        {"objects": [{"shape": {"type": "Sphere", "radius": -1}, "material": 0}], "materials": [{}]},
        ValueError,
        "objects[0].shape: Sphere: radius must be > 0, got -1",
    ),
    (
        {"objects": [{"shape": {"type": "Union", "shapes": [{"type": "Disk"}]}, "material": 0}], "materials": [{}]},
        ValueError,
        "objects[0].shape: Union: shape 0 must be a solid",
    ),
    (
        {"objects": [{"shape": {"type": "Union", "shapes": [{"type": "X"}]}, "material": 0}], "materials": [{}]},
        ValueError,
        "objects[0].shape: shapes[0] must be an object whose type is one of Sphere",
    ),
    (
        {"objects": [{"shape": {"type": "Sphere"}, "material": 0, "transform": [[1]]}], "materials": [{}]},
        ValueError,
        "objects[0]: Transform: matrix must be",
    ),
    ({"materials": [{"diffuse": {"texture": 0}}]}, ValueError, "materials[0].diffuse.texture refers to an empty list"),
    ({"materials": [{"diffuse": -1}]}, ValueError, "materials[0]: Material: diffuse must be >= 0, got -1"),
    ({"materials": [{"difuse": 1}]}, ValueError, "materials[0] has the unknown key 'difuse'"),
    ({"textures": [{}]}, ValueError, "textures[0] must have one of the keys 'path' and 'texels'"),
    ({"textures": [{"path": 3}]}, TypeError, "textures[0]: path must be a path"),
    ({"textures": [{"texels": {"shape": [1, 1, 3]}}]}, ValueError, "textures[0].texels lacks the key 'base64'"),
    ({"textures": [{"texels": {"shape": [1, 1, 3], "base64": "####"}}]}, ValueError, "textures[0].texels must be"),
    ({"lights": [{"light": ONE}, {"light": {"type": "Lamp"}}]}, ValueError, "lights[1].light must be an object whose"),
    ({"lights": [{"light": ONE, "name": "a"}, {"light": ONE, "name": "a"}]}, ValueError, "lights[1]: Scene.add_light"),
    ({"camera": {"eye": [0, 0, 0]}}, ValueError, "camera lacks the key 'target'"),
    ({"camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}}, ValueError, "camera: Camera: target must differ from eye"),
    ({"ambient": "red"}, TypeError, "Scene.from_dict: Scene: ambient"),
    ({"background": [0, float("nan"), 0]}, ValueError, "background must be finite"),
]


@pytest.mark.parametrize(("d", "error", "words"), BAD, ids=[words[:40] for _, _, words in BAD])
def test_errors_say_where(d: dict[str, Any], error: type[Exception], words: str, tmp_path: Path) -> None:
    with pytest.raises(error) as caught:
        rb.Scene.from_dict(d)
    assert words in str(caught.value)
    (tmp_path / "bad.json").write_text(json.dumps(d))
    with pytest.raises(error) as caught:
        rb.load_scene(tmp_path / "bad.json")
    assert "bad.json" in str(caught.value)


def test_texels_of_the_wrong_size() -> None:
    data = base64.b64encode(np.zeros(3, "<f4").tobytes()).decode()
    with pytest.raises(ValueError, match=r"textures\[0\]\.texels must be float32 texels of that shape"):
        rb.Scene.from_dict({"textures": [{"texels": {"shape": [2, 2, 3], "base64": data}}]})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"ambient": 1,\n "background": }', "is not JSON: .*line 2 column 16"),
        ("", "is not JSON: .*line 1 column 1"),
        ("[1, 2]", r"bad\.json' must be an object with keys format"),
    ],
)
def test_files_that_are_not_scenes(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "bad.json").write_text(text)
    with pytest.raises((ValueError, TypeError), match=r"load_scene: .*bad\.json.*") as caught:
        rb.load_scene(tmp_path / "bad.json")
    assert caught.match(words)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "latin.json").write_bytes(b'{"name": "\xe9"}')
    with pytest.raises(ValueError, match=r"load_scene: .*is not JSON"):
        rb.load_scene(tmp_path / "latin.json")
    with pytest.raises(FileNotFoundError, match=r"none\.json"):
        rb.load_scene(tmp_path / "none.json")
    with pytest.raises(ValueError, match=r"load_scene: path must end in \.json or \.nff, got 'a\.obj'"):
        rb.load_scene("a.obj")
    with pytest.raises(TypeError, match="load_scene: path must be a path"):
        rb.load_scene(None)
