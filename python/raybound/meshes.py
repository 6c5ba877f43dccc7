"""Triangle meshes: immutable values, as the other shapes are."""

from __future__ import annotations

import hashlib

import numpy as np
import numpy.typing as npt

from . import _core, _validate
from ._validate import FloatArray, IndexArray
from .shapes import Shape

ROWS = 2**18  # that are digested in one go


class Mesh(Shape):
    """A mesh of triangles, flat or with interpolated normals.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Corners, scene units, n >= 3; rounded to float32.
    faces : (m, 3) array_like of whole numbers
        The corners of each triangle as indices of `vertices`, from 0, counter-clockwise as seen from outside; m >= 1.
    normals : (n, 3) array_like or None
        A normal for each vertex, non-zero, of any length; None: triangles are flat.
    uvs : (n, 2) array_like or None
        Texture coordinates for each vertex, v pointing up.

    Attributes of the same names read back as read-only C-contiguous arrays, float32 and int32 (or None). Two meshes are
    equal if all four are.

    Raises
    ------
    ValueError, TypeError
        If a shape, a number or an index is wrong or the triangles enclose no area, naming the argument and the place.
    """

    vertices: FloatArray
    faces: IndexArray
    normals: FloatArray | None
    uvs: FloatArray | None
    _digest: bytes

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        *,
        normals: npt.ArrayLike | None = None,
        uvs: npt.ArrayLike | None = None,
    ) -> None:
        corners = _validate.array("Mesh", "vertices", vertices, shape=(None, 3))
        indices = _validate.indices("Mesh", "faces", faces)
        _check_count("vertices", len(corners), 3, "points")
        _check_count("faces", len(indices), 1, "triangle")
        n = len(corners)
        across = None if normals is None else _validate.array("Mesh", "normals", normals, shape=(n, 3))
        uv = None if uvs is None else _validate.array("Mesh", "uvs", uvs, shape=(n, 2))
        native = _core.mesh(corners, indices, across, uv)
        self._set(vertices=corners, faces=indices, normals=across, uvs=uv, _native=native)
        self._set(_digest=_digest(corners, indices, across, uv))

    def _key(self) -> object:
        return self._digest

    def __repr__(self) -> str:
        extra = "".join(f", {name}" for name in ("normals", "uvs") if getattr(self, name) is not None)
        return f"Mesh(<{len(self.vertices)} vertices, {len(self.faces)} faces{extra}>)"


def _check_count(name: str, count: int, least: int, unit: str) -> None:
    if count < least:
        raise ValueError(f"Mesh: {name} must be at least {least} {unit}, got {count}")


def _digest(*arrays: FloatArray | IndexArray | None) -> bytes:
    """What equality and hashes look at: quick for a million triangles, too. Makes the arrays read-only."""
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(repr(None if array is None else array.shape).encode())
        if array is not None:
            array.flags.writeable = False
            for first in range(0, len(array), ROWS):  # a signal can stop it in between
                rows = array[first : first + ROWS]
                digest.update(np.add(rows, 0, dtype=array.dtype).tobytes())  # -0.0 equals 0.0
    return digest.digest()
