"""Which segments and which parts of circles come too near to grown obstacles."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st

from coord.geometry.blocked import Floor
from coord.geometry.circles import blocked_angles
from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle

BOUNDS = (0.0, 0.0, 12.0, 12.0)
OBSTACLES = [
    rectangle("r", (2.0, 2.0, 4.0, 7.0), 0.3),
    Circle("c", (8.0, 3.0), 1.0),
    Polygon("l", np.array([(6, 6), (10, 6), (10, 7), (7, 7), (7, 10), (6, 10)], float)),
]
REACH = 0.4
ROUNDING = 1e-12  # of angles [rad]
places = st.tuples(st.floats(0.5, 11.5), st.floats(0.5, 11.5))


@pytest.fixture(scope="module")
def floor():
    grown = grow(OBSTACLES, Footprint(REACH), 0.0, BOUNDS)
    return Floor(grown, grown.rho)


def clearances(floor, points):
    """(parts, n) distances less what is kept."""
    parts = zip(floor.grown.parts, floor.rho, strict=True)
    return np.array([shapely.distance(part, shapely.points(points)) - rho for part, rho in parts])


@settings(deadline=None, derandomize=True, max_examples=100)
@given(st.lists(st.tuples(places, places), min_size=1, max_size=5))
def test_a_segment_hits_the_parts_that_some_of_its_points_are_too_near_to(floor, ends):
    """Against 1,500 points of each segment: the same pairs, except where the nearest comes within a micrometre."""
    segments = np.array([[*a, *b] for a, b in ends])
    hits = {tuple(pair) for pair in floor.hit_parts(segments).tolist()}
    share = np.linspace(0, 1, 1500)[:, None]
    for k, (a, b) in enumerate(ends):
        near = clearances(floor, np.array(a) * (1 - share) + np.array(b) * share).min(axis=1)
        slack = (np.hypot(*np.subtract(a, b)) / 1500) ** 2 + 1e-8
        for part, least in enumerate(near.tolist()):
            if least < -1e-8:
                assert (k, part) in hits
            elif least > slack:
                assert (k, part) not in hits


@settings(deadline=None, derandomize=True, max_examples=100)
@given(places, st.floats(0.05, 3.0))
@example(center=(7.0, 6.6), radius=3.0)  # two stretches meet at 0 but for a rounding, in the middle of an edge
def test_blocked_angles_are_those_at_which_the_circle_is_too_near(floor, center, radius):
    """Against 1,440 points: blocked exactly where one is too near to a part's outline or beyond the box.

    Deep inside a part nothing need be blocked: nobody gets there without crossing its outline.
    """
    stretches = blocked_angles(np.array(center), radius, *floor.edges_of(np.arange(len(floor.rho))), floor.grown.box)
    angles = np.linspace(0, 2 * np.pi, 1440, endpoint=False)
    at = np.array(center) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    xmin, ymin, xmax, ymax = floor.grown.box
    edge = np.min([at[:, 0] - xmin, xmax - at[:, 0], at[:, 1] - ymin, ymax - at[:, 1]], axis=0)
    outlines = [part if part.geom_type == "Point" else shapely.boundary(part) for part in floor.grown.parts]
    to_outline = [
        shapely.distance(line, shapely.points(at)) - rho for line, rho in zip(outlines, floor.rho, strict=True)
    ]
    clear = np.minimum(np.min(to_outline, axis=0), edge)
    blocked = np.zeros(len(angles), bool)
    for first, last in stretches.tolist():
        blocked |= (angles - first + ROUNDING) % (2 * np.pi) < last - first + 2 * ROUNDING
    assert np.all(blocked[clear < -1e-7])
    assert not np.any(blocked[(clear > 1e-7) & (clearances(floor, at).min(axis=0) > 1e-7)])


def test_contact_is_no_hit(floor):
    """A line at exactly the reach from the column, and from the long side of the L, is free; a nanometre or two nearer it is not."""
    touching = np.array([[5.0, 4.4, 11.0, 4.4], [10.4, 5.0, 10.4, 9.0]])
    assert floor.hit_parts(touching).tolist() == []
    assert len(floor.hit_parts(touching - [[0, 3e-9, 0, 3e-9], [3e-9, 0, 3e-9, 0]])) == 2


def test_a_circle_round_its_own_corner_is_blocked_where_the_edges_begin():
    """For 500 squares at any angle: the disc about a corner is free exactly over its quarter of directions."""
    rng = np.random.default_rng(2)
    for _ in range(500):
        reach, angle = rng.uniform(0.1, 0.5), rng.uniform(0, 2 * np.pi)
        grown = grow([rectangle("s", (4.0, 4.0, 8.0, 8.0), angle)], Footprint(reach), 0.0, BOUNDS)
        floor = Floor(grown, grown.rho)
        for place, first, span in zip(grown.corners.places, grown.corners.first, grown.corners.span, strict=True):
            stretches = blocked_angles(place, reach, *floor.edges_of(np.array([0])), floor.grown.box)
            for share, is_free in (
                (1e-5, True),
                (0.5, True),
                (1 - 1e-5, True),
                (-1e-5, False),
                (1 + 1e-5, False),
                (1.7, False),
            ):
                inside = (first + share * span - stretches[:, 0]) % (2 * np.pi) < stretches[:, 1] - stretches[:, 0]
                assert is_free != inside.any()


def test_near_parts_are_those_whose_grown_boxes_meet_a_box(floor):
    """In ascending order, and none on an empty floor."""
    assert floor.near_parts((0.0, 0.0, 12.0, 12.0)).tolist() == [0, 1, 2]
    assert len(floor.near_parts((11.0, 11.0, 12.0, 12.0))) == 0
    empty = grow([], Footprint(REACH), 0.0, BOUNDS)
    assert len(Floor(empty, empty.rho).near_parts((0.0, 0.0, 1.0, 1.0))) == 0
    assert len(Floor(empty, empty.rho).hit_parts(np.array([[0.0, 0.0, 1.0, 1.0]]))) == 0
