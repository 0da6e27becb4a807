"""What a robot is shaped like: a disc, or a convex polygon that keeps its heading or turns with the path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from coord.errors import InvalidValueError
from coord.model.arrays import Point
from coord.model.rules import range_fault
from coord.tolerances import LARGEST_COORDINATE, SMALLEST_RADIUS


@dataclass(frozen=True, slots=True)
class Footprint:
    """The floor a robot covers about its reference point, which is what follows the path.

    Made by ``Footprint(radius)`` for a disc, by ``polygon`` and by ``square``.

    Parameters
    ----------
    radius : of the disc, or of the smallest disc about the reference point that holds the polygon [m].
    vertices : of a convex polygon about the reference point (0, 0), counter-clockwise [m]; none for a disc.
    heading : "fixed": the polygon lies as drawn all the time; "path": its x axis points along the path.

    Raises
    ------
    InvalidValueError
        When the radius is not positive, or larger than any floor.
    """

    radius: float
    vertices: tuple[Point, ...] = ()
    heading: str = "fixed"

    def __post_init__(self) -> None:
        fault = range_fault("the disc's radius", self.radius, " m", SMALLEST_RADIUS, LARGEST_COORDINATE)
        if fault:
            raise InvalidValueError([("footprint", fault)])
        if self.heading not in ("fixed", "path"):
            raise InvalidValueError([("heading", f'heading must be "fixed" or "path" (got "{self.heading}")')])

    @property
    def is_exact(self) -> bool:
        """Whether planning uses the shape itself; one that turns is planned as its ``radius``, and then certified."""
        return bool(self.vertices) and self.heading == "fixed"

    @property
    def core(self) -> tuple[Point, ...]:
        """The convex core that planning uses: the polygon that keeps its heading, else the reference point."""
        return self.vertices if self.is_exact else ((0.0, 0.0),)

    @property
    def margin(self) -> float:
        """What planning adds round the core [m]: nothing to a polygon that keeps its heading, else the radius."""
        return 0.0 if self.is_exact else self.radius


def polygon(vertices: Sequence[Sequence[float]], heading: str = "path") -> Footprint:
    """A convex polygon (n, 2) [m] about the reference point (0, 0), in either sense of rotation.

    Raises
    ------
    InvalidValueError
        When it is not convex, has no area, or does not hold its reference point.
    """
    ring = [(float(x), float(y)) for x, y in vertices]
    if _area(ring) < 0:
        ring.reverse()
    fault = _polygon_fault(ring)
    if fault:
        raise InvalidValueError([("footprint", fault)])
    return Footprint(max(math.hypot(x, y) for x, y in ring), tuple(ring), heading)


def square(side: float, heading: str = "fixed") -> Footprint:
    """A square of this side [m] with the reference point in its middle."""
    fault = range_fault("the square's side", side, " m", 2 * SMALLEST_RADIUS, LARGEST_COORDINATE)
    if fault:
        raise InvalidValueError([("footprint", fault)])
    half = side / 2
    return polygon([(-half, -half), (half, -half), (half, half), (-half, half)], heading)


def _polygon_fault(ring: list[Point]) -> str | None:
    """Why a ring is no footprint, as the independent checker sees it too, or None."""
    if not all(math.isfinite(value) for point in ring for value in point):
        return "all corners of a footprint must be finite numbers [m]"
    if len(ring) < 3 or _area(ring) <= 0:
        return f"a footprint needs at least 3 corners that are not on one line (got {[list(point) for point in ring]})"
    edges = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise([*ring, ring[0]])]
    turns = 0.0
    for (ax, ay), (bx, by) in pairwise([*edges, edges[0]]):
        cross, dot = ax * by - ay * bx, ax * bx + ay * by
        if cross < 0 or (cross == 0 and dot <= 0):
            return "the footprint must be convex, without repeated corners"
        turns += math.atan2(cross, dot)
    if turns > 3 * math.pi:
        return "the footprint must be convex, its outline once round"
    if any(a[0] * b[1] - a[1] * b[0] < 0 for a, b in pairwise([*ring, ring[0]])):
        return "the footprint must hold its reference point (0, 0)"
    return None


def _area(ring: Sequence[Point]) -> float:
    return math.fsum(a[0] * b[1] - a[1] * b[0] for a, b in pairwise([*ring, *ring[:1]])) / 2
