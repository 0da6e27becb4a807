"""The obstacles of a floor, ready to be asked: which of them are near a place, and which hold a point."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from coord.verify.broad import Box, Grid
from coord.verify.records import Circle, Point, Polygon
from coord.verify.shapes import Ring


class Part(NamedTuple):
    """A piece of an obstacle's boundary: an edge (two points), or the centre of a circle and its radius [m]."""

    obstacle: int
    ring: Ring
    radius: float


class Floor:
    """Edges and circles in a grid of cells."""

    def __init__(self, obstacles: Sequence[Circle | Polygon]) -> None:
        self.parts = tuple(_parts(obstacles))
        self._grid = Grid(1.0)
        if self.parts:
            boxes = [_box(k, part) for k, part in enumerate(self.parts)]
            total = math.fsum(math.hypot(box[3] - box[1], box[4] - box[2]) for box in boxes)
            self.cell = max(0.5, 2 * total / len(boxes), total / 200_000)
            self._grid = Grid(self.cell)
            for k, part in enumerate(self.parts):
                for box in _split(k, part, boxes[k], self.cell):
                    self._grid.add(box)

    def near(self, box: Box) -> Iterator[int]:
        """Numbers of the parts whose boxes overlap a box; some more than once."""
        return (other[0] for other in self._grid.near(box))


def _parts(obstacles: Sequence[Circle | Polygon]) -> Iterator[Part]:
    for k, obstacle in enumerate(obstacles):
        if isinstance(obstacle, Circle):
            yield Part(k, (obstacle.center,), obstacle.radius)
            continue
        for ring in obstacle.rings:
            for a, b in zip(ring, (*ring[1:], ring[0]), strict=True):
                if a != b:
                    yield Part(k, (a, b), 0.0)


def _box(number: int, part: Part) -> Box:
    xs, ys = [x for x, _ in part.ring], [y for _, y in part.ring]
    r = part.radius
    return number, min(xs) - r, min(ys) - r, max(xs) + r, max(ys) + r


def _split(number: int, part: Part, box: Box, cell: float) -> Iterator[Box]:
    """Boxes that cover a part; those of a long edge follow it, so that a slanted one does not fill the grid."""
    if len(part.ring) == 1:
        yield box
        return
    (ax, ay), (bx, by) = part.ring
    n = max(1, math.ceil(math.hypot(bx - ax, by - ay) / cell))
    previous = (ax, ay)
    for i in range(1, n + 1):
        point = (bx, by) if i == n else (ax + (bx - ax) * i / n, ay + (by - ay) * i / n)
        yield _box(number, Part(part.obstacle, (previous, point), 0.0))
        previous = point


def holders(points: Sequence[Point], obstacles: Sequence[Circle | Polygon]) -> Iterator[tuple[int, int]]:
    """(point, obstacle) numbers where a polygon holds a point, edges apart.

    Winding numbers over all rings, holes included: a point is free where they cancel.
    """
    order = sorted(range(len(points)), key=lambda k: points[k][1])
    heights = [points[k][1] for k in order]
    for number, obstacle in enumerate(obstacles):
        if isinstance(obstacle, Circle):
            continue
        winding: dict[int, int] = {}
        for ring in obstacle.rings:
            for (ax, ay), (bx, by) in zip(ring, (*ring[1:], ring[0]), strict=True):
                low, high = (ay, by) if ay < by else (by, ay)
                for n in range(bisect_left(heights, low), bisect_left(heights, high)):
                    k = order[n]
                    side = (bx - ax) * (points[k][1] - ay) - (by - ay) * (points[k][0] - ax)
                    if (side > 0.0) == (by > ay):
                        winding[k] = winding.get(k, 0) + (1 if by > ay else -1)
        yield from ((k, number) for k, turns in sorted(winding.items()) if turns)
