"""When a profile is somewhere: the inverse of where it is when."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.alone.inverse import increasing_root, time_at
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest


def test_time_at_is_the_inverse_of_the_state(random_limits, wander):
    """For 50 random motions with stops: the place at the time of a place is that place."""
    rng = np.random.default_rng(1)
    for _ in range(50):
        motion = wander(rng, random_limits(rng), 30)
        s = np.linspace(0.0, motion.length, 400)
        assert motion.state(time_at(motion, s))[:, 0] == pytest.approx(s, abs=1e-9)


def test_time_at_is_the_earliest_time(random_limits, wander):
    """A ten-thousandth of a second earlier the robot is not there yet; the times never decrease."""
    rng = np.random.default_rng(2)
    for _ in range(50):
        motion = wander(rng, random_limits(rng), 30)
        s = np.linspace(0.0, motion.length, 400)
        t = time_at(motion, s)
        assert np.all(np.diff(t) >= 0)
        earlier = motion.state(t - 1e-4)[:, 0]
        assert np.all(earlier <= s + 1e-10)


def stop_and_go(dwell):
    """2 m, a stop of some length, 3 m more."""
    first, second = rest_to_rest(2.0, Limits(1, 0.5, 0.5, 1, 1)), rest_to_rest(3.0, Limits(1, 0.5, 0.5, 1, 1))
    times = [*first.times, *(first.arrival + dwell + second.times)]
    states = [*first.states, *(np.array([2.0, 0.0, 0.0]) + second.states)]
    return first.arrival, VelocityProfile(times, states, [*first.jerks, 0.0, *second.jerks])


def test_at_a_stop_the_time_is_that_of_coming_to_rest():
    """The robot is at 2 m from the end of its first motion on; a hair farther only after the stop."""
    arrival, profile = stop_and_go(10.0)
    assert time_at(profile, 2.0)[0] == pytest.approx(arrival, abs=1e-4)
    assert time_at(profile, 2.0 + 1e-6)[0] > arrival + 10.0


def test_beyond_the_ends_the_times_of_the_ends_are_given_exactly():
    """Departure for the start and before it, arrival for the goal and behind it, without the cube root of rounding."""
    profile = rest_to_rest(5.0, Limits(1.0, 0.5, 0.5, 1.0, 1.0)).shifted(3.0)
    assert time_at(profile, [-1.0, 0.0]).tolist() == [3.0, 3.0]
    assert time_at(profile, [5.0, 6.0]).tolist() == [profile.arrival] * 2


def test_a_robot_that_never_moves_is_there_when_it_departs():
    """All places have the time of its only knot."""
    assert time_at(VelocityProfile([2.0], [(0.0, 0.0, 0.0)], []), [0.0, 1.0]).tolist() == [2.0, 2.0]


rates = st.one_of(st.just(0.0), st.floats(1e-12, 5.0))


@settings(deadline=None, derandomize=True, max_examples=200)
@given(rates, rates, rates, st.floats(0.01, 10), st.floats(0, 1))
def test_the_root_of_an_increasing_cubic_is_found(c1, c2, c3, h, share):
    """The value there is 0 up to rounding, wherever in the interval the root lies and however flat the cubic is."""
    u = share * h
    c0 = -u * (c1 + u * (c2 + u * c3))
    root = increasing_root(tuple(np.array([c]) for c in (c0, c1, c2, c3)), np.array([h]))[0]
    assert 0 <= root <= h
    scale = h * (c1 + h * (c2 + h * c3))
    assert abs(c0 + root * (c1 + root * (c2 + root * c3))) <= 1e-13 * (scale + 1)


@pytest.mark.parametrize("power", range(-15, 0))
def test_near_a_stop_the_time_is_the_cube_root_of_what_is_left(power):
    """With the jerk alone: a way d before the end lasts the cube root of 6 d / j, to nine digits however short it is."""
    jerk, h = 1.5, 2.0
    way = jerk * h**3 / 6 * 10.0**power
    # (h - u)^3 j / 6 = d as a cubic in u, and the same from the other end
    coming = np.array([[way - jerk * h**3 / 6], [jerk * h**2 / 2], [-jerk * h / 2], [jerk / 6]])
    going = np.array([[-way], [0.0], [0.0], [jerk / 6]])
    expected = h * 10.0 ** (power / 3)
    assert increasing_root(going, np.array([h]))[0] == pytest.approx(expected, rel=1e-9)
    if power > -9:  # the constant term itself is rounded
        assert h - increasing_root(coming, np.array([h]))[0] == pytest.approx(expected, rel=1e-5)
