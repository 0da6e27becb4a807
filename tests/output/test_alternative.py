"""The choice that was not taken."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.output.plots.alternative import alternative
from coord.plan import plan

FLOOR = Workspace((-20.0, -20.0, 20.0, 20.0), 0.05)


def crossing(head_start=0.0, options=None):
    """Two robots whose paths cross in the middle; the second in the file is planned second."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    first = Robot("first", Footprint(0.3), limits, (-5.0, 0.0), (5.0, 0.0), priority=1)
    second = Robot("second", Footprint(0.3), limits, (0.0, -5.0 + head_start), (0.0, 6.0), priority=2)
    return plan(Problem("crossing", FLOOR, (first, second)), options or Options(profile="fastest")).plan


def test_who_is_not_delayed_has_no_alternative():
    """The first, and a second with the floor to itself."""
    found = crossing(head_start=3.0)
    assert [alternative(found, one) for one in found.robots] == [None, None]


def test_a_robot_as_near_as_the_other_would_come_too_late_to_pass_first():
    """Both need as long to the crossing: the second lets the first pass, and even its quickest start would be too late."""
    found = crossing()
    choice = alternative(found, found.robots[1])
    assert choice.other == "first"
    assert choice.bound is None
    assert 0.5 < choice.late < 3.0
    assert choice.first < 6.25 < choice.last
    assert "s too late" in choice.text


def test_where_the_other_starts_in_the_way_it_can_never_be_passed_first():
    """The first stands on the second's path until it leaves."""
    found = crossing()
    robots = (dataclasses.replace(found.problem.robots[0], start=(0.0, 0.0)), found.problem.robots[1])
    held = plan(dataclasses.replace(found.problem, robots=robots), Options(profile="fastest")).plan
    choice = alternative(held, held.robots[1])
    assert choice is None or choice.bound is None


@pytest.mark.parametrize("head_start", np.linspace(0.2, 1.6, 8).tolist())
def test_a_bound_is_never_below_the_time_alone_nor_told_where_it_is_impossible(head_start):
    """Whatever the head start: a bound is at least what the robot needs alone."""
    found = crossing(head_start)
    choice = alternative(found, found.robots[1])
    if choice is not None and choice.bound is not None:
        assert choice.bound >= found.robots[1].solo_bound - 1e-9
