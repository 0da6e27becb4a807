"""Of equally early profiles the one that holds up the later ones least."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.coordination import prioritised
from coord.coordination.courtesy import courteous
from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan
from coord.timing.meeting import first_violated
from coord.tolerances import OPTIMAL

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FASTEST = Options(profile="fastest")


def crossing(seed, count=24, size=19.0):
    """Robots from side to side on straight lines, all alike, in the order of their priorities."""
    rng = np.random.default_rng(seed)
    places = [(1.25 * (1 + rng.permutation(14))).tolist() for _ in range(2)]
    robots = []
    for k in range(count):
        at = places[k % 2][k // 2]
        ends = [(0.0, at), (size, at)] if k % 2 else [(at, 0.0), (at, size)]
        start, goal = ends[:: int(rng.choice([-1, 1]))]
        robots.append(Robot(f"r{k}", Footprint(0.5), LIMITS, start, goal, priority=float(k)))
    return Problem("crossing", Workspace((-1.0, -1.0, size + 1, size + 1), 0.05), tuple(robots))


def test_a_robot_that_nobody_comes_after_rolls_instead_of_waiting():
    """Of two that cross, the second one departs at once and slows down, and arrives as it would after a wait."""
    robots = [
        Robot("first", Footprint(0.5), LIMITS, (5.0, 0.0), (5.0, 10.0), priority=1.0),
        Robot("second", Footprint(0.5), LIMITS, (0.0, 5.0), (10.0, 5.0), priority=2.0),
    ]
    found = plan(Problem("two", Workspace((-1.0, -1.0, 11.0, 11.0), 0.05), tuple(robots)), FASTEST).plan.robots[1]
    assert found.how == "splice"
    assert found.profile.departure == 0
    assert found.arrival == pytest.approx(found.lower_bound, rel=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_a_courteous_profile_is_as_early_and_clear_and_holds_up_nobody_more(monkeypatch, seed):
    """For every robot of a scene: arrival the same up to OPTIMAL, and clear of all before it."""
    changed = []

    def watched(scene, i, timing, meetings, timings):
        found = courteous(scene, i, timing, meetings, timings)
        assert found.profile.arrival <= timing.profile.arrival * (1 + OPTIMAL)
        nearer = [meeting.refined() for meeting in meetings]
        assert None in (first_violated(meetings, found.profile), first_violated(nearer, found.profile))
        changed.append(found is not timing)
        return found

    monkeypatch.setattr(prioritised, "courteous", watched)
    result = plan(crossing(seed), FASTEST)
    assert result.certified
    assert len(changed) == 24


@pytest.mark.long
def test_over_many_scenes_courtesy_saves_time(monkeypatch):
    """Over 12 scenes of 24 robots that cross, the sum of all delays is at least 3 % less than without."""
    sums = []
    for method in (courteous, lambda scene, i, timing, meetings, timings: timing):
        monkeypatch.setattr(prioritised, "courteous", method)
        plans = [plan(crossing(seed), FASTEST).plan for seed in range(12)]
        sums.append(math.fsum(one.sum_of_arrivals - one.sum_of_solo_arrivals for one in plans))
    assert sums[0] < 0.97 * sums[1]
