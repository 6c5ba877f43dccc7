"""Numbers that depend on variables over a cell: what linear intervals and Taylor models have in common."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core, _validate
from .base import Number, broadcast, plain
from .interval import Interval

Cell = tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]


def make_cell(
    who: str, centers: npt.ArrayLike, radii: npt.ArrayLike, dimensions: tuple[int, ...], *, enlarge: str = "new"
) -> Cell:
    """The cells |x_i - center_i| <= radius_i as float64 arrays (..., N). ValueError for negative or infinite radii.

    Radii are enlarged by about 2^-40 of themselves, so that what rounds to an end of the cell, as its user computes it,
    lies in it; a radius of 0 stays 0.
    """
    middle = np.asarray(plain(who, "centers", centers), np.float64)
    half = np.asarray(plain(who, "radii", radii), np.float64)
    if not middle.ndim or middle.shape[-1] not in dimensions:
        wanted = " or ".join(f"(..., {n})" for n in dimensions)
        raise ValueError(f"{who}: centers must have shape {wanted}, got {middle.shape}")
    middle, half = broadcast(who, centers=middle, radii=half)
    if (half < 0).any():
        raise ValueError(f"{who}: radii must be >= 0, got {_validate._culprit(half, half >= 0)}")
    middle = np.array(middle)  # the caller's own stays as it is
    if enlarge == "not":
        return middle, np.ascontiguousarray(half)
    wider: npt.NDArray[np.float64] = _core.cell_radii(middle, np.ascontiguousarray(half), enlarge == "derived").reshape(
        middle.shape
    )
    middle.flags.writeable = wider.flags.writeable = False
    return middle, wider


class CellNumber(Number):
    """A number for every point of a cell (or an array of them, each with its cell)."""

    __slots__ = ("_cell",)

    _rank = 1
    _cell: Cell

    def _adopt(self, template: Any) -> None:
        if isinstance(template, tuple) and isinstance(template[0], CellNumber):  # an element of an array
            source, where = template
            cell = source._cell
            if cell[0].ndim > 1:  # a cell for each
                whole = [np.broadcast_to(part, (*source.shape, part.shape[-1])) for part in cell]
                cell = (whole[0][(*where, slice(None))], whole[1][(*where, slice(None))])
            self._cell = cell
        elif isinstance(template, tuple):
            self._cell = template
        else:
            self._cell = template._cell
        for part in self._cell:  # pickles and some indexed arrays come writeable
            part.flags.writeable = False

    def _extra(self) -> Cell:
        return self._cell

    def _lift(self, value: object, who: str, name: str) -> Number:
        if isinstance(value, CellNumber):
            if value._kind != self._kind:
                raise TypeError(f"{who}: operands must be of one kind, got {self._kind} and {value._kind}")
            if value._cell is not self._cell and not all(map(np.array_equal, value._cell, self._cell)):
                raise ValueError(f"{who}: both operands must be functions over the same cell")
            return value
        if isinstance(value, Interval):
            if not np.isfinite(value.mag).all():
                raise ValueError(f"{who}: {name} must be bounded and not empty, got {value!r}")
            records = np.zeros((*value.shape, self._records.shape[-1]))
            self._set_interval(records, value)
            return self._made(self._kind, records, self)
        array = np.asarray(plain(who, name, value), np.float64)
        records = np.zeros((*array.shape, self._records.shape[-1]))
        self._set_constant(records, array)
        return self._made(self._kind, records, self)

    def _set_constant(self, records: npt.NDArray[np.float64], values: npt.NDArray[np.float64]) -> None:
        records[..., 0] = values

    def _set_interval(self, records: npt.NDArray[np.float64], interval: Interval) -> None:
        raise NotImplementedError  # pragma: no cover - every class has its own

    def __eq__(self, other: object) -> bool:
        return Number.__eq__(self, other) is True and all(map(np.array_equal, self._cell, other._cell))  # type: ignore[attr-defined]

    __hash__ = Number.__hash__

    @property
    def centers(self) -> npt.NDArray[np.float64]:
        """The middle of the cell, (..., N)."""
        return self._cell[0]

    @property
    def radii(self) -> npt.NDArray[np.float64]:
        """Half the cell's size along each variable, (..., N)."""
        return self._cell[1]
