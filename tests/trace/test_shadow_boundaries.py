"""Where shadows and cones end, against exact predicates in float64."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from tests.support.support_light import f32, floor, radiance, unit

import raybound as rb

LIMIT = 1e-5  # times the size of the scene; largest observed 2.3e-7 (spheres, boxes), 1.1e-6 (cones)
SIZE = 10.0

Inside = Callable[[np.ndarray], np.ndarray]
Predicate = Callable[[np.ndarray, np.ndarray], np.ndarray]  # (points on the floor, vectors to the light) -> blocked


def blocked_by_sphere(centre: np.ndarray, radius: float, endless: bool) -> Predicate:
    def predicate(points: np.ndarray, reach: np.ndarray) -> np.ndarray:
        f = points - centre
        a, b, c = (reach**2).sum(-1), (f * reach).sum(-1), (f**2).sum(-1) - radius**2
        root = np.sqrt(np.maximum(b * b - a * c, 0))
        first = (-b - root) / a
        return (b * b >= a * c) & (first > 0) & ((first < 1) | endless)

    return predicate


def blocked_by_box(lower: np.ndarray, upper: np.ndarray, endless: bool) -> Predicate:
    def predicate(points: np.ndarray, reach: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore"):
            t = (np.stack([lower, upper])[:, None] - points) / reach
        enter, leave = t.min(axis=0).max(axis=-1), t.max(axis=0).min(axis=-1)
        return (enter <= leave) & (leave > 0) & ((enter < 1) | endless)

    return predicate


def points_on_floor(rng: np.random.Generator, n: int) -> np.ndarray:
    return np.column_stack([rng.uniform(-SIZE / 2, SIZE / 2, (n, 2)), np.zeros(n)])


def shown_dark(scene: rb.Scene, points: np.ndarray) -> np.ndarray:
    """Seen by rays that start close above the floor, below everything else."""
    return radiance(scene, np.add(points, [0, 0, 2.0**-12]), (0, 0, -1))[:, 0] == 0


def worst_boundary(inside: Inside, shown: Inside, seed: int) -> tuple[float, int]:
    """Bisects between points inside and outside of a convex region, by the exact predicate and by the picture.

    Returns the largest distance of the two ends found on a segment, and how many segments there were.
    """
    points = points_on_floor(np.random.default_rng(seed), 20_000)
    is_inside = inside(points)
    inner, outer = points[is_inside], points[~is_inside]
    n = min(len(inner), len(outer), 400)
    inner, across = inner[:n], outer[:n] - inner[:n]
    ends = []
    for test in (inside, shown):
        low, high = np.zeros(n), np.ones(n)
        for _ in range(26):
            middle = (low + high) / 2
            within = test(inner + across * middle[:, None])
            low, high = np.where(within, middle, low), np.where(within, high, middle)
        ends.append(low)
    return float((np.abs(ends[0] - ends[1]) * np.linalg.norm(across, axis=1)).max()), n


def check_shadow(shape: rb.Shape, light: object, exact: Inside, least: int) -> None:
    scene = rb.Scene()
    scene.add(floor(), rb.Material(1.0))
    scene.add(shape, rb.Material(1.0))
    scene.add_light(light)
    error, n = worst_boundary(exact, lambda p: shown_dark(scene, p), 40)
    assert n >= least
    assert error < LIMIT * SIZE


POINT_LIGHTS = [(0.3, 0.2, 6.0), (3.0, -2.0, 5.0), (-2.0, 1.0, 5.5)]
DIRECTIONS = [(0, 0, -1), (0.5, 0.2, -1), (-1.5, 1.0, -1.0)]
SPHERES = [((0.2, -0.3, 1.5), 1.0), ((0.5, 0.4, 0.7), 0.5), ((-0.2, 0.1, 2.0), 0.25)]
BOXES = [((-0.5, -0.7, 0.5), (0.6, 0.8, 1.5)), ((0.1, 0.1, 0.25), (0.2, 1.5, 1.0))]


@pytest.mark.parametrize("light", POINT_LIGHTS)
@pytest.mark.parametrize(("centre", "radius"), SPHERES)
def test_sphere_and_point_light(centre: tuple, radius: float, light: tuple) -> None:
    blocked = blocked_by_sphere(f32(centre), float(f32(radius)), endless=False)
    check_shadow(rb.Sphere(centre, radius), rb.PointLight(light), lambda p: blocked(p, f32(light) - p), 10)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(("centre", "radius"), SPHERES)
def test_sphere_and_directional_light(centre: tuple, radius: float, direction: tuple) -> None:
    blocked = blocked_by_sphere(f32(centre), float(f32(radius)), endless=True)
    to_light = -unit(f32(direction))
    check_shadow(rb.Sphere(centre, radius), rb.DirectionalLight(direction), lambda p: blocked(p, to_light + 0 * p), 6)


@pytest.mark.parametrize("light", POINT_LIGHTS)
@pytest.mark.parametrize(("lower", "upper"), BOXES)
def test_box_and_point_light(lower: tuple, upper: tuple, light: tuple) -> None:
    blocked = blocked_by_box(f32(lower), f32(upper), endless=False)
    check_shadow(rb.Box(lower, upper), rb.PointLight(light), lambda p: blocked(p, f32(light) - p), 6)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(("lower", "upper"), BOXES)
def test_box_and_directional_light(lower: tuple, upper: tuple, direction: tuple) -> None:
    blocked = blocked_by_box(f32(lower), f32(upper), endless=True)
    to_light = -unit(f32(direction))
    check_shadow(rb.Box(lower, upper), rb.DirectionalLight(direction), lambda p: blocked(p, to_light + 0 * p), 4)


@pytest.mark.parametrize("cutoff", [5.0, 20.0, 45.0, 70.0])
@pytest.mark.parametrize("axis", [(0, 0, -1), (0.4, -0.2, -1)])
def test_rim_of_a_spot_light(cutoff: float, axis: tuple) -> None:
    position = f32([0.25, -0.5, 1.0 if cutoff > 50 else 4.0])
    scene = rb.Scene()
    scene.add(floor(), rb.Material(1.0))
    scene.add_light(rb.SpotLight(position, axis, cutoff=cutoff))
    least = math.cos(math.radians(float(f32(cutoff))))

    def lit(points: np.ndarray) -> np.ndarray:
        to_point = points - position
        return (to_point @ unit(f32(axis))) / np.linalg.norm(to_point, axis=1) >= least

    error, n = worst_boundary(lit, lambda p: ~shown_dark(scene, p), 44)
    assert n >= 10
    assert error < LIMIT * SIZE


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_shadows_scale_with_the_scene(scale: float) -> None:
    """No length is built in: the shadow of a scaled scene, pixel by pixel, up to the rim."""
    pictures = []
    for s in (1.0, scale):
        scene = rb.Scene()
        scene.add(floor(half=50 * s), rb.Material(1.0))
        scene.add(rb.Sphere((0, 0, 1.25 * s), 1.0 * s), rb.Material(0.5))
        scene.add_light(rb.PointLight((2 * s, 1 * s, 6 * s)))
        cam = rb.Camera((0, -7 * s, 4 * s), (0, 0, 0.5 * s), fov=45, width=160, height=120)
        pictures.append(rb.render(scene, cam).image[..., 0])
    dark = [picture == 0 for picture in pictures]
    assert dark[0].sum() > 1000
    assert (dark[0] != dark[1]).sum() <= 4  # largest observed 0
    assert np.abs(pictures[0] - pictures[1]).max(where=dark[0] == dark[1], initial=0) < 1e-5
