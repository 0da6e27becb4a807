"""The door of shapely: obstacles as exact shapes, and distances to them.

Round things stay exact: a shape is a *core* (a point or a polygon) plus a radius kept apart, never a polygon
that approximates an arc. Shapely drops coordinates that are not finite without a word; all numbers that come
here were checked before.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely

from coord.model.arrays import Array, Point
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
    places = shapely.points(points)

    def signed(shape: Geometry, near: Indices) -> Array:
        return distances(shape, points[near]) - depths(shape, points[near])

    return _too_near(obstacles, places, reach, signed)


def _too_near(
    obstacles: Sequence[Obstacle], shapes: Geometry, reach: Array, signed: Callable[[Geometry, Indices], Array]
) -> tuple[Indices, Indices, Array]:
    """Pairs of shapes (n,) and obstacles nearer than the shapes' reach (n,) [m], as ``too_near`` gives them back.

    ``signed`` : signed distances [m] between an obstacle's core and some of the shapes, by index.
    """
    tree = shapely.STRtree(shapes)
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
        near = near[shapely.dwithin(shape, shapes[near], reach[near] + radius)]
        gaps = signed(shape, near) - radius
        hit = gaps < reach[near] - DISTANCE
        found.append((near[hit], np.full(int(hit.sum()), k, dtype=np.intp), gaps[hit]))
    if not found:
        return np.empty(0, dtype=np.intp), np.empty(0, dtype=np.intp), np.empty(0)
    who, what, gaps = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return who, what, gaps


def placed(points: Array, rings: Sequence[Sequence[Point]]) -> Geometry:
    """Convex shapes about (0, 0), each put at its point (n, 2) [m]; a ring of one vertex gives a point."""
    shapes = [np.add(ring, point) for ring, point in zip(rings, points, strict=True)]
    return np.array(
        [shapely.Polygon(ring) if len(ring) > 2 else shapely.Point(ring[0]) for ring in shapes], dtype=object
    )


def separation(first: Geometry, second: Geometry) -> float:
    """How far apart two convex shapes are [m]; negative: how far one would have to move for them to touch.

    Overlapping convex polygons part soonest across one of their edges (the separating axis theorem).
    """
    distance = float(shapely.distance(first, second))
    if distance > 0:
        return distance
    rings = [shapely.get_coordinates(shape) for shape in (first, second)]
    deepest = -np.inf  # two points have no edge
    for ring, other in (rings, rings[::-1]):
        along = np.diff(ring, axis=0)
        outwards = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.hypot(*along.T)[:, None]
        beyond = ((other[None, :] - ring[:-1, None]) * outwards[:, None]).sum(axis=2).min(axis=1)
        deepest = max(deepest, float(beyond.max(initial=-np.inf)))
    return min(deepest, 0.0) if np.isfinite(deepest) else 0.0


def nearer(first: Geometry, second: Geometry, need: Array) -> npt.NDArray[np.bool_]:
    """Which pairs of convex shapes (n,) are nearer to each other than they need to be (n,) [m]; touching is not."""
    gaps = np.asarray(shapely.distance(first, second), dtype=np.float64)
    for n in np.flatnonzero((gaps == 0) & (need <= DISTANCE)).tolist():
        gaps[n] = separation(first[n], second[n])
    return np.asarray(gaps < need - DISTANCE)


def meeting(shape: Geometry, ring: Sequence[Point]) -> Geometry:
    """Where the reference point of a convex footprint (n, 2) [m] is when it meets a shape: shape (+) (-footprint).

    Exact for concave shapes and holes too: the shape itself, united with the sum of each of its edges.
    """
    back = -np.asarray(ring, dtype=np.float64)
    if len(back) == 1:
        return shape  # of a footprint that counts as a disc, only the reference point
    corners = shapely.get_coordinates(shape)
    if len(corners) == 1:
        return shapely.convex_hull(shapely.MultiPoint(corners[0] + back))
    rings = [shapely.get_coordinates(line) for line in shapely.get_parts(shapely.boundary(shape))]
    ends = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in rings])
    swept = (ends[:, :, None] + back).reshape(len(ends), -1, 2)
    return shapely.union_all([shape, *shapely.convex_hull(shapely.linestrings(swept))])


def polygons_too_near(
    obstacles: Sequence[Obstacle], points: Array, rings: Sequence[Sequence[Point]], clearance: float
) -> tuple[Indices, Indices, Array]:
    """All pairs of a convex footprint that keeps its heading and an obstacle nearer to it than the clearance [m].

    Parameters
    ----------
    points : (n, 2) array [m] of reference points; rings : n footprints about them.

    Returns
    -------
    As ``too_near``: indices of footprints and obstacles, and signed distances [m] between them; negative: how
    far the footprint would have to move to be outside.
    """
    shapes = placed(points, rings)

    def signed(shape: Geometry, near: Indices) -> Array:
        gaps = np.asarray(shapely.distance(shape, shapes[near]), dtype=np.float64)
        met: dict[tuple[Point, ...], Geometry] = {}
        for n in np.flatnonzero(gaps == 0).tolist():
            ring = tuple(rings[near[n]])
            if ring not in met:
                met[ring] = meeting(shape, ring)
            gaps[n] = -float(depths(met[ring], points[near[n : n + 1]])[0])
        return gaps

    return _too_near(obstacles, shapes, np.full(len(points), clearance), signed)


def grown_outlines(obstacles: Sequence[Obstacle], ring: Sequence[Point], reach: float) -> list[Array]:
    """Where a footprint's reference point comes as near to obstacles as it may: rings (n, 2) [m], to look at only.

    Parameters
    ----------
    ring : the footprint's core, a convex polygon or a point. reach : distance [m] of the core from obstacles.

    Arcs are drawn as chords, which cut up to a thousandth of the radius off.
    """
    grown = [
        shapely.buffer(meeting(shape, ring), radius + reach, quad_segs=16) for shape, radius in map(core, obstacles)
    ]
    return _rings(shapely.union_all(grown))


def hull_outlines(rings: Array) -> list[Array]:
    """The floor that a convex footprint covers from pose to pose: rings (k, 2) [m], to look at only.

    Parameters
    ----------
    rings : (n, m, 2) array [m], the footprint at n poses that follow each other; between two it is taken to cover
        their convex hull, which is exact where it does not turn.
    """
    pairs = np.concatenate([rings[:-1], rings[1:]], axis=1) if len(rings) > 1 else rings
    return _rings(shapely.union_all(shapely.convex_hull(shapely.multipoints(pairs))))


def _rings(shape: Geometry) -> list[Array]:
    """All rings of a shape, outlines and holes in opposite senses, the first vertex not repeated."""
    lines = shapely.get_rings(shapely.get_parts(shapely.normalize(shape)))
    return [np.asarray(shapely.get_coordinates(line), dtype=np.float64)[:-1] for line in lines]
