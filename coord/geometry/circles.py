"""Which stretches of circles come too near to segments: where paths cannot turn round a corner."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array

#: [m] Contact is no hit: a turn touches the edges it leaves.
_TOUCH = 1e-9

#: [1] A cosine above 1 by less than this is a contact.
_GRAZE = 1e-9

#: [rad] Blocked stretches of a circle shorter than this come from rounding at a contact.
_SLIVER = 1e-7

_TURN = 2 * np.pi

Box = tuple[float, float, float, float]
Index = npt.NDArray[np.intp]


def blocked_angles(center: Array, radius: float, edges: Array, rho: Array, box: Box) -> Array:
    """Open stretches (k, 2) [rad] of a circle that come nearer than rho (e,) to segments (e, 4) or leave the box.

    As ``blocked_on_circles``, for one circle.
    """
    reach = rho + radius
    gap = np.abs(edges[:, :2] + edges[:, 2:] - 2 * center)
    near = (gap < np.abs(edges[:, :2] - edges[:, 2:]) + 2 * reach[:, None]).all(axis=1)
    circle = np.zeros(int(near.sum()), dtype=np.intp)
    _, begin, end = blocked_on_circles(center[None], np.array([radius]), circle, edges[near], rho[near], box)
    return np.stack([begin, end], axis=1)


def blocked_on_circles(
    centers: Array, radius: Array, circle: Index, edges: Array, rho: Array, box: Box
) -> tuple[Index, Array, Array]:
    """Open stretches of circles that come too near to segments or leave the box.

    Exact: a circle meets the boundary of a segment grown by rho (two half circles and two lines) at angles in
    closed form; between two of those angles it is wholly inside or wholly outside, which its middle tells.

    Parameters
    ----------
    centers, radius : (k, 2), (k,) [m] of the circles.
    circle, edges, rho : (e,), (e, 4), (e,): to which circle each segment belongs, ascending, its ends, and the
        distance to keep from it [m].

    Returns
    -------
    For each stretch its circle, and where it begins, in [0, 2 pi), and ends, perhaps beyond 2 pi; ascending.
    """
    everyone = np.arange(len(radius))
    angles = [_segment_angles(centers[circle], radius[circle], edges, rho), _box_angles(centers, radius, box)]
    owner = np.concatenate([np.tile(circle, 8), np.tile(everyone, 8)])
    cuts = np.concatenate(angles)
    met = np.isfinite(cuts)
    # a circle that meets nothing is cut anywhere, once
    alone = np.flatnonzero(np.bincount(owner[met], minlength=len(radius)) == 0)
    owner, cuts = np.append(owner[met], alone), np.append(cuts[met] % _TURN, np.zeros(len(alone)))
    order = np.lexsort((cuts, owner))
    owner, cuts = owner[order], cuts[order]
    last = np.diff(owner, append=-1) != 0
    ends = np.where(last, cuts[np.searchsorted(owner, owner)] + _TURN, np.append(cuts[1:], 0.0))
    middle = (cuts + ends) / 2
    at = centers[owner] + radius[owner, None] * np.stack([np.cos(middle), np.sin(middle)], axis=1)
    inside = (_is_near(at, owner, circle, edges, rho) | _outside(at, box)) & (ends - cuts > _SLIVER)
    return _joined(owner[inside], cuts[inside], ends[inside])


def _is_near(points: Array, owner: Index, circle: Index, edges: Array, rho: Array) -> npt.NDArray[np.bool_]:
    """Whether points (p, 2) on circles come too near to any of the segments of their circle."""
    first, last = np.searchsorted(circle, owner), np.searchsorted(circle, owner, side="right")
    count = last - first
    point = np.repeat(np.arange(len(owner)), count)
    segment = np.arange(len(point)) - np.repeat(np.cumsum(count) - count - first, count)
    hit = np.zeros(len(owner), dtype=np.bool_)
    hit[point[_distances(points[point], edges[segment]) < rho[segment] - _TOUCH]] = True
    return hit


def _distances(points: Array, edges: Array) -> Array:
    """Distances (n,) [m] of points (n, 2) from segments (n, 4), one by one."""
    (x, y), (ax, ay, bx, by) = points.T, edges.T
    dx, dy, px, py = bx - ax, by - ay, x - ax, y - ay
    square = dx * dx + dy * dy
    share = np.clip((px * dx + py * dy) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return np.asarray(np.hypot(px - share * dx, py - share * dy))


def _joined(owner: Index, begin: Array, end: Array) -> tuple[Index, Array, Array]:
    """Stretches with those that follow each other on one circle without a gap made one."""
    if not len(owner):
        return owner, begin, end
    gap = (begin[1:] > end[:-1]) | (owner[1:] != owner[:-1])
    first = np.append(True, gap)
    return owner[first], begin[first], end[np.append(gap, True)]


def _segment_angles(centers: Array, radius: Array, edges: Array, rho: Array) -> Array:
    """Angles (8 n,) at which circles meet the discs about the ends of segments and the lines beside them."""
    (x, y), (ax, ay, bx, by) = centers.T, edges.T
    found: list[Array] = []
    with np.errstate(divide="ignore", invalid="ignore"):
        for gap_x, gap_y in ((ax - x, ay - y), (bx - x, by - y)):
            square = gap_x * gap_x + gap_y * gap_y
            opening = _arccos((square + radius**2 - rho**2) / (2 * np.sqrt(square) * radius))
            toward = np.arctan2(gap_y, gap_x)
            found += [toward - opening, toward + opening]
        dx, dy = bx - ax, by - ay
        length = np.hypot(dx, dy)
        normal_x, normal_y = -dy / length, dx / length
        offset = (x - ax) * normal_x + (y - ay) * normal_y
        toward = np.arctan2(normal_y, normal_x)
        for line in (rho - offset, -rho - offset):
            opening = _arccos(line / radius)
            found += [toward - opening, toward + opening]
    return np.concatenate(found)


def _arccos(cosine: Array) -> Array:
    """Arc cosine; at contact rounding may leave the cosine a hair above 1, and the contact must not be lost."""
    return np.asarray(np.arccos(np.where(np.abs(cosine) < 1 + _GRAZE, np.clip(cosine, -1.0, 1.0), np.nan)))


def _box_angles(centers: Array, radius: Array, box: Box) -> Array:
    """Angles (8 n,) at which circles meet the walls of the box, not a number where they do not."""
    (x, y), (xmin, ymin, xmax, ymax) = centers.T, box
    found: list[Array] = []
    for toward, line in ((0.0, xmax - x), (np.pi / 2, ymax - y), (np.pi, x - xmin), (-np.pi / 2, y - ymin)):
        with np.errstate(divide="ignore", invalid="ignore"):
            opening = np.arccos(np.where(np.abs(line) <= radius, line / radius, np.nan))
        found += [toward - opening, toward + opening]
    return np.concatenate(found)


def _outside(points: Array, box: Box) -> npt.NDArray[np.bool_]:
    xmin, ymin, xmax, ymax = box
    x, y = points.T
    return np.asarray((x < xmin - _TOUCH) | (x > xmax + _TOUCH) | (y < ymin - _TOUCH) | (y > ymax + _TOUCH))
