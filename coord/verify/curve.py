"""The path of a robot: lines, arcs and clothoids by arc length."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from coord.verify.quadrature import NODES
from coord.verify.tolerances import FLAT, ROUNDING

Pose = tuple[float, float, float]

#: [rad] Pieces are cut into parts that turn by this much at most: the quadrature is exact there to rounding,
#: and a point of the plane has one foot on an arc.
_ARC_TURN = 1.5
_CLOTHOID_TURN = 1.0


@dataclass(frozen=True, slots=True)
class Piece:
    """A stretch of a path with curvature ``curvature`` + ``rate`` u at u [m] after its begin.

    Parameters
    ----------
    begin, end : arc length [m] on the path.
    x, y, heading : pose at the begin; ``cos`` and ``sin`` are those of the heading.
    """

    begin: float
    end: float
    x: float
    y: float
    heading: float
    cos: float
    sin: float
    curvature: float
    rate: float

    @property
    def length(self) -> float:
        """Length of the piece [m]."""
        return self.end - self.begin

    @property
    def straight(self) -> bool:
        """Whether the piece is a line."""
        return self.curvature == 0.0 and self.rate == 0.0


@dataclass(frozen=True, slots=True)
class Curve:
    """A whole path, cut into pieces that turn little; ``start`` and ``goal`` are the poses at its ends.

    ``slack`` [m] is how far rounding may have carried the end of the chain.
    """

    start: Pose
    goal: Pose
    pieces: tuple[Piece, ...]
    breaks: tuple[float, ...]
    length: float
    slack: float

    @property
    def straight(self) -> bool:
        """Whether the path is one line, or a point."""
        return all(piece.straight for piece in self.pieces)


class _Sum:
    """A running sum that keeps what rounding drops (Neumaier's variant of Kahan's sum)."""

    __slots__ = ("lost", "total")

    def __init__(self, total: float) -> None:
        self.total, self.lost = total, 0.0

    def add(self, term: float) -> None:
        total = self.total + term
        larger, smaller = (self.total, term) if abs(self.total) >= abs(term) else (term, self.total)
        self.lost += (larger - total) + smaller
        self.total = total

    @property
    def value(self) -> float:
        return self.total + self.lost


def curve(start: Pose, pieces: Sequence[Sequence[float]]) -> Curve:
    """The path from a pose over pieces [length, curvature at start, at end], lengths > 0, finite."""
    x, y, heading, s = (_Sum(value) for value in (*start, 0.0))
    found: list[Piece] = []
    for length, k0, k1 in _merged(pieces):
        rate = (k1 - k0) / length
        turn = max(abs(k0), abs(k1)) * length
        parts = max(1, math.ceil(turn / (_CLOTHOID_TURN if rate else _ARC_TURN)))
        origin, direction = s.value, heading.value
        for i in range(parts):
            u0, u1 = length * i / parts, length * (i + 1) / parts
            k, angle = k0 + rate * u0, direction + (k0 + rate * u0 / 2) * u0
            begin, end = (found[-1].end if found else 0.0), origin + u1
            cos, sin = math.cos(angle), math.sin(angle)
            found.append(Piece(begin, end, x.value, y.value, angle, cos, sin, k, rate))
            dx, dy = displacement(u1 - u0, angle, cos, sin, k, rate)
            x.add(dx)
            y.add(dy)
        s.add(length)
        heading.add((k0 + k1) / 2 * length)
    goal = (x.value, y.value, heading.value)
    turning = sum(abs(piece.curvature) * piece.length for piece in found)
    size = max(abs(start[0]), abs(start[1]), abs(goal[0]), abs(goal[1]))
    slack = ROUNDING * (len(found) + 1) * (size + s.value * (1 + abs(start[2]) + turning))
    return Curve(start, goal, tuple(found), tuple(piece.begin for piece in found), s.value, slack)


def total_turn(pieces: Sequence[Sequence[float]]) -> float:
    """An upper bound on how far a path turns to either side [rad]."""
    return math.fsum(max(abs(k0), abs(k1)) * length for length, k0, k1 in pieces)


def _merged(pieces: Sequence[Sequence[float]]) -> list[tuple[float, float, float]]:
    """Lines that follow each other are one line, and so are bends too slight to be any."""
    merged: list[tuple[float, float, float]] = []
    for length, *bends in pieces:
        k0, k1 = (k if abs(k) >= FLAT else 0.0 for k in bends)
        if k0 == k1 == 0.0 and merged and merged[-1][1] == merged[-1][2] == 0.0:
            merged[-1] = (merged[-1][0] + length, 0.0, 0.0)
        else:
            merged.append((length, k0, k1))
    return merged


def displacement(u: float, heading: float, cos: float, sin: float, k: float, rate: float) -> tuple[float, float]:
    """(dx, dy) [m] after the arc length u [m] from a heading, with curvature k + rate * arc length.

    A line or an arc is its chord: u sin(h)/h in the direction heading + h, h = k u / 2; a clothoid is integrated.
    """
    if rate:
        dx = dy = 0.0
        for node, weight in NODES:
            v = u * node
            angle = heading + (k + rate / 2 * v) * v
            dx += weight * math.cos(angle)
            dy += weight * math.sin(angle)
        return u * dx, u * dy
    half = k * u / 2
    if not half:
        return u * cos, u * sin
    chord = u * (math.sin(half) / half)  # in this order: u times a denormal number would lose digits
    return chord * math.cos(heading + half), chord * math.sin(heading + half)


def point(piece: Piece, s: float) -> tuple[float, float]:
    """The point [m] of a piece at the arc length s [m] of its path, held at the ends of the piece."""
    u = min(max(s, piece.begin), piece.end) - piece.begin
    if not (piece.curvature or piece.rate):
        return piece.x + u * piece.cos, piece.y + u * piece.sin
    dx, dy = displacement(u, piece.heading, piece.cos, piece.sin, piece.curvature, piece.rate)
    return piece.x + dx, piece.y + dy


def heading(piece: Piece, s: float) -> float:
    """The heading [rad] of a piece at the arc length s [m] of its path."""
    u = min(max(s, piece.begin), piece.end) - piece.begin
    return piece.heading + (piece.curvature + piece.rate * u / 2) * u


def curvature(piece: Piece, s: float) -> float:
    """The curvature [1/m] of a piece at the arc length s [m] of its path."""
    return piece.curvature + piece.rate * (min(max(s, piece.begin), piece.end) - piece.begin)


def index_at(path: Curve, s: float) -> int:
    """Which piece holds the arc length s [m]; at a joint, the one that begins there."""
    return max(bisect_right(path.breaks, s) - 1, 0)


def pose_at(path: Curve, s: float) -> Pose:
    """The pose at the arc length s [m], held at the ends of the path."""
    if not path.pieces or s <= 0.0:
        return path.start
    if s >= path.length:
        return path.goal
    piece = path.pieces[index_at(path, s)]
    return (*point(piece, s), heading(piece, s))
