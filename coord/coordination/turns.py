"""From moves of one robot at a time to motions of all: everybody goes as soon as those it crosses have gone.

Each move becomes a motion from rest to rest, begun once the robot has done its own moves before, and so late that it
comes to no place before all have left it that were to be there earlier. That is a plan, if a slow one. Then every robot
in turn is planned anew against the motions of all others, which makes no other later, until little is gained.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import numpy as np

from coord.alone.inverse import time_at
from coord.coordination.lattice import Lattice
from coord.coordination.moves import Move
from coord.coordination.scene import Scene
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.timing.ego import Ego
from coord.timing.legs import braked, followed, last_moment, onward
from coord.timing.meeting import Meeting
from coord.timing.passing import Timing, passed

#: Rounds in which every robot is planned anew, at most; and they end when one saves less than this share.
_ROUNDS, _LITTLE = 4, 2e-3

#: [s] Between one robot's leaving a cell and another's entering one: times near a stop are good to about 1e-5 s.
_APART = 1e-3

#: [robots] Larger groups are planned in a hurry only.
_SMALL = 8

#: A calmer profile in the end may arrive later by this factor.
_CALM = 1.01


class Solve(Protocol):
    """What plans one robot against some meetings."""

    def __call__(self, ego: Ego, meetings: list[Meeting], *, hurried: bool = False) -> Timing | None:
        """Its profile, None where none is found; ``hurried`` : without asking whether there is a better one."""


def in_turns(
    scene: Scene, group: Sequence[int], lattice: Lattice, moves: Sequence[Move], timings: Mapping[int, Timing]
) -> dict[int, Timing]:
    """Motions of a group from moves that bring it home.

    Parameters
    ----------
    timings : of the robots planned before: nobody starts before those near have arrived.
    """
    before = [timings[k].profile.arrival for i in group for k in scene.neighbours[i] if k in timings]
    first = max(before, default=0.0)
    ways: list[VelocityProfile | None] = [None] * len(group)
    done: list[tuple[Move, Array]] = []
    for move in moves:
        n = move.robot
        ego, way, places = scene.egos[group[n]], ways[n], lattice.places[n]
        ready = max(first, ego.alone.departure if way is None else way.arrival)
        leg = onward(ego, 0.0 if way is None else way.length, ready)
        if move.end < len(places) - 1:
            leg = braked(leg, last_moment(leg, float(places[move.end]), ego.robot.limits), ego.robot.limits)
        enters = time_at(leg, places[move.start : move.end])
        waits = (_late(lattice, move, enters, other, leaves) for other, leaves in done)
        leg = leg.shifted(max(waits, default=0.0))
        ways[n] = followed(way, leg)
        done.append((move, time_at(leg, places[move.start + 1 : move.end + 1])))
    found = {i: way for i, way in zip(group, ways, strict=True) if way is not None}
    return {i: Timing(way, (), (), "stop", scene.egos[i].solo_bound, open=True) for i, way in found.items()}


def _late(lattice: Lattice, move: Move, enters: Array, other: Move, leaves: Array) -> float:
    """By how much a move has to begin later [s] to enter no cell that it must not share before another left its own.

    ``enters`` : when the one would enter its cells [s]; ``leaves`` : when the other leaves its own.
    """
    table = lattice.crossed.get((other.robot, move.robot))
    if table is None:
        return 0.0
    first, second = np.nonzero(table[other.start : other.end, move.start : move.end])
    return max(float((leaves[first] - enters[second]).max()) + _APART, 0.0) if len(first) else 0.0


def improved(
    scene: Scene,
    found: Mapping[int, Timing],
    timings: Mapping[int, Timing],
    solve: Solve,
    check_time: Callable[[], None],
    most: int,
) -> dict[int, Timing]:
    """The same robots, each planned anew against all others until little is gained; ``most`` : so often in all.

    In the end each of a small group is planned once more without hurry, with all that ``solve`` can do.
    """
    now = dict(found)
    tried: dict[int, tuple[VelocityProfile, ...]] = {}
    for _ in range(_ROUNDS):
        began = sum_of(now)
        for i in by_arrival(now):
            rest = {**timings, **now}
            near = [k for k in scene.neighbours[i] if k in rest]
            against = tuple(rest[k].profile for k in near)
            if tried.get(i) == against or most <= 0:
                continue
            check_time()
            most, tried[i] = most - 1, against
            one = solve(scene.egos[i], scene.meetings(i, near, rest, remember=True), hurried=True)
            if one is not None and one.profile.arrival < now[i].profile.arrival:
                now[i] = one
        if sum_of(now) > began * (1 - _LITTLE):
            break
    for i in by_arrival(now) if len(now) <= _SMALL else []:
        check_time()
        rest = {**timings, **now}
        one = solve(
            scene.egos[i], scene.meetings(i, [k for k in scene.neighbours[i] if k in rest], rest, remember=True)
        )
        if one is not None and one.profile.arrival <= now[i].profile.arrival * _CALM:
            now[i] = one
    return told(scene, now, timings)


def sum_of(timings: Mapping[int, Timing]) -> float:
    """Of the arrivals [s]."""
    return math.fsum(one.profile.arrival for one in timings.values())


def by_arrival(timings: Mapping[int, Timing]) -> list[int]:
    """The robots, the first to arrive first."""
    return sorted(timings, key=lambda i: (timings[i].profile.arrival, i))


def told(scene: Scene, found: Mapping[int, Timing], timings: Mapping[int, Timing]) -> dict[int, Timing]:
    """The same in the order of arrivals, each with whom of those before it passes after, and whom before."""
    known: dict[int, Timing] = {}
    for i in by_arrival(found):
        rest = {**timings, **known}
        meetings = scene.meetings(i, [k for k in scene.neighbours[i] if k in rest], rest, remember=True)
        after, before = passed(meetings, found[i].profile)
        known[i] = dataclasses.replace(
            found[i],
            after=after,
            before=before,
            lower_bound=scene.egos[i].solo_bound,
            open=True,
        )
    return known
