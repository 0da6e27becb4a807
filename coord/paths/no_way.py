"""Sentences for people: why a robot has no way, or none on one side, and what would help."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coord.geometry.blocked import Floor
from coord.geometry.clusters import names_of, reaches_edge
from coord.geometry.enclosure import enclosing
from coord.geometry.growth import Grown
from coord.geometry.shapes import distances, part_distances
from coord.model.arrays import Point
from coord.model.path import Path
from coord.model.problem import Problem
from coord.model.result import Diagnosis
from coord.model.robot import Robot
from coord.paths.sides import Blocker, Ground, Ways
from coord.tolerances import DISTANCE

#: More obstacles than this are not named.
_MOST_NAMES = 5


def shut(problem: Problem, robot: Robot, floor: Floor, place: Point) -> Diagnosis | None:
    """Why a robot cannot even stand at a place, or None when it can; the floor is that of all its places."""
    grown = floor.grown
    which = "start" if place == robot.start else "goal" if place == robot.goal else "via point"
    # the search keeps less from what one of the places is too near to: only those parts are looked at closely
    parts = np.flatnonzero(grown.rho - floor.rho > DISTANCE)
    missing = grown.rho[parts] - part_distances(grown.parts[parts], np.array([place]))
    if missing.max(initial=0.0) > DISTANCE:
        most = int(missing.argmax())
        name = f'obstacle "{names_of(problem.obstacles, grown, parts[most : most + 1])[0]}"'
        return _standing(robot, which, place, float(missing[most]), name)
    xmin, ymin, xmax, ymax = grown.box
    beyond = max(xmin - place[0], place[0] - xmax, ymin - place[1], place[1] - ymax)
    return _standing(robot, which, place, beyond, "the edge of the workspace") if beyond > DISTANCE else None


def _standing(robot: Robot, which: str, place: Point, missing: float, name: str) -> Diagnosis:
    text = f'"{robot.name}" cannot stand at its {which} {_at(place)}: it is {missing:.3g} m too near to {name}.'
    return Diagnosis("no-room", (robot.name,), text, place, None, f"Move its {which} by {missing:.3g} m or more.")


def nowhere(problem: Problem, robot: Robot, ways: Ways) -> Diagnosis:
    """No way at all: the end, or via point, that is shut in, by what, and how wide the widest gap is."""
    start, goal = ways.first_cut()
    reach = robot.footprint.radius + problem.workspace.clearance
    end, names, gap = enclosing(problem.obstacles, problem.workspace.bounds, reach, start, goal)
    place = goal if end == "goal" else start
    which = "start" if place == robot.start else "goal" if place == robot.goal else f"via point {_at(place)}"
    text = f'"{robot.name}" has no way from {_at(start)} to {_at(goal)}: its {which} is shut in by {listed(names)}.'
    radius, clearance = robot.footprint.radius, problem.workspace.clearance
    needs = f"it needs {2 * reach:.2f} m ({2 * radius:g} m wide, {clearance:g} m clearance on either side)"
    remedy = f"There is no gap at all; {needs}." if gap is None else f"The widest gap is {2 * gap:.2f} m; {needs}."
    remedy += f" Widen a passage, or move its {which}."
    return Diagnosis("no-way", (robot.name,), text, place, None, remedy)


def on_side(problem: Problem, ground: Ground, blockers: Sequence[Blocker], side: str) -> str:
    """Why one cannot pass everything on the straight line on one side."""
    members = [np.flatnonzero(ground.clusters == blocker.cluster) for blocker in blockers]
    at_edge = [parts for parts in members if reaches_edge(ground.grown, parts)]
    names = listed(names_of(problem.obstacles, ground.grown, np.concatenate(at_edge or members)))
    if at_edge:
        return f"there is no gap on the {side} between {names} and the edge of the workspace"
    return f"the way round on the {side} of {names} is closed by other obstacles or the edge of the workspace"


def not_on_side(robot: Robot, reason: str) -> Diagnosis:
    """The side that was asked for does not exist."""
    text = f'"{robot.name}" shall pass on the {robot.side}, but {reason}.'
    remedy = 'Take side = "quickest", or make room there.'
    return Diagnosis("no-way-on-side", (robot.name,), text, robot.start, None, remedy)


def no_room_to_turn(robot: Robot) -> Diagnosis:
    """A way through the via points exists, but not with the turns that it needs there."""
    places = ", ".join(_at(place) for place in robot.via)
    text = f'"{robot.name}" cannot pass its via points {places}: there is no room to turn at one of them.'
    remedy = "Move the via point away from obstacles, or let the way through it turn less sharply."
    return Diagnosis("no-room-to-turn", (robot.name,), text, robot.via[0] if robot.via else robot.start, None, remedy)


def bad_path(robot: Robot, sentence: str) -> Diagnosis:
    """A given path that cannot be driven as it is."""
    text = f'"{robot.name}" cannot drive its given path: {sentence}.'
    return Diagnosis("bad-path", (robot.name,), text, robot.start, None, "Change the path's points.")


def given_too_near(problem: Problem, robot: Robot, grown: Grown, path: Path) -> Diagnosis:
    """A given path that does not keep the distance: where, from what, and how much is missing."""
    s = np.linspace(0.0, path.length, max(int(path.length / 0.02), 2))
    points = path.point(s)
    worst, place, name = 0.0, robot.start, "an obstacle"
    (left, lower), (right, upper) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    for k in Floor(grown, grown.rho).near_parts((left, lower, right, upper)).tolist():
        missing = grown.rho[k] - distances(grown.parts[k], points)
        if missing.max() > worst:
            at = points[int(missing.argmax())]
            worst, place = float(missing.max()), (float(at[0]), float(at[1]))
            name = f'obstacle "{names_of(problem.obstacles, grown, np.array([k]))[0]}"'
    xmin, ymin, xmax, ymax = grown.box
    low, high = points - (xmin, ymin), (xmax, ymax) - points
    beyond = -np.minimum(low.min(axis=1), high.min(axis=1))
    if beyond.max() > worst:
        at = points[int(beyond.argmax())]
        worst, place, name = float(beyond.max()), (float(at[0]), float(at[1])), "the edge of the workspace"
    text = f'The given path of "{robot.name}" comes {worst:.3g} m too near to {name} at {_at(place)}.'
    remedy = "Move the path's points, or make its corners tighter with corner_radius."
    return Diagnosis("path-too-near", (robot.name,), text, place, None, remedy)


def listed(names: Sequence[str]) -> str:
    """Names for a sentence; the edge of the workspace where there are none."""
    shown = [f'"{name}"' for name in names[:_MOST_NAMES]]
    if len(names) > _MOST_NAMES:
        shown.append(f"{len(names) - _MOST_NAMES} others")
    return " and ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown) or "the edge of the workspace"


def _at(place: Point) -> str:
    return f"({place[0]:.2f}, {place[1]:.2f})"
