"""`load_mesh`: files of each format, written here by hand, and read back; bad files name the line or what is wrong."""

from __future__ import annotations

import base64
import json
import logging
import struct
import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import raybound as rb

CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
FACES = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
NORMALS = CORNERS - 0.25
UVS = np.array([(0, 0), (1, 0), (0, 0.75), (0.5, 0.25)])
PLAIN = CORNERS[FACES]


def write(tmp_path: Path, name: str, data: str | bytes) -> Path:
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def load(tmp_path: Path, name: str, data: str | bytes) -> rb.Mesh:
    return rb.load_mesh(write(tmp_path, name, data))


def triangles(mesh: rb.Mesh) -> npt.NDArray[np.float32]:
    return mesh.vertices[mesh.faces]


def rows(key: str, values: npt.ArrayLike) -> str:
    return "".join(f"{key} {' '.join(map(str, row))}\n" for row in np.asarray(values).tolist())


# OBJ

OBJ = rows("v", CORNERS) + rows("f", FACES + 1)


def obj_faces(form: str) -> str:
    return "".join("f " + " ".join(form.format(i + 1) for i in face) + "\n" for face in FACES)


def test_obj(tmp_path: Path) -> None:
    mesh = load(tmp_path, "a.obj", OBJ)
    assert mesh == rb.Mesh(CORNERS, FACES)
    assert mesh == rb.load_mesh(str(tmp_path / "a.obj"))
    assert mesh == load(tmp_path, "b.OBJ", OBJ.replace("\n", "\r\n"))


def test_obj_with_normals_and_texture_coordinates(tmp_path: Path) -> None:
    text = rows("v", CORNERS) + rows("vt", UVS) + rows("vn", NORMALS)
    full = load(tmp_path, "a.obj", text + obj_faces("{0}/{0}/{0}"))
    assert full.normals is not None
    assert full.uvs is not None
    np.testing.assert_array_equal(triangles(full), PLAIN)
    np.testing.assert_allclose(full.normals[full.faces], NORMALS[FACES])
    np.testing.assert_allclose(full.uvs[full.faces], UVS[FACES])  # as in the file: v points up in OBJ
    only_uvs = load(tmp_path, "b.obj", text + obj_faces("{0}/{0}"))
    assert only_uvs.normals is None
    assert only_uvs.uvs is not None
    only_normals = load(tmp_path, "c.obj", text + obj_faces("{0}//{0}"))
    assert only_normals.normals is not None
    np.testing.assert_allclose(only_normals.normals[only_normals.faces], NORMALS[FACES])
    assert only_normals.uvs is None
    assert load(tmp_path, "d.obj", text + obj_faces("{0}")) == rb.Mesh(CORNERS, FACES)


def test_obj_seams_split_vertices_only_there(tmp_path: Path) -> None:
    text = rows("v", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]) + rows(
        "vt", [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)]
    )
    mesh = load(tmp_path, "a.obj", text + "f 1/1 2/2 3/3\nf 1/5 3/3 4/4\n")
    assert len(mesh.vertices) == 5
    assert mesh.uvs is not None
    np.testing.assert_allclose(mesh.uvs[mesh.faces[1]], [(0.5, 0.5), (1, 1), (0, 1)])


def test_obj_polygons_are_fans(tmp_path: Path) -> None:
    """Of five, four and three corners."""
    points = [(0, 0, 0), (2, 0, 0), (3, 1, 0), (1, 2, 0), (-1, 1, 0), (0, -1, 0), (2, -1, 0), (1, -3, 0)]
    mesh = load(tmp_path, "a.obj", rows("v", points) + "f 1 2 3 4 5\nf 6 7 2 1\nf 6 8 7")
    expected = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (5, 6, 1), (5, 1, 0), (5, 7, 6)]
    assert {frozenset(face) for face in mesh.faces.tolist()} == {frozenset(face) for face in expected}
    assert len(mesh.faces) == 6


def test_obj_indices_from_the_end_count_from_where_they_stand(tmp_path: Path) -> None:
    parts = [rows("v", CORNERS[:3] + shift) + "f -3 -2 -1\n" for shift in (0, 5)]
    mesh = load(tmp_path, "a.obj", "".join(parts))
    np.testing.assert_array_equal(triangles(mesh), [CORNERS[:3], CORNERS[:3] + 5])


def test_obj_statements_of_no_concern(tmp_path: Path) -> None:
    """Groups, materials and colours change nothing: all faces are one mesh that shares its vertices."""
    text = "# a\nmtllib none.mtl\no first\n" + rows("  v", np.hstack([CORNERS, CORNERS])) + "\tg a\nusemtl red\ns 1\n"
    for i, face in enumerate(FACES + 1):
        text += f"usemtl m{i}\no part{i}\nf {face[0]} {face[1]} \\\n {face[2]}  # {i}\n"
    assert load(tmp_path, "a.obj", text + "l 1 2\np 1\n") == rb.Mesh(CORNERS, FACES)


def test_obj_corners_with_and_without_texture_coordinates(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    text = rows("v", CORNERS) + rows("vt", UVS) + "f 1/1 3/3 2/2\nf 1 2 4\n"
    assert load(tmp_path, "a.obj", text).uvs is None
    assert "only some corners have texture coordinates or normals" in caplog.text


BAD_OBJ = [
    ("", "must have triangles, got none"),
    ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "must have triangles, got none"),
    ("v 0 0\n", "line 1: v must have 3 numbers, got 2"),
    ("\nv 0 0 nan\n", "line 2: v must have finite numbers, got 'nan'"),
    ("v 0 0 1e999\n", "line 1: v must have finite numbers, got '1e999'"),
    ("v 0 zero 0\n", "line 1: v must have finite numbers, got 'zero'"),
    (OBJ + "vn 0 0\n", "line 9: vn must have 3 numbers, got 2"),
    (OBJ + "vt 0\n", "line 9: vt must have 2 numbers, got 1"),
    (OBJ + "f 1 2\n", "line 9: f must have at least 3 corners, got 2"),
    (OBJ + "f 1 2 5\n", "line 9: f refers to vertex 5, but the file has 4"),
    (OBJ + "f 1 2 -5\n", "line 9: a corner of f must have indices from 1, or from -1 back to the first, got '-5'"),
    (OBJ + "f 0 1 2\n", "line 9: a corner of f must have indices from 1"),
    (OBJ + "f 1 2 x\n", "line 9: a corner of f must have indices from 1, or from -1 back to the first, got 'x'"),
    (OBJ + "f 1/1 2/1 3/1\n", "line 9: f refers to texture coordinate 1, but the file has 0"),
    (OBJ + "f 1//2 2//2 3//2\n", "line 9: f refers to normal 2, but the file has 0"),
    (OBJ + "f 1/1/1/1 2 3\n", "line 9: a corner of f must be v, v/vt, v//vn or v/vt/vn, got '1/1/1/1'"),
    (OBJ + "f 1 1 2\n", ""),  # a triangle without area: the core's to tell
    (OBJ + "v 1e39 0 0\nf 5 1 2", "Mesh: vertices must fit in float32"),
]


@pytest.mark.parametrize(("text", "words"), BAD_OBJ, ids=[f"{i} {words[:30]}" for i, (_, words) in enumerate(BAD_OBJ)])
def test_bad_obj(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(ValueError, match=r"load_mesh: cannot read '.*a\.obj': ") as caught:
        load(tmp_path, "a.obj", text)
    assert words in str(caught.value)


# PLY


def ply(
    form: str = "ascii", extra: npt.NDArray[np.float64] | None = None, names: str = "", faces: Any = FACES
) -> bytes:
    values = CORNERS if extra is None else np.hstack([CORNERS, extra])
    properties = "".join(f"property float {name}\n" for name in ("x", "y", "z", *names.split()))
    header = f"ply\nformat {form} 1.0\ncomment made by hand\nelement vertex {len(CORNERS)}\n{properties}"
    header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    if form == "ascii":
        return (header + rows("", values) + "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in faces)).encode()
    order = "<" if "little" in form else ">"
    body = values.astype(f"{order}f4").tobytes()
    return header.encode() + body + b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


FORMS = ["ascii", "binary_little_endian", "binary_big_endian"]


@pytest.mark.parametrize("form", FORMS)
def test_ply(tmp_path: Path, form: str) -> None:
    assert load(tmp_path, "a.ply", ply(form)) == rb.Mesh(CORNERS, FACES)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("names", ["u v", "s t", "texture_u texture_v"])
def test_ply_with_normals_and_texture_coordinates(tmp_path: Path, form: str, names: str) -> None:
    full = ply(form, np.hstack([NORMALS, UVS]), f"nx ny nz {names}")
    assert load(tmp_path, "a.ply", full) == rb.Mesh(CORNERS, FACES, normals=NORMALS, uvs=UVS)
    assert load(tmp_path, "b.ply", ply(form, NORMALS, "nx ny nz")) == rb.Mesh(CORNERS, FACES, normals=NORMALS)


def test_ply_with_quads(tmp_path: Path) -> None:
    mesh = load(tmp_path, "a.ply", ply(faces=[(0, 1, 2, 3), (0, 3, 1)]))
    assert len(mesh.faces) == 3


def test_ply_with_texture_coordinates_of_faces(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Vertices on a seam are split; normals cannot be kept then, which is said."""
    header = "ply\nformat ascii 1.0\ncomment TextureFile lost.png\nelement vertex 4\n"
    header += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    header += "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
    text = header + rows("", np.hstack([CORNERS, NORMALS]))
    mesh = load(tmp_path, "a.ply", text + "\n3 0 1 2 6 0 0 1 0 1 1\n\n3 0 2 3 6 0.5 0.5 1 1 0 1\n")
    np.testing.assert_array_equal(triangles(mesh), CORNERS[[(0, 1, 2), (0, 2, 3)]])
    assert mesh.uvs is not None
    np.testing.assert_allclose(mesh.uvs[mesh.faces], [[(0, 0), (1, 0), (1, 1)], [(0.5, 0.5), (1, 1), (0, 1)]])
    assert len(mesh.vertices) == 5
    assert mesh.normals is None
    (record,) = caplog.records
    assert "normals are left out, as faces have texture coordinates of their own" in record.getMessage()


GOOD_PLY = ply().decode()  # rows of vertices from line 11 on, of faces from line 15 on
BAD_PLY: list[tuple[str | bytes, str]] = [
    (b"", ""),
    (b"plx\n", ""),
    (b"ply\nformat ascii 1.0\nelement vertex 3\n", ""),
    (GOOD_PLY[: GOOD_PLY.index("\n3 ") + 9], "element 'face' must have 4 rows, got 1"),
    (GOOD_PLY.replace("1.0 0.0 0.0\n", "1.0 nan 0.0\n"), "line 12: vertex must have finite numbers, got 'nan'"),
    (GOOD_PLY.replace("1.0 0.0 0.0\n", "1.0 0.0\n"), "line 12: vertex must have 3 numbers, got 2"),
    (GOOD_PLY.replace("3 0 2 1", "4 0 2 1"), "line 15: face must have 5 numbers, got 4"),
    (GOOD_PLY.replace("3 0 2 1", "x 0 2 1"), "line 15: face must have finite numbers, got 'x'"),
    (GOOD_PLY.replace("3 0 2 1", "3 0 2 9"), ""),
    (GOOD_PLY.replace("element vertex 4", "element vertex four"), "line 4: element must have a name and a count"),
    (GOOD_PLY.replace("end_header", "the end"), ""),
    (ply("binary_little_endian")[:-1], ""),
    (ply("binary_little_endian")[:-20], ""),
    (ply("binary_little_endian") + b"more", ""),
    (ply("binary_little_endian", faces=FACES + 3), ""),
    (
        ply("binary_little_endian").replace(struct.pack("<f", 1), struct.pack("<f", np.nan)),
        "Mesh: vertices must be finite",
    ),
    (ply(faces=[]), "must have triangles, got none"),
]


@pytest.mark.parametrize(("data", "words"), BAD_PLY, ids=[f"{i} {words[:30]}" for i, (_, words) in enumerate(BAD_PLY)])
def test_bad_ply(tmp_path: Path, data: str | bytes, words: str) -> None:
    with pytest.raises(ValueError, match=r"load_mesh: cannot read '.*a\.ply': ") as caught:
        load(tmp_path, "a.ply", data)
    assert words in str(caught.value)


# STL


def ascii_stl(name: str = "a solid vertex", shift: float = 0) -> str:
    text = f"solid {name}\n"
    for corners in PLAIN + shift:
        text += f"  facet normal 0 0 1\n    outer loop\n{rows('      vertex', corners)}    endloop\n  endfacet\n"
    return text + f"endsolid {name}\n"


def binary_stl(header: bytes = b"solid but binary") -> bytes:
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *corners.reshape(-1), 0) for corners in PLAIN)
    return header.ljust(80, b" ") + struct.pack("<I", len(PLAIN)) + body


@pytest.mark.parametrize("data", [ascii_stl(), ascii_stl().upper(), binary_stl()])
def test_stl_shares_equal_vertices(tmp_path: Path, data: str | bytes) -> None:
    mesh = load(tmp_path, "a.stl", data)
    assert len(mesh.vertices) == 4
    np.testing.assert_array_equal(triangles(mesh), PLAIN)
    assert mesh.normals is None
    assert mesh.uvs is None


def test_stl_of_several_solids_is_one_mesh(tmp_path: Path) -> None:
    mesh = load(tmp_path, "a.stl", ascii_stl("") + ascii_stl("b", 5))
    assert len(mesh.vertices) == 8
    np.testing.assert_array_equal(triangles(mesh), np.concatenate([PLAIN, PLAIN + 5]))


def test_stl_merges_nothing_but_equals(tmp_path: Path) -> None:
    near = np.float32(1) + np.float32(2**-23)
    data = binary_stl().replace(struct.pack("<f", 1), struct.pack("<f", near), 1)
    assert len(load(tmp_path, "a.stl", data).vertices) == 5


GOOD_STL = ascii_stl("a")
BAD_STL: list[tuple[str | bytes, str]] = [
    (b"", "a binary STL file must have at least 84 bytes, got 0"),
    (binary_stl()[:-1], ""),
    (binary_stl(b"binary")[:-1], "a binary STL file must have 284 for its 4 triangles bytes, got 283"),
    ("solid a\nendsolid a\n", "must have triangles, got none"),
    (GOOD_STL[: GOOD_STL.index("endsolid")], "line 29: the file must go on to endsolid, got its end"),
    (GOOD_STL[:70], "the file must go on to endsolid"),
    (GOOD_STL.replace("vertex 0.0 1.0 0.0", "vertex 0.0 1.0", 1), "line 5: vertex must have 3 numbers, got 2"),
    (
        GOOD_STL.replace("vertex 0.0 1.0 0.0", "vertex 0.0 inf 0", 1),
        "line 5: vertex must have finite numbers, got 'inf'",
    ),
    (GOOD_STL.replace("      vertex 0.0 1.0 0.0\n", "", 1), "line 6: a facet must have 3 vertices, got 2"),
    (
        GOOD_STL.replace("    endloop\n", "vertex 1 2 3\nendloop\n", 1),
        "line 7: a facet must have 3 vertices, got 4 or more",
    ),
    (GOOD_STL.replace("    outer loop\n", "", 1), "line 3: outer must follow, got 'vertex'"),
    (GOOD_STL.replace("  endfacet\n", "endfacets\n", 1), "line 8: endfacet must follow, got 'endfacets'"),
]


@pytest.mark.parametrize(("data", "words"), BAD_STL, ids=[f"{i} {words[:30]}" for i, (_, words) in enumerate(BAD_STL)])
def test_bad_stl(tmp_path: Path, data: str | bytes, words: str) -> None:
    with pytest.raises(ValueError, match=r"load_mesh: cannot read '.*a\.stl': ") as caught:
        load(tmp_path, "a.stl", data)
    assert words in str(caught.value)


# glTF


def gltf(
    nodes: list[dict[str, Any]], *, normals: bool = True, uvs: bool = True, uri: str | None = ""
) -> tuple[Any, bytes]:
    """The header and the buffer of a file with a tetrahedron, v pointing down as glTF has it."""
    down = np.column_stack([UVS[:, 0], 1 - UVS[:, 1]])
    arrays = {
        "POSITION": CORNERS.astype("<f4"),
        **({"NORMAL": NORMALS.astype("<f4")} if normals else {}),
        **({"TEXCOORD_0": down.astype("<f4")} if uvs else {}),
        "indices": FACES.astype("<u2").reshape(-1),
    }
    kinds = {"POSITION": "VEC3", "NORMAL": "VEC3", "TEXCOORD_0": "VEC2", "indices": "SCALAR"}
    views, accessors, data = [], [], b""
    for name, array in arrays.items():
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        component = 5123 if name == "indices" else 5126
        kind = {"type": kinds[name], "componentType": component, "count": len(array)}
        if name == "POSITION":
            kind |= {"min": [0, 0, 0], "max": [1, 1, 1]}
        accessors.append({"bufferView": len(views) - 1, **kind})
        data += array.tobytes()
    attributes = {name: i for i, name in enumerate(arrays) if name != "indices"}
    if uri == "":
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    header = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": attributes, "indices": len(accessors) - 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"uri": "lost.png"}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data), **({} if uri is None else {"uri": uri})}],
    }
    return header, data


def glb(header: Any, data: bytes) -> bytes:
    text = json.dumps(header).encode()
    chunks = b""
    for kind, chunk, fill in ((b"JSON", text, b" "), (b"BIN\0", data, b"\0")):
        chunk += fill * (-len(chunk) % 4)
        chunks += struct.pack("<I", len(chunk)) + kind + chunk
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


FULL_NODE: list[dict[str, Any]] = [{"mesh": 0}]


def test_gltf(tmp_path: Path) -> None:
    expected = rb.Mesh(CORNERS, FACES, normals=NORMALS, uvs=UVS)
    assert load(tmp_path, "a.gltf", json.dumps(gltf(FULL_NODE)[0])) == expected
    assert load(tmp_path, "a.glb", glb(*gltf(FULL_NODE, uri=None))) == expected
    header, data = gltf(FULL_NODE, uri="a%20b.bin")
    write(tmp_path, "a b.bin", data)
    assert load(tmp_path, "b.gltf", json.dumps(header)) == expected
    bare = load(tmp_path, "c.glb", glb(*gltf(FULL_NODE, uri=None, normals=False, uvs=False)))
    assert bare == rb.Mesh(CORNERS, FACES)


def test_gltf_nodes_move_their_meshes(tmp_path: Path) -> None:
    """Translated, turned by 90 degrees about z, squeezed, mirrored, and a child in its parent's coordinates."""
    turn = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
    nodes: list[dict[str, Any]] = [
        {"mesh": 0, "translation": [5, 0, 0]},
        {"mesh": 0, "rotation": turn},
        {"mesh": 0, "scale": [1, 1, 4]},
        {"mesh": 0, "scale": [-3, 1, 1]},
        {"translation": [0, 7, 0], "children": [5]},
        {"mesh": 0, "scale": [2, 2, 2]},
    ]
    header, data = gltf(nodes, uri=None)
    header["scenes"][0]["nodes"] = [0, 1, 2, 3, 4]
    mesh = load(tmp_path, "a.glb", glb(header, data))
    spin = np.array([(0, -1, 0), (1, 0, 0), (0, 0, 1)])
    # The linear part and the shift of each; normals go by the inverse transpose.
    moves = [(np.eye(3), (5, 0, 0)), (spin, (0, 0, 0)), (np.diag([1, 1, 4]), (0, 0, 0))]
    moves += [(np.diag([-3, 1, 1]), (0, 0, 0)), (2 * np.eye(3), (0, 7, 0))]
    assert len(mesh.vertices) == 20
    assert mesh.normals is not None
    found = set()
    for linear, shift in moves:
        vertices = CORNERS @ linear.T + shift
        (at,) = (i for i in range(0, 20, 4) if np.allclose(mesh.vertices[i : i + 4], vertices, atol=1e-6))
        found.add(at)
        np.testing.assert_allclose(unit(mesh.normals[at : at + 4]), unit(NORMALS @ np.linalg.inv(linear)), atol=1e-6)
        corners = triangles(mesh)[at : at + 4].astype(float)
        outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (((corners.mean(axis=1) - vertices.mean(axis=0)) * outward).sum(axis=1) > 0).all()
    assert len(found) == 5


def unit(vectors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    lengths: npt.NDArray[np.float64] = np.linalg.norm(vectors, axis=1)[:, None]
    return vectors / lengths


def test_gltf_texture_coordinates_as_integers(tmp_path: Path) -> None:
    header, data = gltf(FULL_NODE, uri=None)
    view = header["bufferViews"][2]
    codes = np.round(np.column_stack([UVS[:, 0], 1 - UVS[:, 1]]) * 65535).astype("<u2")
    view["byteLength"] = codes.nbytes
    header["accessors"][2] |= {"componentType": 5123, "normalized": True}
    start = view["byteOffset"]
    mesh = load(tmp_path, "a.glb", glb(header, data[:start] + codes.tobytes() + data[start + codes.nbytes :]))
    assert mesh.uvs is not None
    np.testing.assert_allclose(mesh.uvs, UVS, atol=1e-5)


def test_gltf_parts_of_which_some_lack_normals(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    header, data = gltf(FULL_NODE, uri=None)
    first = header["meshes"][0]["primitives"][0]
    header["meshes"][0]["primitives"].append({**first, "attributes": {"POSITION": 0}})
    mesh = load(tmp_path, "a.glb", glb(header, data))
    assert len(mesh.faces) == 8
    assert mesh.normals is None
    assert mesh.uvs is None
    assert "normals are left out, only 1 of 2 geometries have them" in caplog.text


def test_gltf_lines_are_left_out_with_a_warning(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    header, data = gltf(FULL_NODE, uri=None)
    header["meshes"][0]["primitives"].append({"mode": 0, "attributes": {"POSITION": 0}})
    assert len(load(tmp_path, "a.glb", glb(header, data)).faces) == 4
    assert "has no triangles and is left out" in caplog.text


def changed(**changes: Any) -> bytes:
    header, data = gltf(FULL_NODE, uri=None)
    return glb({**header, **changes}, data)


GOOD_GLB = glb(*gltf(FULL_NODE, uri=None))
BAD_GLTF: list[tuple[str, str | bytes, str]] = [
    ("a.glb", b"", "a GLB file must start with"),
    ("a.glb", b"glTX" + GOOD_GLB[4:], "a GLB file must start with"),
    ("a.glb", GOOD_GLB[:-10], f"as long as it says ({len(GOOD_GLB)} bytes), got {len(GOOD_GLB) - 10}"),
    ("a.glb", GOOD_GLB[:40], "as long as it says"),
    ("a.glb", GOOD_GLB.replace(b'"asset"', b'"asset!'), ""),
    ("a.glb", GOOD_GLB.replace(struct.pack("<f", 1), struct.pack("<f", np.inf)), "Mesh: vertices must be finite"),
    (
        "a.glb",
        changed(extensionsRequired=["KHR_draco_mesh_compression"]),
        "KHR_draco_mesh_compression, which cannot be",
    ),
    ("a.glb", changed(accessors=[]), ""),
    ("a.glb", changed(meshes=[{"primitives": [{"mode": 6, "attributes": {"POSITION": 0}}]}]), "got a fan"),
    ("a.glb", changed(meshes=[{"primitives": [{"mode": 1, "attributes": {"POSITION": 0}}]}]), ""),
    ("a.glb", changed(nodes=[{"mesh": 0, "scale": [0, 0, 0]}]), ""),
    ("a.glb", changed(meshes=[{}]), ""),
    ("a.gltf", "", ""),
    ("a.gltf", "[1]", "the header must be a JSON object"),
    ("a.gltf", '{"asset": {"version": "2.0"}}', "must have triangles, got none"),
    ("a.gltf", json.dumps(gltf(FULL_NODE, uri="data:application/octet-stream;base64,AAAA")[0]), ""),
]


@pytest.mark.parametrize(
    ("name", "data", "words"), BAD_GLTF, ids=[f"{i} {words[:30]}" for i, (_, _, words) in enumerate(BAD_GLTF)]
)
def test_bad_gltf(tmp_path: Path, name: str, data: str | bytes, words: str) -> None:
    with pytest.raises(ValueError, match=rf"load_mesh: cannot read '.*{name}': ") as caught:
        load(tmp_path, name, data)
    assert words in str(caught.value)


# All formats


def test_every_cut_of_a_file_is_an_error_or_a_mesh(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Never another exception, never more triangles than there were, and binary files only as a whole."""
    caplog.set_level(logging.ERROR)
    files = {"a.obj": OBJ.encode(), "a.ply": ply(), "b.ply": ply(FORMS[1]), "a.stl": ascii_stl().encode()}
    files |= {"b.stl": binary_stl(b"binary"), "a.glb": GOOD_GLB}
    for name, data in files.items():
        whole = []
        for end in range(0, len(data), 13):
            try:
                whole.append(load(tmp_path, name, data[:end]))
            except ValueError:
                continue
        assert all(len(mesh.faces) <= len(FACES) for mesh in whole)
        if name in ("b.ply", "b.stl", "a.glb"):
            assert not whole, name


def test_a_buffer_that_is_missing(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"a\.gltf' refers to a missing file: .*lost\.bin'"):
        load(tmp_path, "a.gltf", json.dumps(gltf(FULL_NODE, uri="lost.bin")[0]))


def test_paths_that_are_wrong(tmp_path: Path) -> None:
    for name in ("none.obj", "none.glb"):
        with pytest.raises(FileNotFoundError, match=rf"load_mesh: no such mesh file.*{name}"):
            rb.load_mesh(tmp_path / name)
    with pytest.raises(
        ValueError, match=r"load_mesh: path must end in \.obj, \.ply, \.stl, \.gltf or \.glb, got 'a\.off'"
    ):
        rb.load_mesh("a.off")
    with pytest.raises(ValueError, match=r"load_mesh: path must end in"):
        rb.load_mesh("obj")
    with pytest.raises(TypeError, match="load_mesh: path must be a path"):
        rb.load_mesh(None)  # type: ignore[arg-type]
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(FileNotFoundError, match=r"folder\.obj"):
        rb.load_mesh(tmp_path / "folder.obj")


def test_without_the_extra_the_error_names_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path, "a.obj", OBJ)
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(ImportError, match=r"load_mesh needs trimesh: pip install 'raybound\[mesh\]'"):
        rb.load_mesh(path)


def test_loading_prints_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for name, data in {"a.obj": OBJ, "a.ply": ply(), "a.stl": binary_stl(), "a.glb": GOOD_GLB}.items():
        load(tmp_path, name, data)
    assert capfd.readouterr() == ("", "")
