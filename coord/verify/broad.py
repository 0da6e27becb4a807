"""Which robots could meet at all, and when: boxes of their motion in slabs of time, in a grid of cells."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from coord.verify.curve import point
from coord.verify.motion import Motion, arc_length
from coord.verify.tolerances import BOX

#: Number, xmin, ymin, xmax, ymax [m].
Box = tuple[int, float, float, float, float]

#: How many boxes there may be in all before slabs are made longer.
_BOXES = 2_000_000

#: Boxes over more cells than this are compared with everything instead.
_CELLS = 256
_ROW = 1 << 40


class Grid:
    """Boxes by the cells they touch; a cell is one whole number, made of its column and row."""

    def __init__(self, size: float) -> None:
        self._size = size
        self._cells: dict[int, list[Box]] = {}
        self._large: list[Box] = []
        self._all: list[Box] = []

    def add(self, box: Box) -> None:
        """Put a box into the grid."""
        self.put(box, self.touched(box))

    def near(self, box: Box) -> list[Box]:
        """Boxes in the grid that overlap one; some of them more than once."""
        return self.among(self.touched(box), box)

    def put(self, box: Box, cells: Sequence[int]) -> None:
        """Put a box into the cells it touches."""
        self._all.append(box)
        if not cells:
            self._large.append(box)
        table = self._cells
        for cell in cells:
            if cell in table:
                table[cell].append(box)
            else:
                table[cell] = [box]

    def among(self, cells: Sequence[int], box: Box) -> list[Box]:
        """Boxes of these cells that overlap one; some of them more than once."""
        _, x0, y0, x1, y1 = box
        table, found = self._cells, []
        for cell in cells:
            if cell in table:
                for other in table[cell]:
                    if other[1] <= x1 and x0 <= other[3] and other[2] <= y1 and y0 <= other[4]:
                        found.append(other)
        if self._large or not cells:
            for other in self._large if cells else self._all:
                if other[1] <= x1 and x0 <= other[3] and other[2] <= y1 and y0 <= other[4]:
                    found.append(other)
        return found

    def touched(self, box: Box) -> Sequence[int]:
        """The cells a box touches; none if they are too many, then it is compared with everything."""
        size = self._size
        i0, i1 = int(box[1] // size), int(box[3] // size)
        j0, j1 = int(box[2] // size), int(box[4] // size)
        if i0 == i1 and j0 == j1:
            return (i0 * _ROW + j0,)
        if (i1 - i0 + 1) * (j1 - j0 + 1) > _CELLS:
            return ()
        return [i * _ROW + j for i in range(i0, i1 + 1) for j in range(j0, j1 + 1)]


def grown(box: Box, by: float) -> Box:
    """A box made wider on all sides [m]."""
    return box[0], box[1] - by, box[2] - by, box[3] + by, box[4] + by


def sizes(margins: Sequence[float], motions: Sequence[Motion]) -> tuple[float, float]:
    """A good length of slabs [s] and size of cells [m] for boxes grown by these margins [m].

    A slab is the time in which a usual robot drives four times its own size: with shorter ones, most of the work is
    to fill the grid, with longer ones to look at pairs that do not meet. A cell is twice a usual box.
    """
    size = 2 * math.fsum(margins) / len(margins)
    time = math.fsum(motion.arrival - motion.departure for motion in motions)
    way = math.fsum(motion.path.length for motion in motions)
    slab = max(4 * size * time / way if way > 0.0 else 1.0, time / _BOXES, 1e-3)
    return slab, max(2 * size + 2 * slab * (way / time if time > 0.0 else 0.0), 1e-3)


def slabs(motions: Sequence[tuple[int, Motion]], slab: float) -> Iterator[tuple[int, list[Box]]]:
    """Slab number, increasing, and the boxes of the reference points of all that move in it.

    One slab after the other, because so many boxes at once would keep the memory busy.
    """
    waiting = sorted(((int(motion.departure // slab), number, motion) for number, motion in motions), reverse=True)
    active: list[Iterator[Box]] = []
    n = 0
    while waiting or active:
        if not active:
            n = waiting[-1][0]
        while waiting and waiting[-1][0] == n:
            _, number, motion = waiting.pop()
            active.append(_trail(number, motion, slab))
        boxes = [next(trail, None) for trail in active]
        active = [trail for trail, box in zip(active, boxes, strict=True) if box is not None]
        yield n, [box for box in boxes if box is not None]
        n += 1


def _trail(number: int, motion: Motion, slab: float) -> Iterator[Box]:
    """The boxes of one robot, slab by slab.

    All points of a way of length w between two ends at the distance c lie within sqrt(w^2 - c^2)/2 of the box
    of the ends: they lie in the ellipse with these foci.
    """
    stretches, pieces, k, n = motion.stretches, motion.path.pieces, 0, int(motion.departure // slab)
    s, (x, y) = 0.0, motion.path.start[:2]
    while True:
        end = min((n + 1) * slab, motion.arrival)
        while stretches[k].end < end:
            k += 1
        stretch = stretches[k]
        s1 = arc_length(stretch, end)
        x1, y1 = point(pieces[stretch.piece], s1)
        way, dx, dy = s1 - s, x1 - x, y1 - y
        wide = math.sqrt(max(way * way - dx * dx - dy * dy, 0.0)) / 2 + BOX
        left, right = (x, x1) if x < x1 else (x1, x)
        low, high = (y, y1) if y < y1 else (y1, y)
        yield number, left - wide, low - wide, right + wide, high + wide
        if end >= motion.arrival:
            return
        n, s, x, y = n + 1, s1, x1, y1


class Candidates:
    """Who may be near whom: pairs of movers with the slabs in which that may be, and movers with still boxes.

    ``meetings`` : (lower, higher number) -> slabs, increasing. ``passings`` : (number, still box) -> slabs.
    ``crowded`` : whether the search ended early because there were too many pairs.
    """

    def __init__(self) -> None:
        self.meetings: dict[tuple[int, int], list[int]] = {}
        self.passings: dict[tuple[int, int], list[int]] = {}
        self.crowded = False


def candidates(
    moving: Iterable[tuple[int, list[Box]]], margins: Sequence[float], still: Sequence[Box], size: float, stop: int
) -> Candidates:
    """Find all boxes that overlap, those of movers grown by their margins [m], in a grid of cells of some size [m].

    With more than ``stop`` pairs the search ends early: a plan in which everybody is everywhere must not use up
    the memory.
    """
    found = Candidates()
    rests = Grid(size)
    for box in still:
        rests.add(box)
    for n, boxes in moving:
        grid = Grid(size)
        for bare in boxes:
            box = grown(bare, margins[bare[0]])
            cells = rests.touched(box)
            for other in rests.among(cells, box):
                _append(found.passings, box[0], other[0], n)
            for other in grid.among(cells, box):
                _append(found.meetings, min(other[0], box[0]), max(other[0], box[0]), n)
            grid.put(box, cells)
            if len(found.meetings) + len(found.passings) > stop:
                found.crowded = True
                return found
    return found


def _append(table: dict[tuple[int, int], list[int]], one: int, other: int, n: int) -> None:
    when = table.get((one, other))
    if when is None:
        table[one, other] = [n]
    elif when[-1] != n:
        when.append(n)


def runs(numbers: Sequence[int]) -> list[tuple[int, int]]:
    """Increasing whole numbers as runs: first, last of each."""
    found: list[tuple[int, int]] = []
    for n in numbers:
        if found and found[-1][1] == n - 1:
            found[-1] = (found[-1][0], n)
        else:
            found.append((n, n))
    return found
