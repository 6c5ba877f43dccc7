"""Which rays are traced, counted by hand: depth, weights of zero, shadow rays."""

import pytest
from tests.support.support_light import core_render, emitter, floor, glass, mirror, trace

import raybound as rb

W, H = 6, 4
PIXELS = W * H
DOWN = rb.Camera((0, 0, 2), (0, 0, 0), up=(0, 1, 0), fov=20, width=W, height=H)


def counts(scene: rb.Scene, max_depth: int = 5, cam: rb.Camera = DOWN) -> dict[str, int]:
    rays = rb.render(scene, cam, max_depth=max_depth, method="base").stats["rays"]
    assert rays == core_render(scene, cam, max_depth=max_depth).rays
    return {kind: count for kind, count in rays.items() if count}


def scene_with(material: rb.Material, *lights: object) -> rb.Scene:
    scene = rb.Scene(background=(1, 1, 1))
    scene.add(floor(), material)
    for light in lights:
        scene.add_light(light)
    return scene


def test_background_needs_one_ray_a_pixel() -> None:
    assert counts(rb.Scene()) == {"eye": PIXELS}


@pytest.mark.parametrize(("depth", "reflected"), [(1, 0), (2, PIXELS), (5, PIXELS)])
def test_a_mirror_spawns_one_ray_unless_it_is_at_max_depth(depth: int, reflected: int) -> None:
    expected = {"eye": PIXELS, "reflected": reflected}
    assert counts(scene_with(mirror()), depth) == {k: v for k, v in expected.items() if v}


@pytest.mark.parametrize("depth", [1, 2, 3, 5, 9, 50])
def test_two_mirrors_spawn_max_depth_minus_one_rays(depth: int) -> None:
    scene = rb.Scene()
    scene.add(floor(half=1000.0), mirror())
    scene.add(floor(10.0, half=1000.0), mirror())  # seen from below
    rays = counts(scene, depth)
    assert rays.get("reflected", 0) == PIXELS * (depth - 1)


@pytest.mark.parametrize(("depth", "refracted"), [(1, 0), (2, 1), (3, 2), (4, 2)])
def test_a_glass_plate_spawns_two_rays(depth: int, refracted: int) -> None:
    scene = rb.Scene(background=(1, 1, 1))
    scene.add(rb.Box((-50, -50, -1), (50, 50, 0)), glass())
    assert counts(scene, depth).get("refracted", 0) == PIXELS * refracted


@pytest.mark.parametrize("depth", [1, 2, 3, 4, 6])
def test_a_plate_that_mirrors_and_refracts_makes_a_binary_tree(depth: int) -> None:
    """Outside: one reflected ray that escapes and one that enters; each inside: one that escapes and one that stays."""
    scene = rb.Scene(background=(1, 1, 1))
    scene.add(rb.Box((-500, -500, -1), (500, 500, 0)), glass(1.5, transmit=0.5, reflect=0.5))
    assert counts(scene, depth) == {
        k: v * PIXELS for k, v in {"eye": 1, "reflected": depth - 1, "refracted": depth - 1}.items() if v
    }


def test_the_surface_at_max_depth_shows_its_local_light_only() -> None:
    scene = rb.Scene(ambient=1.0, background=(64, 64, 64))
    scene.add(floor(), rb.Material(1.0, reflect=1.0))
    scene.add(rb.Disk((0, 0, 10), (0, 0, 1), radius=50.0), rb.Material(16.0, reflect=1.0))
    shown = [trace(scene, (0, 0, 2), (0, 0, -1), max_depth=depth).radiance[0, 0] for depth in (1, 2, 3, 4)]
    assert shown == [1, 17, 18, 34]


def test_total_internal_reflection_is_one_reflected_ray_even_without_a_mirror() -> None:
    scene = rb.Scene(background=(1, 1, 1))
    scene.add(rb.Box((-500, -500, -1), (500, 500, 0)), glass(1.5))
    cam = rb.Camera((0, 0, -0.5), (10, 0, 0), fov=5, width=W, height=H)
    assert counts(scene, 2, cam) == {"eye": PIXELS, "reflected": PIXELS}


def test_weights_of_zero_in_all_channels_spawn_nothing_but_one_channel_suffices() -> None:
    assert counts(scene_with(rb.Material(1.0, reflect=(0, 0, 0), transmit=0.0))) == {"eye": PIXELS}
    assert counts(scene_with(rb.Material(1.0, reflect=(0, 1e-30, 0)))) == {"eye": PIXELS, "reflected": PIXELS}
    assert counts(scene_with(rb.Material(1.0, transmit=(0, 0, 0.5)))) == {"eye": PIXELS, "refracted": PIXELS}


LAMP = rb.PointLight((0, 0, 5))


@pytest.mark.parametrize(
    ("material", "light", "shadow"),
    [
        (emitter(), LAMP, 1),
        (rb.Material(0.0, 0.5), LAMP, 1),  # the specular term alone
        (rb.Material(0.0, 0.0), LAMP, 0),  # black
        (mirror(), LAMP, 0),
        (emitter(), rb.PointLight((0, 0, -5)), 0),  # behind
        (emitter(), rb.PointLight((0, 0, 5), (0, 0, 0)), 0),  # dark
        (emitter(), rb.PointLight((0, 0, 5), (0, 0, 1)), 1),
        (emitter(), rb.DirectionalLight((0, 0, -1)), 1),
        (emitter(), rb.DirectionalLight((0, 0, 1)), 0),
        (emitter(), rb.SpotLight((0, 0, 5), (0, 0, -1)), 1),
        (emitter(), rb.SpotLight((0, 0, 5), (0, 0, 1)), 0),  # outside the cone
    ],
)
def test_shadow_rays(material: rb.Material, light: object, shadow: int) -> None:
    assert counts(scene_with(material, light)).get("shadow", 0) == PIXELS * shadow


def test_every_light_that_counts_takes_one_shadow_ray() -> None:
    below = rb.PointLight((0, 0, -5))
    assert counts(scene_with(emitter(), LAMP, LAMP, below, LAMP)) == {"eye": PIXELS, "shadow": 3 * PIXELS}


def test_secondary_hits_take_shadow_rays_too() -> None:
    scene = scene_with(rb.Material(0.5, reflect=0.5), LAMP)
    scene.add(floor(10.0), rb.Material(0.5))  # lit from below
    assert counts(scene) == {"eye": PIXELS, "reflected": PIXELS, "shadow": 2 * PIXELS}


def test_black_texels_take_no_shadow_rays() -> None:
    half = rb.Texture([[[0, 0, 0], [1, 1, 1]]], wrap="clamp")
    scene = rb.Scene()
    scene.add(rb.Disk((0, 0, 0), (0, 0, 1), radius=1.0), rb.Material(half))
    scene.add_light(LAMP)
    cam = rb.Camera((0, 0, 2), (0, 0, 0), up=(0, 1, 0), fov=5, width=8, height=1)
    dark = (rb.render(scene, cam).image[..., 0] == 0).sum()
    assert counts(scene, cam=cam)["shadow"] == 8 - dark


def test_trace_counts_no_pixels_but_frames_add_up() -> None:
    with rb.Renderer(scene_with(emitter(), LAMP), method="base") as renderer:
        renderer.render(DOWN)
        renderer.render(DOWN)
        assert renderer.stats["rays"] == {"eye": 2 * PIXELS, "shadow": 2 * PIXELS, "reflected": 0, "refracted": 0}
