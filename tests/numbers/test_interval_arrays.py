"""Operations on arrays of intervals: the bits of single intervals, in every lane and remainder."""

import numpy as np
import pytest

from raybound import _core

ARITY = {"add": 2, "subtract": 2, "multiply": 2, "divide": 2, "fma": 3, "sqrt": 1, "square": 1}
DTYPES = {np.float32: "float", np.float64: "double"}
EMPTY = (np.inf, -np.inf)
SPECIAL = [EMPTY, (-np.inf, np.inf), (0, 0), (0, np.inf), (-np.inf, -1), (-1, 1), (0, 1), (-1, 0), (1e-30, 1e30)]


def operands(rng: np.random.Generator, arity: int, n: int, dtype: type, special_share: float) -> np.ndarray:
    x = rng.choice([-1, 1], (arity, 1, n)) * 10 ** rng.uniform(-6, 6, (arity, 1, n))
    ends = np.sort(x * rng.uniform(0.9, 1.1, (arity, 2, n)), axis=1).astype(dtype)
    for k, i in zip(*np.nonzero(rng.uniform(size=(arity, n)) < special_share)):
        ends[k, :, i] = SPECIAL[rng.integers(len(SPECIAL))]
    return ends


@pytest.mark.parametrize("special_share", [0, 0.02, 1])
@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("name", ARITY)
def test_the_bits_of_single_intervals(name: str, dtype: type, special_share: float) -> None:
    x = operands(np.random.default_rng(53), ARITY[name], 4001, dtype, special_share)
    found = _core.interval_array_operation(name, x)
    expected = _core.interval_operation(name, x.astype(np.float64), DTYPES[dtype]).astype(dtype)
    assert found.dtype == dtype
    assert found.tobytes() == expected.tobytes()
    assert not np.isnan(found).any()
    assert (found[0] < found[1]).sum() > 500
    if special_share == 1:
        assert (found[0] > found[1]).sum() > 300


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("n", range(20))
def test_every_remainder(n: int, dtype: type) -> None:
    x = operands(np.random.default_rng(n), 3, n, dtype, 0.1)
    product = _core.interval_array_operation("multiply", x[:2])
    assert product.shape == (2, n)
    both = _core.interval_array_operation("multiply_add", x)
    assert both.tobytes() == _core.interval_array_operation("add", np.array([product, x[2]])).tobytes()


def test_bad_arguments() -> None:
    with pytest.raises(ValueError, match=r"unknown operation 'modulo'"):
        _core.interval_array_operation("modulo", np.zeros((2, 2, 3)))
    with pytest.raises(ValueError, match=r"operands must have shape \(k, 2, n\)"):
        _core.interval_array_operation("add", np.zeros((2, 3)))
