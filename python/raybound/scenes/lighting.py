"""The lights, and the chandelier and lantern that carry two of them."""

from __future__ import annotations

import math

from ..lights import DirectionalLight, PointLight, SpotLight
from ..scene import Scene
from ..shapes import Cylinder, Sphere
from .gallery import HANGINGS, lamp_mouth
from .hall import CENTRE, HEIGHT
from .kit import Point, put, ring, rods, shifted, turned
from .palette import Palette
from .sculpture import PLACE

SUN = (0.33, 0.42, -1.0)
CHANDELIER_LAMP: Point = (12.0, 6.0, 3.20)
LANTERN_LAMP: Point = (2.4, 6.0, 4.62)
SPOT_ON_SCULPTURE: Point = (6.55, 5.9, 5.9)


def build_lights(scene: Scene, palette: Palette) -> None:
    """Eight lights: the sun, the chandelier, a lantern, the room behind, and four spots."""
    scene.add_light(DirectionalLight(SUN, (1.02, 0.88, 0.64)), name="sun")
    scene.add_light(PointLight(CHANDELIER_LAMP, (0.47, 0.425, 0.355)), name="chandelier")
    scene.add_light(PointLight(LANTERN_LAMP, (0.17, 0.17, 0.18)), name="lantern")
    scene.add_light(PointLight((26.3, 6.0, 3.9), (0.62, 0.50, 0.34)), name="room behind")
    aim = tuple(a - b for a, b in zip((PLACE[0], PLACE[1], 1.9), SPOT_ON_SCULPTURE, strict=True))
    scene.add_light(SpotLight(SPOT_ON_SCULPTURE, aim, cutoff=21, intensity=(0.55, 0.52, 0.46)), name="sculpture spot")
    for name, strength in (("night", 0.66), ("circles", 0.60), ("sunset", 0.60)):
        picture_spot(scene, name, strength)
    chandelier(scene, palette)
    lantern(scene, palette)


def picture_spot(scene: Scene, name: str, strength: float) -> None:
    """A warm pool of light around one picture, from the lamp that hangs over it."""
    hanging = next(h for h in HANGINGS if h.name == name)
    mouth = lamp_mouth(hanging)
    target = hanging.wall.point(hanging.place, 0.0, hanging.height)
    direction = tuple(a - b for a, b in zip(target, mouth, strict=True))
    colour = (strength, 0.93 * strength, 0.80 * strength)
    scene.add_light(SpotLight(mouth, direction, cutoff=27, intensity=colour), name=f"spot on {name}")


def chandelier(scene: Scene, palette: Palette) -> None:
    """Two tiers of arms around a turned stem, and strings of crystal beads."""
    x, y, _ = CENTRE
    stem = [
        (3.86, 0.03),
        (3.94, 0.10),
        (4.02, 0.05),
        (4.20, 0.05),
        (4.34, 0.13),
        (4.46, 0.05),
        (4.86, 0.035),
        (5.0, 0.09),
    ]
    put(scene, palette.dull_brass, turned((x, y, 0.0), [*stem, (5.08, 0.03)]))
    scene.add(Sphere((x, y, 3.83), 0.07), palette.glass)
    put(scene, palette.dull_brass, [Cylinder((x, y, 5.05), (x, y, HEIGHT + 0.01), radius=0.018)])
    put(scene, palette.dull_brass, turned((x, y, 0.0), [(6.10, 0.05), (6.24, 0.16)]))
    arms(scene, palette, 10, 0.88, 4.22)
    arms(scene, palette, 5, 0.50, 4.66)
    crystal = palette.alabaster.replace(diffuse=(0.72, 0.74, 0.78), specular=(0.3, 0.3, 0.3))
    for radius, z, count in ((0.66, 4.02, 28), (0.44, 3.90, 20), (0.22, 3.82, 10), (0.36, 4.54, 15)):
        put(scene, crystal, (Sphere(p, 0.032) for p in ring((x, y, z), radius, count)))


def arms(scene: Scene, palette: Palette, count: int, reach: float, z: float) -> None:
    """Curved arms with a drip pan, a candle and a flame each."""
    x, y, _ = CENTRE
    flame = palette.ivory.replace(diffuse=(1.6, 1.25, 0.7))
    for k in range(count):
        a = 2 * math.pi * (k + 0.5) / count
        c, s = math.cos(a), math.sin(a)
        bend = [(0.04, z), (0.45 * reach, z - 0.16), (0.85 * reach, z - 0.14), (reach, z)]
        put(scene, palette.dull_brass, rods([(x + r * c, y + r * s, h) for r, h in bend], 0.014))
        tip = (x + reach * c, y + reach * s, z)
        put(scene, palette.dull_brass, turned(tip, [(-0.01, 0.02), (0.02, 0.065)]))
        put(scene, palette.ivory, turned(tip, [(0.02, 0.02), (0.13, 0.02)]))
        scene.add(Sphere(shifted(tip, dz=0.148), 0.022), flame)


def lantern(scene: Scene, palette: Palette) -> None:
    """A hanging lantern by the entrance."""
    x, y, _ = LANTERN_LAMP
    foot = (x, y, 4.66)
    put(scene, palette.dull_brass, turned(foot, [(0.0, 0.16), (0.03, 0.20), (0.05, 0.20)]))
    put(scene, palette.alabaster, turned(foot, [(0.05, 0.15), (0.30, 0.19)]))
    put(scene, palette.dull_brass, turned(foot, [(0.30, 0.21), (0.33, 0.21), (0.44, 0.05)]))
    scene.add(Cylinder((x, y, 5.08), (x, y, HEIGHT + 0.01), radius=0.015), palette.dull_brass)
