"""The shortest way round grown obstacles: tangents and arcs.

A shortest path for a disc consists of straight tangents and of arcs of radius rho round convex corners. The
search is lazy: it starts with no obstacle at all, finds the shortest path, looks what that hits, adds those
obstacles, and begins again. With fewer obstacles a path can only be shorter, so the first path that hits
nothing is the shortest of all.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.geometry.blocked import Floor, Screen
from coord.geometry.growth import Grown
from coord.geometry.shapes import part_distances
from coord.model.arrays import Array, Point
from coord.tolerances import PLANNING_MARGIN

_TURN = 2 * np.pi

#: [rad] A tangent may leave a corner this far outside the directions it may have, by rounding.
_CONE_SLACK = 1e-9

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


@dataclass(frozen=True, slots=True)
class Skeleton:
    """A taut path: tangents in between the turns; ``length`` [m] bounds that of every path from below."""

    start: Point
    goal: Point
    turns: tuple[Turn, ...]
    length: float


@dataclass(frozen=True, slots=True)
class NoWay:
    """There is no path; ``parts`` of the grown obstacles stand around the start or the goal."""

    parts: tuple[int, ...]


def skeleton(floor: Floor, start: Point, goal: Point) -> Skeleton | NoWay:
    """The shortest path of a disc's centre from start to goal, both of which must keep the floor's distances."""
    active: set[int] = set()
    while True:
        found = _Search(floor, np.array(sorted(active), dtype=np.intp), start, goal).run()
        if found is None:
            return NoWay(tuple(sorted(active)))
        hits = _hits(floor, found) - active
        if not hits:
            return found
        active |= hits


def search_floor(grown: Grown, start: Point, goal: Point) -> Floor:
    """The floor as a search sees it: with a margin for the certificate.

    The margin is never so large that the start or the goal would be too near to something.
    """
    nearest = part_distances(grown.parts, np.array([start, goal]))
    return Floor(grown, np.minimum(grown.rho + PLANNING_MARGIN, nearest))


@dataclass(frozen=True, slots=True, eq=False)
class _Tangents:
    """Tangents from one disc: corners they lead to (-1: the goal), directions at both ends, end points (n, 2)."""

    corners: npt.NDArray[np.intp]
    leaving: Array
    arriving: Array
    starts: Array
    ends: Array

    def only(self, chosen: npt.NDArray[np.bool_]) -> _Tangents:
        return _Tangents(*(getattr(self, name)[chosen] for name in self.__slots__))


class _Search:
    """A* over tangents: a node is a corner with a side and the direction at which a tangent arrives."""

    def __init__(self, floor: Floor, active: npt.NDArray[np.intp], start: Point, goal: Point) -> None:
        self.floor = floor
        corners = floor.grown.corners
        self.is_active = np.zeros(len(floor.rho), dtype=np.bool_)
        self.is_active[active] = True
        chosen = np.flatnonzero(self.is_active[corners.parts])
        self.places = np.repeat(corners.places[chosen], 2, axis=0)
        self.radius = np.repeat(floor.rho[corners.parts[chosen]], 2)
        self.side = np.tile([1.0, -1.0], len(chosen))
        self.first, self.span = np.repeat(corners.first[chosen], 2), np.repeat(corners.span[chosen], 2)
        self.start, self.goal = np.array(start), np.array(goal)
        # where tangents may lead to: all corners, and last the goal, a disc of radius 0
        self.to_places = np.vstack([self.places, self.goal])
        self.to_radius, self.to_sides = np.append(self.radius, 0.0), np.append(self.side, 1.0)
        self.to_first, self.to_span = np.append(self.first, 0.0), np.append(self.span, _TURN)
        self.screen = Screen(floor, active)
        self.blocked: dict[int, Array] = {}
        self.expanded: dict[int, list[tuple[float, float]]] = {}
        # length + distance left, number, length, previous node, direction in which it is left, corner, arrival
        self.heap: list[tuple[float, int, float, int, float, int, float]] = []
        self.pushed = 0
        self.trail: list[tuple[int, float, int, float]] = []  # previous node, direction there, corner, arrival

    def run(self) -> Skeleton | None:
        """The shortest path among the active parts, or None."""
        self._push(-1, 0.0, self._tangents(self.start, 0.0, 1.0))
        while self.heap:
            _, _, length, previous, leaving, corner, arriving = heapq.heappop(self.heap)
            if corner < 0:
                return self._result(previous, leaving, length)
            if self._is_dominated(corner, arriving, length):
                continue
            self.expanded.setdefault(corner, []).append((arriving, length))
            self.trail.append((previous, leaving, corner, arriving))
            radius, side = float(self.radius[corner]), float(self.side[corner])
            tangents = self._tangents(self.places[corner], radius, side, corner)
            turn = _turns(side, arriving, tangents.leaving)
            fits = turn <= self._free_turn(corner, arriving)
            self._push(len(self.trail) - 1, length + radius * turn[fits], tangents.only(fits))
        return None

    def _push(self, previous: int, length: Array | float, tangents: _Tangents) -> None:
        """Queue the tangents that hit nothing, by the length up to their end and the distance left."""
        segments = np.hstack([tangents.starts, tangents.ends])
        free = ~self.screen.is_hit(segments)
        along = np.hypot(*(tangents.ends - tangents.starts).T)
        rest = np.hypot(*(self.goal - tangents.ends).T)
        total = length + along
        rows = zip(
            (total + rest)[free].tolist(),
            total[free].tolist(),
            tangents.leaving[free].tolist(),
            tangents.corners[free].tolist(),
            tangents.arriving[free].tolist(),
            strict=True,
        )
        for estimate, reached, leaving, corner, arriving in rows:
            self.pushed += 1
            heapq.heappush(self.heap, (estimate, self.pushed, reached, previous, leaving, corner, arriving))

    def _tangents(self, center: Array, radius: float, side: float, own: int = -1) -> _Tangents:
        """Tangents from a directed disc (own: its corner; -1: the start) to all others and to the goal."""
        D = self.to_places - center
        far = np.hypot(D[:, 0], D[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            a = (side * radius - self.to_sides * self.to_radius) / far
        index = np.flatnonzero((far > 0) & (np.abs(a) <= 1.0 + 1e-12))
        a, D, far, sides = np.clip(a[index], -1.0, 1.0), D[index], far[index], self.to_sides[index]
        n = (a[:, None] * D - np.sqrt(1 - a * a)[:, None] * np.stack([-D[:, 1], D[:, 0]], axis=1)) / far[:, None]
        leaving = np.arctan2(side * n[:, 1], side * n[:, 0])
        arriving = np.arctan2(sides * n[:, 1], sides * n[:, 0])
        fits = _in_cone(arriving, self.to_first[index], self.to_span[index])
        if own >= 0:
            fits &= _in_cone(leaving, self.first[own], self.span[own])
        ends = self.to_places[index] + (sides * self.to_radius[index])[:, None] * n
        xmin, ymin, xmax, ymax = self.floor.grown.box
        x, y = ends.T
        fits &= (x >= xmin - 1e-9) & (x <= xmax + 1e-9) & (y >= ymin - 1e-9) & (y <= ymax + 1e-9)
        corners = np.where(index == len(self.places), -1, index)
        return _Tangents(corners, leaving, arriving, center + (side * radius) * n, ends).only(fits)

    def _is_dominated(self, corner: int, arriving: float, length: float) -> bool:
        """Whether somebody was here earlier along the turn, at no greater length, with the arc in between free."""
        radius, side = float(self.radius[corner]), float(self.side[corner])
        for earlier, shorter in self.expanded.get(corner, ()):
            turn = _turn(side, earlier, arriving)
            if shorter + radius * turn <= length + _SAME_LENGTH and turn <= self._free_turn(corner, earlier):
                return True
        return False

    def _free_turn(self, corner: int, arriving: float) -> float:
        """How far [rad] one can turn round a corner from a direction on until something is in the way."""
        single = corner // 2  # both sides share a circle
        if single not in self.blocked:
            center, radius = self.places[corner], float(self.radius[corner])
            self.blocked[single] = self.floor.blocked_angles(center, radius, self.is_active)
        side = float(self.side[corner])
        free = _TURN - 1e-9
        for first, last in self.blocked[single].tolist():
            entry = first if side > 0 else last
            ahead = _turn(side, arriving, entry)
            inside = (arriving - first) % _TURN
            if 1e-7 < inside < last - first - 1e-7:
                return 0.0
            free = min(free, ahead + 1e-9)
        return free

    def _result(self, previous: int, leaving: float, length: float) -> Skeleton:
        turns = []
        while previous >= 0:
            before, left, corner, arriving = self.trail[previous]
            side = float(self.side[corner])
            center = (float(self.places[corner, 0]), float(self.places[corner, 1]))
            angle = _turn(side, arriving, leaving)
            if angle > 1e-12:
                turns.append(Turn(center, float(self.radius[corner]), int(side), arriving, angle))
            previous, leaving = before, left
        start, goal = (float(self.start[0]), float(self.start[1])), (float(self.goal[0]), float(self.goal[1]))
        return Skeleton(start, goal, tuple(turns[::-1]), length)


def _turn(side: float, first: float, last: float) -> float:
    """The angle in [0, 2 pi) from one direction to another, turning to a side; a hair short of a full turn is none."""
    angle = (side * (last - first)) % _TURN
    return 0.0 if angle > _TURN - 1e-9 else angle


def _turns(side: float, first: float, last: Array) -> Array:
    """``_turn`` for many directions."""
    angle = (side * (last - first)) % _TURN
    return np.asarray(np.where(angle > _TURN - 1e-9, 0.0, angle))


def _in_cone(angle: Array, first: Array, span: Array) -> npt.NDArray[np.bool_]:
    return np.asarray((angle - first + _CONE_SLACK) % _TURN <= span + 2 * _CONE_SLACK)


def _hits(floor: Floor, found: Skeleton) -> set[int]:
    """Parts that a skeleton comes too near to."""
    points = [np.array(found.start)]
    for turn in found.turns:
        for angle in (turn.first, turn.first + turn.side * turn.angle):
            points.append(np.array(turn.center) + turn.radius * np.array([math.cos(angle), math.sin(angle)]))
    points.append(np.array(found.goal))
    segments = np.array([[*points[k], *points[k + 1]] for k in range(0, len(points), 2)])
    hits = set(floor.hit_parts(segments)[:, 1].tolist())
    for turn in found.turns:
        center = np.array(turn.center)
        near = floor.near_parts((*(center - turn.radius).tolist(), *(center + turn.radius).tolist()))
        for part in near.tolist():
            only = np.arange(len(floor.rho)) == part
            stretches = floor.blocked_angles(center, turn.radius, only)
            if part not in hits and any(_overlap(turn, first, last) for first, last in stretches.tolist()):
                hits.add(part)
    return hits


def _overlap(turn: Turn, first: float, last: float) -> bool:
    """Whether an arc runs through a stretch of angles by more than rounding."""
    begin = turn.first if turn.side > 0 else turn.first - turn.angle
    ahead, length = (first - begin) % _TURN, last - first
    return ahead < turn.angle - 1e-7 or (ahead > _TURN - length + 1e-7 and turn.angle > 1e-7)
