"""Two small classics: three spheres, and the sphereflake of the Standard Procedural Databases."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..camera import Camera
from ..lights import DirectionalLight, PointLight
from ..materials import Material, Texture
from ..scene import Scene
from ..shapes import Polygon, Sphere

Array = NDArray[np.float64]


def three_spheres() -> Scene:
    """A shiny, a mirror and a glass sphere on a chequered floor under an evening sky."""
    scene = Scene(ambient=(0.14, 0.15, 0.18), background=(0.022, 0.036, 0.075))
    squares = np.kron(np.array([[0, 1], [1, 0]]), np.ones((64, 64)))[..., None]
    tiles = np.array([0.62, 0.56, 0.46]) * squares + np.array([0.10, 0.13, 0.16]) * (1 - squares)
    half = 12.0
    ground = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    floor = Material(Texture(tiles, (half, half)), (0.05, 0.05, 0.05), roughness=0.15, reflect=0.06)
    scene.add(Polygon(ground), floor, name="floor")
    shiny = Material((0.66, 0.09, 0.05), (0.22, 0.22, 0.22), roughness=0.10, reflect=0.06)
    mirror = Material((0.03, 0.03, 0.035), (0.5, 0.5, 0.5), roughness=0.05, reflect=(0.78, 0.80, 0.84))
    glass = Material((0.0, 0.0, 0.0), (0.6, 0.6, 0.6), roughness=0.05, reflect=0.09, transmit=0.90, ior=1.5)
    scene.add(Sphere((-1.55, 0.45, 1.0), 1.0), shiny, name="shiny")
    scene.add(Sphere((0.62, 1.65, 1.2), 1.2), mirror, name="mirror")
    scene.add(Sphere((0.95, -0.95, 0.75), 0.75), glass, name="glass")
    scene.add_light(DirectionalLight((0.55, 0.75, -0.85), (0.75, 0.68, 0.56)), name="sun")
    scene.add_light(PointLight((-4.0, -2.5, 5.0), (0.32, 0.36, 0.45)), name="lamp")
    scene.camera = Camera((-1.3, -6.1, 3.75), (-0.05, 0.30, 0.70), fov=36)
    return scene


def sphereflake(levels: int = 4) -> Scene:
    """The fractal of balls by Eric Haines: each ball carries nine of a third of its size, `levels` times over.

    Four levels make 7381 balls. Floor, lights and camera are those of the database "balls" of the SPD; the balls mirror
    half of the light, and the three lights have its intensity of 1/sqrt(3).
    """
    if isinstance(levels, bool) or not isinstance(levels, int):
        raise TypeError(f"sphereflake: levels must be an int, got {levels!r}")
    if levels < 0:
        raise ValueError(f"sphereflake: levels must be >= 0, got {levels}")
    scene = Scene(background=(0.078, 0.361, 0.753))
    floor = Material((0.80, 0.60, 0.264))
    corners = [(12.0, 12.0, -0.5), (-12.0, 12.0, -0.5), (-12.0, -12.0, -0.5), (12.0, -12.0, -0.5)]
    scene.add(Polygon(corners), floor, name="floor")
    ball = Material((0.50, 0.45, 0.35), (0.05, 0.05, 0.05), roughness=0.15, reflect=(0.50, 0.45, 0.35))
    for centre, radius in zip(*flake(levels), strict=True):
        scene.add(Sphere(tuple(centre.tolist()), float(radius)), ball)
    for position in ((4.0, 3.0, 2.0), (1.0, -4.0, 4.0), (-3.0, 1.0, 5.0)):
        scene.add_light(PointLight(position, (3**-0.5, 3**-0.5, 3**-0.5)))
    scene.camera = Camera((2.1, 1.3, 1.7), (0.0, 0.0, 0.0), fov=45, width=512, height=512)
    return scene


def flake(levels: int) -> tuple[Array, Array]:
    """Centres (n, 3) and radii (n,) of all the balls, large ones first."""
    centres, radii, outward = np.zeros((1, 3)), np.full(1, 0.5), np.array([[0.0, 0.0, 1.0]])
    all_centres, all_radii = [centres], [radii]
    for _ in range(levels):
        # (n, 9, 3): the nine directions, turned from the z axis to each ball's own outward direction.
        directions = np.einsum("nij,kj->nki", turns_from_z(outward), nine_directions())
        centres = centres[:, None, :] + radii[:, None, None] * (4 / 3) * directions
        centres, outward, radii = centres.reshape(-1, 3), directions.reshape(-1, 3), np.repeat(radii / 3, 9)
        all_centres.append(centres)
        all_radii.append(radii)
    return np.concatenate(all_centres), np.concatenate(all_radii)


def nine_directions() -> Array:
    """Six directions around the equator and three above it, as SPD sets them."""
    equator = [(math.cos(a), math.sin(a), 0.0) for a in np.radians(15 + 60 * np.arange(6))]
    level, reach = math.sqrt(2 / 3), math.sqrt(1 / 3)
    above = [(reach * math.cos(a), reach * math.sin(a), level) for a in np.radians(45 + 120 * np.arange(3))]
    return np.array(equator + above)


def turns_from_z(directions: Array) -> Array:
    """The least rotation that takes the z axis to each of the unit directions (n, 3): (n, 3, 3)."""
    x, y, z = directions.T
    down = z < -1 + 1e-9  # here any half turn would do: SPD takes the one about the y axis
    share = 1 / np.where(down, 1.0, 1 + z)
    rows = [[1 - x * x * share, -x * y * share, x], [-x * y * share, 1 - y * y * share, y], [-x, -y, z]]
    return np.where(down[:, None, None], np.diag([-1.0, 1.0, -1.0]), np.moveaxis(np.array(rows), -1, 0))
