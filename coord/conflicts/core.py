"""What the difference of two robots' places must keep away from: a point for two discs, else a convex polygon.

Footprints K_i = core_i (+) ball(margin_i), at x_i, come nearer than the clearance exactly where x_i - x_j lies
nearer than margin_i + margin_j + clearance to the convex core_j (+) (-core_i), (+) the Minkowski sum.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final, TypeAlias

import numpy as np

from coord.model.arrays import Array, Point

#: A convex polygon, counter-clockwise [m], or a single point.
Core: TypeAlias = tuple[Point, ...]

#: The core of two discs.
POINT: Final[Core] = ((0.0, 0.0),)

#: [m] A vertex this near to the line through its neighbours is no corner; 1e-9 m is what distances must keep.
_FLAT = 1e-12


@lru_cache(maxsize=1024)
def conflict_core(ego: Core, other: Core) -> Core:
    """The core other (+) (-ego) of what ego's place, seen from the other's, must keep away from [m].

    Counter-clockwise, without vertices on an edge; a point where both cores are points.
    """
    corners = _hull((q[0] - p[0], q[1] - p[1]) for p in ego for q in other)
    k = 0
    while len(corners) > 2 and k < len(corners):
        # one at a time: of two corners at one place, either is flat only as long as the other is there
        if _height(corners[k - 1], corners[k], corners[(k + 1) % len(corners)]) <= _FLAT:
            del corners[k]
            k = max(k - 1, 0)
        else:
            k += 1
    return tuple(corners)


def swept(core: Array, way: Array) -> Array:
    """The convex polygons that a core (n, 2) sweeps on straight ways (m, 2): (m, 2 n, 2), counter-clockwise.

    The Minkowski sum of core and way: vertices between edges that face the way are moved, those between edges that
    do not are left, and those in between are both. Most vertices occur twice.
    """
    edge = np.roll(core, -1, axis=0) - core
    ahead = (edge[:, 1] * way[:, :1] - edge[:, 0] * way[:, 1:] > 0)[..., None]
    moved = [core + way[:, None] * side for side in (np.roll(ahead, 1, axis=1), ahead)]
    return np.stack(moved, axis=2).reshape(len(way), 2 * len(core), 2)


def _hull(points: Iterable[Point]) -> list[Point]:
    """The convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted(set(points))
    return ordered if len(ordered) < 3 else _chain(ordered) + _chain(ordered[::-1])


def _chain(points: Sequence[Point]) -> list[Point]:
    """The part of the hull to the right of the way from the first point to the last, which is left out."""
    chain: list[Point] = []
    for point in points:
        while len(chain) > 1 and _cross(chain[-2], chain[-1], point) <= 0:
            chain.pop()
        chain.append(point)
    return chain[:-1]


def _height(a: Point, b: Point, c: Point) -> float:
    """How far b lies to the right of the line from a to c [m]; 0 where a and c are one place."""
    length = float(np.hypot(c[0] - a[0], c[1] - a[1]))
    return _cross(a, b, c) / length if length > 0 else 0.0


def _cross(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
