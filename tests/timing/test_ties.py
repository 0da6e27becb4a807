"""Profiles that arrive equally early."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from coord.alone.check import keeps_limits
from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan
from coord.timing.meeting import first_violated
from coord.timing.ties import equally_early
from coord.tolerances import OPTIMAL


@pytest.mark.parametrize("seed", range(12))
def test_they_arrive_as_early_are_clear_and_keep_the_limits(lanes, timed, seed):
    """Whatever slows a robot down: each is another motion that could stand in its place."""
    egos, timings, meetings = timed(lanes(seed), "fastest")
    for ego, timing, met in zip(egos, timings, meetings, strict=True):
        for one in equally_early(ego, met, timing):
            assert one.profile.arrival <= timing.profile.arrival * (1 + OPTIMAL)
            assert first_violated(met, one.profile) is None
            assert keeps_limits(one.profile, ego.robot.limits, ego.caps)


def test_a_robot_that_waits_at_its_start_could_often_roll(lanes, timed):
    """In most of 12 scenes some robot that waits finds a profile that departs earlier and arrives at the same time."""
    scenes = 0
    for seed in range(12):
        egos, timings, meetings = timed(lanes(seed), "fastest")
        waiting = [k for k, timing in enumerate(timings) if timing.how == "start delay"]
        others = [(k, one) for k in waiting for one in equally_early(egos[k], meetings[k], timings[k])]
        scenes += any(one.profile.departure < timings[k].profile.departure for k, one in others)
    assert scenes > 6


def test_a_robot_alone_has_no_other(lanes, timed):
    """Its quickest profile is the only one."""
    egos, timings, meetings = timed(lanes(0), "fastest")
    (first,) = [k for k, timing in enumerate(timings) if timing.how == "alone"][:1]
    assert equally_early(egos[first], meetings[first], timings[first]) == []


def test_a_profile_tells_its_own_sides_not_those_of_the_one_it_stands_for():
    """One that rolls passes ahead of a slow robot that comes late, where the one that waits lets it pass, too."""
    slow, quick = Limits(0.2, 1.0, 1.0, 2.0, 1.0), Limits(2.0, 2.0, 2.0, 4.0, 1.0)
    changed = 0
    for release, y in itertools.product((0.0, 1.0, 2.0, 3.0), (8.2, 8.6, 9.0)):
        robots = (
            Robot("early", Footprint(0.3), quick, (4.0, 5.0), (4.0, 15.0), priority=1, release=release),
            Robot("late", Footprint(0.3), slow, (16.0, y - 1), (16.0, 12.0), priority=2),
            Robot("ego", Footprint(0.3), Limits(1.5, 1.0, 1.0, 2.0, 1.0), (1.0, 10.0), (19.0, 10.0), priority=3),
        )
        problem = Problem("late", Workspace((0.0, 0.0, 20.0, 20.0), 0.1), robots)
        found = plan(problem, Options(profile="fastest")).plan.robots
        ego, t = found[2], np.linspace(0.0, 60.0, 6001)
        for other, x in zip(found[:2], (4.0, 16.0), strict=True):
            passes = t[np.argmax(ego.path.point(ego.profile.state(t)[:, 0])[:, 0] > x)]
            its = t[np.argmax(other.path.point(other.profile.state(t)[:, 0])[:, 1] > 10.0)]
            assert other.robot.name in (ego.after if passes > its else ego.before)
        changed += ego.how == "splice"
    assert changed > 4
