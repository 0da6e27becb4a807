"""The motion without a jerk limit: never slower anywhere than one that can be driven."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.fastest import fastest
from coord.alone.inverse import time_at
from coord.alone.relaxed import without_jerk
from coord.model.path import straight
from coord.model.robot import Limits


def test_on_a_straight_line_it_is_the_trapezoid():
    """20 m at 1 m/s with 1/2 m/s2: 20 s and 1 s for each ramp; on 1 m a triangle of 2 sqrt(2) s."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    assert without_jerk(straight((0, 0), (20, 0)), limits).arrival == pytest.approx(22.0)
    assert without_jerk(straight((0, 0), (1, 0)), limits).arrival == pytest.approx(2 * np.sqrt(2))


def test_between_any_two_places_a_motion_within_all_limits_takes_at_least_as_long(bends, random_limits):
    """On all bends with 20 limits each: the quickest profile found is slower between any neighbours of 300 places."""
    rng = np.random.default_rng(1)
    for path in bends.values():
        for _ in range(20):
            limits = random_limits(rng)
            real, relaxed = fastest(path, limits), without_jerk(path, limits)
            s = np.linspace(0.0, path.length, 300)
            assert np.all(np.diff(time_at(real, s) - time_at(relaxed, s)) >= -1e-9)
            assert relaxed.length == path.length
