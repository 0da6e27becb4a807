"""Sample plans, built by hand: simple paths and simple jerk-limited profiles, not planned by anything."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.path import Path, straight
from coord.model.problem import Problem, Workspace
from coord.model.profile import VelocityProfile
from coord.model.result import BlockingArc, Clearance, Diagnosis, Plan, Result, RobotPlan
from coord.model.robot import Limits, Robot
from coord.output.plan_file import serialise

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def rest_to_rest(length: float, departure: float = 0.0, limits: Limits = LIMITS) -> VelocityProfile:
    """Four phases of equal duration h and jerk +j, -j, -j, +j cover 2 j h^3, with v = j h^2 and a = j h at most."""
    if length == 0:
        return VelocityProfile([departure], [(0.0, 0.0, 0.0)], [])
    acceleration = min(limits.acceleration, limits.deceleration)
    h = max((length / 2 / limits.jerk) ** (1 / 3), (length / 2 / acceleration) ** 0.5, length / 2 / limits.speed)
    j = length / 2 / h**3
    states, jerks = [(0.0, 0.0, 0.0)], [j, -j, -j, j]
    for jerk in jerks:
        s, v, a = states[-1]
        states.append((s + h * (v + h * (a / 2 + h * jerk / 6)), v + h * (a + h * jerk / 2), a + h * jerk))
    states[-1] = (length, 0.0, 0.0)
    return VelocityProfile([departure + k * h for k in range(5)], states, jerks)


def robot_plan(name: str, path: Path, wait: float = 0.0, release: float = 0.0, **more: Any) -> RobotPlan:
    """A robot that drives a path to its end, ``wait`` seconds later than it could."""
    robot = Robot(name, Footprint(0.3), LIMITS, path.start[:2], path.end, release=release)
    profile, solo = rest_to_rest(path.length, release + wait), rest_to_rest(path.length, release).arrival
    return RobotPlan(robot, path, profile, solo, solo - 0.125, profile.arrival - 0.0625, **more)


def make_plan(*robots: RobotPlan, obstacles: tuple[Circle | Polygon, ...] = (), stay: str = "stay") -> Plan:
    """A plan of these robots, in this order, on a floor of 12 m by 8 m."""
    workspace = Workspace((0.0, 0.0, 12.0, 8.0), 0.05, stay)
    problem = Problem("sample", workspace, tuple(robot.robot for robot in robots), obstacles, digest="ab12")
    names = tuple(robot.robot.name for robot in robots)
    return Plan(problem, robots, names, (), sum(robot.lower_bound for robot in robots), "single robots")


@pytest.fixture
def sample() -> Plan:
    """Three robots: one straight, one that waits for it, one on a bend with a clothoid; all kinds of obstacles."""
    red = robot_plan("red", straight((1.0, 4.0), (11.0, 4.0)))
    blue = robot_plan("blue", straight((5.0, 1.0), (5.0, 7.0)), 4.5, 0.5, after=("red",), how="start delay")
    bend = robot_plan('grün, "3" [bold]', Path((9.0, 1.0, 0.1), [(1.0, 0.0, 0.5), (2.0, 0.5, 0.5), (0.7, 0.5, -0.1)]))
    room = Polygon("room", [(6, 5), (8, 5), (8, 7), (6, 7)], ([(6.5, 5.5), (6.5, 6.5), (7.5, 6.5), (7.5, 5.5)],))
    obstacles = (rectangle("rack", (1.5, 1.0, 3.5, 2.5), 0.1), Circle("column", (2.0, 6.0), 0.7), room)
    plan = make_plan(red, blue, bend, obstacles=obstacles)
    robots = (plan.problem.robots[0], replace(plan.problem.robots[1], priority=2.0), plan.problem.robots[2])
    problem = replace(plan.problem, robots=robots)
    parts = tuple(replace(part, robot=robot) for part, robot in zip(plan.robots, robots, strict=True))
    return replace(plan, problem=problem, robots=parts, blocking=(BlockingArc("red", "blue", "goal", (5.0, 4.0)),))


@pytest.fixture
def parked() -> Plan:
    """One robot whose goal is its start: no path to speak of, arrival at its release."""
    return make_plan(robot_plan("still", straight((3.0, 3.0), (3.0, 3.0)), release=1.5))


@pytest.fixture
def many() -> Plan:
    """Fifteen robots in parallel lanes; the odd ones are delayed."""
    lanes = [straight((1.0, 0.4 + 0.5 * k), (11.0 - 0.3 * k, 0.4 + 0.5 * k)) for k in range(15)]
    return make_plan(*(robot_plan(f"agv-{k}", lane, 0.5 * (k % 2)) for k, lane in enumerate(lanes)))


@pytest.fixture
def result_of() -> Callable[..., Result]:
    """A result with this plan, certified or not."""

    def make(plan: Plan, certified: bool = True) -> Result:
        names = [robot.robot.name for robot in plan.robots]
        clearance = Clearance(0.05 + 1e-7, (names[0], names[1]), 6.25) if len(names) > 1 else None
        return Result(plan.problem, plan, certified, serialise(plan), clearance)

    return make


@pytest.fixture
def failure(sample: Plan) -> Result:
    """A result without a plan, with one diagnosis."""
    text = 'no way leads from "red" to its goal: "rack" closes the lane'
    diagnosis = Diagnosis("no_way", ("red",), text, (2.5, 1.75), None, "make the lane 0.1 m wider")
    return Result(sample.problem, None, False, diagnoses=(diagnosis,), stopped="no plan")
