"""The far end: steps, an arched portal under a pediment, and the small room behind it."""

from __future__ import annotations

import itertools
import math

from ..materials import Material
from ..scene import Scene
from ..shapes import Box, Cylinder, Disk, Polygon
from ..transform import Transform
from .columns import column
from .hall import FAR, HEIGHT, LENGTH, PORTAL
from .kit import Wall, block, picture
from .palette import Palette

FLOOR = 0.45  # level of the room behind
SPRING, RADIUS, LINTEL = 3.0, 1.05, 4.2  # where the arch begins, its radius, the top of its spandrels
BACK = Wall((28.6, 8.6), (0, -1), (-1, 0), 5.2)
SEGMENTS = 14


def build_portal(scene: Scene, palette: Palette) -> None:
    """Add the portal and its room."""
    steps(scene, palette)
    stonework(scene, palette)
    arch(scene, palette)
    voussoirs(scene, palette)
    for y in (4.4, 7.6):
        column(scene, palette, (23.52, y, FLOOR), 3.95, 0.17, reeds=(15, 0.0, 360.0))
    pediment(scene, palette)
    room(scene, palette)


def steps(scene: Scene, palette: Palette) -> None:
    """Three steps with rounded nosings."""
    for k in range(3):
        x, half, top = 22.3 + 0.36 * k, 2.30 - 0.12 * k, 0.15 * (k + 1)
        scene.add(Box((x, 6 - half, -0.01), (LENGTH + 0.3 - 0.004 * k, 6 + half, top)), palette.marble)
        scene.add(Cylinder((x, 6 - half, top - 0.026), (x, 6 + half, top - 0.026), radius=0.024), palette.verde)


def stonework(scene: Scene, palette: Palette) -> None:
    """The wall around the arch: two piers, spandrels and what lies above."""
    left, right = 6 - RADIUS, 6 + RADIUS
    for s0, s1 in ((PORTAL[0], left), (right, PORTAL[1])):
        scene.add(FAR.box((s0, s1), (-0.25, 0.012), (-0.1, LINTEL)), palette.cream)
    scene.add(FAR.box(PORTAL, (-0.25, 0.012), (LINTEL, HEIGHT + 0.1)), palette.cream)
    for s in (left - 0.13, right + 0.13):
        scene.add(FAR.box((s - 0.14, s + 0.14), (-0.01, 0.06), (FLOOR - 0.01, SPRING - 0.12)), palette.plaster)
        scene.add(FAR.box((s - 0.18, s + 0.17), (-0.01, 0.10), (SPRING - 0.12, SPRING)), palette.marble)


def arch(scene: Scene, palette: Palette) -> None:
    """The spandrels above the arch and its soffit, as flat strips."""
    angles = [math.pi * k / SEGMENTS for k in range(SEGMENTS + 1)]
    curve = [(6 - RADIUS * math.cos(a), SPRING + RADIUS * math.sin(a)) for a in angles]
    for (s0, z0), (s1, z1) in itertools.pairwise(curve):
        corners = ((s0, z0), (s1, z1), (s1, LINTEL + 0.01), (s0, LINTEL + 0.01))
        scene.add(Polygon([FAR.point(s, 0.012, z) for s, z in corners]), palette.cream)
        soffit = [
            FAR.point(s0, 0.012, z0),
            FAR.point(s0, -0.26, z0),
            FAR.point(s1, -0.26, z1),
            FAR.point(s1, 0.012, z1),
        ]
        scene.add(Polygon(soffit), palette.plaster)


def voussoirs(scene: Scene, palette: Palette) -> None:
    """Wedge stones in two colours around the arch, with a keystone."""
    count, inner, outer = 13, RADIUS - 0.015, RADIUS + 0.24
    half = inner * math.tan(math.pi / (2 * count)) - 0.002
    middle = Transform.translate(LENGTH, 6.0, SPRING)
    for k in range(count):
        turn = middle @ Transform.rotate(180 * (k + 0.5) / count - 90, axis=(1, 0, 0))
        key = k == count // 2
        stone = Box((-0.09 if key else -0.05, -half, inner - 0.03 * key), (0.02, half, outer + 0.10 * key))
        scene.add(stone.transformed(turn), palette.verde if k % 2 == 0 else palette.marble)


def pediment(scene: Scene, palette: Palette) -> None:
    """A lintel on the two columns and a gable with a gilt disc."""
    low = FLOOR + 3.95
    scene.add(Box((23.25, 4.05, low), (LENGTH + 0.01, 7.95, low + 0.26)), palette.plaster)
    scene.add(Box((23.14, 3.92, low + 0.255), (LENGTH + 0.01, 8.08, low + 0.34)), palette.marble)
    base, apex, x, half = low + 0.335, low + 1.00, 23.30, 1.98
    gable = [(x, 6 + half, base), (x, 6 - half, base), (x, 6.0, apex)]
    scene.add(Polygon(gable), palette.cream)
    slope = math.degrees(math.atan2(apex - base, half))
    length = math.hypot(apex - base, half) + 0.10
    for hand in (-1, 1):
        rake = Box((-0.15, -0.05, -0.035), (0.30, length, 0.045))
        turn = Transform.rotate(90 + hand * 90, axis=(0, 0, 1)) @ Transform.rotate(-slope, axis=(1, 0, 0))
        mirror = Box((-0.30, -0.05, -0.035), (0.15, length, 0.045)) if hand == 1 else rake
        scene.add(mirror.transformed(Transform.translate(x, 6.0, apex) @ turn), palette.plaster)
    scene.add(Disk((x - 0.004, 6.0, base + 0.25), (-1, 0, 0), radius=0.17), palette.gilt)
    scene.add(Disk((x - 0.007, 6.0, base + 0.25), (-1, 0, 0), radius=0.12), palette.verde)


def room(scene: Scene, palette: Palette) -> None:
    """A small room with a parquet floor; its back wall carries a picture."""
    x0, x1, y0, y1, top = LENGTH + 0.2, BACK.origin[0], 3.4, 8.6, 4.6
    oak = Material(picture("planks", ((x1 - x0) / 0.9, (y1 - y0) / 0.9)), (0.05, 0.05, 0.04), roughness=0.15)
    level = FLOOR - 0.004
    scene.add(Polygon([(x0, y0, level), (x1, y0, level), (x1, y1, level), (x0, y1, level)]), oak)
    red = Material((0.36, 0.085, 0.07))
    scene.add(Box((x1, y0 - 0.2, 0), (x1 + 0.2, y1 + 0.2, top + 0.2)), red)
    for a, b in ((y0 - 0.2, y0), (y1, y1 + 0.2)):
        scene.add(Box((x0, a, 0), (x1 + 0.1, b, top + 0.2)), red)
    scene.add(Box((x0, y0 - 0.1, top), (x1 + 0.1, y1 + 0.1, top + 0.2)), palette.ceiling)
    scene.add(BACK.box((0, BACK.length), (-0.01, 0.04), (FLOOR - 0.01, FLOOR + 0.20)), palette.dark_wood)
    scene.add(block((26.6, 6.0, FLOOR - 0.002), (0.5, 1.5, 0.42)), palette.walnut)
