"""How a robot of a plan got its path: a plan file keeps the path, not the sides that were compared."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from coord.alone.fastest import fastest
from coord.errors import NoPlanError
from coord.model.options import SHAPES
from coord.model.result import Plan, RobotPlan
from coord.model.route import Route
from coord.paths.routes import find_routes


def route_of(plan: Plan, name: str) -> Route:
    """The route of a robot, found again: in the shape whose path is the plan's, or the plan's path as it is.

    The latter for paths that were given, that lead past places, or that go round other robots.
    """
    part = next(robot for robot in plan.robots if robot.robot.name == name)
    alone = dataclasses.replace(plan.problem, robots=(part.robot,))
    sides: Route | None = None
    for shape in SHAPES:
        try:
            (found,) = find_routes(alone, shape, thorough=True)
        except NoPlanError:
            continue
        if found.path.start == part.path.start and np.array_equal(found.path.pieces, part.path.pieces):
            return found
        sides = sides or found
    profile = fastest(part.path, part.robot.limits)
    remark = (
        "A plan keeps neither via points nor given paths nor ways round other robots; "
        "the dashed ways are those without any of these."
    )
    ways = sides.ways if sides else ()
    return Route(
        part.path, profile, "as planned", "", math.dist(part.robot.start, part.robot.goal), ways, (), (remark,)
    )


def longest_detour(plan: Plan) -> str:
    """The robot whose path is most longer than its straight line."""

    def detour(part: RobotPlan) -> float:
        return part.path.length - math.dist(part.robot.start, part.robot.goal)

    return max(plan.robots, key=detour).robot.name
