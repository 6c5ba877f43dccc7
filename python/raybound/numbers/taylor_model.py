"""Quadratic polynomials with a certified remainder."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core, _validate
from .base import KINDS, plain
from .cell_number import Cell, CellNumber, make_cell
from .interval import KIND, Interval

ARITHMETICS = ("real", "float32")


class TaylorModel(CellNumber):
    """A function over a cell: a quadratic polynomial and a bound of all that it leaves out, or an array of them.

    Made by `TaylorModel.variables` and by operations on them. In the normalised variables
    xi_i = (x_i - center_i) / radius_i the function lies within `remainder` of
    constant + sum linear_i xi_i + sum_{i<=j} quadratic_ij xi_i xi_j, everywhere on the cell. The roundings of the
    coefficients are in the remainder. With arithmetic "float32" the remainder also covers a float32 execution: the
    model then holds both the real value and what the same operations in the same order give in float32, plain numbers
    rounded to it (certified-interpolants.md, sections 2 and 9). Where nothing can be said (a root of what may be
    negative) the remainder is infinite, and stays so.
    """

    __slots__ = ()

    @classmethod
    def variables(
        cls, centers: npt.ArrayLike, radii: npt.ArrayLike, *, arithmetic: str = "real"
    ) -> tuple[TaylorModel, ...]:
        """The N = 2 or 4 coordinates x_i of the cell |x_i - center_i| <= radius_i as models.

        `centers`: (..., N), for as many cells at once; `radii`: broadcasts with it, >= 0. `arithmetic`: "real" or
        "float32". ValueError for other numbers of variables, NaN and infinities.
        """
        _validate.choice("TaylorModel", "arithmetic", arithmetic, ARITHMETICS)
        cell = make_cell("TaylorModel", centers, radii, (2, 4))
        n = cell[0].shape[-1]
        kind = f"taylor_{n}_{arithmetic}"
        records = np.zeros((n, *cell[0].shape[:-1], KINDS[kind][0]))
        for i in range(n):
            records[i, ..., 0] = cell[0][..., i]
            records[i, ..., 1 + i] = cell[1][..., i]
        return tuple(cls._made(kind, part, cell) for part in records)

    @property
    def _n(self) -> int:
        return int(self._cell[0].shape[-1])

    def _set_constant(self, records: npt.NDArray[np.float64], values: npt.NDArray[np.float64]) -> None:
        records[..., 0] = values
        if self.arithmetic == "float32":  # an execution has the nearest float instead
            with np.errstate(over="ignore"):
                records[..., -1] = np.abs(values - values.astype(np.float32))  # exact

    def _set_interval(self, records: npt.NDArray[np.float64], interval: Interval) -> None:
        records[..., 0] = interval.mid
        records[..., -1] = interval.rad

    @property
    def arithmetic(self) -> str:
        """Whose results the remainder covers: "real" or "float32"."""
        return self._kind.rsplit("_", 1)[1]

    @property
    def constant(self) -> Any:
        """The polynomial's constant term."""
        return self._records[..., 0].copy()[()]

    @property
    def linear(self) -> npt.NDArray[np.float64]:
        """The coefficients of the normalised variables, (..., N)."""
        return self._records[..., 1 : 1 + self._n].copy()

    @property
    def quadratic(self) -> npt.NDArray[np.float64]:
        """The coefficients of their products, (..., N, N): squares on the diagonal, mixed terms above it."""
        n = self._n
        matrix = np.zeros((*self.shape, n, n))
        matrix[..., range(n), range(n)] = self._records[..., 1 + n : 1 + 2 * n]
        matrix[(..., *np.triu_indices(n, 1))] = self._records[..., 1 + 2 * n : -1]
        return matrix

    @property
    def remainder(self) -> Any:
        """The bound of what the polynomial leaves out; infinity where nothing is known."""
        return self._records[..., -1].copy()[()]

    def _ranges(self) -> npt.NDArray[np.float64]:
        ranges: npt.NDArray[np.float64] = _core.taylor_ranges(self._kind, np.ascontiguousarray(self._records))
        return ranges.reshape(*self.shape, 3)

    def range(self) -> Interval:
        """All values over the cell."""
        return Interval._made(KIND[np.dtype(np.float64)], self._ranges()[..., :2].copy())

    def interpolation_bound(self) -> Any:
        """How far the multilinear interpolant of the cell's corners can be from the function, anywhere in the cell.

        Mixed terms are interpolated exactly; only pure squares and the remainder count (certified-interpolants.md,
        section 2).
        """
        return self._ranges()[..., 2].copy()[()]

    def __call__(self, x: npt.ArrayLike) -> Interval:
        """Enclosures of the function at points `x`, (..., N), in the variables' own units, in the cell.

        Broadcasts with the models: a grid of points for one model, a point for each of an array of models. ValueError
        for points outside.
        """
        points = np.asarray(plain("TaylorModel", "x", x), np.float64)
        n = self._n
        if not points.ndim or points.shape[-1] != n:
            raise ValueError(f"TaylorModel: x must have shape (..., {n}), got {points.shape}")
        shape = np.broadcast_shapes(points.shape[:-1], self.shape, self._cell[0].shape[:-1])
        parts = (self._records, *self._cell, points)
        flat = [np.ascontiguousarray(np.broadcast_to(part, (*shape, part.shape[-1]))) for part in parts]
        ends = _core.taylor_values(self._kind, *flat)
        return Interval._made(KIND[np.dtype(np.float64)], ends.reshape(*shape, 2))

    def restrict(self, centers: npt.ArrayLike, radii: npt.ArrayLike) -> TaylorModel:
        """The same function over a part of the cell. ValueError if it is not a part, or for an array of cells."""
        middle, given = make_cell("TaylorModel", centers, radii, (self._n,), enlarge="not")
        self._one_cell(middle)
        half = _core.part_radii(*self._cell, middle, given)
        if (half < 0).any():
            i = int(np.argmax(half < 0))
            raise ValueError(
                f"TaylorModel: centers and radii must be a part of the cell, {self._cell[0][i]:.9g} +- "
                f"{self._cell[1][i]:.9g} along variable {i}, got {middle[i]:.9g} +- {given[i]:.9g}"
            )
        half.flags.writeable = False
        return self._substituted(np.zeros(self._n), np.eye(self._n), (middle, half), is_part=True)

    def substitute(
        self, constants: npt.ArrayLike, slopes: npt.ArrayLike, centers: npt.ArrayLike, radii: npt.ArrayLike
    ) -> TaylorModel:
        """The function of new variables y (2 or 4 of them), on which x = constants + slopes y depends.

        `constants`: (N,); `slopes`: (N, M), M = 2 or 4; the new cell is |y_j - center_j| <= radius_j, whose image must
        lie in the old cell (ValueError otherwise). So one fixes a coordinate (a row of zeros), or makes one a function
        of others, as a fixed eye does (certified-interpolants.md, section 5).
        """
        cell = make_cell("TaylorModel", centers, radii, (2, 4), enlarge="derived")
        start = np.asarray(plain("TaylorModel", "constants", constants), np.float64)
        matrix = np.asarray(plain("TaylorModel", "slopes", slopes), np.float64)
        m = cell[0].shape[-1]
        if start.shape != (self._n,) or matrix.shape != (self._n, m):
            raise ValueError(
                f"TaylorModel: constants must have shape ({self._n},) and slopes ({self._n}, {m}), "
                f"got {start.shape} and {matrix.shape}"
            )
        self._one_cell(cell[0])
        return self._substituted(start, matrix, cell, is_part=False)

    def _one_cell(self, centers: npt.NDArray[np.float64]) -> None:
        if self._cell[0].ndim != 1 or centers.ndim != 1:
            raise ValueError("TaylorModel: only models over one cell can be restricted or substituted")

    def _substituted(
        self, constants: npt.NDArray[np.float64], slopes: npt.NDArray[np.float64], cell: Cell, *, is_part: bool
    ) -> TaylorModel:
        kind = f"taylor_{cell[0].shape[-1]}_{self.arithmetic}"
        models = np.ascontiguousarray(self._records)
        records = _core.taylor_substituted(self._kind, models, *self._cell, constants, slopes, *cell, is_part)
        return self._made(kind, records.reshape(*self.shape, KINDS[kind][0]), cell)

    def __repr__(self) -> str:
        if self.ndim:
            return f"<TaylorModel array of shape {self.shape}, {self._n} variables, {self.arithmetic}>"
        return f"<TaylorModel {self.constant:.9g}, linear {self.linear.tolist()}, remainder {self.remainder:.3g}>"
