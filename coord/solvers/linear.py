"""Jerk-limited motion inside bounds, on a fixed time grid, as a linear program."""

from __future__ import annotations

import numpy as np

from coord.model.arrays import Array
from coord.model.robot import Limits
from coord.solvers.assembly import Assembly
from coord.solvers.knots import Cells, Knots, add_motion, add_smoothness, bounded, knots

#: [m] The robot may come to rest this much farther away than speed allows.
_BEYOND = 1.0


def farthest(cells: Cells, limits: Limits) -> float | None:
    """How far [m] the robot can come to rest at the end of the cells, from rest at 0; None where no motion is found."""
    program, at = _program(cells, limits)
    end = at.s[-1:]
    program.box(end, -_BEYOND, limits.speed * float(cells.h.sum()) + _BEYOND)
    program.cost[end] = -1.0
    states = _states(program, at, cells)
    return None if states is None else float(states[-1, 0])


def smoothest(cells: Cells, limits: Limits, length: float, ease: float = 0.0) -> Array | None:
    """Jerks (N,) of the motion from rest at 0 to rest at ``length`` with the least squared jerk, if one is found.

    ``ease`` : weight [1/s2] of the squared acceleration beside the squared jerk.
    """
    program, at = _program(cells, limits)
    there = np.array([length])
    program.rows(there, there, (at.s[-1:], 1.0))
    add_smoothness(program, at, cells.h, 1.0, ease)
    states = _states(program, at, cells)
    return None if states is None else np.diff(states[:, 2]) / cells.h


def _program(cells: Cells, limits: Limits) -> tuple[Assembly, Knots]:
    at = knots(len(cells.h))
    program = Assembly(at.count)
    add_motion(program, at, cells, limits)
    for one in bounded(at, cells):
        none = np.full(len(one.cells), np.inf)
        low, high = (-none, one.bounds) if one.is_upper else (one.bounds, none)
        program.rows(low, high, *one.terms)
    return program, at


def _states(program: Assembly, at: Knots, cells: Cells) -> Array | None:
    if cells.is_contradictory:
        return None
    found = program.solve()
    return at.states(found.x) if found.is_solved else None
