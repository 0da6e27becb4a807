"""Given polylines: kept, with every corner rounded as far as its edges allow."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.errors import InvalidValueError
from coord.model.path import straight
from coord.paths.given import given


def radii(path):
    return [1 / abs(k) for _, k, _ in path.pieces.tolist() if k]


def test_without_corners_it_is_the_straight_line():
    """Two points, collinear points between them, and repeated points make the same path."""
    line = straight((1.0, 1.0), (4.0, 5.0))
    for points in ([], [(1.0, 1.0), (4.0, 5.0)], [(1.0, 1.0), (2.5, 3.0), (2.5, 3.0), (3.25, 4.0), (4.0, 5.0)]):
        path = given(points, 0.2, (1.0, 1.0), (4.0, 5.0))
        assert path.start == line.start
        assert path.pieces.tolist() == line.pieces.tolist()


def test_a_right_angle_is_cut_by_a_quarter_circle():
    """The fillet takes r from each edge and gives r pi/2 back."""
    path = given([(0.0, 0.0), (5.0, 0.0), (5.0, 5.0)], 0.5, (0.0, 0.0), (5.0, 5.0))
    assert radii(path) == [0.5]
    assert path.length == pytest.approx(10.0 - 1.0 + 0.25 * math.pi, abs=1e-12)
    assert path.end == pytest.approx((5.0, 5.0), abs=1e-12)
    arc = path.point(np.linspace(4.5, 4.5 + 0.25 * math.pi, 50))
    assert np.hypot(arc[:, 0] - 4.5, arc[:, 1] - 0.5) == pytest.approx(0.5)


def test_two_corners_share_their_edge():
    """With 0.3 m between two right angles each may take 0.15 m of it, whatever radius was asked for."""
    points = [(0.0, 0.0), (5.0, 0.0), (5.0, 0.3), (9.0, 0.3)]
    path = given(points, 1.0, points[0], points[-1])
    assert radii(path) == pytest.approx([0.15, 0.15])
    assert path.end == pytest.approx(points[-1], abs=1e-12)


def test_a_radius_of_zero_is_one_centimetre_and_less_only_where_it_must():
    """No corner is left: 1 cm, unless the edge is shorter than a fillet of 1 cm needs."""
    path = given([(0.0, 0.0), (5.0, 0.0), (5.0, 5.0), (5.001, 5.0), (5.001, 8.0)], 0.0, (0.0, 0.0), (5.001, 8.0))
    assert radii(path) == pytest.approx([0.01, 0.0005, 0.0005])


@pytest.mark.parametrize("seed", range(30))
def test_the_path_ends_in_the_goal_and_stays_within_a_radius_of_the_polyline(seed):
    """Random polylines with 2 to 12 points: the end is exact to 1e-9 m, no place farther off than corners are cut."""
    rng = np.random.default_rng(seed)
    points = [tuple(point) for point in rng.uniform(0, 20, (rng.integers(2, 13), 2)).tolist()]
    path = given(points, 0.4, points[0], points[-1])
    assert math.dist(path.end, points[-1]) < 1e-9
    assert np.all(path.pieces[:, 0] > 0)
    places = path.point(np.linspace(0, path.length, 2000))
    a, b = np.array(points[:-1]), np.array(points[1:])
    share = ((places[:, None] - a) * (b - a)).sum(axis=2) / ((b - a) ** 2).sum(axis=1)
    foot = a + np.clip(share, 0, 1)[..., None] * (b - a)
    # an arc of radius 0.4 m cannot be farther from both of its tangents than its radius
    assert np.hypot(*(places[:, None] - foot).transpose(2, 0, 1)).min(axis=1).max() <= 0.4


def test_mirrored_points_give_the_mirrored_path():
    """Left turns become right turns of the same length."""
    points = [(0.0, 0.0), (4.0, 1.0), (5.0, 4.0), (9.0, 3.0)]
    one = given(points, 0.3, points[0], points[-1])
    other = given([(x, -y) for x, y in points], 0.3, points[0], (9.0, -3.0))
    assert other.pieces == pytest.approx(one.pieces * [1, -1, -1])


def test_a_corner_that_goes_straight_back_is_an_error_that_names_the_points():
    """There is no arc tangent to both edges."""
    with pytest.raises(InvalidValueError, match=r"straight back .* \(1, 0\), \(5, 0\), \(2, 0\) m"):
        given([(1.0, 0.0), (5.0, 0.0), (2.0, 0.0)], 0.2, (1.0, 0.0), (2.0, 0.0))


def test_a_path_that_goes_nowhere_has_no_pieces():
    """Start, goal and every point between are the same place."""
    assert len(given([(1.0, 2.0)] * 3, 0.2, (1.0, 2.0), (1.0, 2.0)).pieces) == 0
