"""A path that somebody else has drawn: the polyline is kept, and its corners are rounded.

A corner cannot be driven without stopping, so each one becomes a fillet: an arc tangent to both edges. There
are no stops by decree; what a tight fillet costs is decided by the lateral acceleration alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from coord.errors import InvalidValueError
from coord.model.arrays import Point, frozen
from coord.model.path import Path, straight
from coord.paths.taut import SMALLEST_RADIUS
from coord.tolerances import SAME_PLACE

#: [rad] An edge that goes on in the same direction up to this makes no corner; one that comes back, no fillet.
_ONWARD, _BACK = 1e-9, 1e-3

#: [m] Pieces shorter than this are left out.
_SHORTEST = 1e-12


def given(points: Sequence[Point], corner_radius: float, start: Point, goal: Point) -> Path:
    """The polyline through the points, from start to goal, with its corners rounded.

    Parameters
    ----------
    points : places in order [m]; start and goal may be among them.
    corner_radius : of the fillets [m], where the edges are long enough; of two corners with a short edge between
        them each gets half of it. Below 1 cm, and 0, mean 1 cm.

    Raises
    ------
    InvalidValueError
        When the polyline goes straight back at a corner: no arc of any radius is tangent to both edges.
    """
    corners = _corners(start, points, goal)
    if len(corners) == 2:
        return straight(start, goal)
    headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in pairwise(corners)]
    lengths = [math.hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(corners)]
    turns = [_wrapped(after - before) for before, after in pairwise(headings)]
    last = len(lengths) - 1
    room = [length if k in (0, last) else length / 2 for k, length in enumerate(lengths)]
    pieces: list[tuple[float, float, float]] = []
    used = 0.0
    for k, turn in enumerate(turns):
        if math.pi - abs(turn) < _BACK:
            raise InvalidValueError([("path", _reversal(corners[k], corners[k + 1], corners[k + 2]))])
        slope = math.tan(abs(turn) / 2)
        radius = min(max(corner_radius, SMALLEST_RADIUS), min(room[k], room[k + 1]) / slope)
        curvature = math.copysign(1 / radius, turn)
        pieces.append((lengths[k] - used - radius * slope, 0.0, 0.0))
        pieces.append((radius * abs(turn), curvature, curvature))
        used = radius * slope
    pieces.append((lengths[last] - used, 0.0, 0.0))
    return Path((*start, headings[0]), frozen([piece for piece in pieces if piece[0] > _SHORTEST], 3))


def _corners(start: Point, points: Sequence[Point], goal: Point) -> list[Point]:
    """Start, corners and goal, without repeated points and those on the way to the next."""
    chain = [start]
    for point in (*points, goal):
        if math.dist(point, chain[-1]) > SAME_PLACE:
            chain.append(point)
    if chain[-1] != goal:  # the last point is the goal up to rounding, or start and goal are one place
        chain = [*chain[:-1], goal] if len(chain) > 1 else [start, goal]
    kept = chain[:1]
    for here, after in pairwise(chain[1:]):
        before = kept[-1]
        ahead = math.atan2(here[1] - before[1], here[0] - before[0])
        onward = math.atan2(after[1] - here[1], after[0] - here[0])
        if abs(_wrapped(onward - ahead)) > _ONWARD:
            kept.append(here)
    return [*kept, chain[-1]]


def _wrapped(angle: float) -> float:
    return (angle + math.pi) % (2 * math.pi) - math.pi


def _reversal(before: Point, at: Point, after: Point) -> str:
    told = ", ".join(f"({x:g}, {y:g})" for x, y in (before, at, after))
    return (
        f"the path turns straight back in the middle one of the points {told} m; robots drive forwards only: "
        "leave the point out, or give it a loop to turn in"
    )
