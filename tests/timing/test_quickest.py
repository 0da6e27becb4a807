"""Ramps: nothing that drives is ahead of them."""

from __future__ import annotations

import numpy as np
import pytest

from coord.model.profile import advance
from coord.timing.quickest import ramps

TOP, MOST, JERK = 1.4, 0.8, 1.7


def wander(rng, v, a, steps=60, h=0.1):
    """Ways after each step of a random motion that keeps 0 <= speed <= TOP, |acceleration| <= MOST and the jerk."""
    state, ways = np.array([[0.0, v, a]]), [0.0]
    for _ in range(steps):
        for jerk in rng.permutation(np.linspace(-JERK, JERK, 9)):
            after = advance(state, np.array([jerk]), np.array([h]))
            s, w, b = after[0]
            room = b * abs(b) / (2 * JERK)  # what the speed still changes by until the acceleration has gone
            if abs(b) <= MOST and w + min(room, 0) >= 0 and w + max(room, 0) <= TOP:
                break
        else:
            return np.array(ways)
        state = after
        ways.append(float(s))
    return np.array(ways)


@pytest.mark.parametrize("seed", range(5))
def test_no_random_motion_is_ahead_of_the_ramp(seed):
    """From a state that is no quicker, after 200 random motions each."""
    rng = np.random.default_rng(seed)
    for _ in range(200):
        v = float(rng.uniform(0.0, TOP))
        a = float(rng.uniform(-min(MOST, np.sqrt(2 * JERK * v)), min(MOST, np.sqrt(2 * JERK * (TOP - v)))))
        quickest = ramps(np.array([v]), np.array([a]), TOP, MOST, JERK)
        w = v * rng.uniform(0.9, 1.0)
        slower = wander(rng, w, max(a - rng.uniform(0.0, 0.2), -MOST, -np.sqrt(2 * JERK * w)) if a > 0 else a)
        times = 0.1 * np.arange(len(slower))
        only = np.zeros(len(times), dtype=np.intp)
        assert np.all(quickest.way(times, only) >= slower - 1e-9)
        assert np.all(quickest.time(slower, only) <= times + 1e-9)


def test_the_table_of_times_is_short_by_less_than_a_millisecond():
    """The way of a ramp, asked back for its time."""
    quickest = ramps(np.full(33, 0.5), np.linspace(-0.8, 0.8, 33), TOP, MOST, JERK)
    times = np.repeat(np.linspace(0.0, 6.0, 500)[None], 33, axis=0)
    each = np.arange(33)[:, None]
    back = quickest.time(quickest.way(times, each), each)
    assert np.all(back <= times + 1e-9)
    assert np.all(back >= times - 1e-3)


def test_a_ramp_at_full_speed_stays_there():
    """Whatever acceleration it is offered."""
    quickest = ramps(np.full(2, TOP), np.array([0.0, 0.5]), TOP, MOST, JERK)
    assert quickest.way(np.array([2.0, 2.0]), np.arange(2)) == pytest.approx(2 * TOP)
