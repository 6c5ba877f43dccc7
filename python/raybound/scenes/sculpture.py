"""The sculpture: constructive solids balanced on a mirror base, in the manner of the thesis's figure 7-1."""

from __future__ import annotations

from ..materials import Material
from ..scene import Scene
from ..shapes import Box, Cylinder, Intersection, Polygon, Shape, Sphere, Union
from ..transform import Transform
from .palette import Palette

PLACE = (9.1, 8.0, 0.0)
TURN = 24.0  # degrees that the base is turned from the hall's axis
TOP_OF_BASE = 0.74


def build_sculpture(scene: Scene, palette: Palette) -> None:
    """Add base, bottom, middle and top, each an object of its own that a script can edit."""
    stand(scene, palette)
    lapis = Material((0.035, 0.095, 0.36), (0.14, 0.14, 0.14), roughness=0.10, reflect=0.06)
    coral = Material((0.62, 0.10, 0.045), (0.20, 0.20, 0.20), roughness=0.12)
    gold = Material((0.55, 0.35, 0.08), (0.40, 0.30, 0.12), roughness=0.14, reflect=(0.20, 0.15, 0.06))
    place = Transform.translate(PLACE[0], PLACE[1], TOP_OF_BASE)
    scene.add(bottom(), lapis, name="sculpture-bottom", transform=place @ Transform.rotate(-12))
    scene.add(middle(), coral, name="sculpture-middle", transform=place @ Transform.rotate(33))
    scene.add(top(), gold, name="sculpture-top", transform=place @ Transform.rotate(10))


def stand(scene: Scene, palette: Palette) -> None:
    """Four mirrors between two slabs of green marble; they lean back, so that they show walls and pictures."""
    x, y, _ = PLACE
    turn = Transform.translate(x, y, 0) @ Transform.rotate(TURN)
    low, high, foot, head = 0.10, 0.70, 0.92, 0.79
    for bottom_z, top_z, half in ((-0.002, 0.12, 1.0), (0.68, TOP_OF_BASE, 0.86)):
        scene.add(Box((-half, -half, bottom_z), (half, half, top_z)), palette.verde, transform=turn)
    face = Polygon([(foot, -foot, low), (foot, foot, low), (head, head, high), (head, -head, high)])
    for k in range(4):
        side = turn @ Transform.rotate(90 * k)
        scene.add(face, palette.mirror, name=f"mirror-{k}", transform=side)
        scene.add(Cylinder((foot, foot, low), (head, head, high), radius=0.014), palette.brass, transform=side)


def rounded_cube(half: float, roundness: float) -> Shape:
    """A cube whose corners a sphere cuts off."""
    return Intersection(Box((-half, -half, -half), (half, half, half)), Sphere((0, 0, 0), roundness * half))


def bottom() -> Shape:
    """A rounded cube and a short drum on top of it, as one solid."""
    cube = rounded_cube(0.46, 1.32).transformed(Transform.translate(0, 0, 0.458))
    return Union(cube, Cylinder((0, 0, 0.90), (0, 0, 1.00), radius=0.20))


def middle() -> Shape:
    """Three crossed lenses, each what two balls have in common, with a hub and a small ball at either end."""
    reach, radius, centre = 1.10, 1.24, Transform.translate(0, 0, 1.50)
    parts: list[Shape] = [Sphere((0, 0, 0), 0.24)]
    for x, y, z in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
        parts += [Intersection(*(Sphere((reach * h * x, reach * h * y, reach * h * z), radius) for h in (-1, 1)))]
    parts += [Sphere((0, 0, h * 0.53), 0.08) for h in (-1, 1)]
    return Union(*parts).transformed(centre)


def top() -> Shape:
    """What three crossed cylinders have in common, balanced on the uppermost ball, with a pierced crown."""
    r, centre = 0.30, 2.36
    solid = Intersection(
        Cylinder((-1, 0, centre), (1, 0, centre), radius=r),
        Cylinder((0, -1, centre), (0, 1, centre), radius=r),
        Cylinder((0, 0, centre - r + 0.005), (0, 0, centre + 1), radius=r),
    )
    lens = Intersection(Sphere((0, -0.42, 2.93), 0.52), Sphere((0, 0.42, 2.93), 0.52))
    return Union(solid, lens, Sphere((0, 0, 3.25), 0.08))
