"""Legs from rest to rest: braking is as late as it can be, and nothing breaks a limit."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from coord.alone.check import keeps_limits
from coord.alone.fastest import fastest
from coord.model.footprint import Footprint
from coord.model.path import straight
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.solvers.jerk import rest_to_rest
from coord.timing.ego import ego
from coord.timing.legs import braked, followed, last_moment, onward

LIMITS = [
    Limits(1.0, 0.5, 0.5, 1.0, 0.5),
    Limits(1.7, 0.4, 1.1, 0.8, 0.5),
    Limits(0.6, 1.2, 0.3, 3.0, 0.5),
]


def on_a_line(limits, length=12.0, release=0.0):
    robot = Robot("r", Footprint(0.3), limits, (0.0, 0.0), (length, 0.0), release=release)
    return ego(robot, straight(robot.start, robot.goal))


def in_bends(bent_crossing, seed):
    problem = bent_crossing(seed)
    route = find_routes(problem, "fitted")[0]
    mine = ego(problem.robots[0], route.path, route.alone)
    assert not mine.caps.is_constant
    return mine


def stopped(leg, place, limits):
    return braked(leg, last_moment(leg, place, limits), limits)


@pytest.mark.parametrize("limits", LIMITS)
@pytest.mark.parametrize("place", [0.06, 0.4, 1.5, 5.0, 11.9])
def test_driving_on_and_braking_late_is_the_quickest_way_to_rest_somewhere(limits, place):
    """On a straight line nothing rests there sooner: the same arrival as ruckig's from rest to rest."""
    mine = on_a_line(limits)
    stop = stopped(mine.alone, place, limits)
    assert stop.length == pytest.approx(place, abs=1e-9)
    assert stop.arrival == pytest.approx(rest_to_rest(place, limits).arrival, abs=1e-6)
    assert keeps_limits(stop, limits, mine.caps)


@pytest.mark.parametrize("seed", range(6))
def test_braking_keeps_all_limits_and_caps_in_bends(bent_crossing, seed):
    """Wherever it stops, it keeps every cap on the way, ends at rest, and at that place to 1e-9 m."""
    mine = in_bends(bent_crossing, seed)
    for place in np.linspace(0.1, mine.length - 0.01, 40).tolist():
        stop = stopped(mine.alone, place, mine.robot.limits)
        assert stop.length == pytest.approx(place, abs=1e-9)
        assert keeps_limits(stop, mine.robot.limits, mine.caps)


@pytest.mark.parametrize("seed", range(3))
def test_braking_a_moment_later_ends_beyond_the_place(bent_crossing, seed):
    """The moment is the last one: a hundredth of a second after it the stop is too late."""
    mine = in_bends(bent_crossing, seed)
    for place in np.linspace(0.5, mine.length - 0.5, 20).tolist():
        moment = last_moment(mine.alone, place, mine.robot.limits)
        assert braked(mine.alone, moment + 0.01, mine.robot.limits).length > place


def test_who_could_never_overshoot_a_place_need_not_brake_for_it():
    """At its goal or beyond there is nothing to brake for: the moment is the arrival."""
    mine = on_a_line(LIMITS[0])
    for place in (mine.length, mine.length + 3.0):
        assert last_moment(mine.alone, place, LIMITS[0]) == mine.alone.arrival


@pytest.mark.parametrize("seed", range(4))
def test_going_on_from_rest_keeps_all_limits_and_reaches_the_goal(bent_crossing, seed):
    """From any place of a way with bends, and from rest to rest."""
    mine = in_bends(bent_crossing, seed)
    for s in np.linspace(0.3, mine.length - 0.1, 8).tolist():
        leg = onward(mine, s, 7.0)
        stop = stopped(mine.alone, s, mine.robot.limits)
        whole = followed(stop, onward(mine, stop.length, 90.0))
        assert leg.departure == 7.0
        assert (leg.states[0, 0], *leg.states[-1]) == (s, mine.length, 0.0, 0.0)
        assert keeps_limits(whole, mine.robot.limits, mine.caps)


def test_going_on_along_a_line_is_the_quickest_there_is():
    """As quick as a robot that starts there."""
    mine = on_a_line(LIMITS[1])
    ahead = fastest(straight((4.5, 0.0), (12.0, 0.0)), LIMITS[1])
    assert onward(mine, 4.5, 3.0).arrival == pytest.approx(3.0 + ahead.arrival, abs=1e-9)


def test_going_on_from_the_start_is_driving_alone():
    """The very profile, later, also with a release time."""
    mine = on_a_line(LIMITS[0], release=2.5)
    leg = onward(mine, 0.0, 9.0)
    assert (leg.departure, leg.states.tolist()) == (9.0, mine.alone.states.tolist())


def test_between_two_legs_a_robot_stands_still():
    """Speed and acceleration are exactly 0 all the time, and the place is the one where it came to rest."""
    mine = on_a_line(LIMITS[0])
    stop = stopped(mine.alone, 5.0, LIMITS[0])
    whole = followed(stop, onward(mine, stop.length, stop.arrival + 4.0))
    waits = whole.state(np.linspace(stop.arrival, stop.arrival + 4.0, 101))
    assert np.all(waits[:, 1:] == 0)
    assert np.ptp(waits[:, 0]) == 0
    assert whole.arrival > stop.arrival + 4.0


def test_a_stop_without_a_wait_has_no_phase_of_no_length():
    """Where the next leg leaves at once, or a hair later, times still increase."""
    mine = on_a_line(LIMITS[0])
    stop = stopped(mine.alone, 5.0, LIMITS[0])
    for wait in (0.0, 1e-12):
        whole = followed(stop, onward(mine, stop.length, stop.arrival + wait))
        assert np.all(np.diff(whole.times) > 1e-11)
        assert keeps_limits(whole, LIMITS[0], mine.caps)


def test_slow_brakes_begin_to_brake_earlier():
    """A robot that decelerates less has to decide sooner."""
    quick, slow = LIMITS[0], dataclasses.replace(LIMITS[0], deceleration=0.1)
    leg = on_a_line(quick).alone
    assert last_moment(leg, 8.0, slow) < last_moment(leg, 8.0, quick) - 1.0
