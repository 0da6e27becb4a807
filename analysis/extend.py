"""What one more robot costs: ``python analysis/extend.py [--robots 20] [--csv FOLDER] [PROBLEM ...]``.

Of each problem (a generated hall of 200 robots among 60 obstacles, and the problem files given) robots spread over the
file are left out, one at a time: the others are planned, the plan is written, read back and extended by that robot.
Told is whether it joined, whether all other records are the same to the byte, and the processor time of planning it
as a share of that of planning all robots; reading, writing and verifying are in neither.

What is the same on every machine goes to ``extend.csv``, seconds and shares to ``extend_seconds.csv``.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import json
import math
import platform
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from typing import TypeVar

import numpy as np
from fields import Field, gap

from coord import read_problem
from coord.coordination.extending import extended
from coord.coordination.kept import Kept, kept
from coord.errors import NoPlanError
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle, rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.result import Plan, Result
from coord.model.robot import Limits, Robot
from coord.output.plan_file import parse, serialise
from coord.plan import plan
from coord.verify import verify

HERE = Path(__file__).resolve().parent
COLUMNS = ("problem", "robots", "left out", "outcome", "other records the same", "how", "arrival [s]", "full run [s]")
SECONDS = ("problem", "left out", "planning all [s]", "planning one more [s]", "share [%]")

#: Of the wall of noise on a shared machine the least of so many runs is taken, of the extension and of the full run.
REPEATS = 3

#: [%] What one more robot may cost of planning all.
PROMISE = 2.0

T = TypeVar("T")


@dataclass(frozen=True)
class Row:
    """One robot that was left out and joined, or did not."""

    problem: str
    robots: int
    name: str
    outcome: str
    same: bool | None
    how: str
    arrival: float
    full_arrival: float
    full_seconds: float
    seconds: float

    @property
    def share(self) -> float:
        """Of planning all [%]."""
        return 100 * self.seconds / self.full_seconds


def hall(count: int = 200, seed: int = 1) -> Problem:
    """Trips of 10 to 30 m in a hall of 100 x 100 m with racks and columns; no two places are nearer than 1.2 m."""
    rng = np.random.default_rng((seed, count))
    obstacles: list[Obstacle] = []
    for k in range(60):
        x, y = rng.uniform(5.0, 95.0, 2).tolist()
        if k % 3:
            obstacles.append(rectangle(f"rack {k}", (x, y, x + 4.0, y + 1.0), float(rng.uniform(0.0, math.pi))))
        else:
            obstacles.append(Circle(f"column {k}", (x, y), 0.5))
    field = Field(Workspace((0.0, 0.0, 100.0, 100.0), 0.05), tuple(obstacles))
    body, limits, places, robots = Footprint(0.3), Limits(1.5, 1.0, 1.0, 2.0, 1.0), [], []
    while len(robots) < count:
        start = tuple(np.round(rng.uniform(1.0, 99.0, 2), 3).tolist())
        turn, far = rng.uniform(0.0, 2 * math.pi), rng.uniform(10.0, 30.0)
        goal = (round(start[0] + far * math.cos(turn), 3), round(start[1] + far * math.sin(turn), 3))
        taken = any(math.dist(place, other) < 1.2 for place in (start, goal) for other in places)
        if taken or not all(1.0 <= value <= 99.0 for value in goal):
            continue
        if min(gap(field, body, place) for place in (start, goal)) > 0.1:
            places += [start, goal]
            robots.append(Robot(f"h{len(robots):03d}", body, limits, start, goal))
    return Problem(f"hall_n{count}", field.workspace, tuple(robots), field.obstacles)


def timed(work: Callable[[], T]) -> tuple[T, float]:
    """What comes out, and the least processor time [s] of some runs."""
    times = []
    for _ in range(REPEATS):
        began = process_time()
        found = work()
        times.append(process_time() - began)
    return found, min(times)


def planned(problem: Problem) -> tuple[Result, float]:
    """A full run, and the processor time [s] of its planning, without writing and verifying."""
    result, seconds = timed(lambda: plan(problem))
    if result.plan is None:
        return result, math.nan
    made = result.plan
    _, checking = timed(lambda: verify(serialise(made)))
    return result, seconds - checking


def extension(holding: Kept) -> Plan | NoPlanError:
    """The extended plan, or why there is none."""
    try:
        return extended(holding, Options())
    except NoPlanError as failure:
        return failure


def without(problem: Problem, name: str) -> Problem:
    """The problem without one robot."""
    return dataclasses.replace(problem, robots=tuple(robot for robot in problem.robots if robot.name != name))


def records(document: bytes) -> dict[str, str]:
    """Each robot's part of a plan file as its text."""
    return {part["name"]: json.dumps(part) for part in json.loads(document)["robots"]}


def join(problem: Problem, full: Result, full_seconds: float, name: str) -> Row:
    """Leave a robot out, plan, write, read, and let it join."""
    count, (alone,) = len(problem.robots), [part for part in full.plan.robots if part.robot.name == name]
    first = plan(without(problem, name))
    if first.plan is None:
        code = first.diagnoses[0].code
        return Row(problem.name, count, name, f"no plan of the others: {code}", None, "", math.nan, alone.arrival,
                   full_seconds, math.nan)  # fmt: skip
    older = parse(first.document)
    made, seconds = timed(lambda: extension(kept(problem, older)))
    if isinstance(made, NoPlanError):
        return Row(problem.name, count, name, made.diagnoses[0].code, None, "", math.nan, alone.arrival, full_seconds,
                   seconds)  # fmt: skip
    document = serialise(made)
    outcome = verify(document).verdict
    before, after = records(first.document), records(document)
    (part,) = [part for part in made.robots if part.robot.name == name]
    same = {one: after[one] for one in before} == before
    return Row(problem.name, count, name, outcome, same, part.how, part.arrival, alone.arrival, full_seconds, seconds)


def spread(problem: Problem, count: int) -> list[str]:
    """Names of so many robots, evenly over the file, the last among them."""
    last = len(problem.robots) - 1
    return [problem.robots[round(k)].name for k in np.unique(np.round(np.linspace(0, last, min(count, last + 1))))]


def told(rows: Sequence[Row]) -> str:
    """What came of one problem, in a line."""
    shares = np.array([row.share for row in rows if row.outcome == "certified"])
    joined, same = len(shares), sum(row.same is True for row in rows)
    text = f"{rows[0].problem}: {joined} of {len(rows)} joined and certified, {same} with all other records the same"
    if not joined:
        return text
    below = f"{np.count_nonzero(shares < PROMISE)} of {joined} below the promised {PROMISE:g} %"
    shown = f"median {np.median(shares):.2f} %, mean {shares.mean():.2f} %, worst {shares.max():.2f} % of planning all"
    return f"{text}; {shown}, {below}"


def main() -> None:
    """Plan, extend, print, keep."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problems", nargs="*", type=Path, help="further problem files")
    parser.add_argument("--robots", type=int, default=20, help="left out of each problem, one at a time")
    parser.add_argument("--csv", type=Path, help="folder for extend.csv and extend_seconds.csv")
    arguments = parser.parse_args()
    problems = [hall()]
    for file in arguments.problems:
        if file.is_file():
            problems.append(read_problem(file))
        else:
            print(f"{file}: not there, left out", file=sys.stderr)
    rows: list[Row] = []
    for problem in problems:
        full, seconds = planned(problem)
        if full.plan is None:
            print(f"{problem.name}: no plan: {full.diagnoses[0].code}")
            continue
        own = [join(problem, full, seconds, name) for name in spread(problem, arguments.robots)]
        print(told(own), flush=True)
        rows += own
    if arguments.csv:
        keep(rows, arguments.csv)


def keep(rows: Sequence[Row], folder: Path) -> None:
    """Write both files."""
    same = [
        (row.problem, row.robots, row.name, row.outcome, {True: "yes", False: "no", None: ""}[row.same], row.how,
         _text(row.arrival, 6), _text(row.full_arrival, 6))
        for row in rows
    ]  # fmt: skip
    times = [
        (row.problem, row.name, _text(row.full_seconds, 4), _text(row.seconds, 5), _text(row.share, 3)) for row in rows
    ]
    head = (*SECONDS[:2], *(f"{title}, {platform.machine()}" for title in SECONDS[2:]))
    for name, table in (("extend.csv", [COLUMNS, *same]), ("extend_seconds.csv", [head, *times])):
        with (folder / name).open("w", newline="", encoding="utf-8") as stream:
            csv.writer(stream).writerows(table)


def _text(value: float, digits: int) -> str:
    return "" if math.isnan(value) else f"{value:.{digits}f}"


if __name__ == "__main__":
    main()
