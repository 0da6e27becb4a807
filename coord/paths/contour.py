"""The edge of grown obstacles: exact lines and arcs, and how to walk along them.

The border of a core grown by rho consists of its edges moved outwards by rho, and of arcs about its convex
corners. Where grown obstacles overlap, what lies inside another is left out. Every line and arc runs with its
obstacle to the left. Which stretches of them are free is found only when a walk comes to them, so that a large
floor costs no more than the obstacles on the way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from coord.geometry.blocked import Floor
from coord.geometry.circles import blocked_angles
from coord.model.arrays import Array, Point
from coord.paths.strokes import Stroke, distance, wrapped

#: [m] Free and blocked stretches shorter than this come from rounding; so far apart may be what meets in a point.
_SLIVER, _MEETS = 1e-8, 1e-6


@dataclass(frozen=True, slots=True)
class Walk:
    """Strokes along the edge, up to the place at ``leave`` [m] on the straight line."""

    strokes: tuple[Stroke, ...]
    leave: float

    @property
    def length(self) -> float:
        """Length along the edge [m]."""
        return math.fsum(stroke.length for stroke in self.strokes)


class Contour:
    """Lines and arcs round the grown obstacles of a floor."""

    def __init__(self, floor: Floor) -> None:
        """The floor's own ``rho`` is the distance at which the edge runs."""
        self.floor = floor
        edges, rho = floor.grown.edges, floor.rho[floor.grown.edge_parts]
        along = edges[:, 2:] - edges[:, :2]
        length = np.hypot(along[:, 0], along[:, 1])
        real = length > 0
        self.edges, self.rho, along, length = edges, rho, along[real], length[real]
        outwards = np.column_stack([along[:, 1], -along[:, 0]]) / length[:, None]
        begin = edges[real, :2] + rho[real, None] * outwards
        heading = np.arctan2(along[:, 1], along[:, 0])
        lines = np.column_stack([begin, heading, length, np.zeros(len(length))])
        corners = floor.grown.corners
        radius = floor.rho[corners.parts]
        x, y = (corners.places + radius[:, None] * np.column_stack([np.cos(corners.first), np.sin(corners.first)])).T
        arcs = np.column_stack([x, y, corners.first + np.pi / 2, radius * corners.span, 1 / np.maximum(radius, 1e-300)])
        self.table = np.concatenate([lines, arcs[radius > 0]])
        self.boxes = _boxes(self.table)
        self.known: dict[int, list[tuple[float, float]]] = {}

    def stroke(self, k: int) -> Stroke:
        """The k-th line or arc."""
        x, y, heading, length, curvature = self.table[k].tolist()
        return Stroke(x, y, heading, length, curvature)

    def stretches(self, k: int) -> list[tuple[float, float]]:
        """Where the k-th line or arc is free."""
        if k not in self.known:
            self.known[k] = self.free(self.stroke(k))
        return self.known[k]

    def free(self, stroke: Stroke) -> list[tuple[float, float]]:
        """Between which lengths [m] a stroke keeps the floor's distances and stays in its box."""
        cuts = _arc_cuts(self, stroke) if stroke.curvature else _line_cuts(self, stroke)
        cuts = np.unique(np.concatenate([[0.0, stroke.length], cuts[(cuts > 0) & (cuts < stroke.length)]]))
        cuts = cuts[np.append(np.diff(cuts) > _SLIVER, True)]
        if len(cuts) < 2:
            return []
        cuts[0] = 0.0
        middles = np.array([stroke.pose(s)[:2] for s in ((cuts[:-1] + cuts[1:]) / 2).tolist()])
        blocked = self.floor.is_hit(np.hstack([middles, middles]), np.zeros(len(middles)))
        xmin, ymin, xmax, ymax = self.floor.grown.box
        x, y = middles.T
        blocked |= (x < xmin - _SLIVER) | (x > xmax + _SLIVER) | (y < ymin - _SLIVER) | (y > ymax + _SLIVER)
        found: list[tuple[float, float]] = []
        for first, last, hit in zip(cuts[:-1].tolist(), cuts[1:].tolist(), blocked.tolist(), strict=True):
            if hit:
                continue
            if found and found[-1][1] == first:
                found[-1] = (found[-1][0], last)
            else:
                found.append((first, last))
        return found

    def walk(self, line: Stroke, hit: float, leaves: list[float], direction: int) -> Walk | str:
        """Along the edge from where the straight line meets it to the first place where the line may be taken again.

        Parameters
        ----------
        line : the straight line; ``hit`` [m] : where it meets the edge.
        leaves : lengths [m] of the line, all beyond the hit, from which it is free.
        direction : +1 with the obstacle to the left, -1 to the right.

        Returns
        -------
        The walk, or in words why there is none.
        """
        x, y, heading = line.pose(hit)
        places = [(leave, line.pose(leave)[:2]) for leave in leaves]
        strokes: list[Stroke] = []
        seen: set[tuple[int, int]] = set()
        k, s = -1, 0.0
        while True:
            following = self._next((x, y), heading, direction, k)
            if following is None:
                return "the edge of the obstacle leaves the floor there"
            k, s, end = following
            begin = (k, round(s / _MEETS))
            if begin in seen:
                return "the edge of the obstacle leads back to where it was met"
            seen.add(begin)
            whole = self.stroke(k)
            part = whole.part(s, end) if direction > 0 else whole.part(end, s).back()
            met = [(at, leave) for leave, place in places for gap, at in [distance(part, place)] if gap < _MEETS]
            if met:
                at, leave = min(met)
                strokes.append(part.part(0.0, at))
                return Walk(tuple(stroke for stroke in strokes if stroke.length > _SLIVER), leave)
            strokes.append(part)
            x, y, heading = part.pose(part.length)

    def _next(self, at: Point, heading: float, direction: int, current: int) -> tuple[int, float, float] | None:
        """The stretch that goes on from a place: its line or arc, and the lengths [m] at which it begins and ends."""
        (low_x, low_y), (high_x, high_y) = self.boxes[:, :2].T, self.boxes[:, 2:].T
        near = (low_x < at[0]) & (at[0] < high_x) & (low_y < at[1]) & (at[1] < high_y)
        found: list[tuple[float, int, float, float]] = []
        for k in np.flatnonzero(near).tolist():
            stroke = self.stroke(k)
            gap, s = distance(stroke, at)
            if gap > _MEETS:
                continue
            full = stroke.curvature and stroke.length * stroke.curvature > 2 * math.pi - 1e-9
            for place in {s, 0.0, stroke.length} if full and min(s, stroke.length - s) < _MEETS else {s}:
                for first, last in self.stretches(k):
                    end = last if direction > 0 else first
                    if first - _MEETS <= place <= last + _MEETS and direction * (end - place) > 2 * _MEETS:
                        onward = stroke.pose(place)[2] + (0.0 if direction > 0 else math.pi)
                        turn = direction * wrapped(onward - heading)
                        found.append((turn + (1e-9 if k == current else 0.0), k, place, end))
        if not found:
            return None
        # with the obstacle to the left, the edge of the free floor is what turns most to the right
        _, k, place, end = min(found)
        return k, place, end


def _near_edges(contour: Contour, box: tuple[float, float, float, float]) -> tuple[Array, Array]:
    edges, rho = contour.edges, contour.rho
    low, high = (
        np.minimum(edges[:, :2], edges[:, 2:]) - rho[:, None],
        np.maximum(edges[:, :2], edges[:, 2:]) + rho[:, None],
    )
    near = (low[:, 0] <= box[2]) & (high[:, 0] >= box[0]) & (low[:, 1] <= box[3]) & (high[:, 1] >= box[1])
    return edges[near], rho[near]


def _arc_cuts(contour: Contour, stroke: Stroke) -> Array:
    """Lengths [m] at which an arc may get in or out of something."""
    radius = 1 / stroke.curvature
    center = np.array([stroke.x - radius * math.sin(stroke.heading), stroke.y + radius * math.cos(stroke.heading)])
    box = (*(center - radius).tolist(), *(center + radius).tolist())
    edges, rho = _near_edges(contour, box)
    angles = blocked_angles(center, radius, edges, rho, contour.floor.grown.box).ravel()
    begin = stroke.heading - math.pi / 2
    return np.asarray(((angles - begin + _SLIVER) % (2 * math.pi) - _SLIVER) * radius)


def _line_cuts(contour: Contour, stroke: Stroke) -> Array:
    """Lengths [m] at which a line meets the border of a segment grown by rho, or the box."""
    x1, y1, _ = stroke.pose(stroke.length)
    box = (min(stroke.x, x1), min(stroke.y, y1), max(stroke.x, x1), max(stroke.y, y1))
    edges, rho = _near_edges(contour, box)
    c, s = math.cos(stroke.heading), math.sin(stroke.heading)
    ends = [_framed(edges[:, k : k + 2], stroke, c, s) for k in (0, 2)]
    cuts: list[Array] = []
    with np.errstate(invalid="ignore", divide="ignore"):
        for end in ends:  # discs: half chords
            half = np.sqrt(rho**2 - end[:, 1] ** 2)
            cuts += [end[:, 0] - half, end[:, 0] + half]
        along = ends[1] - ends[0]
        length = np.hypot(along[:, 0], along[:, 1])
        for side in (1.0, -1.0):  # strips: where the lines beside the segment have height 0
            height = ends[0][:, 1] + side * rho * along[:, 0] / length
            share = -height / along[:, 1]
            cut = ends[0][:, 0] - side * rho * along[:, 1] / length + share * along[:, 0]
            cuts.append(np.where((share >= -_SLIVER) & (share <= 1 + _SLIVER), cut, np.nan))
        xmin, ymin, xmax, ymax = contour.floor.grown.box
        cuts.append(np.array([(xmin - stroke.x), (xmax - stroke.x)]) / c if c else np.empty(0))
        cuts.append(np.array([(ymin - stroke.y), (ymax - stroke.y)]) / s if s else np.empty(0))
    found = np.concatenate(cuts)
    return np.asarray(found[np.isfinite(found)])


def _framed(points: Array, stroke: Stroke, c: float, s: float) -> Array:
    dx, dy = points[:, 0] - stroke.x, points[:, 1] - stroke.y
    return np.column_stack([c * dx + s * dy, c * dy - s * dx])


def _boxes(table: Array) -> Array:
    """Boxes (n, 4) [m] about lines and arcs, with the room that meeting needs."""
    x, y, heading, length, curvature = table.T
    bent = curvature > 0
    radius = 1 / np.where(bent, curvature, 1.0)
    cx = np.where(bent, x - radius * np.sin(heading), x + length / 2 * np.cos(heading))
    cy = np.where(bent, y + radius * np.cos(heading), y + length / 2 * np.sin(heading))
    rx = np.where(bent, radius, np.abs(length / 2 * np.cos(heading))) + _MEETS
    ry = np.where(bent, radius, np.abs(length / 2 * np.sin(heading))) + _MEETS
    return np.column_stack([cx - rx, cy - ry, cx + rx, cy + ry])
