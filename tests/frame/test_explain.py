"""frame.explain: its ray tree is what the pixel shows."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from tests.support.random_scenes import random_scene
from tests.support.support_light import EMITTER_AMBIENT, emitter, floor, mirror

import raybound as rb


def nodes(tree: dict[str, Any]) -> Iterator[dict[str, Any]]:
    yield tree
    for child in tree["children"]:
        yield from nodes(child)


@pytest.mark.parametrize("seed", range(6))
def test_the_radiance_of_the_tree_is_the_pixel(seed: int) -> None:
    scene = random_scene(seed)
    frame = rb.render(scene, max_depth=6)
    rng = np.random.default_rng([160, seed])
    origins, directions = scene.camera.rays()
    height, width = frame.path.shape
    branches = 0
    for _ in range(60):
        x, y = int(rng.integers(width)), int(rng.integers(height))
        explained = frame.explain(x, y)
        tree = explained.tree
        assert (np.float32(tree["radiance"]) == frame.image[y, x]).all()
        assert explained.object_id == tree["object_id"] == frame.object_id[y, x]
        assert (explained.x, explained.y, explained.path) == (x, y, frame.path[y, x])
        assert (np.float32(tree["direction"]) == directions[y, x]).all()
        assert (np.float32(tree["origin"]) == origins[y, x]).all()
        if tree["hit"]:
            assert np.float32(tree["t"]) == frame.depth[y, x]
        branches += len(tree["children"])
    assert branches >= 5


def test_the_tree_counts_the_rays_of_the_frame() -> None:
    """Kinds over all pixels are the frame's counts; shadow rays of weight zero apart, since no material is black."""
    scene = random_scene(3, pixels=24)
    frame = rb.render(scene, max_depth=5, method="base")
    height, width = frame.path.shape
    count = dict.fromkeys(("eye", "reflected", "refracted", "shadow"), 0)
    for y in range(height):
        for x in range(width):
            for node in nodes(frame.explain(x, y).tree):
                count[node["kind"]] += 1
                count["shadow"] += sum(lamp["verdict"] in ("lit", "blocked") for lamp in node["lights"])
    assert count == frame.stats["rays"]
    assert min(count.values()) > 0


def test_verdicts_name_lights_and_blockers() -> None:
    scene = rb.Scene()
    ground = scene.add(floor(), emitter(), name="ground")
    ball = scene.add(rb.Sphere((0, 0, 3), 0.5), emitter(), name="ball")
    lamps = [
        rb.PointLight((0, 0, 9)),  # blocked by the ball
        rb.PointLight((5, 0, 5)),  # lit
        rb.PointLight((0, 0, -5)),  # behind
        rb.SpotLight((5, 5, 5), (1, 0, 0)),  # outside its cone
    ]
    handles = [scene.add_light(lamp, name=f"lamp {k}") for k, lamp in enumerate(lamps)]
    cam = rb.Camera((0, -2, 2), (0, 0, 0), fov=1, width=1, height=1)
    explained = rb.render(scene, cam).explain(0, 0)
    verdicts = {lamp["id"]: (lamp["verdict"], lamp["blocker"]) for lamp in explained.tree["lights"]}
    expected = [("blocked", ball.id), ("lit", -1), ("behind", -1), ("outside cone", -1)]
    assert verdicts == dict(zip([handle.id for handle in handles], expected, strict=True))
    assert explained.object_id == ground.id
    text = str(explained)
    for word in ("ground", "ball", "lamp 0", "blocked", "outside cone", "TRACED"):
        assert word in text


def test_trees_are_those_of_the_frames_revision() -> None:
    scene = rb.Scene(ambient=EMITTER_AMBIENT, background=0.5)
    ball = scene.add(rb.Sphere(), emitter((3, 2, 1)), name="ball")
    cam = rb.Camera((0, -5, 0), (0, 0, 0), width=3, height=3)
    frame = rb.render(scene, cam)
    ball.remove()
    assert frame.explain(1, 1).tree["radiance"] == (3, 2, 1)
    assert "ball" in str(frame.explain(1, 1))


def test_background_and_depth_limit() -> None:
    scene = rb.Scene(background=(0.5, 0.25, 0.125))
    scene.add(floor(), mirror())
    cam = rb.Camera((0, 0, 2), (0, 0, 0), up=(0, 1, 0), width=1, height=1)
    tree = rb.render(scene, cam, max_depth=2).explain(0, 0).tree
    (sky,) = tree["children"]
    assert (sky["hit"], sky["object_id"], sky["radiance"]) == (False, -1, (0.5, 0.25, 0.125))
    assert tree["radiance"] == sky["radiance"]
    assert not rb.render(scene, cam, max_depth=1).explain(0, 0).tree["children"]


def test_parents_are_the_sums_of_what_they_spawn() -> None:
    """Without lights: ambient rho + reflect L(R) + transmit L(T), node by node."""
    scene = rb.Scene(ambient=0.5, background=(0.5, 0.25, 0.125))
    weights = {}
    for k in range(12):
        reflect, transmit = ((0.5, 0.0), (0.25, 0.5), (0.0, 0.75))[k % 3]
        weights[
            scene.add(
                rb.Sphere((k % 4 - 1.5, k // 4 - 1, 0), 0.6), rb.Material(0.2, reflect=reflect, transmit=transmit)
            ).id
        ] = reflect, transmit
    cam = rb.Camera((0.3, -1, 6), (0, 0, 0), fov=40, width=24, height=24)
    frame = rb.render(scene, cam, max_depth=5)
    checked = 0
    for x in range(24):
        for node in nodes(frame.explain(x, 11).tree):
            if not node["children"]:
                continue
            reflect, transmit = weights[node["object_id"]]
            if node["total_internal_reflection"]:
                reflect, transmit = reflect + transmit, 0.0
            parts = {child["kind"]: np.array(child["radiance"]) for child in node["children"]}
            exact = 0.1 + reflect * parts.get("reflected", 0) + transmit * parts.get("refracted", 0)
            assert node["radiance"] == pytest.approx(exact, rel=1e-6)
            checked += 1
    assert checked >= 60


@pytest.mark.parametrize(("x", "y"), [(-1, 0), (0, -1), (5, 0), (0, 4), (1.5, 0)])
def test_pixels_outside_are_refused(x: float, y: float) -> None:
    frame = rb.render(rb.Scene(), rb.Camera((0, 0, 0), (1, 0, 0), width=5, height=4))
    with pytest.raises((ValueError, TypeError), match="explain"):
        frame.explain(x, y)
