"""Closed meshes with needles, with triangles of all sizes, and far away: no ray may pass between triangles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...camera import Camera
from ...lights import DirectionalLight, PointLight
from ...materials import Material
from ...meshes import Mesh
from ...scene import Scene
from .registry import Group
from .stage import GREY, RED, WHITE, YELLOW, Place, power_of_two, scene_with

Vertices = NDArray[np.float64]
Angles = NDArray[np.floating[Any]]
Faces = NDArray[np.int64]

case = Group()
FAR = (148376.0, 1234.0, -223423.0)


def globe(polar: Angles, turn: Angles) -> tuple[Vertices, Faces]:
    """The unit sphere as a closed mesh: vertices (n, 3) and faces (m, 3), counter-clockwise seen from outside.

    `polar` are the angles of its rings from the z axis, between 0 and pi and growing; `turn` those of the vertices on
    a ring, all in rad.
    """
    rings, around = len(polar), len(turn)
    angle, spin = np.meshgrid(polar, turn, indexing="ij")
    ring = np.stack([np.sin(angle) * np.cos(spin), np.sin(angle) * np.sin(spin), np.cos(angle)], axis=-1)
    vertices = np.concatenate([[(0, 0, 1), (0, 0, -1)], ring.reshape(-1, 3)])
    j = np.arange(around)
    top = [np.stack([0 * j, _at(0, j, around), _at(0, j + 1, around)], axis=1)]
    bottom = [np.stack([0 * j + 1, _at(rings - 1, j + 1, around), _at(rings - 1, j, around)], axis=1)]
    sides = []
    for i in range(rings - 1):
        a, b = _at(i, j, around), _at(i + 1, j, around)
        c, d = _at(i + 1, j + 1, around), _at(i, j + 1, around)
        sides += [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    return vertices, np.concatenate([*top, *sides, *bottom])


def _at(i: int, j: Faces, around: int) -> Faces:
    """The number of the j-th vertex on the i-th ring."""
    return 2 + i * around + j % around


@case(
    "needle-mesh",
    "A closed mesh in which every other triangle is a needle: nothing may leak between them.",
    scale="the width of the needles over their length, and the angle they take, rad",
    default=1e-3,
    scales=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5),
    within=(1e-6, 0.125),
)
def needle_mesh(scale: float) -> Scene:
    """A faceted gem of 24 sides with a needle along each edge; a light inside must not show on the floor."""
    sides = np.arange(24) * (2 * math.pi / 24)
    vertices, faces = globe(np.array([0.5, 1.1, 2.2]), np.sort(np.concatenate([sides, sides + scale])))
    gem = Mesh(vertices + np.array([0.0, 0.0, 1.25]), faces)
    scene = scene_with((gem, RED), (Place().floor(8.0), GREY))
    scene.add_light(PointLight((0.0, 0.0, 1.25), 1.0))
    scene.add_light(DirectionalLight((0.5, 0.75, -1.0), 0.7))
    scene.camera = Camera((-0.5, -4.5, 3.0), (0.0, 0.0, 1.0), fov=45.0)
    return scene


@case(
    "graded-mesh",
    "A closed mesh without T-vertices whose triangles shrink toward its poles, by a constant factor from ring to ring.",
    scale="the radius of the least ring over that of the mesh",
    default=1e-4,
    scales=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
    within=(1e-7, 0.25),
)
def graded_mesh(scale: float) -> Scene:
    """Seen from inside, where every ray meets it."""
    half = np.geomspace(scale, 1.25, 16)
    vertices, faces = globe(np.concatenate([half, math.pi - half[::-1]]), np.arange(24) * (2 * math.pi / 24))
    scene = scene_with((Mesh(vertices, faces), WHITE), (Place().sphere((0.0, 0.25, 0.375), 0.125), RED))
    scene.add_light(PointLight((0.25, -0.5, -0.25), 0.8))
    scene.camera = Camera((0.0, 0.0, -0.5), (0.0, 0.0, 1.0), up=(0.0, 1.0, 0.0), fov=75.0)
    return scene


@case(
    "far-mesh",
    "The inside of a mesh with randomly moved vertices, far from the origin: every ray meets it.",
    scale="its middle is at scale * (148376, 1234, -223423), scene units",
    default=1.0,
    scales=(1e-3, 1.0, 10.0),
    within=(1e-6, 1e3),
)
def far_mesh(scale: float) -> Scene:
    """16 by 16 faces, 2 units wide, or 2000 float32 steps where these are larger, with a ball and a block inside."""
    rng = np.random.default_rng(16)
    vertices, faces = globe(np.arange(1, 16) * (math.pi / 16), np.arange(16) * (2 * math.pi / 16))
    vertices = vertices * rng.uniform(0.9, 1.1, (len(vertices), 1))
    middle = np.asarray(FAR) * scale
    unit = max(1.0, power_of_two(float(np.abs(middle).max())) * 2.0**-13)
    place = Place((float(middle[0]), float(middle[1]), float(middle[2])), unit)
    room = Material((0.62, 0.60, 0.55), reflect=0.2)
    scene = scene_with((Mesh(middle + unit * vertices, faces), room))
    scene.add(place.sphere((0.25, 0.375, -0.125), 0.1875), RED)
    scene.add(place.box((-0.5, 0.25, -0.375), (-0.1875, 0.5, 0.125)), YELLOW)
    scene.add_light(place.lamp(0.25, -0.375, 0.5))
    scene.camera = place.camera((0.0, -0.75, 0.0), (0.0, 0.25, 0.0), fov=80.0)
    return scene
