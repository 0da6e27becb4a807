"""Motions by ruckig: what comes back keeps what was asked for, whatever ruckig does inside."""

from __future__ import annotations

import random

import numpy as np
import pytest

from coord.model.robot import Limits
from coord.solvers.jerk import motion, rest_to_rest

REST = (0.0, 0.0, 0.0)
#: Numbers as people write them; they hit the borders between ruckig's cases far more often than random ones.
NUMBERS = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.75, 0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 5.0)
LENGTHS = (*NUMBERS, 0.001, 0.01, 7.3, 10.0, 20.0, 100.0)


def human(rng):
    """Limits and a length as a person would write them."""
    speed, up, down = (rng.choice(NUMBERS) for _ in range(3))
    return Limits(speed, up, down, rng.choice(NUMBERS) * rng.choice((1, 2, 10)), 1.0), rng.choice(LENGTHS)


def check(profile, start, goal, limits):
    """From start to goal, consistent from knot to knot, within the limits, never backwards."""
    h, (s, v, a), j = np.diff(profile.times), profile.states[:-1].T, profile.jerks
    assert profile.departure == 0.0
    assert tuple(profile.states[0]) == start
    assert tuple(profile.states[-1]) == goal
    assert np.all(h > 0)
    end = np.stack([s + h * v + h**2 * a / 2 + h**3 * j / 6, v + h * a + h**2 * j / 2, a + h * j], axis=1)
    assert np.abs(end - profile.states[1:]).max() < 1e-9
    turning = np.clip(np.divide(-a, j, out=np.zeros_like(a), where=j != 0), 0.0, h)
    speeds = np.concatenate([profile.states[:, 1], v + turning * a + turning**2 * j / 2])
    assert speeds.min() > -1e-9
    assert speeds.max() < limits.speed + 1e-9
    assert profile.states[:, 2].max() < limits.acceleration + 1e-9
    assert profile.states[:, 2].min() > -limits.deceleration - 1e-9
    assert np.abs(j).max() < limits.jerk + 1e-9


def test_a_motion_that_does_not_begin_at_zero_is_found():
    """From 1.0 m to 1.2 m with all limits 0.1 ruckig fails; asked as a motion over 0.2 m it does not."""
    limits = Limits(0.1, 0.1, 0.1, 0.1, 0.1)
    profile = motion((1.0, 0.0, 0.0), (1.2, 0.0, 0.0), limits)
    check(profile, (1.0, 0.0, 0.0), (1.2, 0.0, 0.0), limits)
    assert profile.arrival == pytest.approx(rest_to_rest(1.2 - 1.0, limits).arrival, abs=1e-12)


def test_numbers_as_people_write_them_give_a_motion_that_keeps_its_limits():
    """5,000 rest-to-rest motions, none missing: exact ends, consistent states, every limit kept, never backwards."""
    rng = random.Random(1)
    for _ in range(5000):
        limits, length = human(rng)
        check(rest_to_rest(length, limits), REST, (length, 0.0, 0.0), limits)


def test_a_motion_between_moving_states_keeps_its_limits_or_is_none():
    """3,000 changes of speed over a length: where a motion comes back, it is one; too short a length gives none."""
    rng = random.Random(2)
    found = 0
    for _ in range(3000):
        limits, length = human(rng)
        start = (rng.choice((0.0, 1.0, 3.3)), limits.speed * rng.choice((0, 0.25, 0.5, 1)), 0.0)
        goal = (start[0] + length, limits.speed * rng.choice((0, 0.25, 0.5, 1)), 0.0)
        profile = motion(start, goal, limits)
        if profile is not None:
            found += 1
            check(profile, start, goal, limits)
        else:
            change = abs(goal[1] ** 2 - start[1] ** 2)
            # without a jerk limit this length would do; with it the change takes at most this much more
            rate = limits.acceleration if goal[1] > start[1] else limits.deceleration
            assert length < change / (2 * rate) + limits.speed * (
                rate / limits.jerk + 2 * (limits.speed / limits.jerk) ** 0.5
            )
    assert found > 1500


def test_a_duration_is_met_exactly_or_there_is_no_motion():
    """3,000 motions with more time than the quickest: within 1e-9 s of what was asked, and within the limits."""
    rng = random.Random(3)
    found = 0
    for _ in range(3000):
        limits, length = human(rng)
        start = (0.0, limits.speed * rng.choice((0, 0.25, 0.5, 1)), 0.0)
        goal = (length, limits.speed * rng.choice((0, 0.25, 0.5, 1)), 0.0)
        quickest = motion(start, goal, limits)
        if quickest is None or quickest.arrival > 1000:
            continue
        duration = quickest.arrival * rng.choice((1, 1.01, 1.1, 1.5, 2, 3))
        profile = motion(start, goal, limits, duration)
        if profile is not None:
            found += 1
            assert profile.arrival == pytest.approx(duration, rel=1e-9, abs=1e-9)
            check(profile, start, goal, limits)
    assert found > 1800


def test_a_shorter_duration_than_the_quickest_gives_none():
    """Never a motion that takes longer than asked, nor one beyond the limits."""
    rng = random.Random(4)
    for _ in range(500):
        limits, length = human(rng)
        assert motion(REST, (length, 0.0, 0.0), limits, 0.999 * rest_to_rest(length, limits).arrival) is None


def test_too_short_a_way_to_stop_gives_none():
    """At 1 m/s with 0.5 m/s2 there is no stop within 0.9 m, and the robot does not overshoot and come back."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    assert motion((0.0, 1.0, 0.0), (0.9, 0.0, 0.0), limits) is None
    assert motion((0.0, 1.0, 0.0), (1.5, 0.0, 0.0), limits) is not None


def test_a_start_that_must_reverse_gives_none():
    """Slow and braking hard, the speed would dip below 0 before it can rise: no motion rather than a dip."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    assert motion((0.0, 0.05, -0.5), (5.0, 0.0, 0.0), limits) is None


def test_a_tenth_of_a_millimetre_and_a_kilometre_are_driven_alike():
    """Rest to rest over lengths of seven orders of magnitude."""
    limits = Limits(1.0, 0.5, 0.7, 1.0, 0.5)
    for length in np.geomspace(1e-4, 1e3, 50).tolist():
        check(rest_to_rest(length, limits), REST, (length, 0.0, 0.0), limits)


def test_a_very_long_duration_is_met_or_gives_none():
    """A robot that waits for hours is a motion or None, never a ValueError about a number."""
    limits = Limits(0.05, 1.2, 0.3, 0.8, 1.0)
    profile = motion(REST, (700.0, 0.0, 0.0), limits, 28001.0)
    assert profile is None or profile.arrival == pytest.approx(28001.0)
