"""Nearest first: who goes, who stops, who waits for whom in a jam; nothing depends on priorities or on the handedness."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from coord import read_problem
from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan
from coord.verify import verify

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((-20.0, -20.0, 20.0, 20.0), 0.05)
PROBLEMS = Path(__file__).parents[2] / "problems"
NEAREST = Options(method="nearest")

#: [m] Half the way on which a robot is too near to another that crosses at a right angle: two radii and the clearance.
APART = 0.65


def robot(name, start, goal, **more):
    return Robot(name, Footprint(0.3), LIMITS, start, goal, **more)


def planned(*robots, floor=FLOOR):
    """name -> its part of the plan, which is certified."""
    result = plan(Problem("p", floor, robots), NEAREST)
    assert result.certified
    return {one.robot.name: one for one in result.plan.robots}


def pinwheel(half):
    """Four robots on the sides of a square, each of which crosses one neighbour's way first and another's second."""
    ends = [(-10.0, -half), (10.0, -half)]
    robots = []
    for k, name in enumerate(["east", "north", "west", "south"]):
        for _ in range(k > 0):
            ends = [(-y, x) for x, y in ends]
        robots.append(robot(name, *ends))
    return Problem("pinwheel", FLOOR, tuple(robots))


@pytest.mark.parametrize("priorities", [(1.0, 2.0), (2.0, 1.0), (None, None)])
@pytest.mark.parametrize("lead", [-3.0, -0.5, 0.5, 3.0])
def test_the_nearer_of_two_goes_first_whatever_the_priorities(priorities, lead):
    """It drives as if alone; the other stops on its way and says after whom it goes."""
    a = robot("a", (-8.0, 0.0), (8.0, 0.0), priority=priorities[0])
    b = robot("b", (0.0, -8.0 - lead), (0.0, 8.0), priority=priorities[1])
    both = planned(a, b)
    first, second = (both["a"], both["b"]) if lead > 0 else (both["b"], both["a"])
    assert (first.how, first.arrival) == ("alone", first.solo_arrival)
    if abs(lead) < 1:  # else the first is through before the second would have to brake
        assert (second.how, second.after, second.before) == ("stop", (first.robot.name,), ())
        assert second.arrival > second.solo_arrival + 1


def test_a_slow_robot_that_is_nearer_goes_first_all_the_same():
    """Distance counts, not time: it has been given the conflict when the quick one has to brake."""
    slow = dataclasses.replace(
        robot("slow", (0.0, -1.5), (0.0, 8.0), release=6.0), limits=Limits(0.2, 0.5, 0.5, 1.0, 0.5)
    )
    both = planned(robot("quick", (-9.0, 0.0), (8.0, 0.0)), slow)
    assert both["quick"].how == "stop"
    assert both["slow"].arrival == both["slow"].solo_arrival


def test_who_is_not_released_yet_does_not_compete():
    """However near it is to the conflict, the other goes first when it comes before the release."""
    near = robot("near", (0.0, -1.0), (0.0, 8.0), release=30.0)
    both = planned(robot("far", (-9.0, 0.0), (8.0, 0.0)), near)
    assert [both[name].arrival == both[name].solo_arrival for name in ("far", "near")] == [True, True]


@pytest.mark.parametrize("swapped", [False, True])
def test_of_two_at_the_same_distance_the_first_of_the_file_goes_first(swapped):
    """Also where rounding would say otherwise: differences below a centimetre do not count."""
    robots = [robot("a", (-8.0, 0.0), (8.0, 0.0)), robot("b", (0.0, -8.000001), (0.0, 8.0))]
    both = planned(*(robots[::-1] if swapped else robots))
    assert [name for name in both if both[name].how == "alone"] == ["b" if swapped else "a"]


def test_who_stops_stands_still_outside_the_conflict_until_the_other_has_left_it():
    """Speed exactly 0, centre at the distance to keep from the other's line, until the other is as far past."""
    slow = dataclasses.replace(robot("a", (-3.0, 0.0), (8.0, 0.0)), limits=Limits(0.3, 0.5, 0.5, 1.0, 0.5))
    both = planned(slow, robot("b", (0.0, -8.5), (0.0, 8.0)))
    profile = both["b"].profile
    (k,) = np.flatnonzero((profile.jerks == 0) & np.all(profile.states[:-1, 1:] == 0, axis=1))
    place, until = profile.states[k, 0], profile.times[k + 1]
    assert place == pytest.approx(8.5 - APART, abs=1e-3)
    assert both["a"].profile.state(until)[0, 0] == pytest.approx(3.0 + APART, abs=1e-3)
    assert np.all(profile.state(np.linspace(profile.times[k], until, 100)) == [place, 0.0, 0.0])


def test_who_would_park_in_the_way_lets_the_other_pass():
    """Although it is much nearer: the other could never arrive else."""
    both = planned(robot("parks", (0.0, -3.0), (0.0, 0.0)), robot("passes", (-9.0, 0.0), (8.0, 0.0)))
    assert both["passes"].arrival == both["passes"].solo_arrival
    assert both["parks"].after == ("passes",)


def test_where_robots_leave_on_arrival_the_nearer_goes_first_to_a_goal_on_the_others_way():
    """Nobody parks there: it is gone before the other comes."""
    floor = dataclasses.replace(FLOOR, after_arrival="leave")
    both = planned(robot("ends", (0.0, -3.0), (0.0, 0.0)), robot("passes", (-9.0, 0.0), (8.0, 0.0)), floor=floor)
    assert [one.arrival == one.solo_arrival for one in both.values()] == [True, True]


def test_who_starts_on_the_others_way_leaves_first():
    """The other stops before that place until it is gone, however long that takes."""
    both = planned(robot("stands", (0.0, 0.0), (0.0, 8.0), release=40.0), robot("comes", (-9.0, 0.0), (8.0, 0.0)))
    assert both["stands"].arrival == both["stands"].solo_arrival
    assert (both["comes"].how, both["comes"].after) == ("stop", ("stands",))
    assert both["comes"].arrival > 42


@pytest.mark.parametrize("half", [0.7, 1.0])
def test_four_in_a_ring_get_through_where_there_is_room_between_two_crossings(half):
    """Stopped before its second crossing each has left its first: so the first is free, and on it goes."""
    result = plan(pinwheel(half), NEAREST)
    assert result.certified
    assert {one.how for one in result.plan.robots} == {"stop"}


@pytest.mark.parametrize("half", [0.4, 0.6])
def test_four_in_a_ring_jam_where_there_is_no_room_between_two_crossings(half):
    """Each stops before its second crossing, still in its first: who waits for whom is told, with place and time."""
    result = plan(pinwheel(half), NEAREST)
    assert result.plan is None
    (jam,) = result.diagnoses
    assert (jam.code, jam.robots) == ("jam", ("east", "north", "west", "south"))
    stop, since = 10 + half - APART, jam.time
    assert jam.place in [
        pytest.approx(p, abs=0.01)
        for p in ((stop - 10, -half), (half, stop - 10), (10 - stop, half), (-half, 10 - stop))
    ]
    assert f'"east" waits at ({stop - 10:.2f}, {-half:.2f}) since {since:.2f} s for "north"' in jam.text
    assert '"south" waits at' in jam.text
    assert 'for "east": a jam.' in jam.text
    assert "--method velocity" in jam.remedy
    assert plan(pinwheel(half), Options(method="velocity")).certified
    assert plan(pinwheel(half), Options(method="stop")).certified


def test_those_behind_a_jam_are_counted():
    """In the convoy the third of the lane waits behind the second, which is stuck in a ring with two others."""
    (jam,) = plan(read_problem(PROBLEMS / "convoy.toml"), NEAREST).diagnoses
    assert jam.robots == ("second", "crosser", "joiner")
    assert '"joiner" waits at ' in jam.text
    assert jam.text.endswith(" 1 more waits behind.")


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("method", ["stop", "nearest"])
def test_every_plan_is_certified_and_a_jam_is_all_that_can_go_wrong(crowd, seed, method):
    """Crowds whose starts and goals are on each other's ways: the checker accepts the plan, or there is a ring."""
    result = plan(crowd(seed, count=10, spacing=2.0), Options(method=method))
    if result.plan is None:
        assert {found.code for found in result.diagnoses} <= ({"jam"} if method == "nearest" else set()) | {
            "blocking-cycle"
        }
    else:
        assert result.certified
        assert verify(result.document).certified


@pytest.mark.parametrize("method", ["stop", "nearest"])
def test_most_crowds_are_planned(crowd, method):
    """Of ten crowds at least six: a method that never finds anything would pass the test before."""
    assert sum(plan(crowd(seed, count=10, spacing=2.0), Options(method=method)).certified for seed in range(10)) >= 6


def hub(seed, count=7):
    """Robots across a circle on straight lines that pass its middle somewhere; nobody rests on another's way."""
    rng = np.random.default_rng(seed)
    robots = []
    for k, turn in enumerate(rng.permutation(np.arange(count) * np.pi / count)):
        along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        off, start, goal = rng.uniform(-1, 1), -rng.uniform(8, 12), rng.uniform(8, 12)
        ends = [tuple(np.round(along * s + across * off, 3).tolist()) for s in (start, goal)]
        robots.append(robot(f"r{k}", *ends))
    return Problem("hub", FLOOR, tuple(robots))


def mirrored(problem):
    """The problem with left and right exchanged."""
    robots = [
        dataclasses.replace(one, start=(-one.start[0], one.start[1]), goal=(-one.goal[0], one.goal[1]))
        for one in problem.robots
    ]
    xmin, ymin, xmax, ymax = problem.workspace.bounds
    floor = dataclasses.replace(problem.workspace, bounds=(-xmax, ymin, -xmin, ymax))
    return dataclasses.replace(problem, workspace=floor, robots=tuple(robots))


@pytest.mark.parametrize("method", ["stop", "nearest"])
@pytest.mark.parametrize("seed", range(6))
def test_mirrored_scenes_are_settled_alike(seed, method):
    """The same robots give way to the same, and arrive at the same times; a jam has the same ring."""
    problem, options = hub(seed), Options(method=method)
    one, other = plan(problem, options), plan(mirrored(problem), options)
    assert (one.plan is None) == (other.plan is None)
    if one.plan is None:
        assert [found.robots for found in one.diagnoses] == [found.robots for found in other.diagnoses]
        return
    for mine, image in zip(one.plan.robots, other.plan.robots, strict=True):
        assert (mine.after, mine.before, mine.how) == (image.after, image.before, image.how)
        assert mine.arrival == pytest.approx(image.arrival, abs=1e-3)


@pytest.mark.parametrize("seed", [0, 1, 3, 4])
def test_the_order_is_that_of_the_arrivals(seed):
    """Whom a robot let pass, or got ahead of, is said of those that arrived before it; the bound is its own."""
    found = plan(hub(seed), NEAREST).plan
    arrival = {one.robot.name: one.arrival for one in found.robots}
    assert not found.blocking
    assert list(found.order) == sorted(found.order, key=arrival.__getitem__)
    for one in found.robots:
        earlier = set(found.order[: found.order.index(one.robot.name)])
        assert {*one.after, *one.before} <= earlier
        assert one.lower_bound == one.solo_bound


def test_the_same_input_gives_the_same_bytes():
    """No set or clock decides anything."""
    problem = pinwheel(1.0)
    assert plan(problem, NEAREST).document == plan(problem, NEAREST).document


def test_when_the_time_is_up_nobody_goes_on():
    """Then the diagnosis is the time limit, not a jam."""
    result = plan(pinwheel(1.0), Options(method="nearest", time_limit=1e-9))
    assert [found.code for found in result.diagnoses] == ["time-limit"]
