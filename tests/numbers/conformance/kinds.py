"""The kinds of numbers: how operands are drawn, what values they may stand for, and what a result promises."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import flint
import numpy as np

from raybound import _core

Ball = flint.arb
INF = np.inf
Records = np.ndarray
Balls = list[list[Ball]]


class Kind:
    """A number type whose records enclose functions over [-1, 1]^variables (0 variables: a set of numbers)."""

    def __init__(self, name: str, *, executed: bool = False, dtype: type = np.float64, variables: int = 0) -> None:
        self.name = name
        self.executed = executed  # whether results of float32 arithmetic are enclosed, too
        self.dtype = dtype
        self.variables = variables
        self.unit = float(np.finfo(dtype).eps) / 2
        self.is_set = False  # loses the part of its operands that is outside of the domain, where others give up

    def __repr__(self) -> str:
        return self.name

    def apply(self, operation: str, operands: Sequence[Records], parameter: float = 0.0) -> Records:
        return np.asarray(_core.apply(self.name, operation, list(operands), parameter))

    def draw(self, rng: np.random.Generator, centers: np.ndarray) -> Records:
        """Operands of every kind around the given places."""
        raise NotImplementedError

    def cells(self, centers: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> Records:
        """centers + slopes xi + bends xi_0^2, the last where the kind has squares: (n,), (n, variables or 1), (n,)."""
        raise NotImplementedError

    def variable(self, i: int, low: np.ndarray, high: np.ndarray) -> tuple[Records, np.ndarray, np.ndarray]:
        """The i-th variable over cells [low, high], (n,), which are float32 numbers; and the center and radius of the
        cells as the kind sees them."""
        raise NotImplementedError

    def points(self, rng: np.random.Generator, n: int) -> np.ndarray:
        """Points of the domain, (n, variables): the center, corners, points on edges and inside."""
        points = rng.uniform(-1, 1, (n, self.variables))
        points[: 2 * n // 3] = np.where(
            rng.random(points[: 2 * n // 3].shape) < 0.7, np.sign(points[: 2 * n // 3]), 0.5
        )
        if n > 2:
            points[0] = 0
        return points

    def values(self, records: Records, points: np.ndarray, offsets: np.ndarray) -> Balls:
        """A value that each record may have at each point; `offsets` (n, points) in [-1, 1] says which."""
        raise NotImplementedError

    def ends(self, records: Records, points: np.ndarray) -> list[list[tuple[Ball, Ball]]]:
        """The least and the greatest value of each record at each point."""
        low, high = (self.values(records, points, np.full((len(records), len(points)), t)) for t in (-1.0, 1.0))
        return [list(zip(a, b)) for a, b in zip(low, high)]

    def is_canonical(self, records: Records) -> np.ndarray:
        """Whether records are as they should be: without NaN, the ends in order, the unknown always the same."""
        raise NotImplementedError

    def is_bounded(self, records: Records) -> np.ndarray:
        """Where something is promised."""
        raise NotImplementedError

    def is_empty(self, records: Records) -> np.ndarray:
        """Where a result has no values: the operation is defined nowhere."""
        return np.zeros(len(records), bool)

    def ranges(self, records: Records) -> np.ndarray:
        """Least and greatest value over the domain, (n, 2)."""
        raise NotImplementedError

    def part(self, records: Records, rng: np.random.Generator) -> Records:
        """The same functions over a part of the domain, or less of a set."""
        raise NotImplementedError

    def special(self) -> Records:
        """Operands at the ends of what there is."""
        raise NotImplementedError


def spread(rng: np.random.Generator, centers: np.ndarray) -> np.ndarray:
    """How far operands reach: from nothing to several times their size, and now and then to an absolute 1."""
    relative = np.abs(centers) * 10.0 ** rng.uniform(-17, 0.6, len(centers))
    size = np.where(rng.random(len(centers)) < 0.15, 10.0 ** rng.uniform(-8, 0.3, len(centers)), relative)
    return np.where(rng.random(len(centers)) < 0.1, 0, size)


TINY, LEAST = 2.0**-1074, 2.0**-1022
PLACES = [
    0.0,
    1.0,
    -1.0,
    0.5,
    np.pi / 2,
    2.0,
    -3.0,
    1e-10,
    TINY,
    -TINY,
    LEAST,
    2.0**-149,
    2.0**-126,
    1e38,
    3.4028234663852886e38,
]
FAR_PLACES = [2.0**-500, 1e154, -1e155, 1e300, 1.5e308, -1.7e308, np.finfo(np.float64).max, 709.5, -745.0]


class IntervalKind(Kind):
    """Also what holds its values between two ends: `_sides` of a record, and `_between` the record of two."""

    def __init__(self, name: str, *, executed: bool = False, dtype: type = np.float64) -> None:
        super().__init__(name, executed=executed, dtype=dtype)
        self.is_set = True

    def _sides(self, records: Records) -> np.ndarray:
        return records

    def _between(self, sides: np.ndarray) -> Records:
        return sides.astype(self.dtype)

    def draw(self, rng: np.random.Generator, centers: np.ndarray) -> Records:
        radius = spread(rng, centers)
        with np.errstate(over="ignore"):
            low = np.asarray(centers - radius * rng.integers(0, 2, len(centers)), self.dtype)
            high = np.maximum(np.asarray(centers + radius, self.dtype), low)
        return self._mended(low, high)

    def _mended(self, low: np.ndarray, high: np.ndarray) -> Records:
        largest = np.finfo(self.dtype).max
        return self._between(np.stack([np.minimum(low, largest), np.maximum(high, -largest)], -1))

    def cells(self, centers: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> Records:
        radius = np.abs(slopes).sum(-1) + np.abs(bends)
        return self._mended(np.asarray(centers - radius, self.dtype), np.asarray(centers + radius, self.dtype))

    def variable(self, i: int, low: np.ndarray, high: np.ndarray) -> tuple[Records, np.ndarray, np.ndarray]:
        return self._between(np.stack([low, high], -1)), low, low

    def values(self, records: Records, points: np.ndarray, offsets: np.ndarray) -> Balls:
        return [
            [self._value(low, high, t) for t in row]
            for (low, high), row in zip(self._sides(records).tolist(), offsets.tolist())
        ]

    @staticmethod
    def _value(low: float, high: float, t: float) -> Ball:
        if low > high:
            return Ball("nan")
        if t in (-1, 1):
            return Ball(low if t < 0 else high)
        if low == -INF or high == INF:  # far from the finite end, if there is one, or near
            finite = high if high < INF else low if low > -INF else 0.0
            away = -1 if high < INF or (low == -INF and t < 0) else 1
            return Ball(finite) + away * Ball(2) ** int(1100 * (2 * abs(t) - 1))
        return (Ball(low) * (1 - Ball(t)) + Ball(high) * (1 + Ball(t))) / 2

    def ends(self, records: Records, points: np.ndarray) -> list[list[tuple[Ball, Ball]]]:
        return [[(Ball(low), Ball(high))] * len(points) for low, high in self._sides(records).tolist()]

    def is_bounded(self, records: Records) -> np.ndarray:
        return np.isfinite(self._sides(records)).all(-1)

    def is_empty(self, records: Records) -> np.ndarray:
        return self._sides(records)[:, 0] > self._sides(records)[:, 1]

    def ranges(self, records: Records) -> np.ndarray:
        return self._sides(records).astype(np.float64)

    def part(self, records: Records, rng: np.random.Generator) -> Records:
        ends, sides = np.sort(rng.random((len(records), 2)), -1), self._sides(records)
        with np.errstate(invalid="ignore"):
            inner = sides[:, :1] + (sides[:, 1:] - sides[:, :1]) * ends
        inner = np.clip(np.where(np.isfinite(inner), inner, sides), sides[:, :1], sides[:, 1:])
        return self._between(np.where(self.is_empty(records)[:, None], sides, inner))

    def is_canonical(self, records: Records) -> np.ndarray:
        low, high = records.T
        return np.where(low > high, (low == INF) & (high == -INF), (low < INF) & (high > -INF)) & (low == low)

    def special(self) -> Records:
        with np.errstate(over="ignore"):
            ends = np.unique(np.array([*PLACES, *FAR_PLACES, INF, -INF], self.dtype))
        low, high = (g.ravel() for g in np.meshgrid(ends, ends))
        good = (low <= high) & (low < INF) & (high > -INF)
        few = np.nonzero(good)[0][:: max(1, good.sum() // 60)]
        picked = np.stack([low[few], high[few]], -1)
        signed = [[-0.0, 0.0], [0.0, 0.0], [-0.0, 1.0], [-1.0, -0.0], [INF, -INF], [-INF, INF], [0.0, INF], [-INF, 0.0]]
        return self._between(np.concatenate([picked, np.array(signed, self.dtype)]))


class RunningErrorKind(IntervalKind):
    """A value as plain floating point gives it, and the ends that enclose the exact one: all where nothing is known."""

    def __init__(self, name: str, dtype: type) -> None:
        super().__init__(name, dtype=dtype)
        self.is_set = False

    def _sides(self, records: Records) -> np.ndarray:
        return records[:, 1:]

    def _between(self, sides: np.ndarray) -> Records:
        ends = sides.astype(self.dtype)
        value = np.clip(ends[:, :1] / 2 + ends[:, 1:] / 2, ends[:, :1], ends[:, 1:])
        return np.concatenate([value, ends], -1)

    def is_canonical(self, records: Records) -> np.ndarray:
        return records[:, 1] <= records[:, 2]

    def special(self) -> Records:
        records = super().special()
        return np.ascontiguousarray(records[np.isfinite(records).all(-1) & (records[:, 1] <= records[:, 2])])


class LinearKind(Kind):
    """The constant's ends, those of each slope, and those of the range, within which all values are besides."""

    def _make(self, constant: np.ndarray, slopes: np.ndarray) -> Records:
        """From ends (n, 2) and (n, variables, 2)."""
        whole = np.full((len(constant), 2), [-INF, INF])
        parts = np.concatenate([constant, slopes.reshape(len(constant), -1), whole], -1)
        return self.apply("settled", [np.ascontiguousarray(parts)])

    def draw(self, rng: np.random.Generator, centers: np.ndarray) -> Records:
        n, v = len(centers), self.variables
        size = spread(rng, centers)
        with np.errstate(over="ignore", invalid="ignore"):
            wide = size[:, None] * np.sort(rng.uniform(-1, 1, (n, 2)), -1) * (rng.random((n, 1)) < 0.5)
            share = 10.0 ** rng.uniform(-14, 0, (n, 1))
            slopes = size[:, None, None] * rng.uniform(-1, 1, (n, v, 1)) / v
            slopes = slopes + np.abs(slopes) * share[:, None] * np.sort(rng.uniform(-1, 1, (n, v, 2)), -1)
        constant = centers[:, None] + wide * share
        good = np.isfinite(constant).all(-1) & np.isfinite(slopes).all((1, 2))
        return self._make(np.where(good[:, None], constant, 1.0), np.where(good[:, None, None], slopes, 0.0))

    def cells(self, centers: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> Records:
        return self._make(np.stack([centers, centers], -1), np.stack([slopes, slopes], -1))

    def variable(self, i: int, low: np.ndarray, high: np.ndarray) -> tuple[Records, np.ndarray, np.ndarray]:
        center, radius = cell_between(low, high)
        slopes = np.zeros((len(low), self.variables))
        slopes[:, i] = radius
        return self.cells(center, slopes, slopes[:, 0]), center, radius

    def values(self, records: Records, points: np.ndarray, offsets: np.ndarray) -> Balls:
        v = self.variables
        x = [[Ball(c) for c in point] for point in points]
        rows = []
        for record, ts in zip(records.tolist(), offsets.tolist()):
            slopes, (least, greatest) = record[2 : 2 + 2 * v], record[-2:]
            row = []
            for point, t in zip(x, ts):
                low, high = Ball(record[0]), Ball(record[1])
                for k, c in enumerate(point):
                    ends = [s * c for s in (Ball(slopes[2 * k]), Ball(slopes[2 * k + 1]))]
                    low, high = (low + ends[0], high + ends[1]) if c >= 0 else (low + ends[1], high + ends[0])
                low, high = low if low > least else Ball(least), high if high < greatest else Ball(greatest)
                row.append(low if t == -1 else high if t == 1 else (low * (1 - Ball(t)) + high * (1 + Ball(t))) / 2)
            rows.append(row)
        return rows

    def is_canonical(self, records: Records) -> np.ndarray:
        return ~np.isnan(records).any(-1) & (records[:, ::2] <= records[:, 1::2]).all(-1)

    def is_bounded(self, records: Records) -> np.ndarray:
        return np.isfinite(records).all(-1)

    def ranges(self, records: Records) -> np.ndarray:
        return records[:, -2:]

    def special(self) -> Records:
        rows = []
        for place in [*PLACES, *FAR_PLACES]:
            for slope, width in ((0.0, 0.0), (place, 0.0), (0.3, 0.0), (0.3, 0.1), (TINY, TINY), (0.0, abs(place) / 2)):
                constant = np.array([[place - width, place + width]])
                slopes = np.full((1, self.variables, 2), [slope - width, slope + width]) / self.variables
                rows.append(self._make(constant, slopes)[0])
        return np.array(rows)


def cell_between(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Center and radius of cells that hold [low, high]."""
    center = 0.5 * low + 0.5 * high
    radius = np.maximum(np.nextafter(high - center, np.inf), np.nextafter(center - low, np.inf))
    return center, np.where(low == high, 0, radius)


class TaylorKind(Kind):
    @property
    def width(self) -> int:
        n = self.variables
        return 2 + 2 * n + n * (n - 1) // 2

    def draw(self, rng: np.random.Generator, centers: np.ndarray) -> Records:
        """The first, second degree and remainder share the spread in all proportions."""
        n, v = len(centers), self.variables
        records = np.zeros((n, self.width))
        records[:, 0] = centers
        shares = 10.0 ** rng.uniform(-14, 0, (n, 3)) * (rng.random((n, 3)) < 0.8)
        shares[np.arange(n), rng.choice(3, n, p=[0.7, 0.1, 0.2])] = 1
        with np.errstate(over="ignore", invalid="ignore"):
            size = (spread(rng, centers) / shares.sum(-1))[:, None] * shares
            for part, columns in enumerate((slice(1, 1 + v), slice(1 + v, -1), slice(-1, None))):
                weights = rng.uniform(-1, 1, records[:, columns].shape) * (rng.random(records[:, columns].shape) < 0.8)
                weights[:, 0] = np.where(weights.any(-1), weights[:, 0], 1)
                records[:, columns] = size[:, part, None] * weights / np.abs(weights).sum(-1, keepdims=True)
        records[:, -1] = np.abs(records[:, -1])
        if self.executed:  # as results of executions have: about some float32 numbers
            with np.errstate(over="ignore", invalid="ignore"):
                records[:, 0] = records[:, 0].astype(np.float32)
                rounding = 10.0 ** rng.uniform(-7.5, -5, n) * np.abs(records[:, :-1]).sum(-1)
            records[:, -1] += np.where(rng.random(n) < 0.5, rounding, 0)
        return np.where(np.isfinite(records), records, 0)

    def cells(self, centers: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> Records:
        records = np.zeros((len(centers), self.width))
        records[:, 0] = centers
        records[:, 1 : 1 + self.variables] = slopes
        records[:, 1 + self.variables] = bends
        return records

    def variable(self, i: int, low: np.ndarray, high: np.ndarray) -> tuple[Records, np.ndarray, np.ndarray]:
        center, radius = cell_between(low, high)
        records = np.zeros((len(low), self.width))
        records[:, 0], records[:, 1 + i] = center, radius
        return records, center, radius

    def _polynomials(self, records: Records, points: np.ndarray) -> Balls:
        v = self.variables
        pairs = [(i, i) for i in range(v)] + [(i, j) for i in range(v) for j in range(i + 1, v)]
        x = [[Ball(c) for c in point] for point in points]
        monomials = [[Ball(1), *point, *(point[i] * point[j] for i, j in pairs)] for point in x]
        rows = flint.arb_mat(records[:, :-1].tolist()) * flint.arb_mat(monomials).transpose()
        return [[rows[i, j] for j in range(len(points))] for i in range(len(records))]

    def values(self, records: Records, points: np.ndarray, offsets: np.ndarray) -> Balls:
        remainders = records[:, -1].tolist()
        return [
            [p + Ball(t) * r if t and r else p for p, t in zip(row, ts)]
            for row, r, ts in zip(self._polynomials(records, points), remainders, offsets.tolist())
        ]

    def is_canonical(self, records: Records) -> np.ndarray:
        unknown = records[:, -1] == INF
        return np.where(unknown, (records[:, :-1] == 0).all(-1), np.isfinite(records).all(-1)) & (records[:, -1] >= 0)

    def is_bounded(self, records: Records) -> np.ndarray:
        return records[:, -1] < INF

    def ranges(self, records: Records) -> np.ndarray:
        return np.asarray(_core.taylor_ranges(self.name, np.ascontiguousarray(records)))[:, :2]

    def part(self, records: Records, rng: np.random.Generator) -> Records:
        v = self.variables
        half = rng.uniform(0, 1, v)
        half[rng.random(v) < 0.3] = 0
        middle = (1 - half) * rng.uniform(-1, 1, v)
        zeros, ones = np.zeros(v), np.ones(v)
        maps = (zeros, ones, zeros, np.eye(v), middle, half * (1 - 2.0**-50), True)
        return np.asarray(_core.taylor_substituted(self.name, np.ascontiguousarray(records), *maps))

    def special(self) -> Records:
        rows = []
        for place in [*PLACES, *FAR_PLACES]:
            for slope, bend, remainder in (
                (0.0, 0.0, 0.0),
                (0.0, 0.0, abs(place)),
                (place, 0.0, 0.0),
                (0.7 * place, 0.0, 1e-9),
                (0.3, 0.0, 0.0),
                (TINY, TINY, TINY),
                (0.0, place, 0.0),
                (0.0, 0.0, INF),
            ):
                row = np.zeros(self.width)
                row[[0, 1, 2, 1 + self.variables, -1]] = place, slope / 2, slope / 2, bend, remainder
                rows.append(row)
        for size in (1e30, 1e154, 1.2e308, 700.0, 1e-160, 1e-310):  # far larger than their center
            row = np.zeros(self.width)
            row[[0, 1, -1]] = 0.3 * size, size, size / 1e9
            rows.append(row)
        records = np.array(rows)
        records[np.isinf(records[:, -1]), :-1] = 0
        return records


@dataclass
class FloatKind:
    """Plain floating point: no enclosure, but a bound of error in units in the last place."""

    name: str
    dtype: type

    def __repr__(self) -> str:
        return self.name


FLOATS = [FloatKind("float32", np.float32), FloatKind("float64", np.float64)]
KINDS: list[Kind] = [
    IntervalKind("interval_float64"),
    IntervalKind("interval_float32", dtype=np.float32),
    IntervalKind("interval_float64_executed", executed=True),
    IntervalKind("interval_float32_executed", dtype=np.float32, executed=True),
    RunningErrorKind("running_error_float64", np.float64),
    RunningErrorKind("running_error_float32", np.float32),
    *(LinearKind(f"linear_{n}_{rule}", variables=n) for n in (1, 2, 3, 4) for rule in ("hansen", "second-order")),
    TaylorKind("taylor_2_real", variables=2),
    TaylorKind("taylor_4_real", variables=4),
    TaylorKind("taylor_2_float32", variables=2, executed=True),
    TaylorKind("taylor_4_float32", variables=4, executed=True),
]
