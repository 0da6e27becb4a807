"""Splicing towards a contact at ego's goal once made a profile with a jerk too few."""

from __future__ import annotations

import pytest

from coord.alone.check import keeps_limits
from coord.model.path import straight
from coord.model.robot import Footprint, Limits, Robot
from coord.timing.delay import Contact
from coord.timing.ego import ego
from coord.timing.splice import spliced


@pytest.mark.xfail(strict=True, raises=ValueError, reason="splice._join: an arc that begins after the arrival")
def test_an_arc_that_begins_after_the_arrival_is_no_splice():
    """The contact lies at the goal, 10 s later: whatever comes back is a motion within the limits."""
    limits = Limits(1.19, 0.91, 0.84, 1.68, 0.5)
    robot = Robot("e", Footprint(0.3), limits, (0.0, 0.0), (4.54, 0.0))
    one = ego(robot, straight((0.0, 0.0), (4.54, 0.0)))
    delay = 10.69512003
    for profile in spliced(one, [Contact(delay, one.alone.arrival + delay, 4.54)], []):
        assert keeps_limits(profile, limits, one.caps)
