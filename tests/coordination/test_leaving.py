"""Robots that leave on arrival: nobody parks in anybody's way, and everybody is certified."""

from __future__ import annotations

import math
import random

import pytest

from coord.model.footprint import Footprint
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
DISC = Footprint(0.3)


def problem(robots, leave):
    floor = Workspace((0.0, 0.0, 20.0, 15.0), 0.05, "leave" if leave else "stay")
    return Problem("p", floor, tuple(robots))


def test_a_goal_on_the_way_blocks_only_those_who_stay():
    """Red's goal lies on blue's line: with "stay" blue goes first, with "leave" nobody must."""
    robots = [
        Robot("red", DISC, LIMITS, (10.0, 2.0), (10.0, 7.0), priority=1),
        Robot("blue", DISC, LIMITS, (2.0, 7.0), (18.0, 7.0), priority=2),
    ]
    stay, leave = plan(problem(robots, False)), plan(problem(robots, True))
    assert stay.certified
    assert leave.certified
    assert [arc.at for arc in stay.plan.blocking] == ["goal"]
    assert leave.plan.blocking == ()
    assert leave.plan.order == ("red", "blue")
    assert leave.plan.sum_of_arrivals <= stay.plan.sum_of_arrivals + 1e-9


def test_two_robots_may_have_the_same_goal_when_they_leave():
    """One after the other."""
    robots = [
        Robot("a", DISC, LIMITS, (2.0, 7.0), (10.0, 7.0)),
        Robot("b", DISC, LIMITS, (18.0, 7.0), (10.0, 7.0)),
    ]
    found = plan(problem(robots, True))
    assert found.certified
    first, second = sorted(robot.arrival for robot in found.plan.robots)
    assert second > first


def test_a_robot_at_its_goal_is_in_the_way_until_its_release():
    """It stands on the other's line for 20 s; the other arrives later than alone, and passes the place after that."""
    robots = [
        Robot("post", DISC, LIMITS, (10.0, 7.0), (10.0, 7.0), release=20.0),
        Robot("van", DISC, LIMITS, (2.0, 7.0), (18.0, 7.0)),
    ]
    found = plan(problem(robots, True))
    assert found.certified
    van = found.plan.robots[1]
    assert van.profile.state([20.0])[0, 0] <= 8.0 - 0.65 + 1e-6
    assert van.arrival > van.solo_arrival


@pytest.mark.parametrize("seed", range(12))
def test_crowds_that_leave_are_certified(seed):
    """Twelve robots at random; whoever stands in a ring of starts may be refused, with a diagnosis."""
    draw = random.Random(seed)
    starts: list[tuple[float, float]] = []
    while len(starts) < 12:
        place = (draw.uniform(1, 19), draw.uniform(1, 14))
        if all(math.dist(place, other) > 0.7 for other in starts):
            starts.append(place)
    robots = [
        Robot(f"r{k}", DISC, LIMITS, start, (draw.uniform(1, 19), draw.uniform(1, 14)))
        for k, start in enumerate(starts)
    ]
    found = plan(problem(robots, True))
    assert found.certified or found.diagnoses
    if found.plan is not None:
        assert found.certified
        assert all(arc.at == "start" for arc in found.plan.blocking)
