"""Paths: lines, arcs and clothoids by arc length."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.model.path import Path, straight

lengths = st.floats(1e-3, 20.0)
angles = st.floats(-math.pi, math.pi)
coordinates = st.floats(-1e3, 1e3)


@st.composite
def pieces(draw, most=4):
    """Lines, arcs that turn by up to 1 rad, and clothoids whose curvature changes by up to 1/2 over their length."""
    rows = []
    for _ in range(draw(st.integers(1, most))):
        length = draw(lengths)
        kind = draw(st.sampled_from(["line", "arc", "clothoid"]))
        k0, k1 = draw(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)))
        bends = {"line": (0.0, 0.0), "arc": (k0, k0), "clothoid": (k0, k0 + k1 / 2)}
        rows.append((length, *(k / length for k in bends[kind])))
    return rows


def integrated(start, rows, panels=40):
    """End pose by composite Gauss-Legendre quadrature with ten nodes a panel, summed without rounding."""
    nodes, weights = np.polynomial.legendre.leggauss(10)
    x, y, heading = start
    for length, k0, k1 in rows:
        h = length / panels
        u = ((np.arange(panels)[:, None] + (nodes + 1) / 2) * h).ravel()
        angle = heading + k0 * u + (k1 - k0) * u * u / (2 * length)
        x += math.fsum((np.cos(angle) * np.tile(weights, panels) * h / 2).tolist())
        y += math.fsum((np.sin(angle) * np.tile(weights, panels) * h / 2).tolist())
        heading += (k0 + k1) / 2 * length
    return x, y, heading


@settings(deadline=None, derandomize=True, max_examples=100)
@given(angles, pieces())
def test_the_pose_is_the_integral_of_the_heading(heading, rows):
    """Quadrature with many panels gives the same end of lines, arcs and clothoids within 2e-10 m."""
    path = Path((1.0, -2.0, heading), rows)
    assert path.pose(path.length)[0] == pytest.approx(integrated((1.0, -2.0, heading), rows), abs=2e-10)


def test_a_clothoid_that_turns_by_a_quarter_of_a_radian_is_good_to_a_ten_thousandth_of_a_nanometre():
    """From curvature 0 to 1/2 over 1 m, at any heading, the end is right within 1e-13 m."""
    for heading in np.linspace(0.0, 6.0, 13):
        got = Path((0.0, 0.0, heading), [(1.0, 0.0, 0.5)]).poses[-1]
        assert got == pytest.approx(integrated((0.0, 0.0, heading), [(1.0, 0.0, 0.5)]), abs=1e-13)


def test_a_clothoid_that_turns_by_a_radian_is_as_good_as_promised():
    """From curvature 0 to 2 over 1 m the end is right within 2e-12 m."""
    got = Path((0.0, 0.0, 1.0), [(1.0, 0.0, 2.0)]).poses[-1]
    assert got == pytest.approx(integrated((0.0, 0.0, 1.0), [(1.0, 0.0, 2.0)]), abs=2e-12)


@settings(deadline=None, derandomize=True, max_examples=100)
@given(angles, pieces(), st.floats(0.0, 1.0))
def test_a_place_inside_is_the_end_of_the_path_cut_there(heading, rows, share):
    """Any point of a piece is where the piece would end had it been cut at that arc length."""
    path = Path((0.0, 0.0, heading), rows)
    s, cut, left = share * path.length, [], share * path.length
    for length, k0, k1 in rows:
        part = min(left, length)
        cut.append((part, k0, k0 + (k1 - k0) * part / length))
        left -= part
        if left <= 0:
            break
    cut = [row for row in cut if row[0] > 0]
    assert path.pose(s)[0] == pytest.approx(integrated((0.0, 0.0, heading), cut), abs=2e-10)


def test_a_quarter_circle_ends_where_the_circle_says():
    """Left with radius 2 from the origin along x: centre (0, 2), end (2, 2), heading pi/2; right is its mirror image."""
    for side in (1, -1):
        path = Path((0.0, 0.0, 0.0), [(math.pi, side / 2, side / 2)])
        assert path.end == pytest.approx((2.0, 2.0 * side), abs=1e-15)
        assert path.pose([math.pi / 2])[0] == pytest.approx(
            (2 * math.sin(math.pi / 4), side * (2 - 2 * math.cos(math.pi / 4)), side * math.pi / 4), abs=1e-15
        )


def test_arcs_of_vanishing_curvature_become_lines_without_a_step():
    """The end of an arc tends to that of the line as the curvature goes to 0, down to the smallest numbers."""
    for k in (1e-6, 1e-9, 1e-12, 1e-200, 5e-324):
        x, y = Path((0.0, 0.0, 0.0), [(10.0, k, k)]).end
        assert x == pytest.approx(10.0, abs=1e3 * k * k + 1e-14)
        assert y == pytest.approx(50.0 * k, rel=1e-9, abs=1e-300)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(angles, pieces(), coordinates, coordinates, angles)
def test_moving_and_turning_the_start_moves_and_turns_the_path(heading, rows, dx, dy, turn):
    """Points of the moved path are the moved points; curvatures do not change."""
    path, moved = Path((0.0, 0.0, heading), rows), Path((dx, dy, heading + turn), rows)
    s = np.linspace(0.0, path.length, 17)
    c, sn = math.cos(turn), math.sin(turn)
    x, y = path.point(s).T
    expected = np.stack([dx + c * x - sn * y, dy + sn * x + c * y], axis=1)
    assert np.abs(moved.point(s) - expected).max() < 1e-9
    assert np.abs(moved.pose(s)[:, 2] - path.pose(s)[:, 2] - turn).max() < 1e-12
    assert np.array_equal(moved.curvature(s), path.curvature(s))


@settings(deadline=None, derandomize=True, max_examples=60)
@given(angles, pieces())
def test_points_are_no_farther_apart_than_their_arc_lengths(heading, rows):
    """Arc length is the parameter: chords are at most as long, and short ones nearly so; nothing jumps at the breaks."""
    path = Path((0.0, 0.0, heading), rows)
    s = np.linspace(0.0, path.length, 400)
    chord = np.hypot(*np.diff(path.point(s), axis=0).T)
    step = s[1] - s[0]
    bend = np.abs(path.pieces[:, 1:]).max()
    assert np.all(chord <= step + 1e-11)
    assert np.all(chord >= step * (1 - (bend * step) ** 2 / 24) - 1e-11)


def test_the_curvature_at_a_jump_is_that_of_the_piece_that_begins():
    """At the end of the path it is that of the last piece."""
    path = Path((0.0, 0.0, 0.0), [(1.0, 0.0, 0.0), (1.0, 0.5, 1.0), (1.0, -1.0, -1.0)])
    assert path.curvature([0.0, 1.0, 1.5, 2.0, 3.0]).tolist() == [0.0, 0.5, 0.75, -1.0, -1.0]


def test_beyond_its_ends_a_path_stands_still():
    """Arc lengths below 0 give the start, those above the length the end."""
    path = Path((1.0, 2.0, 0.3), [(1.0, 0.5, 0.5)])
    assert path.pose(-1.0)[0].tolist() == [1.0, 2.0, 0.3]
    assert path.pose(9.0)[0].tolist() == path.poses[-1].tolist()


def test_a_straight_path_ends_at_its_goal():
    """Its length is the distance, and it is known to be straight; no length, no pieces."""
    path = straight((1.0, 2.0), (4.0, 6.0))
    assert (path.length, path.pieces.tolist()) == (5.0, [[5.0, 0.0, 0.0]])
    assert path.end == pytest.approx((4.0, 6.0), abs=1e-15)
    nowhere = straight((1.0, 2.0), (1.0, 2.0))
    assert (nowhere.length, len(nowhere.pieces), nowhere.end) == (0.0, 0, (1.0, 2.0))
    assert nowhere.pose([0.0, 1.0]).tolist() == [[1.0, 2.0, 0.0]] * 2
    assert nowhere.curvature([0.0]).tolist() == [0.0]


def test_paths_cannot_be_changed():
    """Neither their arrays nor their fields; and the array they were made from stays the caller's own."""
    mine = np.array([(1.0, 0.0, 0.0)])
    path = Path((0.0, 0.0, 0.0), mine)
    mine[0, 0] = 7.0
    assert path.length == 1.0
    for array in (path.pieces, path.breaks, path.poses):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0
    with pytest.raises(AttributeError):
        path.start = (1.0, 1.0, 1.0)


def test_a_path_survives_pickling():
    """All its numbers are the same to the last bit, and it is still read-only."""
    path = Path((1.0, 2.0, 0.3), [(1.0, 0.1, 0.5), (2.0, 0.0, 0.0), (0.1, -3.0, -3.0)])
    copy = pickle.loads(pickle.dumps(path))  # noqa: S301
    assert copy.start == path.start
    for name in ("pieces", "breaks", "poses"):
        assert getattr(copy, name).tobytes() == getattr(path, name).tobytes()
        assert not getattr(copy, name).flags.writeable
