"""N.L, falloff, cones, ambient light, two-sided shading, the background: against closed forms in float64."""

import numpy as np
import pytest
from tests.support.support_light import f32, floor, radiance, random_units, unit

import raybound as rb

LIMIT = 1e-5  # relative; largest observed 9.1e-7 (point lights with falloff)
N = 400


def look_down(rng: np.random.Generator, n: int = N) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rays that meet the floor z = 0 at the points returned, float32 throughout."""
    points = f32(rng.uniform(-3, 3, (n, 3)))
    points[:, 2] = 0
    return np.add(points, [0, 0, 2]), np.broadcast_to([0.0, 0, -1], points.shape), points


def lit_floor(light: object, diffuse: object = (0.25, 0.5, 0.75)) -> rb.Scene:
    scene = rb.Scene()
    scene.add(floor(), rb.Material(diffuse))
    scene.add_light(light)
    return scene


def relative_error(shown: np.ndarray, exact: np.ndarray) -> float:
    return float(np.max(np.abs(shown - exact) / np.abs(exact)))


@pytest.mark.parametrize("falloff", [False, True])
@pytest.mark.parametrize("height", [5.0, 0.5, 1e-3, 1e-6])
def test_point_light_over_a_plane(falloff: bool, height: float) -> None:
    position, intensity, rho = f32([0.3, -0.2, height]), f32([2, 3, 4]), f32([0.25, 0.5, 0.75])
    origins, directions, points = look_down(np.random.default_rng(1))
    shown = radiance(lit_floor(rb.PointLight(position, intensity, falloff=falloff)), origins, directions)
    to_light = position - points
    squared = (to_light**2).sum(-1)
    exact = (to_light[:, 2] / np.sqrt(squared) / (squared if falloff else 1))[:, None] * intensity * rho
    assert exact.min() > 0
    assert relative_error(shown, exact) < LIMIT


@pytest.mark.parametrize("slope", [1.0, 1e-2, 1e-5, 1e-7])
def test_directional_light_down_to_grazing(slope: float) -> None:
    travel = f32([1.0, 0.4, -slope])
    origins, directions, _ = look_down(np.random.default_rng(2))
    shown = radiance(lit_floor(rb.DirectionalLight(travel, (1, 2, 3))), origins, directions)
    exact = np.broadcast_to(-unit(travel)[2] * f32([0.25, 1.0, 2.25]), shown.shape)
    assert relative_error(shown, exact) < LIMIT


@pytest.mark.parametrize("falloff", [False, True])
@pytest.mark.parametrize("cutoff", [8.0, 40.0, 89.0, 130.0, 180.0])
def test_spot_light_inside_and_outside_its_cone(falloff: bool, cutoff: float) -> None:
    position, axis = f32([0.5, 0.1, 1.5]), f32([0.5, 0.2, -1.0])
    light = rb.SpotLight(position, axis, cutoff=cutoff, intensity=(2, 2, 2), falloff=falloff)
    origins, directions, points = look_down(np.random.default_rng(3), 6000)
    shown = radiance(lit_floor(light, 0.5), origins, directions)[:, 0]
    to_light = position - points
    distance = np.linalg.norm(to_light, axis=1)
    angle = np.degrees(np.arccos(np.clip(-(to_light @ unit(axis)) / distance, -1, 1)))
    inside, outside = angle < cutoff - 1e-2, angle > cutoff + 1e-2
    exact = to_light[:, 2] / distance / (distance**2 if falloff else 1)
    assert inside.sum() >= 30
    assert outside.sum() >= 40 or cutoff > 80
    assert not shown[outside].any()
    assert relative_error(shown[inside], exact[inside]) < LIMIT


def test_spot_light_that_points_away_from_the_cone_over_90_degrees() -> None:
    light = rb.SpotLight((0, 0, 1), (0, 0, 1), cutoff=135, intensity=(1, 1, 1))
    shown = radiance(lit_floor(light, 1.0), [(0.5, 0, 3), (2.0, 0, 3)], [(0, 0, -1), (0, 0, -1)])[:, 0]
    assert shown[0] == 0
    assert shown[1] == pytest.approx(1 / 5**0.5, rel=LIMIT)


def test_tilted_planes_seen_from_both_sides() -> None:
    """Two-sided: N turns to the viewer, so a light counts where viewer and light are on the same side."""
    rng = np.random.default_rng(4)
    same = 0
    for normal, travel, side in zip(random_units(rng, 150), random_units(rng, 150), rng.choice([-1, 1], 150)):
        n, travel = unit(f32(normal)), f32(travel)
        scene = rb.Scene()
        scene.add(rb.Disk((0, 0, 0), normal, radius=2.0), rb.Material(0.8))
        scene.add_light(rb.DirectionalLight(travel))
        eye = f32(n * side * 3 + np.cross(n, travel))
        shown = radiance(scene, eye, -eye)[0, 0]
        cosine = -(n * side) @ unit(travel)
        same += cosine > 0
        assert shown == pytest.approx(max(cosine, 0) * 0.8, abs=2e-7)  # largest observed 6.4e-8
    assert 50 <= same <= 100


def test_light_sums_over_lights_with_ambient_light() -> None:
    scene = rb.Scene(ambient=(0.1, 0.2, 0.3))
    scene.add(floor(), rb.Material((0.5, 0.25, 1.0)))
    scene.add_light(rb.DirectionalLight((0, 0, -1), (1, 2, 3)))
    scene.add_light(rb.PointLight((0, 0, 4), (8, 8, 8), falloff=True))
    scene.add_light(rb.DirectionalLight((0, 0, 1), (100, 100, 100)))  # from below
    shown = radiance(scene, (0, 0, 1), (0, 0, -1))[0]
    assert shown == pytest.approx(np.array([0.5, 0.25, 1.0]) * ([1.6, 2.7, 3.8]), rel=LIMIT)


def test_ambient_light_alone_is_exact_in_float32() -> None:
    scene = rb.Scene(ambient=(0.1, 0.2, 0.3))
    scene.add(rb.Sphere(), rb.Material((0.7, 0.6, 0.5)))
    shown = radiance(scene, (0, 0, 3), (0, 0.1, -1))[0]
    product = np.float32([0.1, 0.2, 0.3]) * np.float32([0.7, 0.6, 0.5])
    assert (shown == product).all()


def test_background_is_what_rays_that_meet_nothing_show() -> None:
    scene = rb.Scene(ambient=1.0, background=(0.25, 12.5, 0.0))
    scene.add(rb.Sphere((0, 0, -10), 1.0), rb.Material(1.0))
    found = rb.Renderer(scene).trace([(0, 0, 0)] * 3, [(0, 0, 1), (1, 0, 0), (0, 0, -1)])
    assert (found.radiance == np.float32([[0.25, 12.5, 0], [0.25, 12.5, 0], [1, 1, 1]])).all()
    assert found.object_id.tolist() == [-1, -1, 0]
    assert found.path.tolist() == [rb.Path.BACKGROUND, rb.Path.BACKGROUND, rb.Path.TRACED]


def test_sphere_from_inside_is_lit_by_a_light_inside() -> None:
    scene = rb.Scene()
    scene.add(rb.Sphere((0, 0, 0), 2.0), rb.Material(1.0))
    scene.add_light(rb.PointLight((0, 0, 1)))
    directions = random_units(np.random.default_rng(5), N)
    shown = radiance(scene, (0, 0, 0), directions)[:, 0]
    points = 2 * unit(f32(directions))
    exact = -(unit([0, 0, 1] - points) * points / 2).sum(-1)  # N turns inward, to the viewer
    assert exact.min() > 0.5
    assert np.abs(shown - exact).max() < 1e-6  # largest observed 2.1e-7
