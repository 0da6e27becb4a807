"""The door of shapely: obstacles as exact shapes, and distances to them.

Round things stay exact: a shape is a *core* (a point or a polygon) plus a radius kept apart, never a polygon
that approximates an arc. Shapely drops coordinates that are not finite without a word; all numbers that come
here were checked before.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely

from coord.model.arrays import Array
from coord.model.obstacle import Circle, Obstacle
from coord.tolerances import DISTANCE

Geometry: TypeAlias = Any  # shapely has no types
Indices: TypeAlias = npt.NDArray[np.intp]


def core(obstacle: Obstacle) -> tuple[Geometry, float]:
    """What an obstacle is made of: its exact core, and the radius [m] to be added round it.

    A circle is its centre and its radius; a polygon is itself, holes included, and 0.
    """
    if isinstance(obstacle, Circle):
        return shapely.Point(obstacle.center), obstacle.radius
    return shapely.Polygon(obstacle.vertices, obstacle.holes), 0.0


def polygon_fault(vertices: Array) -> str | None:
    """Why an outline (n, 2) [m] is not simple, as a sentence that says where, or None when it is simple."""
    following = np.roll(vertices, -1, axis=0)
    repeated = np.flatnonzero((vertices == following).all(axis=1))
    if len(repeated):
        first, second = int(repeated[0]) + 1, (int(repeated[0]) + 1) % len(vertices) + 1
        x, y = vertices[repeated[0]]
        return f"vertices {first} and {second} are the same point ({x:g}, {y:g}); leave one of them out"
    reason = str(shapely.is_valid_reason(shapely.Polygon(vertices)))
    if reason == "Valid Geometry":
        return None
    place = re.search(r"\[(\S+) (\S+)\]", reason)
    where = f" at ({float(place[1]):g}, {float(place[2]):g})" if place else ""
    return f"the outline crosses or touches itself{where}; an outline must be simple"


def distances(geometry: Geometry, points: Array) -> Array:
    """Distances (n,) [m] from a shape to points (n, 2); 0 for points in it."""
    return np.asarray(shapely.distance(geometry, shapely.points(points)), dtype=np.float64)


def part_distances(shapes: Geometry, points: Array) -> Array:
    """Least distances (m,) [m] of many shapes (m,) from any of the points (n, 2)."""
    return np.asarray(shapely.distance(shapes, shapely.multipoints(points)), dtype=np.float64)


def depths(geometry: Geometry, points: Array) -> Array:
    """How deep (n,) [m] points (n, 2) lie in a shape: their distance to its boundary, 0 for points outside."""
    places = shapely.points(points)
    to_boundary = shapely.distance(shapely.boundary(geometry), places)
    return np.where(shapely.covers(geometry, places), np.nan_to_num(to_boundary), 0.0)


def too_near(obstacles: Sequence[Obstacle], points: Array, reach: Array) -> tuple[Indices, Indices, Array]:
    """All pairs of a point and an obstacle that are nearer than the point's reach.

    Parameters
    ----------
    points : (n, 2) array [m].
    reach : (n,) array [m], the distance each point keeps; a distance equal to it is kept.

    Returns
    -------
    Indices (k,) of the points, indices (k,) of the obstacles, and signed distances (k,) [m] from the point
    to the obstacle's boundary, negative inside. Ordered by obstacle, then by point.
    """
    tree = shapely.STRtree(shapely.points(points))
    farthest = float(reach.max(initial=0.0))
    found: list[tuple[Indices, Indices, Array]] = []
    for k, obstacle in enumerate(obstacles):
        shape, radius = core(obstacle)
        xmin, ymin, xmax, ymax = shapely.bounds(shape)
        margin = farthest + radius
        near = np.sort(tree.query(shapely.box(xmin - margin, ymin - margin, xmax + margin, ymax + margin)))
        if not len(near):
            continue
        shapely.prepare(shape)  # a floor's outline has thousands of edges; prepared, few of them are looked at
        near = near[shapely.dwithin(shape, tree.geometries[near], reach[near] + radius)]
        signed = distances(shape, points[near]) - depths(shape, points[near]) - radius
        hit = signed < reach[near] - DISTANCE
        found.append((near[hit], np.full(int(hit.sum()), k, dtype=np.intp), signed[hit]))
    if not found:
        return np.empty(0, dtype=np.intp), np.empty(0, dtype=np.intp), np.empty(0)
    who, what, signed = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return who, what, signed
