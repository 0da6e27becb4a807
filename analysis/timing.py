"""The benchmark of the timing stage: ``python analysis/timing.py [--robots 2000] [--csv FOLDER] [PLACE ...]``.

Robots of generated families (crossing, following, merging, parked, curved: a seed a scene), of ``problems/`` and of
further problem files or folders (PLACE) are timed one after the other, as quickly as they can and gently. Of the
delayed ones is told how far the arrival is from the certified lower bound given the robots before, with straight
paths and paths with bends apart; how often a choice stayed open; and the squared jerk. Scenes with a blocking cycle
are left out, and counted.

What is the same on every machine goes to ``timing.csv``, processor times to ``timing_seconds.csv``.
"""

from __future__ import annotations

import argparse
import csv
import math
import platform
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coord import read_problem
from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import conflict_regions
from coord.coordination.blocking import blocking_arcs
from coord.coordination.order import topological_order, urgency
from coord.errors import CoordError
from coord.model.footprint import Footprint
from coord.model.problem import Problem, Workspace
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.timing.ego import Ego, ego
from coord.timing.meeting import Ends, Meeting
from coord.timing.passing import Timing, time_robot

HERE = Path(__file__).resolve().parent
PROFILES = ("fastest", "gentle")
COLUMNS = ("family", "paths", "robots", "delayed", "gap median [%]", "gap p99 [%]", "gap worst [%]", "open choices",
           "squared jerk gentle / fastest", "arrivals gentle / fastest")  # fmt: skip

#: [m] Side of the floor of generated scenes.
SIZE = 30.0


@dataclass(frozen=True)
class Row:
    """One robot: what it is like and what became of it under both profiles."""

    family: str
    is_straight: bool
    timings: dict[str, Timing]
    seconds: dict[str, float]

    @property
    def is_delayed(self) -> bool:
        """Whether the robots before it hold it up."""
        return self.timings["fastest"].how != "alone"

    @property
    def gap(self) -> float:
        """(arrival - bound) / bound, as quick as it can."""
        quick = self.timings["fastest"]
        return quick.profile.arrival / quick.lower_bound - 1


def drives(rng: np.random.Generator) -> Limits:
    """Limits between a slow cart and a quick one."""
    return Limits(*np.round(rng.uniform((0.6, 0.3, 0.3, 0.5, 0.2), (1.8, 1.2, 1.2, 3.0, 0.8)), 2).tolist())


def crossing(rng: np.random.Generator) -> Iterator[tuple[list[tuple[float, float]], float]]:
    """From side to side on straight lines, at any slant."""
    while True:
        a, b = np.round(rng.uniform(2, SIZE - 2, 2), 2).tolist()
        ends = [(1.0, a), (SIZE - 1, b)] if rng.integers(2) else [(a, 1.0), (b, SIZE - 1)]
        yield ends[:: int(rng.choice([-1, 1]))], float(rng.choice([0.0, 3.0]))


def following(rng: np.random.Generator) -> Iterator[tuple[list[tuple[float, float]], float]]:
    """Along few lanes in one direction, one behind the other, across other such lanes."""
    used = dict.fromkeys(range(8), 1.0)
    while True:
        lane = int(rng.integers(8))
        at, used[lane] = used[lane], used[lane] + float(np.round(rng.uniform(0.9, 2.0), 2))
        y, length = 4.0 + 3.0 * (lane % 4) * 2, SIZE - 14
        way = [(at, y), (at + length, y)]
        yield [(q, p) for p, q in way] if lane >= 4 else way, 0.0


def merging(rng: np.random.Generator) -> Iterator[tuple[list[tuple[float, float]], float]]:
    """From both sides into one lane, along it, and out again."""
    while True:
        a, b = np.round(rng.uniform(1, SIZE - 1, 2), 2).tolist()
        yield [(1.0, a), (8.0, SIZE / 2), (SIZE - 8.0, SIZE / 2), (SIZE - 1.0, b)], float(rng.choice([0.0, 4.0]))


def parked(rng: np.random.Generator) -> Iterator[tuple[list[tuple[float, float]], float]]:
    """Crossing the floor, where others stand that leave only later."""
    across = crossing(rng)
    while True:
        if rng.integers(3):
            yield next(across)
        else:
            x, y = np.round(rng.uniform(6, SIZE - 6, 2), 2).tolist()
            away = float(np.round(rng.uniform(1, SIZE - 1), 2))
            yield [(x, y), (away, float(rng.choice([1.0, SIZE - 1.0])))], float(np.round(rng.uniform(2, 15), 1))


def curved(rng: np.random.Generator) -> Iterator[tuple[list[tuple[float, float]], float]]:
    """Across the middle with two bends."""
    while True:
        turn, side = rng.uniform(0, 2 * np.pi), rng.uniform(-4, 4)
        c, s, off = math.cos(turn), math.sin(turn), rng.uniform(-4, 4)
        corners = [(-12.0, off), (-3.0, off), (3.0, off + side), (12.0, off + side)]
        way = [(SIZE / 2 + x * c - y * s, SIZE / 2 + x * s + y * c) for x, y in corners]
        yield [(round(x, 3), round(y, 3)) for x, y in way], float(rng.choice([0.0, 3.0]))


FAMILIES = {family.__name__: family for family in (crossing, following, merging, parked, curved)}


def generated(family: str, seed: int, count: int = 14) -> Problem:
    """A scene of so many robots, starts and goals apart from each other."""
    rng = np.random.default_rng([seed, list(FAMILIES).index(family)])
    robots: list[Robot] = []
    used: list[tuple[float, float]] = []
    for way, release in FAMILIES[family](rng):
        if len(robots) == count:
            break
        ends = (way[0], way[-1])
        if any(math.dist(p, q) < 0.8 for p in ends for q in used) or math.dist(*ends) < 5:
            continue
        used += ends
        name = f"{family[0]}{len(robots)}"
        robots.append(Robot(name, Footprint(0.3), drives(rng), *ends, release=release, path=tuple(way)))
    return Problem(f"{family}_{seed}", Workspace((-SIZE, -SIZE, 2 * SIZE, 2 * SIZE), 0.05), tuple(robots))


def meetings_of(egos: Sequence[Ego], chains: Sequence[object], i: int, others: Sequence[int], blocked: set[object],
                clearance: float, timings: dict[int, Timing]) -> list[Meeting]:  # fmt: skip
    """All meetings of robot i with others that have a profile."""
    found = []
    for k in others:
        ends = Ends((i, k, "start") not in blocked, (i, k, "goal") not in blocked,
                    (k, i, "start") in blocked, (k, i, "goal") in blocked)  # fmt: skip
        mine, theirs = egos[i].robot.footprint, egos[k].robot.footprint
        regions = conflict_regions(
            chains[i], chains[k], mine.margin + theirs.margin + clearance, conflict_core(mine.core, theirs.core),
            start_free=ends.start_free, goal_free=ends.goal_free,
        )  # fmt: skip
        found += [Meeting(region, k, timings[k].profile, ends, egos[i].length) for region in regions]
    return found


def timed(problem: Problem, family: str) -> list[Row] | None:
    """A row for each robot; None where no order is possible."""
    robots, clearance = problem.robots, problem.workspace.clearance
    egos = [ego(robot, route.path, route.alone) for robot, route in zip(robots, find_routes(problem), strict=True)]
    chains = [chords(one.path) for one in egos]
    pairs = candidate_pairs(chains, [robot.footprint.radius + clearance / 2 for robot in robots])
    arcs = blocking_arcs(robots, [one.path for one in egos], pairs, clearance)
    names = [robot.name for robot in robots]
    order = topological_order(urgency([r.priority for r in robots], [e.alone.arrival for e in egos]), names, arcs)
    if order is None:
        return None
    index = {name: i for i, name in enumerate(names)}
    blocked = {
        (
            index[arc.first if arc.at == "start" else arc.then],
            index[arc.then if arc.at == "start" else arc.first],
            arc.at,
        )
        for arc in arcs
    }
    near: dict[int, list[int]] = {i: [] for i in range(len(robots))}
    for i, k in pairs:
        near[i].append(k)
        near[k].append(i)
    found: dict[str, dict[int, Timing]] = {}
    seconds: dict[str, dict[int, float]] = {}
    for profile in PROFILES:
        timings, taken = found.setdefault(profile, {}), seconds.setdefault(profile, {})
        for i in order:
            began = time.process_time()
            before = [k for k in near[i] if k in timings]
            timing = time_robot(
                egos[i], meetings_of(egos, chains, i, before, blocked, clearance, timings), profile=profile
            )
            if timing is None:
                return None
            timings[i], taken[i] = timing, time.process_time() - began
    return [
        Row(family, egos[i].caps.is_constant, {p: found[p][i] for p in PROFILES}, {p: seconds[p][i] for p in PROFILES})
        for i in range(len(robots))
    ]


def squared_jerk(profile: VelocityProfile) -> float:
    """Integral of the squared jerk [m2/s5]."""
    return float((np.diff(profile.times) * profile.jerks**2).sum())


def summary(name: str, paths: str, rows: Sequence[Row]) -> tuple[str, ...]:
    """One line of the table."""
    delayed = [row for row in rows if row.is_delayed]
    gaps = 100 * np.array([row.gap for row in delayed] or [0.0])
    jerk = [math.fsum(squared_jerk(row.timings[p].profile) for row in delayed) for p in PROFILES]
    arrivals = [math.fsum(row.timings[p].profile.arrival for row in rows) for p in PROFILES]
    figures = [f"{value:.3f}" for value in (np.median(gaps), np.quantile(gaps, 0.99), gaps.max())]
    still_open = sum(row.timings["fastest"].open for row in rows)
    smoother = f"{jerk[1] / jerk[0]:.3f}" if delayed else ""
    return (name, paths, str(len(rows)), str(len(delayed)), *figures, str(still_open), smoother,
            f"{arrivals[1] / arrivals[0]:.5f}")  # fmt: skip


def problems_in(places: Sequence[Path]) -> Iterator[tuple[str, Problem]]:
    """Family and problem of every problem file that can be read."""
    files = [file for place in places for file in ([place] if place.is_file() else sorted(place.rglob("*.toml")))]
    for file in files:
        if file.name == "best_known.toml":
            continue
        try:
            yield file.stem.split("_")[0], read_problem(file)
        except CoordError as error:
            print(f"{file.name}: not read: {str(error).splitlines()[0]}", file=sys.stderr)


def all_rows(robots: int, places: Sequence[Path], note: Callable[[str], None]) -> list[Row]:
    """Rows of the generated families, so many robots in all, then of the problem files."""
    rows: list[Row] = []
    for family in FAMILIES:
        count = seed = cycles = 0
        while count < robots / len(FAMILIES):
            found = timed(generated(family, seed), family)
            seed, cycles = seed + 1, cycles + (found is None)
            rows, count = rows + (found or []), count + len(found or [])
        note(f"{family}: {seed} scenes, {cycles} of them left out because of a blocking cycle")
    for family, problem in problems_in(places):
        try:
            found = timed(problem, family)
        except CoordError as error:
            found = None
            note(f"{problem.name}: {str(error).splitlines()[0]}")
        rows += found or []
        if found is None:
            note(f"{problem.name}: no order, or no way")
    return rows


def main() -> None:
    """Time, print, and keep what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("places", nargs="*", type=Path)
    parser.add_argument("--robots", type=int, default=2000)
    parser.add_argument("--csv", type=Path, default=HERE)
    arguments = parser.parse_args()
    rows = all_rows(
        arguments.robots, [HERE.parent / "problems", *arguments.places], lambda text: print(text, file=sys.stderr)
    )
    families = list(dict.fromkeys(row.family for row in rows))
    table, wall = [], []
    for name in [*families, "all"]:
        own = [row for row in rows if name in (row.family, "all")]
        for paths, some in (
            ("straight", [r for r in own if r.is_straight]),
            ("bends", [r for r in own if not r.is_straight]),
        ):
            if some:
                table.append(summary(name, paths, some))
                wall.append((name, paths, *(f"{1000 * np.mean([r.seconds[p] for r in some]):.2f}" for p in PROFILES)))
    print("| " + " | ".join(COLUMNS) + " | ms a robot |\n|" + "---|" * (len(COLUMNS) + 1))
    for line, (_, _, *cost) in zip(table, wall, strict=True):
        print("| " + " | ".join([*line, " / ".join(cost)]) + " |")
    for file, head, lines in (
        ("timing.csv", COLUMNS, table),
        (
            "timing_seconds.csv",
            ("family", "paths", *(f"ms a robot, {p}, {platform.machine()}" for p in PROFILES)),
            wall,
        ),
    ):
        with (arguments.csv / file).open("w", newline="", encoding="utf-8") as stream:
            csv.writer(stream, lineterminator="\n").writerows([head, *lines])


if __name__ == "__main__":
    sys.exit(main())
