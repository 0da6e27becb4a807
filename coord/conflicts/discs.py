"""Where a line is nearer than R to a point, or to a segment: closed forms for the conflicts of discs."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array


def ellipse_slice(q: Array, u: Array, w: Array, R: Array, s0: Array, still: float) -> tuple[Array, Array, Array, Array]:
    """Where |q + u (s - s0) - w x| < R at x = 0: least and largest s (m,), and their slopes over x (m,).

    Parameters
    ----------
    q, u, w : (m, 2) [m], [1], [1]; R, s0 : (m,) [m].
    still : half the width [m] of the slice where u = 0, which then holds every s.
    """
    uu = (u * u).sum(axis=1)
    is_still = uu == 0
    safe = np.where(is_still, 1.0, uu)
    across = cross(u, q)
    root = np.sqrt(np.maximum(uu * R * R - across * across, 0.0))
    mid, half = s0 - (u * q).sum(axis=1) / safe, np.where(is_still, still, root / safe)
    mid_slope = (u * w).sum(axis=1) / safe
    steep = np.where(root > 0, root, np.inf)
    half_slope = across * cross(u, w) / (steep * safe)
    return mid - half, mid + half, mid_slope - half_slope, mid_slope + half_slope


def stadium_extent(E: Array, w: Array, u: Array, length: Array, R: Array) -> tuple[Array, Array]:
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


def cross(a: Array, b: Array) -> Array:
    """The z component of the cross products of vectors (..., 2)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


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
    across0, across1 = cross(unit, E), cross(unit, w)
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
