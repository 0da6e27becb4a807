"""Where two robots are too close: the collision region in the coordination plane.

For the arc lengths s of one robot (ego) and sigma of the other, the region holds all (s, sigma) at which
their footprints come closer than the clearance (O'Donnell & Lozano-Perez 1989). It does not depend on
velocities, so it is computed once. Both paths are chains of chords; where both robots are on one chord each,
the region is the part of an ellipse (or of a strip) inside a rectangle, a convex *block* in closed form:
|D + u s - w sigma| < R.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.conflicts.chords import Chords
from coord.model.arrays import Array, frozen
from coord.tolerances import REGION_CELL, REGION_MARGIN, SAME_PLACE

#: Further nodes towards the ends of a region, as shares of a cell: its boundary is steep there.
_END_NODES = (0.0625, 0.25)

#: [m] How far a region goes beyond ego's start or goal where it reaches them.
_BEYOND = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class ConflictRegion:
    """One connected part of the collision region of ego and another robot, as outer bounds.

    Parameters
    ----------
    sigma : (n+1,) array [m], nodes along the other's path, increasing.
    low : (n, 2) array [m], for each cell the values at its two nodes of a line below every forbidden s.
    high : (n, 2) array [m], likewise above. Forbidden is the open interval between the two lines.
    """

    sigma: Array
    low: Array
    high: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "sigma", frozen(self.sigma))
        object.__setattr__(self, "low", frozen(self.low, 2))
        object.__setattr__(self, "high", frozen(self.high, 2))

    @property
    def s_range(self) -> tuple[float, float]:
        """Least and largest forbidden arc length of ego [m]."""
        return float(self.low.min()), float(self.high.max())


@dataclass(frozen=True, slots=True, eq=False)
class _Blocks:
    """Convex blocks, one a pair of near chords: |D + u (s - s0) - w (sigma - sigma0)| < R, s and sigma in a box."""

    chords: npt.NDArray[np.intp]  # (n, 2) indices of ego's and the other's chord
    D: Array
    u: Array
    w: Array
    R: Array
    s0: Array
    s: Array  # (n, 2) the arc lengths of ego's chord
    sigma0: Array
    sigma: Array  # (n, 2) the arc lengths of the other's chord, cut down to the block's extent


def conflict_regions(
    ego: Chords, other: Chords, distance: float, *, start_free: bool = False, goal_free: bool = False
) -> tuple[ConflictRegion, ...]:
    """The connected parts of the region in which the reference points are closer than ``distance`` [m].

    The bounds are outer ones: every (s, sigma) of the true region lies strictly between them. Where it
    reaches ego's start or goal, they go beyond 0 or the length, so that resting there is forbidden too.

    Parameters
    ----------
    start_free, goal_free : an exact test has shown that ego at its start (goal) is never too close to any
        place of the other's path; the bounds then stop at 0 (at the length), without any padding.
    """
    blocks = _near_blocks(ego, other, distance + REGION_MARGIN, start_free, goal_free)
    if not len(blocks.R):
        return ()
    return tuple(_region(blocks, members) for members in _components(blocks))


def _near_blocks(ego: Chords, other: Chords, distance: float, start_free: bool, goal_free: bool) -> _Blocks:
    """All pairs of chords that come closer than the distance, with the extent of the other's arc length."""
    i, k = _box_pairs(ego, other, distance)
    ds, dsigma = np.diff(ego.s)[i], np.diff(other.s)[k]
    p, q = ego.points[i], other.points[k]
    # velocity of the point per metre of arc length; 0 for a robot that never moves
    u = np.divide(ego.points[i + 1] - p, ds[:, None], out=np.zeros_like(p), where=ds[:, None] > 0)
    w = np.divide(other.points[k + 1] - q, dsigma[:, None], out=np.zeros_like(q), where=dsigma[:, None] > 0)
    R = distance + ego.errors[i] + other.errors[k]
    first, last = _stadium_extent(q - p, w, u, ds, R)
    first, last = np.maximum(first, 0.0), np.minimum(last, dsigma)
    # a resting robot has one row, all others need an extent
    keep = (last - first > SAME_PLACE) | ((dsigma == 0) & (first <= last))
    i, k, first, last = i[keep], k[keep], first[keep], last[keep]
    sigma0 = other.s[k]
    low, high = ego.s[:-1].copy(), ego.s[1:].copy()
    low[0] -= 0.0 if start_free else _BEYOND
    high[-1] += 0.0 if goal_free else _BEYOND
    return _Blocks(
        np.stack([i, k], axis=1),
        (p - q)[keep],
        u[keep],
        w[keep],
        R[keep],
        ego.s[i],
        np.stack([low[i], high[i]], axis=1),
        sigma0,
        np.stack([sigma0 + first, sigma0 + last], axis=1),
    )


def _box_pairs(ego: Chords, other: Chords, distance: float) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Pairs of chords whose bounding boxes come closer than the distance (errors of chords included)."""
    reach = distance + float(ego.errors.max()) + float(other.errors.max())
    low_i, high_i = np.minimum(ego.points[:-1], ego.points[1:]), np.maximum(ego.points[:-1], ego.points[1:])
    low_k, high_k = np.minimum(other.points[:-1], other.points[1:]), np.maximum(other.points[:-1], other.points[1:])
    near = np.all(low_i[:, None] - reach < high_k[None], axis=2) & np.all(low_k[None] < high_i[:, None] + reach, axis=2)
    i, k = np.nonzero(near)
    return i, k


def _stadium_extent(E: Array, w: Array, u: Array, length: Array, R: Array) -> tuple[Array, Array]:
    """Where the line E + w x is nearer than R to the segment from 0 to u length: first, last x (first > last: never).

    The stadium is convex, so the extent is the hull of the extents in its two discs and its rectangle.
    """
    first, last = np.full(len(R), np.inf), np.full(len(R), -np.inf)

    def widen(low: Array, high: Array, valid: npt.NDArray[np.bool_]) -> None:
        np.minimum(first, low, out=first, where=valid)
        np.maximum(last, high, out=last, where=valid)

    for end in (np.zeros_like(length), length):
        low, high, valid = _disc_extent(E - u * end[:, None], w, R)
        widen(low, high, valid)
    low, high, valid = _rectangle_extent(E, w, u, length, R)
    widen(low, high, valid)
    return first, last


def _disc_extent(E: Array, w: Array, R: Array) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Where |E + w x| < R; for w = 0 everywhere or nowhere."""
    a, b, c = (w * w).sum(axis=1), (E * w).sum(axis=1), (E * E).sum(axis=1) - R * R
    moving = a > 0
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    safe = np.where(moving, a, 1.0)
    low = np.where(moving, (-b - root) / safe, -np.inf)
    high = np.where(moving, (-b + root) / safe, np.inf)
    return low, high, np.where(moving, b * b > a * c, c < 0)


def _rectangle_extent(
    E: Array, w: Array, u: Array, length: Array, R: Array
) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Where E + w x lies beside the segment, closer than R to it, between its two ends."""
    norm = np.sqrt((u * u).sum(axis=1))
    unit = np.divide(u, norm[:, None], out=np.zeros_like(u), where=norm[:, None] > 0)
    along0, along1 = (E * unit).sum(axis=1), (w * unit).sum(axis=1)
    across0, across1 = _cross(unit, E), _cross(unit, w)
    low1, high1 = _linear_extent(along0, along1, np.zeros_like(R), norm * length)
    low2, high2 = _linear_extent(across0, across1, -R, R)
    low, high = np.maximum(low1, low2), np.minimum(high1, high2)
    return low, high, (low < high) & (norm > 0)


def _linear_extent(c0: Array, c1: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Where low < c0 + c1 x < high."""
    safe = np.where(c1 != 0, c1, 1.0)
    x0, x1 = (low - c0) / safe, (high - c0) / safe
    inside = (low < c0) & (c0 < high)
    first = np.where(c1 != 0, np.minimum(x0, x1), np.where(inside, -np.inf, np.inf))
    last = np.where(c1 != 0, np.maximum(x0, x1), np.where(inside, np.inf, -np.inf))
    return first, last


def _components(blocks: _Blocks) -> list[npt.NDArray[np.intp]]:
    """Blocks grouped by touching bounding boxes: coarser than truly connected, which is on the safe side."""
    n = len(blocks.R)
    if n == 1:
        return [np.array([0])]
    a, b = _touching(blocks)
    group = np.arange(n)
    while True:  # labels flow to the smallest of a group, in ever larger strides
        least = group.copy()
        np.minimum.at(least, a, group[b])
        np.minimum.at(least, b, group[a])
        least = least[least]
        if np.array_equal(least, group):
            break
        group = least
    return [np.flatnonzero(group == label) for label in np.unique(group)]


def _touching(blocks: _Blocks) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
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


def _region(blocks: _Blocks, members: npt.NDArray[np.intp]) -> ConflictRegion:
    """Outer lines for every cell between nodes: grid points, ends of blocks, and some more near the ends."""
    extent = blocks.sigma[members]
    first, last = float(extent[:, 0].min()), float(extent[:, 1].max())
    if last - first <= SAME_PLACE:  # the other never moves: one row
        low, high = _slice(blocks, members, np.full(len(members), first))
        return ConflictRegion(frozen([first, first]), frozen([[low.min()] * 2]), frozen([[high.max()] * 2]))
    nodes = _nodes(extent, first, last)
    member, cell = np.nonzero(
        (extent[:, :1] <= (nodes[:-1] + nodes[1:])[None] / 2) & ((nodes[:-1] + nodes[1:])[None] / 2 <= extent[:, 1:])
    )
    low, high = _lines(blocks, members[member], nodes[cell], nodes[cell + 1])
    count = len(nodes) - 1
    lows, highs = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(lows, cell, low)
    np.maximum.at(highs, cell, high)
    return ConflictRegion(frozen(nodes), frozen(lows), frozen(highs))


def _nodes(extent: Array, first: float, last: float) -> Array:
    cell = min(REGION_CELL, (last - first) / 8)
    ends = [x + sign * share * cell for x, sign in ((first, 1), (last, -1)) for share in _END_NODES]
    count = max(1, int(np.ceil((last - first) / cell)))
    nodes = np.unique(np.concatenate([np.linspace(first, last, count + 1), ends, extent.ravel()]))
    nodes = np.asarray(nodes[np.concatenate([[True], np.diff(nodes) > SAME_PLACE])])
    nodes[-1] = last
    return nodes


def _lines(blocks: _Blocks, member: npt.NDArray[np.intp], start: Array, end: Array) -> tuple[Array, Array]:
    """Values (m, 2) at both ends of cells of lines below and above the blocks' slices there.

    A slice's lower end is a convex function of sigma, so its tangent at the middle lies below it; where the
    tangent is so steep that a constant is better, the constant is taken. The upper end is the mirror image.
    """
    middle = (start + end) / 2
    mid, half, mid_slope, half_slope = _ellipse(blocks, member, middle)
    width = (end - start)[:, None] * np.array([-0.5, 0.5])
    box = blocks.s[member]
    low = np.maximum((mid - half)[:, None] + (mid_slope - half_slope)[:, None] * width, box[:, :1])
    high = np.minimum((mid + half)[:, None] + (mid_slope + half_slope)[:, None] * width, box[:, 1:])
    # a line cut off at the box's edge inside the cell is no line any more: the edge itself is the bound
    cut_low = (low == box[:, :1]).any(axis=1)
    cut_high = (high == box[:, 1:]).any(axis=1)
    low = np.where(cut_low[:, None], box[:, :1], low)
    high = np.where(cut_high[:, None], box[:, 1:], high)
    return low, high


def _slice(blocks: _Blocks, member: npt.NDArray[np.intp], sigma: Array) -> tuple[Array, Array]:
    """Forbidden s (m,), (m,) of blocks at sigma (m,)."""
    mid, half, _, _ = _ellipse(blocks, member, sigma)
    return np.maximum(mid - half, blocks.s[member, 0]), np.minimum(mid + half, blocks.s[member, 1])


def _ellipse(blocks: _Blocks, member: npt.NDArray[np.intp], sigma: Array) -> tuple[Array, Array, Array, Array]:
    """Middle and half width of the slice of |D + u s - w sigma| < R at sigma, and their slopes."""
    u, w, R = blocks.u[member], blocks.w[member], blocks.R[member]
    q = blocks.D[member] - w * (sigma - blocks.sigma0[member])[:, None]
    uu = (u * u).sum(axis=1)
    still = uu == 0  # ego never moves
    safe = np.where(still, 1.0, uu)
    across = _cross(u, q)
    root = np.sqrt(np.maximum(uu * R * R - across * across, 0.0))
    mid, half = blocks.s0[member] - (u * q).sum(axis=1) / safe, root / safe
    mid_slope = (u * w).sum(axis=1) / safe
    steep = np.where(root > 0, root, np.inf)
    half_slope = across * _cross(u, w) / (steep * safe)
    return mid, np.where(still, _BEYOND, half), mid_slope, half_slope


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
