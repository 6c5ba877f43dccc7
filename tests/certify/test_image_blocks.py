"""What image blocks have met is kept while the camera stays: after edits only what they touch is asked again, and every
frame still has the base image's bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from tests.support.random_scenes import has_close_ones
from tests.support.support_exact import EDITS, Tally, check_scene, compare

import raybound as rb


@pytest.mark.parametrize("first", range(0, 120, 20))
def test_edits_under_a_still_camera(first: int) -> None:
    plain, close = Tally(), Tally()
    for seed in range(first, first + 20):
        check_scene(seed, close if has_close_ones(seed) else plain, cameras=7, still=True)
    assert set(plain.edits) | set(close.edits) == set(EDITS)
    assert plain.frames + close.frames == 160
    assert plain.share > 0.6
    assert close.share > 0.4  # where rays leave a solid that touches others, they search alone


@pytest.mark.soak
@pytest.mark.parametrize("first", range(0, 1000, 50))
def test_a_thousand_scenes_under_a_still_camera(first: int) -> None:
    plain, close = Tally(), Tally()
    for seed in range(first, first + 50):
        check_scene(seed, close if has_close_ones(seed) else plain, cameras=7, pixels=96, still=True)
    assert plain.frames + close.frames == 400
    assert plain.share > 0.6
    assert close.share > 0.4


def museum(width: int = 240) -> tuple[rb.Scene, rb.Camera]:
    scene = rb.scenes.museum()
    assert scene.camera is not None
    return scene, scene.camera.replace(width=width, height=width * 3 // 4)


@contextmanager
def both(scene: rb.Scene, **options: object) -> Iterator[tuple[rb.Renderer, rb.Renderer]]:
    exact, base = rb.Renderer(scene, **options), rb.Renderer(scene, method="base")  # type: ignore[arg-type]
    with exact, base:
        yield exact, base


def searches(frame: rb.Frame) -> int:
    return sum(frame.stats["rays"].values())


def named(scene: rb.Scene, name: str) -> rb.Object:
    return next(item for item in scene.objects if item.name == name)


def test_nothing_is_asked_again_where_nothing_has_changed() -> None:
    scene, camera = museum()
    with both(scene) as (exact, base):
        first = compare(exact, base, camera, Tally(), "first")
        assert searches(first) > 0
        again = compare(exact, base, camera, Tally(), "again")
        assert searches(again) == 0
        assert again.stats["cells"]["made"] == 0
        assert again == first  # paths and reasons tell how a pixel was found, whenever that was


def test_colours_and_intensities_ask_nothing() -> None:
    scene, camera = museum()
    with both(scene) as (exact, base):
        exact.render(camera)
        for item in scene.objects[::40]:
            item.material = item.material.replace(diffuse=(0.2, 0.5, 0.3))
        for lamp in scene.lights:
            if isinstance(lamp.light, rb.PointLight):
                lamp.light = lamp.light.replace(intensity=(3.0, 2.0, 1.0))
        frame = compare(exact, base, camera, Tally(), "colours")
        assert searches(frame) == 0
        assert frame.stats["cells"]["made"] == 0


def test_a_move_asks_a_small_part_again() -> None:
    scene, camera = museum()
    with both(scene) as (exact, base):
        first = exact.render(camera)
        item = named(scene, "sculpture-top")
        for _ in range(3):
            item.move(rb.Transform.translate(0, 0, 0.1))
            frame = compare(exact, base, camera, Tally(), "moved")
            assert 0 < searches(frame) < 0.4 * searches(first)


def _mirrors(scene: rb.Scene) -> None:
    scene.objects[0].material = rb.Material((0.3, 0.3, 0.3), reflect=0.6)


def _glass(scene: rb.Scene) -> None:
    scene.objects[1].material = rb.Material((0.1, 0.1, 0.1), transmit=0.7, ior=1.3)


def _denser_glass(scene: rb.Scene) -> None:
    scene.objects[1].material = rb.Material((0.1, 0.1, 0.1), transmit=0.7, ior=1.8)


def _no_mirrors(scene: rb.Scene) -> None:
    scene.objects[0].material = rb.Material((0.3, 0.3, 0.3))


def _wider_spot(scene: rb.Scene) -> None:
    scene.lights[0].light = rb.SpotLight((2, -2, 4), (-2, 2, -4), cutoff=50, intensity=(20, 20, 20))


def _spot_elsewhere(scene: rb.Scene) -> None:
    scene.lights[0].light = rb.SpotLight((-2, -2, 4), (2, 2, -4), cutoff=50, intensity=(20, 20, 20))


def _another_light(scene: rb.Scene) -> None:
    scene.lights[0].remove()
    scene.add_light(rb.DirectionalLight((1, 1, -3), radiance=(0.6, 0.6, 0.5)))


def _one_less(scene: rb.Scene) -> None:
    scene.objects[0].remove()


CHANGES = (
    _mirrors,
    _glass,
    _denser_glass,
    _no_mirrors,
    _wider_spot,
    _spot_elsewhere,
    _another_light,
    _one_less,
)


def glasshouse() -> rb.Scene:
    """Spheres, a prism and CSG in a corner: rays go on in all ways, and primitives have leaves of several numbers."""
    scene = rb.Scene(ambient=0.1, background=(0.2, 0.3, 0.4))
    scene.add(rb.Sphere((-1, 0, 0.6), 0.6), rb.Material((0.5, 0.2, 0.2), reflect=0.4))
    scene.add(rb.Sphere((0.4, -0.6, 0.5), 0.5), rb.Material((0.1, 0.1, 0.1), transmit=0.8, ior=1.5))
    scene.add(rb.Box((0.8, 0.2, 0), (1.6, 1, 0.7)) | rb.Sphere((1.2, 0.6, 0.8), 0.45), rb.Material((0.2, 0.5, 0.2)))
    scene.add(rb.Box((-4, -4, -0.1), (4, 4, 0)), rb.Material((0.6, 0.6, 0.6), reflect=0.2))
    scene.add_light(rb.SpotLight((2, -2, 4), (-2, 2, -4), cutoff=30, intensity=(20, 20, 20)))
    scene.add_light(rb.PointLight((-2, -2, 3), intensity=(4, 4, 4)))
    scene.camera = rb.Camera((0.5, -4, 2), (0, 0, 0.4), width=120, height=90)
    return scene


@pytest.mark.parametrize("options", [{}, {"threads": 2}, {"memory": 300_000}, {"editable": False}, {"max_depth": 3}])
def test_what_rays_are_sent_on_is_looked_at(options: dict[str, int]) -> None:
    scene = glasshouse()
    assert scene.camera is not None
    exact = rb.Renderer(scene, **options)  # type: ignore[arg-type]
    base = rb.Renderer(scene, method="base", max_depth=options.get("max_depth", 5))
    with exact, base:
        compare(exact, base, scene.camera, Tally(), "first")
        change: Callable[[rb.Scene], None]
        for change in CHANGES:
            before = exact.render(scene.camera).image.copy()
            change(scene)
            after = compare(exact, base, scene.camera, Tally(), change.__name__)
            assert not np.array_equal(before, after.image), change.__name__  # it was worth asking


def test_without_blocks_everything_is_asked_again() -> None:
    scene, camera = museum()
    with both(scene, editable=False) as (exact, base):
        first = compare(exact, base, camera, Tally(), "first")
        again = compare(exact, base, camera, Tally(), "again")
        assert searches(again) == searches(first)
        kept = exact.memory_used
    with both(scene) as (exact, _):
        exact.render(camera)
        assert exact.memory_used > kept


def test_paths_after_edits_do_not_depend_on_threads() -> None:
    frames = []
    for threads in (1, 2, 3):
        scene, camera = museum(160)
        with rb.Renderer(scene, threads=threads) as renderer:
            renderer.render(camera)
            named(scene, "sculpture-top").move(rb.Transform.translate(0, 0, 0.3))
            frames.append(renderer.render(camera))
    assert all(frame == frames[0] for frame in frames[1:])


def test_trees_too_large_for_a_record_are_asked_again() -> None:
    scene = rb.Scene(ambient=0.1, background=(0.2, 0.3, 0.4))
    for z in np.arange(16) * 0.3:  # each ray becomes two
        corners = [(-50, -50, z), (50, -50, z), (50, 50, z), (-50, 50, z)]
        scene.add(rb.Polygon(corners), rb.Material((0.1, 0.1, 0.1), reflect=0.4, transmit=0.5, ior=1.0))
    camera = rb.Camera((0.3, 0.4, -5), (0, 0, 0), up=(0, 1, 0), fov=12, width=8, height=8)
    for depth, kept in ((6, True), (14, False)):
        with rb.Renderer(scene, max_depth=depth) as exact, rb.Renderer(scene, method="base", max_depth=depth) as base:
            first = compare(exact, base, camera, Tally(), "first")
            again = compare(exact, base, camera, Tally(), "again")
            assert searches(again) == (0 if kept else searches(first))


@pytest.mark.parametrize("memory", [800_000, 1_000_000, 2_000_000, 8_000_000])
def test_what_has_changed_counts_as_memory(memory: int) -> None:
    scene = rb.Scene(ambient=0.1)
    rng = np.random.default_rng(1)
    with scene.edit():
        for position in rng.uniform(-20, 20, (20_000, 3)).tolist():
            scene.add(rb.Sphere(position, 0.2), rb.Material((0.5, 0.5, 0.5)))
    scene.add_light(rb.PointLight((0, 0, 40), intensity=(4, 4, 4)))
    camera = rb.Camera((0, -60, 0), (0, 0, 0), width=40, height=30)
    moved = scene.objects[0]
    with both(scene, memory=memory) as (exact, base):
        compare(exact, base, camera, Tally(), "first")
        before = exact.memory_used
        for step in range(10):
            moved.move(rb.Transform.translate(0, 0, 0.01))
            compare(exact, base, camera.orbit(step, 0), Tally(), "moved")
            assert exact.memory_used <= memory
        if memory == 8_000_000:
            assert exact.memory_used - before >= 8 * 20_000 * 4  # a number of each primitive, eight times
