"""Curves as pieces of linear curvature."""

import itertools

import numpy as np
import pytest

from coord.model.arrays import frozen
from coord.model.path import Path
from coord.paths.refit import refit


def _sine(x):
    """Half a wave over [0, 4], which meets the line at an angle, straight."""
    a = np.pi / 4
    return np.sin(a * x), a * np.cos(a * x), -(a**2) * np.sin(a * x)


@pytest.mark.parametrize("fixed", list(itertools.product((False, True), repeat=2)))
def test_the_pieces_of_an_arch_end_on_the_line_with_its_heading_and_where_they_are_fixed(fixed):
    """From a start at an angle the pieces come down to y = 0 with the heading of the curve, about where it ends.

    Fixed ends are met to 1e-12 m; free ones move by as much as the pieces are longer than the curve.
    """
    found = refit(_sine, 0.0, 4.0, fixed)
    path = Path((found.begin, 0.0, found.heading), frozen(found.pieces, 3))
    assert found.heading == pytest.approx(np.arctan(np.pi / 4))
    assert path.end == pytest.approx((found.end, 0), abs=1e-11)
    assert path.poses[-1, 2] == pytest.approx(-np.arctan(np.pi / 4), abs=1e-11)
    assert (found.begin, found.end) == pytest.approx((0, 4), abs=5e-3)
    if fixed[0]:
        assert found.begin == 0
    if fixed[1]:
        assert found.end == pytest.approx(4, abs=1e-12)


def test_the_pieces_follow_the_curve():
    """Places along the pieces are within millimetres of an arch two metres high and wide."""
    found = refit(_sine, 0.0, 4.0, (True, True))
    assert found.places[:, 1] == pytest.approx(_sine(found.places[:, 0])[0], abs=3e-3)
