"""Robots that stand in each other's way in a ring leave together: planned one after the other, with deadlines.

One after the other they could never come home, since each would have to go first. So whoever is planned keeps away
from the places where those not planned yet rest, and where they still have to pass, until a deadline; and whoever
is planned later has to be gone by the time the others come. Deadlines are raised until all fit. The guarantee of
arrival does not cover such robots: a plan is found, or not.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import TypeAlias

import numpy as np

from coord.alone.inverse import time_at
from coord.conflicts.chords import chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import conflict_regions
from coord.conflicts.rest import runs_over
from coord.coordination.scene import Scene
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

#: A profile against some meetings; None where there is none.
Solve: TypeAlias = Callable[[Ego, list[Meeting]], Timing | None]

#: What came of a robot, against the profiles of those near it and these deadlines: rounds and orders often ask again.
_Memory: TypeAlias = dict[tuple[int, tuple[VelocityProfile, ...], tuple[tuple[int, float], ...]], Timing | None]


def plan_together(
    scene: Scene, group: Sequence[int], timings: Mapping[int, Timing], solve: Solve, check_time: Callable[[], None]
) -> dict[int, Timing] | None:
    """Profiles for all robots of a group, in the order in which they were planned; None where none were found.

    Where nobody in the group has a priority, and it is small, both directions of the order are compared.

    Parameters
    ----------
    group : robots that stand in each other's way in a ring; planned in this order, or with another of them first.
    timings : of the robots planned before.
    check_time : called before each robot; may raise.
    """
    memory: _Memory = {}
    orders = [[i, *(k for k in group if k != i)] for i in group[:_MOST_FIRST]]
    if len(group) <= _SMALL and all(scene.egos[i].robot.priority is None for i in group):
        both = list(group), list(group[::-1])
        found = [_in_order(scene, order, timings, solve, check_time, memory) for order in both]
        sums = [math.inf if one is None else math.fsum(t.profile.arrival for t in one.values()) for one in found]
        if min(sums) < math.inf:
            return found[sums.index(min(sums))]
        orders = orders[1:]
    attempts = (_in_order(scene, order, timings, solve, check_time, memory) for order in orders)
    return next((one for one in attempts if one is not None), None)


def _in_order(
    scene: Scene,
    order: Sequence[int],
    timings: Mapping[int, Timing],
    solve: Solve,
    check_time: Callable[[], None],
    memory: _Memory,
) -> dict[int, Timing] | None:
    """The same with the robots in this order."""
    deadlines: dict[tuple[int, int], float] = {}
    before = [timings[k].profile.arrival for i in order for k in scene.neighbours[i] if k in timings]
    latest = _LATEST * (max(before, default=0.0) + math.fsum(scene.egos[i].alone.arrival for i in order))
    while max(deadlines.values(), default=0.0) <= latest:
        planned: dict[int, Timing] = {}
        for i in order:
            check_time()
            found = _timed(scene, i, order, {**timings, **planned}, deadlines, solve, memory)
            if found is None:
                break
            planned[i] = found
        if len(planned) == len(order):
            return planned
        if not _raised(scene, planned, order[len(planned)], deadlines):
            return None
    return None


def _timed(
    scene: Scene,
    i: int,
    group: Sequence[int],
    timings: Mapping[int, Timing],
    deadlines: Mapping[tuple[int, int], float],
    solve: Solve,
    memory: _Memory,
) -> Timing | None:
    """One robot against those that have a profile, and away from where the others of its group rest or will pass."""
    near = [k for k in scene.neighbours[i] if k in timings]
    waits = [(k, deadlines[i, k]) for k in group if (i, k) in deadlines and k not in timings]
    key = i, tuple(timings[k].profile for k in near), tuple(sorted(waits))
    if key not in memory:
        memory[key] = _against(scene, i, near, timings, waits, solve)
    return memory[key]


def _against(
    scene: Scene,
    i: int,
    near: Sequence[int],
    timings: Mapping[int, Timing],
    waits: Sequence[tuple[int, float]],
    solve: Solve,
) -> Timing | None:
    """The same against some robots with a profile, and with the deadlines of some without."""
    away = [meeting for k, deadline in waits for meeting in _kept_away(scene, i, k, deadline)]
    found = solve(scene.egos[i], scene.meetings(i, near, timings) + away)
    if found is None or not away:
        return found
    # a deadline is a choice, not a fact: what it costs proves nothing
    return dataclasses.replace(
        found,
        after=_among(found.after, timings),
        before=_among(found.before, timings),
        lower_bound=scene.egos[i].solo_bound,
        open=True,
    )


def _among(robots: Sequence[int], known: Collection[int]) -> tuple[int, ...]:
    return tuple(k for k in robots if k in known)


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
