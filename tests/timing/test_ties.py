"""Profiles that arrive equally early."""

from __future__ import annotations

import pytest

from coord.alone.check import keeps_limits
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
