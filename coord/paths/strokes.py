"""Lines and arcs with a place, smooth chains of them, and the fillets that join chains where they meet in a corner."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from coord.model.arrays import Point

#: [m] A fillet's place is found when its two conditions agree so well; steps at most to get there.
_CONVERGED, _MOST_STEPS = 1e-13, 60


@dataclass(frozen=True, slots=True)
class Stroke:
    """A line (curvature 0) or an arc: where it begins [m], heading there [rad], length [m], curvature [1/m]."""

    x: float
    y: float
    heading: float
    length: float
    curvature: float

    def pose(self, s: float) -> tuple[float, float, float]:
        """Place (x, y) [m] and heading [rad] after the length s [m], which may lie beyond the ends."""
        turn = self.curvature * s
        chord = s * (math.sin(turn / 2) / (turn / 2)) if turn else s
        ahead = self.heading + turn / 2
        return self.x + chord * math.cos(ahead), self.y + chord * math.sin(ahead), self.heading + turn

    def part(self, first: float, last: float) -> Stroke:
        """From one length [m] on to another."""
        return Stroke(*self.pose(first), last - first, self.curvature)

    def back(self) -> Stroke:
        """The same from its end to its beginning."""
        x, y, heading = self.pose(self.length)
        return Stroke(x, y, heading + math.pi, self.length, -self.curvature)


class Chain:
    """Strokes that follow each other without a corner."""

    def __init__(self, strokes: Sequence[Stroke]) -> None:
        """At least one stroke, each beginning where the one before ends, in the same direction."""
        self.strokes = tuple(strokes)
        self.ends: list[float] = []
        for stroke in strokes:
            self.ends.append((self.ends[-1] if self.ends else 0.0) + stroke.length)

    @property
    def length(self) -> float:
        """Length of the chain [m]."""
        return self.ends[-1]

    def at(self, s: float) -> tuple[float, float, float, float]:
        """x, y [m], heading [rad] and curvature [1/m] after the length s [m], which may lie beyond the ends."""
        k = next((k for k, end in enumerate(self.ends) if s <= end), len(self.ends) - 1)
        stroke = self.strokes[k]
        return (*stroke.pose(s - self.ends[k] + stroke.length), stroke.curvature)

    def cut(self, before: float, behind: float) -> Iterator[Stroke]:
        """What is left without a length [m] at the beginning and one at the end."""
        for stroke, end in zip(self.strokes, self.ends, strict=True):
            begin = end - stroke.length
            first, last = max(before, begin), min(self.length - behind, end)
            if last > first:
                yield stroke.part(first - begin, last - begin)


@dataclass(frozen=True, slots=True)
class Fillet:
    """An arc tangent to the end of one chain and to the beginning of the next; it replaces lengths [m] of both."""

    before: float
    behind: float
    radius: float
    turn: float

    @property
    def piece(self) -> tuple[float, float, float]:
        """Length and curvatures."""
        curvature = math.copysign(1 / self.radius, self.turn)
        return (self.radius * abs(self.turn), curvature, curvature)


def fillet(one: Chain, two: Chain, radius: float, room: tuple[float, float]) -> Fillet | None:
    """The fillet of this radius [m] in the corner between two chains; None where it needs more than the room [m].

    Its centre is a radius away from both chains, on the inside of the corner: Newton's method on the lengths
    that it replaces. The derivative of a place beside a curve is its tangent times 1 - radius x curvature.
    """
    corner = wrapped(two.at(0.0)[2] - one.at(one.length)[2])
    side = math.copysign(1.0, corner)
    a = b = min(radius * math.tan(abs(corner) / 2), *room)
    for _ in range(_MOST_STEPS):
        xa, ya, ha, ka = one.at(one.length - a)
        xb, yb, hb, kb = two.at(b)
        gap_x = (xa - side * radius * math.sin(ha)) - (xb - side * radius * math.sin(hb))
        gap_y = (ya + side * radius * math.cos(ha)) - (yb + side * radius * math.cos(hb))
        if math.hypot(gap_x, gap_y) < _CONVERGED * (1 + abs(xa) + abs(ya)):
            turn = wrapped(hb - ha)
            return Fillet(a, b, radius, turn) if turn * side > 0 else None
        grow_a, grow_b = 1 - side * radius * ka, 1 - side * radius * kb
        sine = math.sin(hb - ha)
        if abs(sine) < 1e-12 or grow_a <= 0 or grow_b <= 0:
            return None
        # gap - a' grow_a (cos, sin)(ha) - b' grow_b (cos, sin)(hb) = 0 for the changes a' and b'
        a += (gap_x * math.sin(hb) - gap_y * math.cos(hb)) / (sine * grow_a)
        b += (gap_y * math.cos(ha) - gap_x * math.sin(ha)) / (sine * grow_b)
        if not (0 <= a <= room[0] and 0 <= b <= room[1]):
            return None
    return None


def distance(stroke: Stroke, point: Point) -> tuple[float, float]:
    """How far [m] a point is from a stroke, and at which length [m] along it the nearest place is."""
    dx, dy = point[0] - stroke.x, point[1] - stroke.y
    c, s = math.cos(stroke.heading), math.sin(stroke.heading)
    along, aside = c * dx + s * dy, c * dy - s * dx
    if stroke.curvature:
        radius = 1 / stroke.curvature
        turn = math.atan2(along, abs(radius) - aside * math.copysign(1.0, radius))
        full = 2 * math.pi * abs(radius)
        along = (turn * abs(radius)) % full
        if along > (stroke.length + full) / 2:
            along -= full
    along = min(max(along, 0.0), stroke.length)
    x, y, _ = stroke.pose(along)
    return math.hypot(point[0] - x, point[1] - y), along


def wrapped(angle: float) -> float:
    """An angle [rad] in (-pi, pi]."""
    return math.remainder(angle, 2 * math.pi)
