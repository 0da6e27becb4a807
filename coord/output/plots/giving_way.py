"""Where on the floor a robot gives way: what the plan says about who passes after whom, as places."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from coord.model.arrays import Array, Point
from coord.model.result import Plan, RobotPlan
from coord.output.plots.style import is_late

#: [s] Time between two samples, and the most samples of all.
_STEP, _MOST_SAMPLES = 0.02, 4000

#: [m] Of robots that come equally close, the first one to do so is the decisive one.
_AS_CLOSE: Final = 1e-3


class GivesWay(NamedTuple):
    """``robot`` is at ``place`` [m] when it comes closest to ``other``, which it lets pass, at ``time`` [s]."""

    robot: RobotPlan
    other: RobotPlan
    place: Point
    time: float


def giving_way(plan: Plan) -> list[GivesWay]:
    """For each delayed robot the place where the robot that it waits for leaves it the least room.

    Of all that it lets pass the decisive one is the one that it comes closest to; found from samples, for
    drawing only.
    """
    count = min(_MOST_SAMPLES, math.ceil(plan.makespan / _STEP) + 2)
    t = np.linspace(0.0, plan.makespan, count)
    by_name = {robot.robot.name: robot for robot in plan.robots}
    places: dict[str, Array] = {}

    def places_of(robot: RobotPlan) -> Array:
        name = robot.robot.name
        if name not in places:
            places[name] = robot.path.point(robot.profile.state(t)[:, 0])
        return places[name]

    found = []
    for robot in plan.robots:
        others = [by_name[name] for name in robot.after if name in by_name]
        if is_late(robot) and others:
            driving = int(np.searchsorted(t, robot.arrival, side="right"))
            moments = [_closest(robot, other, t[:driving], places_of(robot), places_of(other)) for other in others]
            least = min(room for room, _ in moments)
            decisive = [mark for room, mark in moments if room <= least + _AS_CLOSE]
            found.append(min(decisive, key=lambda mark: mark.time))
    return found


def _closest(robot: RobotPlan, other: RobotPlan, t: Array, here: Array, there: Array) -> tuple[float, GivesWay]:
    """How close two robots come [m], rim to rim; the places (m, 2) begin at the times t."""
    room = np.hypot(*(here[: len(t)] - there[: len(t)]).T)
    k = int(np.argmin(room))
    place = (float(here[k, 0]), float(here[k, 1]))
    rims = robot.robot.footprint.radius + other.robot.footprint.radius
    return float(room[k]) - rims, GivesWay(robot, other, place, float(t[k]))
