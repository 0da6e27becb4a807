"""Motions whose knots may move, against what is known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest
from coord.solvers.knots import Cells
from coord.solvers.linear import farthest
from coord.solvers.movable import Freedom, Motion, moved

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
N = 64


def free(times):
    """Cells without bounds between the times."""
    n = len(times) - 1
    return Cells(np.diff(times), np.full((n, 4), np.inf), np.full((n, 4), -np.inf), np.full(n, 1.0))


def ends_free(trust):
    """Only the last knot, and all others evenly with it, may move."""
    anchors, fixed = np.zeros(N + 1, bool), np.zeros(N + 1, bool)
    anchors[[0, -1]] = fixed[0] = True
    return Freedom(anchors, fixed, trust, trust, trust)


def standing(times):
    return Motion(times, np.zeros((len(times), 3)), np.zeros(len(times) - 1))


@pytest.mark.parametrize("length", [1.0, 4.0, 12.0])
def test_rounds_with_a_free_arrival_come_to_the_quickest_motion(length):
    """From half as much time again as needed, eight rounds: ruckig's time, but for what 64 cells lose."""
    best = rest_to_rest(length, LIMITS).arrival
    times = np.linspace(0.0, 1.5 * best, N + 1)
    motion, trust = standing(times), 0.0
    for _ in range(8):
        motion, lacks = moved(free(motion.times), LIMITS, length, motion, ends_free(trust))
        trust = 1.5
    assert lacks < 1e-6
    assert best - 1e-3 <= motion.times[-1] <= 1.02 * best


def test_without_any_trust_the_motion_is_exact():
    """With all knots where they are, states follow from the jerks, and as much lacks as the goal is out of reach."""
    times = np.linspace(0.0, 8.0, N + 1)
    reached = farthest(free(times), LIMITS)
    motion, lacks = moved(free(times), LIMITS, reached + 0.5, standing(times), ends_free(0.0))
    assert lacks == pytest.approx(0.5, abs=1e-4)
    assert motion.times == pytest.approx(times, abs=1e-9)
    s, v, a = motion.states[:-1].T
    h, j = np.diff(times), motion.jerks
    assert s + h * (v + h * (a / 2 + h * j / 6)) == pytest.approx(motion.states[1:, 0], abs=1e-6)
    assert a + h * j == pytest.approx(motion.states[1:, 2], abs=1e-6)


def test_a_motion_seen_at_other_knots_is_the_same_motion():
    """At 200 moments, place, speed and acceleration are those of the cubics."""
    profile = rest_to_rest(5.0, LIMITS)
    motion = Motion(profile.times, profile.states, profile.jerks)
    moments = np.linspace(0.0, profile.arrival, 200)
    assert motion.at(moments).states == pytest.approx(profile.state(moments), abs=1e-9)


def test_a_lower_bound_out_of_reach_is_missed_by_what_lacks():
    """Past 3 m after 2 s no robot is that starts from rest with 0.5 m/s2."""
    times = np.linspace(0.0, 20.0, N + 1)
    cells = free(times)
    lower = cells.lower.copy()
    lower[times[:-1] >= 2.0] = 3.0
    _, lacks = moved(Cells(cells.h, cells.upper, lower, cells.caps), LIMITS, 6.0, standing(times), ends_free(0.0))
    assert 2.0 < lacks < 3.0
