"""Float32 pictures beside float64 ones, and whether a difference is explained by a discontinuity next to the pixel."""

from __future__ import annotations

from typing import Any

import numpy as np

import raybound as rb

from .support_light import Picture, core_render

TOLERANCE = 5e-5  # of radiance about 1; other pixels differ by rounding alone
REACH = 0.02  # pixels: how far a discontinuity may be from the centre of a pixel that differs


def pictures(
    scene: rb.Scene, cam: rb.Camera, max_depth: int, tolerance: float = TOLERANCE
) -> tuple[Picture, Picture, np.ndarray]:
    """Both pictures, and where they differ by more than the tolerance."""
    single = core_render(scene, cam, max_depth=max_depth)
    double = core_render(scene, cam, max_depth=max_depth, precision="float64")
    error = np.abs(single.image - double.image).max(axis=-1)
    return single, double, error > tolerance * (1 + double.image.max(axis=-1))


def signature(tree: dict[str, Any]) -> tuple:
    """The decisions in a ray tree: what is hit, what is lit, what reflects totally."""
    lights = tuple(lamp["verdict"] for lamp in tree["lights"])
    return (
        *(tree["kind"], tree["object_id"], tree["face_id"], tree["total_internal_reflection"], lights),
        tuple(signature(child) for child in tree["children"]),
    )


def zoomed(cam: rb.Camera, x: int, y: int, reach: float = REACH) -> rb.Camera:
    """A camera of 5 x 5 pixels around the ray of one pixel, that reaches `reach` pixels to each side."""
    direction = cam.rays()[1][y, x].astype(float)
    pixel = 2 * np.tan(np.radians(cam.fov) / 2) / cam.height
    fov = float(np.degrees(2 * np.arctan(reach * pixel * 1.25)))
    # A far target: its rounding turns the view by a unit in the last place, wherever the eye is.
    target = np.add(cam.eye, 1024 * max(1.0, *np.abs(cam.eye)) * direction)
    return cam.replace(target=target, fov=max(fov, 0.001), width=5, height=5)


def is_explained(scene: rb.Scene, cam: rb.Camera, max_depth: int, x: int, y: int, reach: float = REACH) -> bool:
    """Whether ray trees or values around the pixel's centre change by what is to be explained."""
    near = zoomed(cam, x, y, reach)
    frame = rb.render(scene, near, max_depth=max_depth)
    trees = {signature(frame.explain(i, j).tree) for i in range(5) for j in range(5)}
    if len(trees) > 1:
        return True
    single, double, _ = pictures(scene, near, max_depth)
    values = np.concatenate([single.image.reshape(-1, 3), double.image.reshape(-1, 3)])
    return bool(np.ptp(values, axis=0).max() > TOLERANCE / 2)  # a steep texture or highlight
