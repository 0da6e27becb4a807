"""A slow and simple second way to shortest paths, and floors to try both on."""

from __future__ import annotations

import heapq
import math

import numpy as np
import pytest
import shapely

from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.paths.skeleton import NoWay, search_floor, skeleton
from coord.paths.taut import taut
from coord.tolerances import PLANNING_MARGIN


def _shape(obstacle):
    if isinstance(obstacle, Circle):
        return shapely.Point(obstacle.center), obstacle.radius
    return shapely.Polygon(obstacle.vertices, obstacle.holes), 0.0


def _regular(center, radius, count, phase):
    angles = phase + 2 * np.pi * np.arange(count) / count
    return shapely.Polygon(np.asarray(center) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))


def _grown(obstacle, reach, sides, factor):
    """The obstacle swept by a regular polygon of radius factor x reach: hulls along its edges, united with itself."""
    core, radius = _shape(obstacle)
    if isinstance(obstacle, Circle):
        return _regular(obstacle.center, (radius + reach) * factor, sides, 0.1)
    parts = [core]
    for ring in obstacle.rings:
        for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            ends = [_regular(end, reach * factor, sides, 0.1) for end in (a, b)]
            parts.append(shapely.convex_hull(shapely.union_all(ends)))
    return shapely.union_all(parts)


def _visibility(obstacles, bounds, reach, start, goal, sides, factor):
    """Length of the shortest polyline round obstacles grown by polygons; infinite where there is none."""
    block = shapely.union_all([_grown(obstacle, reach, sides, factor) for obstacle in obstacles])
    xmin, ymin, xmax, ymax = bounds
    corners = []
    for part in shapely.get_parts(block):
        oriented = shapely.orient_polygons(part)
        rings = [oriented.exterior, *oriented.interiors]
        for ring in rings:
            at = shapely.get_coordinates(ring)[:-1]
            before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
            convex = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] > 0
            corners.append(at[convex])
    at = np.vstack([np.array([start, goal]), *corners])
    inside = (at >= np.array([xmin, ymin]) + reach) & (at <= np.array([xmax, ymax]) - reach)
    at = at[inside.all(axis=1)]
    a, b = np.triu_indices(len(at), 1)
    shapely.prepare(block)
    lines = shapely.linestrings(np.stack([at[a], at[b]], axis=1))
    # a line may run along the boundary and touch corners, but not through the inside
    free = ~shapely.intersects(block, lines)
    doubt = np.flatnonzero(~free)
    free[doubt] = [bool(shapely.relate_pattern(block, line, "F********")) for line in lines[doubt]]
    length = np.where(free, np.hypot(*(at[a] - at[b]).T), np.inf)
    table = np.full((len(at), len(at)), np.inf)
    table[a, b] = table[b, a] = length
    best, heap, done = np.full(len(at), np.inf), [(0.0, 0)], np.zeros(len(at), bool)
    best[0] = 0.0
    while heap:
        d, k = heapq.heappop(heap)
        if done[k]:
            continue
        done[k] = True
        nearer = np.flatnonzero(d + table[k] < best)
        best[nearer] = d + table[k, nearer]
        for m in nearer.tolist():
            heapq.heappush(heap, (float(best[m]), m))
    return float(best[1])


@pytest.fixture(scope="session")
def sandwich():
    """(obstacles, bounds, reach, start, goal, sides) -> lengths of which the true shortest one lies between."""

    def both(obstacles, bounds, reach, start, goal, sides=24):
        wide = 1 / math.cos(math.pi / sides)
        return (
            _visibility(obstacles, bounds, reach, start, goal, sides, 1.0),
            _visibility(obstacles, bounds, reach + 2 * PLANNING_MARGIN, start, goal, sides, wide),
        )

    return both


@pytest.fixture(scope="session")
def route():
    """(obstacles, bounds, reach, start, goal) -> skeleton and path, or None where there is no way."""

    def find(obstacles, bounds, reach, start, goal):
        floor = search_floor(grow(obstacles, Footprint(reach), 0.0, bounds), (start, goal))
        found = skeleton(floor, start, goal)
        return None if isinstance(found, NoWay) else (found, taut(found, floor))

    return find


@pytest.fixture(scope="session")
def keeps_clear():
    """Asserts that a path keeps its reach from everything and leads from start to goal, at places 2 mm apart."""

    def check(path, obstacles, bounds, reach, start, goal):
        at = path.point(np.linspace(0.0, path.length, max(200, int(path.length / 0.002))))
        assert np.hypot(*(at[0] - start)) < 1e-9
        assert np.hypot(*(at[-1] - goal)) < 1e-9
        points = shapely.points(at)
        for obstacle in obstacles:
            core, radius = _shape(obstacle)
            assert shapely.distance(core, points).min() >= radius + reach - 1e-9
        assert np.all(at >= np.array(bounds[:2]) + reach - 1e-9)
        assert np.all(at <= np.array(bounds[2:]) - reach + 1e-9)

    return check


BOUNDS = (0.0, 0.0, 20.0, 15.0)


def _obstacle(rng, k):
    x, y = rng.uniform((3, 2), (17, 13))
    kind = rng.integers(4)
    if kind == 0:
        return Circle(f"o{k}", (x, y), rng.uniform(0.2, 2.0))
    if kind == 1:
        w, h = rng.uniform(0.2, 5.0, 2)
        return rectangle(f"o{k}", (x - w / 2, y - h / 2, x + w / 2, y + h / 2), rng.uniform(-3, 3) * rng.integers(2))
    count = rng.integers(3, 9)
    angles = np.sort(rng.uniform(0, 2 * np.pi, count)) + np.linspace(0, 1e-3, count)
    gaps = np.diff(np.append(angles, angles[0] + 2 * np.pi))
    if gaps.max() > np.pi - 0.2 or gaps.min() < 0.05:
        return Circle(f"o{k}", (x, y), 0.7)
    radii = rng.uniform(0.3, 2.8, count) if kind == 2 else np.full(count, rng.uniform(0.5, 2.5))
    return Polygon(f"o{k}", np.array([x, y]) + radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1))


@pytest.fixture(scope="session")
def floors():
    """(seed, obstacles) -> obstacles that may overlap, bounds, reach, and a free start and goal far apart."""

    def make(seed, most):
        rng = np.random.default_rng(seed)
        obstacles = [_obstacle(rng, k) for k in range(rng.integers(1, most + 1))]
        reach = rng.uniform(0.15, 0.6)

        def free(x_low, x_high):
            while True:
                place = rng.uniform((x_low, reach), (x_high, 15 - reach))
                point = shapely.Point(place)
                if all(core.distance(point) >= radius + reach for core, radius in map(_shape, obstacles)):
                    return tuple(place.tolist())

        return obstacles, BOUNDS, reach, free(reach, 4), free(16, 20 - reach)

    return make
