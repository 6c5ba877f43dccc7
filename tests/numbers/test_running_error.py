"""RunningError against exact rationals and arbitrary precision: enclosures, widths, bits, flags, and its shadow."""

import math
from collections.abc import Callable
from typing import Any

import flint
import numpy as np
import pytest

from raybound import _core

NO, YES, UNKNOWN = range(3)
TYPES = [pytest.param(False, id="float"), pytest.param(True, id="double")]
SIZES = [10_000, pytest.param(1_000_000, marks=pytest.mark.soak)]

Rows = np.ndarray[Any, np.dtype[np.float64]]


def precision(wide: bool) -> type[np.floating[Any]]:
    return np.float64 if wide else np.float32


def numbers(rng: np.random.Generator, n: int, wide: bool, decades: float = 6) -> tuple[Rows, Rows]:
    """Rows (value, lower, upper) of size 10^U(-6, 6), a quarter each with no error, up to 2^10 ulp, up to 2^20 ulp and
    up to the value itself; and a number within each: an end or in between.
    """
    kind = precision(wide)
    value = (10 ** rng.uniform(-decades, decades, n) * rng.choice([-1.0, 1.0], n)).astype(kind)
    ulp = np.spacing(np.abs(value))
    relative = rng.random(n).astype(kind) * np.abs(value)
    sizes = [
        0 * ulp,
        rng.integers(0, 2**10, n).astype(kind) * ulp,
        rng.integers(0, 2**20, n).astype(kind) * ulp,
        relative,
    ]
    error = np.choose(rng.integers(0, 4, n), sizes).astype(kind)
    rows = np.stack([value, value - error, value + error], axis=1).astype(np.float64)
    inside = rows[:, 1] + rng.random(n) * (rows[:, 2] - rows[:, 1])
    exact = np.choose(rng.integers(0, 3, n), [rows[:, 1], rows[:, 2], np.clip(inside, rows[:, 1], rows[:, 2])])
    return rows, exact


def rational(x: float) -> flint.fmpq:
    return flint.fmpq(*x.as_integer_ratio())


def below(x: float, exact: flint.fmpq) -> bool:
    return x == -math.inf or (x != math.inf and rational(x) <= exact)


def kind(wide: bool, *, shadow: bool = False) -> str:
    return ("precise_" if shadow else "") + f"running_error_float{64 if wide else 32}"


def errors(rows: Any, wide: bool) -> Rows:
    """error and relative_error, (n, 2)."""
    return np.asarray(_core.apply(kind(wide), "errors", [rows]), float)[:, :2]


def with_shadow(rows: Rows) -> Rows:
    """The same numbers with a precise value, which begins as the value."""
    return np.concatenate([rows, rows[:, :1], np.zeros((len(rows), 1))], axis=1)


def operation(name: str, operands: list[Rows], wide: bool, parameter: float = 0.0, shadow: bool = True) -> Rows:
    given = [with_shadow(rows) for rows in operands] if shadow else operands
    return np.asarray(_core.apply(kind(wide, shadow=shadow), name, given, parameter), float)[:, :3]


def quadratic(coefficients: list[Rows], wide: bool) -> tuple[Rows, Rows]:
    """The roots as rows of six, and per row what is certain and what the plain kernel says."""
    given = [with_shadow(rows) for rows in coefficients]
    found = np.asarray(_core.apply(kind(wide, shadow=True), "quadratic", given), float)
    return found[:, [0, 1, 2, 5, 6, 7]], found[:, 10:]


def point(x: Any) -> Rows:
    """Rows of exact numbers."""
    return np.repeat(np.atleast_1d(np.asarray(x, float))[:, None], 3, axis=1)


ARITHMETIC: dict[str, tuple[int, Callable[..., Any]]] = {
    "negate": (1, lambda a: -a),
    "square": (1, lambda a: a * a),
    "abs": (1, abs),
    "add": (2, lambda a, b: a + b),
    "subtract": (2, lambda a, b: a - b),
    "multiply": (2, lambda a, b: a * b),
    "divide": (2, lambda a, b: a / b),
    "minimum": (2, min),
    "maximum": (2, max),
    "fma": (3, lambda a, b, c: a * b + c),
}


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("wide", TYPES)
@pytest.mark.parametrize("name", ARITHMETIC)
def test_arithmetic_encloses_exact_rationals(name: str, wide: bool, n: int) -> None:
    """Every exact result inside; ends of exact operands next to each other; ends tight to the bit for the others."""
    rng = np.random.default_rng(len(name) + 100 * wide)
    count, exactly = ARITHMETIC[name]
    operands, exact = zip(*(numbers(rng, n, wide) for _ in range(count)))
    result = operation(name, list(operands), wide)
    kind, flagged, sharp = precision(wide), 0, 0
    for i, (value, lower, upper) in enumerate(result.tolist()):
        if lower == -math.inf and upper == math.inf:
            assert name == "divide", i
            assert operands[1][i, 1] <= 0 <= operands[1][i, 2], i
            flagged += 1
            continue
        inside = exactly(*(rational(e[i]) for e in exact))
        assert below(lower, inside), (i, lower, inside)
        assert below(-upper, -inside), (i, upper, inside)
        assert lower <= value <= upper
        if all(x[i, 1] == x[i, 2] for x in operands):
            assert upper <= np.nextafter(kind(lower), kind(np.inf))
            sharp += 1
    assert n - flagged > 0.9 * n
    assert sharp > 0.8 * n * 0.25**count


@pytest.mark.parametrize("wide", TYPES)
@pytest.mark.parametrize("name", ["add", "subtract", "multiply", "divide", "fma"])
def test_arithmetic_is_tight(name: str, wide: bool) -> None:
    """No end can be moved inward by one number: the exact range of the operands' enclosures reaches beyond."""
    n = 2000
    rng = np.random.default_rng(7)
    count, exactly = ARITHMETIC[name]
    operands = [numbers(rng, n, wide)[0] for _ in range(count)]
    result = operation(name, operands, wide)
    kind, tested = precision(wide), 0
    for i, (_, lower, upper) in enumerate(result.tolist()):
        if not math.isfinite(lower):
            continue
        corners = [()]
        for x in operands:
            corners = [(*c, rational(end)) for c in corners for end in x[i, 1:].tolist()]
        values = [exactly(*c) for c in corners]
        assert rational(float(np.nextafter(kind(lower), kind(np.inf)))) > min(values)
        assert rational(float(np.nextafter(kind(upper), kind(-np.inf)))) < max(values)
        tested += 1
    assert tested > 0.9 * n


def ward(x: flint.arb, sigma: float) -> flint.arb:
    return ((1 - 1 / (x * x)) / flint.arb(sigma) ** 2).exp()


# name: (smallest and largest operand, parameter, reference, width of the result for an exact operand in ulp)
FUNCTIONS: dict[str, tuple[float, float, float, Callable[[flint.arb], flint.arb], int]] = {
    "sqrt": (1e-6, 1e6, 0, lambda x: x.sqrt(), 1),
    "rsqrt": (1e-6, 1e6, 0, lambda x: x.rsqrt(), 5),
    "reciprocal": (-1e6, 1e6, 0, lambda x: 1 / x, 1),
    "exp": (-80, 80, 0, lambda x: x.exp(), 3),
    "log": (1e-6, 1e6, 0, lambda x: x.log(), 3),
    "sin": (-1e6, 1e6, 0, lambda x: x.sin(), 3),
    "cos": (-1e6, 1e6, 0, lambda x: x.cos(), 3),
    "tan": (-1e6, 1e6, 0, lambda x: x.tan(), 3),
    "asin": (-1, 1, 0, lambda x: x.asin(), 3),
    "acos": (-1, 1, 0, lambda x: x.acos(), 3),
    "atan": (-1e6, 1e6, 0, lambda x: x.atan(), 3),
    "power": (-1e3, 1e3, 5, lambda x: x**5, 6),
    "ward_lobe": (0.2, 1, 0.25, lambda x: ward(x, 0.25), 2**12),
}


@pytest.mark.parametrize("n", [2000, pytest.param(200_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("wide", TYPES)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_enclose_arbitrary_precision(name: str, wide: bool, n: int) -> None:
    least, most, parameter, exactly, ulps = FUNCTIONS[name]
    rng = np.random.default_rng(11)
    kind = precision(wide)
    size = 10 ** rng.uniform(math.log10(max(least, 1e-6)), math.log10(most), n)
    value = (size * rng.choice([-1.0, 1.0], n) if least < 0 else size).astype(kind)
    error = np.where(rng.random(n) < 0.5, 0, 10 ** rng.uniform(-7, -1, n) * np.abs(value)).astype(kind)
    lower, upper = np.maximum(value - error, kind(least)), np.minimum(value + error, kind(most))
    value = np.clip(value, lower, upper)
    rows = np.stack([value, lower, upper], axis=1).astype(float)
    inside = rows[:, 1] + rng.random(n) * (rows[:, 2] - rows[:, 1])
    exact = np.choose(rng.integers(0, 3, n), [rows[:, 1], rows[:, 2], np.clip(inside, rows[:, 1], rows[:, 2])])
    result = operation(name, [rows], wide, parameter)
    flagged = ~np.isfinite(result[:, 1:]).all(axis=1)
    with flint.ctx.workprec(160):
        for i in np.nonzero(~flagged)[0].tolist():
            y = exactly(flint.arb(exact[i]))
            assert not y < flint.arb(result[i, 1]), (i, rows[i], result[i], y)
            assert not y > flint.arb(result[i, 2]), (i, rows[i], result[i], y)
    points = (rows[:, 1] == rows[:, 2]) & ~flagged
    assert points.sum() > 0.4 * n
    width = (result[points, 2] - result[points, 1]) / np.spacing(np.abs(result[points, 0]).astype(kind)).astype(float)
    assert np.quantile(width, 0.99) <= ulps
    wild = name in ("tan", "sin", "cos")  # operands whose error is more than a period
    assert flagged.sum() <= (0.3 if wild else 0.1) * n


@pytest.mark.parametrize("wide", TYPES)
def test_values_have_the_bits_of_the_plain_kernel(wide: bool) -> None:
    kind, n = precision(wide), 4000
    rng = np.random.default_rng(5)
    rows = [numbers(rng, n, wide)[0] for _ in range(3)]
    a, b, _ = (r[:, 0].astype(kind) for r in rows)
    plain = {
        "add": a + b,
        "subtract": a - b,
        "multiply": a * b,
        "divide": a / b,
        "square": a * a,
        "reciprocal": 1 / a,
        "minimum": np.minimum(a, b),
        "maximum": np.maximum(a, b),
        "abs": np.abs(a),
    }
    for name, expected in plain.items():
        result = operation(name, rows[:2] if name in ARITHMETIC and ARITHMETIC[name][0] == 2 else rows[:1], wide)
        assert expected.dtype == kind
        np.testing.assert_array_equal(result[:, 0].astype(kind), expected, err_msg=name)
    positive = np.abs(rows[0])
    positive[:, 1:] = np.sort(positive[:, 1:], axis=1)
    root = np.sqrt(positive[:, 0].astype(kind))
    np.testing.assert_array_equal(operation("sqrt", [positive], wide)[:, 0].astype(kind), root)
    np.testing.assert_array_equal(operation("rsqrt", [positive], wide)[:, 0].astype(kind), 1 / root)
    if not wide:
        x = rng.uniform(-1, 1, n).astype(np.float32)
        for name in ("exp", "acos"):  # our own, not the C library's
            np.testing.assert_array_equal(
                operation(name, [point(x)], wide)[:, 0].astype(kind), _core.elementary(name, x)
            )


def test_the_shadow_changes_nothing() -> None:
    rng = np.random.default_rng(3)
    for wide in (False, True):
        rows = [numbers(rng, 500, wide)[0] for _ in range(3)]
        for name in [*ARITHMETIC, *FUNCTIONS]:
            operands = rows[: ARITHMETIC[name][0]] if name in ARITHMETIC else rows[:1]
            shadowed, without = (operation(name, operands, wide, 0.5, shadow) for shadow in (True, False))
            np.testing.assert_array_equal(shadowed, without)


@pytest.mark.parametrize("n", [300, pytest.param(30_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("wide", TYPES)
def test_programs_enclose_exact_rationals(wide: bool, n: int) -> None:
    """Random straight-line programs of twelve operations on four registers; where they end, in exact rationals."""
    rng = np.random.default_rng(17)
    drawn = [numbers(rng, n, wide, decades=2) for _ in range(4)]
    registers = [rows for rows, _ in drawn]
    exact = [[rational(x) for x in e.tolist()] for _, e in drawn]
    for step in range(12):
        name = ["add", "subtract", "multiply", "divide"][step % 4]
        i, j, target = rng.integers(0, 4, 3)
        if i == j:
            j = (j + 1) % 4
        registers[target] = operation(name, [registers[i], registers[j]], wide)
        function = ARITHMETIC[name][1]
        exact[target] = [function(x, y) if y != 0 else None for x, y in zip(exact[i], exact[j])]
    bounded = 0
    for rows, truth in zip(registers, exact):
        for (_, lower, upper), x in zip(rows.tolist(), truth):
            if math.isfinite(lower) and math.isfinite(upper):
                assert below(lower, x)
                assert below(-upper, -x)
                bounded += 1
    assert bounded > 2 * n


@pytest.mark.parametrize("wide", TYPES)
def test_error_and_relative_error(wide: bool) -> None:
    n = 3000
    rng = np.random.default_rng(29)
    rows, exact = numbers(rng, n, wide)
    sizes = errors(rows, wide)
    signed = rows[:, 1] * rows[:, 2] > 0
    assert signed.sum() > 0.9 * n
    for (value, lower, upper), x, (error, relative), sure in zip(rows.tolist(), exact.tolist(), sizes.tolist(), signed):
        off = abs(rational(value) - rational(x))
        assert off <= rational(error)
        assert error <= max(upper - value, value - lower) * (1 + 2**-22)
        if sure:
            assert off <= rational(relative) * abs(rational(x))
            assert relative <= error / min(abs(lower), abs(upper)) * (1 + 2**-22)
        else:
            assert relative == math.inf
    zero = errors(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 2.0]]), wide)
    assert zero.tolist() == [[0.0, 0.0], [1.0, math.inf]]


FLAGGED = [
    ("sqrt", [[1.0, -1e-3, 2.0]], 0),
    ("sqrt", [[-1.0, -1.0, -1.0]], 0),
    ("rsqrt", [[1.0, 0.0, 2.0]], 0),
    ("log", [[1.0, 0.0, 2.0]], 0),
    ("asin", [[1.0, 0.5, 1.5]], 0),
    ("acos", [[-1.0, -1.5, -0.5]], 0),
    ("tan", [[1.5, 1.0, 2.0]], 0),
    ("reciprocal", [[1.0, 0.0, 2.0]], 0),
    ("divide", [[0.0, 0.0, 0.0], [1.0, -1.0, 2.0]], 0),
    ("divide", [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 0),
    ("power", [[1.0, -1.0, 2.0]], -1),
    ("ward_lobe", [[1.0, 1.0, 1.0]], 0),
    ("multiply", [[0.0, 0.0, 0.0], [math.inf, 1e30, math.inf]], 0),
    ("add", [[math.nan, 0.0, 1.0], [1.0, 1.0, 1.0]], 0),
]


@pytest.mark.parametrize("wide", TYPES)
@pytest.mark.parametrize(("name", "operands", "parameter"), FLAGGED)
def test_domain_errors_are_flagged(name: str, operands: list[list[float]], parameter: float, wide: bool) -> None:
    """The error is infinite, and stays so whatever follows, a product with 0 included."""
    result = operation(name, [np.array([row]) for row in operands], wide, parameter)
    assert result[0, 1:].tolist() == [-math.inf, math.inf]
    assert errors(result, wide).tolist() == [[math.inf, math.inf]]
    for later in ("multiply", "minimum", "add"):
        after = operation(later, [result, point(0.0)], wide)
        assert after[0, 1:].tolist() == [-math.inf, math.inf]


@pytest.mark.parametrize("wide", TYPES)
def test_overflow_and_underflow(wide: bool) -> None:
    kind = np.finfo(precision(wide))
    most, least = float(kind.max), float(kind.smallest_subnormal)
    assert operation("multiply", [point(most), point(2.0)], wide)[0].tolist() == [math.inf, most, math.inf]
    assert operation("add", [point(-most), point(-most)], wide)[0].tolist() == [-math.inf, -math.inf, -most]
    assert operation("multiply", [point(least), point(0.5)], wide)[0].tolist() == [0.0, 0.0, least]
    assert operation("exp", [point(1e4)], wide)[0].tolist() == [math.inf, most, math.inf]
    assert errors(operation("exp", [point(1e4)], wide), wide)[0, 0] == math.inf


@pytest.mark.parametrize("wide", TYPES)
def test_comparisons_are_certain_or_unknown(wide: bool) -> None:
    n = 5000
    rng = np.random.default_rng(31)
    (a, exact_a), (b, exact_b) = numbers(rng, n, wide, decades=1), numbers(rng, n, wide, decades=1)
    near = rng.random(n) < 0.3  # the same value, another error
    b[near] = a[near]
    exact_b[near] = rng.uniform(a[near, 1], a[near, 2])
    lesser, answers = _core.running_error_lesser(a, b, wide)
    less = exact_a < exact_b
    for verdict in (NO, YES, UNKNOWN):
        assert (answers[:, 0] == verdict).sum() > 0.1 * n
    assert not less[answers[:, 0] == NO].any()
    assert less[answers[:, 0] == YES].all()
    np.testing.assert_array_equal(answers[:, 1] == 1, a[:, 0] < b[:, 0])
    np.testing.assert_array_equal(lesser[:, 0], np.minimum(a[:, 0], b[:, 0]))
    chosen = np.where(less, exact_a, exact_b)
    assert (lesser[:, 1] <= chosen).all()
    assert (chosen <= lesser[:, 2]).all()


def roots(a: float, b: float, c: float) -> tuple[bool, flint.arb, flint.arb]:
    """Whether the roots of exact coefficients are real, and both, the lesser first."""
    x, y, z = (rational(v) for v in (a, b, c))
    discriminant = y * y - 4 * x * z
    root = flint.arb(max(discriminant, flint.fmpq(0))).sqrt()
    both = [(-flint.arb(y) + s * root) / (2 * flint.arb(x)) for s in (-1, 1)]
    return discriminant >= 0, *(both if x > 0 else both[::-1])


@pytest.mark.parametrize("n", [3000, pytest.param(300_000, marks=pytest.mark.soak)])
@pytest.mark.parametrize("wide", TYPES)
def test_quadratic(wide: bool, n: int) -> None:
    """No real roots are missed, none invented; certain wherever the discriminant is, and the roots are tight."""
    kind = precision(wide)
    rng = np.random.default_rng(37)
    rows, exact = map(list, zip(*(numbers(rng, n, wide, decades=3) for _ in range(3))))
    grazing = rng.random(n) < 0.4  # a discriminant that cancels: c next to b^2 / 4a
    a, b = (rows[k][:, 0] for k in range(2))
    c = (b * b / (4 * a) * (1 + rng.integers(-3, 4, n) * np.finfo(kind).eps)).astype(kind).astype(float)
    for k in range(3):
        rows[k][grazing] = point((a, b, c)[k][grazing])
        exact[k][grazing] = rows[k][grazing, 0]
    solved, answers = quadratic(rows, wide)
    counts = [(answers[:, 0] == verdict).sum() for verdict in (NO, YES, UNKNOWN)]
    assert min(counts[:2]) > 0.1 * n
    assert counts[2] > 0.01 * n
    ulps = []
    with flint.ctx.workprec(300):
        for i in range(n):
            real, low, high = roots(*(e[i] for e in exact))
            verdict = answers[i, 0]
            assert verdict == UNKNOWN or (verdict == YES) == real, i
            if real:
                for (value, lower, upper), t in ((solved[i, :3], low), (solved[i, 3:], high)):
                    assert not t < flint.arb(lower), (i, t, lower)
                    assert not t > flint.arb(upper), (i, t, upper)
                    if verdict == YES and all(x[i, 1] == x[i, 2] for x in rows) and not grazing[i]:
                        ulps.append((upper - lower) / float(np.spacing(kind(abs(value)))))
    assert len(ulps) > 0.005 * n
    assert np.quantile(ulps, 0.95) <= 8
    exactly_known = grazing & (answers[:, 0] != UNKNOWN)
    if not wide:  # floats have their discriminant in double: its sign is certain
        assert (exactly_known == grazing).all()


def test_quadratic_is_not_fooled() -> None:
    """Values with a negative discriminant whose errors reach a positive one: the seeds' function calls that a miss."""
    coefficients = [point(1.0), np.array([[2.0, 1.875, 2.125]]), np.array([[1.03125, 1.0, 1.0625]])]
    solved, answers = quadratic(coefficients, False)
    assert answers[0].tolist() == [UNKNOWN, 0]
    half = math.sqrt(2.125**2 - 4)
    assert solved[0, 1] <= (-2.125 - half) / 2
    assert solved[0, 5] >= (-2.125 + half) / 2
    degenerate = [np.array([[0.0, 0.0, 0.0]]), point(1.0), point(1.0)]
    solved, answers = quadratic(degenerate, False)
    assert answers[0, 0] == UNKNOWN
    assert np.isinf(solved[0, [1, 2, 4, 5]]).all()


@pytest.mark.parametrize("wide", TYPES)
def test_the_shadow_can_fail(wide: bool) -> None:
    with pytest.raises(RuntimeError, match="broken addition gave 3, outside of"):
        _core.running_error_broken_addition(1.0, 2.0, wide)
    _core.running_error_broken_addition(1.0, 0.0, wide)  # the same operation where it happens to be right


def test_bad_input() -> None:
    with pytest.raises(ValueError, match="operands"):
        operation("add", [np.zeros((2, 3)), np.zeros((3, 3))], False)
    with pytest.raises(ValueError, match="no operation is called 'cosh'"):
        operation("cosh", [np.zeros((1, 3))], False)
