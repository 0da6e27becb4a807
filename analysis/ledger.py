"""The README's table of measured figures: ``python analysis/ledger.py [FOLDER ...]``.

Plans every problem of the folders given (default: ``problems/``), each in this process, and prints one row a
problem: robots, delay a robot, gap, least clearance, and the seconds that planning and certifying took. With
``--csv FILE`` the rows are kept. Problems without a plan are listed with their diagnosis's code.
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

from coord import BadFileError, Options, read_problem
from coord.plan import plan

HERE = Path(__file__).resolve().parent
COLUMNS = ("problem", "robots", "delay a robot [s]", "gap [%]", "least clearance [m]", "seconds", "outcome")


def row(file: Path, profile: str) -> tuple[str, ...]:
    """One line of the table."""
    try:
        problem = read_problem(file)
    except BadFileError as error:
        return (file.stem, "", "", "", "", "", f"not read: {error.faults[0].text}")
    result = plan(problem, Options(profile=profile))
    count = str(len(problem.robots))
    if result.plan is None or not result.certified:
        return (file.stem, count, "", "", "", f"{result.seconds:.2f}", result.diagnoses[0].code)
    found = result.plan
    delay = (found.sum_of_arrivals - found.sum_of_solo_arrivals) / len(found.robots)
    least = "" if result.min_clearance is None else f"{result.min_clearance.value:.4f}"
    figures = (f"{delay:.3f}", f"{100 * found.optimality_gap:.2f}", least, f"{result.seconds:.2f}")
    return (file.stem, count, *figures, "certified")


def main() -> None:
    """Plan, print, and keep what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", type=Path, default=[HERE.parent / "problems"])
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--profile", default="fastest", choices=("fastest", "gentle"))
    arguments = parser.parse_args()
    files = [
        file
        for place in arguments.folders
        for file in ([place] if place.is_file() else sorted(place.rglob("*.toml")))
        if file.name != "best_known.toml"
    ]
    rows = []
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS))
    for file in files:
        rows.append(row(file, arguments.profile))
        print("| " + " | ".join(rows[-1]) + " |", flush=True)
    if arguments.csv:
        with arguments.csv.open("w", newline="", encoding="utf-8") as stream:
            csv.writer(stream).writerows([COLUMNS, *rows])


if __name__ == "__main__":
    sys.exit(main())
