"""Display cases and pedestals, and what stands on them."""

from __future__ import annotations

from ..materials import Material
from ..scene import Scene
from ..shapes import Cylinder, Polygon, Sphere, Union
from . import curiosities, games
from .furniture import pedestal
from .kit import Point, block, put, ring, shifted, turned
from .palette import Palette

TABLE = 0.93  # height of a case's velvet
CASE = (1.9, 0.95)  # length along the hall, and width
LEG = ((-0.002, 0.034), (0.07, 0.046), (0.125, 0.029), (0.44, 0.049), (0.52, 0.034), (0.61, 0.038))


def build_display(scene: Scene, palette: Palette) -> None:
    """Add four cases and six pedestals with their exhibits."""
    chess = case(scene, palette, (6.1, 3.55, 0.0), palette.blue_velvet)
    games.chess_set(scene, palette, shifted(chess, -0.42))
    curiosities.gems(scene, palette, shifted(chess, 0.52))
    shells = case(scene, palette, (16.6, 3.3, 0.0), palette.velvet)
    curiosities.shells(scene, palette, shifted(shells, -0.45))
    curiosities.necklace(scene, palette, shifted(shells, 0.5))
    numbers = case(scene, palette, (16.6, 8.7, 0.0), palette.blue_velvet)
    games.abacus(scene, palette, shifted(numbers, -0.45))
    curiosities.molecule(scene, palette, shifted(numbers, 0.5))
    vases = case(scene, palette, (20.4, 8.9, 0.0), palette.velvet)
    curiosities.vases(scene, palette, vases)
    treasures(scene, palette)


def case(scene: Scene, palette: Palette, foot: Point, cloth: Material) -> Point:
    """A table with a cloth top and low panes around it; open above, so that light gets in. Returns the top's middle."""
    length, width = CASE
    table(scene, palette, foot)
    scene.add(block(shifted(foot, dz=0.865), (length, width, 0.055)), palette.dark_wood)
    scene.add(block(shifted(foot, dz=0.915), (length - 0.08, width - 0.08, TABLE - 0.915)), cloth)
    half_x, half_y, low, high = length / 2 - 0.02, width / 2 - 0.02, 0.921, 1.20
    corners = [(-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y)]
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        ends = ((ax, ay, low), (bx, by, low), (bx, by, high), (ax, ay, high))
        pane = [shifted(foot, *end) for end in ends]
        scene.add(Polygon(pane), palette.pane)
        scene.add(Cylinder(pane[3], pane[2], radius=0.009), palette.dull_brass)
        scene.add(Cylinder(shifted(pane[0], dz=-0.01), pane[3], radius=0.011), palette.dull_brass)
        scene.add(Sphere(pane[3], 0.016), palette.dull_brass)
    return shifted(foot, dz=TABLE)


def table(scene: Scene, palette: Palette, foot: Point) -> None:
    """What carries a case: four turned legs with stretchers, and a frame with three drawers on each long side."""
    length, width = CASE
    scene.add(block(shifted(foot, dz=0.620), (length - 0.14, width - 0.10, 0.247)), palette.cabinet)
    scene.add(block(shifted(foot, dz=0.600), (length - 0.09, width - 0.05, 0.032)), palette.dark_wood)
    for x in (-0.55, 0.0, 0.55):
        for hand in (-1, 1):
            front = hand * (width / 2 - 0.05)
            scene.add(block(shifted(foot, x, front, 0.645), (0.51, 0.024, 0.207)), palette.walnut)
            scene.add(Sphere(shifted(foot, x, front + hand * 0.026, 0.748), 0.018), palette.brass)
    x, y, z = length / 2 - 0.13, width / 2 - 0.135, 0.165
    for leg in ((-x, -y), (x, -y), (x, y), (-x, y)):
        put(scene, palette.walnut, turned(shifted(foot, *leg), LEG))
    # The stretchers have the shape of an H; they end within the legs.
    ends = [Cylinder(shifted(foot, e, -y, z), shifted(foot, e, y, z), radius=0.018) for e in (-x, x)]
    scene.add(Union(*ends, Cylinder(shifted(foot, -x, 0, z), shifted(foot, x, 0, z), radius=0.015)), palette.walnut)


def treasures(scene: Scene, palette: Palette) -> None:
    """Balls of glass and silver, a spiral and urns, on pedestals."""
    top = 1.05
    for x, y, material, radius in (
        (14.2, 8.7, palette.glass, 0.30),
        (9.6, 3.1, palette.silver, 0.28),
        (19.6, 3.2, palette.glass, 0.27),
    ):
        pedestal(scene, palette, (x, y, 0.0), top)
        put(scene, palette.dull_brass, turned((x, y, top), [(-0.002, 0.13), (0.035, 0.10)]))
        scene.add(Sphere((x, y, top + 0.02 + radius), radius), material)
    pedestal(scene, palette, (4.6, 9.3, 0.0), top)
    curiosities.helix(scene, palette, (4.6, 9.3, top))
    for y in (3.9, 8.1):
        urn(scene, palette, (27.9, y, 0.45))
    pedestal(scene, palette, (3.3, 1.6, 0.0), 0.9)
    urn(scene, palette, (3.3, 1.6, 0.898))


def urn(scene: Scene, palette: Palette, foot: Point) -> None:
    """A lidded urn with a girdle of beads."""
    outline = [
        (-0.002, 0.15),
        (0.04, 0.15),
        (0.08, 0.05),
        (0.16, 0.06),
        (0.36, 0.22),
        (0.50, 0.23),
        (0.58, 0.18),
        (0.62, 0.20),
    ]
    put(scene, palette.alabaster, turned(foot, [*outline, (0.64, 0.20), (0.72, 0.06), (0.76, 0.03)]))
    put(scene, palette.gilt, (Sphere(p, 0.018) for p in ring(shifted(foot, dz=0.43), 0.228, 16)))
    scene.add(Sphere(shifted(foot, dz=0.79), 0.045), palette.gilt)
