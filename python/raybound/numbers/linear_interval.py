"""Linear bounds of functions over a cell."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _validate
from .base import KINDS, apply
from .cell_number import CellNumber, make_cell
from .interval import KIND, Interval

RULES = ("hansen", "second-order")


class LinearInterval(CellNumber):
    """A function over a cell, between linear bounds: Hansen's generalised interval (thesis 4.3.5), or an array of them.

    Made by `LinearInterval.variables` and by operations on them. In the normalised variables
    xi_i = (x_i - center_i) / radius_i the function lies in constant + sum slopes_i xi_i, everywhere on the cell, where
    `constant` and `slopes` are intervals. Ends are rounded outward. Where nothing can be said (a root of what may be
    negative) the constant is the entire line, and stays so.
    """

    __slots__ = ()

    @classmethod
    def variables(
        cls, centers: npt.ArrayLike, radii: npt.ArrayLike, *, rule: str = "second-order"
    ) -> tuple[LinearInterval, ...]:
        """The N = 1 to 4 coordinates x_i of the cell |x_i - center_i| <= radius_i as linear intervals.

        `centers`: (..., N), for as many cells at once; `radii`: broadcasts with it, >= 0. `rule`: how functions are
        bounded, "hansen" (first order) or "second-order" (thesis 4.3.6). ValueError for other numbers of variables, NaN
        and infinities.
        """
        _validate.choice("LinearInterval", "rule", rule, RULES)
        cell = make_cell("LinearInterval", centers, radii, (1, 2, 3, 4))
        n = cell[0].shape[-1]
        kind = f"linear_{n}_{rule}"
        records = np.zeros((n, *cell[0].shape[:-1], KINDS[kind][0]))
        for i in range(n):
            records[i, ..., 0:2] = cell[0][..., i, np.newaxis]
            records[i, ..., 2 + 2 * i : 4 + 2 * i] = cell[1][..., i, np.newaxis]
            records[i, ..., -2:] = [-np.inf, np.inf]  # to be intersected with what constant and slopes say
        return tuple(cls._made(kind, apply(kind, "settled", [part]), cell) for part in records)

    def _set_constant(self, records: npt.NDArray[np.float64], values: npt.NDArray[np.float64]) -> None:
        records[..., 0:2] = values[..., np.newaxis]
        records[..., -2:] = values[..., np.newaxis]

    def _set_interval(self, records: npt.NDArray[np.float64], interval: Interval) -> None:
        ends = np.stack([interval.inf, interval.sup], axis=-1)
        records[..., 0:2] = ends
        records[..., -2:] = ends

    @property
    def rule(self) -> str:
        """How functions are bounded: "hansen" or "second-order"."""
        return self._kind.rsplit("_", 1)[1]

    def _interval(self, ends: npt.NDArray[np.float64]) -> Interval:
        return Interval._made(KIND[np.dtype(np.float64)], ends.copy())

    @property
    def constant(self) -> Interval:
        """The constant term."""
        return self._interval(self._records[..., 0:2])

    @property
    def slopes(self) -> Interval:
        """The coefficients of the normalised variables, (..., N)."""
        ends = self._records[..., 2:-2]
        return self._interval(ends.reshape(*self.shape, -1, 2))

    def range(self) -> Interval:
        """All values over the cell."""
        return self._interval(self._records[..., -2:])

    def _bounds(self) -> npt.NDArray[np.float64]:
        bounds: npt.NDArray[np.float64] = apply(self._kind, "bounds", [self._records])
        return bounds

    def corner_bound(self) -> Any:
        """The width of the linear bounds at the corner where they are widest (thesis 4.3.5)."""
        return self._bounds()[..., 1].copy()[()]

    def interpolation_bound(self) -> Any:
        """How far the multilinear interpolant of the cell's corners can be from the function, anywhere in the cell."""
        return self._bounds()[..., 0].copy()[()]

    def __repr__(self) -> str:
        if self.ndim:
            return f"<LinearInterval array of shape {self.shape}, {self.rule}>"
        slopes = ", ".join(map(repr, self.slopes))
        return f"<LinearInterval {self.constant!r}, slopes {slopes}>"
