"""Obstacles grown by what a robot needs: exact cores, cut into parts, with the corners paths turn round.

A grown obstacle is a core and a distance rho to keep from it; it is never turned into a polygon. Polygons
that touch are merged first, so that no path is sought between them; large cores are cut into parts, so that a
search looks only at those near its way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import shapely

from coord.errors import InvalidValueError
from coord.geometry.index import connected
from coord.geometry.shapes import Geometry, core, meeting
from coord.geometry.spines import spines
from coord.model.arrays import Array
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle

#: Corners lose directions to so many neighbours on either side, all but a hair [rad].
_NEIGHBOURS, _TRIM_SLACK = 12, 1e-6

#: Cores with more vertices are halved until no part has more.
_MOST_VERTICES = 64


@dataclass(frozen=True, slots=True, eq=False)
class Corners:
    """Where shortest paths may turn: round a vertex, at directions between the normals of its two edges.

    Parameters
    ----------
    places : (n, 2) array [m].
    first, span : (n,) arrays [rad], the directions from ``first`` counter-clockwise over ``span``; a circle's
        centre has all directions, span 2 pi.
    parts : (n,) indices of the parts they belong to.
    """

    places: Array
    first: Array
    span: Array
    parts: npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Grown:
    """The obstacles of a floor as seen by a robot.

    Parameters
    ----------
    parts : (m,) array of shapes; ``rho`` : (m,) distance [m] that the robot's centre keeps from each;
        ``convex`` : (m,) whether it is convex; ``spines`` : (m, 2, 4) [m], segments inside it.
    corners : of all parts.
    edges : (e, 4) array [m], the segments of all parts (a point twice for a circle); ``edge_parts`` : (e,).
    touching : (t, 2) pairs of parts that touch, in both orders, ascending.
    box : xmin, ymin, xmax, ymax [m] of the places where the robot's centre may be.
    """

    parts: Geometry
    rho: Array
    convex: npt.NDArray[np.bool_]
    spines: Array
    corners: Corners
    edges: Array
    edge_parts: npt.NDArray[np.intp]
    touching: npt.NDArray[np.intp]
    box: tuple[float, float, float, float]

    def near_siblings(self, chosen: npt.NDArray[np.intp], steps: int) -> npt.NDArray[np.intp]:
        """The chosen parts and those that so many steps from part to touching part lead to, ascending."""
        reached = np.unique(chosen)
        for _ in range(steps):
            index = _rows(self.touching[:, 0], reached)
            reached = np.union1d(reached, self.touching[index, 1])
        return reached

    def edges_of(self, chosen: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
        """Indices of the segments of some parts; a part's segments follow each other, in the order of the parts."""
        return _rows(self.edge_parts, chosen)

    def corners_of(self, chosen: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
        """Indices of the corners of some parts."""
        return _rows(self.corners.parts, chosen)


def _rows(owners: npt.NDArray[np.intp], chosen: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Where the chosen stand in an ascending list of owners."""
    first, last = np.searchsorted(owners, chosen), np.searchsorted(owners, chosen, side="right")
    ranges = [np.arange(a, b) for a, b in zip(first.tolist(), last.tolist(), strict=True)]
    return np.concatenate([np.empty(0, dtype=np.intp), *ranges])


def grow(
    obstacles: Sequence[Obstacle], footprint: Footprint, clearance: float, bounds: tuple[float, float, float, float]
) -> Grown:
    """Grow obstacles for a robot that keeps a clearance [m] from everything.

    For a disc, and for a polygon that turns with the path, the cores are the obstacles and the radius is added
    to the distance. For a polygon K that keeps its heading they are Minkowski sums with -K: the places of its
    reference point at which it would touch the obstacle.

    Raises
    ------
    InvalidValueError
        When outlines cross themselves: problem files are checked for that, problems made by programs are not.
    """
    _check_outlines(obstacles)
    K, reach = np.array(footprint.core), footprint.margin + clearance
    round_ones = [obstacle for obstacle in obstacles if isinstance(obstacle, Circle)]
    polygons = [
        meeting(core(obstacle)[0], footprint.core) for obstacle in obstacles if not isinstance(obstacle, Circle)
    ]
    shapes: list[Geometry] = []
    owners: list[int] = []
    for whole in _merged(polygons):
        pieces = _cut(whole)
        owners += [len(owners)] * len(pieces)
        shapes += pieces
    parts = np.array([*shapes, *(meeting(core(circle)[0], footprint.core) for circle in round_ones)], dtype=object)
    rho = np.array([reach] * len(shapes) + [reach + circle.radius for circle in round_ones])
    outlines = _Outlines.of(parts)
    edges, edge_parts = outlines.edges()
    (left, lower), (right, upper) = K.min(axis=0), K.max(axis=0)
    xmin, ymin, xmax, ymax = bounds
    box = (xmin - left + reach, ymin - lower + reach, xmax - right - reach, ymax - upper - reach)
    siblings = np.array(owners + list(range(len(owners), len(parts))), dtype=np.intp)
    return Grown(
        parts,
        rho,
        outlines.convex(len(parts)),
        spines(parts, edges, edge_parts),
        outlines.corners(rho),
        edges,
        edge_parts,
        _touching(parts, siblings),
        box,
    )


def _check_outlines(obstacles: Sequence[Obstacle]) -> None:
    cores = np.array([core(obstacle)[0] for obstacle in obstacles], dtype=object)
    faults = [
        ("polygon", f'obstacle "{obstacles[k].name}": {shapely.is_valid_reason(cores[k])}; an outline must be simple')
        for k in np.flatnonzero(~shapely.is_valid(cores)).tolist()
    ]
    if faults:
        raise InvalidValueError(faults)


def _merged(polygons: list[Geometry]) -> list[Geometry]:
    """Small polygons united where they touch or overlap; others are left as they are, vertex by vertex.

    It saves corners that no path can turn round. What is left apart is as impassable as what is united.
    """
    small = np.array([shapely.get_num_coordinates(polygon) <= _MOST_VERTICES for polygon in polygons], dtype=np.bool_)
    shapes = np.array(polygons, dtype=object)
    a, b = shapely.STRtree(shapes[small]).query(shapes[small], predicate="intersects")
    label = connected(int(small.sum()), a, b)
    merged = list(shapes[~small])
    for group in np.unique(label).tolist():
        members = shapes[small][label == group]
        merged += list(shapely.get_parts(shapely.union_all(members))) if len(members) > 1 else list(members)
    return merged


def _cut(whole: Geometry) -> list[Geometry]:
    """Halve a polygon across its longer side until its parts are small."""
    if shapely.get_num_coordinates(whole) <= _MOST_VERTICES:
        return [whole]
    xmin, ymin, xmax, ymax = shapely.bounds(whole)
    if xmax - xmin >= ymax - ymin:
        middle = (xmin + xmax) / 2
        halves = [(xmin, ymin, middle, ymax), (middle, ymin, xmax, ymax)]
    else:
        middle = (ymin + ymax) / 2
        halves = [(xmin, ymin, xmax, middle), (xmin, middle, xmax, ymax)]
    pieces = [_clipped(whole, half) for half in halves]
    polygons = [part for piece in pieces for part in shapely.get_parts(piece) if shapely.get_dimensions(part) == 2]
    return [part for polygon in polygons for part in _cut(polygon)]


def _clipped(whole: Geometry, box: tuple[float, float, float, float]) -> Geometry:
    """What of a polygon lies in a box; the quick way sometimes leaves outlines that touch themselves."""
    quick = shapely.clip_by_rect(whole, *box)
    return quick if shapely.is_valid(quick) else shapely.intersection(whole, shapely.box(*box))


def _touching(parts: Geometry, siblings: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Pairs (t, 2) of parts of one whole whose boxes touch, in both orders, ascending."""
    boxes = shapely.box(*shapely.bounds(parts).reshape(-1, 4).T) if len(parts) else parts
    a, b = shapely.STRtree(boxes).query(boxes, predicate="intersects")
    pairs = np.stack([a, b], axis=1)[(siblings[a] == siblings[b]) & (a != b)]
    return np.asarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))], dtype=np.intp)


@dataclass(frozen=True, slots=True, eq=False)
class _Outlines:
    """All rings of all parts, obstacle to the left: (n, 2) points, the row of the next and the one before, the part."""

    points: Array
    following: npt.NDArray[np.intp]
    preceding: npt.NDArray[np.intp]
    parts: npt.NDArray[np.intp]

    @classmethod
    def of(cls, parts: Geometry) -> _Outlines:
        """Of parts that are polygons or points; a point is a ring of one."""
        is_point = shapely.get_dimensions(parts) == 0
        rings, owner = shapely.get_rings(shapely.orient_polygons(parts), return_index=True)
        points, ring = shapely.get_coordinates(rings, return_index=True)
        closing = np.diff(ring, append=-1) != 0  # rings repeat their first point at the end
        points, ring = points[~closing], ring[~closing]
        points = np.vstack([points, shapely.get_coordinates(parts[is_point])])
        ring = np.append(ring, len(rings) + np.arange(int(is_point.sum())))
        owner = np.append(owner, np.flatnonzero(is_point))
        if not len(points):
            nothing = np.empty(0, dtype=np.intp)
            return cls(points, nothing, nothing, nothing)
        starts = np.flatnonzero(np.diff(ring, prepend=-1))
        ends = np.append(starts[1:], len(ring)) - 1
        following, preceding = np.arange(len(ring)) + 1, np.arange(len(ring)) - 1
        following[ends], preceding[starts] = starts, ends
        return cls(points, following, preceding, owner[ring].astype(np.intp))

    def edges(self) -> tuple[Array, npt.NDArray[np.intp]]:
        """Segments (n, 4) and their parts."""
        return np.hstack([self.points, self.points[self.following]]), self.parts

    def _turns(self) -> tuple[Array, Array]:
        """The edges (n, 2) that lead to the vertices, and how far [rad] the outline turns there, to the left if > 0."""
        along = self.points[self.following] - self.points
        before = along[self.preceding]
        turn = np.arctan2(before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0], (before * along).sum(axis=1))
        return before, turn

    def convex(self, count: int) -> npt.NDArray[np.bool_]:
        """Which of so many parts have no vertex that turns the other way."""
        return np.asarray(np.bincount(self.parts[self._turns()[1] < 0], minlength=count) == 0)

    def corners(self, rho: Array) -> Corners:
        """The convex vertices with the cones of their outward normals."""
        before, turn = self._turns()
        first = np.arctan2(-before[:, 0], before[:, 1])  # outward normal: the edge turned clockwise
        alone = self.following == np.arange(len(self.points))
        convex = np.flatnonzero((turn > 1e-12) & ~alone)
        first, span = self._trimmed(convex, first[convex], turn[convex], rho[self.parts[convex]])
        left = span > 1e-12
        rows = np.sort(np.concatenate([convex[left], np.flatnonzero(alone)]))
        whole_first, whole_span = np.zeros(len(alone)), np.full(len(alone), 2 * np.pi)
        whole_first[convex[left]], whole_span[convex[left]] = first[left], span[left]
        return Corners(self.points[rows], whole_first[rows], whole_span[rows], self.parts[rows])

    def _trimmed(self, rows: npt.NDArray[np.intp], first: Array, span: Array, rho: Array) -> tuple[Array, Array]:
        """Cones without the directions at their ends in which a neighbour along the outline is nearer than rho.

        A round or slanted wall on a grid is a staircase, whose corners keep a sliver of their directions each.
        """
        low, high = np.zeros(len(rows)), span.copy()
        for step in (self.following, self.preceding):
            other = step[rows]
            for _ in range(_NEIGHBOURS):
                gap = self.points[other] - self.points[rows]
                far = np.hypot(gap[:, 0], gap[:, 1])
                near = (far > 0) & (far < 2 * rho)
                half = np.arccos(np.clip(far / np.where(near, 2 * rho, np.inf), 0.0, 1.0)) - _TRIM_SLACK
                begin = (np.arctan2(gap[:, 1], gap[:, 0]) - half - first) % (2 * np.pi)
                end = begin + 2 * half
                # the blocked stretch, and the same a turn earlier, as seen from the cone's first direction
                for a, b in ((begin, end), (begin - 2 * np.pi, end - 2 * np.pi)):
                    low = np.where(near & (a <= low) & (b > low), b, low)
                    high = np.where(near & (a < high) & (b >= high), a, high)
                other = step[other]
        return first + low, high - low
