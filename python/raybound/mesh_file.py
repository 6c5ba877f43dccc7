"""Meshes from files, read by the library trimesh (the extra `raybound[mesh]`)."""

from __future__ import annotations

import errno
import io
import logging
import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _gltf, _mesh_text, _validate
from .meshes import Mesh

SUFFIXES = (".obj", ".ply", ".stl", ".gltf", ".glb")
UV = "_raybound_uv"
log = logging.getLogger(__name__)


class _Part(NamedTuple):
    """One geometry of a file, in the file's coordinates."""

    vertices: npt.NDArray[Any]
    faces: npt.NDArray[Any]
    normals: npt.NDArray[Any] | None
    uvs: npt.NDArray[Any] | None


def load_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Reads a mesh from an OBJ, PLY, STL, glTF or GLB file. Needs trimesh: `pip install raybound[mesh]`.

    All geometries of a file are put into one mesh, in its coordinates and order; faces of more than three corners are
    split into fans from their first. Normals and texture coordinates (v pointing up) of the vertices are kept where all
    geometries have them, else left out with a logged warning. Vertices are not merged, but those of an STL file, which
    has three for each triangle, are where they are equal as float32. Colours and materials are left out.

    Raises FileNotFoundError if there is no such file (or none that it refers to), ImportError without trimesh, and
    ValueError naming the path (and the line or the face where it can be told) for an unknown extension and for a file
    that is malformed, truncated or without triangles, or that has a number that is not finite.
    """
    source = _validate.file_path("load_mesh", "path", path)
    suffix = Path(source).suffix.lower()
    if suffix not in SUFFIXES:
        raise ValueError(f"load_mesh: path must end in {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}, got {source!r}")
    if not Path(source).is_file():
        raise FileNotFoundError(errno.ENOENT, "load_mesh: no such mesh file", source)
    try:
        import trimesh  # noqa: F401  # here, so that a missing package is told before the file is looked at
    except ImportError:
        raise ImportError("load_mesh needs trimesh: pip install 'raybound[mesh]'") from None
    try:
        return _joined(source, _read(source, suffix))
    except FileNotFoundError as error:  # of a glTF file's buffer
        lost = error.filename or str(error)
        raise FileNotFoundError(errno.ENOENT, f"load_mesh: {source!r} refers to a missing file", lost) from None
    except (MemoryError, OSError):
        raise
    except Exception as error:  # a malformed file may raise anything in the library
        message = " ".join(str(error).split()) or "unknown reason"
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        raise ValueError(f"load_mesh: cannot read {source!r}: {kind}{message}") from None


def _read(source: str, suffix: str) -> list[_Part]:
    data = Path(source).read_bytes()
    if suffix in (".gltf", ".glb"):
        return _parts(_gltf.plain(data, suffix, UV), suffix, source)
    if suffix == ".stl":
        return [_merged(part) for part in _parts(_checked_stl(data), suffix, source)]
    if suffix == ".ply":
        return _read_ply(data, source)
    text, mixed = _mesh_text.checked_obj(data.decode("utf-8", errors="replace"))
    if mixed:
        log.warning("%s: only some corners have texture coordinates or normals; such kinds are left out", source)
    return _parts(text.encode(), suffix, source)


def _read_ply(data: bytes, source: str) -> list[_Part]:
    header = data[: data.find(b"end_header")].replace(b"\r", b"\n")
    if b"\nformat ascii" in header:
        data = _mesh_text.checked_ply(data.decode("utf-8")).encode()
    # Where faces have texture coordinates, trimesh splits vertices, but not the vertices' normals.
    splits = b"texcoord" in header
    parts = _parts(data, ".ply", source, fix_texture=splits, skip_materials=True)
    if splits and b" nx\n" in header:
        log.warning("%s: normals are left out, as faces have texture coordinates of their own", source)
        parts = [part._replace(normals=None) for part in parts]
    return parts


def _checked_stl(data: bytes) -> bytes:
    """A binary file as it is, if its length is right, or an ASCII one checked."""
    count = int.from_bytes(data[80:84], "little")
    if len(data) >= 84 and len(data) == 84 + 50 * count:
        return data
    if data.lstrip()[:5].lower() != b"solid":
        expected = f"{84 + 50 * count} for its {count} triangles" if len(data) >= 84 else "at least 84"
        raise ValueError(f"a binary STL file must have {expected} bytes, got {len(data)}")
    return _mesh_text.checked_stl(data.decode("utf-8", errors="replace")).encode()


def _parts(data: bytes, suffix: str, source: str, **options: Any) -> list[_Part]:
    """The geometries that trimesh finds, unchanged but for their place in the scene."""
    import trimesh

    resolver = trimesh.resolvers.FilePathResolver(source)
    scene: Any = trimesh.load(
        io.BytesIO(data), file_type=suffix[1:], resolver=resolver, force="scene", process=False, **options
    )
    found = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        geometry = scene.geometry[name]
        if isinstance(geometry, trimesh.Trimesh):
            found.append(_part(geometry, np.asarray(matrix, np.float64)))
        else:
            log.warning("%s: %r has no triangles and is left out", source, name)
    return [part for part in found if len(part.faces)]


def _part(geometry: Any, matrix: npt.NDArray[np.float64]) -> _Part:
    """A geometry moved by a 4 x 4 matrix."""
    vertices, faces = np.array(geometry.vertices), np.array(geometry.faces)
    # Read by the property alone, trimesh would make normals where the file has none.
    normals = np.array(geometry.vertex_normals) if "vertex_normals" in geometry._cache else None
    uvs = geometry.vertex_attributes.get(UV, getattr(geometry.visual, "uv", None))
    if uvs is not None and UV in geometry.vertex_attributes:
        uvs = _gltf.upwards(uvs)
    if not np.array_equal(matrix, np.eye(4)):
        linear = matrix[:3, :3]
        vertices = vertices @ linear.T + matrix[:3, 3]
        if np.linalg.det(linear) < 0:
            faces = faces[:, ::-1]  # a mirror turns triangles around
        if normals is not None:
            normals = normals @ np.linalg.inv(linear)
    return _Part(vertices, faces, normals, None if uvs is None else np.array(uvs))


def _merged(part: _Part) -> _Part:
    """The part with equal vertices shared, in the order of their first use."""
    rounded = part.vertices.astype(np.float32) + np.float32(0)  # -0.0 equals 0.0
    _, first, inverse = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return _Part(part.vertices[first[order]], rank[inverse.reshape(-1)][part.faces], None, None)


def _joined(source: str, parts: list[_Part]) -> Mesh:
    """One mesh of all parts."""
    if not parts:
        raise ValueError("the file must have triangles, got none")
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)])
    vertices = np.concatenate([part.vertices for part in parts])
    normals = _all_or_none(source, "normals", [part.normals for part in parts])
    uvs = _all_or_none(source, "texture coordinates", [part.uvs for part in parts])
    return Mesh(vertices, faces, normals=normals, uvs=uvs)


def _all_or_none(source: str, what: str, arrays: list[npt.NDArray[Any] | None]) -> npt.NDArray[Any] | None:
    present = [array for array in arrays if array is not None]
    if len(present) == len(arrays):
        return np.concatenate(present)
    if present:
        log.warning("%s: %s are left out, only %d of %d geometries have them", source, what, len(present), len(arrays))
    return None
