"""Ways past robots as they stand at some moment: at their starts, at their goals, or aside.

A robot on its way through some places finds the others standing differently on each stage. Its way has to be clear,
on each, of those that stand then.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from coord.conflicts.core import conflict_core
from coord.conflicts.rest import closest, runs_over
from coord.coordination.way_round import Rests, Way, way_round, way_through
from coord.model.arrays import Point, frozen
from coord.model.obstacle import Circle
from coord.model.path import Path, straight
from coord.model.problem import Problem
from coord.model.route import Route

#: [m] So much more than the clearance is kept from who stands aside: it may have to stand a bit off its place.
ROOM = 0.1


class Standing(NamedTuple):
    """A robot that stands at a place [m]."""

    robot: int
    place: Point


class Stage(NamedTuple):
    """A part of a robot's way: the place [m] to which it leads, and who stands where while the robot is on it."""

    place: Point
    others: tuple[Standing, ...]


def reach(problem: Problem, i: int, k: int) -> float:
    """The distance from which on two robots never come too near to each other, however they are turned [m]."""
    robots = problem.robots
    return robots[i].footprint.radius + robots[k].footprint.radius + problem.workspace.clearance


def is_passed(problem: Problem, i: int, path: Path, other: Standing) -> bool:
    """Whether a robot on a path comes too near to another that stands somewhere, by an exact test."""
    own, beside = problem.robots[i].footprint, problem.robots[other.robot].footprint
    distance = own.margin + beside.margin + problem.workspace.clearance
    return runs_over(path, other.place, distance, conflict_core(beside.core, own.core)) is not None


def is_clear(problem: Problem, i: int, path: Path, stages: Sequence[Stage]) -> bool:
    """Whether a robot on a path meets nobody on the way from place to place, as the others stand on each stage."""
    return not any(
        is_passed(problem, i, part, other)
        for part, stage in zip(parts(path, [stage.place for stage in stages]), stages, strict=True)
        for other in near(problem, i, part, stage.others)
    )


def near(problem: Problem, i: int, path: Path, others: Sequence[Standing]) -> list[Standing]:
    """Those of some robots that a closer look at a path is worth."""
    at = path.poses[:, :2]
    room = float(path.pieces[:, 0].max(initial=0.0)) / 2  # a piece lies within half its length of its ends
    low, high = (at.min(axis=0) - room).tolist(), (at.max(axis=0) + room).tolist()
    return [
        other
        for other in others
        if all(
            a - reach(problem, i, other.robot) <= x <= b + reach(problem, i, other.robot)
            for a, x, b in zip(low, other.place, high, strict=True)
        )
    ]


def parts(path: Path, places: Sequence[Point]) -> list[Path]:
    """A path cut where it comes nearest to places in turn; the last part leads to its end, whatever the last place."""
    cuts = [0.0, *(closest(path, place)[1] for place in places[:-1]), path.length]
    return [_part(path, begin, max(begin, end)) for begin, end in pairwise(cuts)]


def _part(path: Path, begin: float, end: float) -> Path:
    x, y, heading = path.pose([begin])[0].tolist()
    inside = path.breaks[(path.breaks > begin) & (path.breaks < end)].tolist()
    pieces = []
    for a, b in pairwise([begin, *inside, end]):
        k = min(int(np.searchsorted(path.breaks, (a + b) / 2, side="right")) - 1, len(path.pieces) - 1)
        if b > a:
            length, k0, k1 = path.pieces[k].tolist()
            rate, first = (k1 - k0) / length, float(path.breaks[k])
            pieces.append((b - a, k0 + rate * (a - first), k0 + rate * (b - first)))
    return Path((x, y, heading), frozen(pieces, 3))


def way_past(known: Rests, i: int, route: Route, stages: Sequence[Stage], shape: str) -> Way | None:
    """A robot's way from its start through the places of its stages, round all who stand on any of them.

    Who stands too near to one of the places is left out, so ``is_clear`` has to follow. The blocks are of all places
    of rest that the way runs over, used just then or not.
    """
    problem, robot = known.problem, known.problem.robots[i]
    ends = [robot.start, *(stage.place for stage in stages)]
    points = [straight(end, end) for end in ends]
    used, aside = np.zeros(len(known.used), dtype=np.bool_), []
    for other in dict.fromkeys(one for stage in stages for one in stage.others):
        k = other.robot
        if any(is_passed(problem, i, point, other) for point in points):
            continue
        resting = (problem.robots[k].start, problem.robots[k].goal)
        if other.place in resting:
            used[2 * k + resting.index(other.place)] = True
        elif all(math.dist(other.place, end) >= reach(problem, i, k) + ROOM for end in ends):
            name, radius = f"{problem.robots[k].name} aside", problem.robots[k].footprint.radius
            aside.append(Circle(name, other.place, radius + ROOM))
    now, via = dataclasses.replace(known, used=used), tuple(ends[1:-1])
    if via:
        way = way_through(now, i, route, frozenset(), shape, via, also=aside)
    else:
        way = way_round(now, i, route, frozenset(), shape, also=aside)
    return None if way is None else Way(way.route, frozenset(known.blocks(way.route.path, i)))
