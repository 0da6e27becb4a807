"""For proofs: how far any jerk-limited motion could get, bounded from above.

Between the knots of a time grid the jerk may be any function within its limit. All that is kept of it are its
first three Legendre moments, each with the most that it can be; speed and acceleration limits are kept at the knots
and on average, the bounds on s at the knots alone. So every motion within the limits is a solution of the program,
but not the other way round. What the solver returns is not trusted: its multipliers, whatever they are, are put into
the dual function, and since all variables are boxed, weak duality makes that a bound.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers import conic
from coord.solvers.conic import Program

#: Programs have one of these numbers of cells, so that few solvers are built.
SIZES = (8, 12, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 256, 320, 384, 512)

#: [1] A metre that lacks at a lower bound costs as much as so many metres that lack at the end.
_PENALTY = 4.0

#: PIQP needs a little curvature everywhere.
_DIAGONAL = 1e-9

#: Means over [-1, 1] of |P1| and |P2|, the second and third Legendre polynomial; the latter is rounded up.
_MEAN_P1, _MEAN_P2 = 0.5, 0.38491

#: [m] More than what rounding can do to the dual function.
_ROUNDING = 1e-8

#: Row and column of each coefficient of a cell. Columns: 0..5 are s, v, a and the moments of the cell, 6..8 the next
#: s, v, a, and -1 is what lacks. Rows: three equations of motion; mean speed; lower bound on s; speed over s; four
#: pairs of moments; mean acceleration, over the whole cell and weighted towards its beginning and its end.
_PLACES = (
    (0, 6), (0, 0), (0, 1), (0, 2), (0, 3), (0, 4), (0, 5),
    (1, 7), (1, 1), (1, 2), (1, 3), (1, 4),
    (2, 8), (2, 2), (2, 3),
    (3, 6), (3, 0), (4, 6), (4, -1), (5, 6), (5, 7),
    (6, 3), (6, 4), (7, 3), (7, 4), (8, 3), (8, 5), (9, 3), (9, 5),
    (10, 7), (10, 1), (11, 6), (11, 0), (11, 1), (12, 7), (12, 6), (12, 0),
)  # fmt: skip
_ROWS = 13


@dataclass(frozen=True, slots=True, eq=False)
class Stages:
    """A time grid of N cells with what every motion keeps at its knots.

    Parameters
    ----------
    h : (N,) durations [s].
    low, high : (N+1,) bounds [m] on s at the knots.
    speed : (N+1,) bounds [m/s] on v at the knots; ``mean`` : (N,) on the mean speed of the cells.
    slope, offset : (N+1,) further bounds at the knots, v <= slope s + offset.
    """

    h: Array
    low: Array
    high: Array
    speed: Array
    mean: Array
    slope: Array
    offset: Array


def farthest_bound(stages: Stages, limits: Limits) -> tuple[float, Array]:
    """An upper bound [m] on how far any motion from rest through the stages gets that rests at their end.

    Where no motion keeps all lower bounds, what lacks there is taken off. So where the bound is below the goal's
    arc length, no motion through the stages is there in time. Also returned are the states (N+1, 3) of the
    relaxation's own solution: a rough motion. The bound is infinite where the solver fails.
    """
    n = len(stages.h)
    box, row_box = _variable_bounds(stages, limits), _row_bounds(stages, limits)
    program, values = _program(n), _coefficients(stages)
    gradient = np.zeros(6 * n + 4)
    gradient[[6 * n, -1]] = -1.0, _PENALTY
    x, multipliers = program.solve(np.full(6 * n + 4, _DIAGONAL), gradient, values, row_box, box)
    if not (np.all(np.isfinite(x)) and np.all(np.isfinite(multipliers))):
        return math.inf, np.zeros((n + 1, 3))
    reduced = gradient + np.bincount(program.columns, values * multipliers[program.rows], minlength=len(gradient))
    least = _least(reduced, *box) + _least(-multipliers, *row_box)
    return _ROUNDING - least, np.append(x[:-1], np.zeros(3)).reshape(-1, 6)[:, :3].copy()


def _least(weights: Array, low: Array, high: Array) -> float:
    """The least sum of weights (m,) times values that lie between ``low`` and ``high`` (m,)."""
    return math.fsum(np.where(weights > 0, weights * low, weights * high).tolist())


def _variable_bounds(stages: Stages, limits: Limits) -> tuple[Array, Array]:
    """Unknowns s, v, a and three moments for each cell, the last s, v, a, and what lacks at lower bounds."""
    low, high = np.zeros((len(stages.high), 6)), np.zeros((len(stages.high), 6))
    high[:, 0] = stages.high
    high[:, 1] = stages.speed
    low[:, 2], high[:, 2] = -limits.deceleration, limits.acceleration
    high[:, 3:] = limits.jerk * np.array([1.0, _MEAN_P1, _MEAN_P2])
    low[:, 3:] = -high[:, 3:]
    low[[0, -1], 1:3] = high[[0, -1], 1:3] = 0.0
    high[0, 0] = 0.0
    most = max(float(stages.low.max()), 0.0) + 1.0
    return np.append(low.ravel()[:-3], 0.0), np.append(high.ravel()[:-3], most)


def _row_bounds(stages: Stages, limits: Limits) -> tuple[Array, Array]:
    """Bounds of the rows; those that are open on one side get there what the variables' boxes allow at most."""
    h = stages.h
    low, high = np.zeros((len(h), _ROWS)), np.zeros((len(h), _ROWS))
    farthest = float(stages.high.max())
    low[:, 3], high[:, 3] = -farthest, h * stages.mean
    low[:, 4], high[:, 4] = stages.low[1:], 2 * farthest + 2.0
    low[:, 5], high[:, 5] = -np.abs(stages.slope[1:]) * farthest, stages.offset[1:]
    low[:, 6:10], high[:, 6:10] = -limits.jerk, limits.jerk
    for row, share in ((10, h), (11, h**2 / 2), (12, h**2 / 2)):
        low[:, row], high[:, row] = -limits.deceleration * share, limits.acceleration * share
    return low.ravel(), high.ravel()


def _coefficients(stages: Stages) -> Array:
    """Values of the rows' coefficients, cell by cell, in the order of ``_PLACES``."""
    h = stages.h
    one = np.ones_like(h)
    s = [one, -one, -h, -(h**2) / 2, -(h**3) / 6, h**3 / 4, -(h**3) / 12]
    v = [one, -one, -h, -(h**2) / 2, h**2 / 2]
    a = [one, -one, -h]
    at_knots = [one, -one, one, one, -stages.slope[1:], one]
    moments = [one, one, one, -one, one, one, one, -one]
    means = [one, -one, one, -one, -h, h, -one, one]
    return np.stack(s + v + a + at_knots + moments + means, axis=1).ravel()


@lru_cache(maxsize=64)
def _program(n: int) -> Program:
    return conic.program("relaxation", _PLACES, n, rows=_ROWS, unknowns=6, more=4, rounds=80)
