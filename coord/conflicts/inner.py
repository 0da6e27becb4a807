"""What is truly forbidden: the inner counterpart of a conflict region's outer bounds.

The outer bounds miss nothing, so whoever keeps out of them is safe; but they prove nothing about what is
impossible. For that every place between the bounds must be too close in truth: where chords stand for arcs, the
distance is lowered by what they may be off, and between two nodes the bounds are chords of the convex blocks
instead of tangents.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from coord.conflicts.blocks import Blocks, corner_nodes, slices
from coord.conflicts.discs import stadium_extent
from coord.conflicts.region import ConflictRegion, cell_nodes
from coord.conflicts.rounded import rounded_extent
from coord.model.arrays import Array, frozen
from coord.tolerances import SAME_PLACE

#: [m] Distances are lowered by this, so that what rounding makes of a touch is no proof.
_MARGIN = 1e-7

#: At both nodes of a cell (2,) the ends [m] of an interval.
_Interval = tuple[Array, Array]


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
        nodes = cell_nodes(np.concatenate([extent.ravel(), corner_nodes(blocks, every)]), first, last)
    middle = (nodes[:-1] + nodes[1:]) / 2
    member, cell = np.nonzero((extent[:, :1] <= middle[None]) & (middle[None] <= extent[:, 1:]))
    ends = [_clipped(blocks, member, nodes[cell + side]) for side in (0, 1)]
    low, high = (np.stack([end[k] for end in ends], axis=1) for k in (0, 1))
    chains = _chains([_joined(low[cell == k], high[cell == k]) for k in range(len(middle))], length)
    return tuple(_part(nodes, chain) for chain in chains)


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


def _joined(low: Array, high: Array) -> list[_Interval]:
    """Intervals (n, 2) of one cell, those that touch at both nodes made one."""
    found: list[_Interval] = []
    for k in np.lexsort((low[:, 1], low[:, 0])).tolist():
        if found and np.all(low[k] <= found[-1][1] + SAME_PLACE):
            found[-1] = (np.minimum(found[-1][0], low[k]), np.maximum(found[-1][1], high[k]))
        else:
            found.append((low[k], high[k]))
    return found


def _chains(cells: list[list[_Interval]], length: float) -> list[list[tuple[int, _Interval]]]:
    """One interval a cell, the widest, or the one that goes on from the cell before; cut where none goes on."""
    chains: list[list[tuple[int, _Interval]]] = []
    for k, intervals in enumerate(cells):
        inside = [(low, high) for low, high in intervals if _overlap(low, high, 0.0, length).max() > 0]
        if not inside:
            continue
        before = chains[-1][-1] if chains and chains[-1][-1][0] == k - 1 else None
        following = [one for one in inside if before is not None and _goes_on(before[1], one, length)]
        widest = max(following or inside, key=lambda one: float((one[1] - one[0]).sum()))
        if following:
            chains[-1].append((k, widest))
        else:
            chains.append([(k, widest)])
    return chains


def _goes_on(before: _Interval, after: _Interval, length: float) -> bool:
    """Whether two intervals of neighbouring cells have more than a point of ego's way in common at the node between."""
    low = max(before[0][1], after[0][0], 0.0)
    return bool(min(before[1][1], after[1][0], length) > low)


def _overlap(low: Array, high: Array, start: float, end: float) -> Array:
    return np.asarray(np.minimum(high, end) - np.maximum(low, start))


def _part(nodes: Array, chain: list[tuple[int, _Interval]]) -> ConflictRegion:
    cells = [k for k, _ in chain]
    at = np.append(nodes[cells], nodes[cells[-1] + 1])
    lows, highs = ([interval[end] for _, interval in chain] for end in (0, 1))
    return ConflictRegion(frozen(at), frozen(lows), frozen(highs))
