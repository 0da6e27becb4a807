"""Where two robots are too close: the collision region in the coordination plane.

For the arc lengths s of one robot (ego) and sigma of the other, the region holds all (s, sigma) at which
their footprints come closer than the clearance (O'Donnell & Lozano-Perez 1989). It does not depend on
velocities, so it is computed once. Both paths are chains of chords; where both robots are on one chord each,
the region is a convex block in closed form, see ``coord.conflicts.blocks``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.conflicts.blocks import Blocks, components, corner_nodes, near_blocks, slices
from coord.conflicts.chords import Chords
from coord.conflicts.core import POINT, Core
from coord.model.arrays import Array, frozen
from coord.tolerances import REGION_CELL, SAME_PLACE

#: So many cells at most are made one where no bound is off a straight line by this much [m] from one to the next.
_JOINED, _STRAIGHT = 8, 1e-11

#: Further nodes towards the ends of a region, as shares of a cell: its boundary is steep there.
_END_NODES = (0.0625, 0.25)


@dataclass(frozen=True, slots=True, eq=False)
class ConflictRegion:
    """One connected part of the collision region of ego and another robot, as outer bounds.

    Parameters
    ----------
    sigma : (n+1,) array [m], nodes along the other's path, increasing.
    low : (n, 2) array [m], for each cell the values at its two nodes of a line below every forbidden s.
    high : (n, 2) array [m], likewise above. Forbidden is the open interval between the two lines.
    blocks : what the region consists of, for ``coord.conflicts.inner``; None where that is not known.
    cell : how far nodes are apart at most [m].
    """

    sigma: Array
    low: Array
    high: Array
    blocks: Blocks | None = None
    cell: float = REGION_CELL

    def __post_init__(self) -> None:
        object.__setattr__(self, "sigma", frozen(self.sigma))
        object.__setattr__(self, "low", frozen(self.low, 2))
        object.__setattr__(self, "high", frozen(self.high, 2))

    @property
    def s_range(self) -> tuple[float, float]:
        """Least and largest forbidden arc length of ego [m]."""
        return float(self.low.min()), float(self.high.max())


def conflict_regions(
    ego: Chords,
    other: Chords,
    distance: float,
    core: Core = POINT,
    *,
    start_free: bool = False,
    goal_free: bool = False,
) -> tuple[ConflictRegion, ...]:
    """The connected parts of the region in which ego, seen from the other, is nearer than ``distance`` to the core.

    The bounds are outer ones: every (s, sigma) of the true region lies strictly between them. Where it
    reaches ego's start or goal, they go beyond 0 or the length, so that resting there is forbidden too.

    Parameters
    ----------
    distance : of the reference points [m] for discs; what is kept round the core for polygons, > 0 or 0.
    core : the convex polygon of ``coord.conflicts.core.conflict_core``, a point for two discs.
    start_free, goal_free : an exact test has shown that ego at its start (goal) is never too close to any
        place of the other's path; the bounds then stop at 0 (at the length), without any padding.
    """
    blocks = near_blocks(ego, other, distance, core, start_free=start_free, goal_free=goal_free)
    if not len(blocks.R):
        return ()
    return tuple(_region(blocks, members) for members in components(blocks))


def refined(region: ConflictRegion, share: float) -> ConflictRegion:
    """The same with cells so many times as long and bounds nearer to the truth; itself where its blocks are unknown."""
    if region.blocks is None:
        return region
    return _region(region.blocks, np.arange(len(region.blocks.R)), share * region.cell)


def _region(blocks: Blocks, members: npt.NDArray[np.intp], longest: float = REGION_CELL) -> ConflictRegion:
    """Outer lines for every cell between nodes: grid points, ends of blocks, and some more near the ends."""
    extent = blocks.sigma[members]
    first, last = float(extent[:, 0].min()), float(extent[:, 1].max())
    if last - first <= SAME_PLACE:  # the other never moves: one row
        low, high, _, _ = slices(blocks, members, np.full(len(members), first))
        low, high = np.maximum(low, blocks.s[members, 0]), np.minimum(high, blocks.s[members, 1])
        rows = frozen([first, first]), frozen([[low.min()] * 2]), frozen([[high.max()] * 2])
        return ConflictRegion(*rows, blocks.of(members), longest)
    nodes = cell_nodes(np.concatenate([extent.ravel(), corner_nodes(blocks, members)]), first, last, longest)
    member, cell = np.nonzero(
        (extent[:, :1] <= (nodes[:-1] + nodes[1:])[None] / 2) & ((nodes[:-1] + nodes[1:])[None] / 2 <= extent[:, 1:])
    )
    low, high = _lines(blocks, members[member], nodes[cell], nodes[cell + 1])
    count = len(nodes) - 1
    lows, highs = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(lows, cell, low)
    np.maximum.at(highs, cell, high)
    return ConflictRegion(*_joined(nodes, lows, highs), blocks.of(members), longest)


def _joined(nodes: Array, low: Array, high: Array) -> tuple[Array, Array, Array]:
    """The same with cells made one on which both bounds go on straight, as on lanes, up to so many of them."""
    straight = np.ones(max(len(low) - 1, 0), bool)
    for line in (low, high):
        slope = (line[:, 1] - line[:, 0]) / np.diff(nodes)
        bends = np.abs(np.diff(slope)) * np.maximum(nodes[2:] - nodes[1:-1], nodes[1:-1] - nodes[:-2])
        straight &= (np.abs(line[1:, 0] - line[:-1, 1]) < _STRAIGHT) & (bends < _STRAIGHT)
    breaks = np.flatnonzero(~straight) + 1
    since = np.arange(len(low)) - np.concatenate([[0], breaks])[np.searchsorted(breaks, np.arange(len(low)), "right")]
    first = np.flatnonzero(since % _JOINED == 0)
    last = np.append(first[1:], len(low)) - 1
    ends = [np.stack([line[first, 0], line[last, 1]], axis=1) for line in (low, high)]
    return np.append(nodes[first], nodes[-1]), ends[0], ends[1]


def cell_nodes(given: Array, first: float, last: float, longest: float) -> Array:
    """Where cells begin and end: the given places, a grid, and some more near the ends, where bounds are steep."""
    cell = min(longest, (last - first) / 8)
    ends = [x + sign * share * cell for x, sign in ((first, 1), (last, -1)) for share in _END_NODES]
    count = max(1, int(np.ceil((last - first) / cell)))
    nodes = np.unique(np.concatenate([np.linspace(first, last, count + 1), ends, given]))
    nodes = np.asarray(nodes[np.concatenate([[True], np.diff(nodes) > SAME_PLACE])])
    nodes[-1] = last
    return nodes


def _lines(blocks: Blocks, member: npt.NDArray[np.intp], start: Array, end: Array) -> tuple[Array, Array]:
    """Values (m, 2) at both ends of cells of lines below and above the blocks' slices there.

    A slice's lower end is a convex function of sigma, so its tangent at the middle lies below it; where the
    tangent is so steep that a constant is better, the constant is taken. The upper end is the mirror image.
    """
    low, high, low_slope, high_slope = slices(blocks, member, (start + end) / 2)
    width = (end - start)[:, None] * np.array([-0.5, 0.5])
    box = blocks.s[member]
    low = np.maximum(low[:, None] + low_slope[:, None] * width, box[:, :1])
    high = np.minimum(high[:, None] + high_slope[:, None] * width, box[:, 1:])
    # a line cut off at the box's edge inside the cell is no line any more: the edge itself is the bound
    cut_low = (low == box[:, :1]).any(axis=1)
    cut_high = (high == box[:, 1:]).any(axis=1)
    low = np.where(cut_low[:, None], box[:, :1], low)
    high = np.where(cut_high[:, None], box[:, 1:], high)
    return low, high
