"""What the suite asks of a kind of number: operands, the values they may stand for, what a result promises."""

from __future__ import annotations

from collections.abc import Sequence

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
