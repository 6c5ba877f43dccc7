"""The hall itself: floor, walls, panelling, entablature and a coffered ceiling with two open skylights.

x runs along the hall, y to its left side, z up; metres.
"""

from __future__ import annotations

from ..materials import Material
from ..scene import Scene
from ..shapes import Box, Cylinder, Disk, Polygon, Sphere
from .kit import Wall, picture, put, ring
from .palette import Palette

LENGTH, WIDTH, HEIGHT = 24.0, 12.0, 6.5
BAYS, BAY = 5, 4.8
LEFT = Wall((0.0, WIDTH), (1, 0), (0, -1), LENGTH)
RIGHT = Wall((LENGTH, 0.0), (-1, 0), (0, 1), LENGTH)
FAR = Wall((LENGTH, WIDTH), (0, -1), (-1, 0), WIDTH)
NEAR = Wall((0.0, 0.0), (0, 1), (1, 0), WIDTH)
PORTAL = (3.4, 8.6)  # the far wall's stone middle, along its s

# Openings in the ceiling, (x0, x1, y0, y1): the sun must find no pane in its way.
SKYLIGHTS = ((5.0, 9.4, 4.0, 8.0), (14.6, 19.0, 4.0, 8.0))
CENTRE = (12.0, 6.0, 0.0)


def build_hall(scene: Scene, palette: Palette) -> None:
    """Add everything that does not move."""
    floor(scene)
    medallion(scene, palette)
    walls(scene, palette)
    for wall in (LEFT, RIGHT, NEAR):
        panelling(scene, palette, wall, (0.0, wall.length))
    panelling(scene, palette, FAR, (0.0, PORTAL[0]))
    panelling(scene, palette, FAR, (PORTAL[1], WIDTH))
    for wall in (LEFT, RIGHT, FAR, NEAR):
        entablature(scene, palette, wall)
    beams(scene, palette)
    ceiling(scene, palette)
    rosettes(scene, palette)


def floor(scene: Scene) -> None:
    """Marble flags, 0.8 m each, and a carpet that runs to the portal."""
    x0, x1, y0, y1 = -0.2, LENGTH + 0.2, -0.2, WIDTH + 0.2
    flags = Material(picture("floor", ((x1 - x0) / 1.6, (y1 - y0) / 1.6)), (0.03, 0.03, 0.03), roughness=0.12)
    scene.add(Polygon([(x0, y0, 0), (x1, y0, 0), (x1, y1, 0), (x0, y1, 0)]), flags, name="floor")
    # The carpet's first edge runs across it: u is its width.
    z, near, far, half = 0.012, 14.7, 22.1, 1.0
    cloth = Material(picture("carpet", (1.0, (far - near) / (2 * half))))
    scene.add(Polygon([(near, 6 + half, z), (near, 6 - half, z), (far, 6 - half, z), (far, 6 + half, z)]), cloth)


def medallion(scene: Scene, palette: Palette) -> None:
    """A compass star of polished marbles: discs with sixteen rays."""
    x, y, _ = CENTRE
    polish = {"reflect": 0.14}
    dark = palette.verde.replace(diffuse=(0.025, 0.075, 0.055), **polish)
    light = palette.marble.replace(diffuse=(0.72, 0.66, 0.54), **polish)
    rose = palette.marble.replace(diffuse=(0.40, 0.16, 0.11), **polish)
    ochre = palette.marble.replace(diffuse=(0.62, 0.40, 0.14), **polish)
    for layer, (radius, material) in enumerate(((1.95, dark), (1.85, light), (1.55, dark), (1.48, rose))):
        scene.add(Disk((x, y, 0.002 + 0.002 * layer), (0, 0, 1), radius=radius), material)
    for rank, (reach, count, phase) in enumerate(((1.0, 8, 22.5), (1.46, 8, 0.0))):
        level = 0.011 + 0.003 * rank
        tips = list(ring((x, y, level), reach, count, phase))
        folds = list(ring((x, y, level), 0.42 - 0.1 * (1 - rank), count, phase + 180 / count))
        for k, tip in enumerate(tips):
            scene.add(Polygon([(x, y, level), tip, folds[k]]), (light, ochre)[rank])
            scene.add(Polygon([(x, y, level), folds[k - 1], tip]), (dark, dark)[rank])
    scene.add(Disk((x, y, 0.017), (0, 0, 1), radius=0.22), dark)
    scene.add(Disk((x, y, 0.019), (0, 0, 1), radius=0.15), ochre)


def papered(length: float, height: float) -> Material:
    """Wallpaper for a wall of this size: the pattern is 0.9 m wide."""
    return Material(picture("wallpaper", (length / 0.9, height / 0.9)))


def walls(scene: Scene, palette: Palette) -> None:
    """Papered walls; the far one leaves out its portal, which has a builder of its own."""
    top = HEIGHT + 0.1
    for name, wall in (("left wall", LEFT), ("right wall", RIGHT), ("near wall", NEAR)):
        span = (-0.2, wall.length + 0.2)
        paper = papered(wall.length + 0.4, top + 0.1)
        scene.add(wall.box(span, (-0.25, 0.0), (-0.1, top)), paper, name=name)
    for s0, s1 in ((-0.2, PORTAL[0]), (PORTAL[1], WIDTH + 0.2)):
        scene.add(FAR.box((s0, s1), (-0.25, 0.0), (-0.1, top)), papered(s1 - s0, top + 0.1))


def panelling(scene: Scene, palette: Palette, wall: Wall, span: tuple[float, float]) -> None:
    """Skirting board, dado with raised panels, dado rail and picture rail."""
    s0, s1 = span
    scene.add(wall.box(span, (-0.01, 0.030), (-0.01, 0.98)), palette.panelling)
    scene.add(wall.box(span, (-0.01, 0.050), (-0.01, 0.16)), palette.dark_wood)
    scene.add(wall.box(span, (-0.01, 0.065), (0.975, 1.035)), palette.dark_wood)
    scene.add(wall.box(span, (-0.01, 0.045), (4.62, 4.67)), palette.gilt)
    count = max(1, round((s1 - s0) / 1.2))
    pitch = (s1 - s0) / count
    for k in range(count):
        a = s0 + pitch * k + 0.13
        scene.add(wall.box((a, a + pitch - 0.26), (0.02, 0.048), (0.28, 0.86)), palette.cream)


def entablature(scene: Scene, palette: Palette, wall: Wall) -> None:
    """Architrave, frieze and a cornice in three steps, around the whole hall; above it a cove hides the wallpaper."""
    # Walls along x overlap those along y in the corners; a little height apart keeps faces from coinciding.
    lift = 0.003 if wall in (FAR, NEAR) else 0.0
    span = (-0.1, wall.length + 0.1)
    steps = ((5.26, 5.36, 0.60), (5.355, 5.46, 0.63), (5.455, 5.72, 0.58), (5.715, 5.80, 0.66), (5.795, 5.90, 0.78))
    for z0, z1, depth in steps:
        shade = palette.cream if depth == 0.58 else palette.plaster
        scene.add(wall.box(span, (-0.05, depth - lift), (z0 + lift, z1 + lift)), shade)
    for z0, z1, depth in ((5.89, 5.97, 0.20), (5.965, HEIGHT + 0.02, 0.12)):
        scene.add(wall.box(span, (-0.05, depth - lift), (z0 + lift, z1 + lift)), palette.plaster)
    scene.add(wall.box(span, (-0.05, 0.665 - lift), (5.74 + lift, 5.765 + lift)), palette.gilt)


def beams(scene: Scene, palette: Palette) -> None:
    """Main beams over the columns, ties along the hall, and lighter ribs between that make the coffers."""

    def across(x: float, half: float, low: float, y0: float, y1: float) -> None:
        scene.add(Box((x - half, y0, low), (x + half, y1, HEIGHT + 0.05)), palette.plaster)

    def along(y: float, half: float, low: float, x0: float, x1: float) -> None:
        scene.add(Box((x0, y - half, low), (x1, y + half, HEIGHT + 0.06)), palette.plaster)

    for k in range(1, BAYS):
        across(BAY * k, 0.20, 5.98, -0.1, WIDTH + 0.1)
    for y in (3.85, 8.15):
        along(y, 0.15, 6.04, -0.1, LENGTH + 0.1)
    for k in range(BAYS):
        middle = BAY * (k + 0.5)
        open_bay = k in (1, 3)
        for y0, y1 in ((-0.1, 3.8), (8.2, WIDTH + 0.1)) if open_bay else ((-0.1, WIDTH + 0.1),):
            across(middle, 0.09, 6.20, y0, y1)
        for y in (2.1, 9.9) if open_bay else (2.1, 6.0, 9.9):
            along(y, 0.09, 6.22, BAY * k - 0.1, BAY * (k + 1) + 0.1)


def ceiling(scene: Scene, palette: Palette) -> None:
    """Slabs around the skylights, and the bars that cross the openings."""
    low, high = HEIGHT, HEIGHT + 0.3
    edges = [-0.3, *(x for opening in SKYLIGHTS for x in opening[:2]), LENGTH + 0.3]
    for k in range(0, len(edges), 2):
        scene.add(Box((edges[k], -0.3, low), (edges[k + 1], WIDTH + 0.3, high)), palette.ceiling)
    for x0, x1, y0, y1 in SKYLIGHTS:
        for a, b in ((-0.3, y0), (y1, WIDTH + 0.3)):
            scene.add(Box((x0 - 0.05, a, low + 0.003), (x1 + 0.05, b, high - 0.003)), palette.ceiling)
        for k in range(1, 4):
            x = x0 + (x1 - x0) * k / 4
            scene.add(Box((x - 0.035, y0 - 0.05, low + 0.10), (x + 0.035, y1 + 0.05, low + 0.20)), palette.iron)
        for k in range(1, 4):
            y = y0 + (y1 - y0) * k / 4
            scene.add(Box((x0 - 0.05, y - 0.025, low + 0.12), (x1 + 0.05, y + 0.025, low + 0.18)), palette.iron)


def rosettes(scene: Scene, palette: Palette) -> None:
    """A gilt boss on a plaster disc in every coffer that is not open to the sky."""
    for k in range(BAYS):
        rows = (1.05, 3.0, 9.0, 10.95) if k in (1, 3) else (1.05, 3.0, 4.95, 7.05, 9.0, 10.95)
        for x in (BAY * k + 1.25, BAY * (k + 1) - 1.25):
            for y in rows:
                scene.add(Cylinder((x, y, HEIGHT - 0.05), (x, y, HEIGHT + 0.02), radius=0.26), palette.cream)
                put(scene, palette.gilt, [Sphere((x, y, HEIGHT - 0.05), 0.11)])
