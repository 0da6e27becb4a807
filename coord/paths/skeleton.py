"""The shortest way round grown obstacles: tangents and arcs.

A shortest path for a disc consists of straight tangents and of arcs of radius rho round convex corners. The
search is lazy: it starts with no obstacle at all, finds the shortest path, looks what that hits, adds those
obstacles, and begins again. With fewer obstacles a path can only be shorter, so the first path that hits
nothing is the shortest of all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from coord.geometry.blocked import Floor
from coord.geometry.circles import blocked_angles
from coord.geometry.growth import Grown
from coord.geometry.shapes import part_distances
from coord.model.arrays import Array, Point
from coord.paths.cones import TURN
from coord.paths.search import Arrival, Search
from coord.paths.tangents import END, TangentGraph, turn
from coord.tolerances import PLANNING_MARGIN

#: Steps from a part that is hit to the parts beside it, pieces of one wall, that take part from then on, too.
_SIBLINGS = 4

#: Parts this near to a segment that hits something take part, too: a share of the size of what it hits.
_BESIDE = 0.25

#: [rad] A smaller turn is none.
_NO_TURN = 1e-12


@dataclass(frozen=True, slots=True)
class Turn:
    """An arc of a skeleton: centre, radius [m], side (+1 counter-clockwise), and directions [rad] from the centre."""

    center: Point
    radius: float
    side: int
    first: float
    angle: float

    def at(self, share: float) -> Point:
        """The point [m] at a share of the turn."""
        direction = self.first + self.side * self.angle * share
        return (self.center[0] + self.radius * math.cos(direction), self.center[1] + self.radius * math.sin(direction))


@dataclass(frozen=True, slots=True)
class Skeleton:
    """A taut path: tangents in between the turns; ``length`` [m] bounds that of every path from below."""

    start: Point
    goal: Point
    turns: tuple[Turn, ...]
    length: float

    @property
    def places(self) -> tuple[Point, ...]:
        """Start, centres of the turns, goal [m]."""
        return (self.start, *(turn.center for turn in self.turns), self.goal)

    @property
    def sides(self) -> tuple[int, ...]:
        """Sides of the turns, 0 for start and goal."""
        return (0, *(turn.side for turn in self.turns), 0)


@dataclass(frozen=True, slots=True)
class NoWay:
    """There is no path; ``parts`` of the grown obstacles stand around the start or the goal."""

    parts: tuple[int, ...]


def skeleton(floor: Floor, start: Point, goal: Point, longest: float = math.inf) -> Skeleton | NoWay:
    """The shortest path of a disc's centre from start to goal, both of which must keep the floor's distances.

    ``longest`` : where every path is longer than this [m], there is no way.
    """
    return search(TangentGraph(floor, start, goal), longest)


def search(graph: TangentGraph, longest: float = math.inf) -> Skeleton | NoWay:
    """The same on a graph that may know something already, and may have barriers."""
    floor = graph.floor
    progress = Search(graph)
    while True:
        way = progress.run(longest)
        if way is None:
            return NoWay(tuple(sorted(graph.active.tolist())))
        found = _traced(graph, way)
        hits = _newly_hit(floor, found, graph.active)
        if not len(hits):
            return found
        graph.activate(np.setdiff1d(_with_those_beside(floor, hits, found), graph.active))
        progress.renew()


def search_floor(grown: Grown, places: Sequence[Point]) -> Floor:
    """The floor as a search sees it: with a margin for the certificate.

    The margin is never so large that one of the places that a path leads to would be too near to something.
    """
    nearest = part_distances(grown.parts, np.array(places))
    return Floor(grown, np.minimum(grown.rho + PLANNING_MARGIN, nearest))


def _traced(graph: TangentGraph, way: Sequence[Arrival]) -> Skeleton:
    """The skeleton of a way, given by its arrivals, that at the goal first."""
    found = []
    for after, arrival in pairwise(way):
        side = float(graph.side[arrival.node])
        angle = turn(side, arrival.arriving, after.left)
        if arrival.node != END and angle > _NO_TURN:
            x, y = graph.places[arrival.node].tolist()
            found.append(Turn((x, y), float(graph.radius[arrival.node]), int(side), arrival.arriving, angle))
    start, goal = (float(graph.start[0]), float(graph.start[1])), (float(graph.goal[0]), float(graph.goal[1]))
    return Skeleton(start, goal, tuple(found[::-1]), way[0].length)


def _segments(found: Skeleton) -> Array:
    """The tangents (n, 4) [m] of a skeleton."""
    points = [found.start, *(arc.at(share) for arc in found.turns for share in (0.0, 1.0)), found.goal]
    return np.array(points).reshape(-1, 4)


def _newly_hit(floor: Floor, found: Skeleton, active: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Parts that have no part in the search yet and that a skeleton comes too near to."""
    hits = floor.hit_parts(_segments(found))[:, 1]
    for arc in found.turns:
        center = np.array(arc.center)
        near = floor.near_parts((*(center - arc.radius).tolist(), *(center + arc.radius).tolist()))
        near = np.setdiff1d(near, active)
        if len(near) and _is_cut(floor, arc, near):
            hits = np.concatenate([hits, near])
    return np.setdiff1d(hits, active)


def _with_those_beside(floor: Floor, hits: npt.NDArray[np.intp], found: Skeleton) -> npt.NDArray[np.intp]:
    """Parts that are hit and those beside them, which the next skeleton might hit: it saves rounds."""
    segments = _segments(found)
    segments = segments[np.unique(floor.hit_parts(segments)[:, 0])]
    beside = floor.parts_within(_BESIDE * float(np.median(floor.sizes(hits))), segments)
    return floor.grown.near_siblings(np.union1d(hits, beside), _SIBLINGS)


def _is_cut(floor: Floor, arc: Turn, parts: npt.NDArray[np.intp]) -> bool:
    """Whether an arc comes too near to some parts."""
    stretches = blocked_angles(np.array(arc.center), arc.radius, *floor.edges_of(parts), floor.grown.box)
    return any(_overlap(arc, first, last) for first, last in stretches.tolist())


def _overlap(arc: Turn, first: float, last: float) -> bool:
    """Whether an arc runs through a stretch of angles by more than rounding."""
    begin = arc.first if arc.side > 0 else arc.first - arc.angle
    ahead, length = (first - begin) % TURN, last - first
    return ahead < arc.angle - 1e-7 or (ahead > TURN - length + 1e-7 and arc.angle > 1e-7)
