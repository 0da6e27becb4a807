"""Quadratic programs put together term by term, with no more rows than they need, for casadi's conic door to PIQP."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import casadi
import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array

Columns: TypeAlias = npt.NDArray[np.intp]

#: Columns (m,) of one unknown in each of m rows, -1 where it is known to be zero, and its coefficients (m,) there.
Term: TypeAlias = tuple[Columns, Array | float]

#: PIQP needs a little curvature everywhere; this is too little to move a solution visibly.
_DIAGONAL = 1e-7

#: Iterations at most; twice as many for large programs, with more unknowns than this.
_MOST, _LARGE = 60, 2000

#: Tolerances of PIQP where a solution is only a step on the way to the next.
COARSE = {"eps_abs": 1e-6, "eps_rel": 1e-7, "eps_duality_gap_abs": 1e-6, "eps_duality_gap_rel": 1e-6}


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What the solver returns for the unknowns, and for the multipliers of the rows; whether it met its tolerances."""

    x: Array
    multipliers: Array
    is_solved: bool


class Assembly:
    """A convex quadratic program in the making: the sum of squares, costs, rows and boxes.

    Parameters
    ----------
    unknowns : how many there are; those without a box are free.
    diagonal : what every squared unknown costs, by halves.
    """

    def __init__(self, unknowns: int, diagonal: float = _DIAGONAL) -> None:
        self.count, self.diagonal = unknowns, diagonal
        self.low, self.high = np.full(unknowns, -np.inf), np.full(unknowns, np.inf)
        self.cost = np.zeros(unknowns)
        self._rows: list[tuple[Columns, Columns, Array]] = []
        self._squares: list[tuple[Columns, Columns, Array]] = []
        self._bounds: list[tuple[Array, Array]] = []
        self._height = 0

    def rows(self, low: Array, high: Array, *terms: Term) -> None:
        """Further rows (m,): the sum of the terms is between ``low`` and ``high``; one of them is finite in each."""
        rows = self._height + np.arange(len(low))
        self._height += len(low)
        self._bounds.append((low, high))
        self._rows += [_known(rows, columns, values) for columns, values in terms]

    def squares(self, weights: Array, *terms: Term) -> None:
        """Further costs, by halves: the weighted (m,) squares of the sums of the terms."""
        for own, value in terms:
            for other, factor in terms:
                here = own >= 0
                self._squares.append(_known(own[here], other[here], (weights * value * factor)[here]))

    def box(self, columns: Columns, low: Array | float, high: Array | float) -> None:
        """Bounds of unknowns, beside those that they have; columns of -1 are passed over."""
        here = columns >= 0
        columns = columns[here]
        self.low[columns] = np.maximum(self.low[columns], np.broadcast_to(low, here.shape)[here])
        self.high[columns] = np.minimum(self.high[columns], np.broadcast_to(high, here.shape)[here])

    def solve(self, tolerances: Mapping[str, float] | None = None, most: int = _MOST) -> Solution:
        """What the solver finds in at most so many iterations."""
        each = np.arange(self.count)
        squares = _matrix([*self._squares, (each, each, np.full(self.count, self.diagonal))], self.count, self.count)
        rows = _matrix(self._rows, self._height, self.count)
        options: dict[str, Any] = {
            "max_iter": 2 * most if self.count > _LARGE else most,
            "verbose": False,
            "kkt_solver": "sparse_ldlt_ineq_cond",
            **(tolerances or {}),
        }
        solver = casadi.conic(
            "assembly",
            "piqp",
            {"h": squares.sparsity(), "a": rows.sparsity()},
            {"error_on_fail": False, "print_time": False, "piqp": options},
        )
        low, high = self._row_bounds()
        found = solver(h=squares, g=self.cost, a=rows, lba=low, uba=high, lbx=self.low, ubx=self.high)
        x, multipliers = np.asarray(found["x"]).ravel(), np.asarray(found["lam_a"]).ravel()
        return Solution(x, multipliers, bool(solver.stats()["success"]))

    def least_cost(self, multipliers: Array) -> float:
        """A bound that no choice of the unknowns beats, the squares left out, from whatever multipliers of the rows.

        It is the dual function; every unknown must have a box.
        """
        low, high = self._row_bounds()
        multipliers = np.where(np.isfinite(high), multipliers, np.minimum(multipliers, 0.0))
        multipliers = np.where(np.isfinite(low), multipliers, np.maximum(multipliers, 0.0))
        rows, columns, values = (np.concatenate(parts) for parts in zip(*self._rows, strict=True))
        reduced = self.cost + np.bincount(columns, values * multipliers[rows], minlength=self.count)
        return _least(reduced, self.low, self.high) + _least(-multipliers, low, high)

    def _row_bounds(self) -> tuple[Array, Array]:
        low, high = (np.concatenate(bounds) for bounds in zip(*self._bounds, strict=True))
        return low, high


def _least(weights: Array, low: Array, high: Array) -> float:
    """The least sum of weights (m,) times values that lie between ``low`` and ``high`` (m,)."""
    bounds = np.where(weights > 0, low, high)
    return math.fsum(np.multiply(weights, bounds, out=np.zeros_like(weights), where=weights != 0).tolist())


def _known(rows: Columns, columns: Columns, values: Array | float) -> tuple[Columns, Columns, Array]:
    here = columns >= 0
    return rows[here], columns[here], np.broadcast_to(values, columns.shape)[here]


def _matrix(entries: list[tuple[Columns, Columns, Array]], height: int, width: int) -> Any:
    """The casadi matrix with these entries; those at the same place are added."""
    rows, columns, values = (np.concatenate(parts) for parts in zip(*entries, strict=True))
    places = columns * height + rows  # casadi keeps columns one after the other
    order = np.argsort(places, kind="stable")
    places = places[order]
    first = np.flatnonzero(np.diff(places, prepend=-1))
    places, values = places[first], np.add.reduceat(values[order], first)
    starts = np.searchsorted(places, height * np.arange(width + 1))
    return casadi.DM(casadi.Sparsity(height, width, starts.tolist(), (places % height).tolist()), values)
