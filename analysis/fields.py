"""Random floors and random robots on them, always the same for the same seed.

Fields hold rectangles, straight and turned, columns, convex and concave polygons, some of them touching and
overlapping each other. They are so dense that most straight lines are blocked, and so sparse that there mostly is
a way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely

from coord.geometry.blocked import Floor
from coord.geometry.growth import grow
from coord.model.footprint import Footprint, square
from coord.model.obstacle import Circle, Obstacle, Polygon, rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.skeleton import search_floor

#: [m2] Floor for each obstacle.
_ROOM = 8.0

#: [m] Starts and goals keep this much more than the distance, so that every search has its full margin.
_AIR = 1e-4

#: Places tried for a start or a goal before a field is called too full.
_MOST_TRIES = 2000

#: Corners of an L and of a U in the unit square, counter-clockwise.
_LETTERS = (
    ((0.0, 0.0), (1.0, 0.0), (1.0, 0.3), (0.35, 0.3), (0.35, 1.0), (0.0, 1.0)),
    ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.8, 1.0), (0.8, 0.2), (0.2, 0.2), (0.2, 0.9), (0.0, 0.9)),
)

Pair = tuple[float, float]
Making = Callable[[str, float, float, np.random.Generator], Obstacle]


@dataclass(frozen=True, slots=True)
class Field:
    """A floor with obstacles: its edge, the clearance kept on it, and what stands on it."""

    workspace: Workspace
    obstacles: tuple[Obstacle, ...]


def random_field(count: int, seed: int) -> Field:
    """A field of ``count`` obstacles on a square floor of 8 m2 for each."""
    rng = np.random.default_rng((seed, count))
    side = round(math.sqrt(_ROOM * count), 1)
    obstacles: list[Obstacle] = []
    for k in range(count):
        last = obstacles[-1] if obstacles else None
        if isinstance(last, Polygon) and rng.random() < 0.12:
            obstacles.append(_beside(f"o{k}", last, rng))
        else:
            x, y = rng.uniform(0.0, side, 2).tolist()
            obstacles.append(_KINDS[int(rng.integers(len(_KINDS)))](f"o{k}", x, y, rng))
    clearance = float(rng.choice([0.0, 0.05, 0.1]))
    return Field(Workspace((0.0, 0.0, side, side), clearance), tuple(obstacles))


def random_robot(field: Field, name: str, rng: np.random.Generator, shape: str = "disc") -> Robot:
    """A robot of 0.2 to 0.5 m, a "disc" or a "square" of that half side, from one free place to another far off.

    Raises
    ------
    ValueError
        When the field has no free places far from each other.
    """
    radius = round(float(rng.uniform(0.2, 0.5)), 3)
    footprint = square(2 * radius) if shape == "square" else Footprint(radius)
    speed, acceleration, deceleration, jerk, lateral = np.round(
        rng.uniform((0.5, 0.3, 0.3, 0.5, 0.3), (2.0, 1.0, 1.0, 2.0, 1.0)), 2
    ).tolist()
    limits = Limits(speed, acceleration, deceleration, jerk, lateral)
    xmin, _, xmax, _ = field.workspace.bounds
    start = _free_place(field, footprint, rng, None, 0.0)
    goal = _free_place(field, footprint, rng, start, 0.4 * (xmax - xmin))
    return Robot(name, footprint, limits, start, goal)


def problem_of(field: Field, robot: Robot) -> Problem:
    """The problem of one robot alone on a field."""
    return Problem(robot.name, field.workspace, (robot,), field.obstacles)


def floor_of(field: Field, robot: Robot) -> Floor:
    """The field as a search for the robot's path sees it: the one place that knows how coord grows obstacles."""
    grown = grow(field.obstacles, robot.footprint, field.workspace.clearance, field.workspace.bounds)
    return search_floor(grown, (robot.start, robot.goal))


def gap(field: Field, footprint: Footprint, place: Pair) -> float:
    """Distance [m] of a footprint at a place from the nearest obstacle and from the edge, 0 where they overlap."""
    x, y = place
    body = shapely.Point(place) if len(footprint.core) == 1 else shapely.Polygon(np.add(footprint.core, place))
    xs, ys = zip(*((x + dx, y + dy) for dx, dy in footprint.core), strict=True)
    xmin, ymin, xmax, ymax = field.workspace.bounds
    least = min(min(xs) - xmin, xmax - max(xs), min(ys) - ymin, ymax - max(ys))
    for obstacle in field.obstacles:
        is_round = isinstance(obstacle, Circle)
        core = shapely.Point(obstacle.center) if is_round else shapely.Polygon(obstacle.vertices, obstacle.holes)
        least = min(least, shapely.distance(core, body) - (obstacle.radius if is_round else 0.0))
    return float(least) - footprint.margin


def floor_plan(cells: int, seed: int) -> np.ndarray:
    """A made-up floor plan (cells, cells) of booleans, row 0 at the bottom: rooms, doors, pillars, tables, specks."""
    rng = np.random.default_rng((seed, cells))
    occupied = np.zeros((cells, cells), dtype=np.bool_)
    occupied[[0, 1, 2, -1, -2, -3], :] = occupied[:, [0, 1, 2, -1, -2, -3]] = True
    room, wall, door = cells // 10, 4, cells // 50
    for k in range(1, 10):
        for m in range(10):  # each wall between two rooms has a door of its own
            at, begin = k * room, m * room
            gate = begin + int(rng.integers(wall + 4, room - door - 4))
            occupied[at : at + wall, begin : begin + room + wall] = True
            occupied[at : at + wall, gate : gate + door] = False
            gate = begin + int(rng.integers(wall + 4, room - door - 4))
            occupied[begin : begin + room + wall, at : at + wall] = True
            occupied[gate : gate + door, at : at + wall] = False
    y, x = np.ogrid[:cells, :cells]
    for _ in range(300):
        row, column = rng.integers(room // 8, cells - room // 8, 2).tolist()
        if rng.random() < 0.5:
            height, width = rng.integers(6, room // 5, 2).tolist()
            occupied[row : row + height, column : column + width] = True
        else:
            size = int(rng.integers(3, room // 12))
            top, left = max(row - size, 0), max(column - size, 0)
            window = (slice(top, row + size + 1), slice(left, column + size + 1))
            occupied[window] |= (x[:, window[1]] - column) ** 2 + (y[window[0]] - row) ** 2 <= size**2
    specks = rng.integers(0, cells, (400, 2))
    occupied[specks[:, 0], specks[:, 1]] = True
    return occupied


def _free_place(field: Field, footprint: Footprint, rng: np.random.Generator, other: Pair | None, apart: float) -> Pair:
    xmin, ymin, xmax, ymax = field.workspace.bounds
    for _ in range(_MOST_TRIES):
        x, y = rng.uniform((xmin, ymin), (xmax, ymax)).tolist()
        is_apart = other is None or math.hypot(x - other[0], y - other[1]) >= apart
        if is_apart and gap(field, footprint, (x, y)) >= field.workspace.clearance + _AIR:
            return (x, y)
    raise ValueError(f"no free place in {_MOST_TRIES} tries; use fewer obstacles or another seed")


def _rectangle(name: str, x: float, y: float, rng: np.random.Generator) -> Obstacle:
    w, h = rng.uniform(0.3, 2.6, 2).tolist()
    return rectangle(name, (x - w / 2, y - h / 2, x + w / 2, y + h / 2))


def _turned(name: str, x: float, y: float, rng: np.random.Generator) -> Obstacle:
    w, h = rng.uniform(0.2, 2.6, 2).tolist()
    return rectangle(name, (x - w / 2, y - h / 2, x + w / 2, y + h / 2), float(rng.uniform(-1.5, 1.5)))


def _column(name: str, x: float, y: float, rng: np.random.Generator) -> Obstacle:
    return Circle(name, (x, y), float(rng.uniform(0.1, 1.0)))


def _convex(name: str, x: float, y: float, rng: np.random.Generator) -> Obstacle:
    cloud = rng.uniform(-1.2, 1.2, (int(rng.integers(5, 12)), 2)) * rng.uniform(0.4, 1.0, 2)
    hull = shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(cloud)))[:-1]
    return Polygon(name, hull + np.array([x, y]))


def _star(name: str, x: float, y: float, rng: np.random.Generator) -> Obstacle:
    count = int(rng.integers(5, 11))
    angles = 2 * np.pi * (np.arange(count) + rng.uniform(0.0, 0.8, count)) / count
    radii = rng.uniform(0.2, 1.5, count)
    return Polygon(name, radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1) + np.array([x, y]))


def _letter(name: str, x: float, y: float, rng: np.random.Generator) -> Obstacle:
    shape = (np.array(_LETTERS[int(rng.integers(2))]) - 0.5) * rng.uniform(0.8, 2.8, 2)
    turn = float(rng.uniform(-3.0, 3.0)) if rng.random() < 0.5 else 0.0
    c, s = math.cos(turn), math.sin(turn)
    return Polygon(name, shape @ np.array([[c, s], [-s, c]]) + np.array([x, y]))


def _beside(name: str, other: Polygon, rng: np.random.Generator) -> Obstacle:
    """A rectangle that touches another obstacle's box in an edge, in a corner, or overlaps it."""
    xmax, ymax = other.vertices.max(axis=0).tolist()
    w, h = rng.uniform(0.3, 1.5, 2).tolist()
    x = xmax - float(rng.choice([0.0, 0.2]))
    y = ymax - float(rng.choice([0.0, h / 2, h]))
    return rectangle(name, (x, y, x + w, y + h))


_KINDS: tuple[Making, ...] = (_rectangle, _turned, _column, _convex, _star, _letter)
