"""Which segments keep the distance from grown obstacles, and what is near a turn: behind the path search."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import shapely

from coord.geometry.growth import Grown
from coord.geometry.shapes import Geometry
from coord.geometry.spines import crossing, reaching
from coord.model.arrays import Array

#: [m] Contact is no hit: a tangent touches the disc it leaves.
_TOUCH = 1e-9


class Floor:
    """Grown obstacles with an index, and the distance the search keeps from each part."""

    def __init__(self, grown: Grown, rho: Array) -> None:
        """Use ``rho`` (m,) [m] for the parts: a little more than needed, less near the start and the goal."""
        self.grown = grown
        self.rho = rho
        self.boxes = _boxes(grown, rho)
        self._tree = shapely.STRtree(self.boxes)

    def hit_parts(self, segments: Array) -> npt.NDArray[np.intp]:
        """Pairs (k, 2) of a segment's index and a part's, where segments (n, 4) come too near to a part."""
        return _near_pairs(self._tree, self.grown.parts, self.rho, segments)

    def parts_within(self, distance: float, segments: Array) -> npt.NDArray[np.intp]:
        """Parts whose grown boxes come so near [m] to any of the segments (n, 4), ascending."""
        lines = shapely.linestrings(segments.reshape(-1, 2, 2))
        return np.unique(self._tree.query(lines, predicate="dwithin", distance=distance)[1])

    def sizes(self, parts: npt.NDArray[np.intp]) -> Array:
        """The smaller sides (n,) [m] of the grown boxes of parts."""
        bounds = shapely.bounds(self.boxes[parts])
        return np.asarray((bounds[:, 2:] - bounds[:, :2]).min(axis=1))

    def is_hit(self, segments: Array, errors: Array) -> npt.NDArray[np.bool_]:
        """Whether segments (n, 4), each widened by its error (n,) [m], come too near to any part."""
        return _any(len(segments), _near_pairs(self._tree, self.grown.parts, self.rho, segments, errors))

    def near_parts(self, box: tuple[float, float, float, float]) -> npt.NDArray[np.intp]:
        """Parts whose grown boxes meet a box, ascending."""
        if not len(self.grown.parts):
            return np.empty(0, dtype=np.intp)
        return np.sort(self._tree.query(shapely.box(*box)))

    def edges_of(self, parts: npt.NDArray[np.intp]) -> tuple[Array, Array]:
        """Segments (e, 4) [m] of the cores of parts, and the distance (e,) [m] to keep from each."""
        index = self.grown.edges_of(parts)
        return self.grown.edges[index], self.rho[self.grown.edge_parts[index]]


class Outlines:
    """The segments of parts that joined one after the other, for looking up those near an arc."""

    def __init__(self, floor: Floor) -> None:
        """Begin without any."""
        self._floor = floor
        self.edges, self.rho, self.parts = np.empty((0, 4)), np.empty(0), np.empty(0, dtype=np.intp)
        self._middles, self._widths = np.empty((2, 0)), np.empty((2, 0))  # twice the middle, and the grown size

    def add(self, parts: npt.NDArray[np.intp]) -> None:
        """Let the segments of more parts join."""
        edges, rho = self._floor.edges_of(parts)
        a, b = edges.T[:2], edges.T[2:]
        self.edges, self.rho = np.concatenate([self.edges, edges]), np.concatenate([self.rho, rho])
        owners = self._floor.grown.edge_parts[self._floor.grown.edges_of(parts)]
        self.parts = np.concatenate([self.parts, owners])
        self._middles = np.hstack([self._middles, a + b])
        self._widths = np.hstack([self._widths, np.abs(a - b) + 2 * rho])

    def near_turns(
        self, centers: Array, parts: npt.NDArray[np.intp], radius: Array, first: Array, span: Array, known: int
    ) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Pairs of a turn and a segment, from number ``known`` on, whose grown box comes near the turn.

        Turns (k,) go round corners of some parts in directions from ``first`` [rad] over ``span``. Segments of the
        corner's own part count only where that is not convex, and never the two that meet at the corner: a turn in
        the directions of the corner keeps its radius from those.
        """
        middle = first + span / 2
        at = centers + radius[:, None] * np.stack([np.cos(middle), np.sin(middle)], axis=1)
        reach = 4 * radius * np.sin(span / 4)  # twice the distance of the ends of the turn from its middle
        near = np.ones((len(radius), len(self.rho) - known), dtype=np.bool_)
        for axis in (0, 1):
            gap = np.abs(self._middles[axis, None, known:] - 2 * at[:, axis, None])
            near &= gap < self._widths[axis, None, known:] + reach[:, None]
        row, segment = np.nonzero(near)
        segment += known
        (x, y), (ax, ay, bx, by) = centers[row].T, self.edges[segment].T
        meets = ((ax == x) & (ay == y)) | ((bx == x) & (by == y))
        others = (self.parts[segment] != parts[row]) | ~(meets | self._floor.grown.convex[parts[row]])
        return row[others], segment[others]


class Screen:
    """Some parts of a floor, for testing many segments against them."""

    def __init__(self, floor: Floor, parts: npt.NDArray[np.intp]) -> None:
        """Index the chosen parts."""
        self._parts, self._rho = floor.grown.parts[parts], floor.rho[parts]
        self._tree, self._boxes = shapely.STRtree(floor.boxes[parts]), shapely.bounds(floor.boxes[parts])
        self._spines = reaching(floor.grown.spines[parts], self._rho)

    def is_hit(self, segments: Array) -> npt.NDArray[np.bool_]:
        """Whether segments (n, 4) come too near to any of the parts.

        Most of those that do cross the middle of a part: distances are measured for the rest only.
        """
        hit = np.zeros(len(segments), dtype=np.bool_)
        if not len(self._rho) or not len(segments):
            return hit
        lines = shapely.linestrings(segments.reshape(-1, 2, 2))
        line, part = self._tree.query(lines)
        hit[line[crossing(segments[line, None], self._spines[part]).any(axis=1)]] = True
        line, part = line[~hit[line]], part[~hit[line]]
        met = _meet(segments[line], self._boxes[part])
        line, part = line[met], part[met]
        near = shapely.dwithin(self._parts[part], lines[line], np.maximum(self._rho[part] - _TOUCH, 0.0))
        hit[line[near]] = True
        return hit


def _meet(segments: Array, boxes: Array) -> npt.NDArray[np.bool_]:
    """Whether boxes (n, 4) have corners on both sides of the lines through segments (n, 4), one by one."""
    ax, ay, bx, by = segments.T
    xmin, ymin, xmax, ymax = boxes.T
    ux, uy = bx - ax, by - ay
    offset = ux * (ymin + ymax - 2 * ay) - uy * (xmin + xmax - 2 * ax)
    return np.asarray(np.abs(offset) <= np.abs(ux) * (ymax - ymin) + np.abs(uy) * (xmax - xmin) + _TOUCH)


def _near_pairs(
    tree: shapely.STRtree, parts: Geometry, rho: Array, segments: Array, errors: Array | None = None
) -> npt.NDArray[np.intp]:
    """Pairs (k, 2) of a segment (n, 4) and an indexed part nearer than the part's rho and the segment's error."""
    if not len(segments) or not len(parts):
        return np.empty((0, 2), dtype=np.intp)
    lines = shapely.linestrings(segments.reshape(-1, 2, 2))
    probes = lines
    if errors is not None:
        low, high = np.minimum(segments[:, :2], segments[:, 2:]), np.maximum(segments[:, :2], segments[:, 2:])
        probes = shapely.box(*(low - errors[:, None]).T, *(high + errors[:, None]).T)
    line, part = tree.query(probes, predicate="intersects")
    far = rho[part] if errors is None else rho[part] + errors[line]
    near = shapely.dwithin(parts[part], lines[line], np.maximum(far - _TOUCH, 0.0))
    return np.stack([line[near], part[near]], axis=1)


def _any(count: int, pairs: npt.NDArray[np.intp]) -> npt.NDArray[np.bool_]:
    hit = np.zeros(count, dtype=np.bool_)
    hit[pairs[:, 0]] = True
    return hit


def _boxes(grown: Grown, rho: Array) -> npt.NDArray[np.object_]:
    if not len(grown.parts):
        return np.empty(0, dtype=object)
    bounds = shapely.bounds(grown.parts)
    return np.asarray(shapely.box(*(bounds[:, :2] - rho[:, None]).T, *(bounds[:, 2:] + rho[:, None]).T))
