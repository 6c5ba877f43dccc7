"""Scenes in NFF, the Neutral File Format of the Standard Procedural Databases.

Source: Eric Haines, "Neutral File Format", version 3.9, and "A Proposal for Standard Graphics Environments", IEEE
Computer Graphics and Applications 7(11), 1987. What the format leaves open is decided here:

* Colours are linear RGB. `angle` is the vertical field of view. The picture is not mirrored: x grows along
  cross(view, up). `hither` is read and has no effect.
* Each of n lights has the intensity sqrt(n) / (2 n) that the SPD suggest, times its colour if it has one, without
  falloff; ambient light has that value, too (as for one light, where there is none).
* `f r g b Kd Ks Shine T ior` is `Material(Kd * rgb, specular, roughness, reflect=Ks, transmit=T, ior)`, with `specular`
  and `roughness` as `fit_highlight` fits them to Phong's highlight.
* Every primitive is one object, in the file's order: a `Sphere`; a `Cylinder` or `Cone`, which unlike NFF's have caps;
  a `Polygon` where it is convex and planar, else a `Mesh`; a `Mesh` with normals for a patch. All are two-sided: the
  sign of a radius, which only tells the visible side, has no effect.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from . import _validate
from ._nff_words import Words, is_number
from ._triangulate import triangulate
from ._validate import DoubleArray, IndexArray
from .camera import Camera
from .lights import PointLight
from .materials import Material
from .meshes import Mesh
from .scene import Scene
from .shapes import Cone, Cylinder, Polygon, Shape, Sphere

RGB = ("red", "green", "blue")
SURFACE = (*RGB, "Kd", "Ks", "Shine", "T", "index_of_refraction")
CONE = tuple(f"{end}{part}" for end in ("base", "apex") for part in (".x", ".y", ".z", "_radius"))
SPHERE = ("center.x", "center.y", "center.z", "radius")
VIEW = {
    **{key: tuple(f"{key}.{axis}" for axis in "xyz") for key in ("from", "at", "up")},
    "angle": ("angle",),
    "hither": ("hither",),
    "resolution": ("xres", "yres"),
}
LOWEST_SIGMA, HIGHEST_SIGMA = 1e-4, 1.0  # Material's lower limit; at 1 the lobe is as wide as the hemisphere


def fit_highlight(ks: float, shine: float) -> tuple[float, float]:
    """(specular, roughness) of the Ward lobe that is closest to Phong's highlight Ks (R.V)^n, n = shine >= 0.

    In the plane of N, L and V the angle between R and V is twice the angle d between N and H. With x = tan(d)^2,

        cos(2 d) = (1 - x) / (1 + x),    so    cos(2 d)^n = exp(-2 n artanh(x)) = exp(-2 n (x + x^3/3 + ...)),

    and Ward's lobe is exp(-x / sigma^2): with sigma = 1 / sqrt(2 n) the exponents differ from x^3 on only. Its
    peak, at d = 0, is rho_s / (4 sigma^2), so rho_s = 4 sigma^2 Ks makes it Phong's. sigma is clamped to [1e-4, 1], and
    the peak stays.
    """
    sigma = min(max(1 / math.sqrt(2 * shine), LOWEST_SIGMA), HIGHEST_SIGMA) if shine > 0 else HIGHEST_SIGMA
    return 4 * sigma * sigma * ks, sigma


@functools.lru_cache(maxsize=32)
def _names(count: int, patch: bool) -> tuple[str, ...]:
    """What the numbers of a polygon's or patch's vertices are called."""
    parts = ("x", "y", "z", *(("nx", "ny", "nz") if patch else ()))
    return tuple(f"vertex {i + 1}: {part}" for i in range(count) for part in parts)


class _Loader:
    """Makes the scene, entity by entity."""

    def __init__(self, words: Words) -> None:
        self.words = words
        self.scene = Scene()
        self.material: Material | None = None
        self.background: list[float] | None = None
        self.lights: list[tuple[int, list[float]]] = []  # with the words at which they start
        self.entities: dict[str, Callable[[], None]] = {
            "v": self.read_view,
            "b": self.read_background,
            "l": self.read_light,
            "f": self.read_surface,
            "c": lambda: self.add(self.cone),
            "s": lambda: self.add(self.sphere),
            "p": lambda: self.add(self.polygon),
            "pp": lambda: self.add(self.patch),
        }

    def load(self) -> Scene:
        words = self.words
        with self.scene.edit():
            while (entity := words.take()) is not None:
                words.start = words.at - 1
                if entity not in self.entities:
                    words.fail(f"an entity must be one of {', '.join(self.entities)}, got {entity!r}")
                self.entities[entity]()
            if self.scene.camera is None:
                words.fail("v: the file must have a view, got none", len(words.words))
            self.add_lights()
        return self.scene

    # What is seen

    def read_view(self) -> None:
        words = self.words
        if self.scene.camera is not None:
            words.fail("v: the file must have one view, got a second one")
        found: dict[str, list[float]] = {}
        while len(found) < len(VIEW):
            key, at = words.take(), words.at - 1
            if key is None or key not in VIEW or key in found:
                words.expect(f"the next keyword must be {' or '.join(k for k in VIEW if k not in found)}", at)
            numbers = key != "resolution"
            found[key] = words.numbers(VIEW[key]) if numbers else [words.whole(name, 1) for name in VIEW[key]]
        width, height = (int(size) for size in found["resolution"])
        camera = words.make(
            Camera, found["from"], found["at"], up=found["up"], fov=found["angle"][0], width=width, height=height
        )
        self.scene.camera = camera

    def read_background(self) -> None:
        if self.background is not None:
            self.words.fail("b: the file must have one background, got a second one")
        self.background = self.colour(RGB)
        self.words.make(setattr, self.scene, "background", self.background)

    def colour(self, names: tuple[str, ...]) -> list[float]:
        """Numbers >= 0."""
        first = self.words.at
        values = self.words.numbers(names)
        for at, (name, value) in enumerate(zip(names, values, strict=True), first):
            if value < 0:
                self.words.expect(f"{name} must be >= 0", at)
        return values

    def read_light(self) -> None:
        start, words = self.words.start, self.words
        position = words.numbers(("x", "y", "z"))
        coloured = words.at < len(words.words) and is_number(words.words[words.at])
        self.lights.append((start, position + (self.colour(RGB) if coloured else [1.0, 1.0, 1.0])))

    def add_lights(self) -> None:
        count = max(len(self.lights), 1)
        relative = math.sqrt(count) / (2 * count)
        self.scene.ambient = relative
        for start, numbers in self.lights:
            self.words.start = start
            light = self.words.make(PointLight, numbers[:3], [relative * value for value in numbers[3:]])
            self.scene.add_light(light)

    def read_surface(self) -> None:
        first = self.words.at
        red, green, blue, kd, ks, shine, transmit, ior = self.colour(SURFACE)
        if transmit > 0 and not ior > 0:
            self.words.expect("index_of_refraction must be > 0 where T > 0", first + len(SURFACE) - 1)
        specular, roughness = fit_highlight(ks, shine)
        self.material = self.words.make(
            Material,
            (kd * red, kd * green, kd * blue),
            specular,
            roughness=roughness,
            reflect=ks,
            transmit=transmit,
            ior=ior if transmit > 0 else 1.0,  # opaque surfaces have any number here, 0 in most files
        )

    # Primitives

    def add(self, read: Callable[[], Shape]) -> None:
        shape = read()
        if self.material is None:
            self.words.fail(f"{self.words.entity}: an f entity must come before the first object, got none")
        self.words.make(self.scene.add, shape, self.material)

    def sphere(self) -> Shape:
        x, y, z, radius = self.words.numbers(SPHERE)
        return self.words.make(Sphere, (x, y, z), abs(radius))

    def cone(self) -> Shape:
        *base, wide, x, y, z, narrow = self.words.numbers(CONE)
        apex = [x, y, z]
        if wide * narrow < 0:
            self.words.fail(f"c: base_radius and apex_radius must have one sign, got {wide} and {narrow}")
        wide = self.words.make(_validate.number, "c", "base_radius", abs(wide))
        narrow = self.words.make(_validate.number, "c", "apex_radius", abs(narrow))
        if wide == narrow:
            return self.words.make(Cylinder, base, apex, radius=wide)
        if wide < narrow:
            base, apex, wide, narrow = apex, base, narrow, wide
        return self.words.make(Cone, base, apex, radius=wide, top_radius=narrow)

    def vertices(self, patch: bool) -> DoubleArray:
        count, words = self.words.whole("total_vertices", 3), self.words
        width = 6 if patch else 3
        if words.at + width * count > len(words.words):  # do not make names for a count that is beyond all bounds
            count = min(count, (len(words.words) - words.at) // width + 1)
        return np.array(words.numbers(_names(count, patch))).reshape(count, width)

    def polygon(self) -> Shape:
        vertices = self.vertices(patch=False)
        try:
            return Polygon(vertices)
        except ValueError as error:
            if len(vertices) == 3:
                self.words.fail(f"p: {error}")
        return self.words.make(Mesh, vertices, self.faces(vertices))

    def faces(self, vertices: DoubleArray) -> IndexArray:
        """The triangles of a polygon as it is after its vertices were rounded."""
        rounded = self.words.make(_validate.array, "Polygon", "vertices", vertices, shape=(None, 3))
        return self.words.make(triangulate, rounded.astype(np.float64))

    def patch(self) -> Shape:
        both = self.vertices(patch=True)
        vertices, normals = both[:, :3], both[:, 3:]
        zero = np.flatnonzero(~normals.any(axis=1))
        if zero.size:
            self.words.fail(f"pp: vertex {zero[0] + 1}: the normal must be non-zero, got (0.0, 0.0, 0.0)")
        faces = np.array([[0, 1, 2]]) if len(vertices) == 3 else self.faces(vertices)
        return self.words.make(Mesh, vertices, faces, normals=normals)


def parse(data: bytes, path: str) -> Scene:
    """The scene that the bytes of an NFF file describe, with its camera.

    Raises ValueError naming the path, the line, the entity, the value and what was expected, and ImportError where a
    polygon needs the extra `raybound[mesh]`.
    """
    return _Loader(Words(path, data)).load()
