"""Scenes as plain JSON: `Scene.to_dict`, `Scene.from_dict`, `load_scene` and `Scene.save`.

    {"format": "raybound scene",
     "version": 1,
     "ambient": [r, g, b],
     "background": [r, g, b],
     "camera": {"eye": [x, y, z], ...} or null,
     "textures": [{"path": "wood.png", "scale": [1, 1], "wrap": "repeat" or [u, v] or null},
                  {"texels": {"shape": [h, w, 3], "base64": "..."}}],
     "meshes": [{"vertices": {"shape": [n, 3], "base64": "..."}, "faces": {"shape": [m, 3], "base64": "..."},
                 "normals": null, "uvs": null}],
     "materials": [{"diffuse": [r, g, b] or number or {"texture": 0}, "specular": ...}],
     "shapes": [{"type": "Union", "shapes": [{"type": "Sphere"}, ...]}],
     "objects": [{"name": "ball", "shape": {"type": "Sphere", ...}, "material": 0, "transform": [[4 x 4]]}],
     "lights": [{"name": "lamp", "light": {"type": "PointLight", "position": [x, y, z], ...}}]}

Shapes, lights, materials, textures and cameras are objects whose keys are their constructor's arguments; those with a
default may be left out, and so may names, transforms and every list. Numbers are written with the digits that give the
same float32. Texels are little-endian float32, linear, top row first. A shape {"type": "Mesh", "mesh": 0} refers to the
list of meshes, whose arrays are nested lists or little-endian float32 in base64, and int32 for faces. A shape
{"shape": 0} refers to the list of shapes, where each may refer to those before it: what nests deep is written there.
"""

from __future__ import annotations

import base64
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _validate, nff
from ._description import arguments_of, check_keys, class_named, items, make, pick
from ._nest import apart
from ._shape_file import Known, shape_from_dict
from ._validate import FloatArray, IndexArray
from ._value import Value
from .camera import Camera
from .lights import DirectionalLight, Light, PointLight, SpotLight
from .materials import Material, Texture
from .meshes import Mesh
from .scene import Scene
from .shapes import Shape
from .transform import Transform

FORMAT, VERSION = "raybound scene", 1
LIGHTS: dict[str, type[Light]] = {cls.__name__: cls for cls in (DirectionalLight, PointLight, SpotLight)}
KEYS = (
    "format",
    "version",
    "ambient",
    "background",
    "camera",
    "textures",
    "meshes",
    "shapes",
    "materials",
    "objects",
    "lights",
)


# Writing


class _Writer:
    """Numbers the materials, textures and meshes of one scene while its objects are written."""

    def __init__(self, folder: str | None) -> None:
        self.folder = folder
        self.materials: list[dict[str, Any]] = []
        self.textures: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.shapes: list[dict[str, Any]] = []
        self.places: dict[int, int] = {}  # in the list of shapes, by id
        self.indices: dict[Material | Texture | Mesh, int] = {}

    def value(self, value: object) -> Any:
        """A field's value as plain JSON."""
        if isinstance(value, Texture):
            if value not in self.indices:
                self.indices[value] = len(self.textures)
                self.textures.append(self.texture(value))
            return {"texture": self.indices[value]}
        if isinstance(value, Transform):
            return _plain(value.matrix)
        if isinstance(value, Shape):
            return self.typed(value)
        if isinstance(value, tuple) and value and isinstance(value[0], Shape):
            return [self.typed(shape) for shape in value]
        return _plain(value)

    def fields(self, value: Value) -> dict[str, Any]:
        return {name: self.value(getattr(value, name)) for name in value._fields}

    def typed(self, value: Value) -> dict[str, Any]:
        if isinstance(value, Mesh):
            if value not in self.indices:
                self.indices[value] = len(self.meshes)
                self.meshes.append({name: _encoded(getattr(value, name)) for name in value._fields})
            return {"type": "Mesh", "mesh": self.indices[value]}
        if id(value) in self.places:
            return {"shape": self.places[id(value)]}
        return {"type": type(value).__name__, **self.fields(value)}

    def deep(self, shapes: list[Shape]) -> None:
        """Writes what of these nests too deep into the list of shapes."""
        for value in apart(shapes):
            written = self.typed(value)
            self.places[id(value)] = len(self.shapes)
            self.shapes.append(written)

    def material(self, value: Material) -> int:
        if value not in self.indices:
            self.indices[value] = len(self.materials)
            self.materials.append(self.fields(value))
        return self.indices[value]

    def texture(self, value: Texture) -> dict[str, Any]:
        source: dict[str, Any] = {"scale": _plain(value.scale), "wrap": _plain(value.wrap)}
        if value._location is not None:
            return {"path": self.path(value._location), **source}
        return {"texels": _encoded(value.texels), **source}

    def path(self, location: str) -> str:
        """A texture's path: relative to the file's folder if it lies in there, else absolute."""
        if self.folder is not None and Path(location).is_relative_to(self.folder):
            return Path(location).relative_to(self.folder).as_posix()
        return location


def _encoded(array: FloatArray | IndexArray | None) -> dict[str, Any] | None:
    """An array's shape and its little-endian float32 or int32 as base64."""
    if array is None:
        return None
    data = array.astype(array.dtype.newbyteorder("<")).tobytes()
    return {"shape": list(array.shape), "base64": base64.b64encode(data).decode("ascii")}


def _plain(value: object) -> Any:
    """Numbers, tuples and arrays as JSON; floats with the fewest digits that give the same float32."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (tuple, list)):
        return [_plain(item) for item in value]
    return float(str(np.float32(value))) if isinstance(value, float) else value


def to_dict(scene: Scene, folder: str | None = None) -> dict[str, Any]:
    """A plain-JSON description of the scene; paths in `folder` become relative to it."""
    with scene._lock:
        records = scene._records.copy()
    writer = _Writer(folder)
    writer.deep([record.shape for record in records.objects.values()])
    objects = [
        {
            "name": record.name,
            "shape": writer.typed(record.shape),
            "material": writer.material(record.material),
            "transform": writer.value(record.transform),
        }
        for record in records.objects.values()
    ]
    return {
        "format": FORMAT,
        "version": VERSION,
        "ambient": _plain(records.ambient),
        "background": _plain(records.background),
        "camera": None if records.camera is None else writer.fields(records.camera),
        "textures": writer.textures,
        "meshes": writer.meshes,
        **({"shapes": writer.shapes} if writer.shapes else {}),
        "materials": writer.materials,
        "objects": objects,
        "lights": [{"name": r.name, "light": writer.typed(r.light)} for r in records.lights.values()],
    }


def save_scene(scene: Scene, path: str | os.PathLike[str]) -> None:
    """Writes a .json file. ValueError for another extension, FileNotFoundError if the folder is missing."""
    target = _validate.file_path("Scene.save", "path", path)
    if Path(target).suffix.lower() != ".json":
        raise ValueError(f"Scene.save: path must end in .json, got {target!r}")
    text = json.dumps(to_dict(scene, str(Path(target).absolute().parent)), indent=1, allow_nan=False)
    Path(target).write_text(text + "\n", encoding="utf-8")


# Reading


def load_scene(path: str | os.PathLike[str]) -> Scene:
    """Reads a scene with its camera from a .json file (ours) or an .nff file (the Neutral File Format).

    What NFF leaves open is decided as the Standard Procedural Databases suggest: `angle` is the vertical field of view;
    each of n lights has the intensity sqrt(n) / (2 n), times its colour if it has one, without falloff, and ambient
    light the same; Phong's highlight becomes the Ward lobe of equal peak and width, sigma = 1 / sqrt(2 Shine). Cones
    and cylinders, which have no caps in NFF, are solids here. Each primitive is one object without a name, in the
    file's order; polygons that are not convex and planar become meshes of triangles, which takes the extra
    `raybound[mesh]`.

    Raises FileNotFoundError if the file (or a texture's) is missing, ValueError for an unknown extension, for text that
    is not JSON or NFF, and for unknown, missing or wrong entries, naming them (and the line, for NFF), ImportError if
    the extra is needed and missing.
    """
    source = _validate.file_path("load_scene", "path", path)
    suffix = Path(source).suffix.lower()
    if suffix not in (".json", ".nff"):
        raise ValueError(f"load_scene: path must end in .json or .nff, got {source!r}")
    data = Path(source).read_bytes()
    if suffix == ".nff":
        return nff.parse(data, source)
    try:
        d = json.loads(data)
    except RecursionError:
        raise ValueError(
            f"load_scene: {source!r} nests too deep for JSON (shapes may be in the list 'shapes' instead)"
        ) from None
    except ValueError as error:  # JSONDecodeError or UnicodeDecodeError
        raise ValueError(f"load_scene: {source!r} is not JSON: {error}") from None
    return from_dict(d, folder=str(Path(source).absolute().parent), who=f"load_scene: {source!r}")


def from_dict(d: Mapping[str, Any], folder: str | None = None, who: str = "Scene.from_dict") -> Scene:
    """The scene that `to_dict` described; relative paths of textures start at `folder` (default: the current one)."""
    check_keys(who, d, KEYS)
    if d.get("format", FORMAT) != FORMAT or d.get("version", VERSION) != VERSION:
        found = f"{d.get('format')!r}, {d.get('version')!r}"
        raise ValueError(f"{who}: format and version must be {FORMAT!r}, {VERSION}, got {found}")
    scene = make(who, Scene, d.get("ambient", 0.0), d.get("background", 0.0))
    if d.get("camera") is not None:
        scene.camera = camera_from_dict(d["camera"], f"{who}: camera")
    textures = [_texture(item, folder, at) for at, item in items(who, d, "textures")]
    known = Known([_mesh(item, at) for at, item in items(who, d, "meshes")], [])
    for at, item in items(who, d, "shapes"):
        known.shapes.append(shape_from_dict(item, known, at))
    materials = [_material(item, textures, at) for at, item in items(who, d, "materials")]
    with scene.edit():
        for at, item in items(who, d, "objects"):
            check_keys(at, item, ("name", "shape", "material", "transform"), required=("shape", "material"))
            material = pick(f"{at}.material", item["material"], materials)
            matrix = item.get("transform")
            by = None if matrix is None else make(at, Transform, matrix)
            shape = shape_from_dict(item["shape"], known, f"{at}.shape")
            make(at, scene.add, shape, material, name=item.get("name"), transform=by)
        for at, item in items(who, d, "lights"):
            check_keys(at, item, ("name", "light"), required=("light",))
            make(at, scene.add_light, _light(item["light"], f"{at}.light"), name=item.get("name"))
    return scene


def camera_from_dict(d: object, who: str) -> Camera:
    """A camera from its constructor's arguments."""
    return make(who, Camera, **arguments_of(who, d, Camera))


def _light(d: object, who: str) -> Light:
    cls = class_named(who, d, LIGHTS)
    made: Light = make(who, cls, **arguments_of(who, d, cls, ("type",)))
    return made


def _material(d: object, textures: list[Texture], who: str) -> Material:
    arguments = arguments_of(who, d, Material)
    diffuse = arguments.get("diffuse")
    if isinstance(diffuse, Mapping):
        index = check_keys(f"{who}.diffuse", diffuse, ("texture",), ("texture",))["texture"]
        arguments["diffuse"] = pick(f"{who}.diffuse.texture", index, textures)
    return make(who, Material, **arguments)


def _texture(d: object, folder: str | None, who: str) -> Texture:
    found = check_keys(who, d, ("path", "texels", "scale", "wrap"))
    if ("path" in found) == ("texels" in found):
        raise ValueError(f"{who} must have one of the keys 'path' and 'texels'")
    rest = {key: found[key] for key in ("scale", "wrap") if key in found}
    if "texels" in found:
        return make(who, Texture, _decoded(found["texels"], "<f4", f"{who}.texels", "texels"), **rest)
    path = _validate.file_path(who, "path", found["path"])
    return make(who, Texture, path if folder is None else str(Path(folder, path)), **rest)


def _mesh(d: object, who: str) -> Mesh:
    arguments = arguments_of(who, d, Mesh)
    for name, value in arguments.items():
        if isinstance(value, Mapping):
            arguments[name] = _decoded(value, "<i4" if name == "faces" else "<f4", f"{who}.{name}", "numbers")
    return make(who, Mesh, **arguments)


def _decoded(d: object, dtype: str, who: str, what: str) -> npt.NDArray[Any]:
    """The array that `_encoded` wrote."""
    found = check_keys(who, d, ("shape", "base64"), ("shape", "base64"))
    try:
        data = np.frombuffer(base64.b64decode(found["base64"], validate=True), dtype)
        return data.reshape(found["shape"]).astype(data.dtype.newbyteorder("="))
    except (ValueError, TypeError) as error:
        kind = "float32" if dtype == "<f4" else "int32"
        raise ValueError(f"{who} must be {kind} {what} of that shape in base64: {error}") from None
