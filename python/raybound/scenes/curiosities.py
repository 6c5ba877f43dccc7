"""Small exhibits: gems, shells, a necklace, a molecule, vases and a double helix."""

from __future__ import annotations

import math

from ..materials import Material
from ..scene import Scene
from ..shapes import Box, Cone, Cylinder, Intersection, Shape, Sphere
from ..transform import Transform
from .kit import Point, put, shifted, turned
from .palette import Palette


def gems(scene: Scene, palette: Palette, centre: Point) -> None:
    """Six cut stones on little stands: boxes turned against each other within a ball."""
    colours = (
        (0.55, 0.02, 0.06),
        (0.02, 0.34, 0.14),
        (0.04, 0.10, 0.50),
        (0.55, 0.33, 0.02),
        (0.34, 0.06, 0.42),
        (0.05, 0.40, 0.46),
    )
    for k, colour in enumerate(colours):
        foot = shifted(centre, 0.22 * (k % 2) - 0.11, 0.24 * (k // 2) - 0.24)
        put(scene, palette.dull_brass, turned(foot, [(-0.002, 0.045), (0.012, 0.045), (0.03, 0.02), (0.06, 0.03)]))
        stone = Material(colour, (0.45, 0.45, 0.45), roughness=0.06, reflect=0.10)
        place = Transform.translate(*shifted(foot, dz=0.115)) @ Transform.rotate(17 * k)
        scene.add(gem(0.056), stone, name=f"gem-{k}", transform=place)


def gem(half: float) -> Shape:
    """Two crossed cubes within a ball: the lower one stands on a corner's axis, the other lies flat."""
    flat = Box((-half, -half, -half), (half, half, half))
    tipped = flat.transformed(Transform.rotate(45, axis=(0, 0, 1)) @ Transform.rotate(45, axis=(1, 0, 0)))
    return Intersection(flat, tipped, Sphere((0, 0, 0), 1.22 * half))


def shells(scene: Scene, palette: Palette, centre: Point) -> None:
    """Two sea snails: balls that shrink along a rising spiral, each whorl resting on the one before."""
    pearl, rose = palette.gem(0.72, 0.60, 0.50), palette.gem(0.66, 0.30, 0.26)
    for place, material, size, hand in (
        (shifted(centre, -0.05, -0.16), pearl, 1.0, 1),
        (shifted(centre, 0.05, 0.20), rose, 0.85, -1),
    ):
        balls = []
        for k in range(30):
            shrink = 0.925**k
            turn, reach = hand * 0.50 * k, 0.060 * size * shrink
            z = (0.061 + 0.120 * (1 - shrink)) * size
            balls.append(
                Sphere(shifted(place, reach * math.cos(turn), reach * math.sin(turn), z), 0.062 * size * shrink)
            )
        put(scene, material, balls)


def necklace(scene: Scene, palette: Palette, centre: Point) -> None:
    """Beads around a velvet cone, large in front."""
    put(scene, palette.ebony, turned(centre, [(-0.002, 0.16), (0.02, 0.16), (0.02, 0.14), (0.36, 0.05), (0.40, 0.055)]))
    bead, small = palette.gem(0.78, 0.72, 0.62), palette.gem(0.06, 0.34, 0.36)
    count = 30
    for k in range(count):
        a = 2 * math.pi * k / count
        z = 0.17 + 0.075 * (1 + math.cos(a))  # lowest toward the front, -x
        size = 0.0135 - 0.0035 * math.cos(a)
        radius = 0.14 - 0.09 * (z - 0.02) / 0.34 + 0.9 * size
        spot = shifted(centre, radius * math.cos(a), radius * math.sin(a), z)
        scene.add(Sphere(spot, size), small if k % 5 == 0 else bead)


def molecule(scene: Scene, palette: Palette, centre: Point) -> None:
    """Cubane: eight carbons, eight hydrogens and the bonds between; it stands on one hydrogen, held by a rod."""
    put(scene, palette.dull_brass, turned(centre, [(-0.002, 0.10), (0.02, 0.10), (0.03, 0.012), (0.09, 0.012)]))
    edge = 0.085
    tilt = math.degrees(math.acos(1 / math.sqrt(3)))
    turn = Transform.translate(*shifted(centre, dz=0.365)) @ Transform.rotate(tilt, axis=(-1, 1, 0))
    carbon, hydrogen = palette.gem(0.06, 0.06, 0.07), palette.gem(0.70, 0.10, 0.05)
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for x, y, z in corners:
        inner, outer = (edge * x, edge * y, edge * z), (1.75 * edge * x, 1.75 * edge * y, 1.75 * edge * z)
        scene.add(Sphere(inner, 0.036).transformed(turn), carbon)
        scene.add(Sphere(outer, 0.024).transformed(turn), hydrogen)
        scene.add(Cylinder(inner, outer, radius=0.010).transformed(turn), palette.alabaster)
        for far in ((-x, y, z), (x, -y, z), (x, y, -z)):
            if far > (x, y, z):
                end = (edge * far[0], edge * far[1], edge * far[2])
                scene.add(Cylinder(inner, end, radius=0.012).transformed(turn), palette.alabaster)


def vases(scene: Scene, palette: Palette, centre: Point) -> None:
    """Seven small vases, each of its own outline and glaze."""
    outlines = (
        [(0.0, 0.05), (0.02, 0.05), (0.14, 0.09), (0.20, 0.05), (0.26, 0.035), (0.30, 0.055)],
        [(0.0, 0.04), (0.10, 0.085), (0.16, 0.085), (0.20, 0.04), (0.22, 0.05)],
        [(0.0, 0.06), (0.03, 0.03), (0.12, 0.07), (0.30, 0.045), (0.34, 0.06)],
    )
    glazes = (
        (0.04, 0.20, 0.36),
        (0.50, 0.14, 0.05),
        (0.16, 0.38, 0.26),
        (0.60, 0.45, 0.14),
        (0.32, 0.10, 0.26),
        (0.62, 0.58, 0.50),
        (0.05, 0.30, 0.34),
    )
    for k, glaze in enumerate(glazes):
        foot = shifted(centre, 0.24 * (k - 3), 0.16 * (-1) ** k, -0.002)
        put(scene, palette.gem(*glaze), turned(foot, outlines[k % 3]))


def helix(scene: Scene, palette: Palette, foot: Point) -> None:
    """A double helix of balls with rungs between, on a brass foot."""
    put(scene, palette.dull_brass, turned(foot, [(-0.002, 0.16), (0.03, 0.16), (0.05, 0.03), (0.10, 0.02)]))
    scene.add(Cone(shifted(foot, dz=0.08), shifted(foot, dz=1.02), radius=0.012, top_radius=0.008), palette.dull_brass)
    strands = (palette.gem(0.05, 0.22, 0.50), palette.gem(0.62, 0.12, 0.05))
    rungs = (palette.gem(0.70, 0.50, 0.10), palette.gem(0.15, 0.42, 0.16))
    for k in range(17):
        a, z = 0.55 * k, 0.14 + 0.05 * k
        c, s = 0.13 * math.cos(a), 0.13 * math.sin(a)
        ends = (shifted(foot, c, s, z), shifted(foot, -c, -s, z))
        for end, strand in zip(ends, strands, strict=True):
            scene.add(Sphere(end, 0.034), strand)
        scene.add(Cylinder(ends[0], ends[1], radius=0.011), rungs[k % 2])
