"""What one instruction level computes, written to a file: `python -m tests.support.support_levels OUT.npz`."""

from __future__ import annotations

import sys

import numpy as np

import raybound as rb

from .random_scenes import random_scene


def scenes() -> dict[str, rb.Scene]:
    """The ready scenes, and random ones with every shape, transform, light and texture."""
    ready = {
        "museum": rb.scenes.museum(),
        "three_spheres": rb.scenes.three_spheres(),
        "sphereflake": rb.scenes.sphereflake(3),
    }
    return {**ready, **{f"random {seed}": random_scene(seed) for seed in range(6)}}


def results() -> dict[str, np.ndarray]:
    """Pictures, ids, depths and hit records of every scene, by name."""
    found: dict[str, np.ndarray] = {"level": np.array(rb.report()["instruction_level"])}
    for name, scene in scenes().items():
        assert scene.camera is not None
        camera = scene.camera.replace(width=240, height=180)
        frame = rb.render(scene, camera)
        found.update({f"{name}: {array}": getattr(frame, array) for array in ("image", "object_id", "depth")})
        directions = camera.rays()[1].reshape(-1, 3)
        origins = np.repeat(np.array([camera.eye]), len(directions), axis=0)
        eye_hits = scene.intersect(origins, directions)
        rng = np.random.default_rng(1)
        low, high = np.asarray(scene.bounds)
        origins, targets = (rng.uniform(low, high, (20_000, 3)) for _ in range(2))
        scattered_hits = scene.intersect(origins, targets - origins)
        # As bytes: files do not keep the padding of records.
        found[f"{name}: hits from the eye"] = eye_hits.view(np.uint8)
        found[f"{name}: hits of scattered rays"] = scattered_hits.view(np.uint8)
        found[f"{name}: number of hits"] = np.array([eye_hits["hit"].sum(), scattered_hits["hit"].sum()])
        found[f"{name}: occlusion"] = scene.occluded(origins, targets)
    return found


if __name__ == "__main__":
    np.savez(sys.argv[1], **results())
