"""Long paths of rays against mpmath: parallel mirrors, the inside of a mirrored sphere, light caught in glass."""

import numpy as np
import pytest
from tests.support.support_light import (
    EMITTER_AMBIENT,
    chain_of,
    emitter,
    f32,
    glass,
    mirror,
    radiance,
    single_ray_tree,
)
from tests.support.support_paths import folded, path_in_sphere

import raybound as rb

BOUNCES = 50


def test_fifty_bounces_between_parallel_mirrors_keep_their_way() -> None:
    scene = rb.Scene(background=(0.75, 0.5, 0.25))
    for x in (0.0, 1.0):
        scene.add(rb.Polygon([(x, -99, -99), (x, 99, -99), (x, 99, 99), (x, -99, 99)]), mirror())
    tree = single_ray_tree(scene, (0.4, 0.1, -0.2), (1.0, 0.83, 0.31), BOUNCES)
    nodes = chain_of(tree)
    assert len(nodes) == BOUNCES
    points = np.array([node["point"] for node in nodes])
    d = np.array(tree["direction"], float)
    # The unfolded way is straight.
    straight = f32([0.4, 0.1, -0.2]) + d * ((1 + np.arange(BOUNCES) - float(f32(0.4))) / d[0])[:, None]
    assert (points[:, 0] == np.arange(1, BOUNCES + 1) % 2).all()
    assert np.abs(points[:, 1:] - straight[:, 1:]).max() < 1e-4  # at 60 units; largest observed 1.4e-5
    assert np.abs(folded(straight[:, 0], 0, 1) - points[:, 0]).max() < 1e-6


@pytest.mark.parametrize("height", [3.0, 20.0, 45.0])
def test_the_end_of_a_corridor_shows_through_perfect_mirrors(height: float) -> None:
    """reflect = 1: the colour at the end arrives bit for bit, whatever the number of bounces."""
    scene = rb.Scene(background=(0.7, 0.1, 0.3))
    for x in (0.0, 1.0):
        scene.add(rb.Polygon([(x, -9, 0), (x, 9, 0), (x, 9, height), (x, -9, height)]), mirror())
    end = radiance(scene, [(0.5, 0, 0.25)] * 2, [(1, 0, 1), (1, 0.1, 0.95)], max_depth=60)
    assert (end == f32([0.7, 0.1, 0.3])).all()
    inside = radiance(scene, (0.5, 0, 0.25), (1, 0, 1), max_depth=int(height) - 1)
    assert (inside == 0).all()


def test_fifty_bounces_lose_light_geometrically() -> None:
    """local + reflect (local + reflect (...)): a geometric sum of 50 terms."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    for x in (0.0, 1.0):
        scene.add(
            rb.Polygon([(x, -99, -99), (x, 99, -99), (x, 99, 99), (x, -99, 99)]),
            rb.Material(0.125, reflect=(0.9, 0.5, 1.0)),
        )
    shown = radiance(scene, (0.5, 0, 0), (1, 0.3, 0.2), max_depth=BOUNCES)[0]
    weight = f32([0.9, 0.5])
    assert shown[:2] == pytest.approx(0.125 * (1 - weight**BOUNCES) / (1 - weight), rel=1e-6)
    assert shown[2] == 0.125 * BOUNCES


@pytest.mark.parametrize("radius", [1.0, 1e-3, 1e4])
def test_inside_a_mirrored_sphere(radius: float) -> None:
    scene = rb.Scene()
    scene.add(rb.Sphere((0, 0, 0), radius), mirror())
    rng = np.random.default_rng(100)
    worst = 0.0
    for _ in range(10):
        eye, target = f32(rng.normal(size=(2, 3)) * 0.3 * radius)
        nodes = chain_of(single_ray_tree(scene, eye, target, BOUNCES))
        assert len(nodes) == BOUNCES
        way = path_in_sphere(eye, nodes[0]["direction"], float(f32(radius)), BOUNCES)
        errors = [np.linalg.norm(np.subtract(node["point"], p)) / radius for node, p in zip(nodes, way, strict=True)]
        assert errors[0] < 2e-7
        worst = max(worst, *errors)
    # The n-th bounce is turned by n times twice the angle of incidence: errors grow with n^2 at most.
    assert worst < 5e-4  # largest observed 1.4e-4


def test_an_emitter_seen_after_many_bounces_in_a_mirrored_sphere() -> None:
    """Rays through the centre come back: the ball in the middle is seen from everywhere."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    scene.add(rb.Sphere((0, 0, 0), 1.0), mirror())
    scene.add(rb.Sphere((0, 0, 0), 0.25), emitter((3, 2, 1)))
    directions = np.random.default_rng(101).normal(size=(200, 3))
    eyes = f32(directions / np.linalg.norm(directions, axis=1)[:, None] * 0.5)
    shown = radiance(scene, eyes, eyes, max_depth=2)
    assert (shown == [3, 2, 1]).all()


def test_light_caught_in_a_glass_cube() -> None:
    """A ray that meets all faces beyond the critical angle stays for good: 50 total reflections, unfolded."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT)
    scene.add(rb.Box((-1, -1, -1), (1, 1, 1)), rb.Material(0.01, transmit=1.0, ior=1.6))
    tree = single_ray_tree(scene, (0.1, -0.2, 0.3), (1.1, 0.73, 1.21), BOUNCES)
    nodes = chain_of(tree)
    assert [node["kind"] for node in nodes[1:]] == ["reflected"] * (BOUNCES - 1)
    assert all(node["total_internal_reflection"] for node in nodes[:-1])
    way = np.cumsum([node["t"] for node in nodes])
    straight = f32([0.1, -0.2, 0.3]) + np.array(tree["direction"]) * way[:, None]
    points = np.array([node["point"] for node in nodes])
    assert np.abs(folded(straight, -1, 1) - points).max() < 2e-4  # at 60 units; largest observed 1.9e-5
    assert tree["radiance"][0] == pytest.approx(0.01 * BOUNCES, rel=1e-5)


def test_a_stack_of_glass_plates_passes_fifty_faces() -> None:
    scene = rb.Scene(background=(0.7, 0.1, 0.3))
    for k in range(25):
        scene.add(rb.Box((-50, -50, -2 * k - 1), (50, 50, -2 * k)), glass(1.5))
    nodes = chain_of(single_ray_tree(scene, (0, 0, 1), (0.5, 0.2, 0), 60))
    assert len(nodes) == 51
    assert nodes[0]["radiance"] == pytest.approx(f32([0.7, 0.1, 0.3]), rel=0)
    sine = np.hypot(*nodes[0]["direction"][:2])
    inside = sine / 1.5 / np.sqrt(1 - (sine / 1.5) ** 2)
    outside = sine / np.sqrt(1 - sine**2)
    across = np.linalg.norm(np.subtract(nodes[49]["point"], nodes[0]["point"])[:2])
    assert across == pytest.approx(25 * inside + 24 * outside, abs=1e-4)  # largest observed 1.4e-5


def test_touching_glass_plates_are_seen_in_order() -> None:
    """Coincident faces of plates without a gap: each face of each plate refracts once."""
    scene = rb.Scene(background=(0.5, 0.5, 0.5))
    for k in range(6):
        scene.add(rb.Box((-50, -50, -k - 1), (50, 50, -k)), glass(1.0))
    shown = radiance(
        scene, np.column_stack([np.linspace(-1, 1, 50), np.zeros(50), np.ones(50)]), (0.1, 0.2, -1), max_depth=20
    )
    assert (shown == 0.5).all()


@pytest.mark.parametrize("depth", [50, 1000])
def test_great_depths_do_not_overflow_the_stack(depth: int) -> None:
    scene = rb.Scene(ambient=EMITTER_AMBIENT, background=0.5)
    scene.add(rb.Sphere((0, 0, 0), 1.0), rb.Material(2.0**-10, reflect=1.0))
    cam = rb.Camera((0, 0, 0.2), (1, 0.3, 0), width=8, height=8)
    frame = rb.render(scene, cam, max_depth=depth, method="base")
    assert frame.stats["rays"]["reflected"] == 64 * (depth - 1)
    assert (frame.image == depth * 2.0**-10).all()
    assert (rb.render(scene, cam, max_depth=depth, method="exact").image == frame.image).all()
    assert len(chain_of(frame.explain(3, 3).tree)) == depth
