"""Pairs of chords that two robots can be too near on: convex blocks of the coordination plane, in closed form.

With ego at D + u s and the other at w sigma, a block is {(s, sigma) : D + u s - w sigma is nearer than R to the
conflict core}, inside a rectangle: part of an ellipse, a strip, or their polygonal kin. D, u and w may be any
vectors, the core any convex polygon.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from coord.conflicts.apart import on_segments
from coord.conflicts.chords import Chords
from coord.conflicts.core import Core, swept
from coord.conflicts.discs import ellipse_slice, stadium_extent
from coord.conflicts.rounded import bends, rounded_extent, rounded_slice
from coord.geometry.index import connected
from coord.model.arrays import Array
from coord.tolerances import DISTANCE, REGION_MARGIN, SAME_PLACE

#: [m] How far a region goes beyond ego's start or goal where it reaches them.
BEYOND: Final = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Blocks:
    """Convex blocks, one a pair of near chords: D + u (s - s0) - w (sigma - sigma0) nearer than R to the core."""

    chords: npt.NDArray[np.intp]  # (n, 2) indices of ego's and the other's chord
    D: Array
    u: Array
    w: Array
    R: Array
    s0: Array
    s: Array  # (n, 2) the arc lengths of ego's chord
    sigma0: Array
    sigma: Array  # (n, 2) the arc lengths of the other's chord, cut down to the block's extent
    core: Array  # (k, 2) of all blocks
    slack: Array  # by how much R may exceed what is truly forbidden
    ds: Array  # lengths of ego's chords

    def of(self, members: npt.NDArray[np.intp]) -> Blocks:
        """Some of the blocks."""
        return Blocks(
            self.chords[members],
            self.D[members],
            self.u[members],
            self.w[members],
            self.R[members],
            self.s0[members],
            self.s[members],
            self.sigma0[members],
            self.sigma[members],
            self.core,
            self.slack[members],
            self.ds[members],
        )


def near_blocks(
    ego: Chords, other: Chords, distance: float, core: Core, *, start_free: bool, goal_free: bool
) -> Blocks:
    """All pairs of chords that come closer than the distance and a margin, with the extent of the other's arc length.

    Straight chords of polygons that keep the distance to the tolerance of distances are left out: squares side by
    side in lanes just wide enough are common, and the margin would have each let the other pass all the way.
    """
    corners, outer = np.array(core), distance + REGION_MARGIN
    i, k = _box_pairs(ego, other, outer, corners)
    ds, dsigma = np.diff(ego.s)[i], np.diff(other.s)[k]
    p, q = ego.points[i], other.points[k]
    # velocity of the point per metre of arc length; 0 for a robot that never moves
    u = np.divide(ego.points[i + 1] - p, ds[:, None], out=np.zeros_like(p), where=ds[:, None] > 0)
    w = np.divide(other.points[k + 1] - q, dsigma[:, None], out=np.zeros_like(q), where=dsigma[:, None] > 0)
    R = outer + ego.errors[i] + other.errors[k]
    if len(core) == 1:
        first, last = stadium_extent(q - p + corners, w, u, ds, R)
    else:
        first, last = rounded_extent(q - p, w, u * ds[:, None], R, -corners)
    first, last = np.maximum(first, 0.0), np.minimum(last, dsigma)
    # a resting robot has one row, all others need an extent
    keep = (last - first > SAME_PLACE) | ((dsigma == 0) & (first <= last))
    if len(core) > 1:
        straight = (ego.errors[i] == 0) & (other.errors[k] == 0)
        for row in np.flatnonzero(keep & straight).tolist():
            ends = q[row] - p[row] + w[row] * [[0.0], [dsigma[row]]]
            keep[row] = _apart(ends, u[row] * ds[row], corners) < distance - DISTANCE / 2
    i, k, first, last = i[keep], k[keep], first[keep], last[keep]
    sigma0 = other.s[k]
    low, high = ego.s[:-1].copy(), ego.s[1:].copy()
    low[0] -= 0.0 if start_free else BEYOND
    high[-1] += 0.0 if goal_free else BEYOND
    return Blocks(
        np.stack([i, k], axis=1),
        (p - q)[keep],
        u[keep],
        w[keep],
        R[keep],
        ego.s[i],
        np.stack([low[i], high[i]], axis=1),
        sigma0,
        np.stack([sigma0 + first, sigma0 + last], axis=1),
        corners,
        (2 * (ego.errors[i] + other.errors[k])) + REGION_MARGIN,
        ds[keep],
    )


def _apart(ends: Array, way: Array, core: Array) -> float:
    """Signed distance [m] between the segment from ends[0] to ends[1] (2, 2) and what -core sweeps on a way (2,)."""
    outline = swept(-core, way[None])[0]
    outline = outline[(outline != np.roll(outline, 1, axis=0)).any(axis=1)]
    return float(on_segments(ends[:1], ends[1:], outline)[0][0])


def slices(blocks: Blocks, member: npt.NDArray[np.intp], sigma: Array) -> tuple[Array, Array, Array, Array]:
    """Least and largest s (m,) of some blocks at sigma (m,), as if chords had no ends, and their slopes over sigma."""
    u, w, R, s0 = blocks.u[member], blocks.w[member], blocks.R[member], blocks.s0[member]
    q = blocks.D[member] - w * (sigma - blocks.sigma0[member])[:, None]
    if len(blocks.core) == 1:
        return ellipse_slice(q - blocks.core, u, w, R, s0, BEYOND)
    low, high, low_slope, high_slope = rounded_slice(q, u, w, R, blocks.core, BEYOND)
    return s0 + low, s0 + high, low_slope, high_slope


def corner_nodes(blocks: Blocks, member: npt.NDArray[np.intp]) -> Array:
    """The sigma (m,) at which the outlines of some blocks change from straight to bent; none for discs."""
    if len(blocks.core) == 1:
        return np.empty(0)
    u, w, R = blocks.u[member], blocks.w[member], blocks.R[member]
    s, sigma = bends(blocks.D[member], u, w, R, blocks.core)
    s, sigma = s + blocks.s0[member, None], sigma + blocks.sigma0[member, None]
    box, extent = blocks.s[member], blocks.sigma[member]
    inside = (box[:, :1] <= s) & (s <= box[:, 1:]) & (extent[:, :1] < sigma) & (sigma < extent[:, 1:])
    return np.asarray(sigma[inside])


def _box_pairs(
    ego: Chords, other: Chords, distance: float, core: Array
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Pairs of chords whose bounding boxes come closer than the distance to the core's (errors of chords included)."""
    reach = distance + float(ego.errors.max()) + float(other.errors.max())
    low_i, high_i = np.minimum(ego.points[:-1], ego.points[1:]), np.maximum(ego.points[:-1], ego.points[1:])
    low_k, high_k = np.minimum(other.points[:-1], other.points[1:]), np.maximum(other.points[:-1], other.points[1:])
    ahead, behind = reach + core.max(axis=0), reach - core.min(axis=0)
    near = np.all(low_i[:, None] - ahead < high_k[None], axis=2) & np.all(
        low_k[None] < high_i[:, None] + behind, axis=2
    )
    i, k = np.nonzero(near)
    return i, k


def components(blocks: Blocks) -> list[npt.NDArray[np.intp]]:
    """Blocks grouped by touching bounding boxes: coarser than truly connected, which is on the safe side."""
    n = len(blocks.R)
    if n == 1:
        return [np.array([0])]
    a, b = _touching(blocks)
    group = connected(n, a, b)
    return [np.flatnonzero(group == label) for label in np.unique(group)]


def _touching(blocks: Blocks) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Pairs of blocks of neighbouring chords whose boxes touch; others cannot."""
    row, column = blocks.chords.T
    width = int(column.max()) + 3
    key = row * width + column + 1
    order = np.argsort(key, kind="stable")
    found_a, found_b = [], []
    for step in (1, width - 1, width, width + 1):
        place = np.minimum(np.searchsorted(key[order], key + step), len(key) - 1)
        b = order[place]
        a = np.flatnonzero(key[b] == key + step)
        found_a.append(a)
        found_b.append(b[a])
    a, b = np.concatenate(found_a), np.concatenate(found_b)
    slack = SAME_PLACE * 10
    touch = (
        (blocks.s[a, 0] <= blocks.s[b, 1] + slack)
        & (blocks.s[b, 0] <= blocks.s[a, 1] + slack)
        & (blocks.sigma[a, 0] <= blocks.sigma[b, 1] + slack)
        & (blocks.sigma[b, 0] <= blocks.sigma[a, 1] + slack)
    )
    return a[touch], b[touch]
