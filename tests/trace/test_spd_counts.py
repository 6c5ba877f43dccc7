"""Ray counts of the Standard Procedural Databases against those counted from the same files by another program.

The counted program knows no end caps and takes cones as 64-sided; it traces 513 x 513 eye rays, the outermost through
the corners of the picture, to depth 5. The data are in the folder nff/ of the environment variable RAYBOUND_DATA.
"""

from __future__ import annotations

import math
import os
from pathlib import Path

import pytest

import raybound as rb

TOLERANCE = 0.01
COUNTED = {
    "balls_s4": {"eye hits": 263_169, "reflected": 175_918, "refracted": 0, "shadow": 954_993},
    "mount_s6": {"eye hits": 173_686, "reflected": 356_178, "refracted": 356_130, "shadow": 414_392},
    "rings_s7": {"eye hits": 263_169, "reflected": 316_231, "refracted": 0, "shadow": 1_086_428},
    "tetra_s6": {"eye hits": 49_950, "reflected": 0, "refracted": 0, "shadow": 46_261},
    "tree_s11": {"eye hits": 169_901, "reflected": 0, "refracted": 0, "shadow": 1_097_805},
}


def data_file(name: str) -> Path:
    folder = os.environ.get("RAYBOUND_DATA")
    if not folder:
        pytest.skip("needs RAYBOUND_DATA, the folder with nff/")
    return Path(folder, "nff", f"{name}.nff")


def corner_camera(camera: rb.Camera, size: int = 513) -> rb.Camera:
    """Pixel centres where the original's rays are: through the corners of size - 1 pixels a side."""
    slope = math.tan(math.radians(camera.fov) / 2) * size / (size - 1)
    return camera.replace(fov=2 * math.degrees(math.atan(slope)), width=size, height=size)


@pytest.mark.parametrize("name", COUNTED)
def test_ray_counts(name: str) -> None:
    scene = rb.load_scene(data_file(name))
    assert scene.camera is not None
    frame = rb.render(scene, corner_camera(scene.camera), max_depth=5, method="base")
    rays = {**frame.stats["rays"], "eye hits": int((frame.object_id >= 0).sum())}
    assert rays.pop("eye") == 513 * 513
    assert rays == {kind: pytest.approx(count, rel=TOLERANCE, abs=0) for kind, count in COUNTED[name].items()}
