"""Problems in which robots stand in each other's way, always the same for the same kind and number.

Five kinds: dense ``crowds``; ``rings`` of handed-over places; ``swaps``, head-on pairs on lines that may cross, or all
through one hub; ``doors``, a wall with a gap as wide as one robot or two; ``corridors`` between two rooms, some with a
bay. Each has 2 to 60 robots. Of five problems of a size one has squares, and in one robots leave on arrival.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from coord.model.footprint import Footprint, square
from coord.model.obstacle import Obstacle, rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot

#: Robots of the problems of each kind; the list begins anew at its end, with other seeds.
SIZES = (2, 2, 3, 3, 4, 4, 5, 6, 6, 8, 8, 10, 12, 14, 16, 20, 24, 30, 40, 60)

#: [m] Kept between robots, and from walls.
CLEARANCE = 0.05

#: [m] Half the width of every robot.
HALF = 0.3

#: [m] What a place needs beside others of its sort: a square turned against another reaches farthest.
APART = 2 * HALF * math.sqrt(2) + CLEARANCE + 0.01

#: Which of the problems of one size have squares, and in which robots leave on arrival.
_SQUARES, _LEAVE, _TURNS = 3, 4, 5

#: Places tried before a floor is called too full.
_MOST_TRIES = 20000

#: Robots at the rim of one hub.
_MOST_AT_A_HUB = 20

Pair = tuple[float, float]
Box = tuple[float, float, float, float]
Trips = list[tuple[Pair, Pair]]
Scene = tuple[Box, Trips, tuple[Obstacle, ...]]


def crowded(kind: str, number: int) -> Problem:
    """The problem of a kind with this number, from 0 on.

    Raises
    ------
    ValueError
        When there is no room for so many places, which no number below 1000 was seen to do.
    """
    rng = np.random.default_rng((list(KINDS).index(kind), number))
    turn, which = divmod(number, len(SIZES))
    bounds, trips, obstacles = KINDS[kind](SIZES[which], turn, rng)
    body = square(2 * HALF) if turn % _TURNS == _SQUARES else Footprint(HALF)
    robots = []
    for k, (start, goal) in enumerate(trips):
        speed, acceleration = rng.choice([0.8, 1.0, 1.5]), rng.choice([0.5, 1.0])
        limits = Limits(float(speed), float(acceleration), float(acceleration), 2.0, 1.0)
        release = float(rng.choice([0.0, 0.0, 0.0, 3.0]))
        robots.append(Robot(f"r{k:02d}", body, limits, _rounded(start), _rounded(goal), release=release))
    after = "leave" if turn % _TURNS == _LEAVE else "stay"
    return Problem(f"{kind} {number}", Workspace(bounds, CLEARANCE, after), tuple(robots), obstacles)


def _crowds(count: int, turn: int, rng: np.random.Generator) -> Scene:
    """Starts and goals anywhere on 5, 8 or 12 m2 a robot."""
    side = 2.0 + math.sqrt(count * (5.0, 8.0, 12.0)[turn % 3])
    floor = (0.0, 0.0, side, side)
    return floor, list(zip(_places(floor, count, rng), _places(floor, count, rng), strict=True)), ()


def _rings(count: int, turn: int, rng: np.random.Generator) -> Scene:
    """Rings of places, each robot going to the next place; one ring of all, or rings of 2 to 6 beside each other."""
    sizes = [count] if turn % 3 == 0 and count <= _MOST_AT_A_HUB else _parts(count, rng)
    trips: Trips = []
    across = math.ceil(math.sqrt(len(sizes)))
    radii = [max(1.0, 0.9 / math.sin(math.pi / size)) * float(rng.uniform(1.0, 2.0)) for size in sizes]
    pitch = 2 * max(radii) + 2.0
    for k, (size, radius) in enumerate(zip(sizes, radii, strict=True)):
        middle = ((k % across + 0.5) * pitch, (k // across + 0.5) * pitch)
        first = rng.uniform(0.0, 2 * math.pi)
        at = [_on_circle(middle, radius, first + 2 * math.pi * m / size) for m in range(size)]
        trips += [(at[m], at[(m + 1) % size]) for m in range(size)]
    return (0.0, 0.0, across * pitch, math.ceil(len(sizes) / across) * pitch), trips, ()


def _swaps(count: int, turn: int, rng: np.random.Generator) -> Scene:
    """Pairs that swap their places: through one hub, beside each other, or anywhere, each across the others' lines."""
    pairs = max(count // 2, 1)
    if turn % 3 == 0 and count <= _MOST_AT_A_HUB:
        radius = max(3.0, 2 * pairs * 1.2 / (2 * math.pi))
        middle = (radius + 2.0, radius + 2.0)
        turns = [math.pi * k / pairs + float(rng.uniform(-0.05, 0.05)) / pairs for k in range(pairs)]
        ends = [(_on_circle(middle, radius, a), _on_circle(middle, radius, a + math.pi)) for a in turns]
        return (0.0, 0.0, 2 * radius + 4.0, 2 * radius + 4.0), [trip for a, b in ends for trip in ((a, b), (b, a))], ()
    if turn % 3 == 1:
        gap, length = float(rng.uniform(1.6, 3.0)), float(rng.uniform(4.0, 10.0))
        rows = [1.5 + gap * k for k in range(pairs)]
        ends = [((1.5, y), (1.5 + length, y + float(rng.uniform(-0.2, 0.2)))) for y in rows]
        floor = (0.0, 0.0, length + 3.0, rows[-1] + 1.5)
    else:
        side = 3.0 + math.sqrt(count * 12.0)
        floor = (0.0, 0.0, side, side)
        places = _places(floor, 2 * pairs, rng)
        ends = list(zip(places[::2], places[1::2], strict=True))
    return floor, [trip for a, b in ends for trip in ((a, b), (b, a))], ()


def _doors(count: int, turn: int, rng: np.random.Generator) -> Scene:
    """A wall across the floor with a gap for one robot or for two; everybody goes to the other side."""
    deep = 2.0 + math.sqrt(count * 5.0)
    gap = _width(1 + turn % 2) + float(rng.uniform(0.02, 0.2))
    at = float(rng.uniform(1.0, deep - 1.0 - gap))
    walls = (
        rectangle("wall, lower part", (deep, 0.0, deep + 0.3, at)),
        rectangle("wall, upper part", (deep, at + gap, deep + 0.3, deep)),
    )
    left, right = (0.0, 0.0, deep, deep), (deep + 0.3, 0.0, 2 * deep + 0.3, deep)
    return (0.0, 0.0, right[2], deep), _to_and_fro(left, right, count, rng), walls


def _corridors(count: int, turn: int, rng: np.random.Generator) -> Scene:
    """Two rooms, a corridor for one robot or for two between them, in every other problem with a bay in the middle."""
    deep, length = 2.0 + math.sqrt(count * 4.0), float(rng.uniform(3.0, 8.0))
    width = _width(2 if turn % 3 == 2 else 1) + float(rng.uniform(0.02, 0.2))
    low, x = (deep - width) / 2, deep + length
    bay = _width(1) + 0.3
    walls: list[Obstacle] = [rectangle("lower wall", (deep, 0.0, x, low))]
    if rng.integers(2) and low + width + bay < deep:
        middle = deep + length / 2
        walls += [
            rectangle("upper wall, left", (deep, low + width, middle - bay, deep)),
            rectangle("upper wall, right", (middle + bay, low + width, x, deep)),
            rectangle("upper wall, bay", (middle - bay, low + width + bay, middle + bay, deep)),
        ]
    else:
        walls.append(rectangle("upper wall", (deep, low + width, x, deep)))
    left, right = (0.0, 0.0, deep, deep), (x, 0.0, x + deep, deep)
    return (0.0, 0.0, x + deep, deep), _to_and_fro(left, right, count, rng), tuple(walls)


#: What there is, by name.
KINDS: dict[str, Callable[[int, int, np.random.Generator], Scene]] = {
    "crowds": _crowds,
    "rings": _rings,
    "swaps": _swaps,
    "doors": _doors,
    "corridors": _corridors,
}


def _to_and_fro(left: Box, right: Box, count: int, rng: np.random.Generator) -> Trips:
    """Trips from one room to the other, some of them to places where others start."""
    forth = count - count // 2
    here, there = _places(left, forth, rng), _places(right, count - forth, rng)
    goals_there = _goals(there, forth, right, rng)
    goals_here = _goals(here, count - forth, left, rng)
    return [*zip(here, goals_there, strict=True), *zip(there, goals_here, strict=True)]


def _goals(starts: Sequence[Pair], count: int, room: Box, rng: np.random.Generator) -> list[Pair]:
    """Goals in a room: in one of two problems the places of those who start there, as far as they suffice."""
    taken = [starts[k] for k in rng.permutation(len(starts)).tolist()][:count] if rng.integers(2) else []
    return taken + _places(room, count - len(taken), rng, taken)


def _places(floor: Box, count: int, rng: np.random.Generator, taken: Sequence[Pair] = ()) -> list[Pair]:
    """Places on a floor, away from its edge, from each other and from those taken."""
    xmin, ymin, xmax, ymax = floor
    rim = HALF * math.sqrt(2) + CLEARANCE + 0.01
    found = list(taken)
    for _ in range(_MOST_TRIES):
        if len(found) == count + len(taken):
            return found[len(taken) :]
        x, y = rng.uniform((xmin + rim, ymin + rim), (xmax - rim, ymax - rim)).tolist()
        if all(math.hypot(x - u, y - v) >= APART for u, v in found):
            found.append((x, y))
    raise ValueError(f"no room for {count} places in {_MOST_TRIES} tries")


def _parts(count: int, rng: np.random.Generator) -> list[int]:
    """Numbers from 2 to 6 that add up to a number, or to one less than that where it leaves one over."""
    parts = []
    while count >= 2:
        parts.append(min(int(rng.integers(2, 7)), count))
        count -= parts[-1]
    return parts


def _width(robots: int) -> float:
    """What so many robots beside each other need between two walls [m]."""
    return robots * 2 * HALF + (robots + 1) * CLEARANCE


def _on_circle(middle: Pair, radius: float, angle: float) -> Pair:
    return (middle[0] + radius * math.cos(angle), middle[1] + radius * math.sin(angle))


def _rounded(place: Pair) -> Pair:
    return (round(place[0], 4), round(place[1], 4))
