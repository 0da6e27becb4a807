"""Is a profile clear of a window? Exact, against dense sampling."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.window import Window
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest
from coord.timing.clear import excess

PROFILE = rest_to_rest(10.0, Limits(1.0, 0.5, 0.7, 1.0, 0.5)).shifted(2.0)


def random_window(rng, lasts):
    """A chain of strips whose bounds jump and lean at random."""
    n = int(rng.integers(1, 9))
    times = np.cumsum(rng.uniform(0.1, 2.0, n + 1)) + rng.uniform(-2, 8)
    low = rng.uniform(-1, 9, (n, 2))
    high = low + rng.uniform(0.2, 4, (n, 2))
    if lasts:
        times[-1], low[-1, 1], high[-1, 1] = np.inf, low[-1, 0], high[-1, 0]
    return Window(0, np.maximum.accumulate(np.maximum(times, np.arange(n + 1) * 1e-3)), low, high)


def sampled(profile, window, count=4000):
    """How far s reaches above low and below high, at worst, at times inside the strips."""
    over, under = -np.inf, -np.inf
    for k, ((low0, low1), (high0, high1)) in enumerate(zip(window.low, window.high, strict=True)):
        first, last = window.times[k], window.times[k + 1]
        last = max(profile.arrival, first) + 1 if np.isinf(last) else last
        share = np.linspace(0, 1, count)
        s = profile.state(first + (last - first) * share)[:, 0]
        over = max(over, (s - low0 - (low1 - low0) * share).max())
        under = max(under, (high0 + (high1 - high0) * share - s).max())
    return over, under


def test_the_excess_over_a_window_is_that_of_dense_sampling():
    """For 300 random windows, a tenth of which never end: never less, and hardly more."""
    rng = np.random.default_rng(1)
    for k in range(300):
        window = random_window(rng, lasts=k % 10 == 0)
        gap = excess(PROFILE, window)
        over, under = sampled(PROFILE, window)
        assert over - 1e-9 <= gap.over_low <= over + 1e-5
        assert under - 1e-9 <= gap.under_high <= under + 1e-5
        assert gap.is_clear == (min(gap.over_low, gap.under_high) <= 1e-9)
        assert gap.passes_after == (gap.over_low <= (1e-9 if gap.is_clear else gap.under_high))


def test_the_time_of_a_collision_is_within_the_window():
    """Where the profile is inside a window, the first such stretch begins when the window is there and it is inside soon after."""
    rng = np.random.default_rng(2)
    seen = 0
    for _ in range(300):
        window = random_window(rng, lasts=False)
        gap = excess(PROFILE, window)
        if np.isfinite(gap.time):
            seen += 1
            assert window.times[0] <= gap.time <= window.times[-1]
        else:
            inside = [
                (low < s) & (s < high)
                for (low, _), (high, _), s in zip(
                    window.low, window.high, PROFILE.state(window.times[:-1])[:, 0], strict=True
                )
            ]
            assert not any(inside)
    assert seen > 50


def test_a_robot_that_never_moves_is_above_below_or_inside():
    """A single knot at 0: inside a window about 0, after one that begins at 0, before one that ends there."""
    still = VelocityProfile([3.0], [(0.0, 0.0, 0.0)], [])
    for low, high, after, clear in ((-1, 1, False, False), (0, 1, True, True), (-1, 0, False, True)):
        gap = excess(still, Window(0, np.array([1.0, 9.0]), np.array([[low, low]]), np.array([[high, high]])))
        assert (gap.passes_after, gap.is_clear) == (after, clear)


def test_a_peak_between_knots_is_seen():
    """A line through both ends of a phase is crossed in between: found to the last digit, though the knots are clear."""
    profile = VelocityProfile([0.0, 2.0], [(0.0, 0.0, 1.0), (2.0, 2.0, 1.0)], [0.0])
    bound = Window(0, np.array([0.0, 2.0]), np.array([[5.0, 5.0]]), np.array([[0.0, 2.0]]))
    # the line t lies above t^2 / 2 by at most 1/2, at t = 1
    assert excess(profile, bound).under_high == pytest.approx(0.5, abs=1e-12)
