"""Splicing towards a contact at ego's goal once made a profile with a jerk too few."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.check import keeps_limits
from coord.model.footprint import Footprint
from coord.model.path import straight
from coord.model.robot import Limits, Robot
from coord.timing.corridor import Corridor
from coord.timing.ego import ego
from coord.timing.splice import spliced


def test_an_arc_that_begins_after_the_arrival_is_no_splice():
    """The contact lies at the goal, 10 s later: whatever comes back is a motion to the goal."""
    limits = Limits(1.19, 0.91, 0.84, 1.68, 0.5)
    robot = Robot("e", Footprint(0.3), limits, (0.0, 0.0), (4.54, 0.0))
    one = ego(robot, straight((0.0, 0.0), (4.54, 0.0)))
    delay, none = 10.69512003, np.empty(0)
    bounds = Corridor(np.array([4.54]), np.array([delay]), none, none)
    for profile in spliced(one, bounds, delay):
        assert len(profile.times) == len(profile.states) == len(profile.jerks) + 1
        assert profile.states[-1] == pytest.approx((4.54, 0.0, 0.0), abs=1e-12)
        keeps_limits(profile, limits, one.caps)  # may refuse it, must not fail
