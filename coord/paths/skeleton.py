"""The shortest way round grown obstacles: tangents and arcs.

A shortest path for a disc consists of straight tangents and of arcs of radius rho round convex corners. The
search is lazy: it starts with no obstacle at all, finds the shortest path, looks what that hits, adds those
obstacles, and begins again. With fewer obstacles a path can only be shorter, so the first path that hits
nothing is the shortest of all.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.geometry.blocked import Floor, blocked_angles
from coord.geometry.growth import Grown
from coord.geometry.shapes import part_distances
from coord.model.arrays import Array, Point
from coord.paths.tangents import END, TURN, TangentGraph, Tangents, turn, turns
from coord.tolerances import PLANNING_MARGIN

#: Steps from a part that is hit to the parts beside it, pieces of one wall, that take part from then on, too.
_SIBLINGS = 4

#: Parts this near to a segment that hits something take part, too: a share of the size of what it hits.
_BESIDE = 0.25

#: Tangents from one place that are tested at once; the rest waits until the search comes to them.
_BATCH = 16

#: [m] A way is not shorter than another by less than this.
_SAME_LENGTH = 1e-12


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
    while True:
        found = _Search(graph).run(longest)
        if found is None:
            return NoWay(tuple(sorted(graph.active.tolist())))
        hits = _newly_hit(floor, found, graph.active)
        if not len(hits):
            return found
        graph.activate(np.setdiff1d(_with_those_beside(floor, hits, found), graph.active))


def search_floor(grown: Grown, places: Sequence[Point]) -> Floor:
    """The floor as a search sees it: with a margin for the certificate.

    The margin is never so large that one of the places that a path leads to would be too near to something.
    """
    nearest = part_distances(grown.parts, np.array(places))
    return Floor(grown, np.minimum(grown.rho + PLANNING_MARGIN, nearest))


@dataclass(slots=True, eq=False)
class _State:
    """A node with the direction in which it is reached, and the tangents that lead on from it.

    ``before`` : the state it is reached from, by number, -1 at the start, and ``left`` : in which direction that is
    left. ``order`` : the tangents that the turn allows, the most promising first; ``estimate`` and ``reached`` :
    for each of them the least length to the goal through it, and the length up to its end; ``queued`` : how many
    of them were tested.
    """

    before: int
    left: float
    node: int
    arriving: float
    tangents: Tangents
    order: npt.NDArray[np.intp]
    estimate: Array
    reached: Array
    queued: int = 0


class _Search:
    """A* over tangents."""

    def __init__(self, graph: TangentGraph) -> None:
        self.graph = graph
        self.states: list[_State] = []
        self.expanded: dict[int, list[tuple[float, float]]] = {}
        # least length to the goal, number, state, place in its order; -1: the rest of its tangents is to be tested
        self.heap: list[tuple[float, int, int, int]] = []
        self.pushed = 0

    def run(self, longest: float) -> Skeleton | None:
        """The shortest path among the active parts; None where there is none, or only longer ones."""
        self._expand(-1, 0.0, END, 0.0, 0.0)
        while self.heap and self.heap[0][0] <= longest:
            _, _, number, place = heapq.heappop(self.heap)
            if place < 0:
                self._queue(number)
                continue
            state = self.states[number]
            tangent, length = int(state.order[place]), float(state.reached[place])
            leaving, arriving = float(state.tangents.leaving[tangent]), float(state.tangents.arriving[tangent])
            node = int(state.tangents.nodes[tangent])
            if node == END:
                return self._result(number, leaving, length)
            if not self._is_dominated(node, arriving, length):
                self.expanded.setdefault(node, []).append((arriving, length))
                self._expand(number, leaving, node, arriving, length)
        return None

    def _expand(self, before: int, left: float, node: int, arriving: float, length: float) -> None:
        """Enter a new state: find where one can go on to, and how long the way would be at least."""
        graph = self.graph
        tangents = graph.tangents(node)
        reached = length + tangents.lengths
        chosen = np.arange(len(reached))
        if node != END:
            angle = turns(float(graph.side[node]), arriving, tangents.leaving)
            reached += graph.radius[node] * angle
            chosen = np.flatnonzero(angle <= graph.free_turn(node, arriving))
        estimate = (reached + tangents.left)[chosen]
        by_estimate = np.argsort(estimate, kind="stable")
        order = chosen[by_estimate]
        self.states.append(_State(before, left, node, arriving, tangents, order, estimate[by_estimate], reached[order]))
        self._queue(len(self.states) - 1)

    def _queue(self, number: int) -> None:
        """Test some more of a state's tangents, queue those that hit nothing, and remember that there are more."""
        state = self.states[number]
        first, last = state.queued, min(state.queued + _BATCH, len(state.order))
        state.queued = last
        free = self.graph.are_free(state.tangents, state.order[first:last])
        for place in (first + np.flatnonzero(free)).tolist():
            self._push(number, place, float(state.estimate[place]))
        if last < len(state.order):
            self._push(number, -1, float(state.estimate[last]))

    def _push(self, number: int, place: int, estimate: float) -> None:
        self.pushed += 1
        heapq.heappush(self.heap, (estimate, self.pushed, number, place))

    def _is_dominated(self, node: int, arriving: float, length: float) -> bool:
        """Whether somebody was here earlier along the turn, at no greater length, with the arc in between free."""
        radius, side = float(self.graph.radius[node]), float(self.graph.side[node])
        for earlier, shorter in self.expanded.get(node, ()):
            angle = turn(side, earlier, arriving)
            if shorter + radius * angle <= length + _SAME_LENGTH and angle <= self.graph.free_turn(node, earlier):
                return True
        return False

    def _result(self, number: int, leaving: float, length: float) -> Skeleton:
        found, graph = [], self.graph
        while (state := self.states[number]).node != END:
            side = float(graph.side[state.node])
            angle = turn(side, state.arriving, leaving)
            if angle > 1e-12:
                x, y = graph.places[state.node].tolist()
                found.append(Turn((x, y), float(graph.radius[state.node]), int(side), state.arriving, angle))
            number, leaving = state.before, state.left
        start, goal = (float(graph.start[0]), float(graph.start[1])), (float(graph.goal[0]), float(graph.goal[1]))
        return Skeleton(start, goal, tuple(found[::-1]), length)


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
