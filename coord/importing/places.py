"""Two places far apart on a floor that a robot can drive between: where an example robot starts, and where it goes."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Point

Cells = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.intp]

#: Maps are looked at in blocks of cells, so that they have at most this many rows and columns: seconds become moments.
_MOST = 600

#: Separate free regions that are looked at, largest or not, before the best of them is taken.
_REGIONS = 200


def two_places(occupied: Cells, resolution: float, origin: Point, radius: float) -> tuple[Point, Point] | None:
    """Start and goal of a disc that gets from one to the other; None where no place is free.

    Parameters
    ----------
    occupied : (rows, columns) array, row 0 at the bottom. resolution : side of a cell [m].
    origin : lower left corner [m]. radius : of the disc [m].

    A disc whose centre moves from cell to cell stays clear when each of these cells has free cells all round it, as
    far as the disc reaches. Both places are about as far apart as places of the largest free region can be.
    """
    for factor in dict.fromkeys([max(1, math.ceil(max(occupied.shape) / _MOST)), 1]):
        size = resolution * factor
        free = _roomy(_blocks(occupied, factor), max(0, math.ceil(radius / size - 0.5 + 1e-6)))
        if free.any():
            first, last = ((r + 0.5, c + 0.5) for r, c in _far_apart(free))
            return (
                (origin[0] + size * first[1], origin[1] + size * first[0]),
                (origin[0] + size * last[1], origin[1] + size * last[0]),
            )
    return None


def _blocks(occupied: Cells, factor: int) -> Cells:
    """Blocks of factor x factor cells, occupied where one of them is, or is beyond the edge."""
    rows, columns = occupied.shape
    padded = np.pad(occupied, ((0, -rows % factor), (0, -columns % factor)), constant_values=True)
    return np.asarray(padded.reshape(len(padded) // factor, factor, -1, factor).any(axis=(1, 3)))


def _roomy(occupied: Cells, reach: int) -> Cells:
    """Cells with nothing occupied within ``reach`` rows and columns; beyond the edge all is."""
    wide = np.pad(occupied, reach, constant_values=True)
    sums = np.pad(wide.astype(np.int64).cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    n = 2 * reach + 1
    return np.asarray(sums[n:, n:] - sums[:-n, n:] - sums[n:, :-n] + sums[:-n, :-n] == 0)


def _far_apart(free: Cells) -> tuple[tuple[int, int], tuple[int, int]]:
    """Two cells (row, column) of the largest region of free cells, far apart along the way between them."""
    width = free.shape[1] + 2
    left = np.pad(free, 1).ravel()
    largest: Indices = np.empty(0, dtype=np.intp)
    for _ in range(_REGIONS):
        if int(left.sum()) <= len(largest):
            break
        region = _flood(left, int(left.argmax()), width)
        left[region] = False
        largest = max(largest, region, key=len)
    inside = np.zeros(left.shape, dtype=bool)
    inside[largest] = True
    first = int(_flood(inside, int(largest[0]), width)[-1])
    last = int(_flood(inside, first, width)[-1])
    return (first // width - 1, first % width - 1), (last // width - 1, last % width - 1)


def _flood(free: Cells, start: int, width: int) -> Indices:
    """All cells joined to one by steps along rows and columns, the nearest first, the farthest last."""
    seen = ~free
    seen[start] = True
    front = np.array([start], dtype=np.intp)
    found = [front]
    while len(front):
        near = np.concatenate([front - 1, front + 1, front - width, front + width])
        front = np.unique(near[~seen[near]])
        seen[front] = True
        found.append(front)
    return np.concatenate(found)
