"""next_float_up, next_float_down against numpy.nextafter; bits; gamma against exact rationals."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import raybound as rb

TYPES = {np.float32: np.uint32, np.float64: np.uint64}
SETTINGS = settings(derandomize=True, deadline=None, max_examples=300)


def special(dtype: type) -> np.ndarray:
    info = np.finfo(dtype)
    values = [0.0, np.inf, info.max, info.tiny, info.smallest_subnormal, info.tiny - info.smallest_subnormal, 1.0]
    array = np.array(values, dtype)
    return np.concatenate([array, -array, [dtype(np.nan)]])


def patterns(dtype: type, n: int) -> np.ndarray:
    """Random bit patterns: normal numbers of all sizes, subnormals, NaNs."""
    bits = TYPES[dtype]
    rng = np.random.default_rng(17)
    words = rng.integers(0, np.iinfo(bits).max, n, dtype=bits, endpoint=True)
    small = rng.integers(0, np.finfo(dtype).tiny.view(bits), n // 10, dtype=bits)
    sign = bits(1) << bits(8 * dtype().itemsize - 1)
    return np.concatenate([words, small, small | sign]).view(dtype)


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize(("ours", "toward"), [(rb.next_float_up, np.inf), (rb.next_float_down, -np.inf)])
def test_steps_are_those_of_nextafter(dtype: type, ours: object, toward: float) -> None:
    x = np.concatenate([patterns(dtype, 100_000), special(dtype)])
    with np.errstate(all="ignore"):
        expected = np.nextafter(x, dtype(toward))
    found = ours(x)  # type: ignore[operator]
    nan = np.isnan(x)
    # The infinity of the other side is left alone too: it stands for an unbounded interval.
    stays = np.isinf(x)
    assert np.isnan(found[nan]).all()
    assert np.array_equal(found[stays & (x == toward)], x[stays & (x == toward)])
    usual = ~nan & ~stays
    assert found.dtype == dtype
    assert np.array_equal(found[usual].view(TYPES[dtype]), expected[usual].view(TYPES[dtype]))
    subnormal = (np.abs(x) < np.finfo(dtype).tiny) & (x != 0)
    assert usual.sum() > 100_000
    assert subnormal.sum() > 15_000


@pytest.mark.parametrize("dtype", TYPES)
def test_specials(dtype: type) -> None:
    least, largest = np.finfo(dtype).smallest_subnormal, np.finfo(dtype).max
    for zero in (dtype(0), -dtype(0)):
        assert rb.next_float_up(zero) == least
        assert rb.next_float_down(zero) == -least
    assert rb.next_float_up(largest) == np.inf
    assert rb.next_float_down(-largest) == -np.inf
    assert rb.next_float_up(-least) == 0
    assert np.signbit(rb.next_float_up(-least))
    assert rb.next_float_up(dtype(np.inf)) == np.inf
    assert rb.next_float_down(-dtype(np.inf)) == -np.inf
    assert rb.next_float_up(-dtype(np.inf)) == -largest
    assert rb.next_float_down(dtype(np.inf)) == largest


@SETTINGS
@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_down_undoes_up(x: float) -> None:
    x32 = np.float32(x)
    if np.isfinite(rb.next_float_up(x32)):
        assert rb.next_float_down(rb.next_float_up(x32)) == x32
    assert rb.next_float_up(x32) > x32 > rb.next_float_down(x32)


def test_shapes_and_types() -> None:
    assert isinstance(rb.next_float_up(1.0), float)
    assert rb.next_float_up(1) == np.nextafter(1.0, 2.0)
    assert rb.next_float_up(np.float16(1)).dtype == np.float32
    for shape in ((), (0,), (3,), (2, 3), (2, 0, 4)):
        assert rb.next_float_up(np.ones(shape, np.float32)).shape == shape
    strided = np.arange(20, dtype=np.float64)[::3]
    assert np.array_equal(rb.next_float_down(strided), np.nextafter(strided, -np.inf))
    for bad in ("1", None, 1j, True, np.array([True])):
        with pytest.raises(TypeError, match="next_float_up: x"):
            rb.next_float_up(bad)


@pytest.mark.parametrize("dtype", TYPES)
def test_bits_are_those_of_memory(dtype: type) -> None:
    """Of all numbers, NaNs with their payloads among them; and back, to the bit."""
    x = np.concatenate([patterns(dtype, 100_000), special(dtype)])
    bits = rb.float_bits(x)
    assert bits.dtype == TYPES[dtype]
    assert np.array_equal(bits, x.view(TYPES[dtype]))
    for back in (rb.float_from_bits(bits), rb.float_from_bits(bits, dtype)):
        assert back.dtype == dtype
        assert np.array_equal(back.view(TYPES[dtype]), bits)
    assert np.isnan(x).sum() > 50  # one in 2^11 patterns of float64
    assert len(np.unique(bits[np.isnan(x)])) > 40


def test_bits_of_known_numbers() -> None:
    assert rb.float_bits(np.float32(1)) == 0x3F800000
    assert rb.float_bits(1) == rb.float_bits(1.0) == 0x3FF0000000000000
    assert type(rb.float_bits(1.0)) is np.uint64
    assert rb.float_bits(np.float16(-2)) == 0xC0000000
    assert rb.float_from_bits(0x7F7FFFFF, np.float32) == np.finfo(np.float32).max
    assert rb.float_from_bits(1, np.float64) == 5e-324
    assert rb.float_from_bits(np.array([0, 2**63], np.uint64)).tolist() == [0.0, -0.0]
    assert np.isnan(rb.float_from_bits(np.uint32(0x7F800001)))
    for shape in ((), (0,), (2, 3), (2, 0, 4)):
        bits = rb.float_bits(np.ones(shape, np.float32))
        assert bits.shape == rb.float_from_bits(bits).shape == shape


def test_bits_refuse() -> None:
    for bad in ("1", None, 1j, True):
        with pytest.raises(TypeError, match="float_bits: x must be"):
            rb.float_bits(bad)
        with pytest.raises(TypeError, match="float_from_bits: bits must be"):
            rb.float_from_bits(bad)
    with pytest.raises(TypeError, match="bits must be an integer or an array of integers, got dtype float64"):
        rb.float_from_bits(1.0, np.float32)
    with pytest.raises(TypeError, match=r"dtype must be float32 or float64 .*, got None for bits of dtype int64"):
        rb.float_from_bits(1)
    with pytest.raises(TypeError, match=r"dtype must be float32 or float64 .*, got <class 'numpy.float16'>"):
        rb.float_from_bits(1, np.float16)
    for bad in (-1, 2**32, [0, -7]):
        with pytest.raises(ValueError, match=r"float_from_bits: bits must fit in uint32, got -?[0-9]+"):
            rb.float_from_bits(bad, np.float32)


@pytest.mark.parametrize(("dtype", "unit"), [(np.float32, Fraction(1, 2**24)), (np.float64, Fraction(1, 2**53))])
def test_gamma_is_the_rational_rounded_up(dtype: type, unit: Fraction) -> None:
    """gamma_n = n u / (1 - n u) from above, by two steps at most."""
    counts = [*range(1, 200), 1000, 4095, 65535, 2**20]
    for n, found in zip(counts, rb.gamma(np.array(counts), dtype)):
        exact = n * unit / (1 - n * unit)
        assert Fraction(float(found)) >= exact
        assert Fraction(float(rb.next_float_down(rb.next_float_down(found)))) < exact  # seen: one step
        assert found == rb.gamma(n, dtype)


def test_gamma_refuses() -> None:
    assert rb.gamma(0) >= 0
    assert rb.gamma(3).dtype == np.float32
    for bad in (1.5, "3", True, None):
        with pytest.raises(TypeError, match="gamma: n"):
            rb.gamma(bad)
    with pytest.raises(ValueError, match="gamma: n"):
        rb.gamma(-1)
    with pytest.raises(TypeError, match="dtype"):
        rb.gamma(3, np.float16)


@pytest.mark.parametrize("n", [2**24 - 1, 2**24, 2**24 + 1, 2**31 - 1])
def test_gamma_has_no_value_where_n_roundings_have_no_bound(n: int) -> None:
    """n u >= 1: an error or infinity, never a negative bound."""
    try:
        bound = rb.gamma(n)
    except ValueError:
        return
    assert bound > 0
