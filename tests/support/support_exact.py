"""Pictures from certified lists beside the base tracer's, and random edits of scenes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from tests.support.random_scenes import (
    MAKERS,
    Rng,
    add_glass_around_the_eye,
    light,
    material,
    random_scene,
    transform,
)

import raybound as rb

ARRAYS = ("image", "depth", "object_id", "error_bound")


@dataclass
class Tally:
    """How much was compared, and how much of it needed no search."""

    frames: int = 0
    pixels: int = 0
    certified: int = 0
    edits: dict[str, int] = field(default_factory=dict)

    @property
    def share(self) -> float:
        return self.certified / max(1, self.pixels)


def differing(a: rb.Frame, b: rb.Frame) -> int:
    """The number of pixels that differ in a byte of radiance, depth, id or bound."""
    wrong = np.zeros(a.path.shape, bool)
    for name in ARRAYS:
        x, y = (np.ascontiguousarray(getattr(f, name)).view(np.uint32) for f in (a, b))
        different = x != y
        wrong |= different.any(axis=-1) if different.ndim == 3 else different
    return int(wrong.sum())


def compare(exact: rb.Renderer, base: rb.Renderer, camera: rb.Camera, tally: Tally, what: str) -> rb.Frame:
    """Renders one view with both and asserts equal bytes."""
    mine, truth = exact.render(camera), base.render(camera)
    wrong = differing(mine, truth)
    assert wrong == 0, f"{what}: {wrong} of {mine.path.size} pixels differ from the base image"
    tally.frames += 1
    tally.pixels += mine.path.size
    tally.certified += int(np.isin(mine.path, (rb.Path.EXACT, rb.Path.BACKGROUND)).sum())
    return mine


def views(scene: rb.Scene, rng: Rng, count: int) -> list[rb.Camera]:
    """The scene's own camera, and others around it, some of them close."""
    camera = scene.camera
    assert camera is not None
    found = [camera]
    while len(found) < count:
        other = camera.orbit(float(rng.uniform(-60, 60)), float(rng.uniform(-20, 20)))
        found.append(other.dolly(float(rng.uniform(0, 5))) if rng.random() < 0.3 else other)
    return found


def _move(scene: rb.Scene, rng: Rng) -> None:
    _object(scene, rng).move(rb.Transform.translate(*(rng.normal(size=3) * 0.5).tolist()))


def _paint(scene: rb.Scene, rng: Rng) -> None:
    _object(scene, rng).material = material(rng)


def _reshape(scene: rb.Scene, rng: Rng) -> None:
    _object(scene, rng).shape = MAKERS[int(rng.integers(len(MAKERS)))](rng)


def _remove(scene: rb.Scene, rng: Rng) -> None:
    if len(scene) > 4:
        _object(scene, rng).remove()


def _add(scene: rb.Scene, rng: Rng) -> None:
    scene.add(MAKERS[int(rng.integers(len(MAKERS)))](rng), material(rng), transform=transform(rng))


def _recolour_light(scene: rb.Scene, rng: Rng) -> None:
    if scene.lights:
        lamp = scene.lights[int(rng.integers(len(scene.lights)))]
        name = "radiance" if isinstance(lamp.light, rb.DirectionalLight) else "intensity"
        lamp.light = lamp.light.replace(**{name: tuple(rng.uniform(0, 1, 3).tolist())})


def _move_light(scene: rb.Scene, rng: Rng) -> None:
    if scene.lights:
        scene.lights[int(rng.integers(len(scene.lights)))].light = light(rng)


def _add_light(scene: rb.Scene, rng: Rng) -> None:
    if len(scene.lights) < 6:
        scene.add_light(light(rng))


def _remove_light(scene: rb.Scene, rng: Rng) -> None:
    if len(scene.lights) > 1:
        scene.lights[int(rng.integers(len(scene.lights)))].remove()


def _object(scene: rb.Scene, rng: Rng) -> rb.Object:
    return scene.objects[int(rng.integers(len(scene.objects)))]


EDITS = {
    "move": _move,
    "paint": _paint,
    "reshape": _reshape,
    "remove": _remove,
    "add": _add,
    "recolour light": _recolour_light,
    "move light": _move_light,
    "add light": _add_light,
    "remove light": _remove_light,
}
WEIGHTS = np.array([6, 2, 1, 2, 3, 2, 2, 1, 1]) / 20
MEMORY = (2**28, 2**28, 2**28, 200_000, 150_000, 1)  # by seed: plenty, tight, none


def edit(scene: rb.Scene, rng: Rng, tally: Tally) -> None:
    """One to three random edits, as one or one by one."""
    names = rng.choice(list(EDITS), size=int(rng.integers(1, 4)), p=WEIGHTS)
    for name in names:
        EDITS[name](scene, rng)
        tally.edits[name] = tally.edits.get(name, 0) + 1


def check_scene(seed: int, tally: Tally, *, cameras: int = 5, pixels: int = 64, still: bool = False) -> None:
    """A random scene from several cameras (`still`: from one, so that blocks are kept), edited between them: every
    frame equals the base image, byte for byte."""
    rng = np.random.default_rng([seed, 6])
    scene = random_scene(seed, pixels=pixels)
    if seed % 9 == 8:
        add_glass_around_the_eye(scene, seed)
    memory = MEMORY[seed % len(MEMORY)]
    with (
        rb.Renderer(scene, method="exact", memory=memory, threads=1 + seed % 2) as exact,
        rb.Renderer(scene, method="base", threads=1) as base,
    ):
        seen = views(scene, rng, 1) * cameras if still else views(scene, rng, cameras)
        for index, camera in enumerate(seen):
            compare(exact, base, camera, tally, f"seed {seed}, view {index}, edits {tally.edits}")
            assert exact.memory_used <= memory
            edit(scene, rng, tally)
        assert scene.camera is not None
        compare(exact, base, scene.camera, tally, f"seed {seed}, the first view again, edits {tally.edits}")
