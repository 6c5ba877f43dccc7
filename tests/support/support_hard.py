"""The hard cases as parameters of tests."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import raybound as rb

CASES = rb.scenes.HARD_CASES
WIDTH, HEIGHT = 65, 49  # odd: the middle row and column look straight ahead
MESHES = [name for name in CASES if name.endswith("-mesh")]
QUADRICS = ["quadric-clip"]
ANALYTIC = [name for name in CASES if name not in MESHES + QUADRICS]


def all_scales(names: Any) -> Any:
    """A decorator: each of the cases at each scale where it is measured."""
    pairs = [(name, scale) for name in names for scale in CASES[name].scales]
    return pytest.mark.parametrize(("name", "scale"), pairs, ids=[f"{name}-{scale:.0e}" for name, scale in pairs])


def hard(name: str, scale: float | None = None) -> tuple[rb.Scene, rb.Camera]:
    """A case with a camera of 65 x 49 pixels."""
    scene = rb.scenes.hard_case(name, scale)
    assert scene.camera is not None
    return scene, scene.camera.replace(width=WIDTH, height=HEIGHT)


def rays_of(cam: rb.Camera) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions of all pixels, (n, 3) float64, row by row."""
    origins, directions = cam.rays()
    return origins.reshape(-1, 3).astype(float), directions.reshape(-1, 3).astype(float)


def render(scene: rb.Scene, cam: rb.Camera, name: str) -> rb.Frame:
    return rb.render(scene, cam, max_depth=CASES[name].max_depth)


def flat(image: np.ndarray) -> np.ndarray:
    """Pixels in the order of `rays_of`, float64."""
    return image.reshape(-1, 3).astype(float)
