"""Where a robot can get to at most while others stand still: the floor as a raster, cells as bits of one number.

A raster cannot prove that there is a way. This one is generous: shapes are taken as discs that they hold, and every
distance is shortened by what lies between a point and the middle of its cell. So where no cells lead from a place to
another, no way does, which is found out about fifty times as quickly as by a search for ways.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import InitVar, dataclass, field
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from coord.geometry.shapes import too_near
from coord.model.arrays import Array, Point
from coord.model.footprint import Footprint
from coord.model.obstacle import Obstacle
from coord.model.problem import Problem

#: [m] Cells are so wide, on floors of many of them wider.
_CELL, _MOST_CELLS = 0.1, 250_000


@dataclass(slots=True, eq=False)
class Raster:
    """A floor in cells, a set of cells as the bits of a number, row by row; each row ends with one that none enters.

    Parameters
    ----------
    x, y : of the middles of the columns and rows [m].
    """

    problem: InitVar[Problem]
    x: Array = field(init=False)
    y: Array = field(init=False)
    _cell: float = field(init=False)
    _clearance: float = field(init=False)
    _obstacles: Sequence[Obstacle] = field(init=False)
    _grounds: dict[float, int] = field(init=False, default_factory=dict)
    _discs: dict[tuple[Point, float], int] = field(init=False, default_factory=dict)

    def __post_init__(self, problem: Problem) -> None:
        xmin, ymin, xmax, ymax = problem.workspace.bounds
        self._cell = max(_CELL, math.sqrt((xmax - xmin) * (ymax - ymin) / _MOST_CELLS))
        self.x, self.y = (np.arange(a, b + self._cell, self._cell) for a, b in ((xmin, xmax), (ymin, ymax)))
        self._clearance, self._obstacles = problem.workspace.clearance, problem.obstacles

    def ground(self, shape: Footprint) -> int:
        """Cells in which a robot may be clear of all obstacles and of the edge."""
        reach = self._short(inner_radius(shape) + self._clearance)
        if reach not in self._grounds:
            u, v = np.meshgrid(self.x, self.y)
            edge = (u < self.x[0] + reach) | (v < self.y[0] + reach)
            free = ~(edge | (u > self.x[-1] - reach) | (v > self.y[-1] - reach)).reshape(-1)
            near, _, _ = too_near(self._obstacles, np.stack([u, v], axis=2).reshape(-1, 2), np.full(u.size, reach))
            free[near] = False
            self._grounds[reach] = self._bits(free.reshape(u.shape))
        return self._grounds[reach]

    def beside(self, shape: Footprint, other: Footprint, place: Point) -> int:
        """Cells in which a robot is too near to another that stands at a place."""
        reach = self._short(inner_radius(shape) + inner_radius(other) + self._clearance)
        if (place, reach) not in self._discs:
            near = np.hypot(self.x - place[0], (self.y - place[1])[:, None]) < reach
            self._discs[place, reach] = self._bits(near)
        return self._discs[place, reach]

    def cell(self, place: Point) -> int:
        """The cell that holds a place."""
        across = min(max(round((place[0] - float(self.x[0])) / self._cell), 0), len(self.x) - 1)
        along = min(max(round((place[1] - float(self.y[0])) / self._cell), 0), len(self.y) - 1)
        return 1 << (along * (len(self.x) + 1) + across)

    def reached(self, place: Point, free: int, goal: int = 0) -> int:
        """Cells that free cells lead to from a place, corner to corner too; not all once the goal is among them."""
        now, before = self.cell(place), 0
        while now != before and not now & goal:
            before = now
            now |= self.widened(now) & free
        return now

    def widened(self, cells: int) -> int:
        """Some cells and all next to them, corner to corner too."""
        row = len(self.x) + 1
        cells |= (cells << 1) | (cells >> 1)
        return cells | (cells << row) | (cells >> row)

    def _short(self, distance: float) -> float:
        """A distance [m] without what may lie between a point and the middle of its cell, for both ends at once."""
        return distance - self._cell * math.sqrt(0.5)

    def _bits(self, cells: npt.NDArray[np.bool_]) -> int:
        whole = np.concatenate([cells, np.zeros((len(cells), 1), dtype=np.bool_)], axis=1)
        return int.from_bytes(np.packbits(whole, bitorder="little").tobytes(), "little")


def inner_radius(shape: Footprint) -> float:
    """Of a disc about the reference point that a robot covers, however it is turned [m]."""
    if not shape.vertices:
        return shape.radius
    edges = pairwise([*shape.vertices, shape.vertices[0]])
    return min((a[0] * b[1] - a[1] * b[0]) / math.dist(a, b) for a, b in edges)
