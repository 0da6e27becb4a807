"""Motions on paths with bends: the times of the bends and the arrival are found together, from a rough course."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.check import keeps_limits
from coord.alone.inverse import time_at
from coord.conflicts.window import Window
from coord.model.footprint import Footprint
from coord.model.path import Path
from coord.model.robot import Limits, Robot
from coord.timing.clear import excess
from coord.timing.ego import ego
from coord.timing.grid import Course
from coord.timing.haste import hasty_course
from coord.timing.program import through_tube
from coord.timing.tube import Tube, after_bound, before_bound

#: 8 m straight on, a bend to the left of 2 m that may be driven at 0.5 m/s, and 8 m straight on.
BEND = Path((0.0, 0.0, 0.0), [(8.0, 0, 0), (2.0, 1.2, 1.2), (8.0, 0, 0)])


@pytest.fixture(scope="module")
def one():
    return ego(Robot("e", Footprint(0.3), Limits(1.0, 0.5, 0.5, 1.0, 0.3), (0.0, 0.0), BEND.end), BEND)


def block(since, until, low, high):
    """The place between low and high is taken from a time until another."""
    return Window(0, np.array([since, until]), np.array([[low, low]]), np.array([[high, high]]))


@pytest.mark.parametrize("stretch", [1.02, 1.3, 2.0])
@pytest.mark.parametrize("even", [False, True])
def test_alone_any_course_leads_to_the_quickest_motion(one, stretch, even):
    """From the quickest course, and from one at even speed, in up to twice the time: within 0.3 % of the time alone."""
    times = np.linspace(0.0, one.alone.arrival, 200)
    s = np.linspace(0.0, one.length, 200) if even else np.maximum.accumulate(one.alone.state(times)[:, 0])
    profile = through_tube(one, Tube([], []), one.solo_bound, 3 * one.alone.arrival, Course(times * stretch, s))
    assert profile is not None
    assert keeps_limits(profile, one.robot.limits, one.caps)
    assert one.solo_bound <= profile.arrival <= 1.003 * one.alone.arrival


@pytest.mark.parametrize("where", [4.0, 7.5, 8.5, 9.9, 10.5, 14.0])
def test_from_the_hasty_course_a_place_is_passed_as_soon_as_it_is_free(one, where):
    """A place taken until t = 30, before, in and behind the bend: at most 4 % later than without jerk, and clear."""
    window = block(0.0, 30.0, where, where + 0.5)
    tube = Tube([after_bound(window)], [])
    course = hasty_course(one, tube)
    profile = through_tube(one, tube, one.solo_bound, 100.0, course)
    assert profile is not None
    assert keeps_limits(profile, one.robot.limits, one.caps)
    assert excess(profile, window).passes_after
    assert excess(profile, window).is_clear
    assert course.times[-1] - 1e-6 <= profile.arrival <= 1.04 * course.times[-1] + 1.0


@pytest.mark.parametrize("spare", [0.05, 0.3])
def test_a_place_is_passed_in_time_though_the_course_comes_late(one, spare):
    """Behind the bend by the time alone and a little: the course is a tenth later, the profile is in time."""
    at = float(time_at(one.alone, 12.0)[0]) + spare
    window = block(at, at + 20.0, 10.5, 12.0)
    times = np.linspace(0.0, one.alone.arrival, 200)
    late = Course(1.1 * times, np.maximum.accumulate(one.alone.state(times)[:, 0]))
    profile = through_tube(one, Tube([], [before_bound(window)]), one.solo_bound, 60.0, late)
    assert profile is not None
    assert excess(profile, window).is_clear
    assert not excess(profile, window).passes_after
    assert profile.arrival <= 1.003 * one.alone.arrival


def test_the_hasty_course_is_nowhere_later_than_any_motion(one):
    """Against the profiles through tubes with a place taken, at 500 moments."""
    for where in (4.0, 8.5, 12.0):
        tube = Tube([after_bound(block(0.0, 25.0, where, where + 1.0))], [])
        course = hasty_course(one, tube)
        profile = through_tube(one, tube, one.solo_bound, 100.0, course)
        moments = np.linspace(0.0, course.times[-1], 500)
        # between its own moments the course is a chord of a curve
        assert np.all(course.at(moments) >= profile.state(moments)[:, 0] - 5e-3)


def test_where_no_motion_is_in_time_none_is_found(one):
    """Behind the bend half a second before the quickest motion could be there."""
    at = float(time_at(one.alone, 12.0)[0]) - 0.5
    tube = Tube([], [before_bound(block(at, at + 20.0, 10.5, 12.0))])
    assert through_tube(one, tube, one.solo_bound, 60.0, hasty_course(one, tube)) is None
