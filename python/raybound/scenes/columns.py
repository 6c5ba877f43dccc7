"""Reeded columns: half engaged along the walls, and free ones for the portal."""

from __future__ import annotations

import math

from ..scene import Scene
from ..shapes import Disk, Shape
from .hall import BAY, BAYS, LEFT, RIGHT
from .kit import Point, block, frustum, put, shifted, turned
from .palette import Palette


def build_columns(scene: Scene, palette: Palette) -> None:
    """A column on each wall between the bays, with a gilt boss on the frieze above it."""
    for wall in (LEFT, RIGHT):
        outward = math.degrees(math.atan2(wall.inward[1], wall.inward[0]))
        for k in range(1, BAYS):
            column(scene, palette, wall.point(BAY * k, 0.30, 0.0), 5.26, 0.25, reeds=(11, outward, 210.0))
            scene.add(Disk(wall.point(BAY * k, 0.583, 5.59), (*wall.inward, 0), radius=0.085), palette.gilt)


def column(
    scene: Scene, palette: Palette, foot: Point, height: float, radius: float, reeds: tuple[int, float, float]
) -> None:
    """A column of Tuscan outline whose shaft is a bundle of reeds.

    `reeds` is their count, the direction they are centred on and the angle they spread over, in degrees.
    """
    r = radius
    scene.add(block(shifted(foot, dz=-0.002), (2.9 * r, 2.9 * r, 0.17)), palette.verde)
    base = [(0.165, 1.36 * r), (0.24, 1.36 * r), (0.24, 1.24 * r), (0.33, 1.12 * r), (0.33, 1.2 * r), (0.37, 1.2 * r)]
    put(scene, palette.limestone, turned(foot, base))
    shaft_low, shaft_high = 0.36, height - 0.42
    put(scene, palette.limestone, [frustum(shifted(foot, dz=shaft_low), shifted(foot, dz=shaft_high), r, 0.84 * r)])
    put(scene, palette.limestone, (reed(foot, r, shaft_low, shaft_high, angle) for angle in spread(*reeds)))
    neck = shaft_high - 0.01
    put(scene, palette.gilt, turned(foot, [(neck, 1.08 * r), (neck + 0.05, 1.08 * r)]))
    put(
        scene, palette.marble, turned(foot, [(neck + 0.05, 0.86 * r), (neck + 0.16, 0.86 * r), (neck + 0.31, 1.36 * r)])
    )
    top = height - neck - 0.308
    scene.add(block(shifted(foot, dz=neck + 0.308), (2.9 * r, 2.9 * r, top + 0.004)), palette.plaster)


def spread(count: int, centre: float, angle: float) -> list[float]:
    """Directions in degrees, evenly over the angle; a full turn has no double."""
    gaps = count if angle == 360.0 else count - 1
    return [centre - angle / 2 + angle * k / gaps for k in range(count)]


def reed(foot: Point, r: float, low: float, high: float, degrees: float) -> Shape:
    """One reed: a thin tapered rod let into the shaft."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    bottom = shifted(foot, 0.97 * r * c, 0.97 * r * s, low + 0.005)
    top = shifted(foot, 0.81 * r * c, 0.81 * r * s, high - 0.005)
    return frustum(bottom, top, 0.155 * r, 0.13 * r)
