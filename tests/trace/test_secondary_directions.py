"""Mirror and Snell angles against mpmath, total internal reflection on both sides of the critical angle, weights."""

import math

import mpmath
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
    random_units,
    single_ray_tree,
    unit,
)

import raybound as rb

LIMIT = 3e-7  # of a component of a unit direction; largest observed 1.8e-7


def scene_of(shape: rb.Shape, material: rb.Material) -> rb.Scene:
    scene = rb.Scene(ambient=EMITTER_AMBIENT, background=(0.5, 0.25, 0.125))
    scene.add(shape, material)
    return scene


def exact_normal_of_sphere(direction: np.ndarray, eye: np.ndarray, radius: float) -> list:
    """The outward normal where the ray first meets the sphere about the origin, in mpmath."""
    d = [mpmath.mpf(float(x)) for x in direction]
    o = [mpmath.mpf(float(x)) for x in eye]
    a, b = mpmath.fsum(x * x for x in d), mpmath.fsum(x * y for x, y in zip(o, d))
    c = mpmath.fsum(x * x for x in o) - mpmath.mpf(radius) ** 2
    root = mpmath.sqrt(b * b - a * c)
    t = (-b - root) / a if c > 0 else (-b + root) / a
    return [(x + t * y) / radius for x, y in zip(o, d)]


def snell(d, n, ior: float):
    """The refracted direction, or None: eta is 1/ior against the outward normal n, ior along it."""
    size = mpmath.sqrt(mpmath.fsum(mpmath.mpf(float(x)) ** 2 for x in d))
    d = [mpmath.mpf(float(x)) / size for x in d]
    cosine = mpmath.fsum(x * y for x, y in zip(d, n))
    eta = 1 / mpmath.mpf(ior) if cosine < 0 else mpmath.mpf(ior)
    side = -1 if cosine < 0 else 1
    across = [eta * (x - cosine * y) for x, y in zip(d, n)]  # the sine grows by eta, and keeps its direction
    sine2 = mpmath.fsum(x * x for x in across)
    if sine2 > 1:
        return None
    return [float(x + side * mpmath.sqrt(1 - sine2) * y) for x, y in zip(across, n)]


@pytest.mark.parametrize("inside", [False, True])
def test_mirror_angles_on_spheres(inside: bool) -> None:
    rng = np.random.default_rng(20)
    for _ in range(60):
        eye = f32(random_units(rng, 1)[0] * (0.7 if inside else 3.0))
        tree = single_ray_tree(scene_of(rb.Sphere(), mirror()), eye, f32(random_units(rng, 1)[0] * 0.5), 2)
        d = unit(tree["direction"])
        n = np.array([float(x) for x in exact_normal_of_sphere(d, eye, 1.0)])
        (child,) = tree["children"]
        assert child["kind"] == "reflected"
        # Largest observed 3.1e-7: two roundings of the normal, grown by 2 |D.N|.
        assert np.abs(child["direction"] - (d - 2 * (d @ n) * n)).max() < 5e-7


@pytest.mark.parametrize("ior", [1.33, 1.5, 2.4, 1.0, 0.7])
@pytest.mark.parametrize("inside", [False, True])
def test_snell_angles_on_spheres_in_both_directions(ior: float, inside: bool) -> None:
    rng = np.random.default_rng(21)
    refracted, worst = 0, 0.0
    for _ in range(60):
        eye = f32(random_units(rng, 1)[0] * (0.5 if inside else 3.0))
        tree = single_ray_tree(scene_of(rb.Sphere(), glass(ior)), eye, f32(random_units(rng, 1)[0] * 0.6), 2)
        n = exact_normal_of_sphere(np.array(tree["direction"]), eye, 1.0)
        exact = snell(tree["direction"], n, float(f32(ior)))
        (child,) = tree["children"]
        assert tree["total_internal_reflection"] == (exact is None)
        if exact is not None:
            refracted += 1
            assert child["kind"] == "refracted"
            error = np.abs(np.subtract(child["direction"], exact)).max()
            cosine = abs(float(mpmath.fsum(x * y for x, y in zip(exact, n))))
            worst = max(worst, error / (1 + ior**2 / cosine))  # the cosine is the root of a difference from 1
    assert refracted >= 25
    assert worst < 2e-7  # largest observed 1.5e-7


@pytest.mark.parametrize(("above", "eta"), [(True, 1 / 1.5), (False, 1.5)])
def test_eta_follows_the_outward_normal_of_a_disk(above: bool, eta: float) -> None:
    """A disk encloses nothing: its outward side is that of its normal."""
    for angle in (0.1, 0.3, 0.6):
        eye = f32([-math.tan(angle), 0, 1 if above else -1])
        tree = single_ray_tree(scene_of(rb.Disk((0, 0, 0), (0, 0, 1), radius=1.0), glass(1.5)), eye, (0, 0, 0), 2)
        (child,) = tree["children"]
        sine = abs(unit(eye)[0])
        assert child["direction"][0] == pytest.approx(sine * eta, abs=LIMIT)
        assert math.copysign(1, child["direction"][2]) == (-1 if above else 1)


@pytest.mark.parametrize("ior", [1.1, 1.33, 1.5, 2.4])
@pytest.mark.parametrize("offset", [1e-4, 1e-5])
def test_total_internal_reflection_begins_at_the_critical_angle(ior: float, offset: float) -> None:
    scene = scene_of(rb.Box((-50, -50, -50), (50, 50, 0)), glass(ior))
    critical = math.asin(1 / float(f32(ior)))
    for turn in np.linspace(0, 6, 13):
        for sign in (-1, 1):
            angle = critical + sign * offset
            eye = [math.sin(angle) * math.cos(turn), math.sin(angle) * math.sin(turn), -math.cos(angle)]
            tree = single_ray_tree(scene, eye, (0, 0, 0), 2)
            assert tree["total_internal_reflection"] == (sign > 0)
            assert [c["kind"] for c in tree["children"]] == ["reflected" if sign > 0 else "refracted"]


@pytest.mark.parametrize("offset", [1e-4, 1e-5])
def test_glass_lighter_than_air_reflects_totally_from_outside(offset: float) -> None:
    scene = scene_of(rb.Box((-50, -50, -50), (50, 50, 0)), glass(0.75))
    for sign in (-1, 1):
        angle = math.asin(0.75) + sign * offset
        tree = single_ray_tree(scene, (math.sin(angle), 0, math.cos(angle)), (0, 0, 0), 2)
        assert tree["total_internal_reflection"] == (sign > 0)


def test_weights_below_and_above_the_critical_angle() -> None:
    """reflect L(R) + transmit L(T); under total reflection (reflect + transmit) L(R)."""
    scene = rb.Scene(ambient=EMITTER_AMBIENT, background=(0.5, 0.25, 0.125))
    scene.add(rb.Box((-50, -50, -50), (50, 50, 0)), rb.Material(0.0, reflect=(0.25, 0.5, 0), transmit=(0.5, 0.125, 1)))
    scene.add(rb.Box((-40, -40, -30), (40, 40, -20)), emitter((8, 4, 2)))
    steep = radiance(scene, (0, 0, -1), (0.3, 0, 1))[0]
    flat = radiance(scene, (0, 0, -1), (1.5, 0, 1))[0]
    assert steep.tolist() == [0.25 * 8 + 0.5 * 0.5, 0.5 * 4 + 0.125 * 0.25, 0.125]
    assert flat.tolist() == [0.75 * 8, 0.625 * 4, 2]


def test_light_through_a_glass_plate_comes_out_parallel() -> None:
    scene = scene_of(rb.Box((-50, -50, -1), (50, 50, 0)), glass(1.7))
    tree = single_ray_tree(scene, (-1, 0.5, 1), (0, 0, 0), 3)
    nodes = chain_of(tree)
    assert [node["kind"] for node in nodes] == ["eye", "refracted", "refracted"]
    assert np.abs(np.subtract(nodes[2]["direction"], nodes[0]["direction"])).max() < LIMIT
    sine = math.hypot(*nodes[0]["direction"][:2]) / 1.7
    shift = np.subtract(nodes[1]["point"], nodes[0]["point"])
    assert math.hypot(shift[0], shift[1]) == pytest.approx(math.tan(math.asin(sine)), abs=1e-6)


def test_ior_one_changes_no_direction() -> None:
    tree = single_ray_tree(scene_of(rb.Sphere(), glass(1.0)), (0.3, -3, 0.4), (0.2, 0, 0.3), 3)
    for node in chain_of(tree)[1:]:
        assert np.abs(np.subtract(node["direction"], tree["direction"])).max() < LIMIT
