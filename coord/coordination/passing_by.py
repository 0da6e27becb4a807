"""Room to pass: robots that meet head-on and have to leave together, one of them on a path beside the other's.

Two robots that swap places on one line are separated: at some time the one would have to be where the other is. A
detour of one round the other, as it stands where they meet, takes that away. By how much more than needed it keeps
away, the distance decides how exactly the two must hit the right moment.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator
from itertools import combinations

import numpy as np

from coord.conflicts.chords import chords
from coord.conflicts.core import conflict_core
from coord.conflicts.inner import inner_regions
from coord.conflicts.region import ConflictRegion, conflict_regions
from coord.coordination.blocking import Block
from coord.coordination.rerouting import Rerouting
from coord.coordination.way_round import Rests, Way, rests, way_round, way_through
from coord.model.arrays import Point
from coord.model.obstacle import Circle
from coord.model.problem import Problem

#: [m] A detour keeps so much more than the distance from where the other passes. A touch would leave no time to pass.
_ROOM = 0.02

#: Places along the stretch where two robots meet at which one could go round the other; and times at which it is
#: looked where they would meet.
_PLACES, _TIMES = 7, 400


def with_room_to_pass(
    problem: Problem,
    found: Rerouting,
    shape: str,
    check_time: Callable[[], None] = lambda: None,
    at_ease: Collection[tuple[int, ...]] = (),
) -> Rerouting:
    """Paths on which no two robots that have to leave together are separated, as far as there are such paths.

    Of each separated pair the robot goes round the other that loses less time; robots whose paths are given stay on
    them. A new path runs over no place where others rest that the old one did not run over. ``at_ease`` : groups
    that come home on their paths.
    """
    known = rests(problem)
    for i, k in separated_pairs(problem, found, at_ease):
        shares = ((1.0, 0.0), (0.0, 1.0), (0.5, 0.5))
        options = [_apart(known, found, (i, k), share, shape, check_time) for share in shares]
        if not any(options):
            ways = ((*pair, side) for pair in ((i, k), (k, i)) for side in (-1.0, 1.0))
            options = [_abreast(known, found, *way, shape, check_time) for way in ways]
        times = [math.inf if one is None else one.routes[i].time + one.routes[k].time for one in options]
        found = options[int(np.argmin(times))] or found
    return found


def _apart(
    known: Rests,
    found: Rerouting,
    pair: tuple[int, int],
    shares: tuple[float, float],
    shape: str,
    check_time: Callable[[], None],
) -> Rerouting | None:
    """The same with two robots on paths that leave room to pass; None where there are none.

    ``shares`` : of the room, by how much of it each of the two leaves its path.
    """
    robots = known.problem.robots
    if any(share > 0 and robots[k].path for k, share in zip(pair, shares, strict=True)):
        return None
    for place, heading in _places(known.problem, found, *pair):
        for side in (-1.0, 1.0):  # both keep to the right of each other, or both to the left
            check_time()
            changed: Rerouting | None = found
            for driving, other, share in ((*pair, shares[0]), (*pair[::-1], shares[1])):
                if share > 0 and changed is not None:
                    sign = side if driving == pair[0] else -side
                    body = _body(known.problem, driving, other, place, heading, sign, share)
                    changed = _beside(known, changed, driving, other, body, shape)
            if changed is not None and not is_separated(known.problem, changed, *pair):
                return changed
    return None


def _body(
    problem: Problem, driving: int, other: int, place: Point, heading: float, side: float, share: float
) -> Circle:
    """What makes a robot pass a place at a share of the distance that two robots need from each other.

    The whole distance: the other robot, as it stands there. Else something beside it, which leaves less room to the
    one side (+1 left of the heading) than to the other.
    """
    own, rival, clearance = problem.robots[driving].footprint, problem.robots[other], problem.workspace.clearance
    name = f"{rival.name} on its way"
    if share == 1.0:
        return Circle(name, place, rival.footprint.radius + _ROOM)
    needed = own.radius + rival.footprint.radius + clearance + _ROOM
    aside = -side * needed
    center = (place[0] - aside * math.sin(heading), place[1] + aside * math.cos(heading))
    return Circle(name, center, needed + share * needed - own.radius - clearance)


def _beside(known: Rests, found: Rerouting, driving: int, other: int, body: Circle, shape: str) -> Rerouting | None:
    """The same with one robot on a path round a body, over no place of rest that it did not run over before."""
    allowed = frozenset(block for block in found.blocks if block.driving == driving)
    way = way_round(known, driving, found.routes[driving], allowed, shape, also=(body,))
    return None if way is None else _with(found, driving, other, way)


def _abreast(
    known: Rests, found: Rerouting, driving: int, other: int, side: float, shape: str, check_time: Callable[[], None]
) -> Rerouting | None:
    """The same with one robot on a path aside, along and back, at the distance that the two need; None where none is.

    Where they start so near to each other that nothing between them leaves both their places free, it goes out of the
    other's way first (+1 to the left), lets it by, and then goes where it was.
    """
    robot, rival = known.problem.robots[driving], known.problem.robots[other]
    length = math.dist(robot.start, robot.goal)
    if robot.path or robot.via or length == 0:
        return None
    check_time()
    needed = robot.footprint.radius + rival.footprint.radius + known.problem.workspace.clearance + _ROOM
    (x, y), (u, v) = robot.start, robot.goal
    aside = -side * needed * (v - y) / length, side * needed * (u - x) / length
    via = tuple((a + aside[0], b + aside[1]) for a, b in (robot.start, robot.goal))
    allowed = frozenset(block for block in found.blocks if block.driving == driving)
    way = way_through(known, driving, found.routes[driving], allowed, shape, via)
    changed = None if way is None else _with(found, driving, other, way)
    return None if changed is None or is_separated(known.problem, changed, driving, other) else changed


def separated_pairs(
    problem: Problem, found: Rerouting, at_ease: Collection[tuple[int, ...]] = ()
) -> list[tuple[int, int]]:
    """Pairs of robots that have to leave together and cannot pass each other on their paths.

    ``at_ease`` : groups that come home on their paths.
    """
    pairs = (pair for group in found.together if group not in at_ease for pair in combinations(group, 2))
    return [(i, k) for i, k in pairs if is_separated(problem, found, i, k)]


def is_separated(problem: Problem, found: Rerouting, i: int, k: int) -> bool:
    """Whether nothing leads from where both robots start to where both have arrived.

    A connected part of their collision region that reaches from the edge on which i rests at its start, or k at its
    goal, to the edge on which i rests at its goal, or k at its start, lies across all such ways, forwards or back. Seen
    on outer bounds: a planner cannot bring such a pair home.
    """
    first, second = found.routes[i].path.length, found.routes[k].path.length
    blocked = set(found.blocks)
    waits, parks = Block(k, i, "start") in blocked, Block(k, i, "goal") in blocked
    for region in _regions(problem, found, i, k):
        low, high = region.s_range
        before = low < 0 or (parks and region.sigma[-1] >= second)
        after = high > first or (waits and region.sigma[0] <= 0)
        if before and after:
            return True
    return False


def is_proved_separated(problem: Problem, found: Rerouting, i: int, k: int) -> bool:
    """The same seen on what is truly forbidden: then there are no motions at all on these paths."""
    first, second = found.routes[i].path.length, found.routes[k].path.length
    stay = problem.workspace.after_arrival == "stay"  # whoever leaves is at its goal for no time at all
    for part in (part for region in _regions(problem, found, i, k) for part in inner_regions(region, first)):
        low, high = part.s_range
        before = low <= 0 or (stay and part.sigma[-1] >= second)
        after = (stay and high >= first) or part.sigma[0] <= 0
        if before and after:
            return True
    return False


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


def _places(problem: Problem, found: Rerouting, i: int, k: int) -> Iterator[tuple[Point, float]]:
    """Where two robots could pass each other, and i's heading there; the place where they would meet alone first."""
    routes, robots = found.routes, problem.robots
    mine, theirs = (routes[one].alone.shifted(robots[one].release) for one in (i, k))
    t = np.linspace(0.0, max(mine.arrival, theirs.arrival), _TIMES)
    path = routes[i].path
    s = mine.state(t)[:, 0]
    here, there = path.point(s), routes[k].path.point(theirs.state(t)[:, 0])
    nearest = int(np.argmin(np.hypot(*(here - there).T)))
    meeting = (here[nearest] + there[nearest]) / 2
    along = path.length * (np.arange(_PLACES) + 1) / (_PLACES + 1)
    places = np.vstack([meeting, path.point(along)])
    headings = path.pose(np.append(s[nearest], along))[:, 2].tolist()
    order = np.argsort(np.hypot(*(places - meeting).T), kind="stable").tolist()
    for n in order:
        x, y = places[n].tolist()
        yield (x, y), headings[n]


def _with(found: Rerouting, i: int, other: int, way: Way) -> Rerouting:
    """The same with one robot on another way, beside that of another."""
    return found.on(i, way, (*found.beside.get(i, ()), other))
