"""Where a line is nearer than R to a convex polygon: closed forms for the conflicts of polygons.

All that is nearer than R to a polygon is a rounded polygon, bounded by arcs of radius R round its corners and by
its edges moved out by R. A line enters and leaves it through these, so the outermost of its crossings with them
is where it does.
"""

from __future__ import annotations

import numpy as np

from coord.conflicts.core import swept
from coord.conflicts.discs import cross
from coord.model.arrays import Array

#: [m] Between two bends an arc of a rounded polygon departs from the tangent at its middle by about this much;
#: longer arcs, which many cells cut anyway, get no more than so many bends.
_ARC = 1e-3
_MOST_PARTS = 8

#: [1] Sine of the angle between two ways below which they count as parallel.
_PARALLEL = 1e-9


def rounded_slice(
    q: Array, u: Array, w: Array, R: Array, core: Array, still: float
) -> tuple[Array, Array, Array, Array]:
    """Where q + u s - w x is nearer than R to the core at x = 0: least and largest s (m,), their slopes over x (m,).

    The slopes are those of the supporting lines there: straight bounds of the whole region of (s, x), which is convex.

    Parameters
    ----------
    q, u, w : (m, 2) [m], [1], [1]; R : (m,) [m]; core : (n, 2) [m], convex, counter-clockwise.
    still : half the width [m] of the slice where u = 0, which then holds every s.
    """
    is_still = (u * u).sum(axis=1) == 0
    direction = np.where(is_still[:, None], [1.0, 0.0], u)
    ends = []
    for end, normal in zip(*_crossings(q, direction, core[None], R), strict=True):
        facing = (normal * direction).sum(axis=1)
        slope = np.where(facing != 0, (normal * w).sum(axis=1), (direction * w).sum(axis=1))
        slope /= np.where(facing != 0, facing, (direction * direction).sum(axis=1))
        ends.append((end, np.where(is_still, 0.0, slope)))
    (low, low_slope), (high, high_slope) = ends
    return np.where(is_still, -still, low), np.where(is_still, still, high), low_slope, high_slope


def rounded_extent(E: Array, w: Array, way: Array, R: Array, core: Array) -> tuple[Array, Array]:
    """Where the line E + w x is nearer than R to what the core sweeps on a straight way: first, last x (m,).

    Where it never is, first >= last; where w = 0, the extent is everything or nothing.

    Parameters
    ----------
    E, w, way : (m, 2) [m], [1], [m]; R : (m,) [m]; core : (n, 2) [m], convex, counter-clockwise.
    """
    is_still = (w * w).sum(axis=1) == 0
    direction = np.where(is_still[:, None], [1.0, 0.0], w)
    (first, last), _ = _crossings(E, direction, swept(core, way), R)
    inside = (first < 0) & (last > 0)
    first = np.where(is_still, np.where(inside, -np.inf, np.inf), first)
    return first, np.where(is_still, -first, last)


def bends(D: Array, u: Array, w: Array, R: Array, core: Array) -> tuple[Array, Array]:
    """Where the outline of {(s, x): D + u s - w x nearer than R to the core} changes: s, x (m, k) [m].

    The ends of its straight parts, and places between them where it bends; NaN where u and w are parallel and all
    of it is straight.
    """
    facing = outward_normals(core[None])[0][0]
    parts = [core, core]
    normals = [np.roll(facing, 1, axis=0), facing]
    turn = np.arctan2(cross(normals[0], facing), (normals[0] * facing).sum(axis=1))
    count = np.minimum(np.ceil(turn / np.sqrt(8 * _ARC / max(float(R.max()), _ARC))), _MOST_PARTS)
    for k in range(1, int(count.max())):
        angle = np.arctan2(normals[0][:, 1], normals[0][:, 0]) + turn * k / count
        parts.append(core[count > k])
        normals.append(np.stack([np.cos(angle), np.sin(angle)], axis=1)[count > k])
    z = np.concatenate(parts) + R[:, None, None] * np.concatenate(normals) - D[:, None]
    area = cross(u, w)[:, None]
    safe = np.where(np.abs(area) > _PARALLEL, area, np.nan)
    return cross(z, w[:, None]) / safe, cross(z, u[:, None]) / safe


def _crossings(q: Array, u: Array, corners: Array, R: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Least and largest x (m,) of lines q + u x in rounded polygons, and outward normals (m, 2) there, of any length.

    ``corners`` : (m or 1, n, 2), counter-clockwise; vertices may occur twice. A line that misses the polygon has both
    ends where it is nearest to some corner.
    """
    normal, length = outward_normals(corners)
    # component by component: sums over a last axis of two take several times as long
    (nx, ny), (ux, uy) = np.moveaxis(normal, -1, 0), u.T[:, :, None]
    gx, gy = q[:, :1] - corners[..., 0], q[:, 1:] - corners[..., 1]
    uu, across = ux * ux + uy * uy, ux * gy - uy * gx
    middle = -(ux * gx + uy * gy) / uu
    square = uu * (R * R)[:, None] - across * across
    half = np.sqrt(np.maximum(square, 0.0)) / uu
    toward = nx * ux + ny * uy
    at = (R[:, None] - (nx * gx + ny * gy)) / np.where(toward != 0, toward, 1.0)
    along = nx * (gy + uy * at) - ny * (gx + ux * at)
    on_edge = (along >= 0) & (along <= length) & (toward != 0)
    touched = square > 0
    missed = ~(touched | on_edge).any(axis=1, keepdims=True)
    touched |= missed & (square == square.max(axis=1, keepdims=True))
    ends, normals = [], []
    rows = np.arange(len(q))
    one = np.minimum(rows, len(normal) - 1)
    for side in (-1.0, 1.0):
        on_arcs = np.where(touched, side * middle + half, -np.inf)
        on_edges = np.where(on_edge & (side * toward > 0), side * at, -np.inf)
        arc, edge = np.argmax(on_arcs, axis=1), np.argmax(on_edges, axis=1)
        from_arc, from_edge = on_arcs[rows, arc], on_edges[rows, edge]
        end = side * np.maximum(from_arc, from_edge)
        outward = np.stack([gx[rows, arc], gy[rows, arc]], axis=1) + u * end[:, None]
        ends.append(end)
        normals.append(np.where((from_arc >= from_edge)[:, None], outward, normal[one, edge]))
    return (ends[0], ends[1]), (normals[0], normals[1])


def outward_normals(corners: Array) -> tuple[Array, Array]:
    """Outward normals (..., n, 2) and lengths (..., n) of the edges from corner to corner; zeros where two are one."""
    edge = np.roll(corners, -1, axis=-2) - corners
    length = np.hypot(edge[..., 0], edge[..., 1])
    safe = np.where(length > 0, length, 1.0)[..., None]
    return np.stack([edge[..., 1], -edge[..., 0]], axis=-1) / safe, length
