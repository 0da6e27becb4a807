"""Scenes of robots on straight lines, the plain truth about them, and a slow second way to the best arrival."""

from __future__ import annotations

import itertools

import casadi
import numpy as np
import pytest

from coord.conflicts.chords import chords
from coord.conflicts.region import conflict_regions
from coord.conflicts.rest import runs_over
from coord.model.footprint import Footprint
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.timing.ego import ego
from coord.timing.meeting import Ends, Meeting
from coord.timing.passing import time_robot

LARGE = Workspace((-40.0, -40.0, 60.0, 60.0), 0.05)


def _lanes(seed):
    """Three to five lanes 2 m apart, on each a robot that crosses the way of "ego" at about the worst moment."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 6))
    robots = []
    for k in range(count):
        x, up = 3.0 + 2 * k, rng.integers(2)
        start, goal = ((x, 1.0), (x, 15.0)) if up else ((x, 15.0), (x, 1.0))
        limits = Limits(*np.round(rng.uniform((0.8, 0.3, 0.3, 0.4, 0.3), (1.5, 1.0, 1.0, 3.0, 1.2)), 2).tolist())
        halfway = 7 / limits.speed + limits.speed / limits.acceleration / 2 + limits.acceleration / limits.jerk / 2
        meets = 1.25 + (x + 7.4) + (0.0 if seed % 2 else 0.4 * k) + rng.uniform(-1.2, 1.5)
        release = float(np.round(max(0.0, meets - halfway), 2))
        robots.append(Robot(f"k{k}", Footprint(0.4), limits, start, goal, priority=1.0, release=release))
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    robots.append(Robot("ego", Footprint(0.4), limits, (-7.4, 8.0), (3.0 + 2 * count, 8.0), priority=2.0))
    return Problem("lanes", Workspace((-10.0, 0.0, 20.0, 16.0), 0.05), tuple(robots))


@pytest.fixture(scope="session")
def lanes():
    """seed -> a problem."""
    return _lanes


def _crossroads(seed, count=6, size=14.0):
    """Robots of all sizes and speeds between the sides of a square; starts and goals apart from each other."""
    rng = np.random.default_rng(seed)
    robots, used = [], []
    while len(robots) < count:
        ends = []
        for _ in range(2):
            along = float(np.round(rng.uniform(2, size - 2), 2))
            ends.append(((1.0, along), (size - 1, along), (along, 1.0), (along, size - 1))[rng.integers(4)])
        places = np.array([*ends, *used])
        gaps = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) + 9 * np.eye(len(places))
        if gaps[:2].min() < 1.2 or gaps[0, 1] < 4:
            continue
        used += ends
        limits = Limits(*np.round(rng.uniform((0.5, 0.3, 0.3, 0.4, 0.3), (2.0, 1.5, 1.5, 4.0, 1.2)), 2).tolist())
        radius, release = float(np.round(rng.uniform(0.15, 0.45), 2)), float(rng.choice([0.0, 0.0, 1.5, 4.0]))
        robots.append(Robot(f"r{len(robots)}", Footprint(radius), limits, *ends, release=release))
    return Problem("crossroads", Workspace((0.0, 0.0, size, size), 0.05), tuple(robots))


@pytest.fixture(scope="session")
def crossroads():
    """(seed, count) -> a problem, which may have a blocking cycle."""
    return _crossroads


def _least_gap(plan, samples=4000):
    """Least distance between any two footprints less the clearance [m], sampled over the whole plan."""
    t = np.linspace(0.0, plan.makespan + 1.0, samples)
    at = [one.path.point(one.profile.state(t)[:, 0]) for one in plan.robots]
    radii = [one.robot.footprint.radius for one in plan.robots]
    gaps = [
        np.hypot(*(at[i] - at[k]).T).min() - radii[i] - radii[k] for i, k in itertools.combinations(range(len(at)), 2)
    ]
    return min(gaps, default=np.inf) - plan.problem.workspace.clearance


@pytest.fixture(scope="session")
def least_gap():
    """plan -> sampled least distance less the clearance."""
    return _least_gap


def _interval(mine, other, clearance, t):
    """Forbidden arc lengths of a robot on a straight path at the times t, in closed form; (inf, -inf) where none is."""
    reach = mine.robot.footprint.radius + other.robot.footprint.radius + clearance
    along = np.array([np.cos(mine.path.start[2]), np.sin(mine.path.start[2])])
    gap = np.array(mine.robot.start) - other.path.point(other.profile.state(t)[:, 0])
    b, rest = gap @ along, reach**2 - (gap**2).sum(axis=1)
    root = np.sqrt(np.maximum(b * b + rest, 0.0))
    low, high = -b - root, -b + root
    away = (b * b + rest <= 0) | (high <= 0) | (low >= mine.path.length)
    return np.where(away, np.inf, low), np.where(away, -np.inf, high)


def _fits(limits, h, lower, upper, length):
    """Whether HiGHS finds jerks on an even grid that keep the limits and, at the knots, the bounds on s."""
    n = len(lower) - 1
    steps = {
        0: ((0, -1.0), (1, -h), (2, -h * h / 2), (3, -(h**3) / 6)),
        1: ((1, -1.0), (2, -h), (3, -h * h / 2)),
        2: ((2, -1.0), (3, -h)),
    }
    entries = [
        (3 * k + i, 4 * k + j, value) for k in range(n) for i, row in steps.items() for j, value in (*row, (4 + i, 1.0))
    ]
    rows, columns, values = map(list, zip(*entries, strict=True))
    A = casadi.DM.triplet(rows, columns, casadi.DM(values), 3 * n, 4 * n + 3)
    box = np.zeros((2, n + 1, 4))
    box[:, :, 0] = np.maximum(lower, 0.0), np.minimum(upper, length)
    box[1, :, 1] = limits.speed
    box[:, :, 2] = np.array([[-limits.deceleration], [limits.acceleration]])
    box[:, :, 3] = np.array([[-limits.jerk], [limits.jerk]])
    box[:, 0, :3] = box[:, -1, :3] = 0.0
    box[:, -1, 0] = length
    low, high = box.reshape(2, -1)[:, :-1]
    if upper[-1] < length or np.any(low > high):
        return False
    options = {"error_on_fail": False, "highs": {"output_flag": False}}
    solver = casadi.conic("fits", "highs", {"a": A.sparsity()}, options)
    solver(g=0, a=A, lba=0, uba=0, lbx=low, ubx=high)
    return bool(solver.stats()["success"])


def _could_arrive(plan, name, arrival, cells=120):
    """Whether some combination of before and after lets a robot arrive at a time, the others driving as they do."""
    by_name = {one.robot.name: one for one in plan.robots}
    mine = by_name[name]
    t = np.linspace(mine.robot.release, arrival, cells + 1)
    others = [by_name[other] for other in plan.order[: plan.order.index(name)]]
    horizon = max([arrival, *(other.arrival for other in others)]) + 1
    fine = np.unique(np.concatenate([np.linspace(0.0, horizon, 3000), t]))
    choices = []
    for other in others:
        low, high = _interval(mine, other, plan.problem.workspace.clearance, fine)
        if not np.isfinite(low).any():
            continue
        after, before = np.minimum.accumulate(low[::-1])[::-1], np.maximum.accumulate(high)
        pair = []
        if low[fine >= arrival].min() >= mine.path.length:
            pair.append((np.full(cells + 1, -np.inf), np.interp(t, fine, np.minimum(after, 1e6))))
        if before[-1] <= mine.path.length:
            pair.append((np.interp(t, fine, np.maximum(before, -1e6)), np.full(cells + 1, np.inf)))
        choices.append(pair)
    for combination in itertools.product(*choices):
        lower = np.max([np.full(cells + 1, -np.inf), *(pair[0] for pair in combination)], axis=0)
        upper = np.min([np.full(cells + 1, np.inf), *(pair[1] for pair in combination)], axis=0)
        if _fits(mine.robot.limits, (arrival - mine.robot.release) / cells, lower, upper, mine.path.length):
            return True
    return False


@pytest.fixture(scope="session")
def interval():
    """(plan-like of ego, of the other, clearance, times) -> forbidden arc lengths of ego on a straight path."""
    return _interval


@pytest.fixture(scope="session")
def could_arrive():
    """(plan, name, arrival) -> whether a robot could be at its goal by then, by brute force over before and after."""
    return _could_arrive


def _timed(problem, profile="fastest"):
    """All egos and timings of a problem, planned in the order of the file; each robot's meetings as well."""
    clearance = problem.workspace.clearance
    egos = [ego(robot, route.path, route.alone) for robot, route in
            zip(problem.robots, find_routes(problem, "taut"), strict=True)]  # fmt: skip
    timings, met = [], []
    for i, mine in enumerate(egos):
        meetings = []
        for k, other in enumerate(egos[:i]):
            reach = mine.robot.footprint.radius + other.robot.footprint.radius + clearance
            free = [runs_over(other.path, place, reach) is None for place in (mine.robot.start, mine.robot.goal)]
            rests = [runs_over(mine.path, place, reach) is not None for place in (other.robot.start, other.robot.goal)]
            regions = conflict_regions(
                chords(mine.path), chords(other.path), reach, start_free=free[0], goal_free=free[1]
            )
            ends = Ends(*free, *rests)
            meetings += [Meeting(region, k, timings[k].profile, ends, mine.length) for region in regions]
        timings.append(time_robot(mine, meetings, profile=profile))
        met.append(meetings)
        if timings[-1] is None:
            return None
    return egos, timings, met


@pytest.fixture(scope="session")
def timed():
    """(problem, profile) -> egos, timings and meetings, in the order of the file; None where a robot is stuck."""
    return _timed


def _bent_crossing(seed, count=5):
    """Robots on given ways with a bend or two, through one place at about one time."""
    rng = np.random.default_rng(seed)
    robots, used = [], []
    while len(robots) < count:
        turn, side = rng.uniform(0, 2 * np.pi), rng.uniform(-1.5, 1.5)
        along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        corners = [(-8, 0), (-2, 0), (1, side), (8, side)]
        way = [tuple(np.round(x * along + y * across, 3).tolist()) for x, y in corners]
        if any(np.hypot(p[0] - q[0], p[1] - q[1]) < 2.0 for p in (way[0], way[-1]) for q in used):
            continue
        used += [way[0], way[-1]]
        limits = Limits(*np.round(rng.uniform((0.7, 0.4, 0.4, 0.7, 0.2), (1.3, 1.0, 1.0, 3.0, 0.5)), 2).tolist())
        name = f"r{len(robots)}"
        robots.append(Robot(name, Footprint(0.3), limits, way[0], way[-1], path=tuple(way), corner_radius=0.5))
    return Problem("bent", LARGE, tuple(robots))


@pytest.fixture(scope="session")
def bent_crossing():
    """seed -> a problem of robots on given ways with bends."""
    return _bent_crossing


@pytest.fixture(scope="session")
def squared_jerk():
    """profile -> integral of the squared jerk [m2/s5]."""
    return lambda profile: float((np.diff(profile.times) * profile.jerks**2).sum())
