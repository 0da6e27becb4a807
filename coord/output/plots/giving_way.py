"""Where on the floor a robot gives way: what the plan says about who passes after whom, as places."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from coord.model.arrays import Point
from coord.model.result import Plan, RobotPlan
from coord.output.plots.style import is_late

#: [s] Time between two samples, and the most samples of one robot.
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
    by_name = {robot.robot.name: robot for robot in plan.robots}
    found = []
    for robot in plan.robots:
        others = [by_name[name] for name in robot.after if name in by_name]
        if is_late(robot) and others:
            found.append(_closest(robot, others))
    return found


def _closest(robot: RobotPlan, others: list[RobotPlan]) -> GivesWay:
    count = min(_MOST_SAMPLES, math.ceil(robot.arrival / _STEP) + 2)
    t = np.linspace(0.0, robot.arrival, count)
    here = robot.path.point(robot.profile.state(t)[:, 0])
    moments = []
    for other in others:
        there = other.path.point(other.profile.state(t)[:, 0])
        room = np.hypot(*(here - there).T) - robot.robot.footprint.radius - other.robot.footprint.radius
        k = int(np.argmin(room))
        moments.append((float(room[k]), float(t[k]), other, (float(here[k, 0]), float(here[k, 1]))))
    least = min(room for room, *_ in moments)
    _, time, other, place = min((m for m in moments if m[0] <= least + _AS_CLOSE), key=lambda moment: moment[1])
    return GivesWay(robot, other, place, time)
