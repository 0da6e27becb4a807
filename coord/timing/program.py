"""The quickest and the smoothest motion through a tube, by linear and quadratic programs on a time grid.

For a fixed arrival the jerk-limited motions inside a tube form a convex set, and arrivals that are possible
stay possible when they come later. So the program asks how far the robot can get until it rests at a given
time; as it covers at most ``speed`` metres a second, the metres that lack give a next arrival that is still
not too late, and the search rises to the least possible one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from coord.alone.check import keeps_limits
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.knots import Cells
from coord.solvers.linear import farthest, smoothest
from coord.timing.ego import Ego
from coord.timing.grid import Course, border_times, cells_between, cells_in, time_knots
from coord.timing.polish import land_exactly
from coord.timing.rounds import LACK, Settled, first_guess, is_hopeless, rounds
from coord.timing.tube import Tube
from coord.tolerances import LIMIT_MARGIN

#: Scales of the cells: the finer grid is for tubes that the coarser one finds too narrow. The finest, by effort, are
#: for tubes that nothing else decides.
_MESHES, _FINER_MESHES = (1.0, 0.4, 0.16, 0.07), ((), (0.03, 0.015), (0.03, 0.015, 0.008))

#: [1] A finer grid is worth its while as long as this share of the arrival may be gained; with bends it costs more.
_FINER, _FINER_IN_BENDS = 5e-4, 1e-3

#: [s] The search for the arrival ends when it rises by less than this; by less still on the finest grids.
_ARRIVAL_STEP = 2e-3

#: Steps of that search at most: a few suffice where motions are found.
_MOST_STEPS = 12

#: [m] An upper bound below this holds the robot at its start: it departs when the bound has risen above.
_AT_START = 2e-3

#: On paths with bends, and how much longer than in the rounds a motion may take to fit exactly [s].
_MESHES_OF_BENDS, _PAUSES = (0.8, 0.33, 0.13), (1e-3, 8e-3)

#: What follows where nothing else decides, as long as a finer mesh brings what lacks below this share.
_FINER_MESH_OF_BENDS, _LESS = 0.055, 0.75

#: Samples of a profile for its course.
_SAMPLES = 400

#: How often the cells of bends are corrected by the last solution.
_CORRECTIONS = 2


def through_tube(
    ego: Ego, tube: Tube, least: float, most: float, course: Course | None = None, *, effort: int = 0,
    is_enough: Callable[[VelocityProfile], bool] = lambda profile: False,
) -> VelocityProfile | None:  # fmt: skip
    """The quickest profile through a tube with an arrival between ``least`` and ``most`` [s]; None if none is found.

    ``least`` must not be later than the best arrival there is. The profile keeps the limits (checked
    exactly); whether it is clear of the windows the caller checks. A tight tube may be too narrow for the
    bounds on a coarse grid, or cost time there, so finer ones are tried after the coarse one.

    Parameters
    ----------
    course : a rough motion through the tube, which a path with bends needs: it says which cells are in which bend.
    effort : 0, or 1 and 2 where a narrow tube is worth finer and the finest grids.
    is_enough : whether finer grids are of no use for a motion such as this one.
    """
    if not ego.caps.is_constant:
        if course is None:
            return None
        return _round_bends(ego, tube, least, most, course, fine=effort > 0, is_enough=is_enough)
    best = None
    for mesh in (*_MESHES, *_FINER_MESHES[effort]):
        many = effort > 0 and mesh <= _MESHES[-1]
        attempt = _Attempt(ego, tube, tightened(ego.robot.limits), held_until(ego, tube), mesh, many)
        profile = _through(attempt, least, most)
        gains = 0.0 if profile is None else 1.0 if best is None else best.arrival / profile.arrival - 1
        if gains > 0:
            best = profile
        if best is not None:
            most = best.arrival * (1 - _FINER)
            if best.arrival <= least * (1 + _FINER) or (many and gains < _FINER) or is_enough(best):
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
    """A tube on one mesh: limits a little tightened, cells scaled by ``mesh``, thousands of them where ``many``."""

    ego: Ego
    tube: Tube
    limits: Limits
    departure: float
    mesh: float
    many: bool = False

    @property
    def step(self) -> float:
        """How close [s] the arrival is sought."""
        return _ARRIVAL_STEP * min(1.0, self.mesh / _MESHES[-1])


def _through(attempt: _Attempt, least: float, most: float) -> VelocityProfile | None:
    if _reach(attempt, most) < 0:
        return None
    arrival = _least(attempt, least, most)
    for pause in (1.0, 3.0, 10.0) if attempt.many else (0.0, 1.0, 3.0, 10.0):  # what does not fit takes longest
        at = min(arrival + pause * attempt.step, most)
        profile = _smooth(attempt, at, None)
        if profile is not None:
            return profile
        if at == most:
            break
    return None


def _least(attempt: _Attempt, least: float, most: float) -> float:
    """The least arrival on the grid, which can be reached at ``most``.

    Where metres lack, so many seconds more are needed at least. Grids are built anew for each arrival, so that a large
    step may lead too far: then it is gone back. Where no motion is found at all the difference is halved.
    """
    ego, speed = attempt.ego, attempt.limits.speed
    low, high = max(least, attempt.departure + (ego.alone.arrival - ego.alone.departure) * 0.5), most
    arrival = min(low, high)
    for _ in range(_MOST_STEPS):
        reached = _reach(attempt, arrival) / speed
        if abs(reached) <= attempt.step:
            return arrival
        low, high = (arrival, high) if reached < 0 else (low, arrival)
        if high - low <= attempt.step:
            break
        arrival = arrival - reached if low < arrival - reached < high else (low + high) / 2
    return high


def _reach(attempt: _Attempt, arrival: float) -> float:
    """How far beyond its goal [m] the robot could rest at the arrival; negative where it cannot get there."""
    ego = attempt.ego
    times = _knots(attempt, arrival, None)
    if times is None:
        return -np.inf
    reached = farthest(cells_in(attempt.tube, times, ego.length, ego.caps, None), attempt.limits)
    return -np.inf if reached is None else reached - ego.length


def _round_bends(
    ego: Ego,
    tube: Tube,
    least: float,
    most: float,
    course: Course,
    *,
    fine: bool,
    is_enough: Callable[[VelocityProfile], bool],
) -> VelocityProfile | None:
    """The quickest profile that rounds about a course lead to: finer ones only where they may gain something."""
    limits, departure = tightened(ego.robot.limits), held_until(ego, tube)
    meshes = (*_MESHES_OF_BENDS, _FINER_MESH_OF_BENDS) if fine else _MESHES_OF_BENDS
    attempts = [_Attempt(ego, tube, limits, departure, mesh, fine) for mesh in meshes]
    settled, lacked = first_guess(ego, course, departure, most), np.inf
    for attempt, finer in zip(attempts, (*attempts[1:], None), strict=True):
        mesh = attempt.mesh
        if mesh == _FINER_MESH_OF_BENDS and settled.lacks > _LESS * lacked:
            break
        lacked, is_first, least_lacking = settled.lacks, attempt is attempts[0], settled
        for found in rounds(ego, tube, limits, mesh, most, settled, is_first=is_first, many=fine):
            settled, least_lacking = found, min(least_lacking, found, key=lambda one: one.lacks)
            if settled.is_near:
                may_gain = settled.arrival > least * (1 + _FINER_IN_BENDS) and not is_enough(settled.course.profile)
                if may_gain and finer is not None and _grid_of(finer, settled) is not None:
                    break
                profile = _fitting(attempt, most, settled)
                if profile is not None:
                    return profile
        if settled.lacks > LACK:  # rounds may lead away again
            settled = least_lacking
        if is_hopeless(settled, mesh):
            return None
    if settled.lacks > LACK:
        return None
    fits = (_fitting(attempt, most, settled) for attempt in reversed(attempts))
    return next((profile for profile in fits if profile is not None), None)


def _fitting(attempt: _Attempt, most: float, settled: Settled) -> VelocityProfile | None:
    """The profile with the borders passed as in the rounds, a little later where it does not fit else."""
    ego = attempt.ego
    for pause in _PAUSES:
        arrival = min(settled.arrival + pause, most)
        times = _grid_of(attempt, settled, arrival)
        if times is None:
            return None
        profile = _profile(attempt, cells_between(attempt.tube, times, ego.length, ego.caps, settled.passes))
        if profile is not None:
            return profile
        if arrival == most:
            return None
    return None


def _smooth(attempt: _Attempt, arrival: float, course: Course | None, ease: float = 0.0) -> VelocityProfile | None:
    ego = attempt.ego
    times = _knots(attempt, arrival, course)
    if times is None:
        return None
    if course is not None:
        course = course.within(float(times[0]), arrival)
    cells = cells_in(attempt.tube, times, ego.length, ego.caps, course)
    return _profile(attempt, cells, ease)


def _profile(attempt: _Attempt, cells: Cells, ease: float = 0.0) -> VelocityProfile | None:
    """The smoothest motion in the cells, exactly at the goal; None where there is none."""
    ego = attempt.ego
    jerks = smoothest(cells, attempt.limits, ego.length, ease)
    if jerks is None:
        return None
    profile = land_exactly(cells.h, jerks, ego.length, attempt.departure)
    if profile is None or not keeps_limits(profile, ego.robot.limits, ego.caps):
        return None
    return profile


def _knots(attempt: _Attempt, arrival: float, course: Course | None) -> Array | None:
    if course is None:  # a little is gained, and little lost without bends, by knots where bounds begin to change, too
        further = [time for span in attempt.tube.spans for time in span]
    else:
        further = border_times(attempt.ego.caps, course.within(attempt.departure, arrival))
    return _grid(attempt, arrival, further)


def _grid_of(attempt: _Attempt, settled: Settled, arrival: float | None = None) -> Array | None:
    """The grid on which the borders are passed as in the rounds; None where it would be too large."""
    return _grid(attempt, settled.arrival if arrival is None else arrival, settled.passes.tolist())


def _grid(attempt: _Attempt, arrival: float, further: Sequence[float]) -> Array | None:
    # without bends finer meshes, which cost little there, do as well
    limits, mesh, cut = attempt.limits, attempt.mesh, attempt.many or not attempt.ego.caps.is_constant
    return time_knots(attempt.tube, attempt.departure, arrival, limits, mesh, further, many=attempt.many, cut=cut)


def course_of(profile: VelocityProfile, since: float) -> Course:
    """The course of a profile, the wait from ``since`` [s] to its departure included."""
    even = np.linspace(profile.departure, profile.arrival, _SAMPLES)
    times = np.unique(np.concatenate([[min(since, profile.departure)], profile.times, even]))
    return Course(times, np.maximum.accumulate(profile.places(times)))


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
