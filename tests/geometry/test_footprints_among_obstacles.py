"""Convex footprints that keep their heading, and how they stand to obstacles and to each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from coord.geometry.shapes import meeting, nearer, placed, polygons_too_near, separation
from coord.model.obstacle import Circle, Polygon

SQUARE = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))
POINT = ((0.0, 0.0),)

COORDINATE = st.integers(-40, 40).map(lambda n: n / 10)
PLACE = st.tuples(COORDINATE, COORDINATE)


@st.composite
def ring(draw):
    """A convex polygon that holds the origin, corners on an ellipse."""
    count, turn = draw(st.integers(3, 8)), draw(st.floats(0, 6))
    x, y = draw(st.floats(0.2, 2)), draw(st.floats(0.2, 2))
    angles = [turn + 2 * math.pi * k / count for k in range(count)]
    return tuple((x * math.cos(angle), y * math.sin(angle)) for angle in angles)


@given(ring(), ring(), PLACE)
def test_the_separation_is_what_moving_the_one_confirms(one, other, place):
    """Apart: shapely's distance. Overlapping: by that much in no direction less, in the best direction just touching."""
    first, second = placed(np.array([(0.0, 0.0), place]), [one, other])
    found = separation(first, second)
    assert found == pytest.approx(separation(second, first), abs=1e-9)
    if found > 0:
        assert found == pytest.approx(shapely.distance(first, second))
        return
    angles = np.linspace(0, 2 * math.pi, 721)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    reach = (np.array(one) @ normals.T).max(axis=0) + (-(np.array(other) + place) @ normals.T).max(axis=0)
    assert -found <= reach.min() + 1e-9
    assert -found >= reach.min() - 0.02


def test_points_have_a_separation_too():
    """A disc's core is a point: its distance from a square, how deep it lies in it, 0 from itself."""
    points = placed(np.array([(0.0, 0.0), (0.0, 0.0), (2.0, 0.0), (0.3, 0.1)]), [SQUARE, POINT, POINT, POINT])
    assert separation(points[0], points[2]) == pytest.approx(1.5)
    assert separation(points[3], points[0]) == pytest.approx(-0.2)
    assert separation(points[1], points[1]) == 0.0


def test_touching_is_not_nearer_than_nothing_but_overlapping_is():
    """With no distance needed, two squares side by side are fine; a micrometre of overlap is not."""
    places = np.array([(0.0, 0.0), (1.0, 0.3), (1.0 - 1e-6, 0.3), (1.1, 0.0)])
    shapes = placed(places, [SQUARE] * 4)
    first = np.array([shapes[0]] * 3)
    assert nearer(first, shapes[1:], np.zeros(3)).tolist() == [False, True, False]
    assert nearer(first, shapes[1:], np.full(3, 0.1)).tolist() == [True, True, False]
    assert nearer(first, shapes[1:], np.full(3, 0.1001)).tolist() == [True, True, True]


CONCAVE = [(0, 0), (4, 0), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3)]


@given(ring(), PLACE)
def test_a_footprint_meets_a_shape_where_its_reference_point_lies_in_the_sum(shape, place):
    """Also for concave shapes with holes: meeting is membership in the Minkowski sum with the mirrored footprint."""
    floor = shapely.Polygon(CONCAVE).union(
        shapely.Polygon([(-4, -4), (-1, -4), (-1, -1), (-4, -1)]).difference(
            shapely.Polygon([(-3.5, -3.5), (-1.5, -3.5), (-1.5, -1.5), (-3.5, -1.5)])
        )
    )
    for part in shapely.get_parts(floor):
        where = meeting(part, shape)
        (body,) = placed(np.array([place]), [shape])
        margin = shapely.distance(shapely.boundary(where), shapely.Point(place))
        if margin > 1e-9:
            assert shapely.covers(where, shapely.Point(place)) == shapely.intersects(part, body)


def test_a_square_near_a_wall_in_it_and_round_a_column_is_measured_exactly():
    """Distance to the side, depth to the nearest way out, the column's radius taken off."""
    wall = Polygon("wall", np.array([(0, 0), (4, 0), (4, 2), (0, 2)]))
    column = Circle("column", (10.0, 0.0), 1.0)
    points = np.array([(-0.7, 1.0), (0.2, 1.0), (8.4, 0.0), (8.1, 0.0), (10.2, 0.0), (-5.0, 0.0), (4.6, 2.6)])
    who, what, signed = polygons_too_near([wall, column], points, [SQUARE] * len(points), 0.3)
    assert who.tolist() == [0, 1, 6, 2, 4]
    assert what.tolist() == [0, 0, 0, 1, 1]
    assert signed == pytest.approx([0.2, -0.7, math.hypot(0.1, 0.1), 0.1, -1.3])


def test_no_polygon_no_pair():
    """Nothing to measure is nothing found."""
    wall = Polygon("wall", np.array([(0, 0), (4, 0), (4, 2), (0, 2)]))
    assert [len(part) for part in polygons_too_near([wall], np.empty((0, 2)), [], 0.3)] == [0, 0, 0]
    assert [len(part) for part in polygons_too_near([], np.zeros((1, 2)), [SQUARE], 0.3)] == [0, 0, 0]
