"""Bays: some robots of a group that cannot leave together on their paths go aside, and wait where they hinder nobody.

On given paths three or more robots can be stuck although every two could pass each other: before a door, say, where
each comes out of the way of one only by going into that of another. A bay is a place off all their paths. One that
goes there first, lets the others by, and then goes on, unties the knot.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from itertools import combinations, islice

import numpy as np

from coord.coordination.lattice import Floor, Lattice, lattice_of, with_other_path
from coord.coordination.moves import MOST_STATES, Outcome, moves_home
from coord.coordination.passing_by import is_separated
from coord.coordination.rerouting import Rerouting
from coord.coordination.way_round import Rests, rests, way_through
from coord.geometry.shapes import too_near
from coord.model.arrays import Array, Point
from coord.model.problem import Problem

#: [m] Bays are sought on a grid this wide, and keep so much more from paths and places of rest than needed.
_GRID, _ROOM = 0.25, 0.05

#: Robots of one group that go into bays; bays tried before one is taken; those of one robot, at least so far apart [m].
_MOST_ROBOTS, _MOST_TRIES, _MOST_BAYS, _APART = 6, 20, 5, 1.5

#: Looks at a robot that the search for bays may take in all groups; a path is as dear as so many; and states for each.
_MOST_LOOKS, _PATH, _FEW_STATES = 250_000, 2000, 40

#: [m] Places of a path are looked at so far apart.
_SAMPLE = 0.1

#: Places compared with all others at once: that keeps the tables small on large floors.
_AT_ONCE = 16

#: [m] Bays are sought so far around the paths of a group.
_AROUND = 5.0

#: The shape of ways while bays are sought: it is found about five times as quickly as the default.
_SKETCH = "taut"


def with_bays(
    problem: Problem,
    found: Rerouting,
    shape: str,
    check_time: Callable[[], None],
    at_ease: Collection[tuple[int, ...]] = (),
) -> Rerouting:
    """Paths on which groups can leave together, as far as bays help; others are left as they are.

    ``at_ease`` : groups that come home on their paths.
    """
    search = _Search(problem, rests(problem), shape, check_time, _MOST_LOOKS)
    for group in found.together:
        if group not in at_ease:
            found = search.untied(found, group)
    return found


@dataclasses.dataclass(slots=True, eq=False)
class _Search:
    """What all groups share; ``left`` : how many looks at a robot may still be taken."""

    problem: Problem
    known: Rests
    shape: str
    check_time: Callable[[], None]
    left: int

    def parted(self, found: Rerouting, group: Sequence[int]) -> Rerouting:
        """The same with no two robots of a group on paths that keep them from both coming home, as far as bays help."""
        for pair in combinations(group, 2):
            if lattice_of(self.floor(found), pair) is None and is_separated(self.problem, found, *pair):
                options = (one for n in (0, 1) for one in self.bays(found, pair, n))
                ways = (self.one_of_two(found, pair, n, place) for n, place in options)
                found = next((way for way in ways if way is not None), found)
        return found

    def one_of_two(self, found: Rerouting, pair: Sequence[int], n: int, place: Point) -> Rerouting | None:
        """The same with one robot of a pair on a way through a bay, if then both come home."""
        if self.left <= 0:
            return None
        self.check_time()
        self.left -= _PATH
        changed = self.through(found, pair, n, place, (0, 1), _SKETCH)
        lattice = None if changed is None else lattice_of(self.floor(changed), pair)
        if changed is None or lattice is None or self.looked(lattice).moves is None:
            return None
        return self.shaped(changed, lattice, pair, {n: place})

    def untied(self, found: Rerouting, group: Sequence[int]) -> Rerouting:
        """The same with some robots of a group on ways through bays; unchanged where that does not help."""
        lattice = lattice_of(self.floor(found), group)
        if lattice is None:
            found = self.parted(found, group)
            lattice = lattice_of(self.floor(found), group)
        if lattice is None or len(group) == 2:
            return found
        now, outcome = found, moves_home(lattice, MOST_STATES)
        bays: dict[int, Point] = {}
        while outcome.moves is None and len(bays) < _MOST_ROBOTS:
            better = self.one_more(now, group, lattice, outcome, bays)
            if better is None:
                return found
            now, lattice, outcome, (n, place) = better
            bays[n] = place
        return self.shaped(now, lattice, group, bays) if outcome.moves is not None else found

    def floor(self, found: Rerouting) -> Floor:
        paths = [route.path for route in found.routes]
        return Floor(self.problem.robots, paths, frozenset(found.blocks), self.problem.workspace.clearance)

    def one_more(
        self, found: Rerouting, group: Sequence[int], lattice: Lattice, outcome: Outcome, taken: Collection[int]
    ) -> tuple[Rerouting, Lattice, Outcome, tuple[int, Point]] | None:
        """The same with one more robot on a way through a bay, the first that brings all home or the most forward."""
        best = None
        stuck = [n for n in outcome.stuck if n not in taken]
        options = (one for n in self.in_the_way(lattice, stuck) for one in self.bays(found, group, n))
        for n, place in islice(options, _MOST_TRIES):
            if self.left <= 0:
                break
            self.check_time()
            self.left -= _PATH
            changed = self.through(found, group, n, place, outcome.stuck, _SKETCH)
            other = None if changed is None else with_other_path(lattice, self.floor(changed), group, n)
            if changed is None or other is None:
                continue
            after = self.looked(other)
            if after.moves is not None:
                return changed, other, after, (n, place)
            if best is None or after.left < best[2].left:
                best = changed, other, after, (n, place)
        return best

    def shaped(self, found: Rerouting, lattice: Lattice, group: Sequence[int], bays: Mapping[int, Point]) -> Rerouting:
        """The same with the ways through bays in the shape asked for, as far as all still come home on them."""
        if self.shape == _SKETCH:
            return found
        for n, place in bays.items():
            changed = self.through(found, group, n, place, (), self.shape)
            other = None if changed is None else with_other_path(lattice, self.floor(changed), group, n)
            if changed is not None and other is not None and moves_home(other, MOST_STATES).moves is not None:
                found, lattice = changed, other
        return found

    def through(
        self, found: Rerouting, group: Sequence[int], n: int, place: Point, stuck: Sequence[int], shape: str
    ) -> Rerouting | None:
        """The same with one robot on a way through a bay, over no place of rest that it did not run over before."""
        i = group[n]
        allowed = frozenset(block for block in found.blocks if block.driving == i)
        way = way_through(self.known, i, found.routes[i], allowed, shape, (place,))
        if way is None:
            return None
        return found.on(i, way, tuple(sorted({*found.beside.get(i, ()), *(group[m] for m in stuck if m != n)})))

    def looked(self, lattice: Lattice) -> Outcome:
        """A short search for moves home, which is counted."""
        outcome = moves_home(lattice, _FEW_STATES)
        self.left -= outcome.looks
        return outcome

    def in_the_way(self, lattice: Lattice, stuck: Sequence[int]) -> list[int]:
        """Robots that are stuck, those first without which the others come home or farthest."""

        def left(n: int) -> float:
            near = [[m for m in some if m != n] if k != n else [] for k, some in enumerate(lattice.neighbours)]
            return self.looked(dataclasses.replace(lattice, neighbours=near)).left if self.left > 0 else math.inf

        return sorted(stuck, key=left)

    def bays(self, found: Rerouting, group: Sequence[int], n: int) -> Iterator[tuple[int, Point]]:
        """Bays for a robot, each with its position in the group; those that cost least as the crow flies first."""
        i = group[n]
        robot = self.problem.robots[i]
        if robot.path or robot.via:
            return
        free = self.free(found, group, i)
        cost = np.hypot(*(free - robot.start).T) + np.hypot(*(free - robot.goal).T)
        taken: list[Point] = []
        for k in np.argsort(cost, kind="stable").tolist():
            x, y = free[k].tolist()
            if all(math.dist((x, y), other) >= _APART for other in taken):
                taken.append((x, y))
                yield n, (x, y)
            if len(taken) == _MOST_BAYS:
                return

    def free(self, found: Rerouting, group: Sequence[int], i: int) -> Array:
        """Places (m, 2) [m] where robot i is in nobody's way: neither where others rest nor on paths of its group."""
        workspace, own = self.problem.workspace, self.problem.robots[i].footprint.radius
        xmin, ymin, xmax, ymax = workspace.bounds
        rim = own + workspace.clearance + _ROOM
        ends = np.concatenate([found.routes[k].path.poses[:, :2] for k in group])
        low = np.maximum(ends.min(axis=0) - _AROUND, (xmin + rim, ymin + rim))
        high = np.minimum(ends.max(axis=0) + _AROUND, (xmax - rim, ymax - rim))
        x, y = np.arange(low[0], high[0], _GRID), np.arange(low[1], high[1], _GRID)
        at = np.stack(np.meshgrid(x, y), axis=2).reshape(-1, 2)
        near, _, _ = too_near(self.problem.obstacles, at, np.full(len(at), rim))
        at = np.delete(at, np.unique(near), axis=0)
        for k in group:
            if k != i:
                path = found.routes[k].path
                s = np.linspace(0.0, path.length, 2 + math.ceil(path.length / _SAMPLE))
                at = _beyond(at, path.point(s), rim + self.problem.robots[k].footprint.radius)
        others = [m for m in range(len(self.known.places)) if m // 2 != i]
        for m in others:
            at = _beyond(at, self.known.places[m : m + 1], rim - workspace.clearance + float(self.known.reaches[m]))
        return at


def _beyond(at: Array, places: Array, distance: float) -> Array:
    """Those of some places (m, 2) that are at least so far [m] from others (n, 2)."""
    for begin in range(0, len(places), _AT_ONCE):
        gap = at[:, None] - places[None, begin : begin + _AT_ONCE]
        at = at[(np.hypot(gap[..., 0], gap[..., 1]) >= distance).all(axis=1)]
    return at
