"""The graph that a search for the shortest way walks: tangents between corners, and arcs round them.

Obstacles join it in rounds. What was found out in earlier rounds is kept. Whether a tangent hits something is
tested when the search asks for it, which it does for a small part of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.geometry.blocked import Floor, Screen, blocked_angles
from coord.model.arrays import Array, Point
from coord.tolerances import BARRIER

TURN = 2 * np.pi

#: The node that stands for the start, and as the end of a tangent for the goal.
END = -1

#: What is known of a tangent that was not found free.
_UNTESTED, _HIT = -1, -2

#: [rad] A tangent may leave a corner this far outside the directions it may have, by rounding.
_CONE_SLACK = 1e-9

#: [rad] A turn ends this little beyond the place where something blocks it, by rounding.
_TURN_SLACK = 1e-9

#: [rad] A direction is inside a blocked stretch when it is so far from both its ends.
_INSIDE = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class Tangents:
    """Tangents from one node: nodes they lead to (END: the goal), directions at both ends, end points (n, 2)."""

    nodes: npt.NDArray[np.intp]
    leaving: Array
    arriving: Array
    starts: Array
    ends: Array
    lengths: Array
    left: Array  # from the end straight to the goal [m]
    tested: npt.NDArray[np.intp]  # the round in which each was found free, _UNTESTED or _HIT


class TangentGraph:
    """Nodes are corners with a side (turning counter-clockwise or clockwise round them)."""

    def __init__(self, floor: Floor, start: Point, goal: Point) -> None:
        """Begin without any obstacle."""
        self.floor, self.start, self.goal = floor, np.array(start), np.array(goal)
        self.active: npt.NDArray[np.intp] = np.empty(0, dtype=np.intp)
        self.places, self.radius, self.side = np.empty((0, 2)), np.empty(0), np.empty(0)
        self.first, self.span = np.empty(0), np.empty(0)
        self._rounds: list[tuple[Array, Array]] = []  # of each round: new edges and their distances
        self._screen = Screen(floor, self.active)
        self._tangents: dict[int, tuple[Tangents, int]] = {}  # with the number of nodes looked at
        self._blocked: dict[int, tuple[list[tuple[float, float]], int]] = {}
        self._barriers = np.empty((0, 4))
        self._barred: dict[int, list[tuple[float, float]]] = {}

    def bar(self, barriers: Array) -> None:
        """Let nothing cross some segments (n, 4) [m] from now on; it replaces those before."""
        self._barriers, self._barred = barriers, {}

    def activate(self, parts: npt.NDArray[np.intp]) -> None:
        """Let more parts of the floor take part."""
        self.active = np.concatenate([self.active, parts])
        corners = self.floor.grown.corners
        chosen = self.floor.grown.corners_of(parts)
        self.places = np.concatenate([self.places, np.repeat(corners.places[chosen], 2, axis=0)])
        self.radius = np.concatenate([self.radius, np.repeat(self.floor.rho[corners.parts[chosen]], 2)])
        self.side = np.concatenate([self.side, np.tile([1.0, -1.0], len(chosen))])
        self.first = np.concatenate([self.first, np.repeat(corners.first[chosen], 2)])
        self.span = np.concatenate([self.span, np.repeat(corners.span[chosen], 2)])
        self._rounds.append(self.floor.edges_of(parts))
        self._screen = Screen(self.floor, self.active)

    def tangents(self, node: int) -> Tangents:
        """The tangents from a node, those too that hit something."""
        found, known = self._tangents.get(node, (None, 0))
        if found is None:
            found = self._drawn(node, 0, goal_too=True)
        elif known < len(self.radius):
            more = self._drawn(node, known, goal_too=False)
            found = Tangents(*(np.concatenate([getattr(found, name), getattr(more, name)]) for name in found.__slots__))
        self._tangents[node] = found, len(self.radius)
        return found

    def are_free(self, tangents: Tangents, chosen: npt.NDArray[np.intp]) -> npt.NDArray[np.bool_]:
        """Whether some tangents, by index, hit nothing."""
        now = len(self._rounds)
        known = tangents.tested[chosen]
        open_ = chosen[(known != _HIT) & (known != now)]
        if len(open_):
            hit = self._screen.is_hit(np.hstack([tangents.starts[open_], tangents.ends[open_]]))
            tangents.tested[open_] = np.where(hit, _HIT, now)
        free = np.asarray(tangents.tested[chosen] == now)
        if len(self._barriers):
            free &= ~_cross(tangents.starts[chosen], tangents.ends[chosen], self._barriers)
        return free

    def free_turn(self, node: int, arriving: float) -> float:
        """How far [rad] one can turn round a corner from a direction on until something is in the way."""
        side = float(self.side[node])
        free = TURN - _TURN_SLACK
        for first, last in self._stretches(node // 2):  # both sides share a circle
            inside = (arriving - first) % TURN
            if _INSIDE < inside < last - first - _INSIDE:
                return 0.0
            free = min(free, turn(side, arriving, first if side > 0 else last) + _TURN_SLACK)
        return free

    def _stretches(self, circle: int) -> list[tuple[float, float]]:
        stretches, rounds = self._blocked.get(circle, ([], 0))
        if rounds < len(self._rounds):
            center, radius = self.places[2 * circle], float(self.radius[2 * circle])
            edges, rho = (np.concatenate(parts) for parts in zip(*self._rounds[rounds:], strict=True))
            more = blocked_angles(center, radius, edges, rho, self.floor.grown.box)
            stretches = stretches + [(first, last) for first, last in more.tolist()]
            self._blocked[circle] = stretches, len(self._rounds)
        return stretches + self._barred_stretches(circle) if len(self._barriers) else stretches

    def _barred_stretches(self, circle: int) -> list[tuple[float, float]]:
        if circle not in self._barred:
            center, radius = self.places[2 * circle], float(self.radius[2 * circle])
            thickness = np.full(len(self._barriers), BARRIER)
            found = blocked_angles(center, radius, self._barriers, thickness, self.floor.grown.box)
            self._barred[circle] = [(first, last) for first, last in found.tolist()]
        return self._barred[circle]

    def _drawn(self, node: int, known: int, *, goal_too: bool) -> Tangents:
        """Tangents from a node to all nodes that are not known yet (and to the goal), whatever they hit."""
        center, radius, side = self.start, 0.0, 1.0
        if node != END:
            center, radius, side = self.places[node], float(self.radius[node]), float(self.side[node])
        to_places, to_radius, to_sides = self.places[known:], self.radius[known:], self.side[known:]
        to_first, to_span = self.first[known:], self.span[known:]
        if goal_too:  # a disc of radius 0, with all directions
            to_places, to_radius = np.vstack([to_places, self.goal]), np.append(to_radius, 0.0)
            to_sides, to_first, to_span = np.append(to_sides, 1.0), np.append(to_first, 0.0), np.append(to_span, TURN)
        D = to_places - center
        far = np.hypot(D[:, 0], D[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            a = (side * radius - to_sides * to_radius) / far
        index = np.flatnonzero((far > 0) & (np.abs(a) <= 1.0 + 1e-12))
        a = np.clip(a[index], -1.0, 1.0)
        x, y = (D[index] / far[index, None]).T
        across = np.sqrt(1 - a * a)
        n, sides = np.stack([a * x + across * y, a * y - across * x], axis=1), to_sides[index]
        # few tangents fit the directions that both corners allow: what comes next is only done for those
        arriving = np.arctan2(sides * n[:, 1], sides * n[:, 0])
        fits = _in_cone(arriving, to_first[index], to_span[index])
        index, n, sides, arriving = index[fits], n[fits], sides[fits], arriving[fits]
        leaving = np.arctan2(side * n[:, 1], side * n[:, 0])
        ends = to_places[index] + (sides * to_radius[index])[:, None] * n
        xmin, ymin, xmax, ymax = self.floor.grown.box
        x, y = ends.T
        fits = (x >= xmin - 1e-9) & (x <= xmax + 1e-9) & (y >= ymin - 1e-9) & (y <= ymax + 1e-9)
        if node != END:
            fits &= _in_cone(leaving, self.first[node], self.span[node])
        nodes = np.where(index + known == len(self.radius), END, index + known)
        starts, ends = (center + (side * radius) * n)[fits], ends[fits]
        lengths, left = np.hypot(*(ends - starts).T), np.hypot(*(self.goal - ends).T)
        untested = np.full(len(starts), _UNTESTED)
        return Tangents(nodes[fits], leaving[fits], arriving[fits], starts, ends, lengths, left, untested)


def _cross(starts: Array, ends: Array, barriers: Array) -> npt.NDArray[np.bool_]:
    """Whether segments (n, 2), (n, 2) cross any of the barriers (b, 4)."""
    p, along = starts[:, None], (ends - starts)[:, None]
    q, wall = barriers[None, :, :2], (barriers[:, 2:] - barriers[:, :2])[None]
    # on which side of the segment the barrier's ends lie, and of the barrier the segment's ends
    first, second = _side(along, q - p), _side(along, q + wall - p)
    third, fourth = _side(wall, p - q), _side(wall, p + along - q)
    return np.asarray(((first * second <= 0) & (third * fourth <= 0)).any(axis=1))


def _side(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def turn(side: float, first: float, last: float) -> float:
    """The angle in [0, 2 pi) from one direction to another, turning to a side; a hair short of a full turn is none."""
    angle = (side * (last - first)) % TURN
    return 0.0 if angle > TURN - 1e-9 else angle


def turns(side: float, first: float, last: Array) -> Array:
    """``turn`` for many directions."""
    angle = (side * (last - first)) % TURN
    return np.asarray(np.where(angle > TURN - 1e-9, 0.0, angle))


def _in_cone(angle: Array, first: Array, span: Array) -> npt.NDArray[np.bool_]:
    return np.asarray((angle - first + _CONE_SLACK) % TURN <= span + 2 * _CONE_SLACK)
