"""Profiles through a tube by the linear program: valid, and about as early as can be."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.check import keeps_limits
from coord.conflicts.window import Window
from coord.model.footprint import Footprint
from coord.model.path import straight
from coord.model.robot import Limits, Robot
from coord.timing.clear import excess
from coord.timing.ego import ego
from coord.timing.program import through_tube
from coord.timing.tube import Tube, after_bound, before_bound

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def robot(length=20.0, release=0.0):
    return ego(
        Robot("e", Footprint(0.3), LIMITS, (0.0, 0.0), (length, 0.0), release=release), straight((0, 0), (length, 0))
    )


def block(since, until, low, high):
    """The place between low and high is taken from a time until another."""
    return Window(0, np.array([since, until]), np.array([[low, low]]), np.array([[high, high]]))


def found(one, after=(), before=(), most=60.0):
    tube = Tube([after_bound(window) for window in after], [before_bound(window) for window in before])
    return through_tube(one, tube, one.solo_bound, most)


def is_valid(one, profile, after=(), before=()):
    assert keeps_limits(profile, LIMITS, one.caps)
    assert profile.states[-1].tolist() == [one.length, 0.0, 0.0]
    assert profile.departure >= one.alone.departure
    assert all(excess(profile, window).passes_after for window in after)
    assert all(excess(profile, window).under_high <= 1e-9 for window in before)


def test_with_an_empty_tube_the_program_comes_close_to_the_quickest_motion():
    """Within 3 % of ruckig, never below."""
    one = robot()
    profile = found(one)
    assert profile is not None
    is_valid(one, profile)
    assert one.solo_bound <= profile.arrival <= 1.03 * one.solo_bound


@pytest.mark.parametrize("release", [0.0, 5.0])
def test_a_place_taken_for_a_while_costs_what_it_must(release):
    """At 10 m until t = 30: from there at full speed at t = 30 the goal is 10 m and a stop of 1.25 s away, within 1 %."""
    one, window = robot(release=release), block(0.0, 30.0, 10.0, 12.0)
    profile = found(one, after=[window])
    assert profile is not None
    is_valid(one, profile, after=[window])
    assert 30 + 10 + 1.25 - 1e-6 <= profile.arrival <= 1.01 * 41.25


def test_before_one_and_after_the_next():
    """Past 6 m by t = 9, but not at 10 m before t = 20: it hurries, then waits, then goes on, and loses what it must."""
    one = robot()
    first, second = block(9.0, 25.0, 4.0, 6.0), block(5.0, 20.0, 10.0, 12.0)
    profile = found(one, after=[second], before=[first])
    assert profile is not None
    is_valid(one, profile, after=[second], before=[first])
    assert profile.state(9.0)[0, 0] >= 6.0
    assert profile.state(20.0)[0, 0] <= 10.0
    assert 20 + 10 + 1.25 - 1e-6 <= profile.arrival <= 1.02 * 31.25


def test_contradicting_bounds_have_no_profile():
    """Past 12 m at t = 15 and not past 10 m at t = 16."""
    windows = block(15.0, 30.0, 8.0, 12.0), block(5.0, 16.0, 10.0, 13.0)
    assert found(robot(), after=[windows[1]], before=[windows[0]]) is None


def test_no_profile_is_later_than_allowed():
    """With 1 s less than the wait needs, there is none."""
    assert found(robot(), after=[block(0.0, 30.0, 10.0, 12.0)], most=40.0) is None


def test_random_tubes_give_valid_profiles():
    """40 tubes with one to three windows: what comes back keeps limits and tube, and nothing comes back too early."""
    rng = np.random.default_rng(1)
    count = 0
    for _ in range(40):
        one, after, before = robot(), [], []
        for k in range(rng.integers(1, 4)):
            low, at = 4.0 + 5 * k, 6.0 + 5 * k + rng.uniform(-3, 6)
            window = block(at, at + rng.uniform(1, 8), low, low + 1.5)
            (before if at > low + 4 else after).append(window)
        profile = found(one, after=after, before=before)
        if profile is not None:
            count += 1
            is_valid(one, profile, after, before)
            assert profile.arrival >= one.solo_bound
            for window in after:
                # from low at the window's end at full speed, then the stop
                assert profile.arrival >= window.times[-1] + (20 - window.low[0, 0]) + 1.25 - 1e-6
    assert count >= 25
