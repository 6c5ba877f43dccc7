"""Speed of the base tracer: whole frames, primary rays alone, and scattered rays at a large mesh."""

from __future__ import annotations

import statistics as _statistics
import time
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from .. import _core, reporting
from ..camera import Camera
from ..renderer import Renderer
from ..scene import Scene
from ..statistics import RAYS
from . import workloads
from .tables import Table


def measure(
    *,
    width: int = 1200,
    height: int = 900,
    repeat: int = 5,
    threads: Sequence[int] = (1, 2),
    names: Sequence[str] | None = None,
    triangles: int = 1_000_000,
    rays: int = 1_000_000,
) -> dict[str, Any]:
    """Measures the base tracer on scenes, seen by their own cameras, and on a mesh of about `triangles` triangles.

    `names` are among `workloads.NAMES`; None takes `workloads.default_names()`.

    Returns a JSON-ready dictionary: "machine" (as `report`), the arguments, "scenes" by name, "mesh", and "left_out",
    the reasons why some are missing. Times are medians over `repeat` runs after one that is not counted. A scene has
    "objects", "primitives", "bytes" (of its snapshot), "seconds_to_make", "seconds_to_build" (a snapshot, with its
    BVH), "rays" by kind (of one frame) and "threads" by number, each with "seconds", "ns_per_pixel", "ns_per_ray",
    "ns_per_primary_ray" (the closest hits of the camera's rays alone, without shading) and "scaling" (how many times
    as fast as with the first number of threads).
    """
    result: dict[str, Any] = {
        "machine": dict(reporting.report()),
        "width": width,
        "height": height,
        "repeat": repeat,
        "scenes": {},
        "mesh": None,
        "left_out": {},
    }
    for name in workloads.default_names() if names is None else names:
        part = partial(_scene, name, width, height, repeat, threads)
        workloads.keep(result, result["scenes"], name, part)
    workloads.keep(result, result, "mesh", partial(_mesh, triangles, rays, repeat, threads))
    return result


def _scene(name: str, width: int, height: int, repeat: int, threads: Sequence[int]) -> dict[str, Any]:
    """The measurements of one scene."""
    begin = time.perf_counter()
    scene = workloads.load(name)
    result: dict[str, Any] = {"seconds_to_make": time.perf_counter() - begin, **_snapshot(scene, repeat)}
    if scene.camera is None:
        raise ValueError("bench: the scene has no camera")
    camera = scene.camera.replace(width=width, height=height)
    result["threads"] = {}
    for count in threads:
        result["rays"], result["threads"][str(count)] = _frames(scene, camera, repeat, count)
    _add_scaling(result["threads"])
    return result


def _snapshot(scene: Scene, repeat: int) -> dict[str, Any]:
    """Size of a scene's snapshot, and how long it takes to build."""
    seconds = []
    for _ in range(repeat):
        document = scene._document.copy()  # which has no snapshot yet
        begin = time.perf_counter()
        snapshot = document.snapshot()
        seconds.append(time.perf_counter() - begin)
    return {
        "objects": len(scene),
        "primitives": snapshot.primitive_count,
        "bytes": snapshot.bytes,
        "seconds_to_build": _statistics.median(seconds),
    }


def _frames(scene: Scene, camera: Camera, repeat: int, threads: int) -> tuple[dict[str, int], dict[str, float]]:
    """The rays of a frame, and medians over frames and over searches of the primary rays."""
    with Renderer(scene, method="base", threads=threads) as renderer:
        frames = [renderer.render(camera).stats for _ in range(repeat + 1)][1:]
    seconds = _statistics.median(stats["seconds_by_phase"]["trace"] for stats in frames)
    snapshot, native = scene._document.snapshot(), camera._native
    primary = [_core.primary_hits(snapshot, native, threads=threads)[1] for _ in range(repeat + 1)][1:]
    rays: dict[str, int] = frames[0]["rays"]
    return rays, {
        "seconds": seconds,
        "ns_per_pixel": seconds / rays["eye"] * 1e9,
        "ns_per_ray": seconds / sum(rays.values()) * 1e9,
        "ns_per_primary_ray": _statistics.median(primary) / rays["eye"] * 1e9,
    }


def _mesh(triangles: int, rays: int, repeat: int, threads: Sequence[int]) -> dict[str, Any]:
    """Closest hits of scattered rays at a mesh."""
    vertices, faces = workloads.mesh(triangles)
    begin = time.perf_counter()
    scene = workloads.mesh_scene(vertices, faces)
    made = time.perf_counter() - begin
    ends = workloads.scattered_rays(vertices, rays)
    result: dict[str, Any] = {"triangles": len(faces), "rays": rays, **_snapshot(scene, repeat), "threads": {}}
    result["seconds_to_build"] += made  # the mesh's own hierarchy is made with it
    for count in threads:
        runs = [_core.closest_hits(scene._document.snapshot(), *ends, threads=count) for _ in range(repeat + 1)][1:]
        seconds = _statistics.median(run["seconds"] for run in runs)
        result["hits"] = int((runs[0]["object_id"] >= 0).sum())
        result["threads"][str(count)] = {"seconds": seconds, "ns_per_ray": seconds / rays * 1e9}
    _add_scaling(result["threads"])
    return result


def _add_scaling(threads: dict[str, dict[str, float]]) -> None:
    """How many times as fast each number of threads is as the first."""
    first = next(iter(threads.values()))["seconds"]
    for times in threads.values():
        times["scaling"] = first / times["seconds"]


def tables(result: dict[str, Any]) -> Iterator[Table]:
    """Tables of what `measure` returned."""
    level = result["machine"]["instruction_level"]
    size = f"{result['width']} x {result['height']} pixels, depth 5"
    columns = ["primitives", "bytes each", "build ms", "threads", "ns/primary ray", "ns/ray", "ns/pixel", "scaling"]
    scenes = result["scenes"].items()
    if scenes:
        yield Table(
            f"The base tracer, {size}, medians of {result['repeat']} runs, instruction level {level}",
            ["scene", *columns],
            [row for name, scene in scenes for row in _scene_rows(name, scene)],
        )
        rays = [_ray_row(name, scene["rays"]) for name, scene in scenes]
        yield Table("Rays a pixel", ["scene", *RAYS, "all"], rays)
    if result["mesh"] is not None:
        yield Table(
            f"Closest hits of {result['mesh']['rays']} scattered rays at a mesh",
            ["triangles", "bytes each", "build ms", "rays that hit", "threads", "ns/ray", "scaling"],
            list(_mesh_rows(result["mesh"])),
        )


def _scene_rows(name: str, scene: dict[str, Any]) -> Iterator[list[str]]:
    for threads, times in scene["threads"].items():
        speeds = [f"{times[key]:.1f}" for key in ("ns_per_primary_ray", "ns_per_ray", "ns_per_pixel")]
        yield [
            name,
            str(scene["primitives"]),
            *_size(scene, scene["primitives"]),
            threads,
            *speeds,
            f"{times['scaling']:.2f}",
        ]


def _size(built: dict[str, Any], count: int) -> list[str]:
    return [f"{built['bytes'] / max(1, count):.0f}", f"{built['seconds_to_build'] * 1e3:.1f}"]


def _ray_row(name: str, rays: dict[str, int]) -> list[str]:
    counts = [rays[kind] for kind in RAYS]
    return [name, *(f"{count / rays['eye']:.3f}" for count in (*counts, sum(counts)))]


def _mesh_rows(mesh: dict[str, Any]) -> Iterator[list[str]]:
    share = f"{100 * mesh['hits'] / mesh['rays']:.0f} %"
    for threads, times in mesh["threads"].items():
        speeds = [f"{times['ns_per_ray']:.1f}", f"{times['scaling']:.2f}"]
        yield [str(mesh["triangles"]), *_size(mesh, mesh["triangles"]), share, threads, *speeds]
