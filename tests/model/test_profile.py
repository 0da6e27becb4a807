"""Velocity profiles: s, v and a over time."""

from __future__ import annotations

import pickle
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.model.profile import VelocityProfile, advance
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest

eighths = st.integers(-40, 40).map(lambda n: n / 8)
phases = st.lists(st.tuples(st.integers(1, 40).map(lambda n: n / 8), eighths), min_size=1, max_size=8)


def exact(phases, t):
    """State at t by rational arithmetic, from rest at 0; held at both ends."""
    s = v = a = Fraction(0)
    left = max(Fraction(t), Fraction(0))
    for h, j in phases:
        u, j = min(left, Fraction(h)), Fraction(j)
        s, v, a = s + v * u + a * u**2 / 2 + j * u**3 / 6, v + a * u + j * u**2 / 2, a + j * u
        left -= u
    return [float(s), float(v), float(a)]


def profile_of(phases, departure=0.0):
    times, states = [0.0], [[0.0, 0.0, 0.0]]
    for h, _ in phases:
        times.append(times[-1] + h)
        states.append(exact(phases, times[-1]))
    return VelocityProfile(np.array(times) + departure, states, [j for _, j in phases])


@settings(deadline=None, derandomize=True, max_examples=100)
@given(phases, st.lists(st.floats(-1.0, 50.0), min_size=1, max_size=10))
def test_states_are_those_of_constant_jerks(phases, times):
    """Rational arithmetic gives the same s, v and a at every time; before and after the ends are held."""
    profile = profile_of(phases)
    expected = [exact(phases, t) for t in times]
    scale = 1 + np.abs(profile.states).max()
    assert np.abs(profile.state(times) - expected).max() <= 1e-12 * scale * profile.arrival**3


def test_at_a_knot_the_state_is_the_knots_own():
    """Bit for bit, so that a robot at its goal is at rest, whatever rounding the last phase has."""
    limits = Limits(1.19, 0.91, 0.84, 1.68, 0.5)
    for length in (0.1, 1.0, 4.54, 20.0):
        profile = rest_to_rest(length, limits)
        assert profile.state(profile.times).tolist() == profile.states.tolist()
        assert profile.state(profile.arrival + 1.0)[0].tolist() == [length, 0.0, 0.0]


@settings(deadline=None, derandomize=True, max_examples=50)
@given(phases, st.floats(0.0, 1e3), st.floats(0.0, 1.0))
def test_a_shifted_profile_is_the_same_motion_later(phases, delay, share):
    """Jerks and states stay as they are, bit for bit, and only the times move."""
    profile = profile_of(phases)
    later = profile.shifted(delay)
    assert later.departure == pytest.approx(profile.departure + delay)
    assert later.arrival == pytest.approx(profile.arrival + delay)
    assert later.states.tobytes() == profile.states.tobytes()
    assert later.jerks.tobytes() == profile.jerks.tobytes()
    t = share * profile.arrival
    assert np.abs(later.state(t + delay) - profile.state(t)).max() < 1e-8 * (1 + np.abs(profile.states).max())


def test_a_profile_knows_when_it_departs_and_arrives_and_how_far_it_goes():
    """First knot, last knot, last arc length."""
    profile = profile_of([(1.0, 1.0), (2.0, -1.0), (1.0, 1.0)], departure=5.0)
    assert (profile.departure, profile.arrival, profile.length) == (5.0, 9.0, exact(((1, 1), (2, -1), (1, 1)), 4)[0])


def test_a_robot_that_never_moves_has_one_knot():
    """It is at the same place at all times, and arrives when it departs."""
    profile = VelocityProfile([3.0], [(0.0, 0.0, 0.0)], [])
    assert profile.state([0.0, 3.0, 99.0]).tolist() == [[0.0, 0.0, 0.0]] * 3
    assert profile.departure == profile.arrival == 3.0
    assert profile.shifted(1.0).arrival == 4.0


def test_profiles_cannot_be_changed():
    """Their arrays are read-only copies."""
    times = np.array([0.0, 1.0])
    profile = VelocityProfile(times, [(0, 0, 0), (1 / 6, 0.5, 1)], [1.0])
    times[1] = 9.0
    assert profile.arrival == 1.0
    for array in (profile.times, profile.states, profile.jerks):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0
    with pytest.raises(AttributeError):
        profile.times = times


def test_a_profile_survives_pickling():
    """All its numbers are the same to the last bit, and it is still read-only."""
    profile = profile_of([(0.1, 0.3), (0.7, -0.2)])
    copy = pickle.loads(pickle.dumps(profile))  # noqa: S301
    for name in ("times", "states", "jerks"):
        assert getattr(copy, name).tobytes() == getattr(profile, name).tobytes()
        assert not getattr(copy, name).flags.writeable


@settings(deadline=None, derandomize=True, max_examples=50)
@given(st.tuples(eighths, eighths, eighths), eighths, st.floats(0.0, 4.0), st.floats(0.0, 4.0))
def test_advancing_twice_is_advancing_once(state, jerk, first, second):
    """Constant jerk for h1, then for h2, is constant jerk for h1 + h2."""
    start, j = np.array([state]), np.array([jerk])
    twice = advance(advance(start, j, np.array([first])), j, np.array([second]))
    assert twice == pytest.approx(advance(start, j, np.array([first + second])), abs=1e-11)


@settings(deadline=None, derandomize=True, max_examples=50)
@given(phases, st.lists(st.floats(-5, 60), min_size=1, max_size=20))
def test_one_place_is_what_the_states_say_to_the_last_digit(phases, times):
    """At any time, before the departure and behind the arrival as well."""
    profile = profile_of(phases, departure=1.0)
    asked = [*times, *profile.times.tolist()]
    assert [profile.place(t) for t in asked] == profile.state(asked)[:, 0].tolist()
