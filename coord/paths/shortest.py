"""Every robot's path: a straight line where it is free, else the shortest way round the obstacles."""

from __future__ import annotations

from collections.abc import Callable

from coord.errors import NoPlanError
from coord.geometry.enclosure import enclosing
from coord.geometry.growth import Grown, grow
from coord.model.footprint import Footprint
from coord.model.path import Path, straight
from coord.model.problem import Problem
from coord.model.result import Diagnosis
from coord.model.robot import Robot
from coord.paths.fitted import fitted
from coord.paths.skeleton import NoWay, search_floor, skeleton
from coord.paths.taut import taut


def shortest_paths(problem: Problem, done: Callable[[int], None], shape: str = "fitted") -> list[Path]:
    """The paths of all robots, in the order of the problem; ``done`` is called with the number found so far.

    Parameters
    ----------
    shape : "fitted" (turns as wide as pays) or "taut" (the shortest way itself).

    Raises
    ------
    NoPlanError
        When robots have no way at all; all of them are named, with what encloses them.
    """
    floors: dict[Footprint, Grown] = {}
    paths, missing = [], []
    for robot in problem.robots:
        reach = robot.footprint.radius + problem.workspace.clearance
        if robot.footprint not in floors:
            floors[robot.footprint] = grow(
                problem.obstacles, robot.footprint, problem.workspace.clearance, problem.workspace.bounds
            )
        if robot.start == robot.goal:
            paths.append(straight(robot.start, robot.goal))
        else:
            floor = search_floor(floors[robot.footprint], robot.start, robot.goal)
            found = skeleton(floor, robot.start, robot.goal)
            if isinstance(found, NoWay):
                missing.append(_no_way(problem, robot, reach))
            else:
                paths.append(taut(found) if shape == "taut" else fitted(found, robot.limits, floor))
        done(len(paths))
    if missing:
        raise NoPlanError(missing)
    return paths


def _no_way(problem: Problem, robot: Robot, reach: float) -> Diagnosis:
    which, names, gap = enclosing(problem.obstacles, problem.workspace.bounds, reach, robot.start, robot.goal)
    place = robot.goal if which == "goal" else robot.start
    shown = [f'"{name}"' for name in names[:5]] + (["others"] if len(names) > 5 else [])
    wall = " and ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown) or "the edge of the workspace"
    text = (
        f'"{robot.name}" has no way from ({robot.start[0]:.2f}, {robot.start[1]:.2f}) to '
        f"({robot.goal[0]:.2f}, {robot.goal[1]:.2f}): its {which} is shut in by {wall}."
    )
    radius, clearance = robot.footprint.radius, problem.workspace.clearance
    needs = f"it needs {2 * reach:.2f} m ({2 * radius:g} m wide, {clearance:g} m clearance on either side)"
    remedy = f"There is no gap at all; {needs}." if gap is None else f"The widest gap is {2 * gap:.2f} m; {needs}."
    remedy += f" Widen a passage, or move its {which}."
    return Diagnosis("no-way", (robot.name,), text, place, None, remedy)
