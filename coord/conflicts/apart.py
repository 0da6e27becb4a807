"""How far a convex polygon is from points, segments and arcs; inside it, less than nothing by the depth.

The signed distance is smooth but for kinks where two edges are equally deep. Along a segment or an arc it is
least at an end, at the foot of a corner's perpendicular, where the way runs parallel to an edge, or at a kink:
so the least value at these few places is the least of all.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from coord.conflicts.discs import cross
from coord.conflicts.rounded import outward_normals
from coord.model.arrays import Array


def signed_distance(z: Array, core: Array) -> Array:
    """Distance [m] of points (..., 2) from a polygon (n, 2), n >= 3, counter-clockwise; inside, -depth."""
    normal, length = outward_normals(core)
    gap = z[..., None, :] - core
    height, along = (gap * normal).sum(axis=-1), cross(normal, gap)
    beside = along - np.clip(along, 0.0, length)
    depth = height.max(axis=-1)
    return np.asarray(np.where(depth <= 0, depth, np.hypot(height, beside).min(axis=-1)))


def on_segments(a: Array, b: Array, core: Array) -> tuple[Array, Array]:
    """Least signed distance (m,) [m] of a polygon from segments a to b (m, 2), and the share (m,) where it is."""
    along = b - a
    square = np.maximum((along**2).sum(axis=1, keepdims=True), 1e-300)
    feet = ((core - a[:, None]) * along[:, None]).sum(axis=2) / square
    normal, offset, first, second = _kinks(core)
    between = normal[first] - normal[second]
    rise = (along[:, None] * between).sum(axis=2)
    level = offset[first] - offset[second] - (a[:, None] * between).sum(axis=2)
    kinks = level / np.where(rise != 0, rise, np.inf)
    ends = np.broadcast_to([0.0, 1.0], (len(a), 2))
    share = np.clip(np.concatenate([ends, feet, kinks], axis=1), 0.0, 1.0)
    distance = signed_distance(a[:, None] + along[:, None] * share[..., None], core)
    best, rows = np.argmin(distance, axis=1), np.arange(len(a))
    return distance[rows, best], share[rows, best]


def on_arc(pose: tuple[float, float, float], length: float, curvature: float, core: Array) -> tuple[float, float]:
    """Least signed distance [m] of a polygon from an arc that begins at a pose, and the arc length [m] where it is."""
    x, y, heading = pose
    side, radius = math.copysign(1.0, curvature), 1 / abs(curvature)
    centre = np.array([x - side * radius * math.sin(heading), y + side * radius * math.cos(heading)])
    normal, offset, first, second = _kinks(core)
    toward = np.concatenate([core - centre, -normal])
    feet = np.arctan2(toward[:, 1], toward[:, 0])
    between = normal[first] - normal[second]
    size = radius * np.hypot(between[:, 0], between[:, 1])
    level = (offset[first] - offset[second] - (between * centre).sum(axis=1)) / np.where(size > 0, size, np.inf)
    opening = np.arccos(np.clip(level, -1.0, 1.0))
    middle = np.arctan2(between[:, 1], between[:, 0])
    angles = np.concatenate([feet, middle - opening, middle + opening])
    start, turn = heading - side * math.pi / 2, length / radius
    ahead = (side * (angles - start)) % (2 * math.pi)
    ahead = np.concatenate([[0.0, turn], ahead[ahead < turn]])
    at = start + side * ahead
    distance = signed_distance(centre + radius * np.stack([np.cos(at), np.sin(at)], axis=1), core)
    best = int(np.argmin(distance))
    return float(distance[best]), float(ahead[best]) * radius


def _kinks(core: Array) -> tuple[Array, Array, npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Outward normals (n, 2) and offsets (n,) of the edges, and all pairs of edges as two arrays of indices."""
    normal, _ = outward_normals(core)
    first, second = np.triu_indices(len(core), 1)
    return normal, np.asarray((normal * core).sum(axis=1)), first, second
