"""Shapes to draw: the line of a path, the band of floor a robot sweeps, the reach of obstacles."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from coord.model.arrays import Array
from coord.model.obstacle import Circle, Obstacle
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


class Field(NamedTuple):
    """Distances over the floor: x (n,), y (m,), distance (m, n) [m]."""

    x: Array
    y: Array
    distance: Array


def distance_field(obstacles: tuple[Obstacle, ...], bounds: tuple[float, float, float, float], reach: float) -> Field:
    """The distance to the nearest outline of an obstacle on a grid, right where it is below ``reach`` [m].

    For drawing only: the line at a level of this field is the border of grown obstacles, united.
    """
    xmin, ymin, xmax, ymax = bounds
    cell = max(xmax - xmin, ymax - ymin) / 700
    x, y = np.arange(xmin, xmax + cell, cell), np.arange(ymin, ymax + cell, cell)
    distance = np.full((len(y), len(x)), 2 * reach)
    for obstacle in obstacles:
        if isinstance(obstacle, Circle):
            (cx, cy), r = obstacle.center, obstacle.radius
            window = _window(x, y, (cx - r, cy - r, cx + r, cy + r), 2 * reach)
            far = np.hypot(x[window[1]] - cx, (y[window[0]] - cy)[:, None]) - r
            distance[window] = np.minimum(distance[window], far)
            continue
        for ring in obstacle.rings:
            for a, b in pairwise([*ring.tolist(), ring[0].tolist()]):
                _lower(distance, x, y, a, b, 2 * reach)
    return Field(x, y, distance)


def _lower(distance: Array, x: Array, y: Array, a: list[float], b: list[float], margin: float) -> None:
    """Lower the field to the distance from the edge a-b, near it."""
    (ax, ay), (bx, by) = a, b
    window = _window(x, y, (min(ax, bx), min(ay, by), max(ax, bx), max(ay, by)), margin)
    u, v = x[window[1]] - ax, (y[window[0]] - ay)[:, None]
    dx, dy = bx - ax, by - ay
    squared = dx * dx + dy * dy
    along = np.clip((u * dx + v * dy) / squared, 0.0, 1.0) if squared else np.zeros_like(u + v)
    distance[window] = np.minimum(distance[window], np.hypot(u - along * dx, v - along * dy))


def _window(x: Array, y: Array, box: tuple[float, float, float, float], margin: float) -> tuple[slice, slice]:
    columns = np.searchsorted(x, [box[0] - margin, box[2] + margin])
    rows = np.searchsorted(y, [box[1] - margin, box[3] + margin])
    return slice(int(rows[0]), int(rows[1])), slice(int(columns[0]), int(columns[1]))
