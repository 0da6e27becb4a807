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

import numpy as np

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers.assembly import Assembly
from coord.solvers.knots import Knots, knots

#: [1] A metre that lacks at a lower bound costs as much as so many metres that lack at the end.
_PENALTY = 4.0

#: PIQP needs a little curvature everywhere; here it makes the bound looser.
_DIAGONAL = 1e-9

#: Multipliers that are not settled make a bound useless.
_ITERATIONS = 100

#: Means over [-1, 1] of |P1| and |P2|, the second and third Legendre polynomial; the latter is rounded up.
_MEAN_P1, _MEAN_P2 = 0.5, 0.38491

#: [m] More than what rounding can do to the dual function.
_ROUNDING = 1e-8


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
    at = knots(len(stages.h))
    program = Assembly(at.count + 1, _DIAGONAL)
    _add_boxes(program, at, stages, limits)
    _add_moments(program, at, stages.h, limits)
    _add_means(program, at, stages, limits)
    _add_bounds(program, at, stages)
    program.cost[[at.s[-1], -1]] = -1.0, _PENALTY
    found = program.solve(most=_ITERATIONS)
    if not (np.all(np.isfinite(found.x)) and np.all(np.isfinite(found.multipliers))):
        return math.inf, np.zeros((len(stages.high), 3))
    return _ROUNDING - program.least_cost(found.multipliers), at.states(found.x)


def _add_boxes(program: Assembly, at: Knots, stages: Stages, limits: Limits) -> None:
    """States, and what lacks at lower bounds, the last unknown."""
    program.box(at.s, 0.0, stages.high)
    program.box(at.v, 0.0, stages.speed)
    program.box(at.a, -limits.deceleration, limits.acceleration)
    program.box(np.array([program.count - 1]), 0.0, max(float(stages.low.max()), 0.0) + 1.0)


def _add_moments(program: Assembly, at: Knots, h: Array, limits: Limits) -> None:
    """The jerk's moments follow from the states at both ends of a cell; how large each is, and two of them together."""
    # s, v, a at the beginning and at the end: coefficients of the moments times the duration
    columns = (at.s[:-1], at.v[:-1], at.a[:-1], at.s[1:], at.v[1:], at.a[1:])
    mean = np.array([0, 0, -1, 0, 0, 1])[:, None] * np.ones_like(h)
    first = np.stack([0 * h, 2 / h, 1 + 0 * h, 0 * h, -2 / h, 1 + 0 * h])
    second = np.stack([-12 / h**2, -6 / h, -1 + 0 * h, 12 / h**2, -6 / h, 1 + 0 * h])
    sums = (
        (mean, 1.0),
        (first, _MEAN_P1),
        (second, _MEAN_P2),
        *((mean + c * m, 1.0) for m in (first, second) for c in (1, -1)),
    )
    for coefficients, share in sums:
        most = share * limits.jerk * h
        program.rows(-most, most, *zip(columns, coefficients, strict=True))


def _add_means(program: Assembly, at: Knots, stages: Stages, limits: Limits) -> None:
    """Mean speed, and mean acceleration over the whole cell and weighted towards its beginning and its end."""
    h, none = stages.h, np.full(len(stages.h), np.inf)
    s, v, s_end, v_end = at.s[:-1], at.v[:-1], at.s[1:], at.v[1:]
    program.rows(-none, h * stages.mean, (s_end, 1.0), (s, -1.0))
    low, high = -limits.deceleration, limits.acceleration
    program.rows(low * h, high * h, (v_end, 1.0), (v, -1.0))
    program.rows(low * h**2 / 2, high * h**2 / 2, (s_end, 1.0), (s, -1.0), (v, -h))
    program.rows(low * h**2 / 2, high * h**2 / 2, (v_end, h), (s_end, -1.0), (s, 1.0))


def _add_bounds(program: Assembly, at: Knots, stages: Stages) -> None:
    """Lower bounds on s, which may be missed by what lacks, and speed over place."""
    k = np.flatnonzero(stages.low[1:] > 0) + 1
    if len(k):
        lacks = np.full(len(k), program.count - 1)
        program.rows(stages.low[k], np.full(len(k), np.inf), (at.s[k], 1.0), (lacks, 1.0))
    none = np.full(len(stages.h), np.inf)
    program.rows(-none, stages.offset[1:], (at.v[1:], 1.0), (at.s[1:], -stages.slope[1:]))
