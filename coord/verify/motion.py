"""Where a robot is at every time: its path, driven by its velocity profile."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

from coord.verify.curve import Curve, Pose, index_at, pose_at
from coord.verify.tolerances import PIECE_END

Row = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Stretch:
    """The motion from ``begin`` to ``end`` [s]: on one piece of the path, with one jerk.

    The state s [m], v [m/s], a [m/s2] is that at the time ``knot`` [s], j [m/s3] the jerk.
    """

    begin: float
    end: float
    knot: float
    s: float
    v: float
    a: float
    j: float
    piece: int


@dataclass(frozen=True, slots=True)
class Motion:
    """A robot's path and how it is driven; at rest at the ends of the path before and after.

    ``ends`` [s] are those of the stretches.
    """

    path: Curve
    departure: float
    arrival: float
    stretches: tuple[Stretch, ...]
    ends: tuple[float, ...]


def motion(path: Curve, times: Row, states: Sequence[Row], jerks: Row) -> Motion:
    """The motion over knots whose times increase and whose arc lengths do not decrease."""
    found: list[Stretch] = []
    for k, j in enumerate(jerks):
        s, v, a = states[k]
        whole = Stretch(times[k], times[k + 1], times[k], s, v, a, j, index_at(path, s + PIECE_END))
        found.extend(_cut(path, whole))
    return Motion(path, times[0], times[-1], tuple(found), tuple(stretch.end for stretch in found))


def _cut(path: Curve, whole: Stretch) -> list[Stretch]:
    """A phase cut where it passes from one piece to the next."""
    last = arc_length(whole, whole.end)
    begin, piece, parts = whole.begin, whole.piece, []
    while piece + 1 < len(path.breaks) and last > path.breaks[piece + 1] + PIECE_END:
        end = _passing(whole, path.breaks[piece + 1], begin)
        if end > begin:
            parts.append(Stretch(begin, end, whole.knot, whole.s, whole.v, whole.a, whole.j, piece))
        begin, piece = end, piece + 1
    if whole.end > begin:
        parts.append(Stretch(begin, whole.end, whole.knot, whole.s, whole.v, whole.a, whole.j, piece))
    return parts


def _passing(stretch: Stretch, s: float, begin: float) -> float:
    """The time at which an arc length is reached, by regula falsi (Illinois) and halving."""
    lo, hi = begin, stretch.end
    below, above = arc_length(stretch, lo) - s, arc_length(stretch, hi) - s
    side = 0
    for step in range(200):
        if below >= 0.0:
            return lo
        t = hi - above * (hi - lo) / (above - below) if step % 8 < 6 and above > below else (lo + hi) / 2
        if not lo < t < hi:
            t = (lo + hi) / 2
            if not lo < t < hi:
                break
        value = arc_length(stretch, t) - s
        if abs(value) < PIECE_END / 100:
            return t
        if value < 0.0:
            lo, below, above, side = t, value, above / 2 if side < 0 else above, -1
        else:
            hi, above, below, side = t, value, below / 2 if side > 0 else below, 1
    return lo


def arc_length(stretch: Stretch, t: float) -> float:
    """The arc length s [m] at a time [s] of a stretch."""
    h = t - stretch.knot
    return stretch.s + h * (stretch.v + h * (stretch.a / 2 + h * stretch.j / 6))


def speed(stretch: Stretch, t: float) -> float:
    """The speed [m/s] at a time [s] of a stretch."""
    h = t - stretch.knot
    return stretch.v + h * (stretch.a + h * stretch.j / 2)


def acceleration(stretch: Stretch, t: float) -> float:
    """The acceleration [m/s2] at a time [s] of a stretch."""
    return stretch.a + (t - stretch.knot) * stretch.j


def stretch_at(whole: Motion, t: float) -> int:
    """Which stretch holds a time between departure and arrival; at a joint, the one that ends there."""
    return min(bisect_left(whole.ends, t), len(whole.stretches) - 1)


def travelled(whole: Motion, t: float) -> float:
    """The arc length [m] at any time [s]."""
    if t <= whole.departure:
        return 0.0
    if t >= whole.arrival:
        return whole.path.length
    s = arc_length(whole.stretches[stretch_at(whole, t)], t)
    return min(max(s, 0.0), whole.path.length)


def pose(whole: Motion, t: float) -> Pose:
    """The pose at any time [s]."""
    return pose_at(whole.path, travelled(whole, t))


def time_at(whole: Motion, s: float, after: float) -> float:
    """A time [s], not before the one given, at which the robot is at the arc length s [m]; to rounding."""
    if s <= travelled(whole, after):
        return after
    lo, hi = max(after, whole.departure), max(after, whole.arrival)
    while lo < (t := (lo + hi) / 2) < hi:
        lo, hi = (lo, t) if travelled(whole, t) >= s else (t, hi)
    return hi
