"""The feet of an exponential detour."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coord.paths.feet import Foot, fitting


def _exponential(rate, x=0.0):
    """The foot of y = exp(rate x), cut at x, with a length of 1/rate."""
    y = float(np.exp(rate * x))
    return Foot(x, y, rate * y, rate**2 * y, 1 / rate)


@given(rate=st.floats(0.1, 10), length=st.floats(0.5, 6), at_angle=st.booleans())
def test_a_foot_goes_on_with_height_slope_and_bend_of_the_flank_and_ends_straight_on_the_line(rate, length, at_angle):
    """Both polynomials match the exponential at its cut to the second derivative, and end with y = y'' = 0."""
    foot = _exponential(rate)._replace(length=length / rate, at_angle=at_angle)
    top, end = foot.below(np.array([0.0, -foot.length])).T
    assert top == pytest.approx([foot.y, foot.slope, foot.second], rel=1e-9)
    assert end[[0, 2]] == pytest.approx([0, 0], abs=1e-9 * rate**2)


@given(rate=st.floats(0.1, 10), length=st.floats(0.5, 6))
def test_a_foot_meets_the_line_along_it_or_at_an_angle(rate, length):
    """The quintic ends flat; the quartic ends with a positive slope, for every length."""
    foot = _exponential(rate)._replace(length=length / rate)
    assert foot.below(np.array([-foot.length]))[1, 0] == pytest.approx(0, abs=1e-9 * rate)
    assert foot._replace(at_angle=True).below(np.array([-foot.length]))[1, 0] > 0


@given(rate=st.floats(0.1, 10), room=st.floats(0.1, 30))
def test_a_foot_at_an_angle_ends_where_the_room_does(rate, room):
    """It goes all the way to the end, whatever the cut; where even the highest cut is beyond, there is none."""
    middle = 5.0
    foot = fitting(lambda share: _exponential(rate, np.log(share) / rate + middle), middle, room, at_angle=True)
    if foot is None:
        assert np.log(1 / 0.4) / rate >= room
    else:
        assert middle - (foot.x - foot.length) == pytest.approx(room)


def test_a_foot_along_the_line_stays_within_its_room_or_there_is_none():
    """The lowest cut is taken where there is room, a higher one where there is less, none where there is too little."""

    def cut_at(share):
        return _exponential(1.0, float(np.log(share)))

    wide, narrow, none = (fitting(cut_at, 0.0, room, at_angle=False) for room in (10.0, 4.0, 2.0))
    assert wide.y == pytest.approx(0.02)
    assert narrow.y > wide.y
    assert narrow.length - narrow.x <= 4
    assert none is None
