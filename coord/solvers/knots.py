"""Motions from rest to rest with constant jerk in each cell of a time grid: unknowns and rows of their programs.

The states at the knots are the unknowns; the jerk follows from the accelerations. Bounds on s hold between the knots
as well, as they hold for the Bezier points of each cubic, and so do the limits of the speed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers.assembly import Assembly, Columns, Term

#: [m/s] Between departure and arrival the program's robot creeps at least this fast, so that rounding
#: cannot make it move backwards.
CREEP = 1e-7

#: Further terms of the rows for speed, place, jerk and middle speed.
Further: TypeAlias = tuple[Sequence[Term], Sequence[Term], Sequence[Term], Sequence[Term]]


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """N time cells with constant jerk each.

    Parameters
    ----------
    h : (N,) durations [s].
    upper, lower : (N, 4) bounds [m] on the Bezier points of s in each cell.
    caps : (N,) largest speed [m/s] in each cell.
    """

    h: Array
    upper: Array
    lower: Array
    caps: Array

    @property
    def is_contradictory(self) -> bool:
        """Whether some lower bound is above the upper one."""
        return bool(np.any(self.lower > self.upper))


@dataclass(frozen=True, slots=True, eq=False)
class Knots:
    """Columns (N+1,) of arc length, speed and acceleration at the knots; -1 where the robot stands at 0 or at rest."""

    s: Columns
    v: Columns
    a: Columns

    @property
    def count(self) -> int:
        """How many unknowns these are."""
        return int(self.s[-1]) + 1

    def states(self, x: Array) -> Array:
        """States (N+1, 3) in a solution."""
        columns = np.stack([self.s, self.v, self.a], axis=1)
        return np.asarray(np.where(columns >= 0, x[columns], 0.0))


def knots(cells: int) -> Knots:
    """The unknowns of a motion through so many cells."""
    first = 3 * np.arange(-1, cells)
    s, v, a = first.copy(), first + 1, first + 2
    s[0] = v[0] = a[0] = v[-1] = a[-1] = -1
    return Knots(s, v, a)


def add_motion(program: Assembly, at: Knots, cells: Cells, limits: Limits, further: Further = ((), (), (), ())) -> None:
    """Rows and boxes for the laws of motion, the limits and the caps."""
    h, none = cells.h, np.zeros(len(cells.h))
    s, v, a = at.s[:-1], at.v[:-1], at.a[:-1]
    s_end, v_end, a_end = at.s[1:], at.v[1:], at.a[1:]
    program.rows(none, none, (v_end, 1.0), (v, -1.0), (a, -h / 2), (a_end, -h / 2), *further[0])
    place = ((s_end, 1.0), (s, -1.0), (v, -h), (a, -(h**2) / 3), (a_end, -(h**2) / 6))
    program.rows(none, none, *place, *further[1])
    program.rows(-limits.jerk * h, limits.jerk * h, (a_end, 1.0), (a, -1.0), *further[2])
    creep = np.full(len(h), CREEP)
    creep[[0, -1]] = -CREEP  # at rest at both ends
    program.rows(creep, cells.caps, (v, 1.0), (a, h / 2), *further[3])
    program.box(at.v[1:-1], CREEP, np.minimum(np.minimum(cells.caps[:-1], cells.caps[1:]), limits.speed))
    program.box(at.a, -limits.deceleration, limits.acceleration)


def add_smoothness(program: Assembly, at: Knots, h: Array, weight: float, ease: float = 0.0) -> None:
    """Costs for the weighted square of the jerk, integrated, and ``ease`` [1/s2] times so much for the acceleration."""
    program.squares(weight / h, (at.a[1:], 1.0), (at.a[:-1], -1.0))
    if ease > 0:
        program.squares(weight * ease * h, (at.a[:-1], 1.0))


@dataclass(frozen=True, slots=True, eq=False)
class Bounded:
    """A Bezier point of some cells that has a bound; either all of them rise, or none.

    Parameters
    ----------
    point : which, 1 to 3; the last one is the next knot.
    cells : (m,) the cells; ``bounds``, ``rises`` : (m,) the bounds [m], and how quickly they rise [m/s].
    terms : its arc length.
    """

    point: int
    is_upper: bool
    cells: Columns
    bounds: Array
    rises: Array
    terms: Sequence[Term]


def bounded(at: Knots, cells: Cells, *, are_moving: bool = False) -> Iterator[Bounded]:
    """The Bezier points that have to be bounded: as no robot moves backwards, many bounds follow from others.

    ``are_moving`` : whether knots may move, so that it matters how quickly bounds rise. Then all bounds are kept at the
        knots, for a motion taken as linear may go backwards where cells shrink.
    """
    for is_upper, bounds, rises in _bounds(cells, are_moving=are_moving):
        if is_upper:
            tells = _upper_that_tell(bounds, rises)
        else:  # the mirror image
            tells = _upper_that_tell(-bounds[::-1, ::-1], rises[::-1, ::-1])[::-1, ::-1]
        if are_moving:
            tells[:, 2] = np.isfinite(bounds[:, 2])
        if not is_upper:
            tells &= (bounds > 0) | (rises != 0)
        for point in (1, 2, 3):
            value, rise, some = bounds[:, point - 1], rises[:, point - 1], tells[:, point - 1]
            for k in (np.flatnonzero(some & (rise == 0)), np.flatnonzero(some & (rise != 0))):
                if len(k):
                    yield Bounded(point, is_upper, k, value[k], rise[k], _place(at, cells.h, k, point))


def _place(at: Knots, h: Array, k: Columns, point: int) -> Sequence[Term]:
    """Terms of the arc length at Bezier points of cells k (m,)."""
    if point == 3:
        return [(at.s[k + 1], 1.0)]
    third = point * h[k] / 3
    inner: list[Term] = [(at.s[k], 1.0), (at.v[k], third)]
    return inner if point == 1 else [*inner, (at.a[k], h[k] ** 2 / 6)]


def _bounds(cells: Cells, *, are_moving: bool) -> Iterator[tuple[bool, Array, Array]]:
    """Whether they are upper ones, and bounds and rises (N, 3) of the Bezier points but the first of each cell."""
    for is_upper, own in ((True, cells.upper), (False, -cells.lower)):
        following = np.append(own[1:, 0], np.inf)
        bounds = own[:, 1:].copy()
        is_next = following < own[:, 3]
        bounds[is_next, 2] = following[is_next]
        rises = np.zeros_like(bounds)
        if are_moving:
            is_bound = np.isfinite(own).all(axis=1)
            rise = np.subtract(own[:, 3], own[:, 0], out=np.zeros(len(own)), where=is_bound) / cells.h
            rises[:] = rise[:, None]
            rises[is_next, 2] = np.append(rise[1:], 0.0)[is_next]
        yield (True, bounds, rises) if is_upper else (False, -bounds, -rises)


def _upper_that_tell(bounds: Array, rises: Array) -> npt.NDArray[np.bool_]:
    """Which of the upper bounds (N, 3) do not follow from later ones that stay where they are."""
    flat = np.where(rises == 0, bounds, np.inf).ravel()
    later = np.append(np.minimum.accumulate(flat[::-1])[::-1][1:], np.inf).reshape(bounds.shape)
    return np.asarray(np.isfinite(bounds) & ~((rises == 0) & (later <= bounds)))
