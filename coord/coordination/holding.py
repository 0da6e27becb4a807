"""Holding places: a large group comes home one robot at a time, and some step aside first.

Where many robots stand in each other's way before one door, paths that are all laid at once leave no order. So the
order comes first: whoever finds a way to its goal past all others, as they stand just then, goes home. Where nobody
does, one that keeps others from it steps aside, to a place off their ways, and goes on when its own way is free; its
path leads through that place. What comes of it is a list of legs, each from rest to rest.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from coord.conflicts.rest import closest
from coord.coordination.flood import Raster
from coord.coordination.rerouting import Rerouting
from coord.coordination.standing import ROOM, Stage, Standing, is_clear, is_passed, near, reach, way_past
from coord.coordination.way_round import Rests, Way
from coord.geometry.shapes import too_near
from coord.model.arrays import Array, Point
from coord.model.problem import Problem

#: [m] Holding places are sought on a grid this wide, so far around a robot; paths are looked at so far apart.
_GRID, _AROUND, _SAMPLE = 0.25, 8.0, 0.3

#: How often a robot steps aside, at most; and of the places where it could, so many are tried, so far apart [m].
_MOST_ASIDE, _MOST_PLACES, _APART = 2, 4, 1.0

#: [m] A place on the way of one other robot is as bad as one so much farther.
_ON_A_WAY = 3.0

#: How often it is begun anew without holding places that failed; and searches for a way, for each robot of a group.
_MOST_ANEW, _MOST_WAYS = 6, 10

#: The shape of ways to a place while it is found out whether it helps.
_SKETCH = "taut"


class Leg(NamedTuple):
    """A robot drives on to a place on its path [m], and rests there until its next leg."""

    robot: int
    place: float


def one_by_one(
    raster: Raster, known: Rests, found: Rerouting, group: Sequence[int], shape: str, check_time: Callable[[], None]
) -> tuple[Rerouting, list[Leg]] | None:
    """Paths of a group and legs on them that bring all home, one after the other; None where none were found.

    Nobody's new path runs over a place of rest of a robot outside the group that the old one did not run over.

    Parameters
    ----------
    raster, known : of the problem.
    shape : of the paths, as in ``find_routes``.
    check_time : called before each search for a way; may raise.
    """
    search = _Search(raster, known, found, tuple(group), shape, check_time, _MOST_WAYS * len(group))
    for _ in range(_MOST_ANEW):
        failed = len(search.spoilt)
        legs = search.run()
        if legs is not None:
            return search.rerouted(), legs
        if len(search.spoilt) == failed:
            break
    return None


@dataclass(slots=True, eq=False)
class _Search:
    """The robots of a group as they stand; ``left`` : searches for a way that may still be made.

    ``at`` : where those stand that are not home; ``aside`` : the stages of each robot up to where it holds;
    ``ways`` : of those that are home; ``spoilt`` : robots with places to which or from which they found no way.
    """

    raster: Raster
    known: Rests
    found: Rerouting
    group: tuple[int, ...]
    shape: str
    check_time: Callable[[], None]
    left: int
    at: dict[int, Point] = field(default_factory=dict)
    aside: dict[int, list[Stage]] = field(default_factory=dict)
    ways: dict[int, Way] = field(default_factory=dict)
    spoilt: set[Standing] = field(default_factory=set)
    outside: dict[int, tuple[Standing, ...]] = field(init=False)
    passed: dict[tuple[int, Standing], bool] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.outside = {i: self._outside(i) for i in self.group}

    @property
    def problem(self) -> Problem:
        return self.known.problem

    @property
    def stays(self) -> bool:
        return self.problem.workspace.after_arrival == "stay"

    def run(self) -> list[Leg] | None:
        """The legs; None where nobody can go on, perhaps because of a place that is then noted as spoilt."""
        self.at = {i: self.problem.robots[i].start for i in self.group}
        self.aside, self.ways = {i: [] for i in self.group}, {}
        order: list[tuple[int, int]] = []
        while self.at and self.left > 0:
            i = next(filter(self.goes_home, self.by_goal()), None)
            if i is None:
                if self.notes_spoilt():
                    return None
                i = next(filter(self.steps_aside, self.in_the_way()), None)
            if i is None:
                return None
            order.append((i, len(self.aside[i]) - (i in self.at)))
        return None if self.at else [self.leg(i, n) for i, n in order]

    def leg(self, i: int, n: int) -> Leg:
        """The n-th leg of a robot, on the path that it got in the end."""
        path, aside = self.ways[i].route.path, self.aside[i]
        return Leg(i, closest(path, aside[n].place)[1] if n < len(aside) else path.length)

    def rerouted(self) -> Rerouting:
        """All robots, those of the group on their ways; who is on a new one leaves room to the others."""
        found = self.found
        for i, way in self.ways.items():
            if way.route is not found.routes[i]:
                found = found.on(i, way, tuple(k for k in self.group if k != i))
        around = {i: one for i, one in found.around.items() if found.routes[i] is self.found.routes[i]}
        return dataclasses.replace(found, around=around)

    # who stands where

    def _outside(self, i: int) -> tuple[Standing, ...]:
        """Places of rest of robots outside the group, but for those that a robot's path runs over already."""
        members = set(self.group)
        over = {(block.resting, block.at) for block in self.found.blocks if block.driving == i}
        return tuple(
            Standing(k, place)
            for k, robot in enumerate(self.problem.robots)
            for at, place in (("start", robot.start), ("goal", robot.goal))
            if k not in members and (k, at) not in over and (at == "start" or self.stays)
        )

    def homed(self, i: int) -> tuple[Standing, ...]:
        """Who stands in a robot's way for good: those of the group that are home, and all outside."""
        robots = self.problem.robots
        home = (Standing(k, robots[k].goal) for k in self.group if self.stays and k not in self.at and k != i)
        return (*home, *self.outside[i])

    def others(self, i: int) -> tuple[Standing, ...]:
        """All that stand in a robot's way now."""
        return (*(Standing(k, place) for k, place in self.at.items() if k != i), *self.homed(i))

    def passes(self, i: int, other: Standing) -> bool:
        """Whether the path that a robot had leads over another that stands at a place."""
        if (i, other) not in self.passed:
            path = self.found.routes[i].path
            self.passed[i, other] = bool(near(self.problem, i, path, [other])) and is_passed(
                self.problem, i, path, other
            )
        return self.passed[i, other]

    def free(self, i: int, others: Iterable[Standing]) -> int:
        """Cells of the raster that others leave to a robot."""
        robots, own = self.problem.robots, self.problem.robots[i].footprint
        taken = 0
        for k, place in others:
            taken |= self.raster.beside(own, robots[k].footprint, place)
        return self.raster.ground(own) & ~taken

    # who goes home

    def by_goal(self) -> list[int]:
        """Robots that are not home, those first on whose goals the fewest others have their way."""
        robots = self.problem.robots
        hit = {i: sum(self.passes(k, Standing(i, robots[i].goal)) for k in self.at if k != i) for i in self.at}
        return sorted(self.at, key=lambda i: (hit[i], i))

    def goes_home(self, i: int) -> bool:
        """Bring a robot home, if it finds a way there that leaves the others one."""
        if not self.may_go_home(i, self.others(i)) or not self.leaves_ways(i):
            return False
        stages = [*self.aside[i], Stage(self.problem.robots[i].goal, self.others(i))]
        way = self.way(i, stages, self.shape)
        if way is None:
            return False
        self.ways[i] = way
        del self.at[i]
        return True

    def way(self, i: int, stages: Sequence[Stage], shape: str) -> Way | None:
        """The robot's present way where it is clear, else a new one; None where that is not clear, either."""
        route, robot = self.found.routes[i], self.problem.robots[i]
        if len(stages) == 1 and is_clear(self.problem, i, route.path, stages):
            return Way(route, frozenset(block for block in self.found.blocks if block.driving == i))
        if robot.path or self.left <= 0:
            return None
        self.check_time()
        self.left -= 1
        way = way_past(self.known, i, route, stages, shape)
        return way if way is not None and is_clear(self.problem, i, way.route.path, stages) else None

    def may_go_home(self, i: int, others: Iterable[Standing]) -> bool:
        """Whether the raster leaves a way home past some others."""
        goal, free = self.raster.cell(self.problem.robots[i].goal), self.free(i, others)
        return bool(goal & free) and bool(self.raster.reached(self.at[i], free, goal) & goal)

    def leaves_ways(self, i: int) -> bool:
        """Whether all others may still come home once a robot is, past those only that are."""
        now = Standing(i, self.problem.robots[i].goal)
        rest = [k for k in self.at if k != i]
        if not self.stays or not any(self.passes(k, now) for k in rest):
            return True
        return all(self.may_go_home(k, (now, *self.homed(k))) for k in rest)

    def notes_spoilt(self) -> bool:
        """Note robots that hold where the raster lets them go home but no way does; whether there are any."""
        some = [i for i in self.at if self.aside[i] and self.may_go_home(i, self.others(i))]
        self.spoilt.update(Standing(i, self.at[i]) for i in some)
        return bool(some)

    # who steps aside

    def in_the_way(self) -> list[int]:
        """Robots that could step aside, those first that keep the most others from going home."""
        robots = self.problem.robots
        able = [k for k in self.at if not robots[k].path and not robots[k].via and len(self.aside[k]) < _MOST_ASIDE]
        kept = dict.fromkeys(self.at, 0)
        for i in self.at:
            for k in self.gates(i):
                kept[k] += 1
        stood_on = {k: sum(self.passes(i, Standing(k, self.at[k])) for i in self.at if i != k) for k in able}
        return sorted(able, key=lambda k: (not kept[k], len(self.aside[k]), -kept[k], -stood_on[k], k))

    def gates(self, i: int) -> list[int]:
        """Robots without any one of which the raster leaves another a way home."""
        robots, raster = self.problem.robots, self.raster
        free, goal = self.free(i, self.others(i)), robots[i].goal
        to, back = (raster.widened(raster.reached(place, free)) for place in (self.at[i], goal))
        own, found = robots[i].footprint, []
        others = [k for k in self.at if k != i]
        discs = {k: raster.beside(own, robots[k].footprint, self.at[k]) for k in others}
        over = [k for k in others if discs[k] & raster.cell(goal)]
        if len(over) <= 1:
            found = [k for k in over or others if discs[k] & to and discs[k] & back]
        return found

    def steps_aside(self, k: int) -> bool:
        """Send a robot aside, if there is a place from which it keeps nobody from going home that it kept before."""
        helped = [i for i in self.at if i != k and k in self.gates(i)]
        for place in self.places(k):
            if self.left <= 0:
                return False
            now = Standing(k, place)
            if helped and not any(self.may_go_home(i, self.all_but(i, k, now)) for i in helped):
                continue
            stages = [*self.aside[k], Stage(place, self.others(k))]
            if not self.is_reached(k, stages):
                self.spoilt.add(now)
                continue
            self.aside[k].append(stages[-1])
            self.at[k] = place
            return True
        return False

    def all_but(self, i: int, k: int, now: Standing) -> Iterator[Standing]:
        """Who stands in a robot's way if another stands somewhere else."""
        return (now if other.robot == k else other for other in self.others(i))

    def is_reached(self, k: int, stages: Sequence[Stage]) -> bool:
        """Whether there is a way to the last of some stages."""
        self.check_time()
        self.left -= 1
        robot = self.problem.robots[k]
        on = Stage(robot.goal, ())
        way = way_past(self.known, k, self.found.routes[k], [*stages, on], _SKETCH)
        return way is not None and is_clear(self.problem, k, way.route.path, [*stages, on])

    def places(self, k: int) -> Iterator[Point]:
        """Where a robot could hold: those first that are near to it and to its goal, and off the ways of others."""
        free = self.holding_places(k)
        x, y = self.at[k]
        gap = free - (x, y)
        cost = np.hypot(*gap.T) + np.hypot(*(free - self.problem.robots[k].goal).T)
        for i in self.at:
            if i != k and len(free):
                path = self.found.routes[i].path
                s = np.linspace(0.0, path.length, 2 + math.ceil(path.length / _SAMPLE))
                cost += _ON_A_WAY * _within(free, path.point(s), reach(self.problem, i, k) + ROOM)
        taken: list[Point] = []
        for n in np.argsort(cost, kind="stable").tolist():
            place = (float(free[n, 0]), float(free[n, 1]))
            if Standing(k, place) not in self.spoilt and all(math.dist(place, one) >= _APART for one in taken):
                taken.append(place)
                yield place
            if len(taken) == _MOST_PLACES:
                return

    def holding_places(self, k: int) -> Array:
        """Places (m, 2) [m] that a robot can get to, where nobody stands, nor will rest in the end."""
        problem, robots = self.problem, self.problem.robots
        xmin, ymin, xmax, ymax = problem.workspace.bounds
        rim = robots[k].footprint.radius + problem.workspace.clearance + ROOM
        (u, v), around = self.at[k], _AROUND
        x = np.arange(max(xmin + rim, u - around), min(xmax - rim, u + around), _GRID)
        y = np.arange(max(ymin + rim, v - around), min(ymax - rim, v + around), _GRID)
        free = np.stack(np.meshgrid(x, y), axis=2).reshape(-1, 2)
        hit, _, _ = too_near(problem.obstacles, free, np.full(len(free), rim))
        free = np.delete(free, np.unique(hit), axis=0)
        to_come = [Standing(i, robots[i].goal) for i in self.at if i != k]
        for i, place in (*self.others(k), *to_come):
            free = free[np.hypot(*(free - place).T) >= reach(problem, i, k) + ROOM]
        cells = self.raster.reached(self.at[k], self.free(k, self.others(k)))
        return free[[bool(self.raster.cell((a, b)) & cells) for a, b in free.tolist()]]


def _within(places: Array, path: Array, distance: float) -> Array:
    """For each place (m, 2) whether one of the points (n, 2) of a path is nearer than a distance [m]."""
    gap = places[:, None] - path[None]
    return np.asarray((np.hypot(gap[..., 0], gap[..., 1]) < distance).any(axis=1))
