"""Speed caps in bends."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.alone.speed_limit import cap, speed_limit
from coord.model.path import Path, straight
from coord.model.robot import Limits

LIMITS = Limits(2.0, 0.5, 0.5, 1.0, 0.5)


def test_the_cap_is_the_root_of_lateral_acceleration_times_radius():
    """sqrt(0.5 x 2) = 1 m/s at 2 m radius, either side; the robot's own speed from 8 m on."""
    assert cap(0.5, LIMITS) == cap(-0.5, LIMITS) == pytest.approx(1.0)
    assert cap(1 / 8, LIMITS) == cap(0.0, LIMITS) == 2.0
    assert cap(1 / 7.9, LIMITS) == pytest.approx(math.sqrt(0.5 * 7.9))


def test_a_straight_path_has_one_section():
    """With the robot's speed as its cap; so has a path whose bends are wide enough."""
    for path in (straight((0, 0), (3, 4)), Path((0, 0, 0), [(3.0, 0, 0), (1.0, 0.1, -0.1), (2.0, 0, 0)])):
        limit = speed_limit(path, LIMITS)
        assert limit.is_constant
        assert limit.caps.tolist() == [2.0]
        assert limit.ends.tolist() == [path.length]


def test_caps_are_safe_everywhere_and_not_much_lower_than_they_may_be(bends):
    """At 5,000 places the section's cap keeps the lateral acceleration; on lines and arcs it is the exact cap."""
    for path in bends.values():
        limit = speed_limit(path, LIMITS)
        s = np.linspace(0.0, path.length, 5000)[1:-1]
        caps = limit.caps[np.searchsorted(limit.ends, s, side="left")]
        bend = np.abs(path.curvature(s))
        exact = np.minimum(LIMITS.speed, np.sqrt(LIMITS.lateral_acceleration / np.maximum(bend, 1e-12)))
        at_jump = np.isclose(s[:, None], path.breaks[None], atol=1e-9).any(axis=1)
        assert np.all(caps[~at_jump] <= exact[~at_jump] * (1 + 1e-12))
        assert np.all(caps >= 0.65 * exact)
        piece = np.searchsorted(path.breaks, s, side="right") - 1
        constant = (path.pieces[:, 1] == path.pieces[:, 2])[piece] & ~at_jump
        assert caps[constant] == pytest.approx(exact[constant])


@pytest.mark.parametrize("ratio", [1.1, 1.3])
def test_within_a_cut_of_a_clothoid_the_cap_falls_short_by_no_more_than_the_factor(ratio):
    """From a line into a bend at 1 /m and back: at 5,000 places the cap is at least the exact one over the factor."""
    path = Path((0.0, 0.0, 0.0), [(1.0, 0, 0), (1.0, 0, 1.0), (1.0, 1.0, 0), (1.0, 0, 0)])
    limit = speed_limit(path, LIMITS, cap_ratio=ratio)
    s = np.linspace(0.0, path.length, 5000)[1:-1]
    caps = limit.caps[np.searchsorted(limit.ends, s, side="left")]
    exact = np.minimum(2.0, np.sqrt(0.5 / np.maximum(np.abs(path.curvature(s)), 1e-12)))
    assert np.all(caps * ratio >= exact * (1 - 1e-9))


def test_the_lowest_cap_of_an_interval_counts_its_ends():
    """An interval that touches a section counts it, one that lies in a section has that section's cap."""
    path = Path((0, 0, 0), [(3.0, 0, 0), (1.0, 0.5, 0.5), (2.0, 0, 0)])
    limit = speed_limit(path, LIMITS)
    first, last = np.array([0.0, 0.0, 3.5, 4.0, 4.1, 0.0]), np.array([2.9, 3.0, 3.6, 5.0, 6.0, 6.0])
    assert limit.lowest(first, last).tolist() == pytest.approx([2.0, 1.0, 1.0, 1.0, 2.0, 1.0])
