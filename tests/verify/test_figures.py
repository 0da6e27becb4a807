"""What a plan says about itself is checked like the rest."""

from __future__ import annotations

import copy

import pytest

from coord.verify import verify


@pytest.fixture
def plan(build):
    robots = [build.robot("a", (0, 0), (4, 0)), build.robot("b", (0, 3), (4, 3), departure=2.0, release=1.0)]
    return build.plan([*robots, build.robot("c", (0, 6), pieces=[[3, 0, 0], [1, 0.2, 0.2]])])


def codes(build, plan):
    return {fault.code for fault in verify(build.data(plan)).faults}


@pytest.mark.parametrize(
    "order",
    [["a", "b"], ["a", "b", "c", "d"], ["a", "b", "b"], ["a", "b", "c", "c"], []],
    ids=["missing", "unknown", "missing and twice", "twice", "empty"],
)
def test_the_order_names_every_robot_once(build, plan, order):
    """A permutation, nothing else."""
    plan["order"] = order
    assert "order" in codes(build, plan)


def test_the_order_keeps_the_blocking_arcs(build, plan):
    """In any order that keeps them, and only there."""
    plan["blocking"] = [["b", "a", "start"], ["c", "b", "goal"]]
    plan["order"] = ["c", "b", "a"]
    assert codes(build, plan) == set()
    plan["order"] = ["b", "c", "a"]
    assert codes(build, plan) == {"blocking"}
    plan["blocking"] = [["b", "z", "start"]]
    assert codes(build, plan) == {"blocking"}


@pytest.mark.parametrize("key", ["after", "before"])
def test_a_robot_lets_only_earlier_ones_pass(build, plan, key):
    """Those planned later did not exist for it, nor does it itself."""
    plan["robots"][1][key] = ["a"]
    assert codes(build, plan) == set()
    for wrong in ("b", "c", "z"):
        plan["robots"][1][key] = [wrong]
        assert codes(build, plan) == {"passing"}


@pytest.mark.parametrize(
    ("key", "code"), [("sum_of_arrivals", "sum"), ("makespan", "makespan"), ("optimality_gap", "gap")]
)
def test_figures_are_what_they_are_said_to_be(build, plan, key, code):
    """To nine digits."""
    plan["result"][key] *= 1 + 1e-12
    assert codes(build, plan) == set()
    plan["result"][key] += 1e-6
    assert code in codes(build, plan)


def test_a_bound_above_the_sum_is_none(build, plan):
    """Whoever found it; and one by "solo_bound" is no more than those add up to."""
    total = plan["result"]["sum_of_arrivals"]
    plan["result"] |= {"lower_bound": total, "lower_bound_by": "joint", "optimality_gap": 0.0}
    assert codes(build, plan) == set()
    plan["result"]["lower_bound_by"] = "solo_bound"
    assert codes(build, plan) == {"bound"}
    plan["result"] |= {"lower_bound": total + 1, "lower_bound_by": "joint", "optimality_gap": -1 / total}
    assert codes(build, plan) == {"bound"}


@pytest.mark.parametrize(
    ("k", "key", "value"),
    [(0, "solo_bound", 1e3), (2, "solo_bound", 1e3), (0, "solo_arrival", 0.0), (2, "lower_bound", 1e3)],
)
def test_a_robots_bounds_are_below_its_arrivals(build, plan, k, key, value):
    """solo_bound <= solo_arrival and arrival; lower_bound <= arrival; on lines and in bends."""
    plan["robots"][k][key] = value
    assert "bound" in codes(build, plan)


def test_a_solo_bound_is_no_more_than_the_fastest_motion_on_a_line(build, plan):
    """Robot b waits; its bound is release + least time, and nothing above it although it arrives later."""
    robot = plan["robots"][1]
    assert robot["solo_bound"] < robot["arrival"] - 0.9
    for more, expected in ((9e-7, set()), (1.1e-6, {"bound"})):
        changed = copy.deepcopy(plan)
        changed["robots"][1]["solo_bound"] += more
        assert codes(build, changed) == expected


@pytest.mark.parametrize("limit", ["speed", "acceleration", "deceleration", "jerk"])
def test_a_raised_limit_shows_in_the_bound(build, plan, limit):
    """Whoever claims a better drive than the plan was made for could have arrived earlier."""
    plan["robots"][0]["limits"][limit] *= 1.01
    assert codes(build, plan) == {"bound"}


@pytest.mark.parametrize(("key", "code"), [("start", "start"), ("goal", "goal")])
def test_paths_lead_from_start_to_goal(build, plan, key, code):
    """1e-10 m off is rounding, 1e-8 m is not; for lines and for bends."""
    for k in (0, 2):
        for off, expected in ((1e-10, set()), (1e-8, {code})):
            changed = copy.deepcopy(plan)
            changed["robots"][k][key][1] += off
            assert codes(build, changed) == expected


def test_faults_of_different_kinds_are_reported_together(build, plan):
    """One finding does not hide the next."""
    plan["order"] = ["a", "b"]
    plan["result"]["makespan"] += 1
    plan["robots"][0]["limits"]["jerk"] /= 2
    plan["robots"][1]["goal"][0] += 1
    assert {"order", "makespan", "jerk", "goal"} <= codes(build, plan)
