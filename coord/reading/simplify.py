"""Simpler outlines that never shrink an obstacle: corners that look inwards are bridged while the growth stays small.

The obstacle lies to the left of its rings. Where a ring turns right at v, between its neighbours a and b, the edge ab
instead of av and vb adds the triangle a v b to the obstacle and takes nothing away. All that lies between a and b in
the original outline must lie to the left of ab and within the tolerance of it; then every point that was added has a
point of the original within the tolerance, found by going straight away from ab.

Rings that do not cross go on not to: an edge that reaches into the triangle would cross av or vb, or end in the
triangle, so it is enough that no other corner lies there. Lattice corners are whole numbers, and every test but that
of the tolerance is exact.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from typing import TypeAlias

import numpy as np

from coord.reading.trace import Ring

Corner: TypeAlias = tuple[int, int]
Polygons: TypeAlias = list[tuple[Ring, list[Ring]]]

#: [1] A growth that is the tolerance but for rounding (three cells of 0.05 m and 0.15 m) is allowed.
_ROUNDING = 1e-9


def simplified(polygons: Sequence[tuple[Ring, list[Ring]]], tolerance: float) -> Polygons:
    """Polygons with fewer corners that contain the given ones and reach nowhere further out than the tolerance.

    Parameters
    ----------
    polygons : as ``trace`` makes them: (shell, holes), the obstacle to the left of each ring, whole numbers, rings
        that do not cross, though they may touch in corners.
    tolerance : in the unit of the corners, so in cells; 0 leaves all as it is.

    A corner that cannot go without outlines meeting each other stays. Holes that are at most twice the tolerance
    wide and hold nothing are filled. All corners that remain were corners before.
    """
    if not tolerance > 0:
        return [(shell, list(holes)) for shell, holes in polygons]
    reach = tolerance * (1 + _ROUNDING)
    rings = [ring for shell, holes in polygons for ring in (shell, *holes)]
    outlines = _Outlines(rings, reach)
    outlines.bridge()
    result: Polygons = []
    k = 0
    for _, holes in polygons:
        shell = outlines.ring(k)
        inner = [outlines.ring(k + n) for n in range(1, len(holes) + 1) if not outlines.is_filled(k + n)]
        result.append((shell, inner))
        k += 1 + len(holes)
    return result


class _Outlines:
    """All rings as one chain of numbered corners, each with its neighbours, and a grid to find corners by place."""

    def __init__(self, rings: Sequence[Ring], reach: float) -> None:
        self._limit = reach * reach
        self._corners: list[Corner] = [(x, y) for ring in rings for x, y in ring.tolist()]
        sizes = [len(ring) for ring in rings]
        self._starts = [0, *np.cumsum(sizes).tolist()]
        self._left = list(sizes)
        self._ring = np.repeat(np.arange(len(rings)), sizes).tolist()
        self._next = [k + 1 for k in range(len(self._corners))]
        self._before = [k - 1 for k in range(len(self._corners))]
        for first, after in zip(self._starts, self._starts[1:], strict=False):
            self._next[after - 1], self._before[first] = first, after - 1
        self._original = list(self._next)
        self._gone = bytearray(len(self._corners))
        self._cell = max(1, round(4 * reach))
        self._grid: dict[Corner, list[int]] = {}
        for k, (x, y) in enumerate(self._corners):
            self._grid.setdefault((x // self._cell, y // self._cell), []).append(k)
        self._filled = {k for k in range(len(rings)) if self._can_be_filled(k, reach)}
        for k in self._filled:
            self._gone[self._starts[k] : self._starts[k + 1]] = b"\1" * sizes[k]

    def bridge(self) -> None:
        """Take out corners, those that add least first, until none can go."""
        waiting = [(self._area(v), v) for v in range(len(self._corners)) if not self._gone[v]]
        waiting = [entry for entry in waiting if entry[0] >= 0]
        heapq.heapify(waiting)
        while waiting:
            area, v = heapq.heappop(waiting)
            if self._gone[v] or area != self._area(v) or not self._may_go(v):
                continue
            a, b = self._before[v], self._next[v]
            self._next[a], self._before[b] = b, a
            self._gone[v] = 1
            self._left[self._ring[v]] -= 1
            for k in (a, b):
                if (new := self._area(k)) >= 0:
                    heapq.heappush(waiting, (new, k))

    def ring(self, k: int) -> Ring:
        """What is left of a ring."""
        first, after = self._starts[k : k + 2]
        return np.array([self._corners[v] for v in range(first, after) if not self._gone[v]], dtype=np.int64)

    def is_filled(self, k: int) -> bool:
        """Whether a hole has been filled."""
        return k in self._filled

    def _area(self, v: int) -> int:
        """Twice the area that goes to the obstacle when v goes; negative where the ring turns left."""
        a, b = self._corners[self._before[v]], self._corners[self._next[v]]
        return -_cross(a, self._corners[v], b)

    def _may_go(self, v: int) -> bool:
        a, b = self._before[v], self._next[v]
        if self._left[self._ring[v]] <= 3 or not self._is_near(a, b):
            return False
        triangle = self._corners[a], self._corners[b], self._corners[v]
        return all(k in (a, v, b) or not _holds(triangle, self._corners[k]) for k in self._corners_near(triangle))

    def _is_near(self, a: int, b: int) -> bool:
        """Whether the original outline from a to b lies to the left of the line ab, within the tolerance of it."""
        (ax, ay), (bx, by) = self._corners[a], self._corners[b]
        ex, ey = bx - ax, by - ay
        square = ex * ex + ey * ey
        k = self._original[a]
        while k != b:
            wx, wy = self._corners[k][0] - ax, self._corners[k][1] - ay
            side, along = ex * wy - ey * wx, ex * wx + ey * wy
            if side < 0:
                return False
            if 0 <= along <= square:
                distance = side * side / square if square else 0.0
            else:
                distance = wx * wx + wy * wy if along < 0 else (wx - ex) ** 2 + (wy - ey) ** 2
            if distance > self._limit:
                return False
            k = self._original[k]
        return square > 0

    def _corners_near(self, triangle: tuple[Corner, Corner, Corner]) -> Iterator[int]:
        """Corners still there in all grid cells that a triangle touches, found column by column."""
        size = self._cell
        xs = sorted(x for x, _ in triangle)
        edges = [(triangle[i], triangle[i - 1]) for i in range(3)]
        for column in range(xs[0] // size, xs[2] // size + 1):
            left, right = max(xs[0], column * size), min(xs[2], (column + 1) * size)
            heights = [y for edge in edges for y in _heights(edge, left, right)]
            for row in range(int(min(heights) // size), int(max(heights) // size) + 1):
                yield from (k for k in self._grid.get((column, row), ()) if not self._gone[k])

    def _can_be_filled(self, k: int, reach: float) -> bool:
        """Whether a ring is a hole so narrow that filling it adds nothing far from the original, and holds nothing."""
        first, after = self._starts[k : k + 2]
        xs, ys = zip(*self._corners[first:after], strict=True)
        low, high = (min(xs), min(ys)), (max(xs), max(ys))
        if min(high[0] - low[0], high[1] - low[1]) > 2 * reach or _twice_area(self._corners[first:after]) > 0:
            return False
        for column in range(low[0] // self._cell, high[0] // self._cell + 1):
            for row in range(low[1] // self._cell, high[1] // self._cell + 1):
                for other in self._grid.get((column, row), ()):
                    x, y = self._corners[other]
                    if self._ring[other] != k and low[0] <= x <= high[0] and low[1] <= y <= high[1]:
                        return False
        return True


def _cross(a: Corner, b: Corner, c: Corner) -> int:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _holds(triangle: tuple[Corner, Corner, Corner], p: Corner) -> bool:
    """Whether a point is in a triangle that runs counter-clockwise, its edges included."""
    a, b, c = triangle
    if _cross(a, b, c) == 0:  # a corner on a straight stretch: nothing is added, and nobody else is on it
        return p in triangle
    return _cross(a, b, p) >= 0 and _cross(b, c, p) >= 0 and _cross(c, a, p) >= 0


def _heights(edge: tuple[Corner, Corner], left: float, right: float) -> Iterator[float]:
    """Heights of an edge within a column, a little beyond both ends of it where it is cut."""
    (x0, y0), (x1, y1) = sorted(edge)
    if x1 < left or x0 > right:
        return
    if x0 == x1:
        yield from (y0, y1)
        return
    for x in (max(left, x0), min(right, x1)):
        y = y0 + (y1 - y0) * (x - x0) / (x1 - x0)
        yield from (y,) if x in (x0, x1) else (y - 0.5, y + 0.5)  # rounding must not lose a row


def _twice_area(ring: Sequence[Corner]) -> int:
    return sum(ring[k - 1][0] * y - x * ring[k - 1][1] for k, (x, y) in enumerate(ring))
