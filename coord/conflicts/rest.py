"""Does a path run over a place where another robot rests? Exact, because the arrival guarantee rests on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from coord.conflicts.apart import on_arc, on_segments, signed_distance
from coord.conflicts.core import POINT, Core
from coord.model.arrays import Array, Point
from coord.model.path import Path
from coord.tolerances import DISTANCE

#: Pieces with varying curvature are halved until the distance is known to this [m].
_KNOWN = DISTANCE / 4

#: Of segments (m, 2 ends, 2): the distances (m, 2) of their ends, and their least distances (m,).
_Measure: TypeAlias = Callable[[Array], tuple[Array, Array]]


def closest(path: Path, place: Point, core: Core = POINT, within: float = math.inf) -> tuple[float, float]:
    """Least distance [m] between a path and a core at a place, and an arc length [m] where it is reached.

    Exact on lines and arcs; on pieces of varying curvature within a quarter of the tolerance of distances.
    Inside a polygon the distance is the depth, negative.

    Parameters
    ----------
    core : a point, or a convex polygon of ``coord.conflicts.core.conflict_core``, about the place.
    within : distances above this [m] need not be exact.
    """
    target = np.array(place)
    if len(core) > 1:
        return _closest_to_polygon(path, target, np.array(core), within)
    best = (float(np.hypot(*(path.poses[0, :2] - target))), 0.0)
    pieces = path.pieces
    arcs = np.flatnonzero(pieces[:, 1] != 0) if len(pieces) else np.array([], dtype=np.intp)
    lines = np.flatnonzero(~pieces[:, 1:].any(axis=1)) if len(pieces) else arcs
    for k, (distance, u) in zip(lines.tolist(), _lines(path, lines, target), strict=True):
        best = min(best, (distance, float(path.breaks[k]) + u))
    for k in [k for k in range(len(pieces)) if k not in set(lines.tolist())]:
        length, k0, k1 = pieces[k].tolist()
        if k0 == k1:
            distance, u = _arc(path.poses[k].tolist(), length, k0, place)
        else:
            distance, u = _bent(path, k, _from_point(target), best[0])
        best = min(best, (distance, float(path.breaks[k]) + u))
    return best


def runs_over(path: Path, place: Point, distance: float, core: Core = POINT) -> float | None:
    """The arc length at which a path comes closest to a core at a place, if closer than ``distance`` [m]; else None.

    Touching exactly is not closer.
    """
    if len(core) > 1 and closest(path, place)[0] > distance + max(math.hypot(x, y) for x, y in core):
        return None
    least, s = closest(path, place, core, within=distance)
    return s if least < distance - DISTANCE else None


def _closest_to_polygon(path: Path, target: Array, core: Array, within: float) -> tuple[float, float]:
    """As ``closest``, for a polygon (n, 2) [m] about the target."""
    # seen from the target: far from the origin the edges' offsets would lose the digits that matter
    poses, pieces = path.poses - [*target, 0.0], path.pieces
    best = (float(signed_distance(poses[0, :2], core)), 0.0)
    straight = np.flatnonzero(~pieces[:, 1:].any(axis=1))
    if len(straight):
        distance, share = on_segments(poses[straight, :2], poses[straight + 1, :2], core)
        k = int(np.argmin(distance))
        at = float(path.breaks[straight[k]] + share[k] * pieces[straight[k], 0])
        best = min(best, (float(distance[k]), at))
    for k in np.flatnonzero(pieces[:, 1:].any(axis=1)).tolist():
        length, k0, k1 = pieces[k].tolist()
        if k0 == k1:
            x, y, heading = poses[k].tolist()
            least, u = on_arc((x, y, heading), length, k0, core)
        else:
            least, u = _bent(path, k, _from_polygon(target, core), min(best[0], within))
        best = min(best, (least, float(path.breaks[k]) + u))
    return best


def _lines(path: Path, index: npt.NDArray[np.intp], target: Array) -> list[tuple[float, float]]:
    """Distances and arc lengths within the pieces of the points closest to the target, for straight pieces."""
    poses, length = path.poses[index], path.pieces[index, 0]
    direction = np.stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=1)
    gap = target - poses[:, :2]
    u = np.clip((gap * direction).sum(axis=1), 0.0, length)
    distance = np.hypot(*(gap - direction * u[:, None]).T)
    return list(zip(distance.tolist(), u.tolist(), strict=True))


def _arc(pose: list[float], length: float, curvature: float, place: Point) -> tuple[float, float]:
    """The closest point of an arc: on the ray from its centre, or an end."""
    x, y, heading = pose
    radius = 1 / abs(curvature)
    side = math.copysign(1.0, curvature)
    cx, cy = x - side * radius * math.sin(heading), y + side * radius * math.cos(heading)
    turn = length * abs(curvature)
    start = math.atan2(y - cy, x - cx)
    toward = math.atan2(place[1] - cy, place[0] - cx)
    from_start = (side * (toward - start)) % (2 * math.pi)
    options = [0.0, turn] + ([from_start] if from_start <= turn else [])

    def distance(angle: float) -> float:
        at = start + side * angle
        return math.hypot(cx + radius * math.cos(at) - place[0], cy + radius * math.sin(at) - place[1])

    best = min(options, key=distance)
    return distance(best), best * radius


def _bent(path: Path, k: int, measure: _Measure, bound: float) -> tuple[float, float]:
    """The closest point of a piece of varying curvature: halve where the chord cannot exclude a better one."""
    bend = float(np.abs(path.pieces[k, 1:]).max())
    base, length = float(path.breaks[k]), float(path.pieces[k, 0])
    best = (math.inf, 0.0)
    open_parts = [(0.0, length)]
    while open_parts:
        u = np.array(open_parts)
        ends, chord = measure(path.point(base + u.ravel()).reshape(-1, 2, 2))
        for pair, distances in zip(open_parts, ends.tolist(), strict=True):
            best = min(best, *zip(distances, pair, strict=True))
        reachable = chord - bend * (u[:, 1] - u[:, 0]) ** 2 / 8
        halve = reachable < min(best[0], bound) - _KNOWN
        open_parts = [
            part
            for first, last in u[halve].tolist()
            for part in ((first, (first + last) / 2), ((first + last) / 2, last))
        ]
    return best


def _from_point(target: Array) -> _Measure:
    """Distances of segments from a place."""

    def measure(at: Array) -> tuple[Array, Array]:
        gap = at - target
        along = at[:, 1] - at[:, 0]
        share = np.clip(-(gap[:, 0] * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)
        return np.hypot(gap[..., 0], gap[..., 1]), np.hypot(*(gap[:, 0] + along * share[:, None]).T)

    return measure


def _from_polygon(target: Array, core: Array) -> _Measure:
    """Signed distances of segments from a polygon about a place."""

    def measure(at: Array) -> tuple[Array, Array]:
        seen = at - target
        return signed_distance(seen, core), on_segments(seen[:, 0], seen[:, 1], core)[0]

    return measure
