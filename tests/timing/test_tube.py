"""Windows as bounds on s over time, and those bounds on a grid of cells."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.window import Window
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest
from coord.timing.clear import excess
from coord.timing.tube import Tube, after_bound, before_bound, lower_on_cells, off_chords, upper_on_cells


def random_window(rng):
    n = int(rng.integers(1, 9))
    times = 2.0 + np.cumsum(rng.uniform(0.1, 1.5, n + 1))
    low = rng.uniform(1, 6, (n, 2))
    return Window(0, times, low, low + rng.uniform(0.2, 3, (n, 2)))


def on_line(bound, t):
    """Values at times inside the pieces of a bound."""
    k = np.clip(np.searchsorted(bound.times, t, side="right") - 1, 0, len(bound.values) - 1)
    share = (t - bound.times[k]) / (bound.times[k + 1] - bound.times[k])
    return bound.values[k, 0] + (bound.values[k, 1] - bound.values[k, 0]) * share


def test_bounds_never_decrease():
    """Because speed is never negative, only what holds for the rest of the window (since its beginning) counts."""
    rng = np.random.default_rng(1)
    for _ in range(100):
        window = random_window(rng)
        for bound in (after_bound(window), before_bound(window)):
            assert np.all(np.diff(bound.values.ravel()) >= -1e-12)


def test_a_motion_is_after_a_window_exactly_if_it_keeps_the_upper_bound():
    """And before it exactly if it keeps the lower one: 300 windows and motions at different times and speeds."""
    rng = np.random.default_rng(2)
    kept = 0
    for _ in range(300):
        window = random_window(rng)
        limits = Limits(*rng.uniform((0.5, 0.3, 0.3, 0.5, 0.3), (2, 1, 1, 3, 1)).tolist())
        profile = rest_to_rest(10.0, limits).shifted(rng.uniform(-6, 10))
        t = np.linspace(window.times[0], window.times[-1], 3000)[1:-1]
        s, gap = profile.state(t)[:, 0], excess(profile, window)
        over, under = (s - on_line(after_bound(window), t)).max(), (on_line(before_bound(window), t) - s).max()
        for by_bound, by_window in ((over, gap.over_low), (under, gap.under_high)):
            if abs(by_bound) > 1e-3:
                assert (by_bound < 0) == (by_window < 1e-9)
                kept += by_bound < 0
    assert kept > 50


def grid(rng, window):
    """Cells that do not reach across the ends of the window, some finer and some coarser than its strips."""
    inner = rng.uniform(window.times[0], window.times[-1], rng.integers(1, 8))
    before, behind = rng.uniform(0, window.times[0], 3), rng.uniform(window.times[-1], window.times[-1] + 5, 3)
    return np.unique(np.concatenate([[0.0], before, window.times[[0, -1]], inner, behind]))


def test_bezier_points_within_the_cells_bounds_keep_the_curve_within_the_tube():
    """Random cubics with Bezier points at the cells' bounds never cross the tube between the knots."""
    rng = np.random.default_rng(3)
    u = np.linspace(0, 1, 200)
    bernstein = np.stack([(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u**2 * (1 - u), u**3])
    for _ in range(200):
        window = random_window(rng)
        times = grid(rng, window)
        upper, lower = upper_on_cells(after_bound(window), times, 0.0), lower_on_cells(before_bound(window), times, 0.0)
        for k in range(len(times) - 1):
            t = times[k] + (times[k + 1] - times[k]) * u
            inside = (t > window.times[0]) & (t < window.times[-1])
            if np.all(np.isfinite(upper[k])):
                curve = upper[k] @ bernstein
                first = np.where(t <= window.times[0], after_bound(window).values[0, 0], np.inf)
                assert np.all(curve <= first + 1e-9)
                assert np.all(curve[inside] <= on_line(after_bound(window), t[inside]) + 1e-9)
            else:
                assert not inside.any()
            if np.all(np.isfinite(lower[k])):
                curve = lower[k] @ bernstein
                last = np.where(t >= window.times[-1], before_bound(window).values[-1, 1], -np.inf)
                assert np.all(curve >= last - 1e-9)
                assert np.all(curve[inside] >= on_line(before_bound(window), t[inside]) - 1e-9)
            else:
                assert not inside.any()


def test_on_fine_cells_the_bounds_are_hardly_narrower_than_the_tube():
    """With 400 cells in a smooth window all four Bezier bounds lie within 1 mm of the tube."""
    t = np.linspace(3.0, 5.0, 41)
    low = 5 - np.sqrt(np.maximum(1 - (t - 4) ** 2, 0))
    window = Window(0, t, np.stack([low[:-1], low[1:]], axis=1), np.stack([low[:-1], low[1:]], axis=1) + 3)
    bound, times = after_bound(window), np.linspace(3.0, 5.0, 401)
    upper = upper_on_cells(bound, times, 0.0)
    at = times[:-1, None] + np.diff(times)[:, None] * np.arange(4) / 3
    exact = on_line(bound, np.minimum(at.ravel(), 5.0 - 1e-12)).reshape(-1, 4)
    assert np.all(upper <= exact + 1e-9)
    # but at the jump where the tube begins to rise
    assert np.median(exact - upper) < 1e-3
    assert (exact - upper)[:-1].max() < 0.05


def test_the_margin_is_taken_from_both_sides():
    """All bounds move inwards by the margin."""
    rng = np.random.default_rng(4)
    window = random_window(rng)
    times = grid(rng, window)
    for on_cells, bound, sign in ((upper_on_cells, after_bound(window), 1), (lower_on_cells, before_bound(window), -1)):
        plain, inset = on_cells(bound, times, 0.0), on_cells(bound, times, 0.01)
        finite = np.isfinite(plain)
        assert np.allclose(sign * (plain[finite] - inset[finite]), 0.01, atol=1e-12)


def test_a_bound_is_off_its_chord_by_the_height_of_its_kink():
    """Flat for 1 s, then 2 m in 1 s: in a cell of both the middle is 1 m below the chord, in cells of one piece none."""
    values = np.array([[1.0, 1.0], [1.0, 3.0]])
    after, before = (
        Window(0, np.array([5.0, 6.0, 7.0]), values, values + 1),
        Window(0, np.array([5.0, 6.0, 7.0]), -values[::-1], 4 - values[::-1, ::-1]),
    )
    upper, lower = Tube([after_bound(after)], []), Tube([], [before_bound(before)])
    for tube in (upper, lower):
        assert off_chords(tube, np.array([0.0, 5.0, 7.0, 9.0])) == pytest.approx([0.0, 1.0, 0.0])
        assert off_chords(tube, np.array([0.0, 5.0, 6.0, 7.0, 9.0])) == pytest.approx([0.0] * 4)
