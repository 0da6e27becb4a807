"""The relaxation: above every motion, and not far above."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from coord.model.robot import Limits
from coord.solvers.assembly import Assembly
from coord.solvers.jerk import rest_to_rest
from coord.solvers.relaxation import Stages, farthest_bound

LIMITS = Limits(1.0, 0.5, 0.4, 1.0, 0.5)


def stages(arrival, cells, low=None, high=None):
    """An even grid on which nothing but the limits holds, and bounds on s where given."""
    one = np.ones(cells + 1)
    return Stages(np.full(cells, arrival / cells), 0 * one if low is None else low, 100 * one if high is None else high,
                  one, one[1:], 0 * one, one)  # fmt: skip


@pytest.mark.parametrize("length", [0.3, 2.0, 7.0, 20.0])
def test_the_farthest_way_is_bounded_closely(length):
    """In ruckig's own time for a length: never less than the length, at most 3 cm more with 96 cells."""
    arrival = rest_to_rest(length, LIMITS).arrival
    bound, states = farthest_bound(stages(arrival, 96), LIMITS)
    assert length <= bound <= length + 0.03
    assert states[-1, 0] == pytest.approx(bound, abs=1e-3)


@pytest.mark.parametrize("seed", range(10))
def test_a_motion_within_bounds_is_never_ruled_out(seed):
    """Bounds drawn about a motion's own places at the knots: it gets at least as far as the motion does."""
    rng = np.random.default_rng(seed)
    motion = rest_to_rest(float(rng.uniform(2, 15)), LIMITS).shifted(float(rng.uniform(0, 3)))
    cells = int(rng.choice([8, 24, 64]))
    s = motion.state(np.linspace(0.0, motion.arrival, cells + 1))[:, 0]
    low, high = s - rng.uniform(0, 0.2, cells + 1), s + rng.uniform(0, 0.2, cells + 1)
    assert farthest_bound(stages(motion.arrival, cells, low, high), LIMITS)[0] >= motion.length - 1e-9


def test_what_lacks_at_lower_bounds_is_taken_off():
    """2 m at the middle of 6 s and rest at 2.1 m in the end could be; 4 m at the middle of 6 s cannot."""
    for place, can_be in ((2.0, True), (4.0, False)):
        low, high = np.zeros(49), np.full(49, 4.5)
        low[24:] = place
        bound = farthest_bound(stages(6.0, 48, low, high), LIMITS)[0]
        assert (bound >= place) == can_be


@pytest.mark.parametrize("noise", [1e-6, 1e-3, 1.0])
def test_wrong_multipliers_only_loosen_the_bound(monkeypatch, noise):
    """Whatever the solver says, the bound is at least the true one."""
    length, cells = 7.0, 48
    arrival = rest_to_rest(length, LIMITS).arrival
    rng, solve = np.random.default_rng(0), Assembly.solve

    def noisy(program, **arguments):
        found = solve(program, **arguments)
        return dataclasses.replace(found, multipliers=found.multipliers + rng.normal(0, noise, len(found.multipliers)))

    monkeypatch.setattr(Assembly, "solve", noisy)
    assert farthest_bound(stages(arrival, cells), LIMITS)[0] >= length
