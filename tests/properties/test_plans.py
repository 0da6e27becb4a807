"""Whatever the problem: a certified plan, or the reason why there is none."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.plan import plan
from coord.verify import verify


def check_plan(problem, result):
    """Everything that must hold of a plan that was handed back."""
    assert result.certified
    assert verify(result.document).verdict == "certified"
    found = result.plan
    assert [one.robot for one in found.robots] == list(problem.robots)
    assert sorted(found.order) == sorted(robot.name for robot in problem.robots)
    at = {name: position for position, name in enumerate(found.order)}
    assert all(at[arc.first] < at[arc.then] for arc in found.blocking)
    for one in found.robots:
        assert one.robot.release + one.path.length / one.robot.limits.speed <= one.solo_bound + 1e-9
        assert one.solo_arrival <= one.arrival
        assert one.solo_bound <= one.lower_bound <= one.arrival
        assert one.profile.departure >= one.robot.release
        assert one.path.end == pytest.approx(one.robot.goal, abs=1e-9)
        assert all(at[other] < at[one.robot.name] for other in (*one.after, *one.before))
        assert not set(one.after) & set(one.before)
    assert found.sum_of_arrivals == pytest.approx(math.fsum(one.arrival for one in found.robots))
    assert found.makespan == max(one.arrival for one in found.robots)
    assert found.lower_bound <= found.sum_of_arrivals + 1e-9
    assert found.sum_of_solo_arrivals <= found.sum_of_arrivals + 1e-9
    assert 0 <= found.optimality_gap + 1e-12 < 1
    figures = json.loads(result.document)["result"]
    assert figures["sum_of_arrivals"] == found.sum_of_arrivals
    assert figures["makespan"] == found.makespan
    assert figures["lower_bound"] == found.lower_bound


def check_least_clearance(problem, result):
    """The reported least distance is about that of 3,000 moments, never more, and not below the clearance."""
    found, least = result.plan, result.min_clearance
    if len(found.robots) < 2:
        assert least is None
        return
    t = np.linspace(0.0, found.makespan + 1.0, 3000)
    at = {
        one.robot.name: (one.path.point(one.profile.state(t)[:, 0]), one.robot.footprint.radius) for one in found.robots
    }
    sampled = min(
        np.hypot(*(at[a][0] - at[b][0]).T).min() - at[a][1] - at[b][1]
        for a in at for b in at if a < b
    )  # fmt: skip
    assert problem.workspace.clearance - 1e-9 <= least.value <= sampled + 1e-6
    (a, ra), (b, rb) = (at[name] for name in least.robots)
    there = [
        one.path.point(one.profile.state(least.time)[:, 0])[0]
        for name in least.robots for one in found.robots if one.robot.name == name
    ]  # fmt: skip
    assert np.hypot(*(there[0] - there[1])) - ra - rb == pytest.approx(least.value, abs=2e-6)


def check_diagnoses(problem, result):
    """Robots by their names, a sentence, a remedy; and no plan at all."""
    assert (result.plan, result.certified, result.document) == (None, False, b"")
    assert result.diagnoses
    names = {robot.name for robot in problem.robots}
    for diagnosis in result.diagnoses:
        assert diagnosis.code in ("no-way", "blocking-cycle")
        assert diagnosis.robots
        assert set(diagnosis.robots) <= names
        assert all(f'"{name}"' in diagnosis.text for name in diagnosis.robots)
        assert diagnosis.remedy


@settings(deadline=None, derandomize=True, max_examples=80)
@given(st.data())
def test_every_problem_has_a_certified_plan_or_a_reason(problems, data):
    """80 made-up crossings with obstacles: the bytes handed back are certified and consistent, or names and places are told."""
    problem = data.draw(problems)
    result = plan(problem)
    if result.plan is None:
        check_diagnoses(problem, result)
    else:
        check_plan(problem, result)
        check_least_clearance(problem, result)


@settings(deadline=None, derandomize=True, max_examples=15)
@given(st.data())
def test_the_same_problem_gives_the_same_bytes(problems, data):
    """Planned again after another problem, the document is the same to the last byte."""
    problem, other = data.draw(problems), data.draw(problems)
    first = plan(problem)
    plan(other)
    again = plan(problem)
    assert again.document == first.document
    assert again.diagnoses == first.diagnoses
