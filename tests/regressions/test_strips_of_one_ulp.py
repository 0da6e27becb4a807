"""Strips of a window that last as long as the last digit of their times."""

from __future__ import annotations

import numpy as np

from coord.conflicts.window import Window
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest
from coord.timing.clear import excess


def test_a_strip_of_one_ulp_is_no_reason_to_fail():
    """A window that lasts for one or two ulps after t = 1: clear where the robot is elsewhere, a collision where it is inside."""
    profile = rest_to_rest(10.0, Limits(1.0, 0.5, 0.7, 1.0, 0.5))
    s = float(profile.state(1.0)[0, 0])
    one = np.nextafter(1.0, 2.0)
    two = np.nextafter(one, 2.0)
    for times in ([1.0, one], [one, two], [1.0, one, two], [0.5, one, two]):
        strips = len(times) - 1
        for low, high, clear in ((s - 0.1, s + 0.1, False), (s + 0.1, s + 0.2, True), (-1.0, s - 0.3, False)):
            bounds = np.full((strips, 2), low), np.full((strips, 2), high)
            if high < 0 and not clear:
                continue
            gap = excess(profile, Window(0, np.array(times), *bounds))
            assert gap.is_clear == (clear or high < float(profile.state(times[0])[0, 0]))
