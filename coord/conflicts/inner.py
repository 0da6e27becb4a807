"""What is truly forbidden: the inner counterpart of a conflict region's outer bounds.

The outer bounds miss nothing, so whoever keeps out of them is safe; but they prove nothing about what is
impossible. For that every place between the bounds must be too close in truth: where chords stand for arcs, the
distance is lowered by what they may be off, and between two nodes the bounds are chords of the convex blocks
instead of tangents.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from coord.conflicts.blocks import Blocks, corner_nodes, slices
from coord.conflicts.discs import stadium_extent
from coord.conflicts.region import ConflictRegion, cell_nodes
from coord.conflicts.rounded import rounded_extent
from coord.model.arrays import Array
from coord.tolerances import SAME_PLACE

#: [m] Distances are lowered by this, so that what rounding makes of a touch is no proof.
_MARGIN = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class _Intervals:
    """Forbidden intervals of cells: the low and high ends (n, 2) [m] at both nodes of the cells (n,)."""

    low: Array
    high: Array
    cell: npt.NDArray[np.intp]

    def of(self, some: npt.NDArray[np.intp]) -> _Intervals:
        """Some of them."""
        return _Intervals(self.low[some], self.high[some], self.cell[some])


def inner_regions(region: ConflictRegion, length: float) -> tuple[ConflictRegion, ...]:
    """Parts of a region in which every (s, sigma) strictly between the bounds is truly forbidden.

    Each part is connected where ego's arc length lies between 0 and its path's ``length`` [m], so that a motion
    passes it on one side. Together they may be less than the truth, never more.
    """
    if region.blocks is None:
        return ()
    blocks = _shrunk(region.blocks)
    if not len(blocks.R):
        return ()
    extent = blocks.sigma
    first, last = float(extent[:, 0].min()), float(extent[:, 1].max())
    every = np.arange(len(blocks.R))
    if last - first <= SAME_PLACE:
        nodes = np.array([first, first])
    else:
        nodes = cell_nodes(np.concatenate([extent.ravel(), corner_nodes(blocks, every)]), first, last, region.cell)
    middle = (nodes[:-1] + nodes[1:]) / 2
    member, cell = np.nonzero((extent[:, :1] <= middle[None]) & (middle[None] <= extent[:, 1:]))
    ends = _clipped(blocks, np.tile(member, 2), nodes[np.concatenate([cell, cell + 1])])
    low, high = (end.reshape(2, -1).T for end in ends)
    found = _inside(_joined(low, high, cell), length)
    return tuple(_part(nodes, found.of(chain)) for chain in _chains(found, length))


def _shrunk(blocks: Blocks) -> Blocks:
    """The blocks with the distance that is truly too close, and their extents along the other's path."""
    R = blocks.R - blocks.slack - _MARGIN
    blocks, R = blocks.of(np.flatnonzero(R > 0)), R[R > 0]
    if len(blocks.core) == 1:
        first, last = stadium_extent(blocks.core - blocks.D, blocks.w, blocks.u, blocks.ds, R)
    else:
        first, last = rounded_extent(-blocks.D, blocks.w, blocks.u * blocks.ds[:, None], R, -blocks.core)
    first = np.maximum(first + blocks.sigma0, blocks.sigma[:, 0])
    last = np.minimum(last + blocks.sigma0, blocks.sigma[:, 1])
    moves = (blocks.w != 0).any(axis=1)
    keep = np.flatnonzero(np.where(moves, last - first > SAME_PLACE, first <= last))
    extent = np.stack([first, last], axis=1)
    return replace(blocks.of(keep), R=R[keep], sigma=extent[keep])


def _clipped(blocks: Blocks, member: npt.NDArray[np.intp], sigma: Array) -> tuple[Array, Array]:
    """The ends (m,) of some blocks' slices at sigma (m,), cut at the ends of ego's chords."""
    low, high, _, _ = slices(blocks, member, sigma)
    low, high = np.maximum(low, blocks.s[member, 0]), np.minimum(high, blocks.s[member, 1])
    return low, np.maximum(low, high)


def _joined(low: Array, high: Array, cell: npt.NDArray[np.intp]) -> _Intervals:
    """Intervals (n, 2) of cells (n,), those of one cell that touch at both nodes made one."""
    order = np.lexsort((low[:, 1], low[:, 0], cell))
    low, high, cell = low[order], high[order], cell[order]
    first, count = _runs(cell)
    begins, top = np.zeros(len(cell), bool), high[first]
    begins[first] = True
    for rank in range(1, int(count.max(initial=0))):
        more = np.flatnonzero(count > rank)
        k = first[more] + rank
        touches = np.asarray((low[k] <= top[more] + SAME_PLACE).all(axis=1))
        begins[k] = ~touches
        top[more] = np.where(touches[:, None], np.maximum(top[more], high[k]), high[k])
    first = np.flatnonzero(begins)
    return _Intervals(np.minimum.reduceat(low, first), np.maximum.reduceat(high, first), cell[first])


def _inside(found: _Intervals, length: float) -> _Intervals:
    """Those that are more than a point of ego's way at either node."""
    width = np.minimum(found.high, length) - np.maximum(found.low, 0.0)
    return found.of(np.flatnonzero(width.max(axis=1) > 0))


def _chains(found: _Intervals, length: float) -> list[npt.NDArray[np.intp]]:
    """One interval a cell, the widest, or the one that goes on from the cell before; cut where none goes on."""
    if not len(found.cell):
        return []
    width = (found.high - found.low).sum(axis=1)
    first, count = _runs(found.cell)
    picked = first.copy()
    for k in np.flatnonzero(count > 1).tolist():
        some = first[k] + np.arange(count[k])
        following = some[_goes_on(found, picked[k - 1], some, length)] if k else some[:0]
        some = following if len(following) else some
        picked[k] = some[np.argmax(width[some])]
    return np.split(picked, np.flatnonzero(~_goes_on(found, picked[:-1], picked[1:], length)) + 1)


def _runs(cell: npt.NDArray[np.intp]) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Where the intervals of each cell begin, and how many they are; the cells are in order."""
    first = np.flatnonzero(np.append(True, np.diff(cell) > 0)[: len(cell)])
    return first, np.diff(np.append(first, len(cell)))


def _goes_on(
    found: _Intervals, before: npt.NDArray[np.intp], after: npt.NDArray[np.intp], length: float
) -> npt.NDArray[np.bool_]:
    """Whether intervals of neighbouring cells have more than a point of ego's way in common at the node between."""
    low = np.maximum(np.maximum(found.low[before, 1], found.low[after, 0]), 0.0)
    high = np.minimum(np.minimum(found.high[before, 1], found.high[after, 0]), length)
    return np.asarray((high > low) & (found.cell[after] == found.cell[before] + 1))


def _part(nodes: Array, chain: _Intervals) -> ConflictRegion:
    return ConflictRegion(nodes[np.append(chain.cell, chain.cell[-1] + 1)], chain.low, chain.high)
