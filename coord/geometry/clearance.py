"""Does a whole path keep the distance? Exact on lines; bends by chords and how far they can lie from the bend."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from coord.geometry.blocked import Floor
from coord.model.arrays import Array
from coord.model.path import Path
from coord.tolerances import DISTANCE

#: [m] First chords of a bend lie at most so far from it; those too near to an obstacle are halved.
_COARSE = 1e-2

#: [m] A chord this near to its bend is not halved any more: what is still too near then is a hit.
_FINE = 5e-7


def keeps_distance(floor: Floor, path: Path, first: float = 0.0, last: float = math.inf) -> bool:
    """Whether the path stays in the box and keeps every part's distance, with no exception between samples.

    Pieces that end before the arc length ``first`` or begin after ``last`` [m] are left out.

    A point of a bend lies within max|curvature| h^2 / 8 of the chord over its arc length h. A bend that
    touches may be refused, if it comes nearer than about a millionth of a metre.
    """
    bends = np.abs(path.pieces[:, 1:]).max(axis=1, initial=0.0)
    asked = (path.breaks[1:] >= first) & (path.breaks[:-1] <= last)
    lines = np.flatnonzero(asked & (bends == 0))
    segments = np.hstack([path.poses[lines, :2], path.poses[lines + 1, :2]])
    if len(floor.hit_parts(segments)) or np.any(_leaves_box(floor, segments, 0.0)):
        return False
    s, bend = _first_chords(path, np.where(asked, bends, 0.0))
    while len(s):
        error = bend * (s[:, 1] - s[:, 0]) ** 2 / 8
        ends = path.point(s.ravel()).reshape(-1, 4)
        near = floor.is_hit(ends, error) | _leaves_box(floor, ends, error[:, None])
        if np.any(near & (error <= _FINE)):
            return False
        s, bend = s[near], np.repeat(bend[near], 2)
        middle = s.mean(axis=1)
        s = np.stack([s[:, 0], middle, middle, s[:, 1]], axis=1).reshape(-1, 2)
    return True


def _first_chords(path: Path, bends: Array) -> tuple[Array, Array]:
    s: list[tuple[float, float]] = []
    bend: list[float] = []
    for k in np.flatnonzero(bends > 0).tolist():
        start, length = float(path.breaks[k]), float(path.pieces[k, 0])
        count = max(1, math.ceil(length * math.sqrt(float(bends[k]) / (8 * _COARSE))))
        s += [(start + length * i / count, start + length * (i + 1) / count) for i in range(count)]
        bend += [float(bends[k])] * count
    return np.array(s).reshape(-1, 2), np.array(bend)


def _leaves_box(floor: Floor, segments: Array, error: Array | float) -> npt.NDArray[np.bool_]:
    """Whether segments (n, 4), widened by their errors, reach out of the box."""
    xmin, ymin, xmax, ymax = floor.grown.box
    x, y = segments[:, [0, 2]], segments[:, [1, 3]]
    slack = DISTANCE
    outside = (x - error < xmin - slack) | (x + error > xmax + slack)
    outside |= (y - error < ymin - slack) | (y + error > ymax + slack)
    return np.asarray(outside.any(axis=1))
