"""The taut path: a skeleton as lines and arcs, with fillets where it would turn on the spot."""

from __future__ import annotations

import math

from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.model.arrays import Point, frozen
from coord.model.path import Path, straight
from coord.paths.bends import Bend, Bends
from coord.paths.skeleton import Skeleton

#: [m] No turn is tighter than this where there is room: tighter ones would be driven at a crawl.
SMALLEST_RADIUS = 0.01

#: [m] Pieces shorter than this are left out.
_SHORTEST = 1e-9

#: Fillets that do not fit are halved so often.
_HALVINGS = 14


def taut(skeleton: Skeleton, floor: Floor) -> Path | None:
    """The path along a skeleton: its tangents, and arcs of its turns' own radius, or fillets of a centimetre.

    Fillets become smaller where a centimetre does not fit; None where nothing fits, which only places to pass
    bring about.
    """
    if not skeleton.turns:
        return straight(skeleton.start, skeleton.goal)
    if all(turn.radius >= SMALLEST_RADIUS for turn in skeleton.turns):
        return _arcs(skeleton)
    smallest = SMALLEST_RADIUS
    for _ in range(_HALVINGS):
        bends = Bends(skeleton, [Bend(max(turn.radius, smallest), 0.0) for turn in skeleton.turns])
        if bends.fits and keeps_distance(floor, path := bends.path()):
            return path
        smallest /= 2
    return None


def _arcs(skeleton: Skeleton) -> Path:
    pieces: list[tuple[float, float, float]] = []
    at, heading = skeleton.start, 0.0
    for k, turn in enumerate(skeleton.turns):
        if k == 0:
            heading = turn.first + turn.side * math.pi / 2
        _line(pieces, at, turn.at(0.0))
        curvature = turn.side / turn.radius
        pieces.append((turn.radius * turn.angle, curvature, curvature))
        at = turn.at(1.0)
    _line(pieces, at, skeleton.goal)
    return Path((*skeleton.start, heading), frozen(pieces, 3))


def _line(pieces: list[tuple[float, float, float]], a: Point, b: Point) -> None:
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    if length > _SHORTEST:
        pieces.append((length, 0.0, 0.0))
