"""Exponential detours: the classical least-squares fit y = A exp(B x) of rise and fall, made safe.

Each obstacle that blocks the straight line gets a detour of its own; in between the robot drives on the line. Next
to start and goal a detour may also meet the line at an angle. Among a few ways to fit and to join the flanks the
quickest is taken. The curve becomes pieces of linear curvature, so that the curvature never jumps, and it is raised
until these pieces keep the distance. Where a detour has no single height over the line, or no room for its feet, the
turns of the whole way are fitted instead, and a remark says so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from coord.alone.chain import quick_estimate
from coord.alone.speed_limit import speed_limit
from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.model.arrays import Array, frozen
from coord.model.path import Path, straight
from coord.model.robot import Limits
from coord.model.route import Shaped
from coord.paths.detours import Detour, Line, run
from coord.paths.fitted import fitted
from coord.paths.flanks import Curve, Flanks, curve, flanks
from coord.paths.refit import Refit, refit
from coord.paths.skeleton import Skeleton
from coord.paths.taut import taut
from coord.tolerances import SAME_PLACE

#: What is tried: distances of the feet from the obstacle in units of its height, and the shares of the height between
#: which the flanks are fitted, all with the first exponent of the join; then the other exponents with the best of them.
_REACHES = (1.0, 0.5, 1.5, 2.5, 4.0)
_SHARES = ((0.02, 0.7), (0.1, 0.7), (0.1, 0.9), (0.2, 0.9), (0.02, 0.5))
_JOINS = (2.0, 1.2, 1.5, 3.0, 4.5)
_BEST = 3

#: A foot takes up to this share of the room before an obstacle; B h, the slope of a flank at the top, is not larger.
_ROOM, _STEEPEST = 0.8, 8.0

#: Rounds in which a curve is raised until its refit clears the envelope, and by how much more than it lacks.
_RAISES, _BEYOND = 8, 1e-6

#: [1] What is then tried to get a certificate, for the height between the places looked at.
_MORE = (1e-5, 1e-4, 1e-3, 4e-3)

#: Neighbours with a gap below this many of their heights are passed in one go: tried in this order.
_CLOSENESS = (1.0, 3.0, math.inf)

#: Rounds in which obstacles that a curve hits are added to what it has to clear.
_ROUNDS = 8

#: Clothoids are cut where the speed cap has changed by this factor, for comparing times.
_CAP_RATIO = 1.5

#: [m] Pieces shorter than this are left out.
_SHORTEST = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class _Bend:
    """One detour as a curve, and as pieces."""

    curve: Curve
    refit: Refit


def exponential(skeleton: Skeleton, limits: Limits, floor: Floor) -> Shaped | None:
    """The path with an exponential detour past every obstacle on the straight line, or fitted turns and the reason.

    None where there are no fitted turns either, which only places to pass bring about.
    """
    if not skeleton.turns:
        return Shaped(straight(skeleton.start, skeleton.goal), "straight")
    guide = taut(skeleton, floor)
    if guide is None:
        return None
    found: tuple[Path, list[_Bend]] | str = "the way has places to pass beside the straight line"
    if all(turn.radius > 0 for turn in skeleton.turns):
        found = _solve(Line(floor, skeleton.start, skeleton.goal, guide), limits)
    if not isinstance(found, str):
        path, bends = found
        return Shaped(path, "exponential", tuple(fit for bend in bends for fit in bend.curve.flanks.fits))
    path = fitted(skeleton, limits, floor) or guide
    return Shaped(path, "fitted", remarks=(f"Fitted turns instead of exponential ones: {found}.",))


def hull_points(floor: Floor, path: Path, limits: Limits) -> list[Array]:
    """The points (n, 2) [m] on the floor that rise and fall of every detour of an exponential path are fitted to."""
    start = (float(path.poses[0, 0]), float(path.poses[0, 1]))
    line = Line(floor, start, path.end, path)
    found = _solve(line, limits)
    if isinstance(found, str):
        return []
    fitted_to = [(bend.curve.flanks, bend.curve.flanks.detour.side) for bend in found[1]]
    return [line.back(points * (1, side)) for part, side in fitted_to for points in (part.rise, part.fall)]


def _solve(line: Line, limits: Limits) -> tuple[Path, list[_Bend]] | str:
    """The path and its detours, or why there is none; more neighbours are passed in one go where that is needed."""
    if not line.is_graph():
        return "the way turns back along the straight line, so that its detour has no single height over it"
    first: str | None = None
    for closeness in _CLOSENESS:
        found = _detoured(line, limits, closeness)
        if not isinstance(found, str):
            return found
        first = first or found
    return str(first)


def _detoured(line: Line, limits: Limits, closeness: float) -> tuple[Path, list[_Bend]] | str:
    parts = _hits(line, np.array([[0.0, 0.0], [line.length, 0.0]]))
    for _ in range(_ROUNDS):
        detours = run(line, parts, closeness)
        if isinstance(detours, str):
            return detours
        bends: list[_Bend] = []
        more: set[int] = set()
        for detour in detours:
            bend = _bend(line, detour, limits)
            if isinstance(bend, str):
                return bend
            if isinstance(bend, _Bend):
                bends.append(bend)
            else:
                more |= bend
        if not more - parts:
            path = _path(line, bends)
            if math.dist(path.end, line.goal) < SAME_PLACE and keeps_distance(line.floor, path):
                return path, bends
            return "the pieces of its curves are not exact enough on a floor of this size"
        parts |= more
    return "too many obstacles stand side by side"


def _bend(line: Line, detour: Detour, limits: Limits) -> _Bend | set[int] | str:
    """The quickest curve past a detour that keeps the distance; or the parts that are still in its way; or why not."""
    options = _options(line, detour, limits)
    if not options:
        return f"the detour {_where(detour)} has too little room for its feet"
    more: set[int] = set()
    for bend in options:
        found = _certified(line, bend)
        if found is not None:
            return found
        hits = _hits(line, _side(bend)) - set(detour.parts)
        if not more and set(line.sides(np.array(sorted(hits), dtype=np.intp))) == {detour.side}:
            more = hits
    return more or f"there is no room for the detour {_where(detour)} beside what stands on its other side"


def _options(line: Line, detour: Detour, limits: Limits) -> list[_Bend]:
    """Curves past a detour, the quickest first: each way to fit it, and each way to join the best of these."""
    rooms = _ROOM * (detour.first - detour.least), _ROOM * (detour.most - detour.last)
    feet = {(min(r * detour.height, rooms[0]), min(r * detour.height, rooms[1])): None for r in _REACHES}
    left = (False, True) if detour.least == 0.0 else (False,)
    right = (False, True) if detour.most == line.length else (False,)
    bends: list[_Bend | None] = []
    for shares, reach, *at_angle in product(_SHARES, feet, left, right):
        found = flanks(detour, reach, shares)
        if found is not None:
            bends.append(_raised(line, found, _JOINS[0], 1.0, (at_angle[0], at_angle[1])))
    best = _timed(line, bends, limits)
    joined = [_raised(line, one.curve.flanks, p, 1.0, one.curve.at_angle) for one in best[:_BEST] for p in _JOINS[1:]]
    return _timed(line, [*best, *joined], limits)


def _timed(line: Line, options: Sequence[_Bend | None], limits: Limits) -> list[_Bend]:
    """The bends in the order of the time that the whole path takes with each of them, the quickest first."""
    bends = [bend for bend in options if bend is not None]
    paths = [_path(line, [bend]) for bend in bends]
    times = [quick_estimate(speed_limit(path, limits, cap_ratio=_CAP_RATIO), limits) for path in paths]
    return [bends[k] for k in sorted(range(len(bends)), key=lambda k: times[k])]


def _certified(line: Line, bend: _Bend) -> _Bend | None:
    """The bend, raised a little more where its pieces need it, if then it keeps every distance."""
    found: _Bend | None = bend
    for more in _MORE:
        if found is None or keeps_distance(line.floor, _alone(line, found)):
            return found
        curve = bend.curve
        found = _raised(line, curve.flanks, curve.p, curve.extra * (1 + more), curve.at_angle)
    return None


def _raised(line: Line, found: Flanks, p: float, extra: float, at_angle: tuple[bool, bool]) -> _Bend | None:
    """The curve with these flanks, raised until its refit is clear; None where there is no room for it."""
    detour = found.detour
    if max(abs(fit.B) for fit in found.fits) * detour.height > _STEEPEST:
        return None
    for _ in range(_RAISES):
        shape = curve(found, p, extra, at_angle)
        pieces = refit(shape, shape.first, shape.last, at_angle) if shape is not None else None
        if shape is None or pieces is None:
            return None
        if pieces.begin < detour.least - SAME_PLACE or pieces.end > detour.most + SAME_PLACE:
            return None
        lack = line.short_of(detour, pieces.places)
        if lack <= 0:
            return _Bend(shape, pieces)
        extra *= 1 + lack + _BEYOND
    return None


def _alone(line: Line, bend: _Bend) -> Path:
    """The pieces of one detour, where they lie on the floor."""
    x, y = line.back(np.array([[bend.refit.begin, 0.0]]))[0].tolist()
    return Path((x, y, _heading(line, bend)), frozen(_pieces(bend), 3))


def _path(line: Line, bends: Sequence[_Bend]) -> Path:
    """The straight line with these detours in it."""
    pieces: list[tuple[float, float, float]] = []
    at = 0.0
    for bend in bends:
        pieces.append((bend.refit.begin - at, 0.0, 0.0))
        pieces += _pieces(bend)
        at = bend.refit.end
    pieces.append((line.length - at, 0.0, 0.0))
    heading = _heading(line, bends[0]) if bends else line.heading
    return Path((*line.start, heading), frozen([piece for piece in pieces if piece[0] > _SHORTEST], 3))


def _heading(line: Line, bend: _Bend) -> float:
    """The heading [rad] with which a detour leaves the line."""
    return line.heading + bend.curve.flanks.detour.side * bend.refit.heading


def _pieces(bend: _Bend) -> list[tuple[float, float, float]]:
    side = bend.curve.flanks.detour.side
    return [(length, side * k0, side * k1) for length, k0, k1 in bend.refit.pieces.tolist()]


def _hits(line: Line, places: Array) -> set[int]:
    """Parts that a polyline (n, 2) of the frame comes too near to."""
    at = line.back(places)
    return set(line.floor.hit_parts(np.hstack([at[:-1], at[1:]]))[:, 1].tolist())


def _side(bend: _Bend) -> Array:
    return np.asarray(bend.refit.places * (1, bend.curve.flanks.detour.side))


def _where(detour: Detour) -> str:
    side = "left" if detour.side > 0 else "right"
    return f"to the {side} at {detour.middle:.2f} m along the straight line"
