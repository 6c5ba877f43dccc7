"""Speed beside Embree's, in turn on one core: whole frames of SPD scenes, and scattered rays at a large mesh.

Machines are noisy, so rounds alternate, the best of each side counts, and the ratio means more than either.
"""

from __future__ import annotations

import importlib
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core, reporting
from ..renderer import Renderer
from ..statistics import RAYS
from . import workloads, yardstick
from .tables import Table
from .workloads import Floats, UnavailableError, keep

NAMES = ("balls_s4", "tetra_s6", "mount_s6")  # what the yardstick reads in full
FRAMES = 2  # of a round; the first warms the caches


def measure(
    *, repeat: int = 5, names: Sequence[str] = NAMES, triangles: int = 1_000_000, rays: int = 1_000_000
) -> dict[str, Any]:
    """Measures this tracer and Embree in `repeat` rounds, single-threaded on one core.

    Returns a JSON-ready dictionary: "machine", "core", "repeat", "scenes" by name, "mesh", and "left_out", the reasons
    why some are missing. A scene has for "embree" and "raybound" their "rays" by kind, "seconds", "rays_per_second" and
    "ns_per_primary_ray"; "ratio" is our rays per second over Embree's. The mesh has "seconds_to_build", "ns_per_ray"
    and "hits" of both, and "overhead_ns" of Embree's, the part that is not traversal.
    """
    result: dict[str, Any] = {"machine": dict(reporting.report()), "repeat": repeat, "scenes": {}, "left_out": {}}
    with tempfile.TemporaryDirectory() as folder, yardstick.pinned() as core:
        result["core"] = core
        try:
            program = yardstick.build(Path(folder))
        except UnavailableError as reason:
            result["left_out"].update(dict.fromkeys(names, str(reason)))
            names = ()
        for name in names:
            keep(result, result["scenes"], name, partial(_scene, program, name, repeat))
        keep(result, result, "mesh", partial(_mesh, triangles, rays, repeat))
    return result


def _scene(program: Path, name: str, repeat: int) -> dict[str, Any]:
    """Whole frames of one scene on both sides."""
    scene, path = workloads.load(name), workloads.data_file(name)
    if scene.camera is None:
        raise UnavailableError("the scene has no camera")
    camera = scene.camera.replace(width=yardstick.WIDTH, height=yardstick.HEIGHT)
    snapshot = scene._document.snapshot()
    theirs, frames, primary = [], [], []
    with Renderer(scene, method="base", threads=1, max_depth=yardstick.DEPTH) as renderer:
        for _ in range(repeat):
            theirs.append(yardstick.run(program, path, FRAMES))
            frames += [renderer.render(camera).stats for _ in range(FRAMES)]
            primary += [_core.primary_hits(snapshot, camera._native, threads=1)[1] for _ in range(FRAMES)]
    seconds = min(stats["seconds_by_phase"]["trace"] for stats in frames)
    embree, ours = _embree_side(theirs), _side(frames[0]["rays"], seconds, min(primary))
    return {
        "primitives": {"embree": theirs[0]["primitives"], "raybound": snapshot.primitive_count},
        "embree": embree,
        "raybound": ours,
        "ratio": ours["rays_per_second"] / embree["rays_per_second"],
    }


def _embree_side(runs: Sequence[dict[str, Any]]) -> dict[str, Any]:
    pixels = yardstick.WIDTH * yardstick.HEIGHT
    rays = {"eye": pixels, **{kind: runs[0][kind] for kind in RAYS if kind != "eye"}}
    seconds, primary = (min(run[key] for run in runs) * 1e-9 * pixels for key in ("pixel_ns", "primary_ns"))
    return _side(rays, seconds, primary)


def _side(rays: dict[str, int], seconds: float, primary_seconds: float) -> dict[str, Any]:
    return {
        "rays": rays,
        "seconds": seconds,
        "rays_per_second": sum(rays.values()) / seconds,
        "ns_per_primary_ray": primary_seconds / rays["eye"] * 1e9,
    }


def _mesh(triangles: int, count: int, repeat: int) -> dict[str, Any]:
    """Closest hits of scattered rays at a mesh on both sides."""
    vertices, faces = workloads.mesh(triangles)
    origins, directions = workloads.scattered_rays(vertices, count)
    begin = time.perf_counter()
    scene = workloads.mesh_scene(vertices, faces)
    snapshot = scene._document.snapshot()
    built = time.perf_counter() - begin
    embree_built, search = _embree_search(vertices, faces)
    nothing = _embree_search(vertices[:3] + 100 * np.float32(np.abs(vertices).max()), faces[:1] * 0 + np.arange(3))[1]
    times: dict[str, list[float]] = {"embree": [], "raybound": [], "overhead": []}
    for _ in range(repeat):
        seconds, distance = _timed(search, origins, directions)
        times["embree"].append(seconds)
        times["overhead"].append(_timed(nothing, origins, directions)[0])
        ours = _core.closest_hits(snapshot, origins, directions, threads=1)
        times["raybound"].append(ours["seconds"])
    ns = {side: min(values) / count * 1e9 for side, values in times.items()}
    theirs_hit, ours_hit = distance < 1e30, np.isfinite(ours["t"])
    return {
        "triangles": len(faces),
        "rays": count,
        "embreex": version("embreex"),
        "embree": {"seconds_to_build": embree_built, "ns_per_ray": ns["embree"], "hits": int(theirs_hit.sum())},
        "raybound": {"seconds_to_build": built, "ns_per_ray": ns["raybound"], "hits": int(ours_hit.sum())},
        "overhead_ns": ns["overhead"],
        "rays_that_disagree": int((theirs_hit != ours_hit).sum()),
        "ratio": ns["embree"] / ns["raybound"],
    }


Search = Callable[[Floats, Floats], Floats]


def _embree_search(vertices: Floats, faces: npt.NDArray[np.integer[Any]]) -> tuple[float, Search]:
    """Seconds to build Embree's scene of a mesh, robust, and its closest hits: (origins, directions) -> distances."""
    try:
        scenes = importlib.import_module("embreex.rtcore_scene")
        meshes = importlib.import_module("embreex.mesh_construction")
    except ImportError:
        raise UnavailableError("embreex is missing: pip install 'raybound[bench]'") from None
    begin = time.perf_counter()
    scene = scenes.EmbreeScene(robust=True)
    meshes.TriangleMesh(scene, vertices, faces.astype(np.int32))
    scene.run(vertices[:1], vertices[:1] + 1)  # the first run builds
    return time.perf_counter() - begin, lambda origins, directions: scene.run(origins, directions, query="DISTANCE")


def _timed(search: Search, origins: Floats, directions: Floats) -> tuple[float, Floats]:
    begin = time.perf_counter()
    distances = search(origins, directions)
    return time.perf_counter() - begin, distances


def tables(result: dict[str, Any]) -> Iterator[Table]:
    """Tables of what `measure` returned."""
    how = f"one thread on one core, in turn, best of {result['repeat']} rounds"
    scenes = result["scenes"].items()
    if scenes:
        size = f"{yardstick.WIDTH} x {yardstick.HEIGHT} pixels, depth {yardstick.DEPTH}"
        yield Table(
            f"Beside a minimal Whitted tracer over Embree 3 (robust, single rays): whole frames, {size}, {how}",
            ["scene", "rays Embree", "rays raybound", "Mrays/s Embree", "Mrays/s raybound", "ratio"],
            [_frame_row(name, scene) for name, scene in scenes],
        )
        yield Table(
            "The same, primary rays without shading",
            ["scene", "ns/ray Embree", "ns/ray raybound", "ratio"],
            [_primary_row(name, scene) for name, scene in scenes],
        )
    if "mesh" in result:
        mesh = result["mesh"]
        yield Table(
            f"Closest hits of {mesh['rays']} scattered rays at a mesh of {mesh['triangles']} triangles, {how}. "
            f"Embree 4 (embreex {mesh['embreex']}, robust) is timed around one call for all rays, of which "
            f"{mesh['overhead_ns']:.0f} ns/ray are spent beside traversal",
            ["", "build s", "rays that hit", "ns/ray", "ratio"],
            [_mesh_row(mesh, side) for side in ("embree", "raybound")],
        )


def _frame_row(name: str, scene: dict[str, Any]) -> list[str]:
    sides = [scene["embree"], scene["raybound"]]
    counts = [str(sum(side["rays"].values())) for side in sides]
    return [name, *counts, *(f"{side['rays_per_second'] * 1e-6:.2f}" for side in sides), f"{scene['ratio']:.2f}"]


def _primary_row(name: str, scene: dict[str, Any]) -> list[str]:
    embree, ours = (scene[side]["ns_per_primary_ray"] for side in ("embree", "raybound"))
    return [name, f"{embree:.1f}", f"{ours:.1f}", f"{embree / ours:.2f}"]


def _mesh_row(mesh: dict[str, Any], side: str) -> list[str]:
    found = mesh[side]
    ratio = mesh["ratio"] if side == "raybound" else 1.0
    return [side, f"{found['seconds_to_build']:.2f}", str(found["hits"]), f"{found['ns_per_ray']:.1f}", f"{ratio:.2f}"]
