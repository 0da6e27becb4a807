"""Convex footprints: sums, distances and directions are exact."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify.shapes import Body, gap, minkowski, mirrored, polygon, polygon_fault, support, translated, turned

angles = st.lists(st.floats(0, 2 * math.pi), min_size=3, max_size=7, unique_by=lambda a: round(a, 2)).filter(
    lambda found: (
        max((b - a) % (2 * math.pi) for a, b in zip(sorted(found), [*sorted(found)[1:], min(found)], strict=True)) < 3
    )
)
rings = st.builds(
    lambda found, r, x, y: tuple((x + r * math.cos(a), y + r * math.sin(a)) for a in sorted(found)),
    angles,
    st.floats(0.2, 2),
    st.floats(-1, 1),
    st.floats(-1, 1),
)
segments = st.tuples(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), st.tuples(st.floats(-2, 2), st.floats(-2, 2)))
directions = [(math.cos(a / 10), math.sin(a / 10)) for a in range(63)]


@settings(max_examples=150, deadline=None, derandomize=True)
@given(p=st.one_of(rings, segments), q=st.one_of(rings, segments))
def test_the_support_of_a_sum_is_the_sum_of_the_supports(p, q):
    """Which says everything about convex sums, degenerate ones included."""
    total = minkowski(p, q)
    for nx, ny in directions:
        assert support(total, nx, ny) == pytest.approx(support(p, nx, ny) + support(q, nx, ny), abs=1e-9)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(ring=rings, x=st.floats(-5, 5), y=st.floats(-5, 5))
def test_the_gap_is_the_best_separating_direction(ring, x, y):
    """n.q - h(n) <= gap for every n, with equality for the one returned; inside, for edge normals."""
    distance, nx, ny = gap((x, y), ring)
    assert math.hypot(nx, ny) == pytest.approx(1, abs=1e-12)
    assert nx * x + ny * y - support(ring, nx, ny) == pytest.approx(distance, abs=1e-9)
    for mx, my in directions:
        assert mx * x + my * y - support(ring, mx, my) <= distance + 1e-9


def test_distances_of_two_squares():
    """Side by side, corner to corner, and one in the other."""
    square = polygon([(-1, -1), (1, -1), (1, 1), (-1, 1)], False)
    difference = minkowski(square.ring, mirrored(square.ring))
    assert gap((3.0, 0.5), difference)[0] == pytest.approx(1)
    assert gap((5.0, 6.0), difference)[0] == pytest.approx(5)
    assert gap((0.5, 0.0), difference)[0] == pytest.approx(-1.5)
    assert gap((2.0, 0.0), difference)[0] == pytest.approx(0)


def test_a_footprint_turns_with_its_path_only_if_it_is_told_to():
    """A quarter turn of a long box."""
    corners = [(-1, -0.5), (2, -0.5), (2, 0.5), (-1, 0.5)]
    turning, fixed = polygon(corners, True), polygon(corners, False)
    assert turned(fixed, 1.0) == fixed.ring
    assert support(turned(turning, math.pi / 2), 0, 1) == pytest.approx(2)
    assert support(turned(turning, math.pi / 2), 1, 0) == pytest.approx(0.5)
    assert (turning.corner, fixed.corner) == (pytest.approx(math.hypot(2, 0.5)), 0.0)
    assert isinstance(turning, Body)


def test_footprints_are_convex_and_hold_their_reference_point():
    """Either sense of the corners will do; dents, stars and far-off shapes will not."""
    square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    star = [(math.sin(4 * math.pi * i / 5), math.cos(4 * math.pi * i / 5)) for i in range(5)]
    assert polygon_fault(square) == polygon_fault(square[::-1]) == ""
    assert polygon_fault([(0, 0), (1, 0), (0, 1)]) == ""
    assert "convex" in polygon_fault([(-1, -1), (1, -1), (0, 0), (1, 1), (-1, 1)])
    assert "convex" in polygon_fault(star)
    assert "reference" in polygon_fault(translated(tuple(square), (1.5, 0)))
    assert "line" in polygon_fault([(0, 0), (1, 0), (2, 0)])
    assert polygon(square[::-1], False).ring[0] in square
