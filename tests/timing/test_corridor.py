"""Delays that windows ask for and allow along the way, and the steps that rise between them."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.alone.inverse import time_at
from coord.conflicts.window import Window
from coord.model.footprint import Footprint
from coord.model.path import straight
from coord.model.robot import Limits, Robot
from coord.timing.corridor import Corridor, corridor, stairs
from coord.timing.delay import after_contact, before_contact
from coord.timing.ego import ego

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
ONE = ego(Robot("e", Footprint(0.3), LIMITS, (0.0, 0.0), (30.0, 0.0)), straight((0.0, 0.0), (30.0, 0.0)))


def window(begin, until, low, high):
    """A place taken for a while."""
    times = np.array([begin, (begin + until) / 2, until])
    return Window(0, times, np.array([[low, low], [low, low]]), np.array([[high, high], [high, high]]))


def test_no_delay_along_a_window_exceeds_its_contact_and_one_reaches_it():
    """The largest delay needed is that of the contact passed after, the least allowed that of the one passed before."""
    some = window(12.0, 16.0, 9.0, 11.0)
    bounds = corridor(ONE.alone, [some], [some])
    assert np.isclose(bounds.least.max(), after_contact(ONE.alone, some).delay, atol=1e-6)
    assert np.isclose(bounds.most.min(), before_contact(ONE.alone, some).delay, atol=1e-6)


def test_delays_are_the_times_of_the_bounds_less_those_of_the_profile_alone():
    some = window(12.0, 16.0, 9.0, 11.0)
    bounds = corridor(ONE.alone, [some], [])
    assert set(bounds.least_at.tolist()) == {9.0}
    assert not len(bounds.most)
    assert np.isclose(bounds.least.min(), 12.0 - float(time_at(ONE.alone, 9.0)[0]))


def test_one_who_stays_has_to_be_preceded_from_when_it_comes_on():
    """A window without end allows the delay that its beginning allows."""
    stays = Window(0, np.array([20.0, np.inf]), np.array([[9.0, 9.0]]), np.array([[11.0, 11.0]]))
    bounds = corridor(ONE.alone, [], [stays])
    assert np.allclose(bounds.most, 20.0 - float(time_at(ONE.alone, 11.0)[0]))
    assert np.all(np.isfinite(bounds.most))


@settings(deadline=None, derandomize=True, max_examples=200)
@given(
    st.lists(st.tuples(st.floats(1.0, 29.0), st.floats(0.1, 20.0)), min_size=1, max_size=6),
    st.lists(st.tuples(st.floats(1.0, 29.0), st.floats(0.0, 20.0)), max_size=6),
)
def test_steps_rise_within_the_corridor_wherever_the_delay_is_constant(least, most):
    """Up to where a step is allowed the one before is kept, from where it is needed on the step: both are within."""
    (least_at, at_least), (most_at, at_most) = (np.array(some).reshape(-1, 2).T for some in (least, most))
    last = float(at_least.max())
    for steps in stairs(Corridor(least_at, at_least, most_at, at_most), last, 4.0, 30.0):
        delays = [step.delay for step in steps]
        assert delays == sorted(set(delays))
        assert delays[-1] == last
        for before, step in itertools.pairwise(steps):
            # whoever has not stepped yet is late enough before the place that needs the step
            assert np.all(at_least[least_at < step.needed] <= before.delay)
            # whoever has stepped is early enough behind the place that allows it
            assert np.all(at_most[most_at > step.allowed] >= step.delay)
