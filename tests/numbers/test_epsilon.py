"""epsilon(x, scale): its guarantee over all exponents, and exactly where that fails. Judged by exact rationals."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import raybound as rb
from raybound import _core

f32 = np.float32
SETTINGS = settings(derandomize=True, deadline=None, max_examples=1000)


def every_exponent(count: int) -> np.ndarray:
    """`count` mantissas, the powers of two and their neighbours for each exponent of normal numbers, of both signs."""
    rng = np.random.default_rng(5)
    words = np.arange(1, 255, dtype=np.uint32)[:, None] << 23 | rng.integers(0, 2**23, (254, count), dtype=np.uint32)
    words[:, :3] = words[:, :3] & 0x7F800000 | np.array([0, 1, 2**23 - 1], np.uint32)
    x = words.ravel().view(f32)
    return np.concatenate([x, -x])


SCALES = [float(f32(s)) for s in (1 + 2.0**-23, 1.5, 2, 3, 10, 1e4, 2**23, 1e30)]


@pytest.mark.parametrize("scale", SCALES)
def test_x_plus_epsilon_is_more_than_x(scale: float) -> None:
    x = every_exponent(256)
    step = rb.epsilon(x, scale)
    with np.errstate(over="ignore", invalid="ignore"):
        above, below = x + step, x - step
    assert step.dtype == above.dtype == f32
    assert len(x) > 130_000
    assert (above > x).all()
    assert (below < x).all()


def test_epsilon_is_the_rounded_product() -> None:
    x = every_exponent(16)
    for scale in SCALES:
        for value, found in zip(x[::7].tolist(), rb.epsilon(x[::7], scale).tolist(), strict=True):
            exact = abs(Fraction(value)) * Fraction(scale) / 2**23
            if exact >= Fraction(2) ** 128 * (1 - Fraction(1, 2**25)):
                assert found == np.inf
                continue
            gap = Fraction(float(np.spacing(f32(found)))) if np.isfinite(found) else Fraction(2) ** 104
            assert abs(Fraction(found) - exact) <= gap / 2


def test_it_moves_by_the_scale_in_steps_of_the_floats_at_x() -> None:
    """The seed's example: by at least ten times the distance between floats, less the rounding of the sum."""
    x = every_exponent(64)
    x = x[np.abs(x) < 1e38]
    moved = (x + rb.epsilon(x, 10)).astype(np.float64) - x
    assert (moved >= 9.5 * np.spacing(np.abs(x))).all()
    far = f32(1e5)
    assert far + f32(1e-5) == far
    assert float(far + rb.epsilon(far, 10)) - 1e5 == pytest.approx(0.117, abs=0.004)


@SETTINGS
@given(st.floats(width=32, allow_nan=False, allow_infinity=False), st.floats(1, 2**40, exclude_min=True, width=32))
def test_it_fails_at_zero_and_small_subnormals_only(x: float, scale: float) -> None:
    value = f32(x)
    step = rb.epsilon(value, scale)
    with np.errstate(over="ignore"):
        grows = bool(value + step > value)
    with mpmath.workprec(200):
        assert grows == (abs(mpmath.mpf(x)) * mpmath.mpf(scale) > mpmath.mpf(2) ** -127)


def test_zero_and_subnormals() -> None:
    assert rb.epsilon(0.0, 10) == rb.epsilon(-0.0, 1e30) == 0
    words = np.concatenate([np.arange(1, 50_000), np.random.default_rng(3).integers(1, 2**23, 60_000)])
    x = words.astype(np.uint32).view(f32)
    for scale in (1.5, 10.0, 1000.0):
        grows = x + rb.epsilon(x, scale) > x
        assert np.array_equal(grows, x.astype(np.float64) * scale > 2.0**-127)
        assert grows.sum() > 1000
        assert (~grows).sum() > 1000


def test_scales_up_to_one() -> None:
    """What the seed forbids: its bound of 1 is safe, a half is where it begins to fail, a quarter where more does."""
    x = every_exponent(256)
    fails = {}
    for scale in (1.0, np.nextafter(f32(0.5), f32(1)), 0.5, 0.4, 0.25, 0.2, 0.0, -1.0):
        with np.errstate(over="ignore"):
            fails[float(scale)] = ~(x + _core.epsilon(x, float(scale)) > x)
    power = np.frexp(x)[0] == np.copysign(0.5, x)
    usual = np.abs(x) >= 2.0**-102  # whose epsilon is not rounded as a subnormal
    assert not fails[1.0].any()
    assert not fails[float(np.nextafter(f32(0.5), f32(1)))][usual].any()
    assert fails[float(np.nextafter(f32(0.5), f32(1)))].any()
    assert np.array_equal(fails[0.5][usual], (power & (x > 0))[usual])
    assert fails[0.4][usual & (x > 0)].mean() > 0.1
    assert not fails[0.4][usual & power & (x < 0)].any()
    assert fails[0.2][usual & power].all()
    assert fails[0.0].all()
    assert fails[-1.0].all()


def test_shapes_types_and_errors() -> None:
    assert isinstance(rb.epsilon(2, 10), f32)
    assert rb.epsilon(1.0, 3) == f32(3 * 2.0**-23)
    for shape in ((0,), (3,), (2, 3), (2, 0, 4)):
        found = rb.epsilon(np.ones(shape), 2)
        assert (found.shape, found.dtype) == (shape, f32)
    strided = np.arange(20.0)[::3]
    assert np.array_equal(rb.epsilon(strided, 2), f32(strided * 2**-22))
    for bad, words in ((np.nan, "x must be finite, got nan"), ([1, np.inf], "got inf at index 1"), (1e39, "fit in fl")):
        with pytest.raises(ValueError, match=f"epsilon: .*{words}"):
            rb.epsilon(bad, 2)
    for scale in (1, 1.0, 0.5, -2, 0, 1 + 1e-9):
        with pytest.raises(ValueError, match=f"epsilon: scale must be > 1, got {scale}"):
            rb.epsilon(1.0, scale)
    for scale in (np.nan, np.inf, [2, 3]):
        with pytest.raises(ValueError, match="epsilon: scale must be"):
            rb.epsilon(1.0, scale)
    for wrong in ("1", None, True, 1j):
        with pytest.raises(TypeError, match="epsilon: x must be"):
            rb.epsilon(wrong, 2)
        with pytest.raises(TypeError, match="epsilon: scale must be"):
            rb.epsilon(1.0, wrong)


def test_the_policy_moves_every_coordinate_by_all_of_it() -> None:
    """At 1e5 the scaled epsilon, times a small component of the normal, leaves a coordinate where it was."""
    sphere = rb.Sphere((1e5, 1e5, 1e5), 100)
    rng = np.random.default_rng(2)
    ways = rng.normal(size=(4000, 3))
    ways *= np.where(rng.random(4000) < 0.5, 0.02, 1)[:, None] ** np.array([1, 0, 0])
    found = {
        name: rb.intersect(sphere, f32(1e5 + 300 * ways), f32(-ways), offsets=name)
        for name in ("scaled-epsilon", "whole-epsilon")
    }
    stays = 0
    for name, hits in found.items():
        assert hits["hit"].all()
        point, moved = f32(hits["point"]), f32(hits["next_origin"])
        sign = np.sign(hits["normal"])
        if name == "whole-epsilon":
            steep = np.abs(hits["normal"]) > 1e-3  # whose sign is that of the plain normal, too
            assert np.array_equal(moved[steep], (point + f32(sign) * rb.epsilon(point, 10))[steep])
            assert ((moved - point) * sign > 0)[steep].all()
            assert (moved != point)[steep].all()
        else:
            stays = ((moved == point) & (sign != 0)).sum()
            assert (np.abs(hits["normal"])[moved == point] < 0.07).all()
    assert stays > 500
