"""Motions and paths for the tests of one robot alone."""

from __future__ import annotations

import numpy as np
import pytest

from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits


def _wander(rng, limits, phases):
    """A motion from rest by random jerks that keeps all limits, stopping and starting as it pleases."""
    times, states, jerks = [0.0], [(0.0, 0.0, 0.0)], []
    while len(jerks) < phases:
        s, v, a = states[-1]
        h, j = rng.uniform(0.02, 0.6), rng.choice([-1.0, 0.0, rng.uniform(-1, 1), 1.0]) * limits.jerk
        after = (s + h * v + h * h * a / 2 + h**3 * j / 6, v + h * a + h * h * j / 2, a + h * j)
        # the speed must still be able to level out within [0, speed]: a^2 / (2 jerk) more or less of it
        reserve = after[2] * abs(after[2]) / (2 * limits.jerk)
        lowest = min(after[1], v, v - a * a / (2 * j) if j > 0 > a and -a / j < h else v)
        highest = max(after[1], v, v - a * a / (2 * j) if j < 0 < a and -a / j < h else v)
        fits = -limits.deceleration <= after[2] <= limits.acceleration and lowest >= 0 and highest <= limits.speed
        if not (fits and 0 <= after[1] + reserve <= limits.speed):
            if a == 0 and v == 0:
                j = 0.0
            else:  # level out: constant acceleration 0 is always within reach
                h, j = (abs(a) / limits.jerk, -np.sign(a) * limits.jerk) if a else (h, 0.0)
            after = (s + h * v + h * h * a / 2 + h**3 * j / 6, v + h * a + h * h * j / 2, a + h * j if j else a)
            after = (after[0], min(max(after[1], 0.0), limits.speed), 0.0)
        times.append(times[-1] + h)
        states.append(after)
        jerks.append(j)
    return VelocityProfile(times, states, jerks)


@pytest.fixture(scope="session")
def wander():
    """(rng, limits, phases) -> a random motion from rest within the limits."""
    return _wander


@pytest.fixture(scope="session")
def random_limits():
    """rng -> limits of robots between a slow cart and a quick one."""
    return lambda rng: Limits(*rng.uniform((0.3, 0.2, 0.2, 0.3, 0.2), (3.0, 2.0, 2.0, 5.0, 1.5)).tolist())


@pytest.fixture(scope="session")
def bends():
    """Paths with bends: an L, an S, a clothoid turn, a long bend only, and one that wriggles."""
    quarter = np.pi / 2
    return {
        "an L": Path((0.0, 0.0, 0.0), [(5.0, 0, 0), (0.5 * quarter, 2, 2), (4.0, 0, 0)]),
        "an S": Path((0.0, 0.0, 0.0), [(3.0, 0, 0), (2.0, 0.8, 0.8), (1.0, 0, 0), (1.5, -1.5, -1.5), (6.0, 0, 0)]),
        "clothoids": Path((0.0, 0.0, 0.0), [(3.0, 0, 0), (1.0, 0, 1.5), (0.5, 1.5, 1.5), (1.0, 1.5, 0), (3.0, 0, 0)]),
        "a bend only": Path((0.0, 0.0, 0.0), [(4.0, 1.2, 1.2)]),
        "wriggles": Path((0.0, 0.0, 0.0), [(0.9, k, k) for k in (1, -2, 3, 0.5)]),
    }
