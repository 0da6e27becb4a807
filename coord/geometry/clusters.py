"""Which obstacles hang together for a robot, where they stand on a line, and what they are called."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import shapely

from coord.geometry.growth import Grown
from coord.geometry.index import connected
from coord.geometry.shapes import core
from coord.model.arrays import Point
from coord.model.obstacle import Obstacle


def clusters(grown: Grown) -> npt.NDArray[np.intp]:
    """For each part the number of its cluster (m,): parts between which the robot cannot pass, directly or in a chain.

    A cluster is called by the least of its parts.
    """
    count = len(grown.parts)
    if not count:
        return np.empty(0, dtype=np.intp)
    bounds, rho = shapely.bounds(grown.parts), grown.rho[:, None]
    boxes = shapely.box(*np.hstack([bounds[:, :2] - rho, bounds[:, 2:] + rho]).T)
    a, b = shapely.STRtree(boxes).query(boxes, predicate="intersects")
    a, b = a[a < b], b[a < b]
    closed = shapely.dwithin(grown.parts[a], grown.parts[b], grown.rho[a] + grown.rho[b])
    return connected(count, a[closed], b[closed])


def anchor(grown: Grown, parts: npt.NDArray[np.intp], start: Point, goal: Point) -> Point:
    """A place in one of some parts' cores [m]: in the middle of the longest stretch of the line that runs through one.

    Where the line runs through none, the place of the cores that is nearest to the line.
    """
    line = shapely.LineString([start, goal])
    shapes = grown.parts[parts]
    chords = shapely.get_parts(shapely.intersection(shapes, line))
    lengths = shapely.length(chords)
    if len(lengths) and lengths.max() > 0:
        x, y = shapely.get_coordinates(chords[int(lengths.argmax())]).mean(axis=0)
        return (float(x), float(y))
    nearest = int(shapely.distance(shapes, line).argmin())
    x, y = shapely.get_coordinates(shapely.shortest_line(shapes[nearest], line))[0]
    return (float(x), float(y))


def reaches_edge(grown: Grown, parts: npt.NDArray[np.intp]) -> bool:
    """Whether there is no room for the robot between some of the parts and the edge of the workspace."""
    bounds, rho = shapely.bounds(grown.parts[parts]), grown.rho[parts, None]
    xmin, ymin, xmax, ymax = grown.box
    low, high = bounds[:, :2] - rho, bounds[:, 2:] + rho
    return bool(np.any(low < [xmin, ymin]) or np.any(high > [xmax, ymax]))


def names_of(obstacles: Sequence[Obstacle], grown: Grown, parts: npt.NDArray[np.intp]) -> list[str]:
    """The obstacles that some parts were made from, in their own order."""
    tree = shapely.STRtree(np.array([core(obstacle)[0] for obstacle in obstacles], dtype=object))
    touched = np.unique(tree.query(grown.parts[parts], predicate="intersects")[1])
    return [obstacles[k].name for k in touched.tolist()]
