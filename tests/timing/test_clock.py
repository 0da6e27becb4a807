"""Ego's clock: when the motion with the jerk forgotten is where."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.inverse import time_at
from coord.alone.relaxed import without_jerk
from coord.model.path import Path, straight
from coord.model.robot import Limits
from coord.timing.clock import clock

LIMITS = Limits(1.2, 0.7, 0.5, 1.5, 0.3)
WAYS = (straight((0.0, 0.0), (9.0, 0.0)), Path((0.0, 0.0, 0.0), [(4.0, 0.0, 0.0), (2.0, 0.9, 0.9), (3.0, 0.0, 0.0)]))


@pytest.mark.parametrize("path", WAYS, ids=["straight", "bend"])
def test_at_the_time_it_tells_the_motion_is_at_the_place(path):
    """At 500 places the motion is there at that time within a nanometre, and the general inverse tells the same time."""
    relaxed = without_jerk(path, LIMITS)
    places = np.linspace(0.0, path.length, 500)
    times = clock(relaxed, places)
    assert np.all(np.diff(times) > 0)
    assert relaxed.state(times)[:, 0] == pytest.approx(places, abs=1e-9)
    assert times == pytest.approx(time_at(relaxed, places), abs=1e-6)


@pytest.mark.parametrize("path", WAYS, ids=["straight", "bend"])
def test_beyond_the_ends_it_tells_the_times_of_the_ends(path):
    """Before the start 0, behind the goal the arrival."""
    relaxed = without_jerk(path, LIMITS)
    assert clock(relaxed, np.array([-1.0, path.length + 1.0])) == pytest.approx([0.0, relaxed.arrival], abs=1e-9)
