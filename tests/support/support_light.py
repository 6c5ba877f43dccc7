"""Helpers of the tests of light: pictures by every method of the core, rays, and small scenes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import raybound as rb
from raybound import _core

EMITTER_AMBIENT = (1.0, 1.0, 1.0)  # with this, a diffuse colour is what a surface shows without lights


@dataclass(frozen=True)
class Picture:
    image: np.ndarray
    depth: np.ndarray
    object_id: np.ndarray
    path: np.ndarray
    rays: dict[str, int]


def core_render(
    scene: rb.Scene,
    cam: rb.Camera,
    *,
    max_depth: int = 5,
    threads: int = 0,
    precision: str = "float32",
    brute_force: bool = False,
) -> Picture:
    """The base picture by the raw module: the only place that calls it for pictures."""
    buffers = _core.FrameBuffers(cam.width, cam.height)
    counts = _core.render(
        scene._document.snapshot(),
        cam._native,
        buffers,
        max_depth=max_depth,
        threads=threads,
        stride=1,
        precision=precision,
        brute_force=brute_force,
        progress=None,
    )
    assert not buffers.error_bound.any()
    return Picture(buffers.image, buffers.depth, buffers.object_id, buffers.path, counts["rays"])


def differing_pixels(a: Picture, b: Picture) -> np.ndarray:
    """Where two pictures differ in a byte: (h, w) bool. NaNs with the same bits are equal."""
    differ = (a.image.view(np.uint32) != b.image.view(np.uint32)).any(axis=-1)
    return differ | (a.depth.view(np.uint32) != b.depth.view(np.uint32)) | (a.object_id != b.object_id)


def assert_same_picture(a: Picture, b: Picture, what: str) -> None:
    wrong = np.argwhere(differing_pixels(a, b))
    assert not len(wrong), f"{what}: {len(wrong)} pixels differ, the first at (row, column) {wrong[0]}"
    assert a.rays == b.rays, what


def trace(scene: rb.Scene, origins: Any, directions: Any, **options: Any) -> Any:
    """Renderer.trace; origins and directions broadcast against each other."""
    origins, directions = np.broadcast_arrays(np.atleast_2d(origins), np.atleast_2d(directions))
    with rb.Renderer(scene, **options) as renderer:
        return renderer.trace(np.array(origins), np.array(directions))


def radiance(scene: rb.Scene, origins: Any, directions: Any, **options: Any) -> np.ndarray:
    return trace(scene, origins, directions, **options).radiance.astype(np.float64)


def single_ray_tree(scene: rb.Scene, eye: Any, target: Any, max_depth: int = 5) -> dict[str, Any]:
    """The ray tree of the single pixel of a camera at `eye` that looks at `target`."""
    toward = np.subtract(target, eye)
    up = np.eye(3)[np.argmin(np.abs(toward))]
    cam = rb.Camera(eye, target, up=up, fov=1.0, width=1, height=1)
    return rb.render(scene, cam, max_depth=max_depth).explain(0, 0).tree


def chain_of(tree: dict[str, Any]) -> list[dict[str, Any]]:
    """The nodes of a ray tree in which every ray spawns one other at most."""
    nodes = [tree]
    while nodes[-1]["children"]:
        (child,) = nodes[-1]["children"]
        nodes.append(child)
    return nodes


def emitter(colour: Any = 1.0) -> rb.Material:
    """A material that shows its colour where ambient light is 1 and there are no lights."""
    return rb.Material(colour)


def mirror(weight: Any = 1.0) -> rb.Material:
    return rb.Material(0.0, reflect=weight)


def glass(ior: float = 1.5, transmit: Any = 1.0, reflect: Any = 0.0) -> rb.Material:
    return rb.Material(0.0, transmit=transmit, reflect=reflect, ior=ior)


def unit(v: Any) -> np.ndarray:
    v = np.asarray(v, np.float64)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def f32(x: Any) -> np.ndarray:
    """Rounded to float32 as scene inputs are, then as float64 for the closed forms."""
    return np.asarray(x, np.float32).astype(np.float64)


def random_units(rng: np.random.Generator, n: int) -> np.ndarray:
    return unit(rng.normal(size=(n, 3)))


def floor(height: float = 0.0, half: float = 100.0) -> rb.Polygon:
    """A square at z = height that is seen from above as outside."""
    return rb.Polygon([(-half, -half, height), (half, -half, height), (half, half, height), (-half, half, height)])
