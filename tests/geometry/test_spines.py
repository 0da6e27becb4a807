"""Segments inside parts, by which most hits are found."""

from __future__ import annotations

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.geometry.blocked import Floor, Screen
from coord.geometry.growth import grow
from coord.geometry.spines import crossing, reaching
from coord.model.footprint import Footprint, square
from coord.model.obstacle import Circle, Polygon, rectangle

OBSTACLES = [
    rectangle("r", (2.0, 2.0, 4.0, 7.0), 0.3),
    Circle("c", (8.0, 3.0), 1.0),
    Polygon("l", np.array([(6, 6), (10, 6), (10, 7), (7, 7), (7, 10), (6, 10)], float)),
]
FOOTPRINTS = (Footprint(0.4), square(0.6))


def floors():
    return [
        Floor(grown, grown.rho) for grown in (grow(OBSTACLES, one, 0.1, (0.0, 0.0, 12.0, 12.0)) for one in FOOTPRINTS)
    ]


def test_spines_are_inside_the_core_and_longer_ones_stay_nearer_than_is_allowed():
    """For a turned rectangle, a point and an L, for a disc and for a square; the L's longest edge stands in for what leaves it."""
    for floor in floors():
        spines = floor.grown.spines
        longer = reaching(spines, floor.rho)
        for part, rho, own, reach in zip(floor.grown.parts, floor.rho, spines, longer, strict=True):
            assert shapely.covers(part.buffer(1e-9), shapely.linestrings(own.reshape(-1, 2, 2))).all()
            assert (shapely.distance(part, shapely.points(reach.reshape(-1, 2))) < rho).all()
            assert (np.hypot(*(reach[:, 2:] - reach[:, :2]).T) > 1.9 * rho).all()


def test_segments_cross_where_each_has_its_ends_on_both_sides_of_the_other():
    """A cross does; a T, a pair on one line and a pair side by side do not."""
    one = np.array([[0.0, 0.0, 2.0, 0.0]] * 4)
    other = np.array([[1.0, -1.0, 1.0, 1.0], [1.0, 0.0, 1.0, 1.0], [1.0, 0.0, 3.0, 0.0], [0.0, 1.0, 2.0, 1.0]])
    assert crossing(one, other).tolist() == [True, False, False, False]


places = st.tuples(st.floats(0.5, 11.5), st.floats(0.5, 11.5))


@settings(deadline=None, derandomize=True, max_examples=200)
@given(st.lists(st.tuples(places, places), min_size=1, max_size=8), st.sampled_from([(0, 1, 2), (2,), (0, 1), ()]))
def test_a_screen_finds_the_hits_that_distances_tell(ends, chosen):
    """Against the distance of each segment from each part, for any choice of parts; not where it is within rounding."""
    for floor in floors():
        parts = np.array(chosen, dtype=np.intp)
        segments = np.array([[*a, *b] for a, b in ends])
        lines = shapely.linestrings(segments.reshape(-1, 2, 2))
        gaps = [shapely.distance(floor.grown.parts[k], lines) - floor.rho[k] for k in chosen]
        least = np.min([np.full(len(ends), np.inf), *gaps], axis=0)
        sure = np.abs(least) > 1e-8
        assert np.array_equal(Screen(floor, parts).is_hit(segments)[sure], (least < 0)[sure])
