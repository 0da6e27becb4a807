"""Who arrives, and is the reason true where not: ``python analysis/arrival.py [--numbers A:B] [--csv FOLDER]``.

500 generated problems of ``crowds.py`` (five kinds, 2 to 60 robots) are planned. Each either comes home, certified, or
has diagnoses, and every reason told is checked by other means: no way, by rooms between polygons (``oracle.py``); two
robots that cannot pass each other on their paths, by a walk over a fine grid of their arc lengths. Where the planner
itself says that it found no motions but proves nothing, the outcome is "no reason found".

A run that needs more than 60 s of processor time is ended. What is the same on every machine goes to ``arrival.csv``,
processor times to ``arrival_seconds.csv``. With ``--numbers`` or ``--kinds`` a part is run and its rows replace those
in the files, so that a long run can be had in pieces; ``--table`` only prints what is in them.
"""

from __future__ import annotations

import argparse
import csv
import math
import platform
import re
import signal
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import oracle
from crowds import KINDS, SIZES, crowded

from coord.coordination.settled import settle
from coord.errors import CoordError
from coord.model.path import Path as Curve
from coord.model.problem import Problem
from coord.model.result import Diagnosis
from coord.paths.routes import find_routes
from coord.plan import plan

#: Problems of each kind, the promised longest run [s], and the promised share without a reason.
NUMBERS, LONGEST, WITHOUT = 100, 60.0, 0.01

#: Outcomes of a problem, the best first.
CERTIFIED, CONFIRMED, NO_REASON = "certified", "confirmed reason", "no reason found"
LATE, UNCONFIRMED = f"over {LONGEST:g} s", "unconfirmed"
OUTCOMES = (CERTIFIED, CONFIRMED, NO_REASON, LATE, UNCONFIRMED)

#: Places along each path of a pair, coarse first: a finer grid is a stronger proof.
GRIDS = (500, 2000, 8000)

#: Places along each path where it is shown that two can pass.
SPARE = 1000

#: [m] Steps in which headings are summed up to points, and what those may be off by that: curvatures reach 100 / m.
STEP, ROUNDING = 2e-4, 1e-5

#: The sentences of diagnoses that claim that a pair is separated, and the one that claims nothing.
_PAIR = re.compile(r'"([^"]+)" and "([^"]+)" (?:cannot pass each other|come too near to pass each other)')
_NOTHING = "which does not prove that there are none"

COLUMNS = ("kind", "number", "robots", "outcome", "reasons", "make room", "sum of arrivals [s]")
SECONDS = ("kind", "number", "robots", "processor time [s]")


@dataclass(frozen=True)
class Row:
    """One problem: what came of it, for which reasons, how many robots make room, and the processor time [s]."""

    kind: str
    number: int
    robots: int
    outcome: str
    reasons: str
    beside: int
    arrivals: str
    seconds: float

    def figures(self) -> tuple[object, ...]:
        """The columns that do not depend on the machine."""
        return (self.kind, self.number, self.robots, self.outcome, self.reasons, self.beside, self.arrivals)


def measured(kind: str, number: int) -> Row:
    """Plan a problem, and confirm its diagnoses."""
    problem = crowded(kind, number)
    key, began = (kind, number, len(problem.robots)), time.process_time()
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        result = plan(problem)
    except TimeoutError:
        return Row(*key, LATE, "", 0, "", time.process_time() - began)
    except (CoordError, ArithmeticError, ValueError, LookupError, RuntimeError) as error:  # a defect is a row, too
        return Row(*key, UNCONFIRMED, type(error).__name__, 0, "", time.process_time() - began)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    seconds = time.process_time() - began
    if result.certified and result.plan is not None:
        beside = sum("room to pass" in one.text for one in result.plan.rerouted)
        return Row(*key, CERTIFIED, "", beside, f"{result.plan.sum_of_arrivals:.6f}", seconds)
    outcome = outcome_of(problem, result.diagnoses)
    codes = " ".join(sorted({one.code for one in result.diagnoses}))
    return Row(*key, outcome, codes, 0, "", seconds)


def too_late(number: int, frame: object) -> None:
    """End a run that has taken its time."""
    raise TimeoutError


def outcome_of(problem: Problem, diagnoses: Sequence[Diagnosis]) -> str:
    """What a problem without a plan counts as: one true reason is enough, and one false one is too many."""
    verdicts = [confirmed(problem, diagnosis) for diagnosis in diagnoses]
    if UNCONFIRMED in verdicts or not verdicts:
        return UNCONFIRMED
    return CONFIRMED if CONFIRMED in verdicts else NO_REASON


def confirmed(problem: Problem, diagnosis: Diagnosis) -> str:
    """Whether a reason is true, by means that the planner does not use."""
    if diagnosis.code == "no-way":
        (robot,) = [one for one in problem.robots if one.name == diagnosis.robots[0]]
        ends = complex(*robot.start), complex(*robot.goal)
        floor = oracle.scene(problem.workspace, problem.obstacles, robot.footprint, ends)
        return CONFIRMED if oracle.separated(floor, *ends) else UNCONFIRMED
    if diagnosis.code == "blocking-cycle" and _NOTHING in diagnosis.text:
        return NO_REASON
    pair = _PAIR.search(diagnosis.text)
    if diagnosis.code != "blocking-cycle" or pair is None:
        return UNCONFIRMED
    found = settle(
        problem, find_routes(problem, "fitted"), "fitted", keep_paths=False, done=lambda done, total: None
    ).found
    index = {robot.name: i for i, robot in enumerate(problem.robots)}
    i, k = (index[name] for name in pair.groups())
    return CONFIRMED if cannot_pass(problem, i, found.routes[i].path, k, found.routes[k].path) else UNCONFIRMED


def can_pass(problem: Problem, i: int, path: Curve, k: int, beside: Curve) -> bool:
    """Whether it is proved that two motions along two paths bring both robots home: ``walk`` with room to spare."""
    gaps, needed, slack = _apart(problem, i, path, k, beside, SPARE)
    return walk(gaps, needed + 2 * slack, SPARE + 1, leave=problem.workspace.after_arrival == "leave")


def cannot_pass(problem: Problem, i: int, path: Curve, k: int, beside: Curve) -> bool:
    """Whether it is proved that no two motions along two paths bring both robots home.

    A motion of both is a way through the plane of their arc lengths that never goes back. Samples of it on a grid go
    from one place to the next to the right, up, or both. Between a point of the plane and the nearest of the grid the
    distance of the two robots changes by half a step of each path at most. So where no such walk leads over samples
    that are less than that too near, there is no such way.
    """
    leave = problem.workspace.after_arrival == "leave"
    for count in GRIDS:
        gaps, needed, slack = _apart(problem, i, path, k, beside, count)
        if not walk(gaps, needed - slack, count + 1, leave=leave):
            return True
    return False


def _apart(
    problem: Problem, i: int, path: Curve, k: int, beside: Curve, count: int
) -> tuple[Callable[[int], np.ndarray], float, float]:
    """Gaps of samples, how large they have to be [m], and how much they change within half a step of both paths."""
    own, other = problem.robots[i].footprint, problem.robots[k].footprint
    here, there = points(path, count), points(beside, count)
    slack, clearance = (path.length + beside.length) / count / 2 + ROUNDING, problem.workspace.clearance
    if own.is_exact or other.is_exact:
        half = [max(x for x, _ in one.vertices) if one.is_exact else one.radius for one in (own, other)]
        return squares_apart(here, there, sum(half)), clearance, slack
    return discs_apart(here, there), own.radius + other.radius + clearance, slack


def points(path: Curve, count: int) -> np.ndarray:
    """The points (count + 1, 2) of a path at even arc lengths, summed up from its headings alone."""
    length = path.length
    fine = math.ceil(length / count / STEP)
    if not len(path.pieces):
        return np.tile(path.start[:2], (count + 1, 1))
    s = (np.arange(count * fine) + 0.5) * length / (count * fine)
    edges = np.concatenate([[0.0], np.cumsum(path.pieces[:, 0])])
    piece = np.clip(np.searchsorted(edges, s, side="right") - 1, 0, len(path.pieces) - 1)
    h, k0, k1 = path.pieces.T
    turned = path.start[2] + np.concatenate([[0.0], np.cumsum(h * (k0 + k1) / 2)])
    u = s - edges[piece]
    heading = turned[piece] + u * (k0[piece] + u * (k1 - k0)[piece] / h[piece] / 2)
    steps = np.stack([np.cos(heading), np.sin(heading)], axis=1) * length / (count * fine)
    at = np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)]) + path.start[:2]
    return np.asarray(at[::fine])


def discs_apart(here: np.ndarray, there: np.ndarray) -> Callable[[int], np.ndarray]:
    """For each sample of one path the distances [m] of all samples of the other."""
    return lambda row: np.hypot(*(there - here[row]).T)


def squares_apart(here: np.ndarray, there: np.ndarray, halves: float) -> Callable[[int], np.ndarray]:
    """The same between squares that do not turn, below 0 where they overlap; ``halves`` : half sides, added up."""

    def gaps(row: int) -> np.ndarray:
        beyond = abs(there - here[row]) - halves
        return np.asarray(np.hypot(*np.maximum(beyond, 0.0).T) + np.minimum(beyond.max(axis=1), 0.0))

    return gaps


def walk(gaps: Callable[[int], np.ndarray], least: float, count: int, *, leave: bool) -> bool:
    """Whether samples at least so far apart [m] lead from both starts to both goals, or to that of one who leaves."""
    reached = np.zeros(count, dtype=np.bool_)
    reached[0] = True
    for row in range(count):
        free = gaps(row) >= least
        begins = reached.copy()
        begins[1:] |= reached[:-1]
        if row == 0:
            begins[1:] = False
        begins &= free
        # a run of free samples is reached from its first beginning on
        at = np.arange(count)
        closed = np.maximum.accumulate(np.where(free, -1, at))
        begun = np.maximum.accumulate(np.where(begins, at, -1))
        reached = free & (begun > closed)
        if leave and reached[-1]:
            return True
        if not reached.any():
            return False
    return bool(reached.any() if leave else reached[-1])


def table(rows: Sequence[Row]) -> None:
    """Kinds beside outcomes, the longest runs, and the promises."""
    print(f"| kind | problems | {' | '.join(OUTCOMES)} | longest run [s] |")
    print(f"|{'---|' * (len(OUTCOMES) + 3)}")
    for kind in (*KINDS, "all"):
        own = [row for row in rows if kind in (row.kind, "all")]
        counts = [sum(row.outcome == outcome for row in own) for outcome in OUTCOMES]
        longest = max((row.seconds for row in own), default=0.0)
        print(f"| {kind} | {len(own)} | {' | '.join(map(str, counts))} | {longest:.1f} |")
    without = sum(row.outcome == NO_REASON for row in rows) / max(len(rows), 1)
    late = [row for row in rows if row.outcome == LATE]
    print(f"\nno reason found: {100 * without:.1f} % (promised: at most {100 * WITHOUT:g} %)")
    print(f"unconfirmed: {sum(row.outcome == UNCONFIRMED for row in rows)} (promised: 0)")
    print(f"runs over {LONGEST:g} s: {len(late)} (promised: 0)")
    for row in rows:
        if row.outcome not in (CERTIFIED, CONFIRMED):
            print(f"  {row.kind} {row.number}: {row.robots} robots, {row.outcome}, {row.reasons}, {row.seconds:.1f} s")


def keep(rows: Iterable[Row], folder: Path) -> None:
    """Write both files."""
    rows = sorted(rows, key=lambda row: (list(KINDS).index(row.kind), row.number))
    seconds = [(row.kind, row.number, row.robots, f"{row.seconds:.3f}") for row in rows]
    head = (*SECONDS[:3], f"{SECONDS[3]}, {platform.machine()}")
    for name, lines in (
        ("arrival.csv", [COLUMNS, *(row.figures() for row in rows)]),
        ("arrival_seconds.csv", [head, *seconds]),
    ):
        with (folder / name).open("w", newline="", encoding="utf-8") as stream:
            csv.writer(stream).writerows(lines)


def kept(folder: Path) -> dict[tuple[str, int], Row]:
    """The rows of both files, none where there are none yet."""
    both = [folder / name for name in ("arrival.csv", "arrival_seconds.csv")]
    if not all(file.is_file() for file in both):
        return {}
    lines = [list(csv.reader(file.read_text(encoding="utf-8").splitlines()))[1:] for file in both]
    return {
        (kind, int(number)): Row(
            kind, int(number), int(robots), outcome, reasons, int(beside), arrivals, float(own[-1])
        )
        for (kind, number, robots, outcome, reasons, beside, arrivals), own in zip(*lines, strict=True)
    }


def main() -> None:
    """Plan, confirm, print, keep."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--numbers", default=f"0:{NUMBERS}", help="of each kind, from the first to before the last")
    parser.add_argument("--csv", type=Path, help="folder for arrival.csv and arrival_seconds.csv")
    parser.add_argument("--table", action="store_true", help="only print the table of what is kept")
    arguments = parser.parse_args()
    rows = kept(arguments.csv) if arguments.csv else {}
    signal.signal(signal.SIGPROF, too_late)
    first, last = map(int, arguments.numbers.split(":"))
    for kind in [] if arguments.table else arguments.kinds:
        for number in range(first, last):
            row = measured(kind, number)
            rows[kind, number] = row
            told = f"{kind} {number}: {row.robots} robots, {row.outcome}, {row.seconds:.1f} s"
            print(told, file=sys.stderr, flush=True)
            if arguments.csv:
                keep(rows.values(), arguments.csv)
    print(f"{platform.machine()}, Python {platform.python_version()}; sizes {SIZES[0]} to {SIZES[-1]}\n")
    table(list(rows.values()))


if __name__ == "__main__":
    main()
