"""Exact shapes of obstacles and distances to them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.geometry.shapes import core, depths, distances, polygon_fault, too_near
from coord.model.obstacle import Circle, Polygon, rectangle

FRAME = Polygon(
    "frame",
    np.array([(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)]),
    (np.array([(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0)]),),
)


def test_a_circle_is_its_centre_and_its_radius():
    """No polygon stands in for the arc: the distance to a circle is exact."""
    shape, radius = core(Circle("c", (3.0, 4.0), 2.0))
    assert radius == 2.0
    assert distances(shape, np.array([(0.0, 0.0)]))[0] - radius == 3.0


def test_a_polygon_is_itself_with_its_holes():
    """In a hole the distance is that to its edge, in the solid part it is 0, outside that to the outline."""
    shape, radius = core(FRAME)
    assert radius == 0.0
    assert distances(shape, np.array([(3, 3), (1, 1), (-3, -4), (6, 6)])).tolist() == [1.0, 0.0, 5.0, 0.0]


def test_depth_is_the_way_out():
    """The distance to the nearest edge for points inside, 0 on the edge and outside."""
    shape, _ = core(FRAME)
    assert depths(shape, np.array([(1, 1), (0.25, 3), (1.5, 3), (3, 3), (0, 0), (9, 9)])).tolist() == [
        1.0,
        0.25,
        0.5,
        0.0,
        0.0,
        0.0,
    ]


@pytest.mark.parametrize(
    "vertices", [[(0, 0), (1, 0), (0, 1)], [(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)], [(0, 0), (0, 1), (1, 0)]]
)
def test_a_simple_polygon_has_no_fault(vertices):
    """Triangles and concave outlines, either way round."""
    assert polygon_fault(np.array(vertices, dtype=float)) is None


@pytest.mark.parametrize(
    ("vertices", "fault"),
    [
        ([(0, 0), (2, 2), (2, 0), (0, 2)], "the outline crosses or touches itself at (1, 1)"),
        ([(0, 0), (4, 0), (4, 4), (2, 0), (0, 4)], "the outline crosses or touches itself at (2, 0)"),
        ([(0, 0), (4, 0), (4, 4), (4, 2), (4, 6), (0, 4)], "the outline crosses or touches itself at (4, "),
        ([(0, 0), (0, 0), (1, 0), (0, 1)], "vertices 1 and 2 are the same point (0, 0)"),
        ([(0, 0), (1, 0), (0, 1), (0, 0)], "vertices 4 and 1 are the same point (0, 0)"),
    ],
)
def test_a_polygon_that_is_not_simple_is_told_with_the_place(vertices, fault):
    """Crossing, touching itself, running back on itself, a vertex given twice."""
    assert str(polygon_fault(np.array(vertices, dtype=float))).startswith(fault)


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.integers(-4, 16), st.integers(-4, 16), st.integers(1, 12)), min_size=1, max_size=20),
    st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9), st.integers(1, 6), st.booleans()), max_size=8),
)
def test_too_near_finds_every_pair_nearer_than_its_reach(places, solids):
    """The same pairs and the same signed distances as the formulas for circles and boxes give, one by one."""
    points = np.array([(x / 2, y / 2) for x, y, _ in places])
    reach = np.array([r / 4 for _, _, r in places])
    obstacles = [
        Circle("o", (x, y), s / 2) if is_round else rectangle("o", (x, y, x + s, y + s / 2))
        for x, y, s, is_round in solids
    ]
    expected = []
    for k, (x, y, s, is_round) in enumerate(solids):
        for n, (px, py) in enumerate(points.tolist()):
            if is_round:
                signed = np.hypot(px - x, py - y) - s / 2
            else:
                dx, dy = max(x - px, px - x - s), max(y - py, py - y - s / 2)
                signed = np.hypot(max(dx, 0), max(dy, 0)) if max(dx, dy) > 0 else max(dx, dy)
            if signed < reach[n] - 1e-9:
                expected.append((n, k, signed))
    who, what, signed = too_near(obstacles, points, reach)
    assert list(zip(who.tolist(), what.tolist(), strict=True)) == [(n, k) for n, k, _ in expected]
    assert signed == pytest.approx([value for _, _, value in expected], abs=1e-12)


def test_nothing_is_near_where_nothing_is():
    """No obstacles, or no points, give no pairs."""
    nothing = np.empty((0, 2))
    assert all(len(part) == 0 for part in too_near([], np.array([(0.0, 0.0)]), np.array([1.0])))
    assert all(len(part) == 0 for part in too_near([FRAME], nothing, np.empty(0)))
