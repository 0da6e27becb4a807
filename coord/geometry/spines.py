"""Two segments inside every part, by which most of what runs through it is found at once.

Whoever crosses a segment inside a core comes too near to it, without any distance being measured.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import shapely

from coord.geometry.shapes import Geometry
from coord.model.arrays import Array

#: Spines reach beyond the core by this share of the distance that is kept from it.
_BEYOND = 0.99


def spines(parts: Geometry, edges: Array, edge_parts: npt.NDArray[np.intp]) -> Array:
    """Two segments (m, 2, 4) [m] inside each of the parts; edges (e, 4) follow each other part by part.

    From the vertex farthest left to that farthest right, and from the lowest to the highest; where a part is bent
    so that this leaves it, its longest edge instead.
    """
    first = np.searchsorted(edge_parts, np.arange(len(parts)))
    last = np.searchsorted(edge_parts, np.arange(len(parts)), side="right") - 1
    square = ((edges[:, 2:] - edges[:, :2]) ** 2).sum(axis=1)
    longest = edges[np.lexsort((square, edge_parts))[last]]
    found = []
    for axis in (0, 1):
        order = np.lexsort((edges[:, axis], edge_parts))
        across = np.hstack([edges[order[first], :2], edges[order[last], :2]])
        inside = shapely.covers(parts, shapely.linestrings(across.reshape(-1, 2, 2))) if len(parts) else first
        found.append(np.where(np.array(inside, dtype=np.bool_)[:, None], across, longest))
    return np.stack(found, axis=1)


def reaching(inside: Array, rho: Array) -> Array:
    """Spines (m, 2, 4) made longer, but not to where the core is rho (m,) [m] away; those of points are crosses."""
    along = inside[..., 2:] - inside[..., :2]
    length = np.hypot(along[..., 0], along[..., 1])[..., None]
    axes = np.eye(2)[None]
    unit = np.where(length > 0, along / np.where(length > 0, length, 1.0), axes)
    more = _BEYOND * rho[:, None, None] * unit
    return np.concatenate([inside[..., :2] - more, inside[..., 2:] + more], axis=-1)


def crossing(first: Array, second: Array) -> npt.NDArray[np.bool_]:
    """Whether segments (..., 4) properly cross others (..., 4), one by one."""
    ax, ay, bx, by = np.moveaxis(first, -1, 0)
    cx, cy, dx, dy = np.moveaxis(second, -1, 0)
    ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
    c, d = ux * (cy - ay) - uy * (cx - ax), ux * (dy - ay) - uy * (dx - ax)
    a, b = vx * (ay - cy) - vy * (ax - cx), vx * (by - cy) - vy * (bx - cx)
    return np.asarray((c * d < 0) & (a * b < 0))
