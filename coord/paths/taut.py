"""The taut path: a skeleton as lines and arcs."""

from __future__ import annotations

import math

from coord.model.arrays import Point, frozen
from coord.model.path import Path, straight
from coord.paths.skeleton import Skeleton

#: [m] Pieces shorter than this are left out.
_SHORTEST = 1e-9


def taut(skeleton: Skeleton) -> Path:
    """The path along a skeleton: its tangents, and arcs of its turns' own radius."""
    if not skeleton.turns:
        return straight(skeleton.start, skeleton.goal)
    pieces: list[tuple[float, float, float]] = []
    at, heading = skeleton.start, 0.0
    for k, turn in enumerate(skeleton.turns):
        entry = _on(turn.center, turn.radius, turn.first)
        exit_ = _on(turn.center, turn.radius, turn.first + turn.side * turn.angle)
        if k == 0:
            heading = turn.first + turn.side * math.pi / 2
        _line(pieces, at, entry)
        curvature = turn.side / turn.radius
        pieces.append((turn.radius * turn.angle, curvature, curvature))
        at = exit_
    _line(pieces, at, skeleton.goal)
    return Path((*skeleton.start, heading), frozen(pieces, 3))


def _on(center: Point, radius: float, angle: float) -> Point:
    return (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))


def _line(pieces: list[tuple[float, float, float]], a: Point, b: Point) -> None:
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    if length > _SHORTEST:
        pieces.append((length, 0.0, 0.0))
