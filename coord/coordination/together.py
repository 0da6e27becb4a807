"""Robots that stand in each other's way in a ring leave together: planned one after the other, with deadlines.

One after the other they could never come home, since each would have to go first. So whoever is planned keeps away
from the places where those not planned yet rest, and where they still have to pass, until a deadline; and whoever
is planned later has to be gone by the time the others come. Deadlines are raised until all fit. Besides, moves of one
robot at a time are sought that bring all home, and become motions at the same time. The guarantee of arrival does not
cover such robots: a plan is found, or not, with so much work at most, counted in robots planned.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from coord.alone.inverse import time_at
from coord.conflicts.chords import chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import conflict_regions
from coord.conflicts.rest import runs_over
from coord.coordination.homeward import Homeward
from coord.coordination.lattice import Floor, lattice_of
from coord.coordination.moves import MOST_STATES, moves_home
from coord.coordination.scene import Scene
from coord.coordination.turns import Solve, improved, in_turns, sum_of, told
from coord.model.arrays import Point, frozen
from coord.model.path import Path, straight
from coord.model.profile import VelocityProfile
from coord.timing.ego import Ego
from coord.timing.meeting import Ends, Meeting
from coord.timing.passing import Timing

#: By which factor deadlines are raised; and they end at so many times what all of the group need one after the other.
_RAISE, _LATEST = 1.3, 2.0

#: Groups up to this size are planned in two orders; of others, up to so many robots are tried first.
_SMALL, _MOST_FIRST = 4, 6

#: Places of a path among which the nearest to a point is sought.
_SAMPLES = 400

#: A robot with so many meetings takes long: where moves are known anyway, it counts as so many robots planned.
_MANY, _DEAR = 32, 30

#: Larger groups that have moves home do without deadlines.
_MOST_WITH_DEADLINES = 8

#: How often each robot of a group may be planned on average while deadlines are sought: of two, of more, and where
#: the lattice has no moves home. How often all of a group while a plan is improved; of a large one, each time it is
#: planned against so many others, so often that it meets this many.
_MOST_OF_TWO, _MOST_TRIES, _FEW_TRIES, _MOST_ANEW, _MOST_MEETINGS = 30, 4, 2, 60, 840

#: What came of a robot, against the profiles of those near it and these deadlines: rounds and orders often ask again.
_Memory: TypeAlias = dict[tuple[int, tuple[VelocityProfile, ...], tuple[tuple[int, float], ...]], Timing | None]


def plan_together(
    scene: Scene,
    group: Sequence[int],
    timings: Mapping[int, Timing],
    solve: Solve,
    check_time: Callable[[], None],
    homeward: Homeward | None = None,
) -> dict[int, Timing] | None:
    """Profiles for all robots of a group, in the order of their arrivals; None where none were found.

    Deadlines are tried; moves one after the other are sought, too, which then become motions at the same time. Both
    plans are improved, and the better one is taken. Two robots that find a plan with deadlines are left with it: what
    is better for them was measured to be worse for the pairs after them.

    Parameters
    ----------
    group : robots that stand in each other's way in a ring; planned in this order, or with another of them first.
    timings : of the robots planned before.
    check_time : called before each robot; may raise.
    homeward : moves that bring the group home, where they are known: then nothing else is sought.
    """
    if homeward is not None:
        slow = in_turns(scene, homeward.group, homeward.lattice, homeward.moves, timings)
        return improved(scene, slow, timings, solve, check_time, _MOST_MEETINGS // len(group))
    floor = Floor([one.robot for one in scene.egos], [one.path for one in scene.egos], scene.blocked, scene.clearance)
    lattice = lattice_of(floor, group)
    moves, is_whole = (None, False) if lattice is None else moves_home(lattice, MOST_STATES)[:2]
    tries = _MOST_OF_TWO if len(group) == 2 else _FEW_TRIES if moves is None and is_whole else _MOST_TRIES
    search = _Search(scene, timings, solve, check_time, tries * len(group), 1 if moves is None else _DEAR)
    plan = None if len(group) > _MOST_WITH_DEADLINES and moves is not None else _with_deadlines(search, group)
    if plan is not None and len(group) == 2:
        return told(scene, plan, timings)
    plans = [] if plan is None else [plan]
    if lattice is not None and moves is not None:
        plans.append(in_turns(scene, group, lattice, moves, timings))
    plans = [improved(scene, one, timings, solve, check_time, _MOST_ANEW) for one in plans]
    return min(plans, key=sum_of, default=None)


@dataclass(slots=True, eq=False)
class _Search:
    """What the attempts with deadlines share.

    ``left`` : how many robots may still be planned in all of them; ``dear`` : as how many one counts that meets many.
    """

    scene: Scene
    timings: Mapping[int, Timing]
    solve: Solve
    check_time: Callable[[], None]
    left: int
    dear: int
    memory: _Memory = field(default_factory=dict)


def _with_deadlines(search: _Search, group: Sequence[int]) -> dict[int, Timing] | None:
    """Profiles for all robots, planned in some order.

    Where nobody in the group has a priority, and it is small, both directions of the order are compared.
    """
    orders = [[i, *(k for k in group if k != i)] for i in group[:_MOST_FIRST]]
    if len(group) <= _SMALL and all(search.scene.egos[i].robot.priority is None for i in group):
        found = [_in_order(search, order) for order in (list(group), list(group[::-1]))]
        known = [one for one in found if one is not None]
        if known:
            return min(known, key=sum_of)
        orders = orders[1:]
    attempts = (_in_order(search, order) for order in orders)
    return next((one for one in attempts if one is not None), None)


def _in_order(search: _Search, order: Sequence[int]) -> dict[int, Timing] | None:
    """The same with the robots in this order."""
    scene, timings = search.scene, search.timings
    deadlines: dict[tuple[int, int], float] = {}
    before = [timings[k].profile.arrival for i in order for k in scene.neighbours[i] if k in timings]
    latest = _LATEST * (max(before, default=0.0) + math.fsum(scene.egos[i].alone.arrival for i in order))
    while max(deadlines.values(), default=0.0) <= latest and search.left > 0:
        planned: dict[int, Timing] = {}
        for i in order:
            search.check_time()
            found = _timed(search, i, order, {**timings, **planned}, deadlines)
            if found is None:
                break
            planned[i] = found
        if len(planned) == len(order):
            return planned
        if not _raised(scene, planned, order[len(planned)], deadlines):
            return None
    return None


def _timed(
    search: _Search,
    i: int,
    group: Sequence[int],
    timings: Mapping[int, Timing],
    deadlines: Mapping[tuple[int, int], float],
) -> Timing | None:
    """One robot against those that have a profile, and away from where the others of its group rest or will pass."""
    near = [k for k in search.scene.neighbours[i] if k in timings]
    waits = [(k, deadlines[i, k]) for k in group if (i, k) in deadlines and k not in timings]
    key = i, tuple(timings[k].profile for k in near), tuple(sorted(waits))
    if key not in search.memory:
        away = [meeting for k, deadline in waits for meeting in _kept_away(search.scene, i, k, deadline)]
        meetings = search.scene.meetings(i, near, timings, remember=True) + away
        search.left -= search.dear if len(meetings) >= _MANY else 1
        search.memory[key] = search.solve(search.scene.egos[i], meetings, hurried=True)
    return search.memory[key]


def _raised(scene: Scene, planned: Collection[int], stuck: int, deadlines: dict[tuple[int, int], float]) -> bool:
    """Let those planned wait longer for one that found no profile; whether any of them is in its way at all."""
    found = False
    for i in planned:
        needs = max((time for _, time in _places(scene, i, stuck)), default=None)
        if needs is not None:
            deadlines[i, stuck] = _RAISE * deadlines[i, stuck] if (i, stuck) in deadlines else needs
            found = True
    return found


def _kept_away(scene: Scene, i: int, k: int, deadline: float) -> Iterator[Meeting]:
    """Robot k as if it stood, until a deadline, at its start on i's path and where it passes i's goal."""
    ego, other = scene.egos[i].robot, scene.egos[k].robot
    core = conflict_core(ego.footprint.core, other.footprint.core)
    distance = ego.footprint.margin + other.footprint.margin + scene.clearance
    still = VelocityProfile(frozen([deadline]), frozen([[0.0, 0.0, 0.0]], 3), frozen([]))
    for place, _ in _places(scene, i, k):
        if runs_over(straight(ego.start, ego.start), place, distance, core) is not None:
            continue  # nobody can keep away from where it starts
        goal_free = runs_over(straight(ego.goal, ego.goal), place, distance, core) is None
        ends = Ends(start_free=True, goal_free=goal_free, other_waits=True, other_parks=False)
        at = chords(straight(place, place))
        for region in conflict_regions(scene.chords[i], at, distance, core, start_free=True, goal_free=goal_free):
            yield Meeting(region, k, still, ends, scene.egos[i].length)


def _places(scene: Scene, i: int, k: int) -> Iterator[tuple[Point, float]]:
    """Where robot k rests, or has to pass, in robot i's way; and when it is gone from there, alone."""
    ego, other = scene.egos[i], scene.egos[k]
    reach = ego.robot.footprint.radius + other.robot.footprint.radius + scene.clearance
    if (k, i, "start") in scene.blocked:
        yield other.robot.start, _time_at(other, reach)
    if (i, k, "goal") in scene.blocked:
        s = _nearest(other.path, ego.robot.goal)
        x, y = other.path.point(np.array([s]))[0].tolist()
        yield (x, y), _time_at(other, s + reach)


def _time_at(ego: Ego, s: float) -> float:
    """When a robot alone is at s [m], at the end where its path is shorter."""
    return float(time_at(ego.alone, np.array([min(s, ego.length)]))[0])


def _nearest(path: Path, place: Point) -> float:
    """Where on a path [m] it comes about nearest to a place."""
    s = np.linspace(0.0, path.length, _SAMPLES)
    gap = path.point(s) - np.array(place)
    return float(s[np.argmin(np.hypot(*gap.T))])
