"""Robots with corners, planned with their own shape, and certified by the checker that shares nothing with the planner."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from coord.model.footprint import Footprint, square
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan as plan_with


def plan(problem):
    """These theorems are about the earliest arrival."""
    return plan_with(problem, Options(profile="fastest"))


LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def planned(*robots, clearance=0.05):
    """A certified plan of robots on an empty floor."""
    result = plan(Problem("corners", Workspace((-30.0, -30.0, 30.0, 30.0), clearance), robots))
    assert result.certified, result.diagnoses
    return result


def star(shapes, turn):
    """Robots whose straight ways all cross in the middle, at equal angles."""
    robots = []
    for k, shape in enumerate(shapes):
        c, s = (10 * f(turn + math.pi * k / len(shapes)) for f in (math.cos, math.sin))
        robots.append(Robot(f"r{k}", shape, LIMITS, (-c, -s), (c, s)))
    return robots


@pytest.mark.parametrize("clearance", [0.0, 0.05, 0.3])
@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0])
def test_squares_that_cross_at_any_angle_are_certified(clearance, turn):
    """Five at once; the plan file says squares, so that the checker saw squares."""
    result = planned(*star([square(0.6)] * 5, turn), clearance=clearance)
    assert {json.dumps(robot["footprint"]) for robot in json.loads(result.document)["robots"]} == {'{"square": 0.6}'}
    assert result.min_clearance.value >= clearance - 1e-9


def test_squares_that_cross_come_as_near_as_they_may():
    """The one that gives way passes the other at 2 mm more than the clearance, at most."""
    result = planned(*star([square(0.6)] * 2, 0.0), clearance=0.05)
    assert 0.05 <= result.min_clearance.value <= 0.052


def test_squares_that_follow_a_slower_one_keep_the_clearance():
    """Three on one line, the slowest ahead and then behind it at half the length of a robot from each other."""
    slow = Limits(0.4, 0.5, 0.5, 1.0, 0.5)
    ways = [((2.0, 0.0), (12.0, 0.0)), ((1.0, 0.0), (11.0, 0.0)), ((0.0, 0.0), (10.0, 0.0))]
    robots = [Robot(f"r{k}", square(0.6), slow if k == 0 else LIMITS, *way) for k, way in enumerate(ways)]
    result = planned(*robots)
    arrivals = [robot.arrival for robot in result.plan.robots]
    assert arrivals[0] == pytest.approx(result.plan.robots[0].solo_arrival)
    assert min(arrivals[1:]) > max(robot.solo_arrival for robot in result.plan.robots[1:]) + 1


def test_squares_side_by_side_do_not_meet():
    """Ten lanes at a side and the clearance apart, to and fro: all as if alone; the discs round them have no plan."""
    ways = [((-6.0, 0.65 * k), (6.0, 0.65 * k))[:: (-1) ** k] for k in range(10)]
    robots = [Robot(f"r{k}", square(0.6), LIMITS, *way) for k, way in enumerate(ways)]
    result = planned(*robots)
    assert all(robot.how == "alone" for robot in result.plan.robots)
    assert result.min_clearance.value == pytest.approx(0.05, abs=1e-12)
    discs = tuple(Robot(one.name, Footprint(0.3 * 2**0.5), LIMITS, one.start, one.goal) for one in robots)
    assert plan(Problem("discs", Workspace((-30.0, -30.0, 30.0, 30.0), 0.05), discs)).plan is None


def test_shapes_of_all_kinds_cross_and_are_certified(regular):
    """Discs, squares, turning squares, pentagons: 12 ways through the middle, three at random angles."""
    rng = np.random.default_rng(1)
    for _ in range(3):
        kinds = [Footprint(0.3), square(0.6), square(0.6, "path"), regular(5, 0.4, rng.uniform(0, 7))]
        result = planned(*star(kinds * 3, rng.uniform(0, 1)))
        assert result.min_clearance.value >= 0.05 - 1e-9


def test_squares_lose_no_more_time_than_the_discs_round_them():
    """Four ways through the middle: the sum of arrivals of squares lies between those of the discs within and without."""
    sums = [
        planned(*star([shape] * 4, 0.2)).plan.sum_of_arrivals
        for shape in (Footprint(0.3), square(0.6), Footprint(0.3 * 2**0.5))
    ]
    assert sums == sorted(sums)
    assert sums[0] < sums[1] < sums[2]
