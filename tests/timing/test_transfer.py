"""From state to state over some way: no motion is quicker than the closed forms say, and ruckig's is as quick."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.model.robot import Limits
from coord.solvers.jerk import LinkTimes
from coord.timing.transfer import least_times, rise


def scene(seed):
    """Limits, a cap, a length, speeds and accelerations with which a robot can come by under the cap."""
    rng = np.random.default_rng(seed)
    limits = Limits(*rng.uniform((0.6, 0.3, 0.3, 0.5, 0.2), (1.8, 1.2, 1.2, 3.0, 0.8)).tolist())
    speeds = rng.uniform(0.1, 0.7, 2) * limits.speed
    most = [min(math.sqrt(2 * limits.jerk * min(v, limits.speed - v)), limits.acceleration, limits.deceleration)
            for v in speeds]  # fmt: skip
    return rng, limits, speeds.tolist(), (rng.uniform(-1, 1, 2) * most).tolist(), float(rng.uniform(2.0, 12.0))


def bound(limits, speeds, low, high, length):
    """The closed form for one cell of accelerations at either end."""
    speed, rising, falling = (np.array([limit]) for limit in (limits.speed, limits.acceleration, limits.deceleration))
    first = rise(np.array([speeds[0]]), low[:1], high[:1], rising, limits.jerk, speed)
    last = rise(np.array([speeds[1]]), -high[1:], -low[1:], falling, limits.jerk, speed)
    return float(least_times(first, last, np.array([length]), speed)[0])


@pytest.mark.parametrize("seed", range(60))
def test_between_two_states_it_is_the_time_of_the_quickest_motion(seed):
    """The very accelerations, on ways long enough: ruckig's time to a microsecond, never above it."""
    _, limits, speeds, accelerations, length = scene(seed)
    a = np.array(accelerations)
    found = bound(limits, speeds, a, a, length)
    quickest = LinkTimes(limits)((speeds[0], a[0]), (speeds[1], a[1]), length, limits.speed)
    assert found <= quickest + 1e-9
    assert found == 0 or found >= quickest - 1e-6


def test_mostly_the_way_is_long_enough():
    """Else the test above would say little: in 60 scenes it is in at least 40."""
    told = [bound(limits, speeds, np.array(a), np.array(a), length) > 0
            for _, limits, speeds, a, length in map(scene, range(60))]  # fmt: skip
    assert sum(told) >= 40


@pytest.mark.parametrize("seed", range(40))
def test_no_motion_that_begins_and_ends_slower_is_quicker(seed):
    """Of 30 pairs of states with no greater speed and an acceleration in the cell, no time is below the bound."""
    rng, limits, speeds, accelerations, length = scene(seed)
    a = np.array(accelerations)
    width = rng.uniform(0.0, 0.3, 2)
    found = bound(limits, speeds, a - width, a, length)
    time_of = LinkTimes(limits)
    for _ in range(30):
        (v0, v1), (a0, a1) = rng.uniform(0.6, 1.0, 2) * speeds, a - rng.uniform(0.0, 1.0, 2) * width
        assert time_of((v0, a0), (v1, a1), length, limits.speed) >= found - 1e-9


@pytest.mark.parametrize("seed", range(60))
def test_rise_and_fall_up_to_the_most_speed_are_no_shorter_than_the_way(seed):
    """So the search for the greatest speed, which comes down from there, begins no lower than where it ends."""
    rng, limits, speeds, accelerations, length = scene(seed)
    top, a = np.array([10 * limits.speed]), np.array(accelerations)
    first = rise(np.array(speeds[:1]), a[:1], a[:1], np.array([limits.acceleration]), limits.jerk, top)
    last = rise(np.array(speeds[1:]), -a[1:], -a[1:], np.array([limits.deceleration]), limits.jerk, top)
    way = np.array([length * float(rng.uniform(0.5, 4.0))])
    most = first.most_speed(last, way)
    assert first.way(most) + last.way(most) >= way - 1e-9
    both = first.way_and_growth(most)
    assert both[0] == pytest.approx(first.way(most), abs=1e-12)
    step = 1e-6
    assert both[1] == pytest.approx((first.way(most + step) - first.way(most - step)) / (2 * step), rel=1e-4)
