"""Left or right of what blocks the straight line.

For every cluster of obstacles on the straight line a barrier across one side of it, from the cluster to beyond
the workspace, leaves only the other side. The shortest way with such barriers is the shortest on that side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from coord.geometry.clusters import anchor, clusters
from coord.geometry.growth import Grown
from coord.model.arrays import Array, Point
from coord.paths.skeleton import NoWay, Skeleton, Turn, search, search_floor
from coord.paths.tangents import TangentGraph

#: Names of the sides by the sign of the passage: seen from start to goal.
NAMES = {1: "left", -1: "right"}


@dataclass(frozen=True, slots=True)
class Blocker:
    """A cluster of obstacles on the straight line of one leg: its number, a place in it, the line's direction."""

    leg: int
    cluster: int
    place: Point
    direction: Point

    def barrier(self, side: int, reach: float) -> tuple[float, float, float, float]:
        """A segment that closes one side (+1 left, -1 right), so long that it ends outside the workspace."""
        (x, y), (dx, dy) = self.place, self.direction
        return (x, y, x - side * reach * dy, y + side * reach * dx)


class Ground:
    """The floor of one kind of robot: grown obstacles and, when they are asked for, their clusters."""

    def __init__(self, grown: Grown) -> None:
        """Begin with the grown obstacles."""
        self.grown = grown
        self._clusters: npt.NDArray[np.intp] | None = None

    @property
    def clusters(self) -> npt.NDArray[np.intp]:
        """The cluster of each part."""
        if self._clusters is None:
            self._clusters = clusters(self.grown)
        return self._clusters


class Ways:
    """The ways of one robot from place to place; what one search finds out helps the next."""

    def __init__(self, ground: Ground, places: Sequence[Point]) -> None:
        """Begin with the floor as these places see it; no place may follow itself."""
        self.ground, self.floor = ground, search_floor(ground.grown, places)
        self._legs = list(pairwise(places))
        self._graphs = [TangentGraph(self.floor, a, b) for a, b in self._legs]

    def blockers(self) -> tuple[Blocker, ...]:
        """What stands on the straight lines from place to place, leg by leg, in the order in which it is met."""
        found = []
        for leg, (a, b) in enumerate(self._legs):
            hit, label = self.floor.hit_parts(np.array([[*a, *b]]))[:, 1], self.ground.clusters
            direction = ((b[0] - a[0]) / math.dist(a, b), (b[1] - a[1]) / math.dist(a, b))
            blockers = [
                Blocker(leg, cluster, anchor(self.ground.grown, hit[label[hit] == cluster], a, b), direction)
                for cluster in np.unique(label[hit]).tolist()
            ]
            found += sorted(blockers, key=lambda one: math.dist(one.place, a))
        return tuple(found)

    def shortest(
        self, blockers: Sequence[Blocker] = (), sides: Sequence[int] = (), longest: float = math.inf
    ) -> list[Skeleton] | NoWay:
        """The shortest way, leg by leg, that passes some blockers on the sides (+1 left, -1 right).

        ``longest`` : there is no way where all are longer than this [m].
        """
        xmin, ymin, xmax, ymax = self.ground.grown.box
        reach = 2 * math.hypot(xmax - xmin, ymax - ymin) + 1.0
        legs: list[Skeleton] = []
        for leg, graph in enumerate(self._graphs):
            barriers = [one.barrier(-side, reach) for one, side in zip(blockers, sides, strict=True) if one.leg == leg]
            graph.bar(np.array(barriers).reshape(-1, 4))
            found = search(graph, longest - math.fsum(one.length for one in legs))
            if isinstance(found, NoWay):
                return found
            legs.append(found)
        return legs

    def first_cut(self) -> tuple[Point, Point]:
        """The first two places between which there is no way; the first two if there is one everywhere."""
        for graph, leg in zip(self._graphs, self._legs, strict=True):
            graph.bar(np.empty((0, 4)))
            if isinstance(search(graph), NoWay):
                return leg
        return self._legs[0]


def joined(legs: Sequence[Skeleton]) -> Skeleton:
    """Legs one after the other; at the places between them a turn of radius 0, unless they go straight on."""
    turns = list(legs[0].turns)
    for before, after in pairwise(legs):
        arriving, leaving = _last_heading(before), _first_heading(after)
        angle = math.remainder(leaving - arriving, 2 * math.pi)
        if abs(angle) > 1e-9:
            side = 1 if angle > 0 else -1
            turns.append(Turn(after.start, 0.0, side, arriving - side * math.pi / 2, abs(angle)))
        turns += after.turns
    return Skeleton(legs[0].start, legs[-1].goal, tuple(turns), math.fsum(leg.length for leg in legs))


def passed(legs: Sequence[Skeleton], blockers: Sequence[Blocker]) -> tuple[int, ...]:
    """On which side a way passes each blocker: +1 left, -1 right."""
    sides = []
    for blocker in blockers:
        leg = _polyline(legs[blocker.leg]) - blocker.place
        dx, dy = blocker.direction
        along, across = leg[:, 0] * dx + leg[:, 1] * dy, leg[:, 1] * dx - leg[:, 0] * dy
        crossing = np.flatnonzero((along[:-1] < 0) != (along[1:] < 0))
        share = along[crossing] / (along[crossing] - along[crossing + 1])
        at = across[crossing] + share * (across[crossing + 1] - across[crossing])
        sides.append(1 if np.count_nonzero(at > 0) % 2 else -1)
    return tuple(sides)


def _polyline(found: Skeleton) -> Array:
    """Points (n, 2) along a way: the ends and the middles of its turns."""
    return np.array([found.start, *(turn.at(share) for turn in found.turns for share in (0.0, 0.5, 1.0)), found.goal])


def _first_heading(leg: Skeleton) -> float:
    if leg.turns:
        return leg.turns[0].first + leg.turns[0].side * math.pi / 2
    return math.atan2(leg.goal[1] - leg.start[1], leg.goal[0] - leg.start[0])


def _last_heading(leg: Skeleton) -> float:
    if leg.turns:
        turn = leg.turns[-1]
        return turn.first + turn.side * (turn.angle + math.pi / 2)
    return _first_heading(leg)
