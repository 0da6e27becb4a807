"""What would help: small changes of a problem, each one tried before it is told.

A diagnosis names robots. With these alone on the floor, the clearance is made smaller, then each of their goals and
starts is moved, until they come home; the smallest change of each kind that was found goes into the remedy. Whoever
plans them may give up early (``MOST_LOOKS``).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final, TypeAlias

from coord.errors import InvalidValueError
from coord.model.arrays import Point
from coord.model.problem import Problem
from coord.model.result import Diagnosis
from coord.model.robot import Robot

#: Diagnoses that a smaller clearance or another place may help against.
_CODES: Final = frozenset({"blocking-cycle", "no-way", "no-way-on-side", "no-room", "no-room-to-turn", "path-too-near"})

#: More robots than this are not tried; nor more moves of their starts and goals.
_MOST_ROBOTS, _MOST_MOVES = 3, 16

#: [m] Told clearances are multiples of this, as are told places; rounds in which the limit is narrowed.
_GRID, _ROUNDS = 1e-3, 5

#: Lengths of moves in units of the robot's radius, and directions.
_STEPS, _DIRECTIONS = (1.0, 2.5), 4

#: A try is given up after so many looks for a way or a motion a robot: where a change helped, it took one each, and
#: where it did not, the last ways to get past each other took tens of them, of the dearest kind.
MOST_LOOKS: Final = 4

#: Whether everybody comes home.
Works: TypeAlias = Callable[[Problem], bool]


def advised(problem: Problem, diagnoses: Sequence[Diagnosis], works: Works) -> tuple[Diagnosis, ...]:
    """The same diagnoses with remedies that were tried; ``works`` plans a problem."""
    return tuple(_with_remedy(problem, diagnosis, works) for diagnosis in diagnoses)


def _with_remedy(problem: Problem, diagnosis: Diagnosis, works: Works) -> Diagnosis:
    robots = tuple(robot for robot in problem.robots if robot.name in diagnosis.robots)
    if diagnosis.code not in _CODES or not robots or len(robots) > _MOST_ROBOTS:
        return diagnosis
    alone = dataclasses.replace(problem, robots=robots)
    if works(alone):  # it takes more robots than these to get stuck: nothing tried here would tell
        return diagnosis
    found = [sentence for sentence in (_clearance(alone, works), _move(alone, works)) if sentence]
    if not found:
        return diagnosis
    only = "" if len(robots) == len(problem.robots) else ", with nobody else on the floor"
    tried = f"Tried{only}: {'; or '.join(found)}."
    return dataclasses.replace(diagnosis, remedy=f"{diagnosis.remedy or ''} {tried}".strip())


def _clearance(problem: Problem, works: Works) -> str:
    """The largest clearance found with which everybody comes home."""
    now = problem.workspace.clearance
    if now <= 0 or not works(_with_clearance(problem, 0.0)):
        return ""
    good, bad = 0.0, now
    for _ in range(_ROUNDS):
        middle = _GRID * math.floor((good + bad) / 2 / _GRID)
        if not good < middle < bad:
            break
        good, bad = (middle, bad) if works(_with_clearance(problem, middle)) else (good, middle)
    return f"a clearance of {good:.3f} m instead of {now:g} m is small enough"


def _with_clearance(problem: Problem, clearance: float) -> Problem:
    return dataclasses.replace(problem, workspace=dataclasses.replace(problem.workspace, clearance=clearance))


def _move(problem: Problem, works: Works) -> str:
    """The shortest move found of one goal or start with which everybody comes home."""
    for tried, (length, robot, which, place) in enumerate(_moves(problem.robots)):
        if tried == _MOST_MOVES:
            break
        try:
            at_goal = which == "goal"
            moved = dataclasses.replace(robot, goal=place) if at_goal else dataclasses.replace(robot, start=place)
            others = tuple(moved if one is robot else one for one in problem.robots)
            changed = dataclasses.replace(problem, robots=others)
        except InvalidValueError:
            continue
        if works(changed):
            return f'the {which} of "{robot.name}" at ({place[0]:.3f}, {place[1]:.3f}), {length:.2f} m away, helps'
    return ""


def _moves(robots: Sequence[Robot]) -> Iterator[tuple[float, Robot, str, Point]]:
    """Moves of goals and starts, the shortest first; robots with given paths stay where they are."""
    options = [
        (step * robot.footprint.radius, k, which, direction)
        for k, robot in enumerate(robots)
        if not robot.path
        for which in ("goal", "start")
        for step in _STEPS
        for direction in range(_DIRECTIONS)
    ]
    for length, k, which, direction in sorted(options, key=lambda one: (one[0], one[2], one[1], one[3])):
        x, y = robots[k].goal if which == "goal" else robots[k].start
        angle = 2 * math.pi * direction / _DIRECTIONS
        place = (_rounded(x + length * math.cos(angle)), _rounded(y + length * math.sin(angle)))
        yield length, robots[k], which, place


def _rounded(value: float) -> float:
    return round(value / _GRID) * _GRID
