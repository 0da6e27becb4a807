"""A motion is cut where it passes from piece to piece, and says at every time where the robot is."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify.curve import curve
from coord.verify.motion import acceleration, arc_length, motion, pose, speed, time_at, travelled

pieces = st.lists(
    st.tuples(st.floats(0.05, 2.0), st.sampled_from([0.0, 0.5]), st.sampled_from([0.0, 0.5])), min_size=1, max_size=8
)


def made(build, given_pieces, departure, rest):
    length = math.fsum(piece[0] for piece in given_pieces)
    runs = [(0.4 * length, rest), (0.6 * length, 0.0)] if rest else [(length, 0.0)]
    robot = build.robot("a", (0, 0), pieces=given_pieces, departure=departure, runs=runs)
    profile = robot["profile"]
    path = curve((0.0, 0.0, 0.0), given_pieces)
    return motion(path, profile["times"], profile["states"], profile["jerks"]), profile


@settings(max_examples=60, deadline=None, derandomize=True)
@given(given_pieces=pieces, departure=st.sampled_from([0.0, 3.3]), rest=st.sampled_from([0.0, 1.0]))
def test_stretches_cover_all_times_and_keep_to_their_pieces(build, given_pieces, departure, rest):
    """No gap in time; every stretch begins and ends on its piece, to 1e-11 m, also where it stops at a joint."""
    whole, profile = made(build, given_pieces, departure, rest)
    assert whole.stretches[0].begin == whole.departure == departure
    assert whole.stretches[-1].end == whole.arrival == profile["times"][-1]
    for one, then in zip(whole.stretches, whole.stretches[1:], strict=False):
        assert one.end == then.begin
        assert then.piece >= one.piece
        assert arc_length(one, one.end) == pytest.approx(arc_length(then, then.begin), abs=1e-11)
    for stretch in whole.stretches:
        assert stretch.begin < stretch.end
        piece = whole.path.pieces[stretch.piece]
        assert arc_length(stretch, stretch.begin) >= piece.begin - 2e-11
        assert arc_length(stretch, stretch.end) <= piece.end + 2e-11


@settings(max_examples=60, deadline=None, derandomize=True)
@given(given_pieces=pieces, share=st.floats(-0.2, 1.2), rest=st.sampled_from([0.0, 1.0]))
def test_times_and_places_belong_together(build, given_pieces, share, rest):
    """A robot rests at the ends before and after; the time of an arc length leads back to it."""
    whole, _ = made(build, given_pieces, 2.0, rest)
    t = 2.0 + share * (whole.arrival - 2.0)
    s = travelled(whole, t)
    assert (s == 0.0) if share <= 0 else (s == whole.path.length) if share >= 1 else (0 <= s <= whole.path.length)
    if share <= 0:
        assert pose(whole, t) == whole.path.start
    if share >= 1:
        assert pose(whole, t) == whole.path.goal
    assert travelled(whole, time_at(whole, s, 0.0)) == pytest.approx(s, abs=1e-9)
    assert time_at(whole, s, t) == t


def test_states_between_knots_are_those_of_the_knots(build):
    """Continued with the jerk, they lead to the next knot."""
    whole, profile = made(build, [(2.0, 0.0, 0.0)], 0.0, 0.0)
    for stretch, (s, v, a) in zip(whole.stretches, profile["states"][1:], strict=True):
        assert arc_length(stretch, stretch.end) == pytest.approx(s, abs=1e-12)
        assert speed(stretch, stretch.end) == pytest.approx(v, abs=1e-12)
        assert acceleration(stretch, stretch.end) == pytest.approx(a, abs=1e-12)
