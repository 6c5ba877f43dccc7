"""The ready scenes: what the museum holds, determinism, pictures, files."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import raybound as rb

MAKERS = {
    "museum": rb.scenes.museum,
    "three_spheres": rb.scenes.three_spheres,
    "sphereflake": lambda: rb.scenes.sphereflake(2),
}


@pytest.fixture(scope="module")
def museum() -> rb.Scene:
    return rb.scenes.museum()


def parts(shape: object) -> Iterator[object]:
    """A shape and all that it is made of."""
    yield shape
    if isinstance(shape, (rb.Union, rb.Intersection)):
        for part in shape.shapes:
            yield from parts(part)
    elif hasattr(shape, "shape"):
        yield from parts(shape.shape)


def test_the_museum_is_large_enough(museum: rb.Scene) -> None:
    assert museum._document.snapshot().primitive_count > 1100
    assert museum._document.snapshot().object_count == len(museum)
    assert museum._document.snapshot().light_count == len(museum.lights)


def test_the_museum_holds_every_kind_of_shape(museum: rb.Scene) -> None:
    found = {type(part) for item in museum for part in parts(item.shape)}
    assert {rb.Sphere, rb.Box, rb.Cylinder, rb.Cone, rb.Polygon, rb.Union, rb.Intersection} <= found


def test_the_museum_has_paintings(museum: rb.Scene) -> None:
    paintings = [item for item in museum if (item.name or "").startswith("painting-")]
    textures = {item.material.diffuse for item in paintings}
    assert len(paintings) >= 12
    assert all(isinstance(texture, rb.Texture) for texture in textures)
    assert len(textures) == len(paintings)


def test_the_museum_has_lights_of_all_kinds(museum: rb.Scene) -> None:
    kinds = [type(lamp.light) for lamp in museum.lights]
    assert len(kinds) >= 5
    assert set(kinds) == {rb.DirectionalLight, rb.PointLight, rb.SpotLight}


def test_the_museum_has_mirrors_and_glass(museum: rb.Scene) -> None:
    materials = {item.material for item in museum}
    assert any(np.max(m.reflect) > 0.5 for m in materials)
    assert any(np.max(m.transmit) > 0.5 for m in materials)
    assert any(np.max(m.specular) > 0 for m in materials)
    rays = rb.render(museum, museum.camera.replace(width=160, height=120)).stats["rays"] if museum.camera else {}
    assert all(rays[kind] > 0 for kind in ("eye", "shadow", "reflected", "refracted"))


@pytest.mark.parametrize("name", MAKERS)
def test_two_calls_make_equal_scenes(name: str) -> None:
    a, b = MAKERS[name](), MAKERS[name]()
    assert a == b
    assert a is not b
    a.objects[0].remove()
    assert a != b
    assert MAKERS[name]() == b


@pytest.mark.parametrize("name", MAKERS)
def test_pictures_are_neither_dark_nor_blown_out(name: str) -> None:
    scene = MAKERS[name]()
    assert scene.camera is not None
    frame = rb.render(scene, scene.camera.replace(width=200, height=150))
    assert np.isfinite(frame.image).all()
    assert frame.image.min() >= 0
    codes = frame.to_srgb()
    assert 50 < codes.mean() < 200
    assert (codes == 255).all(axis=2).mean() < 0.05
    assert (codes < 8).all(axis=2).mean() < 0.05
    assert len(np.unique(frame.object_id)) > 3


@pytest.mark.parametrize("name", MAKERS)
def test_ready_scenes_survive_json(name: str) -> None:
    scene = MAKERS[name]()
    again = rb.Scene.from_dict(scene.to_dict())
    assert again == scene
    small = scene.camera.replace(width=64, height=48) if scene.camera else None
    assert rb.render(again, small).image.tobytes() == rb.render(scene, small).image.tobytes()


def test_sphereflakes() -> None:
    for levels, balls in ((0, 1), (1, 10), (2, 91), (3, 820)):
        scene = rb.scenes.sphereflake(levels)
        assert len(scene) == balls + 1
        assert len(scene.lights) == 3
    with pytest.raises(ValueError, match="sphereflake: levels must be >= 0, got -1"):
        rb.scenes.sphereflake(-1)
    with pytest.raises(TypeError, match=r"sphereflake: levels must be an int, got 1\.5"):
        rb.scenes.sphereflake(1.5)


def test_balls_of_a_sphereflake_touch_their_parents() -> None:
    balls = [item.shape for item in rb.scenes.sphereflake(2) if isinstance(item.shape, rb.Sphere)]
    centres = np.array([ball.center for ball in balls])
    radii = np.array([ball.radius for ball in balls])
    for child, parent in ((1 + i, 0) for i in range(9)):
        distance = np.linalg.norm(centres[child] - centres[parent])
        assert distance == pytest.approx(radii[child] + radii[parent], rel=1e-5)
    for child in range(10, 91):
        gaps = np.linalg.norm(centres[child] - centres[1:10], axis=1) - radii[child] - radii[1:10]
        assert np.abs(gaps).min() < 1e-5
