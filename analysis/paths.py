"""The benchmark of the path stage: ``python analysis/paths.py [--robots 1000] [FLOOR ...]``.

Each random robot is a problem of its own in a field of 10 to 500 obstacles. Its paths, in all shapes there are, are
planned and certified; its skeleton is compared with the whole tangent graph and with a visibility graph, its time
with the time that the skeleton's length alone would take. Then a made-up floor plan of 2000 x 2000 cells is traced,
and ways are sought on it; problem files or folders of them (FLOOR) are added. A robot without a way is a row too, and
counts as a failure unless that is proved.

What is the same on every machine goes to ``paths.csv``, processor times to ``paths_seconds.csv``.
"""

from __future__ import annotations

import argparse
import csv
import math
import platform
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import fields
import numpy as np
import oracle

from coord import read_problem
from coord.errors import CoordError
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits
from coord.paths.routes import find_routes
from coord.paths.skeleton import NoWay, Skeleton, skeleton
from coord.plan import plan
from coord.reading.grid_map import GridMap, map_obstacles
from coord.reading.trace import trace
from coord.solvers.jerk import rest_to_rest

HERE = Path(__file__).resolve().parent
COUNTS = (10, 50, 100, 200, 500)
ROBOTS_A_FIELD = 5
EXAMPLE = Limits(speed=1.0, acceleration=0.5, deceleration=0.5, jerk=1.0, lateral_acceleration=0.5)
SHAPES = ("fitted", "taut", "exponential", "follow")

#: [m] How well lengths must agree.
SAME = 1e-9

Value = TypeVar("Value")


@dataclass(slots=True)
class Row:
    """One robot: which one, what was found (lengths [m], times [s]), and the processor times [s] that it took."""

    obstacles: int
    seed: int
    robot: int
    footprint: str
    outcome: str = ""
    length: float = math.inf
    turns: int = 0
    graph_error: float = math.nan
    polygon_excess: float = math.nan
    ideal: float = math.nan
    applies: bool | None = None
    times: dict[str, float] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    def figures(self) -> list[str]:
        """The columns that do not depend on the machine."""
        numbers = (self.length, self.graph_error, self.polygon_excess, self.ideal)
        shapes = [_text(self.times.get(shape, math.nan)) for shape in SHAPES]
        applies = {None: "", False: "no", True: "yes"}[self.applies]
        return [*map(str, self.key()), self.outcome, str(self.turns), *map(_text, numbers), *shapes, applies]

    def key(self) -> tuple[int, int, int, str]:
        """Which robot it is."""
        return (self.obstacles, self.seed, self.robot, self.footprint)


KEY = ("obstacles", "seed", "robot", "footprint")
FIGURES = (
    *KEY, "outcome", "turns", "skeleton [m]", "beyond the graph [m]", "polygons beyond it [m]", "ideal [s]",
    *(f"{shape} [s]" for shape in SHAPES), "exponential applies",
)  # fmt: skip
SECONDS = ("grow", "skeleton", *(f"path, {shape}" for shape in SHAPES), *(f"plan, {shape}" for shape in SHAPES))


def main() -> None:
    """Measure, keep, and print the promises beside what was measured."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("floors", nargs="*", type=Path, help="problem files, or folders of them")
    parser.add_argument("--robots", type=int, default=1000, help="random robots in all, spread over the fields")
    parser.add_argument("--footprint", choices=("disc", "square"), default="disc", help="of the random robots")
    parser.add_argument("--shapes", nargs="+", choices=SHAPES, default=SHAPES, help="of the paths")
    parser.add_argument("--limits", choices=("random", "example"), default="random", help="example: 1 m/s, 0.5 m/s2")
    parser.add_argument("--no-oracle", action="store_true", help="leave out the comparison of lengths")
    parser.add_argument("--csv", type=Path, help="folder for paths.csv and paths_seconds.csv; default: none is kept")
    arguments = parser.parse_args()
    rows = []
    for count in COUNTS:
        for number in range(math.ceil(arguments.robots / len(COUNTS))):
            rows.append(measured(count, number, arguments))
        print(f"{count} obstacles: {_outcomes(rows, count)}", file=sys.stderr, flush=True)
    print(f"{platform.machine()}, {platform.processor() or platform.system()}, Python {platform.python_version()}\n")
    print(f"{len(rows)} robots: {_outcomes(rows)}\n")
    promises(rows, arguments.footprint)
    by_count(rows, arguments.shapes)
    on_floors(arguments.floors)
    if arguments.csv:
        _write(arguments.csv / "paths.csv", FIGURES, (row.figures() for row in rows))
        seconds = ([*map(str, row.key()), *(_text(row.seconds.get(name, math.nan), 4) for name in SECONDS)]
                   for row in rows)  # fmt: skip
        _write(arguments.csv / "paths_seconds.csv", (*KEY, *(f"{name} [s]" for name in SECONDS)), seconds)


def measured(count: int, number: int, arguments: argparse.Namespace) -> Row:
    """Everything about the random robot of this number in fields of this many obstacles."""
    kind = arguments.footprint
    seed, k = divmod(number, ROBOTS_A_FIELD)
    row = Row(count, seed, k, kind)
    floor = fields.random_field(count, seed)
    robot = fields.random_robot(floor, "robot", np.random.default_rng((seed, count, k)), kind)
    if arguments.limits == "example":
        robot = replace(robot, limits=EXAMPLE)
    grown, row.seconds["grow"] = _timed(lambda: fields.floor_of(floor, robot))
    found, row.seconds["skeleton"] = _timed(lambda: skeleton(grown, robot.start, robot.goal))
    start, goal = complex(*robot.start), complex(*robot.goal)
    scene = oracle.scene(floor.workspace, floor.obstacles, robot.footprint, (start, goal))
    if isinstance(found, NoWay):
        row.outcome = "no way, proved" if oracle.separated(scene, start, goal) else "NO WAY"
        return row
    row.length, row.turns = found.length, len(found.turns)
    row.ideal = rest_to_rest(found.length, robot.limits).arrival
    if not arguments.no_oracle:
        bound = math.inf if count <= 50 else found.length + SAME
        row.graph_error = found.length - oracle.tangent_length(scene, start, goal, bound)
        row.polygon_excess = oracle.visibility_length(scene, start, goal, 1.001 * found.length) - found.length
    _plan_all(row, fields.problem_of(floor, robot), arguments.shapes)
    return row


def _plan_all(row: Row, problem: Problem, shapes: Sequence[str]) -> None:
    failed = []
    for shape in shapes:
        began = time.process_time()
        ends = [began]

        def note(stage: str, *_: int, ends: list[float] = ends) -> None:
            if stage == "paths":
                ends.append(time.process_time())

        try:
            result = plan(problem, Options(shape=shape), note)
        except (CoordError, ArithmeticError, ValueError, LookupError) as error:  # a defect is a row of the table too
            failed.append(f"{shape}: {type(error).__name__}")
            continue
        row.seconds[f"path, {shape}"], row.seconds[f"plan, {shape}"] = ends[-1] - began, result.seconds
        if result.plan is None or not result.certified:
            failed.append(f"{shape}: {result.diagnoses[0].code}")
            continue
        row.times[shape] = result.plan.robots[0].arrival
        if shape == "exponential":  # remarks say where a detour could not be one
            (route,) = find_routes(problem, shape)
            row.applies = bool(route.fits) and not route.remarks
    row.outcome = f"NOT CERTIFIED ({'; '.join(failed)})" if failed else "certified"


def promises(rows: Sequence[Row], kind: str) -> None:
    """The table of what was promised and what was measured."""
    found = [row for row in rows if row.length < math.inf]
    large = [row for row in found if row.obstacles == max(COUNTS)]
    ratio = [row.times["fitted"] / row.ideal for row in found if "fitted" in row.times]
    bent = [row.times["exponential"] / row.times["fitted"] for row in found if row.applies and "fitted" in row.times]
    cells = fields.floor_plan(2000, 1)
    tracing = min(_timed(lambda: trace(cells))[1] for _ in range(3))
    plan_mean, plan_most = on_floor_plan(cells, kind)
    failures = sum(row.outcome.startswith("N") for row in rows)
    off = max((abs(row.graph_error) for row in found if not math.isnan(row.graph_error)), default=math.nan)
    excess = [row.polygon_excess for row in found if not math.isnan(row.polygon_excess)]
    below = max(0.0, -min(excess)) if excess else math.nan
    table = [
        ("robots neither certified nor proved to have no way", "0", f"{failures}", failures == 0),
        ("skeleton against the whole tangent graph [m]", f"<= {SAME:g}", f"{off:.1e}", off <= SAME),
        ("skeleton above a visibility graph's way [m]", f"<= {SAME:g}", f"{below:.1e}", below <= SAME),
        _at_most("fitted / time on the skeleton's length, mean", 1.02, ratio, 4),
        _at_most("exponential / fitted where it applies, mean", 1.12, bent, 4),
        _at_most(f"skeleton, {max(COUNTS)} obstacles, mean [s]", 0.06, [row.seconds["skeleton"] for row in large]),
        _at_most(f"whole path, {max(COUNTS)} obstacles, mean [s]", 0.3,
                 [row.seconds["path, fitted"] for row in large if "path, fitted" in row.seconds]),
        _at_most("tracing 2000 x 2000 cells [s]", 0.2, [tracing]),
        _at_most("skeleton on that floor plan, mean [s]", 0.08, [plan_mean]),
    ]  # fmt: skip
    print("| promise | target | measured | kept |\n|---|---|---|---|")
    for what, target, got, kept in table:
        print(
            f"| {what} | {target} | " + ("not measured | |" if got == "nan" else f"{got} | {'yes' if kept else 'no'} |")
        )
    worst = f"fitted at most {max(ratio, default=math.nan):.3f}, exponential at most {max(bent, default=math.nan):.3f}"
    print(f"\nWorst: {worst}; exponential applies to {len(bent)}; on the floor plan {plan_most:.3f} s.\n")


def by_count(rows: Sequence[Row], shapes: Sequence[str]) -> None:
    """Means by the number of obstacles."""
    times = [f"{shape} / ideal" for shape in shapes]
    print("| obstacles | turns | grow [ms] | skeleton, mean, most [ms] | path, mean, most [ms] | "
          + " | ".join(times) + " |")  # fmt: skip
    print("|" + "---|" * (5 + len(shapes)))
    for count in COUNTS:
        here = [row for row in rows if row.obstacles == count and row.times]
        if not here:
            continue
        cells = [f"{np.mean([row.turns for row in here]):.1f}", _ms(here, "grow", False)]
        cells += [_ms(here, "skeleton"), _ms(here, "path, fitted")]
        for shape in shapes:
            cells.append(f"{np.mean([row.times[shape] / row.ideal for row in here if shape in row.times]):.4f}")
        print(f"| {count} | " + " | ".join(cells) + " |")


def on_floor_plan(cells: np.ndarray, kind: str) -> tuple[float, float]:
    """Mean and largest seconds of a skeleton for 20 random robots on a floor plan of 5 cm cells."""
    grid = GridMap(cells, 0.05, (0.0, 0.0), ())
    floor = fields.Field(Workspace(grid.bounds, 0.05), tuple(map_obstacles(grid)))
    rng = np.random.default_rng(1)
    seconds = []
    for k in range(20):
        robot = fields.random_robot(floor, f"r{k}", rng, kind)
        grown = fields.floor_of(floor, robot)
        seconds.append(_timed(lambda: skeleton(grown, robot.start, robot.goal))[1])  # noqa: B023
    return float(np.mean(seconds)), max(seconds)


def on_floors(places: Iterable[Path]) -> None:
    """Print seconds of skeletons on the floors of problem files."""
    files = [file for place in places for file in ([place] if place.is_file() else sorted(place.rglob("*.toml")))]
    if files:
        print("\n| floor | robots | ways | grow [ms] | skeleton, mean, most [ms] |\n|---|---|---|---|---|")
    for file in files:
        problem = read_problem(file)
        floor = fields.Field(problem.workspace, problem.obstacles)
        growing, seeking, ways = [], [], 0
        for robot in problem.robots:
            grown, grow_seconds = _timed(lambda: fields.floor_of(floor, robot))  # noqa: B023
            found, seconds = _timed(lambda: skeleton(grown, robot.start, robot.goal))  # noqa: B023
            growing.append(grow_seconds)
            seeking.append(seconds)
            ways += isinstance(found, Skeleton)
        spread = f"{1000 * np.mean(seeking):.1f}, {1000 * max(seeking):.1f}"
        print(f"| {file.stem} | {len(seeking)} | {ways} | {1000 * np.mean(growing):.1f} | {spread} |", flush=True)


def _timed(work: Callable[[], Value]) -> tuple[Value, float]:
    began = time.process_time()
    value = work()
    return value, time.process_time() - began


def _at_most(what: str, target: float, values: Sequence[float], digits: int = 3) -> tuple[str, str, str, bool]:
    mean = float(np.mean(values)) if values else math.nan
    return what, f"<= {target:g}", f"{mean:.{digits}f}", mean <= target


def _ms(rows: Sequence[Row], name: str, most: bool = True) -> str:
    values = [1000 * row.seconds[name] for row in rows if name in row.seconds]
    return f"{np.mean(values):.1f}" + (f", {max(values):.0f}" if most else "")


def _outcomes(rows: Sequence[Row], count: int | None = None) -> str:
    outcomes = [row.outcome for row in rows if count in (None, row.obstacles)]
    return ", ".join(f"{outcomes.count(outcome)} {outcome}" for outcome in sorted(set(outcomes)))


def _text(value: float, digits: int = 9) -> str:
    return "" if math.isnan(value) else f"{round(value, digits) + 0.0:.{digits}f}"  # + 0.0: no "-0.000"


def _write(file: Path, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    with file.open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream).writerows([columns, *rows])


if __name__ == "__main__":
    main()
