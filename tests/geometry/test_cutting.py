"""Cutting polygons with holes into polygons without."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.geometry.cutting import polygons_of_wkt, rest_of_box, rings_fault, simple_parts

SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10)]


def box(x, y, size=1.0):
    return [(x, y), (x, y + size), (x + size, y + size), (x + size, y)]


@settings(deadline=None)
@given(st.sets(st.tuples(st.integers(0, 4), st.integers(0, 4)), max_size=12), st.floats(0.0, 1.5))
def test_parts_have_no_holes_and_cover_the_polygon_without_overlap(cells, angle):
    """Whatever holes there are, upright or turned: areas add up, the union is the polygon."""
    holes = [box(2 * x + 0.5, 2 * y + 0.5) for x, y in cells]
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    rings = [np.array(ring) @ turn for ring in (SQUARE, *holes)]
    parts = [shapely.Polygon(part) for part in simple_parts(rings)]
    whole = shapely.Polygon(rings[0], rings[1:])
    assert all(part.is_valid for part in parts)
    assert sum(part.area for part in parts) == pytest.approx(whole.area, rel=1e-12)
    assert shapely.union_all(parts).symmetric_difference(whole).area < 1e-9
    if not angle:
        assert shapely.union_all(parts).equals(whole)


def test_a_polygon_without_holes_stays_as_it_is():
    """One part, the same corners."""
    (part,) = simple_parts([SQUARE])
    assert part.tolist() == [list(map(float, corner)) for corner in SQUARE]


@pytest.mark.parametrize(
    ("rings", "fault"),
    [
        ([SQUARE, box(2, 2)], None),
        ([[(0, 0), (4, 4), (4, 0), (0, 4)]], "the outlines are no polygon: self-intersection at (2, 2)"),
        ([SQUARE, box(20, 2)], "the outlines are no polygon: hole lies outside shell at (20, 2)"),
        ([[(0, 0), (1, 1), (0, 0)]], "an outline needs at least 3 different corners"),
        ([[(0, 0), (1, 1), (0, float("nan"))]], "all corners must be finite numbers"),
    ],
)
def test_faulty_outlines_are_told_with_their_place(rings, fault):
    """Crossing itself, a hole elsewhere, too few corners, no numbers."""
    assert rings_fault(rings) == fault


def test_what_a_floor_leaves_of_its_box_is_covered():
    """A triangle in its box leaves two triangles; with a hole in it, that too."""
    rest = rest_of_box((0, 0, 10, 10), [[[(0, 0), (10, 0), (5, 10)], box(4, 1)]])
    areas = sorted(shapely.Polygon(part).area for part in rest)
    assert areas == pytest.approx([1, 25, 25])


def test_well_known_text_gives_polygons_and_counts_the_rest():
    """Collections within collections; points and lines are counted, empty ones are not."""
    text = "GEOMETRYCOLLECTION (POINT (1 2), GEOMETRYCOLLECTION (MULTIPOLYGON (((0 0, 1 0, 0 1, 0 0)), EMPTY)))"
    polygons, others = polygons_of_wkt(text)
    assert [[ring.tolist() for ring in rings] for rings in polygons] == [[[[0, 0], [1, 0], [0, 1]]]]
    assert others == 1


@pytest.mark.parametrize("text", ["POLYGON ((0 0, 1 0", "CIRCLE (1 2)", "POLYGON ((0 0, 1 0, 1 1))"])
def test_what_is_no_well_known_text_says_why(text):
    """Cut short, an unknown word, an outline that is not closed."""
    with pytest.raises(ValueError, match=r"\w{3}"):
        polygons_of_wkt(text)
