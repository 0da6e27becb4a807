"""Motions whose knots may move: one round of a sequential linear program.

With knots at fixed times the jerk-limited motions are a convex set. Where the times of some knots are sought as well,
the equations of motion are taken as linear about a motion that is known: how each state changes when its cell lasts
a little longer is that motion's own speed, acceleration and jerk at the cell's end.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers.conic import Program, program
from coord.solvers.linear import CREEP, Cells

#: [s/m] A metre that lacks at a lower bound costs as much as arriving so many seconds later.
_PENALTY = 20.0

#: PIQP needs a little curvature everywhere; of several solutions one with little jerk and evenly stretched cells is
#: taken: weights [s] of the squared jerk, as a share of its limit, and of the squared stretching.
_DIAGONAL, _SMOOTH, _EVEN, _STAY = 1e-7, 1e-5, 1e-4, 2e-4

#: [1] Cells may shrink and grow by these shares in one round.
_SHRINK, _GROW = 0.6, 1.5

#: [1] Wider than any difference of two stretchings.
_ANY = 5.0

#: Row and column of each coefficient of a cell. Columns: 0..5 are s, v, a, j, the shift of the knot and the stretching
#: of the cell, 6.. the same of the next cell, and -1 is what lacks. Rows: three equations of motion; the next knot's
#: shift; the next stretching; upper and lower bound at the next knot; middle speed; upper and lower bound at both
#: inner Bezier points.
_PLACES = (
    (0, 6), (0, 0), (0, 1), (0, 2), (0, 3), (0, 5),
    (1, 7), (1, 1), (1, 2), (1, 3), (1, 5),
    (2, 8), (2, 2), (2, 3), (2, 5),
    (3, 10), (3, 4), (3, 5), (4, 11), (4, 5),
    (5, 6), (5, 10), (6, 6), (6, 10), (6, -1),
    (7, 1), (7, 2), (7, 5),
    (8, 0), (8, 1), (8, 4), (8, 5), (9, 0), (9, 1), (9, 4), (9, 5), (9, -1),
    (10, 0), (10, 1), (10, 2), (10, 4), (10, 5), (11, 0), (11, 1), (11, 2), (11, 4), (11, 5), (11, -1),
)  # fmt: skip
_ROWS = 12


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A motion with constant jerk in each of N cells.

    Parameters
    ----------
    times : (N+1,) knots [s], increasing.
    states : (N+1, 3) arc length [m], speed and acceleration there; ``jerks`` : (N,).
    """

    times: Array
    states: Array
    jerks: Array

    def at(self, times: Array) -> Motion:
        """The same motion with other knots (M+1,) [s], with the jerks that it has just after them."""
        k = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, len(self.jerks) - 1)
        u = np.maximum(times - self.times[k], 0.0)
        (s, v, a), j = self.states[k].T, self.jerks[k]
        states = np.stack([s + u * (v + u * (a / 2 + u * j / 6)), v + u * (a + u * j / 2), a + u * j], axis=1)
        return Motion(times, states, j[:-1])


@dataclass(frozen=True, slots=True, eq=False)
class Freedom:
    """How knots may move in one round.

    Parameters
    ----------
    anchors : (N+1,) whether cells before and behind a knot may be stretched differently.
    fixed : (N+1,) whether a knot stays where it is.
    most : no knot but the last moves by more [s].
    sooner, later : the last knot moves by at most so much [s].
    """

    anchors: npt.NDArray[np.bool_]
    fixed: npt.NDArray[np.bool_]
    most: float
    sooner: float
    later: float


def moved(cells: Cells, limits: Limits, length: float, about: Motion, freedom: Freedom) -> tuple[Motion, float] | None:
    """The motion that comes to rest at ``length`` [m] earliest, near one that is known, and what lacks [m].

    ``about`` has the cells' knots; its own bounds need not be kept. Lower bounds, and the goal, may be missed by what
    lacks, at a price, so that there always is a motion. It is exact as far as the knots stay where they are. None
    where the solver returns no numbers.
    """
    n = len(cells.h)
    box, row_box = _variable_bounds(cells, limits, length, freedom), _row_bounds(cells, length, freedom)
    gradient, weight = np.zeros(6 * n + 7), np.full(6 * n + 7, _DIAGONAL)
    gradient[[-3, -1]] = 1.0, _PENALTY
    weight[3:-7:6] = _SMOOTH * cells.h / limits.jerk**2
    weight[5:-7:6] = _EVEN * cells.h
    weight[4:-7:6] = _STAY
    x, _ = _program(n).solve(weight, gradient, _coefficients(cells, about), row_box, box)
    if not np.all(np.isfinite(x)):
        return None
    z = x[:-1].reshape(n + 1, 6)
    return Motion(about.times + z[:, 4], z[:, :3].copy(), z[:-1, 3].copy()), float(x[-1])


def _variable_bounds(cells: Cells, limits: Limits, length: float, freedom: Freedom) -> tuple[Array, Array]:
    """Unknowns s, v, a, j, shift and stretching for each cell and at the end, then what lacks."""
    low, high = np.zeros((len(cells.h) + 1, 6)), np.zeros((len(cells.h) + 1, 6))
    low[:, 0], high[:, 0] = -1.0, length
    low[:, 1], high[:, 1] = CREEP, limits.speed
    np.minimum(high[:-1, 1], cells.caps, out=high[:-1, 1])
    np.minimum(high[1:, 1], cells.caps, out=high[1:, 1])
    low[:, 2], high[:, 2] = -limits.deceleration, limits.acceleration
    low[:, 3], high[:, 3] = -limits.jerk, limits.jerk
    low[:, 4] = np.where(freedom.fixed, 0.0, -freedom.most)
    high[:, 4] = -low[:, 4]
    low[:, 5], high[:, 5] = -_SHRINK, _GROW
    low[0, :3] = high[0, :3] = low[0, 4] = high[0, 4] = 0.0
    low[-1, 1:] = high[-1, 1:] = 0.0
    low[-1, 4], high[-1, 4] = -freedom.sooner, freedom.later
    return np.append(low.ravel(), 0.0), np.append(high.ravel(), length + 1.0)


def _row_bounds(cells: Cells, length: float, freedom: Freedom) -> tuple[Array, Array]:
    """Bounds of the rows; those without a bound get what is beyond all motions: rows without any make PIQP print."""
    n, far = len(cells.h), 2 * length + 4
    low, high = np.zeros((n, _ROWS)), np.zeros((n, _ROWS))
    changes = np.append(freedom.anchors[1:-1], True)
    low[changes, 4], high[changes, 4] = -_ANY, _ANY
    (upper, _), (lower, _) = _at_knots(cells, length)
    low[:, [5, 8, 10]], high[:, [6, 9, 11]] = -far, 2 * far
    high[:, 5], low[:, 6] = np.minimum(upper, far), np.maximum(lower, -far)
    high[:, [8, 10]], low[:, [9, 11]] = np.minimum(cells.upper[:, 1:3], far), np.maximum(cells.lower[:, 1:3], -far)
    low[:, 7], high[:, 7] = CREEP, cells.caps
    low[[0, -1], 7] = -CREEP  # at rest at both ends
    return low.ravel(), high.ravel()


def _at_knots(cells: Cells, length: float) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Upper and lower bounds (N,) [m] at the knots but the first, the goal as well, and how quickly they rise."""
    rises = _rises(cells)
    following = np.append(cells.upper[1:, 0], np.inf), np.append(cells.lower[1:, 0], -np.inf)
    own = cells.upper[:, 3], cells.lower[:, 3]
    upper, lower = np.minimum(own[0], following[0]), np.maximum(own[1], following[1])
    up = np.where(own[0] <= following[0], rises[0], np.append(rises[0][1:], 0.0))
    down = np.where(own[1] >= following[1], rises[1], np.append(rises[1][1:], 0.0))
    lower[-1], down[-1] = length, 0.0
    return (upper, up), (lower, down)


def _rises(cells: Cells) -> tuple[Array, Array]:
    """How quickly (N,), (N,) [m/s] upper and lower bounds rise in each cell; 0 where there is none."""
    found = []
    for bound in (cells.upper, cells.lower):
        finite = np.isfinite(bound).all(axis=1)
        found.append(np.where(finite, (np.where(finite, bound[:, 3], 0.0) - np.where(finite, bound[:, 0], 0.0)), 0.0))
    return found[0] / cells.h, found[1] / cells.h


def _coefficients(cells: Cells, about: Motion) -> Array:
    """Values of the rows' coefficients, cell by cell, in the order of ``_PLACES``."""
    h, states = cells.h, about.states
    one = np.ones_like(h)
    up, down = _rises(cells)
    (_, up_end), (_, down_end) = _at_knots(cells, 0.0)
    first = h * states[:-1, 1] / 3
    second = 2 * first + h**2 * states[:-1, 2] / 3
    dynamics = [
        one, -one, -h, -(h**2) / 2, -(h**3) / 6, -states[1:, 1] * h,
        one, -one, -h, -(h**2) / 2, -states[1:, 2] * h,
        one, -one, -h, -about.jerks * h,
        one, -one, -h, one, -one,
    ]  # fmt: skip
    knots = [one, -up_end, one, -down_end, one, one, h / 2, h * states[:-1, 2] / 2]
    inner = [one, h / 3, -up, first - up * h / 3, one, h / 3, -down, first - down * h / 3, one]
    inner += [one, 2 * h / 3, h**2 / 6, -up, second - up * 2 * h / 3]
    inner += [one, 2 * h / 3, h**2 / 6, -down, second - down * 2 * h / 3, one]
    return np.stack(dynamics + knots + inner, axis=1).ravel()


@lru_cache(maxsize=64)
def _program(n: int) -> Program:
    return program("movable", _PLACES, n, rows=_ROWS, unknowns=6, more=7, rounds=60, exact=False)
