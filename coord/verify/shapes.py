"""Footprints: a convex polygon (a single point for a disc) grown by a radius, and how two of them lie to each other.

Two bodies K_i at p_i and K_j at p_j are as far apart as the point p_i - p_j is from the polygon K_j - K_i, less
both radii. With h the support function, n.(p_i - p_j) - h(n) never exceeds that distance, for any unit vector n.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

Point = tuple[float, float]
Ring = tuple[Point, ...]

#: What a disc is made of before it is grown by its radius.
CENTRE: Ring = ((0.0, 0.0),)

#: [m] Nearer to a corner than this, the direction from it is noise, and that of an edge serves better.
_CORNER = 1e-12


@dataclass(frozen=True, slots=True)
class Body:
    """A footprint about its reference point.

    Parameters
    ----------
    ring : vertices of the convex core [m], counter-clockwise; one point for a disc.
    radius : [m] by which the core is grown.
    turning : whether the drawn x axis points along the path; else it keeps the way it is drawn.
    reach : [m] radius of the disc about the reference point that holds the footprint.
    """

    ring: Ring
    radius: float
    turning: bool
    reach: float

    @property
    def corner(self) -> float:
        """How far the farthest vertex of the core is from the reference point [m]; 0 if turning changes nothing."""
        return self.reach - self.radius if self.turning else 0.0


def disc(radius: float) -> Body:
    """A round footprint; turning it changes nothing."""
    return Body(CENTRE, radius, False, radius)


def polygon(vertices: Sequence[Point], turning: bool) -> Body:
    """A convex footprint, vertices in either sense."""
    ring = tuple(vertices) if _area(vertices) > 0 else tuple(reversed(vertices))
    return Body(ring, 0.0, turning, max(math.hypot(x, y) for x, y in ring))


def polygon_fault(vertices: Sequence[Point]) -> str:
    """Why vertices are no footprint, or nothing: it must be convex and hold its reference point (0, 0)."""
    if len(vertices) < 3 or _area(vertices) == 0.0:
        return "needs three corners that are not on one line"
    sign = 1.0 if _area(vertices) > 0 else -1.0
    edges = [(b[0] - a[0], b[1] - a[1]) for a, b in _edges(vertices)]
    turns = 0.0
    for (ax, ay), (bx, by) in _edges(edges):
        cross, dot = sign * (ax * by - ay * bx), ax * bx + ay * by
        if cross < 0.0 or (cross == 0.0 and dot <= 0.0):
            return "must be convex"
        turns += math.atan2(cross, dot)
    if turns > 3 * math.pi:
        return "must be convex, its outline once round"
    if any(sign * (a[0] * b[1] - a[1] * b[0]) < 0.0 for a, b in _edges(vertices)):
        return "must contain its reference point (0, 0)"
    return ""


def turned(body: Body, heading: float) -> Ring:
    """The core as it lies on the floor when the path has this heading [rad]."""
    if not body.turning:
        return body.ring
    c, s = math.cos(heading), math.sin(heading)
    return tuple((c * x - s * y, s * x + c * y) for x, y in body.ring)


def inner_point(body: Body, pose: tuple[float, float, float]) -> Point:
    """A point well inside a footprint at a pose [m]; the reference point may lie on its edge."""
    ring = turned(body, pose[2])
    return pose[0] + sum(x for x, _ in ring) / len(ring), pose[1] + sum(y for _, y in ring) / len(ring)


def mirrored(ring: Ring) -> Ring:
    """-K: every point reflected at the origin, still counter-clockwise."""
    return tuple((-x, -y) for x, y in ring)


def minkowski(p: Ring, q: Ring) -> Ring:
    """The sum P (+) Q of two convex rings, counter-clockwise; points and segments are rings of one and two."""
    if len(p) == 1 or len(q) == 1:
        one, many = (p, q) if len(p) == 1 else (q, p)
        if one is CENTRE:
            return many
        return tuple((x + one[0][0], y + one[0][1]) for x, y in many)
    p, q = _from_lowest(p), _from_lowest(q)
    total: list[Point] = []
    i = j = 0
    while i < len(p) or j < len(q):
        a, b = p[i % len(p)], q[j % len(q)]
        total.append((a[0] + b[0], a[1] + b[1]))
        c, d = p[(i + 1) % len(p)], q[(j + 1) % len(q)]
        cross = (c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0])
        if j >= len(q) or (i < len(p) and cross >= 0.0):
            i += 1
            if cross == 0.0 and j < len(q):
                j += 1
        else:
            j += 1
    return tuple(total)


def translated(ring: Ring, offset: Point) -> Ring:
    """The ring moved by an offset [m]."""
    return tuple((x + offset[0], y + offset[1]) for x, y in ring)


def support(ring: Ring, nx: float, ny: float) -> float:
    """How far a ring reaches in the direction n: max n.v over its points."""
    if len(ring) == 1:
        return nx * ring[0][0] + ny * ring[0][1]
    return max(nx * x + ny * y for x, y in ring)


def gap(q: Point, ring: Ring) -> tuple[float, float, float]:
    """Signed distance [m] of a point from a convex ring, negative inside, and the unit vector n towards the point.

    n is the direction in which n.q - h(n) equals that distance.
    """
    if len(ring) == 1:
        return _from_point(q, ring[0])
    deepest, dx, dy = -math.inf, 0.0, 0.0
    nearest, mx, my = math.inf, 0.0, 0.0
    for (ax, ay), (bx, by) in _edges(ring):
        ex, ey, wx, wy = bx - ax, by - ay, q[0] - ax, q[1] - ay
        size = math.hypot(ex, ey)
        if size == 0.0:
            continue
        side, along = (ey * wx - ex * wy) / size, (ex * wx + ey * wy) / size
        if side > deepest:
            deepest, dx, dy = side, ey / size, -ex / size
        if side >= 0.0:
            distance, nx, ny = side, ey / size, -ex / size
            if not 0.0 <= along <= size:
                beyond = _from_point(q, (ax, ay) if along < 0.0 else (bx, by))
                if beyond[0] > _CORNER:
                    distance, nx, ny = beyond
            if distance < nearest:
                nearest, mx, my = distance, nx, ny
    if deepest >= 0.0 and nearest < math.inf:
        return nearest, mx, my
    return deepest, dx, dy


def _from_point(q: Point, origin: Point) -> tuple[float, float, float]:
    wx, wy = q[0] - origin[0], q[1] - origin[1]
    distance = math.hypot(wx, wy)
    return (distance, wx / distance, wy / distance) if distance > 0.0 else (0.0, 1.0, 0.0)


def _edges(ring: Sequence[Point]) -> list[tuple[Point, Point]]:
    return list(zip(ring, (*ring[1:], ring[0]), strict=True))


def _area(ring: Sequence[Point]) -> float:
    return math.fsum(a[0] * b[1] - a[1] * b[0] for a, b in _edges(ring)) / 2


def _from_lowest(ring: Ring) -> Ring:
    """The ring begun at its lowest vertex (the leftmost of them): there the edges begin to point right or up."""
    k = min(range(len(ring)), key=lambda i: (ring[i][1], ring[i][0]))
    return ring[k:] + ring[:k]
