"""Write the problems that are made by rule or from a seed: ``crossing/``, ``warehouse/`` and ``squares_*.toml``.

``python problems/generate.py`` writes the files, always with the same content; ``--check`` only says whether they
are up to date, and exits with 1 if not. Change a family here, never in its files.
"""

from __future__ import annotations

import argparse
import itertools
import math
import pathlib
import random
import sys
from collections.abc import Sequence
from typing import Final

from coord import Footprint, Limits, Path, Problem, Robot, Workspace, rectangle
from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.coordination.blocking import blocking_arcs
from coord.coordination.order import topological_order
from coord.paths.routes import find_routes

Point = tuple[float, float]
Line = tuple[Point, Point]
Box = tuple[float, float, float, float]

HERE: Final = pathlib.Path(__file__).parent
CLEARANCE: Final = 0.1

#: Robots, side of the square [m] and seed of each crossing problem.
CROSSINGS: Final = ((2, 8.0, 3), (4, 10.0, 6), (8, 12.0, 9), (16, 16.0, 8))
CROSSING_RADIUS: Final = 0.3
CROSSING_LIMITS: Final = Limits(1.0, 0.5, 0.5, 1.0, 0.5)

#: Robots, columns and rows of shelves and seed of each warehouse.
WAREHOUSES: Final = ((10, 3, 4, 8), (30, 5, 6, 4))
WAREHOUSE_RADIUS: Final = 0.35
WAREHOUSE_LIMITS: Final = Limits(1.5, 0.8, 0.8, 2.0, 0.8)
SHELF: Final = (6.0, 2.0)
AISLE: Final = 2.5
#: Side of the robots that keep their heading, left edge, width and gap of racks, lower edge, depth and gap of rows [m].
SQUARE: Final = 0.8
RACKS: Final = (2.0, 4.5, 1.1)
ROWS: Final = (1.6, 2.8, 2.4)

#: [m] Distance of starts and goals from shelves and edge, and shortest trip.
STAND_OFF: Final = 0.75
SHORTEST_TRIP: Final = 8.0


def main() -> int:
    """Write or check all files; the exit code."""
    parser = argparse.ArgumentParser(description="Write the problems that are made, not drawn by hand.")
    parser.add_argument("--check", action="store_true", help="write nothing, say which files are not up to date")
    check = parser.parse_args().check
    stale = []
    for name, text in problems().items():
        path = HERE / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
    words = "not up to date" if check else "written"
    sys.stdout.write("".join(f"{words}: {name}\n" for name in stale) or "all up to date\n")
    return 1 if check and stale else 0


def problems() -> dict[str, str]:
    """All problem files that are made here, by name."""
    texts = {f"crossing/crossing_{n:02}.toml": crossing(n, side, seed) for n, side, seed in CROSSINGS}
    texts |= {f"warehouse/warehouse_{n:02}.toml": warehouse(n, *rest) for n, *rest in WAREHOUSES}
    return texts | {"squares_fixed.toml": squares_fixed(), "squares_turning.toml": squares_turning()}


def crossing(count: int, side: float, seed: int) -> str:
    """Lines from edge to edge of an empty square; each crosses another and is clear of all other starts and goals."""
    rng = random.Random(seed)  # noqa: S311  a seeded draw, no secret
    lines: list[Line] = []
    while len(lines) < count:
        first, second = rng.sample(range(4), 2)
        line = (_on_edge(rng, first, side), _on_edge(rng, second, side))
        crosses = any(_cross(line, other) for other in lines) or not lines
        if crosses and math.dist(*line) >= 0.7 * side and all(_clear(line, other) for other in lines):
            lines.append(line)
    return _text(
        f"# {count} robots drive straight from edge to edge of an empty square. Every line is clear of every other",
        "# robot's start and goal, so any order works: only the speeds have to be found.",
        f"# Written by problems/generate.py (seed {seed}): change it there.",
        *_head(f"crossing {count:02}", (0.0, 0.0, side, side)),
        *_defaults(f"disc = {CROSSING_RADIUS}", CROSSING_LIMITS),
        *_robots("r", lines),
    )


def _on_edge(rng: random.Random, edge: int, side: float) -> Point:
    """A place half a metre from one of the four edges, on a half-metre lattice."""
    along = 0.5 * rng.randint(2, round(2 * side) - 2)
    across = 0.5 if edge % 2 == 0 else side - 0.5
    return (along, across) if edge < 2 else (across, along)


def _clear(line: Line, other: Line) -> bool:
    reach = 2 * CROSSING_RADIUS + CLEARANCE
    return all(_distance(point, line) > reach for point in other) and all(
        _distance(point, other) > reach for point in line
    )


def _distance(point: Point, line: Line) -> float:
    """Distance [m] of a point from a segment."""
    (ax, ay), (bx, by) = line
    dx, dy = bx - ax, by - ay
    share = ((point[0] - ax) * dx + (point[1] - ay) * dy) / (dx * dx + dy * dy)
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (ax + share * dx, ay + share * dy))


def _cross(one: Line, two: Line) -> bool:
    return _side(one, two[0]) * _side(one, two[1]) < 0 and _side(two, one[0]) * _side(two, one[1]) < 0


def _side(line: Line, point: Point) -> float:
    (ax, ay), (bx, by) = line
    return (bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax)


def warehouse(count: int, columns: int, rows: int, seed: int) -> str:
    """Shelves in rows; trips between random free places, accepted while there is an order in which all can arrive."""
    rng = random.Random(seed)  # noqa: S311  a seeded draw, no secret
    shelves = [_shelf(column, row) for row in range(rows) for column in range(columns)]
    bounds = (0.0, 0.0, columns * (SHELF[0] + AISLE) + AISLE, rows * (SHELF[1] + AISLE) + AISLE)
    trips = _acyclic_trips(rng, count, shelves, bounds)
    return _text(
        f"# {count} robots drive between random places of a warehouse: {len(shelves)} shelves of "
        f"{SHELF[0]:g} x {SHELF[1]:g} m, aisles of {AISLE:g} m.",
        "# Many start or stop on somebody else's way: who must go first is part of the problem. On the",
        "# shortest paths there is an order in which everybody arrives.",
        f"# Written by problems/generate.py (seed {seed}): change it there.",
        *_head(f"warehouse {count:02}", bounds),
        *_defaults(f"disc = {WAREHOUSE_RADIUS}", WAREHOUSE_LIMITS),
        *_robots("amr-", trips),
        *_rectangles("shelf", shelves),
    )


def _shelf(column: int, row: int) -> Box:
    x, y = AISLE + column * (SHELF[0] + AISLE), AISLE + row * (SHELF[1] + AISLE)
    return (x, y, x + SHELF[0], y + SHELF[1])


def _acyclic_trips(rng: random.Random, count: int, shelves: Sequence[Box], bounds: Box) -> list[Line]:
    """Trips whose blocking graph, on the shortest paths, has no cycle."""
    floor = Workspace(bounds, CLEARANCE)
    obstacles = tuple(rectangle(f"shelf {k + 1}", shelf) for k, shelf in enumerate(shelves))
    robots: list[Robot] = []
    paths: list[Path] = []
    while len(robots) < count:
        start, goal = _free_place(rng, shelves, bounds), _free_place(rng, shelves, bounds)
        if math.dist(start, goal) < SHORTEST_TRIP or any(
            math.dist(start, other.start) < 1.0 or math.dist(goal, other.goal) < 1.0 for other in robots
        ):
            continue
        robot = Robot(str(len(robots)), Footprint(WAREHOUSE_RADIUS), WAREHOUSE_LIMITS, start, goal)
        path = find_routes(Problem("", floor, (robot,), obstacles))[0].path
        if _acyclic([*robots, robot], [*paths, path]):
            robots.append(robot)
            paths.append(path)
    return [(robot.start, robot.goal) for robot in robots]


def _free_place(rng: random.Random, shelves: Sequence[Box], bounds: Box) -> Point:
    """A place on a half-metre lattice, a little away from shelves and edge."""
    _, _, xmax, ymax = bounds
    while True:
        x, y = 0.5 * rng.randint(2, round(2 * xmax) - 2), 0.5 * rng.randint(2, round(2 * ymax) - 2)
        if all(
            math.hypot(max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0)) >= STAND_OFF for x0, y0, x1, y1 in shelves
        ):
            return (x, y)


def _acyclic(robots: Sequence[Robot], paths: Sequence[Path]) -> bool:
    pairs = candidate_pairs([chords(path) for path in paths], [WAREHOUSE_RADIUS + CLEARANCE / 2] * len(robots))
    arcs = blocking_arcs(robots, paths, pairs, CLEARANCE)
    return topological_order(range(len(robots)), [robot.name for robot in robots], arcs) is not None


def squares_fixed() -> str:
    """Squares that never turn, between racks: aisles that they fit through and discs round them would not."""
    (left, width, aisle), (lower, depth, lane) = RACKS, ROWS
    columns = [round(left + k * (width + aisle), 9) for k in range(3)]
    rows = [round(lower + k * (depth + lane), 9) for k in range(2)]
    racks = [(x, y, round(x + width, 9), round(y + depth, 9)) for y in rows for x in columns]
    right, top = round(columns[2] + width + left, 9), round(rows[1] + depth + lower, 9)
    between = [round(x - aisle / 2, 9) for x in columns[1:]]
    disc = math.sqrt(2) * SQUARE
    middle, low, high, far = round(lower + depth + lane / 2, 9), 0.8, round(top - 0.8, 9), round(right - 1.0, 9)
    trips = [
        ((between[0], low), (between[0], high)),
        ((between[1], high), (between[1], low)),
        ((1.0, round(middle + 0.5, 9)), (far, round(middle + 0.5, 9))),
        ((far, round(middle - 0.5, 9)), (1.0, round(middle - 0.5, 9))),
        ((1.0, low), (16.0, high)),
        ((far, low), (4.0, high)),
    ]
    return _text(
        f"# {len(trips)} square robots that never turn, {SQUARE:g} m wide, cross a hall with racks. Through the aisles",
        f"# of {aisle:g} m between the racks they fit with their clearance. Discs round them ({disc:.2f} m) would not,",
        "# nor could two such discs pass each other on the lane in the middle, as sq-3 and sq-4 do.",
        "# Written by problems/generate.py: change it there.",
        *_head("squares, fixed", (0.0, 0.0, right, top)),
        *_defaults(f"square = {SQUARE}", WAREHOUSE_LIMITS),
        'heading = "fixed"                   # as drawn, all the time; for squares this is the default',
        *_robots("sq-", trips),
        *_rectangles("rack", racks),
    )


def squares_turning() -> str:
    """Footprints that turn with the path: squares, and a truck much longer than wide, round bends."""
    trips = [
        ((2.0, 2.0), (17.0, 11.0)),
        ((17.5, 2.0), (2.5, 11.0)),
        ((9.5, 12.0), (9.5, 1.5)),
        ((1.5, 6.5), (18.5, 6.5)),
    ]
    robots = _robots("sq-", trips)
    truck = [
        "",
        "[[robots]]",
        'name = "truck"                      # its reference point is its rear axle: it turns about that',
        "footprint = { polygon = [[-0.3, -0.35], [1.2, -0.35], [1.4, 0.0], [1.2, 0.35], [-0.3, 0.35]] }",
        "speed = 0.8",
        "start = [2.0, 9.0]",
        "goal = [17.0, 4.0]",
    ]
    return _text(
        "# Robots that turn with their path: four squares, and a truck twice as long as wide. Planning keeps room for",
        "# the disc round each of them, whichever way it heads; the checker then certifies the shapes as they turn.",
        "# Written by problems/generate.py: change it there.",
        *_head("squares, turning", (0.0, 0.0, 20.0, 13.0)),
        *_defaults("square = 0.7", WAREHOUSE_LIMITS),
        'heading = "path"                    # the drawn x axis points along the path; the default for polygons',
        *robots,
        *truck,
        *_rectangles("block", [(5.0, 3.5, 7.5, 5.0), (12.0, 8.0, 14.5, 9.5)]),
        "",
        "[[obstacles]]",
        'name = "column"',
        "circle = { center = [9.6, 6.4], radius = 1.0 }",
    )


def _rectangles(name: str, boxes: Sequence[Box]) -> list[str]:
    tables = (
        ("", "[[obstacles]]", f'name = "{name} {k + 1}"', f"rectangle = {list(box)}") for k, box in enumerate(boxes)
    )
    return list(itertools.chain.from_iterable(tables))


def _text(*lines: str) -> str:
    return "\n".join(lines) + "\n"


def _head(name: str, bounds: Box) -> list[str]:
    return [
        "",
        'format = "coord-problem/1"',
        f'name = "{name}"',
        "",
        "[workspace]",
        f"bounds = {list(bounds)}",
        f"clearance = {CLEARANCE}",
    ]


def _defaults(footprint: str, limits: Limits) -> list[str]:
    fields = ("speed", "acceleration", "deceleration", "jerk", "lateral_acceleration")
    values = [f"{field} = {getattr(limits, field)}" for field in fields]
    return ["", "[defaults]", f"footprint = {{ {footprint} }}", *values]


def _robots(prefix: str, trips: Sequence[Line]) -> list[str]:
    digits = len(str(len(trips)))
    lines = []
    for k, (start, goal) in enumerate(trips):
        name = f"{prefix}{k + 1:0{digits}}"
        lines += ["", "[[robots]]", f'name = "{name}"', f"start = {list(start)}", f"goal = {list(goal)}"]
    return lines


if __name__ == "__main__":
    sys.exit(main())
