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

from coord.geometry.barriers import anchor, clusters, with_barriers
from coord.geometry.blocked import Floor
from coord.geometry.growth import Grown
from coord.model.arrays import Array, Point
from coord.paths.skeleton import NoWay, Skeleton, Turn, search_floor, skeleton

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

    def blockers(self, floor: Floor, places: Sequence[Point]) -> tuple[Blocker, ...]:
        """What stands on the straight lines from place to place, leg by leg, in the order in which it is met."""
        found = []
        for leg, (a, b) in enumerate(pairwise(places)):
            length = math.dist(a, b)
            hit = floor.hit_parts(np.array([[*a, *b]]))[:, 1] if length > 0 else np.empty(0, dtype=np.intp)
            direction = ((b[0] - a[0]) / length, (b[1] - a[1]) / length) if len(hit) else (0.0, 0.0)
            blockers = [
                Blocker(leg, cluster, anchor(self.grown, hit[self.clusters[hit] == cluster], a, b), direction)
                for cluster in np.unique(self.clusters[hit]).tolist()
            ]
            found += sorted(blockers, key=lambda one: math.dist(one.place, a))
        return tuple(found)

    def way(
        self,
        floor: Floor,
        places: Sequence[Point],
        blockers: Sequence[Blocker] = (),
        sides: Sequence[int] = (),
        longest: float = math.inf,
    ) -> list[Skeleton] | NoWay:
        """The shortest way, leg by leg, that passes some blockers on the sides (+1 left, -1 right).

        ``longest`` : no way where all are longer than this [m].
        """
        xmin, ymin, xmax, ymax = self.grown.box
        reach = 2 * math.hypot(xmax - xmin, ymax - ymin) + 1.0
        legs = []
        for leg, (a, b) in enumerate(pairwise(places)):
            barriers = [one.barrier(-side, reach) for one, side in zip(blockers, sides, strict=True) if one.leg == leg]
            fenced = floor
            if barriers:
                fenced = search_floor(with_barriers(self.grown, np.array(barriers)), places)
            found = skeleton(fenced, a, b, longest)
            longest -= 0.0 if isinstance(found, NoWay) else found.length
            if isinstance(found, NoWay):
                return found
            legs.append(found)
        return legs

    def first_cut(self, floor: Floor, places: Sequence[Point]) -> tuple[Point, Point]:
        """The first two places between which there is no way."""
        for a, b in pairwise(places):
            if isinstance(skeleton(floor, a, b), NoWay):
                return a, b
        return places[0], places[-1]


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
    points = [found.start]
    for turn in found.turns:
        for share in (0.0, 0.5, 1.0):
            angle = turn.first + turn.side * turn.angle * share
            points.append(
                (turn.center[0] + turn.radius * math.cos(angle), turn.center[1] + turn.radius * math.sin(angle))
            )
    return np.array([*points, found.goal])


def _first_heading(leg: Skeleton) -> float:
    if leg.turns:
        return leg.turns[0].first + leg.turns[0].side * math.pi / 2
    return math.atan2(leg.goal[1] - leg.start[1], leg.goal[0] - leg.start[0])


def _last_heading(leg: Skeleton) -> float:
    if leg.turns:
        turn = leg.turns[-1]
        return turn.first + turn.side * (turn.angle + math.pi / 2)
    return _first_heading(leg)
