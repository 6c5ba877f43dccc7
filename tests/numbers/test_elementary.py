"""exp and acos over all floats, atan2 in arbitrary precision: at most 1 ulp."""

from concurrent.futures import ThreadPoolExecutor

import mpmath
import numpy as np
import pytest

from raybound import _core

CHUNKS = 256


def sweep(name: str, stride: int) -> tuple[float, int, int]:
    """The worst error in ulp, where, and how many were tested: all bit patterns that are multiples of the stride."""
    count = -(-(2**32) // stride)
    chunk = -(-count // CHUNKS)
    starts = range(0, count, chunk)

    def part(start: int) -> tuple[float, int, int]:
        return _core.check_elementary(name, start * stride, min(chunk, count - start), stride)

    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(part, starts))
    worst = max(results)
    return worst[0], worst[1], sum(tested for _, _, tested in results)


# 61 is prime: every exponent and both signs get their share.
@pytest.mark.parametrize("stride", [61, pytest.param(1, marks=pytest.mark.soak)])
@pytest.mark.parametrize(
    ("name", "limit"),
    [
        ("exp", 0.51),  # seen over all floats: 0.500000 (see soak)
        ("acos", 0.51),  # seen over all floats: 0.500010
        ("sqrt", 0.5),  # correctly rounded: seen 0.5
    ],
)
def test_all_floats(name: str, limit: float, stride: int) -> None:
    worst, bits, tested = sweep(name, stride)
    assert worst <= limit, f"{name} at {np.uint32(bits).view(np.float32)}: {worst} ulp"
    assert worst > 0.25  # the check does measure
    assert tested >= (2**32 - 2**25) // stride  # all but the NaNs


def test_the_check_sees_what_it_should() -> None:
    """A known argument, against mpmath: e is between the floats that are next to it."""
    assert _core.check_elementary("exp", 0x3F800000, 1, 1)[2] == 1
    assert _core.check_elementary("exp", 0x7FC00000, 1, 1)[2] == 0  # NaN
    with pytest.raises(ValueError, match="name must be"):
        _core.check_elementary("tan", 0, 1, 1)


def ulp_of(exact: mpmath.mpf) -> mpmath.mpf:
    exponent = mpmath.frexp(exact)[1] if exact else -1000
    return mpmath.ldexp(1, max(exponent - 24, -149))


def worst_atan2(y: np.ndarray, x: np.ndarray) -> float:
    found = _core.elementary("atan2", y, x)
    worst = 0.0
    with mpmath.workprec(120):
        for a, b, f in zip(y.tolist(), x.tolist(), found.tolist()):
            exact = mpmath.atan2(mpmath.mpf(a), mpmath.mpf(b))
            worst = max(worst, float(abs(exact - mpmath.mpf(f)) / ulp_of(exact)))
    return worst


@pytest.mark.parametrize("n", [4000, pytest.param(400_000, marks=pytest.mark.soak)])
def test_atan2_of_random_pairs(n: int) -> None:
    rng = np.random.default_rng(23)
    near = rng.normal(size=(n, 2)).astype(np.float32)
    apart = (rng.normal(size=(n, 2)) * 10 ** rng.uniform(-37, 37, (n, 2))).astype(np.float32)
    bits = rng.integers(0, 2**32, (n, 2), dtype=np.uint32).view(np.float32)
    bits = bits[np.isfinite(bits).all(axis=1) & (bits != 0).all(axis=1)]
    subnormal = rng.integers(1, 2**23, (n, 2), dtype=np.uint32).view(np.float32) * rng.choice([-1, 1], (n, 2)).astype(
        np.float32
    )
    assert len(bits) > 0.98 * n
    for pairs in (near, apart, bits, subnormal):
        assert worst_atan2(pairs[:, 0].copy(), pairs[:, 1].copy()) <= 0.51  # seen: 0.500


def test_atan2_at_special_pairs() -> None:
    axis = np.array(
        [0.0, 1e-45, 1e-38, 1e-20, 0.41421356, 0.41421357, 1.0, np.nextafter(1, 2, dtype=np.float32), 3e38], np.float32
    )
    values = np.concatenate([axis, -axis])
    y, x = (g.ravel() for g in np.meshgrid(values, values))
    keep = y != 0  # zeros with their signs: below
    assert worst_atan2(y[keep], x[keep]) <= 0.51
    assert keep.sum() > 250


def test_atan2_of_zeros_and_axes_is_that_of_c() -> None:
    zeros = np.array([0.0, -0.0, 1.0, -1.0, 1e-45, -1e-45], np.float32)
    y, x = (g.ravel() for g in np.meshgrid(zeros, zeros))
    found, expected = _core.elementary("atan2", y, x), np.arctan2(y.astype(float), x.astype(float)).astype(np.float32)
    assert np.array_equal(np.signbit(found), np.signbit(expected))
    assert np.abs(found - expected).max() <= 2.0**-22
    flat = y == 0
    assert np.array_equal(found[flat], expected[flat])


def test_exp_and_acos_outside_their_ranges() -> None:
    x = np.array([89, 1e30, np.inf, -104, -1e30, -np.inf, 0, -0.0], np.float32)
    assert _core.elementary("exp", x).tolist() == [np.inf, np.inf, np.inf, 0, 0, 0, 1, 1]
    assert np.isnan(_core.elementary("exp", np.array([np.nan], np.float32)))[0]
    y = np.array([1, -1, 0, 1.0000001, -1.0000001, np.inf, np.nan], np.float32)
    found = _core.elementary("acos", y)
    assert found[:3].tolist() == [0, np.float32(np.pi), np.float32(np.pi / 2)]
    assert np.isnan(found[3:]).all()
