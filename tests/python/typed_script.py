"""What a user writes, checked by `mypy --strict` in `make lint`, and run by test_typing.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import raybound as rb


def build() -> rb.Scene:
    scene = rb.Scene(ambient=0.1, background=(0.2, 0.3, 0.5))
    wood = rb.Material(rb.Texture(np.ones((2, 2, 3)), (2, 2), wrap="mirror"), specular=0.1)
    shape: rb.Shape = rb.Sphere((0, 0, 1), 1.0) & rb.Box(np.zeros(3), [1, 1, 2]) | rb.Cone(radius=0.5)
    ball: rb.Object = scene.add(shape, wood, name="ball", transform=rb.Transform.rotate(30, axis=(0, 0, 1)))
    lamp: rb.LightHandle = scene.add_light(rb.PointLight((3, -4, 5)), name="lamp")
    with scene.edit():
        ball.material = ball.material.replace(reflect=0.3)
        ball.move(rb.Transform.translate(0, 0, 0.1) @ rb.Transform.scale(1.1).inverse())
        lamp.light = rb.SpotLight((3, -4, 5), (-3, 4, -5), cutoff=40.0)
        scene["ball"].shape = rb.Cylinder()
        scene.ambient = (0.1, 0.1, 0.1)
    scene.camera = rb.Camera((0, -5, 1), (0, 0, 0), width=32, height=24).orbit(20, 10).replace(fov=50.0)
    return scene


def render(scene: rb.Scene, folder: Path) -> rb.Frame:
    fractions: list[float] = []
    with rb.Renderer(scene, rb.Tolerance(0), method="base", threads=1) as renderer:
        frame = renderer.render(progress=fractions.append)
        for better in renderer.refine(frame.camera):
            rb.testing.assert_within_bound(better, frame)
        views = [frame.camera.dolly(0.1 * step) for step in range(2)]
        seconds = [view.stats["seconds"] for view in renderer.sequence(views)]
        radiance = renderer.trace([(0, 0, 9)], [(0, 0, -1)]).radiance
    assert len(seconds) == 2
    assert radiance.shape == (1, 3)
    frame.save(folder / "frame.png")
    traced = int((frame.path == rb.Path.TRACED).sum())
    assert frame.stats["pixels"][rb.Path.TRACED.name] == traced
    print(frame.explain(16, 12), rb.report(), np.asarray(frame).mean())
    rb.plot.path_map(frame).savefig(folder / "map.png")
    return frame


def main(folder: Path) -> rb.Frame:
    scene = build()
    scene.save(folder / "scene.json")
    again = rb.load_scene(folder / "scene.json")
    hits = again.intersect(np.array([[0, -5, 0.5]]), np.array([[0, 1, 0]]))
    assert bool(hits["hit"][0])
    assert again == scene
    return render(again, folder)
