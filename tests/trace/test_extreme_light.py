"""Huge, tiny and black: no NaN and no infinity in any picture."""

import itertools

import numpy as np
import pytest
from tests.support.random_scenes import random_scene
from tests.support.support_light import core_render, floor, radiance

import raybound as rb

LARGEST = 2.0**60  # of any colour; only texels may be larger
CAM = rb.Camera((0.5, -4, 2.5), (0, 0, 0.5), fov=45, width=40, height=30)


def basic(material: rb.Material, *lights: object, ambient: float = 0.0, background: float = 0.0) -> rb.Scene:
    scene = rb.Scene(ambient=ambient, background=background)
    scene.add(floor(half=10.0), material)
    scene.add(rb.Sphere((0, 0, 0.7), 0.6), material)
    scene.add(rb.Cone((1, 0.5, 0.05), (1, 0.5, 1), radius=0.4), material)
    for light in lights:
        scene.add_light(light)
    return scene


def assert_finite(scene: rb.Scene, cam: rb.Camera = CAM, max_depth: int = 5) -> np.ndarray:
    image = core_render(scene, cam, max_depth=max_depth).image
    assert np.isfinite(image).all()
    assert (image >= 0).all()
    return image


VALUES = (0.0, 1e-45, 1e-30, 1.0, 1e15, LARGEST)


@pytest.mark.parametrize("intensity", VALUES)
@pytest.mark.parametrize("falloff", [False, True])
def test_any_intensity_with_any_material(intensity: float, falloff: bool) -> None:
    light = rb.PointLight((0.5, -1, 3), (intensity, 0.0, 1.0), falloff=falloff)
    shown = 0.0
    for diffuse, specular, reflect in itertools.product((0.0, 1.0, LARGEST), repeat=3):
        material = rb.Material((diffuse, 0, 1), (specular, 0, 1), roughness=0.1, reflect=(0.0, reflect, 0.5))
        shown = max(shown, assert_finite(basic(material, light)).max())
    assert shown > 0.01


@pytest.mark.parametrize("ambient", VALUES)
@pytest.mark.parametrize("background", [0.0, LARGEST])
def test_any_ambient_light_and_background(ambient: float, background: float) -> None:
    for weight in (0.5, LARGEST):
        material = rb.Material((LARGEST, 0, 1.0), reflect=(weight, 0, weight), transmit=(0.0, weight, weight))
        assert_finite(basic(material, ambient=ambient, background=background))


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-10, 1e-15, 1e-19, 5e-20, 1e-20, 1e-22, 1e-30, 1e-44, 0.0])
@pytest.mark.parametrize("colour", [(1, 1, 1), (1, 0, 0), (0, LARGEST, 1e-45)])
@pytest.mark.parametrize("kind", ["point", "spot"])
def test_lights_that_all_but_touch_a_surface(distance: float, colour: tuple, kind: str) -> None:
    """At the point below the light the squared distance leaves the range of float32."""
    light = rb.PointLight((0, 0, distance), colour, falloff=True)
    if kind == "spot":
        light = rb.SpotLight((0, 0, distance), (0, 0, -1), intensity=colour, falloff=True)
    scene = rb.Scene()
    scene.add(rb.Box((-1, -1, -1), (1, 1, 0)), rb.Material(0.5, 0.5))
    scene.add_light(light)
    origins = [(0, 0, 2), (1e-20, 0, 2), (0, 1e-19, 2), (distance, 0, 2), (0, -distance, 2), (0.5, 0.5, 2)]
    shown = radiance(scene, origins, (0, 0, -1))
    assert np.isfinite(shown).all()
    assert (shown >= 0).all()


@pytest.mark.parametrize("roughness", [1e-4, 1e-3, 1e-2, 1.0, 1e3, LARGEST])
def test_any_roughness(roughness: float) -> None:
    for specular in (1.0, LARGEST):
        material = rb.Material(0.0, (specular, 0, 0.5), roughness=roughness)
        image = assert_finite(basic(material, rb.DirectionalLight((0, 1, -0.4)), rb.PointLight((0, 0, 3))))
        assert image.max() > 0 or roughness < 0.01 or roughness > 10


@pytest.mark.parametrize("slope", [1e-3, 1e-7, 1e-12, 1e-18, 1e-20, 1e-25, 1e-35])
def test_views_and_lights_that_graze_from_opposite_sides(slope: float) -> None:
    """L + V all but vanishes, and so do N.L and N.V."""
    scene = rb.Scene()
    scene.add(rb.Box((-100, -100, -1), (100, 100, 0)), rb.Material(0.5, 1.0))
    scene.add_light(rb.DirectionalLight((-1, 0, -slope)))
    scene.add_light(rb.DirectionalLight((0, 0, -1)))
    shown = radiance(scene, [(-1, 0, slope), (-1, 0, 2 * slope)], (1, 0, -slope))
    assert np.isfinite(shown).all()
    assert shown.max() > 0.1


@pytest.mark.parametrize("slope", [1e-10, 1e-25, 1e-30, 1e-34])
@pytest.mark.parametrize("roughness", [0.05, 0.5])
def test_views_within_a_unit_of_the_plane(slope: float, roughness: float) -> None:
    """N.V as small as float32 allows: N.L / N.V overflows."""
    scene = rb.Scene()
    scene.add(
        rb.Polygon([(0, 0, 0), (1, 0, slope), (1, 1, slope), (0, 1, 0)]), rb.Material(0.5, 1.0, roughness=roughness)
    )
    scene.add_light(rb.DirectionalLight((0, 0, -1)))
    rises = [np.float32(slope)]
    for _ in range(60):
        rises.append(np.nextafter(rises[-1], np.float32(0)))
    with rb.Renderer(scene) as renderer:
        found = renderer.trace([(-1e-6, 0.5, 0)] * len(rises), [(1, 0, rise) for rise in rises])
    assert np.isfinite(found.radiance).all()
    assert (found.object_id == 0).sum() > 20


def test_textures_of_the_largest_numbers() -> None:
    rng = np.random.default_rng(110)
    texels = np.where(rng.random((8, 8, 3)) < 0.5, np.finfo(np.float32).max, 0.0)
    for ambient in (0.0, 1.0, LARGEST):
        material = rb.Material(rb.Texture(texels, (5, 5)), 0.3, reflect=0.5)
        assert_finite(basic(material, rb.PointLight((1, -1, 3)), ambient=ambient))


def test_black_is_black() -> None:
    image = assert_finite(basic(rb.Material(0.0), rb.PointLight((0, 0, 3), (LARGEST,) * 3), ambient=LARGEST))
    assert not image.any()


@pytest.mark.parametrize("ior", [1e-3, 0.5, 1.0, 1.0000001, 1e3])
def test_any_index_of_refraction(ior: float) -> None:
    material = rb.Material(0.1, transmit=0.9, reflect=0.1, ior=ior)
    image = assert_finite(basic(material, rb.PointLight((0, 0, 3)), ambient=1.0, background=1.0), max_depth=8)
    assert image.min() > 0.01


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1e6, 1e12])
def test_any_size_of_scene(scale: float) -> None:
    grow = rb.Transform.scale(scale)
    scene = rb.Scene(ambient=0.1)
    source = basic(rb.Material(0.5, 0.3, reflect=0.3, transmit=0.3))
    for item in source.objects:
        scene.add(item.shape, item.material, transform=grow)
    scene.add_light(rb.PointLight((1 * scale, -1 * scale, 3 * scale)))
    cam = CAM.replace(eye=np.multiply(CAM.eye, scale), target=np.multiply(CAM.target, scale))
    image = assert_finite(scene, cam)
    source.ambient = 0.1
    source.add_light(rb.PointLight((1, -1, 3)))
    plain = assert_finite(source)
    assert (np.abs(image - plain).max(axis=-1) > 1e-3).mean() < 0.005  # largest observed 0


@pytest.mark.parametrize("first", range(200, 240, 10))
def test_random_scenes_are_finite(first: int) -> None:
    for seed in range(first, first + 10):
        scene = random_scene(seed)
        assert_finite(scene, scene.camera, max_depth=8)
