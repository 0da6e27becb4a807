"""How near two moving robots come to each other."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

from coord.verify.bisection import Bound, Least, descend, joined, worth
from coord.verify.curve import Piece, curvature, heading, point
from coord.verify.motion import Motion, Stretch, acceleration, arc_length, speed
from coord.verify.shapes import Body, Ring, gap, minkowski, mirrored, support, turned
from coord.verify.support import bend


@dataclass(frozen=True, slots=True)
class Mover:
    """A footprint and its motion."""

    body: Body
    motion: Motion


@dataclass(frozen=True, slots=True)
class _Leg:
    """A footprint on one stretch of its motion."""

    body: Body
    stretch: Stretch
    piece: Piece


def meeting(first: Mover, second: Mover, t0: float, t1: float, need: float, best: float) -> Least:
    """The least distance between two robots from t0 to t1 [s], both moving all that time.

    ``need`` and ``best`` [m] as for ``descend``; places found are times.
    """
    reach = first.body.reach + second.body.reach
    discs = len(first.body.ring) == len(second.body.ring) == 1
    least = Least(best, None)
    one, two = first.motion, second.motion
    k, m = bisect_right(one.ends, t0), bisect_right(two.ends, t0)
    t, before = t0, _distance(first, second, k, m, t0)
    while t < t1 and k < len(one.ends) and m < len(two.ends):
        a, b = one.stretches[k], two.stretches[m]
        end = min(a.end, b.end, t1)
        after = _distance(first, second, k, m, end)
        if discs and after - reach < least.value:
            least = Least(after - reach, end, least.open)
        # no point of the plane is nearer to the ends of a way than half of what the way is too short by
        way = arc_length(a, end) - arc_length(a, t) + arc_length(b, end) - arc_length(b, t)
        if not (before + after - way) / 2 - reach >= worth(need, least.value) + _BACKWARDS:
            legs = _Leg(first.body, a, one.path.pieces[a.piece]), _Leg(second.body, b, two.path.pieces[b.piece])
            least = joined(least, _together(*legs, t, end, need, least.value))
        t, before = end, after
        k, m = k + (a.end <= end), m + (b.end <= end)
    return least


#: [m] More than a phase may run backwards, which adds to its way.
_BACKWARDS = 1e-8


def _distance(first: Mover, second: Mover, k: int, m: int, t: float) -> float:
    """The distance between the reference points at a time of the k-th and m-th stretch [m]."""
    k, m = min(k, len(first.motion.ends) - 1), min(m, len(second.motion.ends) - 1)
    a, b = first.motion.stretches[k], second.motion.stretches[m]
    p = point(first.motion.path.pieces[a.piece], arc_length(a, t))
    q = point(second.motion.path.pieces[b.piece], arc_length(b, t))
    return math.hypot(p[0] - q[0], p[1] - q[1])


def _together(first: _Leg, second: _Leg, t0: float, t1: float, need: float, best: float) -> Least:
    """The same while each stays on one stretch."""
    if first.piece.straight and second.piece.straight:
        ring = minkowski(turned(second.body, second.piece.heading), mirrored(turned(first.body, first.piece.heading)))
        bound = _linear(first, second, ring, t0)
    else:
        bound = _curved(first, second)
    return descend(bound, t0, t1, need, best)


def _linear(first: _Leg, second: _Leg, ring: Ring, t0: float) -> Bound:
    """Bounds for two robots on lines: their relative place is a cubic in time."""
    total = first.body.radius + second.body.radius
    (x0, x1, x2, x3), (y0, y1, y2, y3) = _cubic(first, second, t0)
    disc = len(ring) == 1

    def bound(ta: float, tb: float) -> tuple[float, float, float]:
        ha, hb, hm = ta - t0, tb - t0, (ta + tb) / 2 - t0
        x = x0 + hm * (x1 + hm * (x2 + hm * x3))
        y = y0 + hm * (y1 + hm * (y2 + hm * y3))
        if disc:
            value = math.hypot(x, y)
            nx, ny = (x / value, y / value) if value else (1.0, 0.0)
            level = total
        else:
            value, nx, ny = gap((x, y), ring)
            level = support(ring, nx, ny) + total
        fa = nx * (x0 + ha * (x1 + ha * (x2 + ha * x3))) + ny * (y0 + ha * (y1 + ha * (y2 + ha * y3)))
        fb = nx * (x0 + hb * (x1 + hb * (x2 + hb * x3))) + ny * (y0 + hb * (y1 + hb * (y2 + hb * y3)))
        sa, sb = 2 * (nx * x2 + ny * y2), 6 * (nx * x3 + ny * y3)
        sinking = (tb - ta) ** 2 / 8 * max(0.0, sa + ha * sb, sa + hb * sb)
        return min(fa, fb) - level - sinking, value - total, ta + (tb - ta) / 2

    return bound


def _cubic(first: _Leg, second: _Leg, t0: float) -> tuple[list[float], list[float]]:
    """Coefficients of x and y of the first robot relative to the second, by the time since t0."""
    x, y = [0.0] * 4, [0.0] * 4
    for sign, leg in ((1.0, first), (-1.0, second)):
        stretch, piece = leg.stretch, leg.piece
        s = (arc_length(stretch, t0) - piece.begin, speed(stretch, t0), acceleration(stretch, t0) / 2, stretch.j / 6)
        for n, value in enumerate(s):
            x[n] += sign * value * piece.cos
            y[n] += sign * value * piece.sin
    x[0] += first.piece.x - second.piece.x
    y[0] += first.piece.y - second.piece.y
    return x, y


def _curved(first: _Leg, second: _Leg) -> Bound:
    """Bounds for any two stretches."""
    total = first.body.radius + second.body.radius
    turning = first.body.turning or second.body.turning

    def cores(t: float) -> tuple[Ring, Ring]:
        return turned(first.body, _heading(first, t)), turned(second.body, _heading(second, t))

    def bound(ta: float, tb: float) -> tuple[float, float, float]:
        tm = (ta + tb) / 2
        k1, k2 = cores(tm)
        value, nx, ny = gap(_relative(first, second, tm), minkowski(k2, mirrored(k1)))
        ends = []
        for t in (ta, tb):
            x, y = _relative(first, second, t)
            if turning:
                k1, k2 = cores(t)
            ends.append(nx * x + ny * y - support(k1, -nx, -ny) - support(k2, nx, ny))
        bends = _bend(first, (nx, ny), ta, tm, tb) + _bend(second, (-nx, -ny), ta, tm, tb)
        return min(ends) - total - (tb - ta) ** 2 / 8 * max(0.0, bends), value - total, tm

    return bound


def _relative(first: _Leg, second: _Leg, t: float) -> tuple[float, float]:
    p = point(first.piece, arc_length(first.stretch, t))
    q = point(second.piece, arc_length(second.stretch, t))
    return p[0] - q[0], p[1] - q[1]


def _heading(leg: _Leg, t: float) -> float:
    return heading(leg.piece, arc_length(leg.stretch, t))


def _bend(leg: _Leg, n: tuple[float, float], ta: float, tm: float, tb: float) -> float:
    """An upper bound of n.x'' between two times [m/s2]."""
    stretch, piece = leg.stretch, leg.piece
    sa, sm, sb = arc_length(stretch, ta), arc_length(stretch, tm), arc_length(stretch, tb)
    curvatures = curvature(piece, sa), curvature(piece, sb)
    turn = max(map(abs, curvatures)) * (max(sb - sm, sm - sa) + _BACKWARDS)
    # between two ends the speed exceeds the larger one by |jerk| h^2 / 8 at most
    fastest = max(abs(speed(stretch, ta)), abs(speed(stretch, tb))) + abs(stretch.j) * (tb - ta) ** 2 / 8
    accelerations = acceleration(stretch, ta), acceleration(stretch, tb)
    return bend(n, heading(piece, sm), turn, curvatures, piece.rate, accelerations, fastest, leg.body.corner)
