"""Directions of every length: t +- t_error holds the exact t, or the ray is refused."""

import mpmath
import numpy as np
import pytest

import raybound as rb

LEAST = 2.0**-64
LARGEST = float(np.finfo(np.float32).max)
DIRECTION = np.array([0.36, -0.48, -0.8])
mpmath.mp.prec = 400


def ball_scene(center: tuple[float, float, float] = (0, 0, 0), radius: float = 1) -> rb.Scene:
    scene = rb.Scene()
    scene.add(rb.Sphere(center, radius), rb.Material())
    return scene


def exact_t(origin: np.ndarray, direction: np.ndarray, center: tuple[float, float, float], radius: float) -> mpmath.mpf:
    """The first crossing of a sphere, by Lagrange's identity in 400 bits."""
    o = [mpmath.mpf(float(a)) - mpmath.mpf(float(np.float32(c))) for a, c in zip(origin, center, strict=True)]
    d = [mpmath.mpf(float(x)) for x in direction]
    a, b = sum(x * x for x in d), sum(x * y for x, y in zip(o, d, strict=True))
    c = sum(x * x for x in o) - mpmath.mpf(float(np.float32(radius))) ** 2
    return (-b - mpmath.sqrt(b * b - a * c)) / a


def check(
    scene: rb.Scene, origins: np.ndarray, directions: np.ndarray, center: tuple[float, float, float], radius: float
) -> int:
    """How many hits with a finite bound there are; all bounds are seen to hold."""
    origins, directions = origins.astype(np.float32), directions.astype(np.float32)
    finite = 0
    for hits in (scene.intersect(origins, directions), rb.intersect(scene.objects[0].shape, origins, directions)):
        for hit, origin, direction in zip(hits, origins, directions, strict=True):
            if not hit["hit"]:
                continue
            assert np.isfinite(hit["t"])
            t, error = mpmath.mpf(float(hit["t"])), mpmath.mpf(float(hit["t_error"]))
            assert abs(t - exact_t(origin, direction, center, radius)) <= error
            finite += bool(np.isfinite(hit["t_error"]))
    return finite


@pytest.mark.parametrize("exponent", [-64, -63.5, -60, -40, 0, 40, 100, 126, 127.9])
@pytest.mark.parametrize("size", [1, 2.0**-55, 2.0**55])
def test_bounds_hold_for_directions_of_every_length(exponent: float, size: float) -> None:
    rng = np.random.default_rng(11)
    center = tuple(size * rng.normal(size=3))
    targets = np.array(center) + size * rng.uniform(-0.5, 0.5, (60, 3))
    origins = np.array(center) + size * 3 * rng.normal(size=(60, 3)) * 10 ** rng.uniform(0, 1, (60, 1)) + 5 * size
    away = (targets - origins) / np.linalg.norm(targets - origins, axis=1)[:, None]
    assert check(ball_scene(center, size), origins, away * 2.0**exponent * 1.0001, center, size) >= 100


def test_bounds_hold_at_the_limit_of_origins_and_shapes() -> None:
    """The farthest origins and shapes that fit, and the shortest directions: t is near the end of float32."""
    center, size = (-(2.0**59), 2.0**59, 0.0), 2.0**59
    origins = np.array([(2.0**60, 2.0**59, 0.0), (2.0**60, 2.0**59 * 1.2, 2.0**58)])
    directions = np.tile([-LEAST * 1.0001, 0, 0], (2, 1))
    assert check(ball_scene(center, size), origins, directions, center, size) == 4
    assert ball_scene(center, size).intersect(origins, directions)["t"].min() > 1e37


@pytest.mark.parametrize("far", [1e20, 1e30, 1e38, LARGEST])
def test_where_t_is_beyond_float32_nothing_bounds_it(far: float) -> None:
    scene = ball_scene()
    saturated = 0
    for length in (LEAST * 1.01, 1e-9, 1, 1e30, 1e38):
        hits = scene.intersect([(0, 0, far)], [(0, 0, -length)])
        assert check(scene, np.array([(0, 0, far)]), np.array([(0, 0, -length)]), (0, 0, 0), 1) >= 0
        if hits["hit"][0] and far / length > LARGEST:
            assert hits["t"][0] == np.float32(LARGEST)
            assert np.isposinf(hits["t_error"][0])
            saturated += 1
    assert saturated >= (1 if far > 1e20 else 0)


SHORT = [1e-20, 5e-20, 1e-30, 1e-37, 1e-38, 1e-40, 1.5e-45]


@pytest.mark.parametrize("length", SHORT)
def test_short_directions_are_refused_wherever_rays_enter(length: float) -> None:
    scene = ball_scene()
    directions = [(0, 0, -1), (0, 0, -length), (0, length, 0)]
    origins = [(0, 0, 5)] * 3
    expected = r"directions must have a length of at least 2\*\*-64 \(5.4e-20\), got \(0, 0, -.*\) at index 1"
    with pytest.raises(ValueError, match=r"Scene\.intersect: " + expected):
        scene.intersect(origins, directions)
    with pytest.raises(ValueError, match=r"intersect: " + expected):
        rb.intersect(rb.Sphere(), origins, directions)
    with pytest.raises(ValueError, match=r"intersect: " + expected):
        rb.intersect(rb.Sphere(), origins, directions, precision="float64")
    with rb.Renderer(scene) as renderer:
        with pytest.raises(ValueError, match=r"Renderer\.trace: " + expected):
            renderer.trace(origins, directions)
        assert len(renderer.trace(origins[:1], directions[:1]).radiance) == 1


def test_the_first_of_many_short_directions_is_named() -> None:
    directions = np.tile([0.0, 0, -1], (100_000, 1))
    directions[5_000:] = 1e-30
    for _ in range(5):
        with pytest.raises(ValueError, match=r"at index 5000$"):
            ball_scene().intersect(np.zeros((100_000, 3)), directions)


def test_the_least_length_is_that_of_the_vector() -> None:
    scene = ball_scene()
    assert scene.intersect([(0, 0, 5)], [(0, 0, -LEAST)])["t"][0] == 4 / LEAST
    below = np.nextafter(np.float32(LEAST), np.float32(0))
    with pytest.raises(ValueError, match="directions must have a length"):
        scene.intersect([(0, 0, 5)], [(0, 0, -below)])
    scene.intersect([(0, 0, 5)], [LEAST * 0.9 * DIRECTION / 0.8])  # longer than each of its components
