"""The quickest motion through sections with caps, where the answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from coord.model.profile import advance
from coord.model.robot import Limits
from coord.solvers.jerk import motion, rest_to_rest
from coord.solvers.nonlinear import PHASES, quickest_phases

LIMITS = Limits(2.0, 0.5, 0.8, 1.0, 0.5)


def guess(profiles):
    """Rows s, v, a, duration, jerk of a chain of profiles, the longest phases halved until there are seven each."""
    rows = []
    for profile in profiles:
        part = [[*s, h, j] for s, h, j in zip(profile.states.tolist(), np.diff(profile.times), profile.jerks, strict=False)]
        while len(part) < PHASES:
            k = max(range(len(part)), key=lambda i: part[i][3])
            s, v, a, h, j = part[k]
            middle = advance(np.array([[s, v, a]]), np.array([j]), np.array([h / 2]))[0]
            part[k : k + 1] = [[s, v, a, h / 2, j], [*middle, h / 2, j]]
        rows += part
    return np.array(rows)


def states(durations, jerks):
    result = [np.zeros(3)]
    for h, j in zip(durations, jerks, strict=True):
        result.append(advance(result[-1][None], np.array([j]), np.array([h]))[0])
    return np.array(result)


@pytest.mark.parametrize("length", [0.3, 2.0, 8.0, 40.0])
def test_with_one_section_the_program_finds_the_time_of_ruckig(length):
    """From a motion at half the limits it comes to the time-optimal one, within 0.1 %."""
    slow = Limits(1.0, 0.25, 0.4, 0.5, 0.5)
    first = rest_to_rest(length, slow)
    durations, jerks = quickest_phases(np.array([length]), np.array([2.0]), LIMITS, guess([first]))
    best = rest_to_rest(length, LIMITS).arrival
    assert best * (1 - 1e-6) <= durations.sum() <= best * 1.001
    assert states(durations, jerks)[-1] == pytest.approx((length, 0.0, 0.0), abs=1e-6)


def test_a_slow_section_is_passed_at_its_cap_and_left_within_its_end():
    """Speeds stay below each section's cap, the border is where it should be, and the whole is slower than without the cap."""
    ends, caps = np.array([4.0, 6.0, 10.0]), np.array([2.0, 0.5, 2.0])
    chain, at = [], (0.0, 0.0, 0.0)
    for end, speed in ((4.0, 0.5), (6.0, 0.5), (10.0, 0.0)):
        chain.append(motion(at, (end, speed, 0.0), Limits(0.5 if end == 6 else 1.5, 0.4, 0.4, 0.8, 0.5)))
        at = (end, speed, 0.0)
    durations, jerks = quickest_phases(ends, caps, LIMITS, guess(chain))
    along = states(durations, jerks)
    assert along[PHASES, 0] == pytest.approx(4.0, abs=1e-6)
    assert along[2 * PHASES, 0] == pytest.approx(6.0, abs=1e-6)
    assert along[PHASES : 2 * PHASES + 1, 1].max() <= 0.5 + 1e-6
    assert np.abs(jerks).max() <= 1.0 + 1e-6
    assert along[:, 2].max() <= 0.5 + 1e-6
    assert along[:, 2].min() >= -0.8 - 1e-6
    free, slowest = rest_to_rest(10.0, LIMITS).arrival, sum(part.arrival for part in chain)
    assert free + 0.5 < durations.sum() < slowest
    # two metres at 0.5 m/s, and on both sides ramps that cannot be quicker than without a jerk limit
    assert durations.sum() >= 2.0 / 0.5 + 2 * 4.0 / 2.0
