"""Programs over the cells of a time grid, for casadi's conic door to PIQP: the same rows and unknowns in every cell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import casadi
import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array

#: Lower and upper bounds.
Box: TypeAlias = tuple[Array, Array]


@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """A solver for one number of cells; it is used again and again with other numbers.

    ``rows``, ``columns`` : (m,) where the coefficients are, cell by cell.
    """

    rows: npt.NDArray[np.intp]
    columns: npt.NDArray[np.intp]
    order: npt.NDArray[np.intp]
    pattern: Any
    diagonal: Any
    solver: Any

    def solve(self, weight: Array, gradient: Array, values: Array, rows: Box, box: Box) -> tuple[Array, Array]:
        """The unknowns, and the multipliers of the rows; both are whatever the solver returns.

        Parameters
        ----------
        weight, gradient : of the squared unknowns, by halves, and of the unknowns.
        values : (m,) of the coefficients; ``rows``, ``box`` : bounds of the rows and of the unknowns.
        """
        solution = self.solver(
            h=casadi.DM(self.diagonal, weight),
            g=gradient,
            a=casadi.DM(self.pattern, values[self.order]),
            lba=rows[0],
            uba=rows[1],
            lbx=box[0],
            ubx=box[1],
        )
        return np.asarray(solution["x"]).ravel(), np.asarray(solution["lam_a"]).ravel()

    @property
    def is_solved(self) -> bool:
        """Whether the last call met the solver's tolerances."""
        return bool(self.solver.stats()["success"])


def program(
    name: str, places: Sequence[tuple[int, int]], cells: int, *, rows: int, unknowns: int, more: int, rounds: int
) -> Program:
    """A program with the same coefficients in every cell.

    Parameters
    ----------
    places : row and column of each coefficient of a cell, from the cell's own first ones on; column -1 is the last
        unknown of all.
    rows, unknowns : of a cell; ``more`` : unknowns after those of the last cell.
    rounds : iterations at most.
    """
    place, k, count = np.array(places), np.arange(cells)[:, None], unknowns * cells + more
    at = (rows * k + place[:, 0]).ravel()
    columns = np.where(place[:, 1] < 0, count - 1, unknowns * k + place[:, 1]).ravel()
    order = np.lexsort((at, columns))  # casadi keeps columns one after the other
    starts = np.searchsorted(columns[order], np.arange(count + 1))
    pattern = casadi.Sparsity(rows * cells, count, starts.tolist(), at[order].tolist())
    diagonal = casadi.Sparsity.diag(count)
    options: dict[str, Any] = {
        "error_on_fail": False,
        "print_time": False,
        "piqp": {"max_iter": rounds, "verbose": False},
    }
    solver = casadi.conic(name, "piqp", {"h": diagonal, "a": pattern}, options)
    return Program(at, columns, order, pattern, diagonal, solver)
