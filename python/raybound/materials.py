"""Materials and textures."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _validate, images
from ._validate import Colour, FloatArray, packed
from ._value import Value, expression

WRAPS = ("repeat", "clamp", "mirror")
Wrap = str | tuple[str, str] | None


class Texture(Value):
    """A picture on a surface, looked up bilinearly. An immutable value.

    Parameters
    ----------
    source : str, pathlib.Path or array_like
        Any file that OpenImageIO reads, or an (h, w, 3) array. As in a picture, row 0 is the top; v points up, so row 0
        lies at v = 1. Files of 8 and 16 bits are sRGB and are made linear, float files are linear already; grey is
        repeated, alpha is left out. Arrays of dtype uint8 and uint16 are treated as such files are, all others are
        linear RGB.
    scale : (float, float)
        How often the picture repeats over u and v in [0, 1].
    wrap : {"repeat", "clamp", "mirror"}, a pair of these for (u, v), or None
        What lies outside [0, 1] after scaling. None: what suits the chart of the face. Everywhere the texture repeats;
        but where u goes once around an axis and v from one end to the other (spheres, the sides of cylinders and
        cones, the curved face of quadrics) it ends with v: no pole takes colour from the other one.

    Attributes: `path` (as given, or None for an array), `texels` ((h, w, 3) float32, linear, read-only), `scale`,
    `wrap`. The file is read once, here. Two textures are equal if their texels, scale and wrap are; `path` does not
    count.

    Raises
    ------
    FileNotFoundError, ValueError, TypeError
        If the file is missing or cannot be read, an array's shape or a value is wrong, texels are not finite.
    """

    path: str | None
    texels: FloatArray
    scale: tuple[float, float]
    wrap: Wrap
    _location: str | None  # absolute: scene files need it after a change of folder
    _digest: bytes
    _native: _core.Texture

    def __init__(
        self,
        source: str | os.PathLike[str] | npt.ArrayLike,
        scale: tuple[float, float] = (1.0, 1.0),
        *,
        wrap: Wrap = None,
    ) -> None:
        path = None
        if isinstance(source, (str, os.PathLike)):
            path = _validate.file_path("Texture", "source", source)
            texels = images.read_linear(path, "Texture")
        elif isinstance(source, np.ndarray) and source.dtype.kind == "u" and source.dtype.itemsize <= 2:
            texels = images.linear_from_codes(_check_texels(source))
        else:
            texels = _validate.array("Texture", "source", source, shape=(None, None, 3))
        self._adopt(path, None if path is None else str(Path(path).absolute()), texels, scale, wrap)

    def _adopt(self, path: str | None, location: str | None, texels: FloatArray, scale: object, wrap: object) -> None:
        u, v = _validate.array("Texture", "scale", scale, shape=(2,)).tolist()
        self._set(path=path, _location=location, scale=(u, v), wrap=_wrap(wrap))
        upwards = _validate.array("Texture", "source", _check_texels(texels)[::-1], shape=(None, None, 3))
        upwards.flags.writeable = False
        digest = hashlib.sha256(repr(upwards.shape).encode() + (upwards + np.float32(0)).tobytes()).digest()
        self._set(texels=upwards[::-1], _digest=digest, _native=_core.texture(upwards, u, v, *_by_axis(self.wrap)))

    @property
    def source(self) -> str | FloatArray:
        """The path, or for a texture from an array its texels."""
        return self.texels if self.path is None else self.path

    def replace(self, **changes: Any) -> Texture:
        """A copy with another `source`, `scale` or `wrap`; the file is not read again unless `source` is given."""
        unknown = sorted(changes.keys() - set(self._fields))
        if unknown:
            raise TypeError(f"Texture.replace: unknown argument {unknown[0]!r}")
        scale, wrap = changes.get("scale", self.scale), changes.get("wrap", self.wrap)
        if "source" in changes:
            return Texture(changes["source"], scale, wrap=wrap)
        return _restore_texture(self.path, self._location, self.texels, scale, wrap)

    def _key(self) -> object:
        return self._digest, self.scale, self.wrap

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore_texture, (self.path, self._location, np.array(self.texels), self.scale, self.wrap)

    def __repr__(self) -> str:
        height, width, _ = self.texels.shape
        source = f"<array of {height} x {width} texels>" if self.path is None else repr(self.path)
        shown = "" if self.scale == (1.0, 1.0) else f", scale={expression(self.scale)}"
        return f"Texture({source}{shown}{'' if self.wrap is None else f', wrap={self.wrap!r}'})"


def _wrap(value: object) -> Wrap:
    """A word, a pair of words for (u, v) (which is one word if both are the same), or None."""
    if value is None:
        return None
    if isinstance(value, (tuple, list)):
        if len(value) != 2:
            raise ValueError(f"Texture: wrap must be a word or a pair of words (u, v), got {_validate.describe(value)}")
        u, v = (_validate.choice("Texture", f"wrap[{i}]", word, WRAPS) for i, word in enumerate(value))
        return u if u == v else (u, v)
    return _validate.choice("Texture", "wrap", value, WRAPS)


def _by_axis(wrap: Wrap) -> tuple[str, str]:
    """The core's words for u and v."""
    if wrap is None:
        return "chart", "chart"
    return (wrap, wrap) if isinstance(wrap, str) else wrap


def _check_texels(texels: npt.NDArray[Any]) -> npt.NDArray[Any]:
    if texels.ndim != 3 or texels.shape[2] != 3 or not texels.size:
        expected = "an array of shape (h, w, 3) with h, w >= 1"
        raise ValueError(f"Texture: source must be {expected}, got shape {texels.shape}")
    return texels


def _restore_texture(
    path: str | None, location: str | None, texels: FloatArray, scale: object, wrap: object
) -> Texture:
    """A texture with these linear texels, without reading a file."""
    result = object.__new__(Texture)
    result._adopt(path, location, texels, scale, wrap)
    return result


class Material(Value):
    """Ward's isotropic reflection with Whitted's terms (thesis eq. 4.1, 4.2; no 1/pi). An immutable value.

    Parameters
    ----------
    diffuse : float, (3,) array_like, or Texture
        rho_d, linear RGB or a scalar, >= 0.
    specular : float or (3,) array_like
        rho_s, >= 0: the Ward lobe `rho_s / (4 sigma^2) exp((1 - 1/(N.H)^2) / sigma^2) sqrt((N.L)/(N.V))`.
    roughness : float
        sigma, > 0.
    reflect, transmit : float or (3,) array_like
        Weights of the reflected and the refracted ray, >= 0; at total internal reflection the latter joins the former.
    ior : float
        Index of refraction inside over outside, > 0.

    Glass that touches other solids refracts relative to them (see `Scene.add`). Solids that overlap are no stack of
    media: each surface refracts as if its solid stood alone in air, on the way in and on the way out.

    Attributes have the same names; a scalar reads back as a float, a triple as a tuple, rounded to float32.
    """

    diffuse: Colour | Texture
    specular: Colour
    roughness: float
    reflect: Colour
    transmit: Colour
    ior: float
    _native: _core.Material

    def __init__(
        self,
        diffuse: npt.ArrayLike | Texture = (0.5, 0.5, 0.5),
        specular: npt.ArrayLike = 0.0,
        *,
        roughness: float = 0.2,
        reflect: npt.ArrayLike = 0.0,
        transmit: npt.ArrayLike = 0.0,
        ior: float = 1.5,
    ) -> None:
        texture = diffuse if isinstance(diffuse, Texture) else None
        self._set(diffuse=texture or _validate.colour("Material", "diffuse", diffuse))
        self._set(specular=_validate.colour("Material", "specular", specular))
        self._set(roughness=_validate.positive("Material", "roughness", roughness))
        self._set(reflect=_validate.colour("Material", "reflect", reflect))
        self._set(transmit=_validate.colour("Material", "transmit", transmit))
        self._set(ior=_validate.positive("Material", "ior", ior))
        self._set(_native=self._make(texture))

    def _make(self, texture: Texture | None) -> _core.Material:
        diffuse = 1.0 if isinstance(self.diffuse, Texture) else self.diffuse
        return _core.material(
            packed(diffuse),
            None if texture is None else texture._native,
            packed(self.specular),
            self.roughness,
            packed(self.reflect),
            packed(self.transmit),
            self.ior,
        )
