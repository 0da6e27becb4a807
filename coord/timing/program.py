"""The quickest and the smoothest motion through a tube, by linear and quadratic programs on a time grid.

For a fixed arrival the jerk-limited motions inside a tube form a convex set, and arrivals that are possible
stay possible when they come later. So the program asks how far the robot can get until it rests at a given
time; as it covers at most ``speed`` metres a second, the metres that lack give a next arrival that is still
not too late, and the search rises to the least possible one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coord.alone.check import keeps_limits
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.linear import farthest_way, smoothest
from coord.timing.ego import Ego
from coord.timing.grid import Course, border_times, cells_in, course_through, time_knots
from coord.timing.polish import land_exactly
from coord.timing.tube import Tube
from coord.tolerances import LIMIT_MARGIN

#: Scales of the cells: the finer grid is for tubes that the coarser one finds too narrow.
_MESHES = (1.0, 0.4, 0.16, 0.07)

#: [1] A finer grid is worth its while as long as this share of the arrival may be gained.
_FINER = 5e-4

#: [s] The search for the arrival ends when it rises by less than this.
_ARRIVAL_STEP = 2e-3

#: [m] An upper bound below this holds the robot at its start: it departs when the bound has risen above.
_AT_START = 2e-3

#: [s] So much later than on a course the robot may arrive at first.
_LATER = (0.0, 1.0)

#: [m] By so much the bounds are eased, one after the other; and how many times that may lack at the goal.
_EASES, _LACK = (0.03, 0.015, 0.008, 0.004, 0.002, 0.001, 0.0), 3.0

#: The search from above ends after so many arrivals, or when the last ones differ by less than this share.
_FALLS, _NEAR = 10, 1e-3

#: [s] How much earlier than on the last course the robot may enter a bend, at the price of the bend's cap until then.
_LEADS = (0.05, 0.0, 3.0, 0.8, 0.1)

#: Samples of a profile for its course.
_SAMPLES = 400

#: How often the cells of bends are corrected by the last solution.
_CORRECTIONS = 2


def through_tube(
    ego: Ego, tube: Tube, least: float, most: float, course: Course | None = None
) -> VelocityProfile | None:
    """The quickest profile through a tube with an arrival between ``least`` and ``most`` [s]; None if none is found.

    ``least`` must not be later than the best arrival there is. The profile keeps the limits (checked
    exactly); whether it is clear of the windows the caller checks. A tight tube may be too narrow for the
    bounds on a coarse grid, or cost time there, so finer ones are tried after the coarse one.

    Parameters
    ----------
    course : a rough motion through the tube, which a path with bends needs: it says which cells are in which bend.
    """
    if course is None and not ego.caps.is_constant:
        return None
    best = None
    for mesh in _MESHES:
        attempt = _Attempt(ego, tube, tightened(ego.robot.limits), held_until(ego, tube), mesh)
        profile = _through(attempt, least, most, course)
        if profile is not None and (best is None or profile.arrival < best.arrival):
            best = profile
            most, course = best.arrival * (1 - _FINER), None if course is None else course_of(best, attempt.departure)
        if best is not None and best.arrival <= least * (1 + _FINER):
            break
    return best


def smooth_through(
    ego: Ego, tube: Tube, arrival: float, mesh: float, ease: float = 0.0, course: Course | None = None
) -> VelocityProfile | None:
    """The profile through a tube that arrives at a time with the least squared jerk; None where none is found.

    ``ease`` : weight [1/s2] of the squared acceleration beside the squared jerk; ``course`` as for ``through_tube``.
    """
    attempt = _Attempt(ego, tube, tightened(ego.robot.limits), held_until(ego, tube), mesh)
    best = None
    for _ in range(1 if ego.caps.is_constant else 1 + _CORRECTIONS):
        course = None if course is None else course.until(attempt.departure, arrival)
        profile = _smooth(attempt, arrival, course, ease)
        if profile is None:
            return best
        best, course = profile, course_of(profile, attempt.departure)
    return best


@dataclass(frozen=True, slots=True, eq=False)
class _Attempt:
    """A tube on one mesh: limits a little tightened, cells scaled by ``mesh``."""

    ego: Ego
    tube: Tube
    limits: Limits
    departure: float
    mesh: float


def _through(attempt: _Attempt, least: float, most: float, course: Course | None) -> VelocityProfile | None:
    if course is None:
        if _reach(attempt, most, None)[0] < 0:
            return None
        arrival = _rising(attempt, least, most)
    else:
        first = _first(attempt, most, course)
        if first is None:
            return None
        most, course = first
        arrival, course = _falling(attempt, least, most, course)
    for pause in (0.0, _ARRIVAL_STEP, 3 * _ARRIVAL_STEP, 10 * _ARRIVAL_STEP):
        at = min(arrival + pause, most)
        profile = _smooth(attempt, at, course)
        if profile is not None:
            return profile
        if at == most:
            break
    return None


def _first(attempt: _Attempt, most: float, course: Course) -> tuple[float, Course] | None:
    """An arrival up to ``most`` that is possible, and its course; None where none is found.

    The course is only rough, and a bend entered a moment too late can leave a narrow tube without any motion. So the
    program is solved with all bounds eased, then less and less so, each time with the bends where the last solution
    has them. That is tried with the course's own arrival and with a little more time; at last the course is
    stretched over all the time there is.
    """
    end = float(course.times[-1])
    for more in _LATER:
        arrival = min(end + more, most)
        eased = _eased(attempt, arrival, course)
        if eased is not None:
            return arrival, eased
        if arrival == most:
            return None
    reached, better = _reach(attempt, most, course.until(attempt.departure, most))
    return (most, better) if reached >= 0 and better is not None else None


def _eased(attempt: _Attempt, arrival: float, course: Course) -> Course | None:
    """The course of a motion that is beyond its goal by the arrival; None where none is found."""
    length = attempt.ego.length
    for ease in _EASES:
        for lead in _LEADS[:2]:
            times = _knots(attempt, arrival, course)
            if times is None:
                return None
            now = course.within(attempt.departure, arrival)
            cells = cells_in(attempt.tube, times, length, attempt.ego.caps, now, lead)
            cells = replace(cells, upper=cells.upper + ease, lower=cells.lower - ease)
            states = farthest_way(cells, attempt.limits)
            if states is not None and states[-1, 0] >= length - _LACK * ease:
                course = course_through(times, states)
                break
        else:
            return None
    return course


def _rising(attempt: _Attempt, least: float, most: float) -> float:
    """The least arrival on the grid, from below: where metres lack, so many seconds more are needed at least."""
    ego = attempt.ego
    arrival = max(least, attempt.departure + (ego.alone.arrival - ego.alone.departure) * 0.5)
    while True:
        reached, _ = _reach(attempt, arrival, None)
        step = min(max(-reached, 0.0), 10 * ego.length) / attempt.limits.speed
        if arrival + step >= most:
            return most
        arrival += step
        if step <= _ARRIVAL_STEP:
            return arrival


def _falling(attempt: _Attempt, least: float, most: float, course: Course) -> tuple[float, Course]:
    """An early arrival and its course, from above: only a course that gets there tells which cells are in which bend.

    The robot that gets farthest passes its goal at speed; had it stopped there, it would have arrived about a
    stop later. That is tried first, then the middle between what is known to do and what is not.
    """
    ego, low, arrival = attempt.ego, least, most
    stop = float(ego.landing.profile.arrival) - ego.landing.profile.length / ego.landing.speed
    for _ in range(_FALLS):
        trial = float(course.passes(np.array([ego.length]))[0]) + stop
        if not low < trial < arrival - _ARRIVAL_STEP:
            trial = (low + arrival) / 2
        reached, better = _reach(attempt, trial, course.cut(trial, ego.length))
        if reached < 0:
            better = _eased(attempt, trial, course.cut(trial, ego.length))
        if better is not None:
            arrival, course = trial, better
        else:
            low = trial
        if arrival - low < _NEAR * arrival:
            break
    return arrival, course.cut(arrival, ego.length)


def _reach(attempt: _Attempt, arrival: float, course: Course | None) -> tuple[float, Course | None]:
    """How far beyond its goal [m] the robot could rest at the arrival, and the course there on a path with bends.

    Negative where it cannot get there. With bends the last solution tells again which cells are in which bend,
    as long as that gets the robot farther.
    """
    ego, reached = attempt.ego, -np.inf
    for lead in (0.0,) if course is None else _LEADS:
        times = _knots(attempt, arrival, course)
        if times is None:
            break
        now = None if course is None else course.within(attempt.departure, arrival)
        states = farthest_way(cells_in(attempt.tube, times, ego.length, ego.caps, now, lead), attempt.limits)
        if states is None and lead == _LEADS[0]:
            break  # later leads ask for more
        if states is None or states[-1, 0] - ego.length <= reached:
            continue
        reached = float(states[-1, 0]) - ego.length
        course = None if course is None else course_through(times, states)
    return reached, course


def _smooth(attempt: _Attempt, arrival: float, course: Course | None, ease: float = 0.0) -> VelocityProfile | None:
    ego = attempt.ego
    times = _knots(attempt, arrival, course)
    if times is None:
        return None
    if course is not None:
        course = course.within(float(times[0]), arrival)
    cells = cells_in(attempt.tube, times, ego.length, ego.caps, course)
    jerks = smoothest(cells, attempt.limits, ego.length, ease)
    if jerks is None:
        return None
    profile = land_exactly(cells.h, jerks, ego.length, attempt.departure)
    if profile is None or not keeps_limits(profile, ego.robot.limits, ego.caps):
        return None
    return profile


def _knots(attempt: _Attempt, arrival: float, course: Course | None) -> Array | None:
    borders = [] if course is None else border_times(attempt.ego.caps, course.within(attempt.departure, arrival))
    return time_knots(attempt.tube, attempt.departure, arrival, attempt.limits, attempt.mesh, borders)


def course_of(profile: VelocityProfile, since: float) -> Course:
    """The course of a profile, the wait from ``since`` [s] to its departure included."""
    even = np.linspace(profile.departure, profile.arrival, _SAMPLES)
    times = np.unique(np.concatenate([[min(since, profile.departure)], profile.times, even]))
    return Course(times, np.maximum.accumulate(profile.state(times)[:, 0]))


def held_until(ego: Ego, tube: Tube) -> float:
    """The latest time up to which the tube holds the robot at its start."""
    departure = ego.alone.departure
    for bound in tube.upper:
        held = np.flatnonzero(bound.values[:, 1] < _AT_START)
        if len(held):
            departure = max(departure, float(bound.times[held[-1] + 1]))
    return departure


def tightened(limits: Limits) -> Limits:
    """Limits a little below those given, so that the solver's rounding keeps them."""
    share = 1 - LIMIT_MARGIN
    return Limits(
        limits.speed * share,
        limits.acceleration * share,
        limits.deceleration * share,
        limits.jerk * share,
        limits.lateral_acceleration,
    )
