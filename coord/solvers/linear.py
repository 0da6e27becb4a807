"""Jerk-limited motion inside bounds, on a fixed time grid, as a linear program."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers.conic import Program, program

#: Programs are rounded up to these numbers of cells, so that few solvers are built.
SIZES = (8, 12, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 256, 320, 384, 512)

#: The same for the finest grids.
LARGE_SIZES = (*SIZES, 768, 1024, 1536, 2048)

#: PIQP needs a little curvature everywhere; this is too little to move a solution visibly.
_DIAGONAL = 1e-7

#: [m] Where no bound on s is set, these much beyond what speed allows are: rows without any finite bound make
#: PIQP print, and bounds far away (1e7 m) make it run out of iterations.
_BEYOND = 1.0

#: [m/s] Between departure and arrival the program's robot creeps at least this fast, so that rounding
#: cannot make it move backwards.
CREEP = 1e-7

#: Row and column of each coefficient of a cell. Columns: 0..3 are s, v, a, j of the cell, 4..6 the next s, v, a. Rows:
#: three equations of motion, the two inner Bezier points of s, the middle one of v.
_PLACES = (
    (0, 4), (0, 0), (0, 1), (0, 2), (0, 3),
    (1, 5), (1, 1), (1, 2), (1, 3),
    (2, 6), (2, 2), (2, 3),
    (3, 0), (3, 1), (4, 0), (4, 1), (4, 2), (5, 1), (5, 2),
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """N time cells with constant jerk each.

    Parameters
    ----------
    h : (N,) durations [s]; N is one of LARGE_SIZES.
    upper, lower : (N, 4) bounds [m] on the Bezier points of s in each cell.
    caps : (N,) largest speed [m/s] in each cell.
    """

    h: Array
    upper: Array
    lower: Array
    caps: Array


def farthest(cells: Cells, limits: Limits) -> float | None:
    """How far [m] the robot can come to rest at the end of the cells, from rest at 0; None where no motion is found."""
    way = farthest_way(cells, limits)
    return None if way is None else float(way[-1, 0])


def farthest_way(cells: Cells, limits: Limits) -> Array | None:
    """States (N+1, 3) at the knots of the motion that comes to rest as far away as can be, if one is found."""
    solution = _solve(cells, limits, None)
    return None if solution is None else np.append(solution, 0.0).reshape(-1, 4)[:, :3].copy()


def smoothest(cells: Cells, limits: Limits, length: float, ease: float = 0.0) -> Array | None:
    """Jerks (N,) of the motion from rest at 0 to rest at ``length`` with the least squared jerk, if one is found.

    ``ease`` : weight [1/s2] of the squared acceleration beside the squared jerk.
    """
    solution = _solve(cells, limits, length, ease)
    return None if solution is None else solution[:-3].reshape(-1, 4)[:, 3].copy()


def _solve(cells: Cells, limits: Limits, length: float | None, ease: float = 0.0) -> Array | None:
    """Unknowns s, v, a, j for each cell, then the last s, v, a."""
    n = len(cells.h)
    box, row_box = _variable_bounds(cells, limits, length), _row_bounds(cells, _farthest_end(cells, limits))
    if np.any(box[0] > box[1]) or np.any(row_box[0] > row_box[1]):
        return None
    weight = np.full(4 * n + 3, _DIAGONAL)
    gradient = np.zeros(4 * n + 3)
    if length is None:
        gradient[-3] = -1.0
    else:
        weight[3:-3:4] += cells.h
        weight[2:-3:4] += ease * cells.h
    motion = _program(n)
    x, _ = motion.solve(weight, gradient, _coefficients(cells.h), row_box, box)
    return x if motion.is_solved else None


def _variable_bounds(cells: Cells, limits: Limits, length: float | None) -> tuple[Array, Array]:
    n = len(cells.h)
    low, high = np.empty((n + 1, 4)), np.empty((n + 1, 4))
    low[:, 0], high[:, 0] = -_BEYOND, _farthest_end(cells, limits)
    np.maximum(low[:-1, 0], cells.lower[:, 0], out=low[:-1, 0])
    np.maximum(low[1:, 0], cells.lower[:, 3], out=low[1:, 0])
    np.minimum(high[:-1, 0], cells.upper[:, 0], out=high[:-1, 0])
    np.minimum(high[1:, 0], cells.upper[:, 3], out=high[1:, 0])
    low[:, 1], high[:, 1] = CREEP, limits.speed
    np.minimum(high[:-1, 1], cells.caps, out=high[:-1, 1])
    np.minimum(high[1:, 1], cells.caps, out=high[1:, 1])
    low[:, 2], high[:, 2] = -limits.deceleration, limits.acceleration
    low[:, 3], high[:, 3] = -limits.jerk, limits.jerk
    low[0, :3] = high[0, :3] = 0.0
    low[n, 1:3] = high[n, 1:3] = 0.0
    if length is not None:
        low[n, 0] = high[n, 0] = length
    return low.ravel()[:-1], high.ravel()[:-1]


def _farthest_end(cells: Cells, limits: Limits) -> float:
    """An arc length [m] that no motion gets to."""
    return limits.speed * float(cells.h.sum()) + _BEYOND


def _row_bounds(cells: Cells, end: float) -> tuple[Array, Array]:
    """Three equations of motion a cell, then the two inner Bezier points of s and the middle one of v."""
    n = len(cells.h)
    low, high = np.zeros((n, 6)), np.zeros((n, 6))
    low[:, 3:5], high[:, 3:5] = np.maximum(cells.lower[:, 1:3], -_BEYOND), np.minimum(cells.upper[:, 1:3], end)
    low[:, 5], high[:, 5] = CREEP, cells.caps
    low[[0, -1], 5] = -CREEP  # at rest at both ends
    return low.ravel(), high.ravel()


def _coefficients(h: Array) -> Array:
    """Values of the rows' coefficients, cell by cell, in the order of ``_PLACES``."""
    one = np.ones_like(h)
    dynamics = [one, -one, -h, -(h**2) / 2, -(h**3) / 6, one, -one, -h, -(h**2) / 2, one, -one, -h]
    bezier = [one, h / 3, one, 2 * h / 3, h**2 / 6, one, h / 2]
    return np.stack(dynamics + bezier, axis=1).ravel()


@lru_cache(maxsize=64)
def _program(n: int) -> Program:
    return program("motion", _PLACES, n, rows=6, unknowns=4, more=3, rounds=45)
