"""glTF files without what meshes do not need, so that a library reads their texture coordinates as plain attributes.

Source: Khronos Group, "glTF 2.0 Specification", sections 3.6, 3.7 and 4.4.
"""

from __future__ import annotations

import json
import struct
import urllib.parse
from typing import Any

import numpy as np
import numpy.typing as npt

MAGIC, JSON_CHUNK = b"glTF", b"JSON"
TRIANGLES, STRIP, FAN = 4, 5, 6


def plain(data: bytes, suffix: str, uv: str) -> bytes:
    """The file without materials, textures and images, its first texture coordinates as the attribute `uv`.

    Raises ValueError if it is truncated or needs what cannot be read.
    """
    if suffix == ".gltf":
        return json.dumps(_stripped(json.loads(data), uv)).encode()
    if len(data) < 20 or data[:4] != MAGIC or data[16:20] != JSON_CHUNK:
        raise ValueError("a GLB file must start with the word glTF and a chunk of JSON")
    version, length, size = struct.unpack("<III", data[4:16])
    if version != 2 or length != len(data) or 20 + size > len(data):
        raise ValueError(f"a GLB file must be of version 2 and as long as it says ({length} bytes), got {len(data)}")
    header = json.dumps(_stripped(json.loads(data[20 : 20 + size]), uv)).encode()
    header += b" " * (-len(header) % 4)
    rest = data[20 + size :]
    return MAGIC + struct.pack("<III", 2, 20 + len(header) + len(rest), len(header)) + JSON_CHUNK + header + rest


def upwards(uvs: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Texture coordinates with v pointing up; integers are fractions of their largest value."""
    scale = np.iinfo(uvs.dtype).max if uvs.dtype.kind in "iu" else 1
    return np.column_stack([uvs[:, 0] / scale, 1 - uvs[:, 1] / scale])


def _stripped(header: Any, uv: str) -> dict[str, Any]:
    if not isinstance(header, dict):
        raise ValueError("the header must be a JSON object")  # noqa: TRY004  # of a file, not of an argument
    for name in header.get("extensionsRequired", []):
        if not name.startswith("KHR_materials_"):
            raise ValueError(f"the file needs the extension {name}, which cannot be read")
    for key in ("materials", "textures", "images", "samplers", "animations", "skins", "cameras"):
        header.pop(key, None)
    for buffer in header.get("buffers", []):
        if not buffer.get("uri", "data:").startswith("data:"):
            buffer["uri"] = urllib.parse.unquote(buffer["uri"])
    for i, mesh in enumerate(header.get("meshes", [])):
        for primitive in mesh["primitives"]:
            if primitive.get("mode", TRIANGLES) == FAN:
                raise ValueError(f"mesh {i} must consist of triangles or strips of them, got a fan")
            primitive.pop("material", None)
            attributes = primitive["attributes"]
            if "TEXCOORD_0" in attributes:
                attributes[uv] = attributes.pop("TEXCOORD_0")
    return header
