"""What shuts a place in: for the sentence that explains why there is no way. Approximate, to a thousandth."""

from __future__ import annotations

from collections.abc import Sequence

import shapely

from coord.geometry.shapes import Geometry, core
from coord.model.arrays import Point
from coord.model.obstacle import Obstacle

#: Segments a quarter circle for the free space, which is only looked at, never planned in.
_ROUNDNESS = 16

#: [m] Obstacles this near to the edge of the room count as its walls.
_WALL = 0.02


def enclosing(
    obstacles: Sequence[Obstacle], bounds: tuple[float, float, float, float], reach: float, start: Point, goal: Point
) -> tuple[str, list[str], float | None]:
    """Which end is shut in, the names of the obstacles around it, and the largest reach [m] that gets through.

    The smaller of the two rooms is the one that is shut in. The reach is None where not even a point gets through.
    """
    cores = [core(obstacle) for obstacle in obstacles]
    rooms = [_room(cores, bounds, reach, place) for place in (start, goal)]
    which = 1 if rooms[1].area <= rooms[0].area else 0
    near = [
        obstacle.name
        for obstacle, (shape, radius) in zip(obstacles, cores, strict=True)
        if rooms[which].area > 0 and shapely.distance(shape, rooms[which]) <= radius + reach + _WALL
    ]
    low, high = 0.0, reach
    if not _joined(cores, bounds, low, start, goal):
        return ("start", "goal")[which], near, None
    for _ in range(12):
        middle = (low + high) / 2
        low, high = (middle, high) if _joined(cores, bounds, middle, start, goal) else (low, middle)
    return ("start", "goal")[which], near, low


def _joined(
    cores: list[tuple[Geometry, float]], bounds: tuple[float, float, float, float], reach: float, a: Point, b: Point
) -> bool:
    return bool(_room(cores, bounds, reach, a).covers(shapely.Point(b)))


def _room(
    cores: list[tuple[Geometry, float]], bounds: tuple[float, float, float, float], reach: float, place: Point
) -> Geometry:
    """The connected free space around a place."""
    xmin, ymin, xmax, ymax = bounds
    grown = [shapely.buffer(shape, radius + reach, quad_segs=_ROUNDNESS) for shape, radius in cores]
    whole = shapely.box(xmin + reach, ymin + reach, xmax - reach, ymax - reach)
    free = shapely.difference(whole, shapely.union_all(grown))
    point = shapely.Point(place)
    for part in shapely.get_parts(free):
        if part.covers(point):
            return part
    return shapely.Polygon()
