"""The fitted path: every turn of the skeleton as wide as pays.

The shortest way turns as tightly as it may, and a tight turn must be driven slowly. A wider turn about the same
corner is longer and quicker. Every turn becomes clothoid, arc, clothoid with a peak curvature of its own,
touching the corner's offset; radius and share of the clothoids are chosen turn by turn by the time the whole
path takes, as long as the path keeps its distance. The taut path is one of the choices, so that there is
always an outcome.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coord.alone.chain import quick_estimate
from coord.alone.speed_limit import speed_limit
from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.model.arrays import frozen
from coord.model.path import Path, straight
from coord.model.robot import Limits
from coord.paths import turns
from coord.paths.skeleton import Skeleton, Turn
from coord.paths.taut import taut
from coord.solvers.jerk import rest_to_rest

#: Shares of half a turn that each clothoid may take.
_SHARES = (0.0, 0.5, 1.0)

#: Radii tried for a turn: this many, evenly spaced in the logarithm up to the one that needs no slowing down.
_RADII = 6

#: Rounds over all turns.
_ROUNDS = 2

#: A path within this share of the time that its skeleton's length alone would take is not improved any more.
_GOOD_ENOUGH = 2e-4

#: [m] Fixed point of directions and effective radii: change below which it has converged, rounds at most.
_CONVERGED, _MOST_ROUNDS = 1e-12, 100

#: [m] Curves keep this much more than the distance, so that their certificate needs no tiny chords.
_AIR = 2e-6

#: Clothoids are cut where the speed cap has changed by this factor, for comparing times.
_CAP_RATIO = 1.3

#: [m] Pieces shorter than this are left out.
_SHORTEST = 1e-9


@dataclass(frozen=True, slots=True)
class _Shape:
    """Radius of peak curvature [m] and the clothoids' share of the turn."""

    radius: float
    share: float


def fitted(skeleton: Skeleton, limits: Limits, floor: Floor) -> Path:
    """The quickest path found along a skeleton that keeps the floor's distances."""
    if not skeleton.turns:
        return straight(skeleton.start, skeleton.goal)
    shapes = [_Shape(turn.radius + _AIR, 0.0) for turn in skeleton.turns]
    best = taut(skeleton)
    least = _time(best, limits)
    ideal = rest_to_rest(skeleton.length, limits).arrival
    for _ in range(_ROUNDS):
        changed = False
        if least <= ideal * (1 + _GOOD_ENOUGH):
            break
        for k, turn in enumerate(skeleton.turns):
            for shape in _candidates(turn, limits):
                trial = [*shapes[:k], shape, *shapes[k + 1 :]]
                path = _path(skeleton, skeleton.turns, trial)
                if path is None or shape == shapes[k] or path.length / limits.speed >= least:
                    continue
                time = _time(path, limits)
                if time < least * (1 - 1e-6) and keeps_distance(floor, path):
                    shapes, best, least, changed = trial, path, time, True
        if not changed:
            break
    return best


def _time(path: Path, limits: Limits) -> float:
    return quick_estimate(speed_limit(path, limits, cap_ratio=_CAP_RATIO), limits)


def _candidates(turn: Turn, limits: Limits) -> list[_Shape]:
    """Shapes for one turn, from the corner's own radius up to one that is driven at full speed."""
    widest = max(limits.speed**2 / limits.lateral_acceleration, turn.radius) * 1.0001
    radii = np.geomspace(turn.radius + _AIR, widest + _AIR, _RADII).tolist()
    return [_Shape(radius, share) for radius in reversed(radii) for share in _SHARES]


def _path(skeleton: Skeleton, corners: Sequence[Turn], shapes: Sequence[_Shape]) -> Path | None:
    """The path with these turns; None where two curves need more of a tangent than there is, or a turn vanishes."""
    lines = _lines(skeleton, corners, shapes)
    if lines is None:
        return None
    headings, lengths, angles = lines
    pieces: list[tuple[float, float, float]] = []
    before = 0.0
    for k, (corner, shape) in enumerate(zip(corners, shapes, strict=True)):
        lead = turns.lead_in(shape.radius, corner.radius + _AIR, angles[k], shape.share)
        line = lengths[k] - before - lead
        if line < 0:
            return None
        pieces.append((line, 0.0, 0.0))
        pieces += turns.pieces(shape.radius, angles[k], shape.share, corner.side)
        before = lead
    last = lengths[-1] - before
    if last < 0:
        return None
    pieces.append((last, 0.0, 0.0))
    kept = [piece for piece in pieces if piece[0] > _SHORTEST]
    return Path((*skeleton.start, headings[0]), frozen(kept, 3))


def _lines(
    skeleton: Skeleton, corners: Sequence[Turn], shapes: Sequence[_Shape]
) -> tuple[list[float], list[float], list[float]] | None:
    """Headings and lengths of the tangents between the feet of the effective discs, and the turns' angles.

    The discs' radii depend on the angles and these on the radii: iterated to a fixed point.
    """
    places = [skeleton.start, *(corner.center for corner in corners), skeleton.goal]
    radii = [0.0, *(corner.radius for corner in corners), 0.0]
    sides = [0, *(corner.side for corner in corners), 0]
    for _ in range(_MOST_ROUNDS):
        headings, lengths = [], []
        for k in range(len(places) - 1):
            dx, dy = places[k + 1][0] - places[k][0], places[k + 1][1] - places[k][1]
            shift = sides[k] * radii[k] - sides[k + 1] * radii[k + 1]
            square = dx * dx + dy * dy - shift * shift
            if square <= 0:
                return None
            headings.append(math.atan2(dy, dx) + math.atan2(shift, math.sqrt(square)))
            lengths.append(math.sqrt(square))
        angles = [_wrapped(corner.side * (headings[k + 1] - headings[k])) for k, corner in enumerate(corners)]
        if any(not 0 < angle < 3.1 for angle in angles):
            return None
        following = [
            turns.effective_radius(shape.radius, corner.radius + _AIR, angle, shape.share)
            for corner, shape, angle in zip(corners, shapes, angles, strict=True)
        ]
        change = max(abs(new - old) for new, old in zip(following, radii[1:-1], strict=True))
        radii[1:-1] = following
        if change < _CONVERGED:
            return headings, lengths, angles
    return None


def _wrapped(angle: float) -> float:
    return (angle + math.pi) % (2 * math.pi) - math.pi
