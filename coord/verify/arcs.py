"""Exact distances from lines and arcs to points, segments and convex polygons.

Every formula holds for curvature 0 too and loses nothing as the curvature goes to 0: the distance of a point from a
circle through p0 with tangent T, normal N (to the left) and curvature k is, with w = q - p0,
| k |w|^2 - 2 w.N | / (1 + |(k w.T, 1 - k w.N)|), because the centre is p0 + N/k.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from coord.verify.curve import Piece, curvature, displacement, heading, point
from coord.verify.tolerances import FLAT

Point = tuple[float, float]

#: [m] Feet this far beyond the ends of an arc still count: a candidate too many only lowers the result by as little.
_BEYOND = 1e-12


class Arc(NamedTuple):
    """A line or an arc that turns by 1.5 rad at most; what it stands for is nowhere farther from it than ``error``."""

    x: float
    y: float
    cos: float
    sin: float
    curvature: float
    length: float
    error: float


def arc_between(piece: Piece, s0: float, s1: float) -> Arc:
    """The stretch of a piece from s0 to s1 [m]; exact on lines and arcs.

    On a clothoid, the arc through the middle with the curvature there: headings differ by rate u^2 / 2 at u from the
    middle, so places differ by |rate| h^3 / 48 at most, h the length of the stretch.
    """
    h = max(s1 - s0, 0.0)
    if piece.rate == 0.0:
        x, y = point(piece, s0)
        angle = heading(piece, s0)
        return Arc(x, y, math.cos(angle), math.sin(angle), piece.curvature, h, 0.0)
    middle = (s0 + s1) / 2
    x, y = point(piece, middle)
    k, angle = curvature(piece, middle), heading(piece, middle)
    k = k if abs(k) >= FLAT else 0.0
    dx, dy = displacement(-h / 2, angle, math.cos(angle), math.sin(angle), k, 0.0)
    angle -= k * h / 2
    return Arc(x + dx, y + dy, math.cos(angle), math.sin(angle), k, h, abs(piece.rate) * h**3 / 48)


def place(arc: Arc, u: float) -> Point:
    """The point of an arc at u [m] from its begin."""
    half = arc.curvature * u / 2
    along = u * (math.sin(half) / half if half else 1.0)
    c, s = math.cos(half), math.sin(half)
    return arc.x + along * (arc.cos * c - arc.sin * s), arc.y + along * (arc.sin * c + arc.cos * s)


def to_point(arc: Arc, q: Point) -> tuple[float, float]:
    """Distance [m] of a point from an arc, and where on the arc [m from its begin]."""
    wx, wy = q[0] - arc.x, q[1] - arc.y
    along, aside = wx * arc.cos + wy * arc.sin, wy * arc.cos - wx * arc.sin
    k, h = arc.curvature, arc.length
    if k == 0.0:
        u = min(max(along, 0.0), h)
        return math.hypot(along - u, aside), u
    u = math.atan2(k * along, 1 - k * aside) / k
    if 0.0 <= u <= h:
        square = along * along + aside * aside
        return abs(k * square - 2 * aside) / (1 + math.hypot(k * along, 1 - k * aside)), u
    x, y = place(arc, h)
    first, last = math.hypot(wx, wy), math.hypot(q[0] - x, q[1] - y)
    return (first, 0.0) if first <= last else (last, h)


def point_to_segment(q: Point, a: Point, b: Point) -> float:
    """Distance [m] of a point from the segment a b."""
    ex, ey, wx, wy = b[0] - a[0], b[1] - a[1], q[0] - a[0], q[1] - a[1]
    square = ex * ex + ey * ey
    if square == 0.0:
        return math.hypot(wx, wy)
    t = (wx * ex + wy * ey) / square
    if t <= 0.0:
        return math.hypot(wx, wy)
    if t >= 1.0:
        return math.hypot(q[0] - b[0], q[1] - b[1])
    return abs(ex * wy - ey * wx) / math.sqrt(square)


def to_segment(arc: Arc, a: Point, b: Point) -> tuple[float, float]:
    """Distance [m] of the segment a b from an arc, and where on the arc.

    The least distance is at an end of the one or the other, where both are parallel, or 0 where they cross.
    """
    best = min(to_point(arc, a), to_point(arc, b))
    for u in (0.0, arc.length, *_critical(arc, a, b)):
        if -_BEYOND <= u <= arc.length + _BEYOND:
            best = min(best, (point_to_segment(place(arc, u), a, b), min(max(u, 0.0), arc.length)))
    return best


def _critical(arc: Arc, a: Point, b: Point) -> list[float]:
    """Where on its circle an arc is parallel to the line a b, and where it crosses it.

    The offset from the line is c + A sin(k u)/k + B (1 - cos(k u))/k, A = m.T, B = m.N, m normal to the line.
    With y = 2 tan(k u / 2) / k it vanishes where (B k/2 + c k^2/4) y^2 + A y + c = 0.
    """
    mx, my = a[1] - b[1], b[0] - a[0]
    size = math.hypot(mx, my)
    if size == 0.0:
        return []
    mx, my = mx / size, my / size
    k = arc.curvature
    offset = mx * (arc.x - a[0]) + my * (arc.y - a[1])
    first, second = mx * arc.cos + my * arc.sin, my * arc.cos - mx * arc.sin
    if k == 0.0:
        return [-offset / first] if first else []
    angle = math.atan2(-first, second)
    found = [angle / k, (angle - math.pi) / k, (angle + math.pi) / k]
    square = second * k / 2 + offset * k * k / 4
    inside = first * first - 4 * square * offset
    if inside >= 0.0:
        t = -(first + math.copysign(math.sqrt(inside), first)) / 2
        roots = ([t / square] if square else []) + ([offset / t] if t else [])
        found += [2 * math.atan(k * y / 2) / k for y in roots]
    return found


def to_ring(arc: Arc, ring: Sequence[Point]) -> tuple[float, float]:
    """Distance [m] of the outline of a convex polygon (or a segment, or a point) from an arc, and where on the arc."""
    if len(ring) == 1:
        return to_point(arc, ring[0])
    if len(ring) == 2:
        return to_segment(arc, ring[0], ring[1])
    return min(to_segment(arc, a, b) for a, b in zip(ring, (*ring[1:], ring[0]), strict=True))
