"""Ramps bound how early a robot can be somewhere, and how long it still needs."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.ramp import landing, launch
from coord.model.robot import Limits


def test_the_launch_is_ahead_of_every_other_motion(random_limits, wander):
    """100 random motions within the limits: none is anywhere earlier than the ramp."""
    rng = np.random.default_rng(1)
    for _ in range(100):
        limits = random_limits(rng)
        motion = wander(rng, limits, 40)
        t = np.linspace(0.0, motion.arrival, 300)
        assert np.all(launch(limits).time(motion.state(t)[:, 0]) <= t + 1e-7)


def test_the_landing_is_the_launch_of_the_film_run_backwards(random_limits, wander):
    """Read backwards, a motion to rest is one from rest with acceleration and deceleration swapped."""
    rng = np.random.default_rng(2)
    for _ in range(100):
        limits = random_limits(rng)
        swapped = Limits(
            limits.speed, limits.deceleration, limits.acceleration, limits.jerk, limits.lateral_acceleration
        )
        motion = wander(rng, swapped, 40)
        t = np.linspace(0.0, motion.arrival, 300)
        assert np.all(landing(limits).time(motion.state(t)[:, 0]) <= t + 1e-7)


def test_the_ramp_ends_at_full_speed_and_goes_on_so(random_limits):
    """v/a + a/j (or 2 sqrt(v/j)) to full speed over half the distance at full speed; then 1/v a metre."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        limits = random_limits(rng)
        v, a, j = limits.speed, limits.acceleration, limits.jerk
        duration = v / a + a / j if v * j >= a * a else 2 * (v / j) ** 0.5
        ramp = launch(limits)
        assert ramp.profile.arrival == pytest.approx(duration)
        assert ramp.profile.states[-1] == pytest.approx((v * duration / 2, v, 0.0), abs=1e-12)
        assert ramp.time(v * duration / 2 + 7 * v)[0] == pytest.approx(duration + 7)


def test_no_distance_takes_no_time():
    """0 and negative distances need 0 s; the time grows with the distance."""
    ramp = launch(Limits(1.0, 0.5, 0.5, 1.0, 1.0))
    assert ramp.time([-3.0, 0.0]).tolist() == [0.0, 0.0]
    assert np.all(np.diff(ramp.time(np.linspace(0.0, 9.0, 500))) > 0)
