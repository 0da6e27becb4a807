"""Simplified outlines: never smaller, hardly larger, never in each other's way."""

from __future__ import annotations

import itertools
import time

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from coord.reading.simplify import simplified
from coord.reading.trace import trace


def crowded(seed: int, side: int, density: float, blur: int) -> np.ndarray:
    """Random cells, thickened to blobs by ``blur`` cells: outlines full of inward corners, close to each other."""
    cells = np.random.default_rng(seed).random((side, side)) < density
    for _ in range(blur):
        cells[1:] |= cells[:-1]
        cells[:, 1:] |= cells[:, :-1]
    return cells


CELLS = st.builds(
    crowded, st.integers(0, 10**6), st.integers(2, 30), st.sampled_from([0.05, 0.1, 0.3, 0.5]), st.integers(0, 2)
) | arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12)))
TOLERANCES = st.sampled_from([0.5, 0.8, 1.0, 1.5, 2.3, 5.0])


def shape(polygon):
    """A polygon as shapely has it."""
    shell, holes = polygon
    return shapely.Polygon(shell, holes)


def corners(polygons):
    """How many corners polygons have."""
    return sum(len(ring) for shell, holes in polygons for ring in (shell, *holes))


@settings(deadline=None, max_examples=300)
@given(CELLS, TOLERANCES)
def test_no_obstacle_shrinks_and_none_grows_beyond_the_tolerance(occupied, tolerance):
    """Each polygon contains what it was made from, and lies in it widened by the tolerance."""
    before = trace(occupied)
    for old, new in zip(before, simplified(before, tolerance), strict=True):
        assert shape(new).covers(shape(old))
        # the arcs of a widened shape are chords that lie inside of it
        widened = shapely.buffer(shape(old), tolerance / np.cos(np.pi / 256) + 1e-9, quad_segs=64)
        assert widened.covers(shape(new))


@settings(deadline=None, max_examples=300)
@given(CELLS, TOLERANCES)
def test_outlines_stay_simple_and_apart(occupied, tolerance):
    """Every polygon is valid, its shell runs counter-clockwise, and no two polygons share any area."""
    shapes = []
    for shell, holes in simplified(trace(occupied), tolerance):
        assert shapely.is_ccw(shapely.LinearRing(shell))
        assert not any(shapely.is_ccw(shapely.LinearRing(hole)) for hole in holes)
        shapes.append(shape((shell, holes)))
    assert all(one.is_valid for one in shapes)
    assert all(one.intersection(other).area == 0 for one, other in itertools.combinations(shapes, 2))


@given(CELLS)
def test_without_a_tolerance_nothing_changes(occupied):
    """0 leaves every corner where it is."""
    before = trace(occupied)
    for old, new in zip(before, simplified(before, 0.0), strict=True):
        assert np.array_equal(old[0], new[0])
        assert all(np.array_equal(a, b) for a, b in zip(old[1], new[1], strict=True))


def test_a_ragged_wall_becomes_a_straight_one():
    """A wall whose every second cell is missing along its edge keeps its four outer corners only."""
    occupied = np.ones((4, 41), dtype=bool)
    occupied[3, 1::2] = False
    ((shell, holes),) = simplified(trace(occupied), 1.0)
    assert sorted(map(tuple, shell.tolist())) == [(0, 0), (0, 4), (41, 0), (41, 4)]
    assert holes == []


@pytest.mark.parametrize(("tolerance", "corners_left"), [(0.7, 42), (0.71, 5)])
def test_a_flight_of_stairs_becomes_a_ramp_when_the_tolerance_covers_a_step(tolerance, corners_left):
    """The inner corners of steps of one cell lie 0.7071 cells from the ramp over their outer corners."""
    occupied = np.tri(20, dtype=bool)
    ((shell, _),) = simplified(trace(occupied), tolerance)
    assert len(shell) == corners_left


@pytest.mark.parametrize(("tolerance", "holes_left"), [(0.9, 2), (1.0, 1), (1.4, 1), (1.6, 1)])
def test_a_small_hole_is_filled_and_one_with_an_island_is_not(tolerance, holes_left):
    """Two cells wide and nothing in it: filled from a tolerance of one cell on. Three wide with a cell in it: kept."""
    occupied = np.ones((9, 12), dtype=bool)
    occupied[2:4, 2:9] = False
    occupied[5:8, 2:5] = False
    occupied[6, 3] = True
    polygons = simplified(trace(occupied), tolerance)
    assert sorted(len(holes) for _, holes in polygons) == [0, holes_left]


def test_a_noisy_floor_is_simplified_in_seconds():
    """A million cells with 1 % of noise: 0.1 s when it was written."""
    occupied = np.random.default_rng(3).random((1000, 1000)) < 0.01
    occupied[::50] = True
    before = trace(occupied)
    started = time.perf_counter()
    after = simplified(before, 2.0)
    assert time.perf_counter() - started < 5
    assert corners(after) < corners(before)
