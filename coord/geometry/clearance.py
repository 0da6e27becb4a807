"""Does a whole path keep the distance? Exact on lines; bends by chords and how far they can lie from the bend."""

from __future__ import annotations

import math

import numpy as np

from coord.geometry.blocked import Floor
from coord.model.arrays import Array
from coord.model.path import Path

#: [m] First chords of a bend lie at most so far from it; those too near to an obstacle are halved.
_COARSE = 1e-2

#: [m] A chord this near to its bend is not halved any more: what is still too near then is a hit.
_FINE = 5e-7


def keeps_distance(floor: Floor, path: Path) -> bool:
    """Whether the path stays in the box and keeps every part's distance, with no exception between samples.

    A point of a bend lies within max|curvature| h^2 / 8 of the chord over its arc length h. A bend that
    touches may be refused, if it comes nearer than about a millionth of a metre.
    """
    if not _in_box(floor, path):
        return False
    bends = np.abs(path.pieces[:, 1:]).max(axis=1, initial=0.0)
    lines = np.flatnonzero(bends == 0)
    segments = np.hstack([path.poses[lines, :2], path.poses[lines + 1, :2]])
    if len(floor.hit_parts(segments)):
        return False
    s, bend = _first_chords(path, bends)
    while len(s):
        error = bend * (s[:, 1] - s[:, 0]) ** 2 / 8
        ends = path.point(s.ravel()).reshape(-1, 4)
        near = floor.is_hit(ends, error)
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


def _in_box(floor: Floor, path: Path) -> bool:
    """Ends of pieces in the box, and bends nowhere farther out than their chords' error."""
    xmin, ymin, xmax, ymax = floor.grown.box
    s, bend = _first_chords(path, np.abs(path.pieces[:, 1:]).max(axis=1, initial=0.0))
    error = np.concatenate([np.zeros(len(path.breaks)), np.repeat(bend * (s[:, 1] - s[:, 0]) ** 2 / 8, 2)])
    x, y = np.concatenate([path.poses[:, :2], path.point(s.ravel())]).T
    slack = 1e-9
    return bool(
        np.all(x - error >= xmin - slack)
        and np.all(x + error <= xmax + slack)
        and np.all(y - error >= ymin - slack)
        and np.all(y + error <= ymax + slack)
    )
