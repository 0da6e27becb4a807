"""Obstacles grown by what a robot needs: exact cores, cut into parts, with the corners paths turn round.

A grown obstacle is a core and a distance rho to keep from it; it is never turned into a polygon. Polygons
that touch are merged first, so that no path is sought between them; large cores are cut into parts, so that a
search looks only at those near its way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import shapely

from coord.geometry.shapes import Geometry, core
from coord.model.arrays import Array
from coord.model.obstacle import Circle, Obstacle

#: Cores with more vertices are halved until no part has more.
_MOST_VERTICES = 64


@dataclass(frozen=True, slots=True, eq=False)
class Corners:
    """Where shortest paths may turn: round a vertex, at directions between the normals of its two edges.

    Parameters
    ----------
    places : (n, 2) array [m].
    first, span : (n,) arrays [rad], the directions from ``first`` counter-clockwise over ``span``; a circle's
        centre has all directions, span 2 pi.
    parts : (n,) indices of the parts they belong to.
    """

    places: Array
    first: Array
    span: Array
    parts: npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Grown:
    """The obstacles of a floor as seen by a robot.

    Parameters
    ----------
    parts : (m,) array of shapes; ``rho`` : (m,) distance [m] that the robot's centre keeps from each.
    corners : of all parts.
    edges : (e, 4) array [m], the segments of all parts (a point twice for a circle); ``edge_parts`` : (e,).
    box : xmin, ymin, xmax, ymax [m] of the places where the robot's centre may be.
    """

    parts: Geometry
    rho: Array
    corners: Corners
    edges: Array
    edge_parts: npt.NDArray[np.intp]
    box: tuple[float, float, float, float]


def grow(obstacles: Sequence[Obstacle], reach: float, bounds: tuple[float, float, float, float]) -> Grown:
    """Grow obstacles for a disc that keeps ``reach`` [m] (radius and clearance) from everything."""
    round_ones = [obstacle for obstacle in obstacles if isinstance(obstacle, Circle)]
    polygons = [core(obstacle)[0] for obstacle in obstacles if not isinstance(obstacle, Circle)]
    shapes = [part for whole in _merged(polygons) for part in _cut(whole)]
    parts = np.array([*shapes, *(shapely.Point(circle.center) for circle in round_ones)], dtype=object)
    rho = np.array([reach] * len(shapes) + [reach + circle.radius for circle in round_ones])
    edges, owners = _edges(parts)
    xmin, ymin, xmax, ymax = bounds
    box = (xmin + reach, ymin + reach, xmax - reach, ymax - reach)
    return Grown(parts, rho, _corners(parts), edges, owners, box)


def _merged(polygons: list[Geometry]) -> list[Geometry]:
    """Polygons united where they touch or overlap; those alone are left as they are, vertex by vertex."""
    if not polygons:
        return []
    tree = shapely.STRtree(polygons)
    a, b = tree.query(polygons, predicate="intersects")
    label = np.arange(len(polygons))
    while True:
        least = label.copy()
        np.minimum.at(least, a, label[b])
        least = least[least]
        if np.array_equal(least, label):
            break
        label = least
    merged = []
    for group in np.unique(label).tolist():
        members = [polygons[k] for k in np.flatnonzero(label == group)]
        merged += list(shapely.get_parts(shapely.union_all(members))) if len(members) > 1 else members
    return merged


def _cut(whole: Geometry) -> list[Geometry]:
    """Halve a polygon across its longer side until its parts are small."""
    if shapely.get_num_coordinates(whole) <= _MOST_VERTICES:
        return [whole]
    xmin, ymin, xmax, ymax = shapely.bounds(whole)
    if xmax - xmin >= ymax - ymin:
        middle = (xmin + xmax) / 2
        halves = [(xmin, ymin, middle, ymax), (middle, ymin, xmax, ymax)]
    else:
        middle = (ymin + ymax) / 2
        halves = [(xmin, ymin, xmax, middle), (xmin, middle, xmax, ymax)]
    pieces = [shapely.intersection(whole, shapely.box(*half)) for half in halves]
    polygons = [part for piece in pieces for part in shapely.get_parts(piece) if shapely.get_dimensions(part) == 2]
    return [part for polygon in polygons for part in _cut(polygon)]


def _corners(parts: Geometry) -> Corners:
    rows: list[tuple[float, float, float, float, int]] = []
    for index, part in enumerate(parts):
        if shapely.get_dimensions(part) == 0:
            rows.append((shapely.get_x(part), shapely.get_y(part), 0.0, 2 * np.pi, index))
            continue
        for ring in _rings(part):
            along = np.roll(ring, -1, axis=0) - ring
            before = np.roll(along, 1, axis=0)
            turn = np.arctan2(before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0], (before * along).sum(axis=1))
            first = np.arctan2(-before[:, 0], before[:, 1])  # outward normal: the edge turned clockwise
            convex = turn > 1e-12
            rows += [
                (*place, angle, span, index)
                for place, angle, span in zip(
                    ring[convex].tolist(), first[convex].tolist(), turn[convex].tolist(), strict=True
                )
            ]
    table = np.array(rows, dtype=np.float64).reshape(-1, 5)
    return Corners(table[:, :2], table[:, 2], table[:, 3], table[:, 4].astype(np.intp))


def _edges(parts: Geometry) -> tuple[Array, npt.NDArray[np.intp]]:
    edges: list[Array] = []
    for part in parts:
        if shapely.get_dimensions(part) == 0:
            point = shapely.get_coordinates(part)
            edges.append(np.hstack([point, point]))
        else:
            edges.append(np.vstack([np.hstack([ring, np.roll(ring, -1, axis=0)]) for ring in _rings(part)]))
    owners = np.repeat(np.arange(len(edges)), [len(own) for own in edges])
    return np.vstack([*edges, np.empty((0, 4))]), owners.astype(np.intp)


def _rings(polygon: Geometry) -> list[Array]:
    """Outline counter-clockwise and holes clockwise, without the repeated last vertex."""
    oriented = shapely.orient_polygons(polygon)
    rings = [shapely.get_exterior_ring(oriented)]
    rings += [shapely.get_interior_ring(oriented, k) for k in range(shapely.get_num_interior_rings(oriented))]
    return [shapely.get_coordinates(ring)[:-1] for ring in rings]
