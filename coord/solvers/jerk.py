"""The door of ruckig: time-optimal jerk-limited motions between two states (Berscheid & Kroeger 2021)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import ruckig

from coord.errors import SolverError
from coord.model.profile import State, VelocityProfile, integrate
from coord.model.robot import Limits

#: [s] Phases shorter than this are dropped: they carry no motion, and knots must stay distinct.
SHORTEST_PHASE = 1e-10

#: How far (m, m/s, m/s2) the end of the phases may lie from the state asked for. Ruckig itself takes motions
#: that miss it by 1e-8, which the checker would refuse.
END_SLACK = 1e-10

#: What ruckig raises when it finds nothing; above 7,600 s its code has no name in Python, a ValueError.
_FAILURES = (ruckig.RuckigError, ValueError)


def motion(start: State, goal: State, limits: Limits, duration: float | None = None) -> VelocityProfile | None:
    """The quickest motion from one state to another, or the one that takes exactly ``duration`` [s].

    The motion begins at t = 0, never moves backwards and keeps speed, acceleration, deceleration and jerk.
    None when ruckig finds no such motion: the way is too short for the change of speed, or the duration
    cannot be met exactly.
    """
    request = _request(start, goal, limits, duration)
    for scale in (1.0, 1.0 - 1e-9):  # ruckig fails on some round numbers: a hair less of everything helps
        _set_limits(request, limits, scale)
        trajectory = ruckig.Trajectory(1)
        try:
            if not request.validate(True, True):
                return None
            outcome = ruckig.Ruckig(1).calculate(request, trajectory)
        except _FAILURES:
            continue
        if outcome != ruckig.Result.Working:
            continue
        if duration is not None and abs(trajectory.duration - duration) > 1e-9 * max(1.0, duration):
            return None  # a longer motion was given instead
        profile = _profile(start, goal, trajectory)
        if profile is not None:
            return profile
    return None


class LinkTimes:
    """How long the quickest motion between two states takes, thousands of times over with the same limits.

    Calling ``motion`` for that would spend most of its time on profiles that nobody looks at.
    """

    def __init__(self, limits: Limits, *, remember: bool = False) -> None:
        """Prepare one request, of which only the states and the cap change; answers can be kept for the next time."""
        self._known: dict[tuple[tuple[float, float], tuple[float, float], float, float], float] | None
        self._known = {} if remember else None
        self._request = _request((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), limits, None)
        _set_limits(self._request, limits, 1.0)
        self._solver, self._trajectory = ruckig.Ruckig(1), ruckig.Trajectory(1)

    def __call__(self, start: tuple[float, float], goal: tuple[float, float], length: float, cap: float) -> float:
        """Duration [s] from (speed, acceleration) to (speed, acceleration) over ``length`` [m] below a cap [m/s].

        Infinite where no such motion is found.
        """
        if self._known is None:
            return self._duration(start, goal, length, cap)
        question = (start, goal, length, cap)
        if question not in self._known:
            self._known[question] = self._duration(*question)
        return self._known[question]

    def _duration(self, start: tuple[float, float], goal: tuple[float, float], length: float, cap: float) -> float:
        request = self._request
        request.max_velocity = [cap]
        request.current_velocity, request.current_acceleration = [start[0]], [start[1]]
        request.target_velocity, request.target_acceleration = [goal[0]], [goal[1]]
        request.target_position = [length]
        try:
            if not request.validate(True, True):
                return math.inf
            outcome = self._solver.calculate(request, self._trajectory)
        except _FAILURES:
            return math.inf
        found = self._trajectory.profiles[0][0]
        miss = max(abs(found.p[-1] - found.pf), abs(found.v[-1] - found.vf), abs(found.a[-1] - found.af))
        if outcome != ruckig.Result.Working or miss > END_SLACK or min(found.v) < -END_SLACK:
            return math.inf
        return float(self._trajectory.duration)


def rest_to_rest(length: float, limits: Limits) -> VelocityProfile:
    """The quickest motion over ``length`` [m] > 0 from rest to rest.

    Raises
    ------
    SolverError
        When ruckig fails, which no known input makes it do.
    """
    profile = motion((0.0, 0.0, 0.0), (length, 0.0, 0.0), limits)
    if profile is None:
        raise SolverError(f"no rest-to-rest motion found over {length!r} m within {limits}")
    return profile


def _request(start: State, goal: State, limits: Limits, duration: float | None) -> Any:
    request = ruckig.InputParameter(1)
    # from position 0: ruckig loses digits at other places, and then fails
    request.current_position = [0.0]
    request.current_velocity = [start[1]]
    request.current_acceleration = [start[2]]
    request.target_position = [goal[0] - start[0]]
    request.target_velocity = [goal[1]]
    request.target_acceleration = [goal[2]]
    if duration is not None:
        request.minimum_duration = duration
    return request


def _set_limits(request: Any, limits: Limits, scale: float) -> None:
    request.max_velocity = [limits.speed * scale]
    request.min_velocity = [0.0]  # exactly 0: None lets it reverse, -1e-6 lets it creep backwards for ever
    request.max_acceleration = [limits.acceleration * scale]
    request.min_acceleration = [-limits.deceleration * scale]
    request.max_jerk = [limits.jerk * scale]


def _phases(trajectory: Any) -> Iterator[tuple[float, float]]:
    profile = trajectory.profiles[0][0]
    yield from zip(profile.brake.t, profile.brake.j, strict=True)
    yield from zip(profile.t, profile.j, strict=True)


def _profile(start: State, goal: State, trajectory: Any) -> VelocityProfile | None:
    phases = [(float(h), float(j)) for h, j in _phases(trajectory) if h >= SHORTEST_PHASE]
    durations, jerks = [h for h, _ in phases], [j for _, j in phases]
    states = integrate(start, durations, jerks)
    if any(abs(got - asked) > END_SLACK for got, asked in zip(states[-1], goal, strict=True)):
        return None
    if min(v for _, v, _ in states) < -END_SLACK:
        return None
    states[-1] = goal
    return VelocityProfile([0.0, *itertools.accumulate(durations)], states, jerks)  # type: ignore[arg-type]
