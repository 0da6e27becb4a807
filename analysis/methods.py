"""Three ways to settle a collision, side by side: ``python analysis/methods.py [--csv FILE] [FOLDER ...]``.

Plans the problems of ``problems/`` and of further folders with ``--method`` velocity, stop and nearest, profile
fastest, and prints a table of families and methods: how many problems each plans, how many jam, and what robots lose.
Of a folder only the families that need velocities and nothing else are taken (crossing, lanes, chords, antipodd), up to
``--most`` robots. Those that ``velocity`` has no plan for (rings) are left out and named.

It ends with the promise: on the sum of a family ``stop`` is never better than ``velocity`` by more than 0.5 %. Single
problems where it is better at all are listed, since optimal robot by robot is not optimal for the sum.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from dataclasses import dataclass
from pathlib import Path

from coord import BadFileError, Options, read_problem
from coord.model.problem import Problem
from coord.model.result import Result
from coord.plan import plan

HERE = Path(__file__).resolve().parent
METHODS = ("velocity", "stop", "nearest")
FAMILIES = ("crossing", "lanes", "chords", "antipodd")
COLUMNS = ("family", "problem", "robots", "method", "outcome", "stops", "sum of arrivals [s]", "sum alone [s]")

#: What stop may gain on the sum of a family.
PROMISED = 0.005


@dataclass(frozen=True)
class Row:
    """One problem planned with one method; sums are 0 where there is no plan."""

    family: str
    problem: str
    robots: int
    method: str
    outcome: str
    stops: int = 0
    arrivals: float = 0.0
    alone: float = 0.0

    @property
    def is_planned(self) -> bool:
        """Whether there is a certified plan."""
        return self.outcome == "certified"


def files_of(folders: list[Path]) -> list[tuple[str, Path]]:
    """Family and file of all problems to plan."""
    own = HERE.parent / "problems"
    found = [("problems", file) for file in sorted(own.rglob("*.toml")) if file.name != "best_known.toml"]
    for folder in folders:
        if not folder.is_dir():
            print(f"{folder} is not there: left out", file=sys.stderr)
        for file in sorted(folder.rglob("*.toml")):
            family = file.stem.split("_n")[0]
            if family in FAMILIES:
                found.append((family, file))
    return found


def row(family: str, name: str, problem: Problem, method: str) -> Row:
    """Plan one problem with one method."""
    result: Result = plan(problem, Options(method=method, profile="fastest"))
    count = len(problem.robots)
    if result.plan is None or not result.certified:
        return Row(family, name, count, method, result.diagnoses[0].code)
    found = result.plan
    stops = sum(one.how == "stop" for one in found.robots)
    sums = (found.sum_of_arrivals, found.sum_of_solo_arrivals)
    return Row(family, name, count, method, "certified", stops, *sums)


def rows_of(files: list[tuple[str, Path]], most: int) -> tuple[list[Row], list[str]]:
    """All rows, and the problems that are left out, with the reason."""
    rows, left_out = [], []
    for family, file in files:
        try:
            problem = read_problem(file)
        except BadFileError as error:
            left_out.append(f"{file.stem} (not read: {error.faults[0].text})")
            continue
        if len(problem.robots) > most:
            left_out.append(f"{file.stem} ({len(problem.robots)} robots)")
            continue
        planned = []
        for method in METHODS:
            planned.append(row(family, file.stem, problem, method))
            if method == "velocity" and not planned[0].is_planned:
                left_out.append(f"{file.stem} ({planned[0].outcome})")
                break
        else:
            rows += planned
    return rows, left_out


def table(rows: list[Row]) -> list[tuple[str, ...]]:
    """One line for each family and method; the last column compares sums on the problems that a method planned."""
    lines = []
    for family in dict.fromkeys(row.family for row in rows):
        base = {row.problem: row for row in rows if row.family == family and row.method == "velocity"}
        for method in METHODS:
            mine = [row for row in rows if row.family == family and row.method == method]
            done = [row for row in mine if row.is_planned]
            jams = sum(row.outcome == "jam" for row in mine)
            planned = f"{len(done)} of {len(mine)}"
            if not done:
                lines.append((family, method, planned, str(jams), "", "", ""))
                continue
            arrivals, robots = math.fsum(row.arrivals for row in done), sum(row.robots for row in done)
            delay = (arrivals - math.fsum(row.alone for row in done)) / robots
            more = arrivals / math.fsum(base[row.problem].arrivals for row in done) - 1
            lines.append((family, method, planned, str(jams), f"{arrivals:.1f}", f"{delay:.3f}", f"{100 * more:+.1f}"))
    return lines


def promise(rows: list[Row]) -> list[str]:
    """What there is to say about stop against velocity."""
    pairs = [(a, b) for a in rows for b in rows if a.problem == b.problem and a.family == b.family]
    pairs = [(a, b) for a, b in pairs if (a.method, b.method) == ("velocity", "stop") and b.is_planned]
    said = []
    for family in dict.fromkeys(a.family for a, _ in pairs):
        sums = [
            math.fsum(x) for x in zip(*((a.arrivals, b.arrivals) for a, b in pairs if a.family == family), strict=True)
        ]
        more = sums[1] / sums[0] - 1
        said.append(
            f"{family}: sum of stop {100 * more:+.2f} % against velocity: {'kept' if more >= -PROMISED else 'MISSED'}"
        )
    better = [
        f"{a.problem} ({100 * (b.arrivals / a.arrivals - 1):+.2f} %)" for a, b in pairs if b.arrivals < a.arrivals
    ]
    return [*said, f"single problems on which stop is better: {', '.join(better) or 'none'}"]


def main() -> None:
    """Plan, print, and keep the rows."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--most", type=int, default=50, metavar="N", help="leave out problems of more robots")
    parser.add_argument("--csv", type=Path, default=HERE / "methods.csv")
    arguments = parser.parse_args()
    rows, left_out = rows_of(files_of(arguments.folders), arguments.most)
    head = (
        "family",
        "method",
        "planned",
        "jams",
        "sum of arrivals [s]",
        "delay a robot [s]",
        "sum against velocity [%]",
    )
    print("\n".join("| " + " | ".join(line) + " |" for line in [head, ("---",) * len(head), *table(rows)]))
    print("\n".join(["", *promise(rows), f"left out: {', '.join(left_out) or 'none'}"]))
    with arguments.csv.open("w", newline="", encoding="utf-8") as stream:
        lines = [
            (r.family, r.problem, r.robots, r.method, r.outcome, r.stops, repr(r.arrivals), repr(r.alone)) for r in rows
        ]
        csv.writer(stream, lineterminator="\n").writerows([COLUMNS, *lines])


if __name__ == "__main__":
    main()
