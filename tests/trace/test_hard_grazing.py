"""What is hard about grazing views: nothing shades itself, images are in their places."""

import numpy as np
import pytest
from tests.support.support_hard import all_scales, flat, hard, rays_of, render
from tests.support.support_light import f32

import raybound as rb

SKY = f32((0.30, 0.42, 0.58))


@all_scales(["grazing-plane", "grazing-cylinder", "grazing-cone", "grazing-sphere"])
def test_nothing_shades_or_mirrors_itself_at_grazing_angles(name: str, scale: float) -> None:
    """The surface alone: all of it is lit, and mirrors the sky, not itself."""
    scene, cam = hard(name, scale)
    for item in scene.objects[1:]:
        item.remove()
    frame = render(scene, cam, name)
    seen = frame.object_id == 0
    o, d = rays_of(cam)
    hits = scene.intersect(o[seen.ravel()], d[seen.ravel()])
    light = scene.lights[0].light
    toward = -f32(light.direction) / np.linalg.norm(f32(light.direction))
    cosine = hits["normal"].astype(float) @ toward
    expected = f32((0.42, 0.40, 0.37)) * (0.25 + f32(light.radiance[0]) * cosine)[:, None] + 0.35 * SKY
    assert np.abs(frame.image[seen] - expected).max() < 2e-6
    assert seen.mean() > 0.3
    assert cosine.min() > 0.5


@pytest.mark.parametrize(
    "shape",
    [
        rb.Sphere((0, 0, -1), 1.0),
        rb.Cylinder((0, -2, -1), (0, 2, -1), radius=1.0),
        rb.Cone((-1, 0, -3), (3, 0, 0), radius=3.75).transformed(rb.Transform.rotate(90.0)),
    ],
    ids=["sphere", "cylinder", "cone"],
)
def test_tangent_rays_do_not_see_the_inside(shape: rb.Shape) -> None:
    """A ray that begins outside, and touches within rounding, misses or sees the lit outside: never the dark inside."""
    rng = np.random.default_rng(4)
    scene = rb.Scene()
    scene.add(shape, rb.Material(1.0))
    scene.add_light(rb.DirectionalLight((0, 0, -1)))
    n = 4000
    o = np.column_stack([-(10 ** rng.uniform(-5, 1, n)), rng.choice([0.0, 0.25], n), np.zeros(n)])
    d = np.column_stack([np.ones(n), rng.choice([-1, 0, 1], n) * 10 ** rng.uniform(-12, -4, n), np.zeros(n)])
    d[:, 2] = rng.choice([0.0, 0.0, 1e-12, -1e-12, -1e-9], n)
    with rb.Renderer(scene) as renderer:
        found = renderer.trace(o, d)
    hit = found.object_id == 0
    assert hit.sum() > 500
    dark = hit & (found.radiance[:, 0] < 0.5)
    assert not dark.any(), (int(dark.sum()), o[dark][0].tolist(), d[dark][0].tolist())


@all_scales(["grazing-plane"])
def test_images_in_a_grazing_mirror_are_in_their_places(name: str, scale: float) -> None:
    """What the floor mirrors is what an eye below it sees without the floor."""
    scene, cam = hard(name, scale)
    frame = render(scene, cam, name)
    below, o, d = scene.copy(), *rays_of(cam)
    floor = frame.object_id.ravel() == 0
    for lamp in below.lights:
        lamp.remove()
    without_light = render(below, cam, name)  # the floor's own light is constant then, and its shadows do not matter
    below.objects[0].remove()
    with rb.Renderer(below) as renderer:
        image = renderer.trace(o[floor] * [1, 1, -1], d[floor] * [1, 1, -1])
    # Rays from below must not meet the feet of things, which are below the floor.
    inside = (image.object_id >= 1) & (flat(without_light.image)[floor][:, 2] > 0.3)
    shown = flat(without_light.image)[floor] - f32((0.42, 0.40, 0.37)) * 0.25
    differs = np.abs(shown - 0.35 * image.radiance).max(axis=1) > 1e-3
    assert (differs & ~inside).mean() < 0.02
    if scale >= 1e-5:
        assert (image.object_id >= 1).sum() > 100
