"""The graph that a search for the shortest way walks: tangents between corners, and arcs round them.

Obstacles join it in rounds. What was found out in earlier rounds is kept. Whether a tangent hits something is
tested when the search asks for it, which it does for a small part of them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from coord.geometry.blocked import Floor, Outlines, Screen
from coord.geometry.circles import blocked_angles, blocked_on_circles
from coord.model.arrays import Array, Point
from coord.paths.cones import TURN, Cones
from coord.paths.pool import HIT, UNTESTED, Pool
from coord.tolerances import BARRIER

#: The node that stands for the start, and as the end of a tangent for the goal.
END = -1

#: [1] Two discs that touch have a tangent although rounding says that they overlap by such a share.
_TOUCHING = 2e-12

#: [m] A tangent may end this far outside the box of the floor, by rounding.
_OUTSIDE = 1e-9

#: [rad] A turn ends this little beyond the place where something blocks it, by rounding.
_TURN_SLACK = 1e-9

#: [rad] A direction is inside a blocked stretch when it is so far from both its ends.
_INSIDE = 1e-7


class TangentGraph:
    """Nodes are corners with a side (turning counter-clockwise or clockwise round them).

    ``places``, ``radius``, ``side`` : of all nodes, and at the end, as END, of the goal: a disc of radius 0.
    ``tangents`` : all that were drawn so far; elsewhere a tangent is its number there.
    """

    def __init__(self, floor: Floor, start: Point, goal: Point) -> None:
        """Begin without any obstacle."""
        self.floor, self.start, self.goal = floor, np.array(start), np.array(goal)
        self.active: npt.NDArray[np.intp] = np.empty(0, dtype=np.intp)
        self.tangents = Pool()
        self._corners: npt.NDArray[np.intp] = np.empty(0, dtype=np.intp)
        self._outlines = Outlines(floor)
        self._screens: list[Screen] = []  # of each round: the parts that joined
        self._drawn: dict[int, tuple[npt.NDArray[np.intp], int]] = {}  # with the number of nodes looked at
        self._blocked: dict[int, list[tuple[float, float]]] = {}
        self._looked_at: dict[int, int] = {}  # the number of edges that a circle's blocked stretches come from
        self._barriers = np.empty((0, 4))
        self._barred: dict[int, list[tuple[float, float]]] = {}
        self._set_nodes()

    def bar(self, barriers: Array) -> None:
        """Let nothing cross some segments (n, 4) [m] from now on; it replaces those before."""
        self._barriers, self._barred = barriers, {}

    def activate(self, parts: npt.NDArray[np.intp]) -> None:
        """Let more parts of the floor take part."""
        self.active = np.concatenate([self.active, parts])
        self._corners = np.concatenate([self._corners, self.floor.grown.corners_of(parts)])
        self._outlines.add(parts)
        self._screens.append(Screen(self.floor, parts))
        self._set_nodes()

    def _set_nodes(self) -> None:
        corners, twice = self.floor.grown.corners, np.repeat(self._corners, 2)
        self.places = np.vstack([corners.places[twice], self.goal])
        self.radius = np.append(self.floor.rho[corners.parts[twice]], 0.0)
        self.side = np.append(np.tile([1.0, -1.0], len(self._corners)), 1.0)
        self._parts = corners.parts[twice]
        self._cones = Cones.of(np.append(corners.first[twice], 0.0), np.append(corners.span[twice], TURN))
        self._x, self._y = np.ascontiguousarray(self.places.T)
        self._signed = self.side * self.radius
        self._screen = Screen(self.floor, self.active)

    def tangents_from(self, nodes: Sequence[int]) -> list[npt.NDArray[np.intp]]:
        """The tangents from each of some nodes, those too that hit something."""
        count = len(self._parts)
        looked_at = {node: self._drawn[node][1] if node in self._drawn else -1 for node in nodes}
        for known in sorted(set(looked_at.values()) - {count}):
            self._draw([node for node, number in looked_at.items() if number == known], known)
        return [self._drawn[node][0] for node in nodes]

    def are_free(self, chosen: npt.NDArray[np.intp]) -> npt.NDArray[np.bool_]:
        """Whether some tangents hit nothing."""
        now, known = len(self._screens), self.tangents.tested[chosen]
        self._test(chosen[known == UNTESTED], self._screen)
        for since in np.unique(known[(known >= 0) & (known < now)]).tolist():  # found free in an earlier round
            earlier = chosen[known == since]
            for screen in self._screens[since:]:
                self._test(earlier[self.tangents.tested[earlier] != HIT], screen)
        free = np.asarray(self.tangents.tested[chosen] == now)
        if len(self._barriers):
            free &= ~_cross(self.tangents.segments(chosen), self._barriers)
        return free

    def _test(self, chosen: npt.NDArray[np.intp], screen: Screen) -> None:
        if len(chosen):
            hit = screen.is_hit(self.tangents.segments(chosen))
            self.tangents.tested[chosen] = np.where(hit, HIT, len(self._screens))

    def free_turns(self, nodes: Sequence[int], arriving: Sequence[float]) -> list[float]:
        """How far [rad] one can turn round corners from directions on until something is in the way."""
        self._look_round(sorted({node // 2 for node in nodes if node != END}))
        return [self._free_turn(node, direction) for node, direction in zip(nodes, arriving, strict=True)]

    def _free_turn(self, node: int, arriving: float) -> float:
        if node == END:
            return TURN
        side, circle = float(self.side[node]), node // 2  # both sides share a circle
        free = min(self._cones.rest(node, side, arriving), TURN - _TURN_SLACK)
        for first, last in self._blocked[circle] + self._barred_stretches(circle):
            inside = (arriving - first) % TURN
            if _INSIDE < inside < last - first - _INSIDE:
                return 0.0
            free = min(free, turn(side, arriving, first if side > 0 else last) + _TURN_SLACK)
        return free

    def _look_round(self, circles: Sequence[int]) -> None:
        """See to it that it is known what is blocked of the directions that corners may have."""
        count = len(self._outlines.rho)
        looked_at = {circle: self._looked_at.get(circle, 0) for circle in circles}
        for known in sorted(set(looked_at.values()) - {count}):
            outdated = [circle for circle, number in looked_at.items() if number == known]
            node = 2 * np.array(outdated)
            centers, radius, cones = self.places[node], self.radius[node], self._cones
            parts, first, span = self._parts[node], cones.first[node], cones.span[node]
            row, near = self._outlines.near_turns(centers, parts, radius, first, span, known)
            edges, rho = self._outlines.edges[near], self._outlines.rho[near]
            owner, begin, end = blocked_on_circles(centers, radius, row, edges, rho, self.floor.grown.box)
            more: list[list[tuple[float, float]]] = [[] for _ in outdated]
            for k, *stretch in zip(owner.tolist(), begin.tolist(), end.tolist(), strict=True):
                more[k].append((stretch[0], stretch[1]))
            for circle, stretches in zip(outdated, more, strict=True):
                self._blocked[circle] = self._blocked.get(circle, []) + stretches
                self._looked_at[circle] = count

    def _barred_stretches(self, circle: int) -> list[tuple[float, float]]:
        if not len(self._barriers):
            return []
        if circle not in self._barred:
            center, radius = self.places[2 * circle], float(self.radius[2 * circle])
            thickness = np.full(len(self._barriers), BARRIER)
            found = blocked_angles(center, radius, self._barriers, thickness, self.floor.grown.box)
            self._barred[circle] = [(first, last) for first, last in found.tolist()]
        return self._barred[circle]

    def _draw(self, nodes: Sequence[int], known: int) -> None:
        """Draw tangents from some nodes to all that are not known to them (-1: and to the goal), whatever they hit."""
        place, signed, side = self.places[nodes], self._signed[nodes], self.side[nodes]
        if END in nodes:
            place[nodes.index(END)] = self.start
        to = slice(max(known, 0), len(self._x) if known < 0 else len(self._parts))
        x, y = self._x[None, to] - place[:, :1], self._y[None, to] - place[:, 1:]
        square = x * x + y * y
        with np.errstate(divide="ignore", invalid="ignore"):
            a = (signed[:, None] - self._signed[None, to]) / square
            rest = 1 / square - a * a
            fits = rest * square >= -_TOUCHING
            across = np.sqrt(np.maximum(rest, 0.0))
            nx, ny = a * x + across * y, a * y - across * x  # the normal of the tangent
        # few tangents fit the directions that both corners allow: what comes next is only done for those
        fits &= self._cones.allow(np.array(nodes)[:, None], side[:, None] * nx, side[:, None] * ny)
        row, column = np.nonzero(fits)
        nx, ny, node = nx[row, column], ny[row, column], column + to.start
        sides, reach = self.side[node], self._signed[node]
        end_x, end_y = self._x[node] + reach * nx, self._y[node] + reach * ny
        xmin, ymin, xmax, ymax = self.floor.grown.box
        fits = (end_x >= xmin - _OUTSIDE) & (end_x <= xmax + _OUTSIDE)
        fits &= (end_y >= ymin - _OUTSIDE) & (end_y <= ymax + _OUTSIDE)
        fits &= self._cones.allow(node, sides * nx, sides * ny)
        row, nx, ny, node, sides = row[fits], nx[fits], ny[fits], node[fits], sides[fits]
        starts, ends = place[row].T + signed[row] * np.stack([nx, ny]), np.stack([end_x[fits], end_y[fits]])
        numbers = self.tangents.add(
            np.where(node == len(self._parts), END, node),
            leaving=np.arctan2(side[row] * ny, side[row] * nx),
            arriving=np.arctan2(sides * ny, sides * nx),
            starts=starts,
            ends=ends,
            left=np.hypot(*(self.goal[:, None] - ends)),
        )
        for k, more in enumerate(np.split(numbers, np.searchsorted(row, np.arange(1, len(nodes))))):
            before = self._drawn[nodes[k]][0] if known >= 0 else more[:0]
            self._drawn[nodes[k]] = np.concatenate([before, more]), len(self._parts)


def _cross(segments: Array, barriers: Array) -> npt.NDArray[np.bool_]:
    """Whether segments (n, 4) cross any of the barriers (b, 4)."""
    p, along = segments[:, None, :2], (segments[:, 2:] - segments[:, :2])[:, None]
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


def turns(side: Array, first: Array, last: Array) -> Array:
    """``turn`` for many directions."""
    angle = (side * (last - first)) % TURN
    return np.asarray(np.where(angle > TURN - 1e-9, 0.0, angle))
