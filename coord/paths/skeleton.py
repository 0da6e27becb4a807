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

from coord.geometry.blocked import Floor
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
        self.blocked: dict[int, Array] = {}
        self.expanded: dict[int, list[tuple[float, float]]] = {}

    def run(self) -> Skeleton | None:
        """The shortest path among the active parts, or None."""
        counter = 0
        # entries: length + distance to go, number, length, previous entry, departure there, corner, arrival, segment
        heap: list[tuple[float, int, float, int, float, int, float, tuple[float, float, float, float]]] = []
        trail: list[tuple[int, float, int, float]] = []  # previous, departure there, corner, arrival

        def push(
            previous: int, length: float, leaving: float, corner: int, arriving: float, a: Array, b: Array
        ) -> None:
            nonlocal counter
            along = math.hypot(b[0] - a[0], b[1] - a[1])
            rest = math.hypot(self.goal[0] - b[0], self.goal[1] - b[1])
            total = length + along
            counter += 1
            segment = (float(a[0]), float(a[1]), float(b[0]), float(b[1]))
            heapq.heappush(heap, (total + rest, counter, total, previous, leaving, corner, arriving, segment))

        push(-1, 0.0, 0.0, -1, 0.0, self.start, self.goal)
        for corner, leaving, arriving, a, b in self._tangents(self.start, 0.0, 1.0):
            push(-1, 0.0, leaving, corner, arriving, a, b)
        while heap:
            _, _, length, previous, leaving, corner, arriving, segment = heapq.heappop(heap)
            if corner >= 0 and self._is_dominated(corner, arriving, length):
                continue
            if self._is_hit(segment):
                continue
            if corner < 0:
                return self._result(trail, previous, leaving, length)
            self.expanded.setdefault(corner, []).append((arriving, length))
            trail.append((previous, leaving, corner, arriving))
            here = len(trail) - 1
            radius, side = float(self.radius[corner]), float(self.side[corner])
            free = self._free_turn(corner, arriving)
            for following, out, arrive, a, b in self._tangents(self.places[corner], radius, side, corner):
                turn = _turn(side, arriving, out)
                if turn <= free:
                    push(here, length + radius * turn, out, following, arrive, a, b)
        return None

    def _tangents(
        self, center: Array, radius: float, side: float, own: int = -1
    ) -> list[tuple[int, float, float, Array, Array]]:
        """Tangents from a directed disc to all others and to the goal: corner (-1: goal), directions, ends."""
        places = np.vstack([self.places, self.goal])
        radii, sides = np.append(self.radius, 0.0), np.append(self.side, 1.0)
        D = places - center
        far = np.hypot(D[:, 0], D[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            a = (side * radius - sides * radii) / far
        usable = (far > 0) & (np.abs(a) <= 1.0 + 1e-12)
        if own >= 0:
            usable &= (places != center).any(axis=1)
        else:
            usable[-1] = False
        index = np.flatnonzero(usable)
        a, D, far = np.clip(a[index], -1.0, 1.0), D[index], far[index]
        n = (a[:, None] * D - np.sqrt(1 - a * a)[:, None] * np.stack([-D[:, 1], D[:, 0]], axis=1)) / far[:, None]
        leaving = np.arctan2(side * n[:, 1], side * n[:, 0])
        arriving = np.arctan2(sides[index] * n[:, 1], sides[index] * n[:, 0])
        first, span = np.append(self.first, 0.0)[index], np.append(self.span, _TURN)[index]
        fits = _in_cone(arriving, first, span)
        if own >= 0:
            fits &= _in_cone(leaving, self.first[own], self.span[own])
        starts = center + (side * radius) * n
        ends = places[index] + (sides[index] * radii[index])[:, None] * n
        xmin, ymin, xmax, ymax = self.floor.grown.box
        x, y = ends.T
        fits &= (x >= xmin - 1e-9) & (x <= xmax + 1e-9) & (y >= ymin - 1e-9) & (y <= ymax + 1e-9)
        goal = len(self.places)
        return [
            (-1 if index[k] == goal else int(index[k]), float(leaving[k]), float(arriving[k]), starts[k], ends[k])
            for k in np.flatnonzero(fits)
        ]

    def _is_dominated(self, corner: int, arriving: float, length: float) -> bool:
        """Whether somebody was here earlier along the turn, at no greater length, with the arc in between free."""
        radius, side = float(self.radius[corner]), float(self.side[corner])
        for earlier, shorter in self.expanded.get(corner, ()):
            turn = _turn(side, earlier, arriving)
            if shorter + radius * turn <= length + _SAME_LENGTH and turn <= self._free_turn(corner, earlier):
                return True
        return False

    def _is_hit(self, segment: tuple[float, float, float, float]) -> bool:
        hits = self.floor.hit_parts(np.array([segment]))
        return bool(self.is_active[hits[:, 1]].any())

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

    def _result(
        self, trail: list[tuple[int, float, int, float]], previous: int, leaving: float, length: float
    ) -> Skeleton:
        turns = []
        while previous >= 0:
            before, left, corner, arriving = trail[previous]
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
