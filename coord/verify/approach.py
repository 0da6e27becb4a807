"""How near a robot's path leads to something that stands still: an obstacle, or another robot at rest.

Time does not matter here. Lines and arcs are measured exactly; clothoids by arcs that lie within a known
error of them; footprints that turn in bends by support functions.
"""

from __future__ import annotations

from coord.verify.arcs import arc_between, to_ring
from coord.verify.bisection import Bound, Least, descend, joined, worth
from coord.verify.curve import Curve, Piece, Pose, curvature, heading, index_at, point
from coord.verify.shapes import Body, Point, Ring, gap, minkowski, mirrored, support, turned
from coord.verify.support import bend

#: [m] Below this distance from a polygon, exact formulas no longer tell touching from entering.
_TOUCH = 1e-7


def approach(path: Curve, body: Body, span: tuple[float, float], still: Ring, radius: float, goal: Point) -> Least:
    """The least distance between a footprint on a stretch of its path and a convex core grown by a radius.

    Parameters
    ----------
    span : first and last arc length [m].
    still, radius : vertices of the core (one, two, or more counter-clockwise) and how far it is grown [m].
    goal : need and best [m], see ``descend``; places found are arc lengths [m].
    """
    lo, hi = span
    need, best = goal
    if not path.pieces:
        return _noted(resting(body, path.start, still, radius), 0.0, best)
    least = Least(best, None)
    for piece in path.pieces[index_at(path, lo) :]:
        if piece.begin >= hi and piece.begin > lo:
            break
        span = max(lo, piece.begin), min(hi, piece.end)
        least = joined(least, _along(piece, body, span, still, radius, (need, least.value)))
    return least


def resting(body: Body, pose: Pose, still: Ring, radius: float) -> float:
    """The distance [m] between a footprint at rest and a convex core grown by a radius, negative if they overlap."""
    ring = minkowski(still, mirrored(turned(body, pose[2])))
    return gap(pose[:2], ring)[0] - radius - body.radius


def _noted(value: float, at: float, best: float) -> Least:
    return Least(value, at) if value < best else Least(best, None)


def _along(
    piece: Piece, body: Body, span: tuple[float, float], still: Ring, radius: float, goal: tuple[float, float]
) -> Least:
    """The same on one piece."""
    need, best = goal
    lo, hi = span
    if len(body.ring) > 1:  # mostly the disc round the footprint is clear already
        arc = arc_between(piece, lo, hi)
        if _outside(piece, lo, still) and to_ring(arc, still)[0] - arc.error - radius - body.reach >= worth(need, best):
            return Least(best, None)
    if body.turning and not piece.straight:
        return descend(_swept(piece, body, still, radius), lo, hi, need, best)
    ring = minkowski(still, mirrored(turned(body, piece.heading)))
    if piece.rate:
        return descend(_clothoid(piece, body, ring, still, radius), lo, hi, need, best)
    distance, u = to_ring(arc_between(piece, lo, hi), ring)
    if len(ring) < 3 or (distance > _TOUCH and _outside(piece, lo, ring)):
        return _noted(distance - radius - body.radius, lo + u, best)
    return descend(_swept(piece, body, still, radius), lo, hi, need, best)


def _outside(piece: Piece, s: float, ring: Ring) -> bool:
    return len(ring) < 3 or gap(point(piece, s), ring)[0] > 0.0


def _clothoid(piece: Piece, body: Body, ring: Ring, still: Ring, radius: float) -> Bound:
    """Bounds of the distance by arcs, and by support functions where that is close to a polygon or in it."""
    near = _swept(piece, body, still, radius)

    def bound(lo: float, hi: float) -> tuple[float, float, float]:
        arc = arc_between(piece, lo, hi)
        distance, u = to_ring(arc, ring)
        if len(ring) > 2 and not (distance - arc.error > _TOUCH and _outside(piece, lo, ring)):
            return near(lo, hi)
        s = lo + u
        value = gap(point(piece, s), ring)[0] - radius - body.radius
        return distance - arc.error - radius - body.radius, value, s

    return bound


def _swept(piece: Piece, body: Body, still: Ring, radius: float) -> Bound:
    """Bounds of the distance by support functions, for any footprint on any piece."""

    def bound(lo: float, hi: float) -> tuple[float, float, float]:
        middle = (lo + hi) / 2
        angle = heading(piece, middle)
        ring = minkowski(still, mirrored(turned(body, angle)))
        distance, nx, ny = gap(point(piece, middle), ring)
        level = support(still, nx, ny) + radius + body.radius
        ends = [
            nx * x + ny * y - support(turned(body, heading(piece, s)), -nx, -ny)
            for s in (lo, hi)
            for x, y in (point(piece, s),)
        ]
        sinking = sink(piece, body, (nx, ny), lo, hi)
        return min(ends) - level - sinking, distance - radius - body.radius, middle

    return bound


def sink(piece: Piece, body: Body, n: tuple[float, float], lo: float, hi: float) -> float:
    """How far the support function of a footprint against n can sink between two arc lengths, at unit speed [m]."""
    curvatures = (curvature(piece, lo), curvature(piece, hi))
    turn = max(map(abs, curvatures)) * (hi - lo) / 2
    bound = bend(n, heading(piece, (lo + hi) / 2), turn, curvatures, piece.rate, (0.0, 0.0), 1.0, body.corner)
    return max(0.0, bound) * (hi - lo) ** 2 / 8


def inside_edge(path: Curve, body: Body, n: tuple[float, float], level: float, need: float) -> Least:
    """The least distance of a footprint, anywhere on its path, from the half-plane n.x >= level it must stay out of."""
    ends = [(path.start, 0.0), (path.goal, path.length)]
    values = [(level - _extent(body, pose, n), s) for pose, s in ends]
    value, at = min(values)
    least = _noted(value, at, need)
    for piece in path.pieces:
        if piece.straight:
            x, y = point(piece, piece.end)
            value = level - _extent(body, (x, y, piece.heading), n)
            found = _noted(value, piece.end, least.value)
        elif level - n[0] * piece.x - n[1] * piece.y - body.reach - piece.length >= need:
            continue
        else:
            bound = _to_edge(piece, body, n, level)
            found = descend(bound, piece.begin, piece.end, need, least.value)
        least = joined(least, found)
    return least


def _extent(body: Body, pose: Pose, n: tuple[float, float]) -> float:
    """How far a footprint reaches in the direction n [m]."""
    return n[0] * pose[0] + n[1] * pose[1] + support(turned(body, pose[2]), *n) + body.radius


def _to_edge(piece: Piece, body: Body, n: tuple[float, float], level: float) -> Bound:
    def bound(lo: float, hi: float) -> tuple[float, float, float]:
        middle = (lo + hi) / 2
        values = [level - _extent(body, (*point(piece, s), heading(piece, s)), n) for s in (lo, hi, middle)]
        sinking = sink(piece, body, (-n[0], -n[1]), lo, hi)
        return min(values[:2]) - sinking, values[2], middle

    return bound
