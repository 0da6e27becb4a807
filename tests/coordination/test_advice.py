"""Remedies are tried before they are told."""

from __future__ import annotations

import dataclasses
import re

import coord.plan
from coord.coordination.advice import MOST_LOOKS, advised
from coord.model.footprint import Footprint
from coord.model.obstacle import rectangle
from coord.model.problem import Problem, Workspace
from coord.model.result import Diagnosis
from coord.model.robot import Limits, Robot
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def robot(name, start, goal):
    return Robot(name, Footprint(0.3), LIMITS, start, goal)


def door(width):
    """A robot of 0.6 m that keeps 0.05 m before a gap of some width."""
    walls = rectangle("left", (-5.0, 0.0, -width / 2, 0.2)), rectangle("right", (width / 2, 0.0, 5.0, 0.2))
    floor = Workspace((-5.0, -5.0, 5.0, 5.0), 0.05)
    return Problem("door", floor, (robot("a", (0.0, -3.0), (0.0, 3.0)),), walls)


def test_the_clearance_that_is_told_lets_the_robot_through_and_hardly_more_does():
    """A gap of 0.67 m: 0.035 m on either side; the told clearance is at most that, and within 2 mm of it."""
    (told,) = plan(door(0.67)).diagnoses
    found = float(re.search(r"a clearance of (\d\.\d+) m instead of 0.05 m", told.remedy)[1])
    assert 0.033 <= found <= 0.035
    problem = door(0.67)
    eased = dataclasses.replace(problem, workspace=dataclasses.replace(problem.workspace, clearance=found))
    assert plan(eased).certified


def test_where_no_clearance_helps_none_is_told():
    """A gap of 0.5 m is too narrow for 0.6 m."""
    (told,) = plan(door(0.5)).diagnoses
    assert "Tried" not in told.remedy


def test_the_move_that_is_told_is_the_shortest_that_works():
    """Only with its goal moved by at least 0.7 m to the right does everything work: the next length tried is told."""
    problem = door(1.0)

    def works(changed):
        x, y = changed.robots[0].goal
        return changed.workspace.clearance == 0.05 and x >= 0.7 and y == 3.0

    (told,) = advised(problem, [Diagnosis("no-way", ("a",), "No way.", None, None, "Widen a passage.")], works)
    assert told.remedy == 'Widen a passage. Tried: the goal of "a" at (0.750, 3.000), 0.75 m away, helps.'


def test_nothing_is_told_that_does_not_follow_from_the_named_robots():
    """Where these come home alone, or the diagnosis is of another kind, the remedy stays as it was."""
    for code, outcome in (("no-way", True), ("time-limit", False)):
        diagnosis = Diagnosis(code, ("a",), "No way.", None, None, "Do something.")
        assert advised(door(1.0), [diagnosis], lambda _, outcome=outcome: outcome) == (diagnosis,)


def test_a_try_is_given_up_after_so_many_looks(monkeypatch):
    """Two robots that swap places in a lane for one: each try, of which there are several, asks no more often than that."""
    asked = []
    planned = coord.plan._planned

    def counted(problem, options, progress, time_is_up):
        asked.append(0)

        def asks():
            asked[-1] += 1
            return time_is_up()

        return planned(problem, options, progress, asks)

    monkeypatch.setattr(coord.plan, "_planned", counted)
    walls = [rectangle(f"wall {k}", (-5.0, y, 5.0, y + 0.2)) for k, y in enumerate((-0.8, 0.6))]
    pair = robot("a", (-3.0, 0.0), (3.0, 0.0)), robot("b", (3.0, 0.0), (-3.0, 0.0))
    (told,) = plan(Problem("lane", Workspace((-5.0, -5.0, 5.0, 5.0), 0.05), pair, tuple(walls))).diagnoses
    assert told.code == "blocking-cycle"
    whole, *tries = asked
    assert len(tries) >= 2
    assert whole > 2 * MOST_LOOKS
    assert max(tries) == 2 * MOST_LOOKS + 1
