"""Giving way on the move by arcs between more and more delayed profiles."""

from __future__ import annotations

import numpy as np

from coord.alone.check import keeps_limits
from coord.alone.inverse import time_at
from coord.model.footprint import Footprint
from coord.model.path import Path, straight
from coord.model.robot import Limits, Robot
from coord.timing.delay import Contact
from coord.timing.ego import ego
from coord.timing.splice import spliced

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def robot(path):
    place = tuple(path.poses[0, :2].tolist())
    return ego(Robot("e", Footprint(0.3), LIMITS, place, path.end, release=2.0), path)


def contact(one, s, delay):
    """The delay must be this much when the robot is at s."""
    return Contact(delay, float(time_at(one.alone, s)[0]) + delay, s)


def test_a_splice_keeps_the_limits_and_ends_as_late_as_its_last_delay():
    """On a straight way and one with a bend: early as if alone, then with each delay in turn, consistent throughout."""
    bend = Path((0.0, 0.0, 0.0), [(12.0, 0, 0), (1.0, 0.8, 0.8), (8.0, 0, 0)])
    for path in (straight((0.0, 0.0), (24.0, 0.0)), bend):
        one = robot(path)
        for delays in ((1.5,), (0.8, 4.0), (1.0, 1.0), (0.5, 1.5, 6.0)):
            places = np.linspace(0.45, 0.8, len(delays)) * one.length
            contacts = [contact(one, s, delay) for s, delay in zip(places.tolist(), delays, strict=True)]
            profiles = list(spliced(one, contacts, []))
            # an arc that would have to cross the bend at full speed does not exist
            assert profiles or (path is bend and len(set(delays)) > 1)
            for profile in profiles:
                assert keeps_limits(profile, LIMITS, one.caps)
                assert np.isclose(profile.arrival, one.alone.arrival + max(delays), atol=1e-8)
                assert profile.departure == one.alone.departure


def test_a_place_to_be_passed_before_somebody_is_reached_with_the_delay_up_to_there():
    """Before at 8 m with at most 0.5 s, after at 14 m with at least 5 s: on time at the one, late enough at the other."""
    one = robot(straight((0.0, 0.0), (24.0, 0.0)))
    before, after = contact(one, 8.0, 0.5), contact(one, 14.0, 5.0)
    profiles = list(spliced(one, [after], [before]))
    assert profiles
    for profile in profiles:
        assert time_at(profile, 8.0)[0] <= before.time + 1e-9


def test_a_place_behind_that_needs_more_delay_than_a_place_ahead_allows_cannot_be_spliced():
    """After at 8 m with 5 s, before at 14 m with at most 1 s: delays only grow."""
    one = robot(straight((0.0, 0.0), (24.0, 0.0)))
    assert list(spliced(one, [contact(one, 8.0, 5.0)], [contact(one, 14.0, 1.0)])) == []


def test_contacts_at_the_ends_of_the_way_give_valid_profiles_or_none():
    """At 0, near 0, near the goal and at the goal, for small and large delays: nothing but motions within the limits."""
    one = robot(straight((0.0, 0.0), (24.0, 0.0)))
    for s in (0.0, 1e-9, 1e-3, 23.999, 24.0 - 1e-9):
        for delay in (1e-6, 0.1, 3.0, 50.0):
            for profile in spliced(one, [contact(one, s, delay)], []):
                assert keeps_limits(profile, LIMITS, one.caps)
