"""A chess set in mid-game and an abacus."""

from __future__ import annotations

from ..materials import Material
from ..scene import Scene
from ..shapes import Box, Cylinder, Intersection, Polygon, Shape, Sphere, Union
from ..transform import Transform
from .kit import Point, block, picture, put, shifted, turned
from .palette import Palette

# A position after some twenty moves, seen from White's side: ranks 8 to 1, files a to h.
POSITION = ("r....rk.", "pp..qppp", "..n.bn..", "..pp....", "...P.B..", "..PBPN..", "PP.N.PPP", "R..QR.K.")
SQUARE = 0.082
FOOT = {"p": 0.026, "r": 0.029, "n": 0.029, "b": 0.029, "q": 0.032, "k": 0.033}
STATURE = {"p": 0.070, "r": 0.080, "n": 0.075, "b": 0.105, "q": 0.125, "k": 0.135}


def chess_set(scene: Scene, palette: Palette, centre: Point) -> None:
    """The board and the pieces that are left on it."""
    half, thick = 4 * SQUARE / 0.89, 0.028
    scene.add(block(shifted(centre, dz=-0.002), (2 * half, 2 * half, thick)), palette.walnut)
    x, y, z = centre
    z += thick
    board = [(x - half, y - half, z), (x + half, y - half, z), (x + half, y + half, z), (x - half, y + half, z)]
    scene.add(Polygon(board), Material(picture("chessboard"), (0.05, 0.05, 0.05), roughness=0.12), name="chessboard")
    for row, line in enumerate(POSITION):
        for column, letter in enumerate(line):
            if letter != ".":
                place = (x + (row - 3.5) * SQUARE, y + (column - 3.5) * SQUARE, z)
                material = palette.ivory if letter.isupper() else palette.ebony
                put(scene, material, piece(letter.lower(), place, 1.0 if letter.isupper() else -1.0))


def piece(kind: str, foot: Point, ahead: float) -> list[Shape]:
    """One chessman; `ahead` is the side that a knight faces, along x."""
    r, h = FOOT[kind], STATURE[kind]
    shapes = list(turned(foot, [(0.0, r), (0.010, r), (0.022, 0.55 * r), (h - 0.012, 0.38 * r), (h, 0.62 * r)]))
    top = shifted(foot, dz=h)
    if kind == "p":
        return [*shapes, Sphere(shifted(top, dz=0.008), 0.015)]
    if kind == "r":
        return [*shapes, *turned(top, [(0.0, 0.024), (0.022, 0.024)])]
    if kind == "b":
        return [*shapes, mitre(top), Sphere(shifted(top, dz=0.043), 0.006)]
    if kind == "n":
        return [*shapes, horse(top, ahead)]
    crown = turned(top, [(0.0, 0.013), (0.022, 0.024), (0.030, 0.012)])
    if kind == "q":
        return [*shapes, *crown, Sphere(shifted(top, dz=0.034), 0.009)]
    cross = (Box(shifted(top, -0.004, -0.004, 0.028), shifted(top, 0.004, 0.004, 0.062)),
             Box(shifted(top, -0.003, -0.012, 0.042), shifted(top, 0.003, 0.012, 0.050)))  # fmt: skip
    return [*shapes, *crown, Union(*cross)]


def mitre(top: Point) -> Shape:
    """A bishop's head: the pointed solid that two balls have in common."""
    return Intersection(*(Sphere(shifted(top, side * 0.012, 0.0, 0.018), 0.0265) for side in (-1, 1)))


def horse(top: Point, ahead: float) -> Shape:
    """A knight's head: a bent neck and a muzzle, cut from blocks by cylinders."""
    x, y, z = top
    neck = Intersection(
        Box((x - 0.022, y - 0.011, z - 0.004), (x + 0.022, y + 0.011, z + 0.046)),
        Cylinder((x - 0.010 * ahead, y - 0.1, z + 0.010), (x - 0.010 * ahead, y + 0.1, z + 0.010), radius=0.034),
    )
    muzzle = Intersection(
        Box((x - 0.030, y - 0.010, z + 0.018), (x + 0.030, y + 0.010, z + 0.040)),
        Cylinder((x + 0.012 * ahead, y - 0.1, z + 0.027), (x + 0.012 * ahead, y + 0.1, z + 0.027), radius=0.019),
    )
    return Union(neck, muzzle)


def abacus(scene: Scene, palette: Palette, centre: Point) -> None:
    """A counting frame that leans back on a stand, showing a number: nine rods, two beads above and five below."""
    wires, pitch, low, bar, high = 9, 0.066, 0.03, 0.235, 0.345
    half = (wires + 1) * pitch / 2
    lean = Transform.translate(*shifted(centre, dy=-0.12, dz=0.008)) @ Transform.rotate(-32, axis=(1, 0, 0))
    frame: list[Shape] = [Box((-half, -0.02, z - 0.014), (half, 0.02, z + 0.014)) for z in (low - 0.014, high + 0.014)]
    frame += [Box((x - 0.012, -0.018, low - 0.02), (x + 0.012, 0.018, high + 0.02)) for x in (-half, half)]
    frame += [Box((-half, -0.012, bar - 0.007), (half, 0.012, bar + 0.007))]
    put(scene, palette.walnut, (shape.transformed(lean) for shape in frame))
    red, blue = palette.gem(0.50, 0.05, 0.03), palette.gem(0.04, 0.16, 0.42)
    for k, digit in enumerate((3, 1, 4, 1, 5, 9, 2, 6, 5)):
        x = (k - (wires - 1) / 2) * pitch
        scene.add(Cylinder((x, 0, low), (x, 0, high), radius=0.003).transformed(lean), palette.dull_brass)
        ones, fives = digit % 5, digit // 5
        heights = [bar - 0.022 - 0.026 * j if j < ones else low + 0.014 + 0.026 * (4 - j) for j in range(5)]
        put(scene, red, (Sphere((x, 0, z), 0.0128).transformed(lean) for z in heights))
        upper = [bar + 0.022 + 0.026 * j if j < fives else high - 0.014 - 0.026 * (1 - j) for j in range(2)]
        put(scene, blue, (Sphere((x, 0, z), 0.0128).transformed(lean) for z in upper))
    # The prop stands behind on its lower edge and ends within the upper rail, clear of the beads.
    prop = Transform.translate(*shifted(centre, dy=0.212)) @ Transform.rotate(22, axis=(1, 0, 0))
    scene.add(Box((-0.6 * half, -0.012, 0.003), (0.6 * half, 0.012, 0.335)).transformed(prop), palette.dark_wood)
