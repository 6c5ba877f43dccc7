"""Linear intervals and Taylor models: functions over a cell."""

from __future__ import annotations

import flint
import numpy as np
from tests.numbers.conformance.kind import FAR_PLACES, INF, PLACES, TINY, Ball, Balls, Kind, Records, spread

from raybound import _core


def cell_between(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Center and radius of cells that hold [low, high]."""
    center = 0.5 * low + 0.5 * high
    radius = np.maximum(np.nextafter(high - center, np.inf), np.nextafter(center - low, np.inf))
    return center, np.where(low == high, 0, radius)


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
                width = min(width, np.finfo(np.float64).max - abs(place))
                constant = np.array([[place - width, place + width]])
                slopes = np.full((1, self.variables, 2), [slope - width, slope + width]) / self.variables
                rows.append(self._make(constant, slopes)[0])
        return np.array(rows)


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
