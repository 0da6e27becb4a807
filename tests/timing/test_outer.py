"""The outer program: its no is a proof, and it says no where it should."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from coord.alone.chain import chained
from coord.alone.speed_limit import SpeedLimit
from coord.timing import bounds
from coord.timing.meeting import first_violated
from coord.timing.outer import could_arrive, sides_of
from coord.timing.passing import time_robot
from coord.timing.reach import Marks, ranges, reach_by, settled

NOTHING = Marks(np.empty(0), np.empty(0), np.empty(0), np.empty(0))


def parts_of(ego, meetings):
    return [part for meeting in meetings for part in bounds.parts_of(ego, bounds.forbidden(ego, meeting))]


def clear_motions(rng, ego, meetings, timing):
    """The profile found, and slower ones that are clear of all: delayed, and with lower limits."""
    yield timing.profile
    caps = ego.caps
    for _ in range(12):
        share, pause = rng.uniform(0.6, 1.0, 2), float(rng.uniform(0.0, 12.0))
        limits = dataclasses.replace(ego.robot.limits, acceleration=ego.robot.limits.acceleration * share[0])
        slow = chained(SpeedLimit(caps.ends, caps.caps * share[1]), limits)
        if slow is not None:
            slow = slow.shifted(ego.robot.release + pause)
            if first_violated(meetings, slow) is None:
                yield slow


@pytest.fixture(scope="module")
def cases(lanes, crossroads, bent_crossing, timed):
    """All robots of a few scenes, straight and with bends, with their meetings."""
    found = []
    for problem in [
        *(lanes(k) for k in range(6)),
        *(crossroads(k, 5) for k in range(6)),
        *map(bent_crossing, range(6)),
    ]:
        planned = timed(problem)
        if planned is not None:
            found += [case for case in zip(*planned, strict=True) if case[2]]
    return found


def test_no_motion_that_exists_is_ruled_out(cases):
    """Motions clear of all, early and late: the outer program never denies their arrival, nor a range their places."""
    rng, count = np.random.default_rng(0), 0
    for ego, timing, meetings in cases:
        parts = parts_of(ego, meetings)
        for motion in clear_motions(rng, ego, meetings, timing):
            count += 1
            reach = reach_by(ego, parts, motion.arrival)
            times = np.linspace(ego.robot.release, motion.arrival, 300)
            low, high = ranges(reach, NOTHING, times)
            s = motion.state(times)[:, 0]
            assert np.all(ego.relaxed.state(low)[:, 0] <= s + 1e-5)
            assert np.all(ego.relaxed.state(high)[:, 0] >= s - 1e-5)
            sides = sides_of(parts, motion)
            assert settled(reach, sides, ()) is not None
            assert not could_arrive(ego, parts, motion.arrival + 1e-6, 12).cannot
    assert count >= 100


def test_nobody_arrives_before_its_bound_alone(cases):
    """A hundredth before the bound of the robot alone the answer is no, without a relaxation or with one."""
    for ego, _, meetings in cases:
        verdict = could_arrive(ego, parts_of(ego, meetings), 0.99 * ego.solo_bound, 3)
        assert verdict.cannot
        assert verdict.programs <= 1


def test_certify_leaves_no_robot_worse_off_and_closes_most_gaps(cases):
    """Neither does a bound fall nor an arrival rise; two delayed robots in three are then 0.1 % above their bounds or less."""
    gaps = []
    for ego, timing, meetings in cases:
        if timing.how != "alone":
            certified = time_robot(ego, meetings, certify=True)
            assert certified.lower_bound >= timing.lower_bound
            assert certified.profile.arrival <= timing.profile.arrival
            gaps.append(certified.profile.arrival / certified.lower_bound - 1)
    assert len(gaps) >= 20
    assert np.quantile(gaps, 2 / 3) < 1.01e-3


def test_brute_force_on_a_grid_is_never_denied(lanes, could_arrive_in, timed):
    """Where HiGHS finds a motion in some tube by a time, the outer program does not say that there is none."""
    for seed in range(8):
        problem, planned = lanes(seed), timed(lanes(seed))
        ego, timing, meetings = (values[-1] for values in planned)
        for share in (0.97, 0.99, 0.995, 1.0, 1.01):
            arrival = share * timing.profile.arrival
            cannot = could_arrive(ego, parts_of(ego, meetings), arrival * (1 + 1e-3), 200).cannot
            assert not (cannot and could_arrive_in(problem, planned, arrival))


@pytest.fixture(scope="module")
def could_arrive_in(could_arrive):
    """(problem, what ``timed`` found, arrival) -> whether brute force finds a motion of the last robot."""
    from types import SimpleNamespace

    def ask(problem, planned, arrival):
        robots = [
            SimpleNamespace(robot=ego.robot, path=ego.path, profile=timing.profile, arrival=timing.profile.arrival)
            for ego, timing in zip(*planned[:2], strict=True)
        ]
        plan = SimpleNamespace(robots=robots, order=[one.robot.name for one in robots], problem=problem)
        return could_arrive(plan, robots[-1].robot.name, arrival)

    return ask
