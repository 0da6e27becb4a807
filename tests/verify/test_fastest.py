"""The least time from rest to rest is what ruckig finds, and cannot be beaten."""

from __future__ import annotations

import math

import pytest
import ruckig
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify.fastest import fastest, ramp
from coord.verify.records import Limits

sizes = st.floats(0.05, 5.0)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(length=st.floats(0.01, 50.0), speed=sizes, up=sizes, down=sizes, jerk=sizes)
def test_it_is_the_time_of_an_independent_solver(length, speed, up, down, jerk):
    """Ruckig solves the same problem by other means; lengths from far too short to far long enough to cruise."""
    task = ruckig.InputParameter(1)
    task.target_position = [length]
    task.max_velocity, task.max_acceleration, task.max_jerk = [speed], [up], [jerk]
    task.min_velocity, task.min_acceleration = [0.0], [-down]
    trajectory = ruckig.Trajectory(1)
    try:
        ruckig.Ruckig(1).calculate(task, trajectory)
    except RuntimeError:
        return
    assert fastest(length, Limits(speed, up, down, jerk, 1.0)) == pytest.approx(trajectory.duration, rel=1e-8)


def test_closed_forms():
    """No way takes no time; a short way takes 4 (L / 2 j)^(1/3); a long one L/v plus both ramps, which average v/2."""
    limits = Limits(1.0, 0.5, 0.25, 1.0, 1.0)
    assert fastest(0.0, limits) == pytest.approx(0.0, abs=1e-12)
    assert fastest(1e-3, limits) == pytest.approx(4 * (1e-3 / 2) ** (1 / 3), rel=1e-12)
    both = (1 / 0.5 + 0.5 / 1.0) + (1 / 0.25 + 0.25 / 1.0)
    assert fastest(100.0, limits) == pytest.approx(100.0 + both / 2, rel=1e-12)
    assert ramp(1.0, 100.0, 1.0) == pytest.approx(2 * math.sqrt(1.0))
