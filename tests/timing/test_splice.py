"""Giving way on the move by arcs between more and more delayed profiles."""

from __future__ import annotations

import numpy as np

from coord.alone.check import keeps_limits
from coord.alone.inverse import time_at
from coord.model.footprint import Footprint
from coord.model.path import Path, straight
from coord.model.robot import Limits, Robot
from coord.timing.corridor import Corridor
from coord.timing.ego import ego
from coord.timing.splice import spliced

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def robot(path):
    place = tuple(path.poses[0, :2].tolist())
    return ego(Robot("e", Footprint(0.3), LIMITS, place, path.end, release=2.0), path)


def corridor(least, most=()):
    """Delays that are needed, and that are allowed, as pairs of a place and a delay."""
    (least_at, at_least), (most_at, at_most) = (np.array(list(some)).reshape(-1, 2).T for some in (least, most))
    return Corridor(least_at, at_least, most_at, at_most)


def delay_at(one, profile, s):
    return float(time_at(profile, s)[0] - time_at(one.alone, s)[0])


def test_a_splice_keeps_the_limits_and_ends_as_late_as_its_last_delay():
    """On a straight way and one with a bend, late by a delay at one place or by rising ones at several."""
    bend = Path((0.0, 0.0, 0.0), [(12.0, 0, 0), (1.0, 0.8, 0.8), (8.0, 0, 0)])
    for path in (straight((0.0, 0.0), (24.0, 0.0)), bend):
        one = robot(path)
        for delays in ((1.5,), (0.8, 4.0), (1.0, 1.0), (0.5, 1.5, 6.0)):
            places = (np.linspace(0.45, 0.8, len(delays)) * one.length).tolist()
            # on time in the beginning
            bounds = corridor(zip(places, delays, strict=True), [(0.1 * one.length, 0.3)])
            profiles = list(spliced(one, bounds, max(delays)))
            assert profiles
            for profile in profiles:
                assert keeps_limits(profile, LIMITS, one.caps)
                assert np.isclose(profile.arrival, one.alone.arrival + max(delays), atol=1e-8)
                assert one.alone.departure <= profile.departure <= one.alone.departure + 0.3


def test_a_place_to_be_passed_before_somebody_is_reached_with_the_delay_up_to_there():
    """Before at 8 m with at most 0.5 s, after at 14 m with at least 5 s: on time at the one, late enough at the other."""
    one = robot(straight((0.0, 0.0), (24.0, 0.0)))
    first = next(spliced(one, corridor([(14.0, 5.0)], [(8.0, 0.5)]), 5.0))
    assert delay_at(one, first, 8.0) <= 0.5 + 1e-9
    assert delay_at(one, first, 14.0) >= 5.0 - 1e-9


def test_a_corridor_that_rises_all_the_way_is_climbed_in_several_steps():
    """Before somebody slower and after somebody slower yet: between both from the beginning to the end."""
    one = robot(straight((0.0, 0.0), (60.0, 0.0)))
    places = np.linspace(5.0, 50.0, 91)
    least, most = 0.2 * (places - 5.0), 0.2 * (places - 5.0) + 4.0
    bounds = corridor(zip(places, least, strict=True), zip(places, most, strict=True))
    profile = next(spliced(one, bounds, float(least[-1])))
    delays = np.array([delay_at(one, profile, s) for s in places.tolist()])
    assert np.all(delays >= least - 1e-9)
    assert np.all(delays <= most + 1e-9)
    assert np.unique(delays.round(6)).size > 2


def test_a_bend_is_crossed_no_faster_than_alone_when_delay_is_needed_on_both_sides_of_it():
    """It slows down before the bend, or behind it, or goes through it slowly: never above its cap."""
    one = robot(Path((0.0, 0.0, 0.0), [(12.0, 0, 0), (1.0, 0.8, 0.8), (12.0, 0, 0)]))
    for at, until in ((10.0, 4.0), (20.0, 8.0), (22.0, 14.0)):
        profile = next(spliced(one, corridor([(at, 3.0)], [(until, 0.2)]), 3.0))
        assert keeps_limits(profile, LIMITS, one.caps)
        assert delay_at(one, profile, until) <= 0.2 + 1e-9
        assert delay_at(one, profile, at) >= 3.0 - 1e-9


def test_a_place_behind_that_needs_more_delay_than_a_place_ahead_allows_cannot_be_spliced():
    """After at 8 m with 5 s, before at 14 m with at most 1 s: delays only grow."""
    one = robot(straight((0.0, 0.0), (24.0, 0.0)))
    assert list(spliced(one, corridor([(8.0, 5.0)], [(14.0, 1.0)]), 5.0)) == []


def test_contacts_at_the_ends_of_the_way_give_valid_profiles_or_none():
    """At 0, near 0, near the goal and at the goal, for small and large delays: nothing but motions within the limits."""
    one = robot(straight((0.0, 0.0), (24.0, 0.0)))
    for s in (0.0, 1e-9, 1e-3, 23.999, 24.0 - 1e-9):
        for delay in (1e-6, 0.1, 3.0, 50.0):
            for profile in spliced(one, corridor([(s, delay)]), delay):
                assert keeps_limits(profile, LIMITS, one.caps)
