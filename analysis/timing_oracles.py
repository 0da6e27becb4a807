"""The timing stage against three second opinions: ``python analysis/timing_oracles.py [--cases 200] [--csv FILE]``.

A robot "ego" crosses lanes on which others pass at about the worst moments; its profile is the fastest against those
before it. The second opinions share no code with the timing stage: where the others are forbidden to be is worked out
for discs on straight lines in closed form.

- ``choices``: all combinations of before and after, each the least arrival of a linear program on an even time grid
  (HiGHS, the tube at the knots), found by halving.
- ``no jerk``: the same with a very large jerk limit against a program that knows no jerk at all.
- ``lattice``: all motions in steps of half a second with jerk -1, 0 or 1 m/s3, place and time forbidden or not, no
  notion of before and after; also on ways with a bend. It may be later, but never earlier.

Kept in ``timing_oracles.csv``: for each case the arrival, the certified bound, the second opinion and the difference.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import itertools
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import casadi
import numpy as np

from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.result import RobotPlan
from coord.model.robot import Limits, Robot
from coord.plan import plan

HERE = Path(__file__).resolve().parent
COLUMNS = ("check", "seed", "meetings", "combinations", "how", "arrival [s]", "bound [s]", "oracle [s]",
           "arrival / oracle - 1")  # fmt: skip

#: The promise: no second opinion is quicker by more than this share of the arrival.
PROMISED = 1e-3

#: The programs' own error, as a share: the tube is kept at the knots alone, and the halving ends at half of this.
RESOLVED = 2e-4

#: A jerk limit [m/s3] that leaves nothing of the jerk.
NO_JERK = 2000.0

#: Cells of the programs' time grids.
CELLS = 256

#: [m] The lattice's unit of length: steps of 0.5 s with jerks of -1, 0, 1 m/s3 move by multiples of it.
UNIT = 1 / 48


@dataclass(frozen=True)
class Row:
    """One case of one check."""

    check: str
    seed: int
    meetings: int
    combinations: int
    how: str
    arrival: float
    bound: float
    oracle: float

    @property
    def excess(self) -> float:
        """How much later the arrival is than the oracle's, as a share."""
        return self.arrival / self.oracle - 1


def lanes(seed: int, *, most: int = 4, jerk: float | None = None, bend: bool = False) -> Problem:
    """Two lanes or more, 2 m apart, on each a robot that crosses the way of "ego" at about the worst moment."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, most + 1))
    robots = []
    for k in range(count):
        x, up = 3.0 + 2 * k, rng.integers(2)
        start, goal = ((x, 1.0), (x, 15.0)) if up else ((x, 15.0), (x, 1.0))
        limits = Limits(*np.round(rng.uniform((0.8, 0.3, 0.3, 0.4, 0.3), (1.5, 1.0, 1.0, 3.0, 1.2)), 2).tolist())
        halfway = 7 / limits.speed + limits.speed / limits.acceleration / 2 + limits.acceleration / limits.jerk / 2
        meets = 1.25 + (x + 7.0) + (0.0 if seed % 2 else 0.4 * k) + 4.0 * bend + rng.uniform(-1.2, 1.5)
        release = float(np.round(max(0.0, meets - halfway), 2))
        robots.append(Robot(f"k{k}", Footprint(0.4), limits, start, goal, priority=1.0, release=release))
    goal = (3.0 + 2 * count, 8.0)
    # cap in the bend: 0.5 m/s on a radius of 1 m
    limits = Limits(1.0, 0.5, 0.5, jerk or 1.0, 0.25)
    # what the fillet saves is added, so that the length is a whole number of metres, as the lattice needs it
    way = ((-4.0, 5.0 - (2 - np.pi / 2)), (-4.0, 8.0), goal) if bend else ()
    start = way[0] if bend else (-7.0, 8.0)
    robots.append(Robot("ego", Footprint(0.4), limits, start, goal, priority=2.0, path=way, corner_radius=1.0))
    if jerk is not None:
        robots = [dataclasses.replace(one, limits=dataclasses.replace(one.limits, jerk=jerk)) for one in robots]
    return Problem("lanes", Workspace((-10.0, 0.0, 20.0, 16.0), 0.05), tuple(robots))


def planned(problem: Problem) -> tuple[RobotPlan, list[RobotPlan]] | None:
    """Ego and the others as planned, as quick as they can; None where there is no plan."""
    found = plan(problem, Options(profile="fastest")).plan
    if found is None:
        return None
    by_name = {one.robot.name: one for one in found.robots}
    return by_name["ego"], [one for name, one in by_name.items() if name != "ego"]


def reach(ego: RobotPlan, other: RobotPlan) -> float:
    """The least distance [m] of the centres."""
    return ego.robot.footprint.radius + other.robot.footprint.radius + 0.05


def forbidden(ego: RobotPlan, other: RobotPlan, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Arc lengths of ego on its straight path, too near to the other at the times; (inf, -inf) where none is."""
    along = np.array([np.cos(ego.path.start[2]), np.sin(ego.path.start[2])])
    gap = np.array(ego.robot.start) - other.path.point(other.profile.state(times)[:, 0])
    b, rest = gap @ along, reach(ego, other) ** 2 - (gap**2).sum(axis=1)
    root = np.sqrt(np.maximum(b * b + rest, 0.0))
    low, high = -b - root, -b + root
    away = (b * b + rest <= 0) | (high <= 0) | (low >= ego.path.length)
    return np.where(away, np.inf, low), np.where(away, -np.inf, high)


class Program:
    """Whether a motion from rest to rest fits into a tube, by HiGHS, on an even time grid.

    In each cell the jerk is constant; with ``order`` 2 the acceleration is.
    """

    def __init__(self, limits: Limits, length: float, order: int, cells: int) -> None:
        self.limits, self.length, self.order, self.cells = limits, length, order, cells
        # of each equation of motion the columns, with 0 for the state itself and -1, -2, -3 for the power of h
        steps = [[(i + k, -k) for k in range(order + 1 - i)] for i in range(order)]
        entries = [
            (order * k + i, (order + 1) * k + j, power)
            for k in range(cells)
            for i, row in enumerate(steps)
            for j, power in (*row, (order + 1 + i, 1))
        ]
        self.rows, self.columns, self.powers = (np.array(part) for part in zip(*entries, strict=True))
        pattern = self._matrix(np.ones(len(entries))).sparsity()
        options = {"error_on_fail": False, "highs": {"output_flag": False}}
        self.solver = casadi.conic("fits", "highs", {"a": pattern}, options)

    def fits(self, h: float, lower: np.ndarray, upper: np.ndarray) -> bool:
        """Whether a motion with cells of ``h`` [s] keeps the bounds at the knots."""
        n, order, limits = self.cells, self.order, self.limits
        box = np.zeros((2, n + 1, order + 1))
        box[:, :, 0] = np.maximum(lower, 0.0), np.minimum(upper, self.length)
        box[1, :, 1] = limits.speed
        box[:, :, 2] = np.array([[-limits.deceleration], [limits.acceleration]])
        if order == 3:
            box[:, :, 3] = np.array([[-limits.jerk], [limits.jerk]])
        box[:, 0, :order] = box[:, -1, :order] = 0.0
        box[:, -1, 0] = self.length
        low, high = box.reshape(2, -1)[:, :-1]
        if upper[-1] < self.length or np.any(low > high):
            return False
        values = np.zeros(len(self.rows))
        for power, factor in ((1, 1.0), (0, -1.0), (-1, -h), (-2, -(h**2) / 2), (-3, -(h**3) / 6)):
            values[self.powers == power] = factor
        self.solver(g=0, a=self._matrix(values), lba=0, uba=0, lbx=low, ubx=high)
        return bool(self.solver.stats()["success"])

    def _matrix(self, values: np.ndarray) -> casadi.DM:
        size = (self.order * self.cells, (self.order + 1) * self.cells + self.order)
        return casadi.DM.triplet(self.rows.tolist(), self.columns.tolist(), casadi.DM(values), *size)


def tubes(ego: RobotPlan, others: Sequence[RobotPlan], t: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Bounds on s at the times, for every combination of before and after."""
    horizon = max([float(t[-1]), *(other.arrival for other in others)]) + 1
    fine = np.unique(np.concatenate([np.linspace(0.0, horizon, 4000), t]))
    choices = []
    for other in others:
        low, high = forbidden(ego, other, fine)
        if not np.isfinite(low).any():
            continue
        after, before = np.minimum.accumulate(low[::-1])[::-1], np.maximum.accumulate(high)
        pair = []
        if low[fine >= t[-1]].min() >= ego.path.length:
            pair.append((np.full(len(t), -np.inf), np.interp(t, fine, np.minimum(after, 1e6))))
        if before[-1] <= ego.path.length:
            pair.append((np.interp(t, fine, np.maximum(before, -1e6)), np.full(len(t), np.inf)))
        choices.append(pair)
    for combination in itertools.product(*choices):
        yield (
            np.max([np.full(len(t), -np.inf), *(pair[0] for pair in combination)], axis=0),
            np.min([np.full(len(t), np.inf), *(pair[1] for pair in combination)], axis=0),
        )


def least_by_choices(ego: RobotPlan, others: Sequence[RobotPlan], order: int, cells: int) -> tuple[float, int]:
    """The least arrival [s] over all combinations, within 2 % of the one planned, and how many there are."""
    program = Program(ego.robot.limits, ego.path.length, order, cells)
    release, count = ego.robot.release, 0

    def possible(arrival: float) -> bool:
        nonlocal count
        t = np.linspace(release, arrival, cells + 1)
        combinations = list(tubes(ego, others, t))
        count = max(count, len(combinations))
        return any(program.fits((arrival - release) / cells, *tube) for tube in combinations)

    low, high = 0.98 * ego.arrival, 1.02 * ego.arrival
    if possible(low):
        return low, count
    while high - low > RESOLVED / 2 * ego.arrival:
        middle = (low + high) / 2
        low, high = (low, middle) if possible(middle) else (middle, high)
    return high, count


def least_on_lattice(
    ego: RobotPlan, others: Sequence[RobotPlan], cap: Callable[[np.ndarray], np.ndarray], most: int = 160
) -> float:
    """Earliest arrival of all motions in steps of half a second with jerk -1, 0 or 1 m/s3 that keep clear.

    Speed in eighths, acceleration in halves, distance in 1/48 m; v(t) is monotone within a step. ``cap`` : largest
    speed at arc lengths.
    """
    states, goal = np.array([[0, 0, 0]]), int(np.ceil(ego.path.length / UNIT - 1e-6))
    for step in range(most):
        found = []
        for j in (-1, 0, 1):
            s, v, a = states.T
            after = np.stack([s + 3 * v + 3 * a + j, v + 2 * a + j, a + j], axis=1)
            keep = (np.abs(after[:, 2]) <= 1) & (after[:, 1] >= 0) & (after[:, 1] <= 8) & (after[:, 0] <= goal)
            states_j, after = states[keep], after[keep]
            s, v, a = states_j.T
            clear = np.ones(len(after), bool)
            for share in np.linspace(0.0, 1.0, 13):
                h = 0.5 * share
                at = s * UNIT + h * (v / 8 + h * (a / 4 + h * j / 6))
                speed = v / 8 + h * (a / 2 + h * j / 2)
                places = ego.path.point(at)
                clear &= speed <= cap(at) + 1e-9
                for other in others:
                    there = other.path.point(other.profile.state([0.5 * (step + share)])[:, 0])
                    clear &= np.hypot(*(places - there).T) > reach(ego, other)
            found.append(after[clear])
        states = np.unique(np.concatenate(found), axis=0)
        if (states == [goal, 0, 0]).all(axis=1).any():
            return 0.5 * (step + 1)
    return np.inf


def row(check: str, seed: int, ego: RobotPlan, others: Sequence[RobotPlan], oracle: float, count: int) -> Row:
    """The row of a case."""
    return Row(check, seed, len(others), count, ego.how, ego.arrival, ego.lower_bound, oracle)


def choices(seed: int, cells: int = CELLS) -> Row | None:
    """Brute force over before and after; None where ego is not delayed.

    The oracle keeps clear at its knots alone, which makes it a little too early, and changes its jerk at these alone,
    which makes it late. Where it differs from the plan, it is asked again with shorter cells.
    """
    found = planned(lanes(seed))
    if found is None or found[0].how == "alone":
        return None
    first = row("choices", seed, *found, *least_by_choices(*found, 3, cells))
    if abs(first.excess) <= PROMISED:
        return first
    return row("choices", seed, *found, *least_by_choices(*found, 3, 4 * cells))


def without_jerk(seed: int, cells: int = CELLS) -> Row | None:
    """The same with jerk all but free, against a program without any."""
    found = planned(lanes(seed, jerk=NO_JERK))
    if found is None or found[0].how == "alone":
        return None
    return row("no jerk", seed, *found, *least_by_choices(*found, 2, cells))


def lattice(seed: int) -> Row | None:
    """All motions on a lattice, on a straight way or on one with a bend; None as above."""
    bend = bool(seed % 2)
    found = planned(lanes(seed, bend=bend))
    if found is None or found[0].how == "alone":
        return None
    ego, others = found

    def cap(s: np.ndarray) -> np.ndarray:
        k = np.abs(ego.path.curvature(s))
        return np.minimum(1.0, np.sqrt(0.25 / np.maximum(k, 1e-9)))

    least = least_on_lattice(ego, others, cap)
    return row("lattice, bend" if bend else "lattice", seed, ego, others, least, 0)


CHECKS = {"choices": choices, "no jerk": without_jerk, "lattice": lattice}


def main() -> None:
    """Check, print, and keep what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--check", choices=[*CHECKS], action="append")
    parser.add_argument("--csv", type=Path, default=HERE / "timing_oracles.csv")
    arguments = parser.parse_args()
    rows: list[Row] = []
    for name in arguments.check or CHECKS:
        cases = arguments.cases if name == "choices" else max(arguments.cases // 4, 1)
        found = (CHECKS[name](seed) for seed in itertools.count())
        own = list(itertools.islice((one for one in found if one is not None), cases))
        rows += own
        late = np.array([one.excess for one in own])
        beaten = int((late > PROMISED).sum())
        apart = "" if name == "lattice" else f"apart by more: {int((np.abs(late) > PROMISED).sum())}; "
        above = sum(one.bound > one.oracle * (1 + RESOLVED) for one in own)
        print(f"{name}: {len(own)} cases; arrival / oracle - 1: median {np.median(late):.1e}, from {late.min():.1e} to "
              f"{late.max():.1e}; beaten by more than {PROMISED:g}: {beaten}; {apart}"
              f"bound above the oracle by more than {RESOLVED:g}: {above}")  # fmt: skip
        sys.stdout.flush()
    with arguments.csv.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(COLUMNS)
        for one in rows:
            writer.writerow((one.check, one.seed, one.meetings, one.combinations, one.how, f"{one.arrival:.5f}",
                             f"{one.bound:.5f}", f"{one.oracle:.5f}", f"{one.excess:.2e}"))  # fmt: skip


if __name__ == "__main__":
    sys.exit(main())
