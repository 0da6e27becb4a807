"""The quickest motion through a tube, by a linear program on a time grid.

For a fixed arrival the jerk-limited motions inside a tube form a convex set, and arrivals that are possible
stay possible when they come later. So the program asks how far the robot can get until it rests at a given
time; as it covers at most ``speed`` metres a second, the metres that lack give a next arrival that is still
not too late, and the search rises to the least possible one.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coord.alone.check import keeps_limits
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.linear import SIZES, Cells, farthest, smoothest
from coord.timing.ego import Ego
from coord.timing.polish import land_exactly
from coord.timing.tube import Bound, lower_on_cells, upper_on_cells
from coord.tolerances import LIMIT_MARGIN, REGION_MARGIN

#: First cells after an event of the tube last this share of acceleration / jerk; then they grow.
_FIRST_CELL = 0.25
_GROWTH = 1.5

#: [s] Longest cell where no window is, and where one is.
_LONGEST_FREE, _LONGEST_TAKEN = 1.5, 0.25

#: Scales of the cells: the finer grid is for tubes that the coarser one finds too narrow.
_MESHES = (1.0, 0.4)

#: [s] The search for the arrival ends when it rises by less than this.
_ARRIVAL_STEP = 2e-3

#: [m] The tube is narrowed by this, so that the solver's rounding stays inside.
_TUBE_MARGIN = 2 * REGION_MARGIN

#: [m] An upper bound below this holds the robot at its start: it departs when the bound has risen above.
_AT_START = 2e-3


@dataclass(frozen=True, slots=True, eq=False)
class Tube:
    """Upper bounds (from windows passed after) and lower bounds (from windows passed before)."""

    upper: Sequence[Bound]
    lower: Sequence[Bound]


def through_tube(ego: Ego, tube: Tube, least: float, most: float) -> VelocityProfile | None:
    """The quickest profile through a tube with an arrival between ``least`` and ``most`` [s]; None if none is found.

    ``least`` must not be later than the best arrival there is. The profile keeps the limits (checked
    exactly); whether it is clear of the windows the caller checks. A tight tube may be too narrow for the
    bounds on a coarse grid, so a finer one is tried where the coarse one finds nothing.
    """
    for mesh in _MESHES:
        profile = _through(_Attempt(ego, tube, _tightened(ego.robot.limits), _departure(ego, tube), mesh), least, most)
        if profile is not None:
            return profile
    return None


@dataclass(frozen=True, slots=True, eq=False)
class _Attempt:
    """A tube on one mesh: limits a little tightened, cells scaled by ``mesh``."""

    ego: Ego
    tube: Tube
    limits: Limits
    departure: float
    mesh: float


def _through(attempt: _Attempt, least: float, most: float) -> VelocityProfile | None:
    ego = attempt.ego
    if _reach(attempt, most) < 0:
        return None
    arrival = max(least, attempt.departure + (ego.alone.arrival - ego.alone.departure) * 0.5)
    while True:
        lack = -_reach(attempt, arrival)
        step = min(max(lack, 0.0), 10 * ego.length) / attempt.limits.speed
        if step <= _ARRIVAL_STEP:
            break
        arrival += step
        if arrival > most:
            arrival = most
            break
    for pause in (0.0, _ARRIVAL_STEP, 3 * _ARRIVAL_STEP, 10 * _ARRIVAL_STEP):
        at = min(arrival + step + pause, most)
        profile = _smooth(attempt, at)
        if profile is not None:
            return profile
        if at == most:
            break
    return None


def _reach(attempt: _Attempt, arrival: float) -> float:
    """How far beyond its goal [m] the robot could rest at the arrival; negative where it cannot get there."""
    cells = _cells(attempt, arrival)
    reached = None if cells is None else farthest(cells, attempt.limits)
    return -np.inf if reached is None else reached - attempt.ego.length


def _smooth(attempt: _Attempt, arrival: float) -> VelocityProfile | None:
    ego = attempt.ego
    cells = _cells(attempt, arrival)
    jerks = None if cells is None else smoothest(cells, attempt.limits, ego.length)
    if cells is None or jerks is None:
        return None
    profile = land_exactly(cells.h, jerks, ego.length, attempt.departure)
    if profile is None or not keeps_limits(profile, ego.robot.limits, ego.caps):
        return None
    return profile


def _cells(attempt: _Attempt, arrival: float) -> Cells | None:
    """The grid up to an arrival with the tube's bounds on it; None where the grid would be too large."""
    ego, tube, limits = attempt.ego, attempt.tube, attempt.limits
    times = _grid(attempt, arrival)
    if times is None:
        return None
    n = len(times) - 1
    upper, lower = np.full((n, 4), np.inf), np.full((n, 4), -np.inf)
    for bound in tube.upper:
        np.minimum(upper, upper_on_cells(bound, times, _TUBE_MARGIN), out=upper)
    for bound in tube.lower:
        np.maximum(lower, np.minimum(lower_on_cells(bound, times, _TUBE_MARGIN), ego.length), out=lower)
    return Cells(np.diff(times), upper, lower, np.full(n, limits.speed))


def _grid(attempt: _Attempt, arrival: float) -> Array | None:
    """Time knots at the tube's events, dense behind and before each, as many as a size of program has."""
    limits, departure, bounds = attempt.limits, attempt.departure, (*attempt.tube.upper, *attempt.tube.lower)
    taken = [(float(bound.times[0]), float(bound.times[-1])) for bound in bounds]
    events = {departure, arrival, *(t for span in taken for t in span)}
    knots = sorted(t for t in events if departure <= t <= arrival)
    shortest = max(_FIRST_CELL * min(limits.acceleration, limits.deceleration) / limits.jerk, 0.02) * attempt.mesh
    times = [departure]
    for start, end in itertools.pairwise(knots):
        if end - start < 1e-6:  # two events at once
            times[-1] = end if len(times) > 1 else times[-1]
            continue
        middle = (start + end) / 2
        longest = (_LONGEST_TAKEN if any(a < middle < b for a, b in taken) else _LONGEST_FREE) * attempt.mesh
        times += _graded(start, end, min(shortest, longest), longest)
    size = next((size for size in SIZES if size >= len(times) - 1), None)
    if size is None:
        return None
    while len(times) - 1 < size:
        k = int(np.argmax(np.diff(times)))
        times.insert(k + 1, (times[k] + times[k + 1]) / 2)
    times[-1] = arrival
    return np.array(times)


def _graded(start: float, end: float, first: float, longest: float) -> list[float]:
    """Knots after ``start`` up to ``end``: cells grow from both ends towards the middle."""
    half, sizes = (end - start) / 2, [first]
    while sum(sizes) < half:
        sizes.append(min(sizes[-1] * _GROWTH, longest))
    scale = half / sum(sizes)
    widths = np.array(sizes + sizes[::-1]) * scale
    return [*(start + np.cumsum(widths)[:-1]).tolist(), end]


def _departure(ego: Ego, tube: Tube) -> float:
    """The latest time up to which the tube holds the robot at its start."""
    departure = ego.alone.departure
    for bound in tube.upper:
        held = np.flatnonzero(bound.values[:, 1] < _AT_START)
        if len(held):
            departure = max(departure, float(bound.times[held[-1] + 1]))
    return departure


def _tightened(limits: Limits) -> Limits:
    share = 1 - LIMIT_MARGIN
    return Limits(
        limits.speed * share,
        limits.acceleration * share,
        limits.deceleration * share,
        limits.jerk * share,
        limits.lateral_acceleration,
    )
