"""Shapes to draw: the line of a path, arrowheads on it, the band of floor that a disc sweeps."""

from __future__ import annotations

import math

import numpy as np

from coord.model.arrays import Array
from coord.model.path import Path

#: [rad] Bends are drawn as chords that turn by this much.
_CHORD = 0.06


def line(path: Path) -> Array:
    """Poses (n, 3) along a path, close enough together that its bends look round."""
    s = [0.0]
    for (length, k0, k1), begin in zip(path.pieces.tolist(), path.breaks.tolist(), strict=False):
        count = math.ceil(max(abs(k0), abs(k1)) * length / _CHORD) + 1
        s += [begin + length * k / count for k in range(1, count + 1)]
    return path.pose(s)


def band(path: Path, radius: float) -> Array:
    """Outline (n, 2) of the floor that a disc of this radius sweeps along a path."""
    poses = line(path)
    cap = np.linspace(-math.pi / 2, math.pi / 2, 24)
    first, last = poses[0], poses[-1]
    right = [(x + radius * math.sin(h), y - radius * math.cos(h)) for x, y, h in poses.tolist()]
    left = [(2 * x - u, 2 * y - v) for (x, y, _), (u, v) in zip(poses.tolist(), right, strict=True)]
    front = last[:2] + radius * np.column_stack([np.cos(last[2] + cap), np.sin(last[2] + cap)])
    back = first[:2] - radius * np.column_stack([np.cos(first[2] + cap), np.sin(first[2] + cap)])
    return np.concatenate([right, front, left[::-1], back])


def arrowheads(way: Array, size: float, spacing: float) -> list[Array]:
    """Triangles (3, 2) along a line (n, 2) that show its direction, about ``spacing`` [m] apart."""
    steps = np.diff(way, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    s = np.concatenate([[0.0], np.cumsum(lengths)])
    if s[-1] < 2 * size:
        return []
    count = max(1, int(s[-1] / spacing))
    heads = []
    for at in ((np.arange(count) + 0.5) * s[-1] / count).tolist():
        k = min(int(np.searchsorted(s, at, side="right")) - 1, len(steps) - 1)
        ahead = steps[k] / lengths[k]
        aside = np.array([-ahead[1], ahead[0]])
        centre = way[k] + (at - s[k]) * ahead
        heads.append(
            np.array([centre + size * ahead, centre - size * (ahead - aside) / 2, centre - size * (ahead + aside) / 2])
        )
    return heads
