"""What giving way costs, and what it must not depend on."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.alone.fastest import fastest
from coord.alone.inverse import time_at
from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan as plan_with


def plan(problem):
    """These theorems are about the earliest arrival."""
    return plan_with(problem, Options(profile="fastest"))


LARGE = Workspace((-500.0, -500.0, 500.0, 500.0), 0.05)


def crossing(limits, radius=0.3, arm=10.0):
    """Two robots that would be at the crossing of their ways at the same time; the first goes first."""
    disc = Footprint(radius)
    return Problem(
        "crossing",
        LARGE,
        (
            Robot("first", disc, limits, (-arm, 0.0), (arm, 0.0), priority=1.0),
            Robot("second", disc, limits, (0.0, -arm), (0.0, arm), priority=2.0),
        ),
    )


@settings(deadline=None, derandomize=True, max_examples=25)
@given(st.floats(0.3, 2.0), st.floats(0.3, 2.0), st.floats(0.5, 4.0), st.floats(0.1, 0.6))
def test_at_a_right_angle_the_second_loses_root_two_times_the_distance_over_the_speed(
    speed, acceleration, jerk, radius
):
    """Both cruise at v; d later the distance is at least v d / sqrt(2): the delay is sqrt(2) R / v, within 1 %."""
    limits = Limits(speed, acceleration, acceleration, jerk, acceleration)
    first, second = plan(crossing(limits, radius, 30.0)).plan.robots
    expected = math.sqrt(2) * (2 * radius + 0.05) / speed
    delay = second.arrival - second.solo_arrival
    assert expected <= delay + 1e-5
    assert delay <= 1.01 * expected + 2e-3
    assert first.arrival == first.solo_arrival


@pytest.mark.parametrize("angle", [30, 60, 120, 150])
def test_at_any_angle_the_second_loses_the_distance_over_the_relative_speed(angle):
    """With the ways at an angle the least distance is v d |cos(angle / 2)|, so the delay is R / (v cos(angle / 2)), within 1 %."""
    limits, disc, turn = Limits(1.0, 0.5, 0.5, 1.0, 0.5), Footprint(0.3), math.radians(angle)
    c, s = 30 * math.cos(turn), 30 * math.sin(turn)
    robots = (
        Robot("first", disc, limits, (-30.0, 0.0), (30.0, 0.0), priority=1.0),
        Robot("second", disc, limits, (-c, -s), (c, s), priority=2.0),
    )
    second = plan(Problem("p", LARGE, robots)).plan.robots[1]
    expected = 0.65 / math.cos(turn / 2)
    assert expected - 1e-5 <= second.arrival - second.solo_arrival <= 1.01 * expected + 2e-3


def test_following_on_one_line_keeps_the_distance():
    """The same way 1 m behind: the second starts when the first has gone, and arrives as much later."""
    limits, disc = Limits(1.0, 0.5, 0.5, 1.0, 0.5), Footprint(0.3)
    robots = (
        Robot("first", disc, limits, (0.0, 0.0), (30.0, 0.0), priority=1.0),
        Robot("second", disc, limits, (-1.0, 0.0), (29.0, 0.0), priority=2.0),
    )
    found = plan(Problem("p", LARGE, robots)).plan
    assert found.robots[1].arrival == found.robots[1].solo_arrival
    slow = dataclasses.replace(robots[0], limits=dataclasses.replace(limits, speed=0.5))
    behind = plan(Problem("p", LARGE, (slow, robots[1]))).plan
    first, second = behind.robots
    # the second may be at 29 m only once the first, at 1/2 m/s, has passed 29.65 m
    assert time_at(first.profile, 29.65)[0] <= second.arrival <= first.arrival


def test_a_quicker_robot_passes_before_a_slow_one():
    """The second in order is there long before the first: nothing changes for either."""
    slow, quick, disc = Limits(0.2, 0.2, 0.2, 1.0, 0.5), Limits(2.0, 1.0, 1.0, 2.0, 0.5), Footprint(0.3)
    robots = (
        Robot("first", disc, slow, (-10.0, 0.0), (10.0, 0.0), priority=1.0),
        Robot("second", disc, quick, (0.0, -10.0), (0.0, 10.0), priority=2.0),
    )
    first, second = plan(Problem("p", LARGE, robots)).plan.robots
    assert (first.arrival, second.arrival) == (first.solo_arrival, second.solo_arrival)
    assert (second.before, second.after) == (("first",), ())


@pytest.mark.parametrize("seed", range(6))
def test_the_first_in_order_drives_as_if_alone(crossroads, seed):
    """Its profile is, byte for byte, its quickest one, later by its release."""
    found = plan(crossroads(seed)).plan
    if found is None:
        return
    first = next(one for one in found.robots if one.robot.name == found.order[0])
    alone = fastest(first.path, first.robot.limits).shifted(first.robot.release)
    for name in ("times", "states", "jerks"):
        assert getattr(first.profile, name).tobytes() == getattr(alone, name).tobytes()
    assert first.how == "alone"


@pytest.mark.parametrize("seed", range(20))
def test_all_profiles_are_clear_of_each_other(crossroads, least_gap, seed):
    """At 4,000 moments no two robots are closer than the clearance, and nobody beats its bound or leaves too early."""
    found = plan(crossroads(seed, 7)).plan
    if found is None:
        return
    assert least_gap(found) >= -1e-9
    for one in found.robots:
        assert one.solo_bound <= one.lower_bound <= one.arrival
        assert one.solo_bound <= one.solo_arrival <= one.arrival
        assert one.profile.departure >= one.robot.release
        assert one.profile.states[-1].tolist() == [one.path.length, 0.0, 0.0]


@pytest.mark.parametrize("seed", range(12))
def test_robots_of_lower_priority_change_nothing_for_the_others(crossroads, seed):
    """With the last in order left out, all others drive byte for byte as before."""
    problem = crossroads(seed)
    found = plan(problem).plan
    if found is None:
        return
    robots = [dataclasses.replace(robot, priority=float(found.order.index(robot.name))) for robot in problem.robots]
    for count in (3, 5):
        kept = tuple(robot for robot in robots if found.order.index(robot.name) < count)
        fewer = plan(dataclasses.replace(problem, robots=kept)).plan
        assert fewer.order == found.order[:count]
        for one in fewer.robots:
            same = next(other for other in found.robots if other.robot.name == one.robot.name)
            if same.how == one.how:  # the last that others can meet may roll instead of waiting
                assert one.profile.times.tobytes() == same.profile.times.tobytes()
                assert one.profile.states.tobytes() == same.profile.states.tobytes()
            else:
                assert one.arrival == pytest.approx(same.arrival, rel=1e-3)


def moved(problem, place, *, limits=lambda limits: limits, length=1.0, time=1.0, bounds=None):
    """The problem with places, sizes, limits and times changed."""
    robots = tuple(
        dataclasses.replace(
            robot,
            start=place(robot.start),
            goal=place(robot.goal),
            footprint=Footprint(robot.footprint.radius * length),
            limits=limits(robot.limits),
            release=robot.release * time,
            priority=float(k),
        )
        for k, robot in enumerate(problem.robots)
    )
    floor = Workspace(bounds or (-200.0, -200.0, 200.0, 200.0), problem.workspace.clearance * length)
    return Problem("moved", floor, robots)


def arrivals(problem):
    found = plan(problem)
    return None if found.plan is None else np.array([one.arrival for one in found.plan.robots])


SEEDS = range(6)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_mirrored_moved_or_turned_floor_has_the_same_arrivals(crossroads, seed):
    """Mirror, translation by 100 m, quarter turn and a turn by 1 rad: each arrival is the same within 1e-6."""
    problem = crossroads(seed)
    plain = arrivals(moved(problem, lambda p: p))
    c, s = math.cos(1.0), math.sin(1.0)
    for place in (
        lambda p: (-p[0], p[1]),
        lambda p: (p[1], p[0]),
        lambda p: (p[0] + 100.0, p[1] - 50.0),
        lambda p: (-p[1], p[0]),
        lambda p: (c * p[0] - s * p[1], s * p[0] + c * p[1]),
    ):
        other = arrivals(moved(problem, place))
        assert (plain is None) == (other is None)
        if plain is not None:
            assert other == pytest.approx(plain, rel=1e-6)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("k", [0.5, 3.0])
def test_a_quicker_world_has_shorter_times(crossroads, seed, k):
    """Speed, acceleration and jerk times k, k^2, k^3, releases divided by k: arrivals are divided by k, within 1e-3."""
    problem = crossroads(seed)

    def quicker(limits):
        return Limits(
            limits.speed * k,
            limits.acceleration * k**2,
            limits.deceleration * k**2,
            limits.jerk * k**3,
            limits.lateral_acceleration * k**2,
        )

    plain, other = (
        arrivals(moved(problem, lambda p: p)),
        arrivals(moved(problem, lambda p: p, limits=quicker, time=1 / k)),
    )
    if plain is not None:
        assert other * k == pytest.approx(plain, rel=1e-3)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_larger_world_has_the_same_times(crossroads, seed):
    """Places, sizes and limits times 3: the arrivals are the same within 1 %, since cells are a fixed 5 cm."""
    problem = crossroads(seed)

    def larger(limits):
        return Limits(*(3 * value for value in dataclasses.astuple(limits)))

    plain = arrivals(moved(problem, lambda p: p))
    other = arrivals(moved(problem, lambda p: (3 * p[0], 3 * p[1]), limits=larger, length=3.0))
    if plain is not None:
        assert other == pytest.approx(plain, rel=1e-2)
