"""Every robot's path: a straight line where it is free, else the shortest way round the obstacles."""

from __future__ import annotations

from collections.abc import Callable

from coord.errors import NoPlanError
from coord.geometry.enclosure import enclosing
from coord.geometry.growth import Grown, grow
from coord.model.path import Path, straight
from coord.model.problem import Problem
from coord.model.result import Diagnosis
from coord.model.robot import Robot
from coord.paths.skeleton import NoWay, skeleton
from coord.paths.taut import taut


def shortest_paths(problem: Problem, done: Callable[[int], None]) -> list[Path]:
    """The paths of all robots, in the order of the problem; ``done`` is called with the number found so far.

    Raises
    ------
    NoPlanError
        When robots have no way at all; all of them are named, with what encloses them.
    """
    floors: dict[float, Grown] = {}
    paths, missing = [], []
    for robot in problem.robots:
        reach = robot.footprint.radius + problem.workspace.clearance
        if reach not in floors:
            floors[reach] = grow(problem.obstacles, reach, problem.workspace.bounds)
        if robot.start == robot.goal:
            paths.append(straight(robot.start, robot.goal))
        else:
            found = skeleton(floors[reach], robot.start, robot.goal)
            if isinstance(found, NoWay):
                missing.append(_no_way(problem, robot, reach))
            else:
                paths.append(taut(found))
        done(len(paths))
    if missing:
        raise NoPlanError(missing)
    return paths


def _no_way(problem: Problem, robot: Robot, reach: float) -> Diagnosis:
    which, names, gap = enclosing(problem.obstacles, problem.workspace.bounds, reach, robot.start, robot.goal)
    place = robot.goal if which == "goal" else robot.start
    if len(names) > 5:
        names = [*names[:5], "and others"]
    wall = ", ".join(f'"{name}"' if name != "and others" else name for name in names) or "the edge of the workspace"
    text = (
        f'"{robot.name}" has no way from ({robot.start[0]:.2f}, {robot.start[1]:.2f}) to '
        f"({robot.goal[0]:.2f}, {robot.goal[1]:.2f}): its {which} is shut in by {wall} "
        f"for a disc of radius {robot.footprint.radius:g} m that keeps {problem.workspace.clearance:g} m clearance."
    )
    remedy = f"Open a passage wider than {2 * reach:g} m, or move its {which}."
    if gap is not None:
        remedy = f"The widest passage lets a reach of {gap:.3f} m through, and it needs {reach:g} m. " + remedy
    return Diagnosis("no-way", (robot.name,), text, place, None, remedy)
