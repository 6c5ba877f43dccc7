"""What is measured: scenes by name, and a large mesh with rays that have nothing in common."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import raybound

from .. import scenes
from ..materials import Material
from ..scene import Scene
from ..scene_file import load_scene

READY: dict[str, Callable[[], Scene]] = {
    "museum": scenes.museum,
    "sphereflake:4": lambda: scenes.sphereflake(4),
}
# The Standard Procedural Databases (Eric Haines) at these sizes: RAYBOUND_DATA/nff/NAME.nff.
SPD = ("balls_s4", "gears_s4", "lattice_s8", "mount_s6", "rings_s7", "tetra_s6", "tree_s11")
NAMES = (*READY, *SPD)

Floats = npt.NDArray[np.float32]


class UnavailableError(Exception):
    """Something that cannot be measured here; the message says why."""


def data_file(name: str) -> Path:
    """The file of an SPD scene. UnavailableError if RAYBOUND_DATA is unset or the file is not there."""
    folder = os.environ.get("RAYBOUND_DATA")
    if not folder:
        raise UnavailableError("RAYBOUND_DATA is not set")
    path = Path(folder, "nff", f"{name}.nff")
    if not path.is_file():
        raise UnavailableError(f"RAYBOUND_DATA has no nff/{name}.nff")
    return path


def default_names() -> list[str]:
    """The museum and the SPD scenes; where these are missing, the sphereflake stands in for `balls_s4`, its copy."""
    try:
        data_file("balls_s4")
    except UnavailableError:
        return [*READY, *SPD]
    return ["museum", *SPD]


def load(name: str) -> Scene:
    """The scene called `name`. ValueError for an unknown name, UnavailableError if it cannot be loaded."""
    if name in READY:
        return READY[name]()
    if name not in SPD:
        raise ValueError(f"bench: scenes must be among {', '.join(NAMES)}, got {name!r}")
    path = data_file(name)
    try:
        return load_scene(path)
    except (ValueError, ImportError) as error:
        raise UnavailableError(str(error)) from error


def keep(result: dict[str, Any], into: dict[str, Any], name: str, part: Callable[[], Any]) -> None:
    """Puts the measurements of a part under its name, or the reason why there are none under result["left_out"]."""
    try:
        into[name] = part()
    except UnavailableError as reason:
        result["left_out"][name] = str(reason)


def bumpy_sphere(rings: int, columns: int) -> tuple[Floats, npt.NDArray[np.int32]]:
    """A unit sphere with fractal relief: vertices (2 + rings columns, 3), and 2 rings columns triangles (n, 3).

    The relief is six octaves of sine waves in space, whose directions are the same in every run.
    """
    theta = np.pi * np.arange(1, rings + 1) / (rings + 1)
    phi = 2 * np.pi * np.arange(columns) / columns
    across = np.stack([np.cos(phi), np.sin(phi), np.zeros(columns)], -1)
    middle = np.sin(theta)[:, None, None] * across + np.cos(theta)[:, None, None] * np.array([0.0, 0.0, 1.0])
    points = np.concatenate([[(0.0, 0.0, 1.0)], middle.reshape(-1, 3), [(0.0, 0.0, -1.0)]])
    rng = np.random.default_rng(7)
    relief = np.zeros(len(points))
    for octave in range(6):
        for wave in rng.normal(size=(4, 3)) * 3 * 2**octave:
            relief += np.sin(points @ wave + rng.uniform(0, 2 * np.pi)) * 0.03 / 1.9**octave
    return (points * (1 + relief)[:, None]).astype(np.float32), _faces(rings, columns)


def _faces(rings: int, columns: int) -> npt.NDArray[np.int32]:
    """Triangles between neighbouring rings and around both poles, counter-clockwise seen from outside."""
    here = np.arange(columns)
    after = (here + 1) % columns
    upper = 1 + columns * np.arange(rings - 1)[:, None]
    lower = upper + columns
    last = 1 + columns * (rings - 1)
    parts = [
        np.stack([np.zeros_like(here), 1 + here, 1 + after], -1),
        np.stack([upper + here, lower + here, lower + after], -1).reshape(-1, 3),
        np.stack([upper + here, lower + after, upper + after], -1).reshape(-1, 3),
        np.stack([np.full_like(here, last + columns), last + after, last + here], -1),
    ]
    return np.concatenate(parts).astype(np.int32)


def mesh(triangles: int) -> tuple[Floats, npt.NDArray[np.int32]]:
    """A bumpy sphere of about so many triangles."""
    rings = max(2, round((triangles / 4) ** 0.5))
    return bumpy_sphere(rings, max(3, round(triangles / (2 * rings))))


def mesh_scene(vertices: Floats, faces: npt.NDArray[np.int32]) -> Scene:
    """A scene of one mesh. UnavailableError if this version has no meshes."""
    make = getattr(raybound, "Mesh", None)
    if make is None:
        raise UnavailableError("this version has no meshes")
    scene = Scene()
    scene.add(make(vertices, faces), Material())
    return scene


def scattered_rays(vertices: Floats, count: int) -> tuple[Floats, Floats]:
    """Origins and directions (count, 3): from points of the bounding sphere around the origin to others of it."""
    radius = float(np.linalg.norm(vertices, axis=1).max()) * 1.001
    rng = np.random.default_rng(11)
    ends = rng.normal(size=(2, count, 3))
    ends *= radius / np.linalg.norm(ends, axis=2, keepdims=True)
    return ends[0].astype(np.float32), (ends[1] - ends[0]).astype(np.float32)
