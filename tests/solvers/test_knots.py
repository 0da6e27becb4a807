"""Which bounds a motion's program needs: as no robot moves backwards, the others follow."""

from __future__ import annotations

import numpy as np

from coord.solvers.knots import Cells, bounded, knots

N = 12


def told(upper, lower, *, are_moving=False):
    """For each bound that is kept whether it is an upper one, its cell, and its Bezier point."""
    cells = Cells(np.full(N, 0.5), np.asarray(upper, float), np.asarray(lower, float), np.ones(N))
    kept = bounded(knots(N), cells, are_moving=are_moving)
    return {(one.is_upper, int(k), one.point) for one in kept for k in one.cells}


def nowhere():
    return np.full((N, 4), np.inf), np.full((N, 4), -np.inf)


def test_of_an_upper_bound_that_stays_the_last_point_is_enough():
    """Below 2 m up to the end of the fifth cell; a lower bound at the start says nothing."""
    upper, lower = nowhere()
    upper[:5] = 2.0
    lower[3:] = 0.0
    assert told(upper, lower) == {(True, 4, 3)}


def test_of_a_lower_bound_that_stays_the_first_point_is_enough():
    """Above 2 m from the beginning of the fifth cell on, which is the end of the fourth."""
    upper, lower = nowhere()
    lower[4:] = 2.0
    assert told(upper, lower) == {(False, 3, 3)}


def test_bounds_that_rise_are_kept_everywhere():
    """Each point of a rising upper bound is below all later ones, and none follows from another."""
    upper, lower = nowhere()
    upper[2:6] = np.linspace(1.0, 3.0, 4)[:, None] + np.linspace(0.0, 0.6, 4)[None]
    points = {(True, k, point) for k in range(2, 6) for point in (1, 2, 3)}
    assert told(upper, lower) == points | {(True, 1, 3)}


def test_where_knots_move_bounds_are_kept_at_all_of_them():
    """Taken as linear, a motion in cells that shrink may go backwards between them."""
    upper, lower = nowhere()
    upper[:5] = 2.0
    assert told(upper, lower, are_moving=True) == {(True, k, 3) for k in range(5)}


def test_a_window_left_out_of_a_cell_after_another_one_binds_at_the_knot_between():
    """Where the next cell's bound is the lower one, it is the one that counts at the knot."""
    upper, lower = nowhere()
    upper[3], upper[4] = 5.0, 1.0
    assert told(upper, lower) == {(True, 4, 3)}
