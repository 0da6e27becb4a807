"""One robot after the other: what the whole plan owes to the order."""

from __future__ import annotations

import dataclasses

import pytest

from coord.coordination.blocking import reaches_of
from coord.coordination.prioritised import plan_in_order
from coord.coordination.scene import scene_of
from coord.errors import SolverError
from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan
from coord.timing.ego import ego

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((-30.0, -30.0, 30.0, 30.0), 0.05)


def robot(name, start, goal, **more):
    return Robot(name, Footprint(0.3), LIMITS, start, goal, **more)


def star(count, priorities=None):
    """Robots whose ways all cross in the middle; nobody's start or goal lies on another's way."""
    from math import cos, pi, sin

    robots = []
    for k in range(count):
        c, s = 10 * cos(pi * k / count), 10 * sin(pi * k / count)
        robots.append(robot(f"r{k}", (-c, -s), (c, s), priority=None if priorities is None else priorities[k]))
    return Problem("star", FLOOR, tuple(robots))


@pytest.mark.parametrize("priorities", [[1, 2, 3, 4, 5], [5, 4, 3, 2, 1], [2, 5, 1, 3, 4]])
def test_priorities_are_the_order_where_nothing_forbids_it(priorities):
    """The first drives as if alone, and is the only one who does."""
    found = plan(star(5, priorities)).plan
    assert list(found.order) == [f"r{k}" for k in sorted(range(5), key=lambda k: priorities[k])]
    on_time = [one.robot.name for one in found.robots if one.arrival == one.solo_arrival]
    assert on_time == [found.order[0]]


def test_where_robots_meet_is_forgotten_once_they_have_their_profiles():
    """However many look ahead at whom they hold up: in the end no region is kept."""
    problem = star(6)
    egos = [ego(one, route.path, route.alone) for one, route in zip(problem.robots, find_routes(problem), strict=True)]
    scene = scene_of(egos, reaches_of(problem.robots, 0.05), (), 0.05)
    kept = []
    timings = plan_in_order(scene, range(6), lambda done: kept.append(len(scene.regions)))
    assert len(timings) == 6
    assert max(kept) > 0
    assert scene.regions == {}


def test_a_robot_in_the_way_goes_first_whatever_its_priority():
    """The least urgent starts on the way of the most urgent: it leaves first, and the blocking arc says why."""
    problem = Problem(
        "p",
        FLOOR,
        (robot("late", (0.0, 0.0), (0.0, 9.0), priority=9.0), robot("early", (-9.0, 0.0), (9.0, 0.0), priority=1.0)),
    )
    found = plan(problem).plan
    assert found.order == ("late", "early")
    assert [(arc.first, arc.then, arc.at) for arc in found.blocking] == [("late", "early", "start")]


def test_a_robot_that_parks_in_the_way_comes_last():
    """The most urgent would park on the other's way: it is planned after it, and arrives when the other is past."""
    problem = Problem(
        "p",
        FLOOR,
        (robot("parks", (0.0, 9.0), (0.0, 0.0), priority=1.0), robot("passes", (-20.0, 0.0), (9.0, 0.0), priority=2.0)),
    )
    found = plan(problem).plan
    assert found.order == ("passes", "parks")
    parks, passes = found.robots
    assert parks.arrival > 20.0
    assert passes.arrival == passes.solo_arrival


def test_a_convoy_moves_from_its_head():
    """Ten robots in a row, all going 20 m ahead, the last one with the highest priority: the head leaves first."""
    robots = tuple(robot(f"r{k}", (-1.0 * k, 0.0), (20.0 - 1.0 * k, 0.0), priority=float(10 - k)) for k in range(10))
    found = plan(Problem("convoy", FLOOR, robots)).plan
    assert list(found.order) == [f"r{k}" for k in range(10)]


def test_nobody_leaves_before_its_release():
    """Departure and solo arrival count from it; the sum of solo arrivals contains it."""
    problem = star(4)
    released = tuple(dataclasses.replace(one, release=3.0 * k) for k, one in enumerate(problem.robots))
    found = plan(dataclasses.replace(problem, robots=released)).plan
    for k, one in enumerate(found.robots):
        assert one.profile.departure >= 3.0 * k
        assert one.solo_arrival == pytest.approx(22.5 + 3.0 * k)


def test_a_robot_at_its_goal_arrives_at_its_release_and_is_an_obstacle():
    """Beside the way it disturbs nobody; on the way the other goes round it, or must keep its path and the two are named."""
    goes = robot("goes", (-9.0, 0.0), (9.0, 0.0))
    beside = plan(Problem("p", FLOOR, (robot("rests", (0.0, 0.7), (0.0, 0.7), release=2.5), goes))).plan
    assert [one.arrival for one in beside.robots] == [2.5, pytest.approx(20.5)]
    on_the_way = Problem("p", FLOOR, (robot("rests", (0.0, 0.5), (0.0, 0.5)), goes))
    round_it = plan(on_the_way)
    assert round_it.certified
    assert [one.robot for one in round_it.plan.rerouted] == ["goes"]
    on_it = plan(on_the_way, Options(keep_paths=True))
    assert on_it.plan is None
    assert on_it.diagnoses[0].code == "blocking-cycle"
    assert set(on_it.diagnoses[0].robots) == {"rests", "goes"}


def test_robots_that_swap_places_on_one_line_pass_each_other():
    """No order helps, so they leave together, each by half beside the other; on kept paths the two are named."""
    swap = Problem("swap", FLOOR, (robot("a", (-5.0, 0.0), (5.0, 0.0)), robot("b", (5.0, 0.0), (-5.0, 0.0))))
    result = plan(swap)
    assert result.certified
    assert result.plan.blocking == ()
    assert [one.robot for one in result.plan.rerouted] == ["a", "b"]
    assert all("room to pass" in one.text for one in result.plan.rerouted)
    assert max(one.arrival - one.solo_arrival for one in result.plan.robots) < 1.0
    kept = plan(swap, Options(keep_paths=True))
    assert (kept.plan, kept.certified, kept.document) == (None, False, b"")
    (diagnosis,) = kept.diagnoses
    assert diagnosis.code == "blocking-cycle"
    assert '"a" and "b" cannot pass each other, at whatever speeds' in diagnosis.text


@pytest.mark.parametrize("failing", ["finds none", "library"])
def test_where_the_timing_stage_fails_a_robot_waits_until_all_near_it_have_arrived(monkeypatch, failing):
    """Whether it finds nothing or a library gives up: everybody drives alone after those before it, and the plan says so."""

    def fails(*_, **__):
        if failing == "library":
            raise SolverError("out of order")

    monkeypatch.setattr("coord.coordination.prioritised.time_robot", fails)
    result = plan(star(4))
    assert result.certified
    at = {one.robot.name: one for one in result.plan.robots}
    arrived = 0.0
    for name in result.plan.order:
        assert at[name].how == "waited"
        assert at[name].profile.departure == pytest.approx(arrived)
        arrived = at[name].arrival
        earlier = result.plan.order[: result.plan.order.index(name)]
        assert (set(at[name].after), at[name].before) == (set(earlier), ())


def test_a_robot_that_waits_does_not_leave_before_its_release(monkeypatch):
    """Nor later than needed: released after all have arrived, it leaves at its release."""
    monkeypatch.setattr("coord.coordination.prioritised.time_robot", lambda *_, **__: None)
    problem = star(2, [1, 2])
    late = dataclasses.replace(problem.robots[1], release=500.0)
    found = plan(dataclasses.replace(problem, robots=(problem.robots[0], late))).plan
    assert found.robots[1].profile.departure == 500.0
    assert found.robots[1].arrival == found.robots[1].solo_arrival


def test_where_stop_and_go_fails_a_robot_waits_until_all_near_it_have_arrived(monkeypatch):
    """The last resort is the same for every method."""

    def fails(*_):
        raise SolverError("out of order")

    monkeypatch.setattr("coord.coordination.prioritised.stop_robot", fails)
    result = plan(star(3), Options(method="stop"))
    assert result.certified
    assert {one.how for one in result.plan.robots} == {"waited"}
