"""Intervals and running errors: values between two ends."""

from __future__ import annotations

import numpy as np
from tests.numbers.conformance.kind import FAR_PLACES, INF, PLACES, Ball, Balls, Kind, Records, spread


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
        with np.errstate(invalid="ignore"):
            value = np.clip(ends[:, :1] / 2 + ends[:, 1:] / 2, ends[:, :1], ends[:, 1:])
        return np.concatenate([value, ends], -1)

    def is_canonical(self, records: Records) -> np.ndarray:
        return records[:, 1] <= records[:, 2]

    def special(self) -> Records:
        records = super().special()
        return np.ascontiguousarray(records[np.isfinite(records).all(-1) & (records[:, 1] <= records[:, 2])])
