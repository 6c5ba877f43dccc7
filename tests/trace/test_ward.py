"""Ward's two terms against mpmath, for random configurations and grazing ones."""

import mpmath
import numpy as np
import pytest
from tests.support.support_light import f32, radiance, random_units

import raybound as rb

CONDITION = 3.0  # units of 2^-24 times the condition number; largest observed 2.3
PLAIN_LIMIT = 1e-5  # relative, where the lobe is well conditioned; largest observed 5.2e-7


def reflection(n, to_light, v, rho_d, rho_s, sigma):
    """rho_d (N.L) + rho_s/(4 sigma^2) exp((1 - 1/(N.H)^2)/sigma^2) sqrt((N.L)/(N.V)), in mpmath."""
    dot = lambda a, b: mpmath.fsum(x * y for x, y in zip(a, b))  # noqa: E731
    h = normalized([a + b for a, b in zip(to_light, v)])
    nl, nv, nh = dot(n, to_light), dot(n, v), dot(n, h)
    lobe = mpmath.exp((1 - 1 / nh**2) / sigma**2) * mpmath.sqrt(nl / nv) / (4 * sigma**2)
    size = mpmath.sqrt(mpmath.fsum((a + b) ** 2 for a, b in zip(to_light, v)))
    return rho_d * nl, rho_s * lobe, float(nh), float(size)


def normalized(v):
    v = [mpmath.mpf(float(x)) for x in v]
    size = mpmath.sqrt(mpmath.fsum(x * x for x in v))
    return [x / size for x in v]


def show(normal_shape, travel, eye, rho_d, rho_s, sigma) -> float:
    """The renderer's value at the origin of a surface there, seen from `eye`."""
    scene = rb.Scene()
    scene.add(normal_shape, rb.Material(rho_d, rho_s, roughness=sigma))
    scene.add_light(rb.DirectionalLight(travel))
    return radiance(scene, eye, -eye)[0, 0]


def allowance(nh: float, sum_of_lv: float, sigma: float) -> float:
    """The relative error that roundings of 2^-24 may cause: log(lobe) is -tan^2 / sigma^2 of the angle between N and H,
    and H turns by 2^-24 / |L + V|.
    """
    unit = CONDITION * 2.0**-24
    turn, tangent = unit / sum_of_lv, np.sqrt(max(1 / nh**2 - 1, 0))
    return 4 * unit + (2 * tangent * turn + turn**2 + 2 * unit) / (sigma**2 * nh**3)


def upper(rng: np.random.Generator, least: float) -> np.ndarray:
    """A random direction at least `least` above the plane z = 0."""
    while True:
        (v,) = random_units(rng, 1)
        if abs(v[2]) > least:
            return np.array([v[0], v[1], abs(v[2])])


def plane() -> rb.Shape:
    return rb.Box((-50, -50, -1), (50, 50, 0))


@pytest.mark.parametrize("sigma", [0.05, 0.1, 0.2, 0.5, 1.0])
def test_both_terms_for_random_configurations(sigma: float) -> None:
    rng = np.random.default_rng(10)
    sigma, seen, ratios, plain = float(f32(sigma)), 0, [], []
    for _ in range(120):
        light, eye = upper(rng, 0.05), f32(upper(rng, 0.05) * 5)
        if sigma < 0.2:  # near the mirror's angle, where the lobe shows
            eye = f32((light * [-1, -1, 1] + rng.normal(size=3) * sigma) * 5)
            if eye[2] < 0.1:
                continue
        travel = f32(-light)
        diffuse, specular, nh, size = reflection(
            [0, 0, 1], normalized(-travel), normalized(eye), f32(0.4), f32(0.3), sigma
        )
        exact = float(diffuse + specular)
        error = abs(show(plane(), travel, eye, 0.4, 0.3, sigma) - exact)
        ratios.append(error / (exact * allowance(nh, size, sigma)))
        if sigma >= 0.5 and nh > 0.7:
            plain.append(error / exact)
        seen += specular > diffuse / 10
    assert seen >= 20
    assert max(ratios) < 1
    assert max(plain, default=0) < PLAIN_LIMIT


def test_specular_term_alone_on_tilted_planes() -> None:
    rng = np.random.default_rng(11)
    worst, seen = 0.0, 0
    for _ in range(150):
        (normal,) = random_units(rng, 1)
        light, view = random_units(rng, 2)
        n = normalized(f32(normal))
        travel, eye = f32(-light), f32(view * 3)
        nl, nv = -np.dot(travel, normal), np.dot(eye, normal) / 3
        if min(nl, nv) < 0.1:
            continue
        seen += 1
        _, specular, nh, size = reflection(n, normalized(-travel), normalized(eye), 0, f32(0.7), float(f32(0.4)))
        shown = show(rb.Disk((0, 0, 0), normal, radius=1.0), travel, eye, 0.0, 0.7, 0.4)
        worst = max(worst, abs(shown - float(specular)) / float(specular) / allowance(nh, size, 0.4))
    assert seen >= 20
    assert worst < 1  # largest observed 0.43


@pytest.mark.parametrize("slope", [1e-1, 1e-2, 1e-4, 1e-6])
def test_grazing_views_and_grazing_lights(slope: float) -> None:
    """sqrt(N.L / N.V) grows without bound toward the grazing view and falls to 0 toward the grazing light."""
    rng = np.random.default_rng(12)
    for _ in range(20):
        azimuth = rng.uniform(0, 2 * np.pi, 2)
        low = f32([np.cos(azimuth[0]), np.sin(azimuth[0]), slope]) * 4
        high = f32([np.cos(azimuth[1]), np.sin(azimuth[1]), 1.0])
        for light, eye in ((low, high), (high, low), (low, f32(low * [-1, -1, 1]))):
            parts = reflection([0, 0, 1], normalized(light), normalized(eye), f32(0.4), f32(0.3), float(f32(0.5)))
            exact = float(parts[0] + parts[1])
            shown = show(plane(), -light, eye, 0.4, 0.3, 0.5)
            assert shown == pytest.approx(exact, rel=allowance(*parts[2:], sigma=0.5))


def test_peak_is_rho_s_over_four_sigma_squared() -> None:
    for sigma in (1e-4, 1e-2, 0.1, 1.0, 10.0):
        shown = show(plane(), f32([0, 0, -1]), f32([0, 0, 3]), 0.0, 0.5, sigma)
        assert shown == pytest.approx(0.5 / (4 * float(f32(sigma)) ** 2), rel=1e-6)


def test_specular_light_is_coloured_by_rho_s_and_the_light() -> None:
    scene = rb.Scene()
    scene.add(plane(), rb.Material(0.0, (0.1, 0.2, 0.4), roughness=0.5))
    scene.add_light(rb.DirectionalLight((0, 0, -1), (1, 2, 0)))
    assert radiance(scene, (0, 0, 3), (0, 0, -1))[0] == pytest.approx([0.1, 0.4, 0.0], rel=1e-6)
