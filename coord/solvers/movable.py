"""Motions whose knots may move: one round of a sequential linear program.

With knots at fixed times the jerk-limited motions are a convex set. Where the times of some knots are sought as well,
the equations of motion are taken as linear about a motion that is known: how each state changes when its cell lasts
a little longer is that motion's own speed, acceleration and jerk at the cell's end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers.assembly import COARSE, Assembly, Columns, Term
from coord.solvers.knots import Cells, Further, Knots, add_motion, add_smoothness, bounded, knots

#: [s/m] A metre that lacks at a lower bound costs as much as arriving so many seconds later.
_PENALTY = 20.0

#: Of several solutions one with little jerk and evenly stretched cells is taken: weights [s] of the squared jerk, as a
#: share of its limit, and of the squared stretching, and [1/s] of the squared shift of each knot.
_SMOOTH, _EVEN, _STAY = 1e-5, 1e-4, 2e-4

#: [1] Cells may shrink and grow by these shares in one round.
_SHRINK, _GROW = 0.6, 1.5


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
    at = knots(len(cells.h))
    shifts = _Shifts(about.times, freedom, at.count)
    lacking = at.count + shifts.count
    program = Assembly(lacking + 1)
    add_motion(program, at, cells, limits, _stretched(cells, about, shifts))
    _add_bounds(program, at, cells, length, about, shifts, lacking)
    shifts.add_to(program, freedom)
    program.box(at.s[-1:], -np.inf, length)
    add_smoothness(program, at, cells.h, _SMOOTH / limits.jerk**2)
    program.box(np.array([lacking]), 0.0, length + 1.0)
    program.cost[lacking] = _PENALTY
    x = program.solve(COARSE).x
    if not np.all(np.isfinite(x)):
        return None
    shift, states = shifts.at_knots(x), at.states(x)
    jerks = (np.diff(states[:, 2]) - about.jerks * np.diff(shift)) / cells.h
    return Motion(about.times + shift, states, jerks), float(x[-1])


class _Shifts:
    """The unknown shifts of the anchors that may move; the knots between two anchors are shifted evenly."""

    def __init__(self, times: Array, freedom: Freedom, first: int) -> None:
        anchors = np.flatnonzero(freedom.anchors)
        moves = ~freedom.fixed[anchors]
        self.count = int(np.count_nonzero(moves))
        self.columns = np.where(moves, first + np.cumsum(moves) - 1, -1)
        self.spans = np.diff(times[anchors])
        self.span = np.searchsorted(anchors[1:-1], np.arange(len(times)), side="right")
        self.share = (times - times[anchors[self.span]]) / self.spans[self.span]

    def of_knots(self, k: Columns, factor: Array) -> list[Term]:
        """Terms of the shifts of knots k (m,), times a factor (m,)."""
        span, share = self.span[k], self.share[k]
        return [(self.columns[span], factor * (1 - share)), (self.columns[span + 1], factor * share)]

    def of_cells(self, k: Columns, factor: Array) -> list[Term]:
        """Terms of the shares by which cells k (m,) are stretched, times a factor (m,)."""
        span = self.span[k]
        rate = factor / self.spans[span]
        return [(self.columns[span + 1], rate), (self.columns[span], -rate)]

    def add_to(self, program: Assembly, freedom: Freedom) -> None:
        """How far anchors move, how much cells shrink and grow, and what that costs."""
        program.box(self.columns[:-1], -freedom.most, freedom.most)
        program.box(self.columns[-1:], -freedom.sooner, freedom.later)
        program.cost[self.columns[-1]] = 1.0
        changes = np.maximum(self.columns[:-1], self.columns[1:]) >= 0
        before, after, spans = self.columns[:-1][changes], self.columns[1:][changes], self.spans[changes]
        stretching: list[Term] = [(after, 1 / spans), (before, -1 / spans)]
        program.rows(np.full(len(spans), -_SHRINK), np.full(len(spans), _GROW), *stretching)
        program.squares(_EVEN * spans, *stretching)
        k = np.arange(len(self.span))
        program.squares(np.full(len(k), _STAY), *self.of_knots(k, np.ones(len(k))))

    def at_knots(self, x: Array) -> Array:
        """The shifts (N+1,) [s] in a solution."""
        anchors = np.where(self.columns >= 0, x[self.columns], 0.0)
        before, after = anchors[self.span], anchors[self.span + 1]
        return np.asarray(before + self.share * (after - before))


def _stretched(cells: Cells, about: Motion, shifts: _Shifts) -> Further:
    """What stretching a cell adds to the rows of its motion."""
    h, j, k = cells.h, about.jerks, np.arange(len(cells.h))
    v, a = about.states[:, 1], about.states[:, 2]
    factors = (h * (h * j / 2 - a[1:]), h * (h**2 * j / 6 - v[1:]), -h * j, h * a[:-1] / 2)
    speed, place, jerk, middle = (shifts.of_cells(k, factor) for factor in factors)
    return speed, place, jerk, middle


def _add_bounds(
    program: Assembly, at: Knots, cells: Cells, length: float, about: Motion, shifts: _Shifts, lacking: int
) -> None:
    """Rows for the bounds, which are met later where their knots move later; what lacks at lower ones is an unknown."""
    v, a = about.states[:, 1], about.states[:, 2]
    for one in bounded(at, cells, are_moving=True):
        k, h = one.cells, cells.h[one.cells]
        if one.point == 3:
            terms = [*one.terms, *shifts.of_knots(k + 1, -one.rises)]
        else:
            share = one.point * h / 3
            moves = share * v[k] + (h**2 * a[k] / 3 if one.point == 2 else 0.0) - share * one.rises
            terms = [*one.terms, *shifts.of_knots(k, -one.rises), *shifts.of_cells(k, moves)]
        none = np.full(len(k), np.inf)
        if one.is_upper and one.point == 3 and not one.rises.any():
            program.box(at.s[k + 1], -none, one.bounds)
        elif one.is_upper:
            program.rows(-none, one.bounds, *terms)
        else:
            program.rows(one.bounds, none, *terms, (np.full(len(k), lacking), 1.0))
    program.rows(np.array([length]), np.array([np.inf]), (at.s[-1:], 1.0), (np.array([lacking]), 1.0))
