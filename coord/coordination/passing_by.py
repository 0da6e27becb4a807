"""Room to pass: robots that meet head-on and have to leave together, one of them on a path beside the other's.

Two robots that swap places on one line are separated: at some time the one would have to be where the other is. A
detour of one round the other, as it stands where they meet, takes that away. By how much more than needed it keeps
away, the distance decides how exactly the two must hit the right moment.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np

from coord.conflicts.chords import chords
from coord.conflicts.core import conflict_core
from coord.conflicts.inner import inner_regions
from coord.conflicts.region import ConflictRegion, conflict_regions
from coord.coordination.blocking import Block, in_order
from coord.coordination.rerouting import Rerouting
from coord.coordination.way_round import Rests, Way, rests, way_round
from coord.model.arrays import Point
from coord.model.obstacle import Circle
from coord.model.problem import Problem

#: [m] A detour keeps so much more than the distance from where the other passes. A touch would leave no time to pass.
_ROOM = 0.02

#: Places along the stretch where two robots meet at which one could go round the other; and times at which it is
#: looked where they would meet.
_PLACES, _TIMES = 7, 400


def with_room_to_pass(
    problem: Problem, found: Rerouting, shape: str, check_time: Callable[[], None] = lambda: None
) -> Rerouting:
    """Paths on which no two robots that have to leave together are separated, as far as there are such paths.

    Of each separated pair the robot goes round the other that loses less time; robots whose paths are given stay on
    them. A new path runs over no place where others rest that the old one did not run over.
    """
    known = rests(problem)
    for i, k in separated_pairs(problem, found):
        options = []
        for driving, other in ((i, k), (k, i)):
            changed = _beside(known, found, driving, other, shape, check_time)
            if changed is not None:
                options.append((changed.routes[driving].time - found.routes[driving].time, driving, changed))
        if options:
            found = min(options, key=lambda option: option[:2])[2]
    return found


def _beside(
    known: Rests, found: Rerouting, driving: int, other: int, shape: str, check_time: Callable[[], None]
) -> Rerouting | None:
    """The same with one robot on a path that leaves another room to pass; None where there is none."""
    problem = known.problem
    if problem.robots[driving].path:
        return None
    rival = problem.robots[other]
    allowed = frozenset(block for block in found.blocks if block.driving == driving)
    for place in _places(problem, found, driving, other):
        check_time()
        body = Circle(f"{rival.name} on its way", place, rival.footprint.radius + _ROOM)
        way = way_round(known, driving, found.routes[driving], allowed, shape, also=(body,))
        if way is not None:
            changed = _with(found, driving, other, way)
            if not is_separated(problem, changed, driving, other):
                return changed
    return None


def separated_pairs(problem: Problem, found: Rerouting) -> list[tuple[int, int]]:
    """Pairs of robots that have to leave together and cannot pass each other on their paths."""
    pairs = (pair for group in found.together for pair in combinations(group, 2))
    return [(i, k) for i, k in pairs if is_separated(problem, found, i, k)]


def is_separated(problem: Problem, found: Rerouting, i: int, k: int) -> bool:
    """Whether robot i could pass robot k neither after nor before, because places of rest of i are in the way of both.

    Seen on outer bounds of their collision region: a planner cannot bring such a pair home.
    """
    length = found.routes[i].path.length
    return any(region.s_range[0] < 0 and region.s_range[1] > length for region in _regions(problem, found, i, k))


def is_proved_separated(problem: Problem, found: Rerouting, i: int, k: int) -> bool:
    """The same seen on what is truly forbidden: then there are no motions at all on these paths.

    A connected part of the region that reaches from the one's start to its goal leaves no way from (0, 0), where both
    start, to where both have arrived, forwards or back.
    """
    length = found.routes[i].path.length
    parts = (part for region in _regions(problem, found, i, k) for part in inner_regions(region, length))
    return any(part.s_range[0] <= 0 and part.s_range[1] >= length for part in parts)


def _regions(problem: Problem, found: Rerouting, i: int, k: int) -> tuple[ConflictRegion, ...]:
    robots, blocked = problem.robots, set(found.blocks)
    own, other = robots[i].footprint, robots[k].footprint
    return conflict_regions(
        chords(found.routes[i].path),
        chords(found.routes[k].path),
        own.margin + other.margin + problem.workspace.clearance,
        conflict_core(own.core, other.core),
        start_free=Block(i, k, "start") not in blocked,
        goal_free=Block(i, k, "goal") not in blocked,
    )


def _places(problem: Problem, found: Rerouting, driving: int, other: int) -> Iterator[Point]:
    """Where one robot could go round another that it would meet head-on, the place where both would be first."""
    routes, robots = found.routes, problem.robots
    mine, theirs = (routes[k].alone.shifted(robots[k].release) for k in (driving, other))
    t = np.linspace(0.0, max(mine.arrival, theirs.arrival), _TIMES)
    here, there = (routes[k].path.point(one.state(t)[:, 0]) for k, one in ((driving, mine), (other, theirs)))
    nearest = int(np.argmin(np.hypot(*(here - there).T)))
    meeting = tuple(((here[nearest] + there[nearest]) / 2).tolist())
    path = routes[driving].path
    along = path.point(path.length * (np.arange(_PLACES) + 1) / (_PLACES + 1)).tolist()
    places: list[Point] = [(meeting[0], meeting[1]), *((x, y) for x, y in along)]
    yield from sorted(places, key=lambda place: math.dist(place, meeting))


def _with(found: Rerouting, i: int, other: int, way: Way) -> Rerouting:
    """The same with one robot on another way, beside that of another."""
    routes = [*found.routes]
    routes[i] = way.route
    rest = [block for block in found.blocks if block.driving != i]
    blocks = tuple(sorted((*rest, *way.blocks), key=in_order))
    beside = {**found.beside, i: (*found.beside.get(i, ()), other)}
    return dataclasses.replace(found, routes=tuple(routes), blocks=blocks, beside=beside)
