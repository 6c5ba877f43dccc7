"""Paintings in their frames, with labels, and the lamps that hang over them."""

from __future__ import annotations

from dataclasses import dataclass

from ..materials import Material
from ..scene import Scene
from ..shapes import Cylinder
from .hall import BAY, LEFT, NEAR, RIGHT
from .kit import Point, Wall, frustum, picture
from .palette import Palette
from .portal import BACK

EYE = 2.42  # height of the pictures' middle


@dataclass(frozen=True)
class Hanging:
    """A picture, where its middle hangs along the wall, and its size in metres."""

    name: str
    wall: Wall
    place: float
    size: tuple[float, float]
    height: float = EYE


def bay(number: float) -> float:
    """The middle of a bay, counted from the wall's left end."""
    return BAY * (number + 0.5)


HANGINGS = (
    Hanging("window", LEFT, bay(0) - 0.95, (1.35, 1.50)),
    Hanging("birches", LEFT, bay(0) + 0.95, (1.14, 1.52)),
    Hanging("sunflower", LEFT, bay(1) - 0.95, (1.35, 1.50)),
    Hanging("cameo", LEFT, bay(1) + 0.95, (1.20, 1.50)),
    Hanging("night", LEFT, bay(2), (2.70, 2.1375)),
    Hanging("sunset", LEFT, bay(3), (2.80, 1.87)),
    Hanging("mist", LEFT, bay(4) - 0.95, (1.12, 1.92)),
    Hanging("fields", LEFT, bay(4) + 0.95, (1.35, 1.80)),
    Hanging("discs", RIGHT, bay(0), (2.40, 1.92)),
    Hanging("town", RIGHT, bay(1), (2.50, 2.125)),
    Hanging("circles", RIGHT, bay(2), (2.70, 2.16)),
    Hanging("bulge", RIGHT, bay(3) - 1.0, (1.50, 1.50)),
    Hanging("grid", RIGHT, bay(3) + 1.0, (1.32, 1.65)),
    Hanging("squares", RIGHT, bay(4) - 1.05, (1.45, 1.45)),
    Hanging("still_life", RIGHT, bay(4) + 1.0, (1.60, 1.44)),
    Hanging("wave", NEAR, NEAR.length / 2, (3.40, 2.41), 2.55),
    Hanging("golden_tree", BACK, BACK.length / 2, (2.80, 2.19), 2.45),
)


def build_gallery(scene: Scene, palette: Palette) -> None:
    """Hang every picture; the wide ones get a lamp."""
    for k, hanging in enumerate(HANGINGS):
        outer = palette.walnut if k % 3 == 1 else palette.gilt
        inner = palette.gilt if k % 3 == 1 else palette.dark_wood
        hang(scene, palette, hanging, outer, inner)
        if hanging.size[0] > 2.0 and hanging.wall is not BACK:
            lamp(scene, palette, hanging)


def hang(scene: Scene, palette: Palette, hanging: Hanging, outer: Material, inner: Material) -> None:
    """A canvas, an inner slip, an outer moulding and a brass label."""
    wall, (width, height) = hanging.wall, hanging.size
    s = (hanging.place - width / 2, hanging.place + width / 2)
    z = (hanging.height - height / 2, hanging.height + height / 2)
    canvas = Material(picture(hanging.name), (0.015, 0.015, 0.015), roughness=0.2)
    scene.add(wall.panel(s, 0.030, z), canvas, name=f"painting-{hanging.name}")
    moulding(scene, wall, s, z, (0.0, 0.045), 0.050, inner)
    wider, taller = (s[0] - 0.035, s[1] + 0.035), (z[0] - 0.035, z[1] + 0.035)
    moulding(scene, wall, wider, taller, (0.0, 0.085), 0.11, outer)
    low = taller[0] - 0.30
    middle = hanging.place
    scene.add(wall.box((middle - 0.12, middle + 0.12), (-0.01, 0.015), (low, low + 0.09)), palette.dull_brass)


def moulding(
    scene: Scene,
    wall: Wall,
    s: tuple[float, float],
    z: tuple[float, float],
    overlap: tuple[float, float],
    width: float,
    material: Material,
) -> None:
    """Four boxes around the rectangle; `overlap` is how far they cover it, and their depth from the wall.

    The uprights are a little thinner and reach into the horizontals, so that no faces coincide.
    """
    cover, depth = overlap
    inside_s, inside_z = (s[0] + cover, s[1] - cover), (z[0] + cover, z[1] - cover)
    for edge, hand in ((inside_z[0], -1), (inside_z[1], 1)):
        ends = sorted((edge, edge + hand * width))
        scene.add(wall.box((inside_s[0] - width, inside_s[1] + width), (-0.01, depth), (ends[0], ends[1])), material)
    for edge, hand in ((inside_s[0], -1), (inside_s[1], 1)):
        ends = sorted((edge, edge + hand * (width - 0.002)))
        scene.add(
            wall.box((ends[0], ends[1]), (-0.01, depth - 0.003), (inside_z[0] - 0.01, inside_z[1] + 0.01)), material
        )


def lamp_mouth(hanging: Hanging) -> Point:
    """Where the light of a picture's lamp begins."""
    return hanging.wall.point(hanging.place, 2.20, 5.28)


def lamp(scene: Scene, palette: Palette, hanging: Hanging) -> None:
    """A spotlight on a rod from the rib above, turned toward the picture."""
    wall, s = hanging.wall, hanging.place
    mouth, tail = wall.point(s, 2.215, 5.296), wall.point(s, 2.37, 5.52)
    ceiling = 6.02 if wall is NEAR else 6.24
    scene.add(Cylinder(wall.point(s, 2.37, 5.50), wall.point(s, 2.37, ceiling + 0.3), radius=0.015), palette.iron)
    scene.add(Cylinder(wall.point(s, 2.31, 5.433), tail, radius=0.05), palette.iron)
    scene.add(frustum(mouth, wall.point(s, 2.315, 5.44), 0.10, 0.05), palette.dull_brass)
