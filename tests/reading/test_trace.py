"""Tracing: polygons that are exactly the occupied cells."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from coord.reading.trace import trace

CELLS = arrays(bool, st.tuples(st.integers(1, 9), st.integers(1, 9)))


def rows(*lines: str) -> np.ndarray:
    """Cells as drawn, the top row first, # occupied."""
    return np.array([[c == "#" for c in line] for line in reversed(lines)])


def area(ring: np.ndarray) -> float:
    """Area of a ring, positive counter-clockwise."""
    x, y = ring.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()) / 2


def lattice(ring: np.ndarray) -> list[tuple[int, int]]:
    """All lattice points along a ring; edges must run along rows or columns."""
    points = []
    for (x0, y0), (x1, y1) in zip(ring.tolist(), np.roll(ring, -1, axis=0).tolist(), strict=True):
        assert (x0 == x1) != (y0 == y1)
        steps = abs(x1 - x0) + abs(y1 - y0)
        points += [(x0 + (x1 - x0) * k // steps, y0 + (y1 - y0) * k // steps) for k in range(steps)]
    return points


def rasterised(rings: list[np.ndarray], shape: tuple[int, int]) -> np.ndarray:
    """How many vertical edges lie left of each cell's centre, modulo 2: the even-odd rule."""
    crossings = np.zeros(shape, dtype=int)
    for ring in rings:
        for (x0, y0), (_, y1) in zip(ring.tolist(), np.roll(ring, -1, axis=0).tolist(), strict=True):
            crossings[min(y0, y1) : max(y0, y1), x0:] += 1
    return crossings % 2 == 1


def joined(occupied: np.ndarray) -> int:
    """How many groups of cells there are that are joined by edges."""
    left, groups = {tuple(cell) for cell in np.argwhere(occupied).tolist()}, 0
    while left:
        groups, front = groups + 1, [left.pop()]
        while front:
            r, c = front.pop()
            found = {(r + 1, c), (r - 1, c), (r, c + 1), (r, c - 1)} & left
            left -= found
            front += found
    return groups


@settings(deadline=None)
@given(CELLS)
def test_polygons_are_exactly_the_occupied_cells(occupied):
    """Each polygon by itself, rasterised, gives cells that no other has; together they are the occupied ones."""
    total = np.zeros(occupied.shape, dtype=int)
    for shell, holes in trace(occupied):
        cells = rasterised([shell, *holes], occupied.shape)
        assert area(shell) + sum(area(hole) for hole in holes) == cells.sum()
        total += cells
    assert np.array_equal(total, occupied.astype(int))


@settings(deadline=None)
@given(CELLS)
def test_every_ring_is_simple_and_runs_the_right_way_round(occupied):
    """No ring meets itself, shells run counter-clockwise, holes clockwise, and no vertex lies on a straight stretch."""
    for shell, holes in trace(occupied):
        assert area(shell) > 0
        assert all(area(hole) < 0 for hole in holes)
        for ring in (shell, *holes):
            points = lattice(ring)
            assert len(set(points)) == len(points)
            before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
            assert ((before * after).sum(axis=1) == 0).all()


@settings(deadline=None)
@given(CELLS)
def test_there_is_one_polygon_for_each_group_of_cells_joined_by_edges(occupied):
    """Cells that touch in a corner only belong to different polygons, cells that share an edge to the same."""
    assert len(trace(occupied)) == joined(occupied)


@pytest.mark.parametrize(
    ("cells", "polygons"),
    [
        (rows("...", "..."), []),
        (rows("#"), [([(0, 0), (1, 0), (1, 1), (0, 1)], [])]),
        (rows("###", "#.#", "###"), [([(0, 0), (3, 0), (3, 3), (0, 3)], [[(1, 1), (1, 2), (2, 2), (2, 1)]])]),
        (rows(".#", "#."), [([(0, 0), (1, 0), (1, 1), (0, 1)], []), ([(1, 1), (2, 1), (2, 2), (1, 2)], [])]),
    ],
)
def test_small_drawings_have_known_outlines(cells, polygons):
    """Nothing, one cell, a frame, and two cells that touch in a corner."""
    assert [
        ([tuple(p) for p in shell.tolist()], [[tuple(p) for p in hole.tolist()] for hole in holes])
        for shell, holes in trace(cells)
    ] == polygons


def test_a_hook_that_closes_in_a_corner_has_a_hole_that_touches_its_outline():
    """A ring that meets itself is split into an outline and a hole that share one corner."""
    ((shell, holes),) = trace(rows("###", "#.#", "##."))
    assert [hole.tolist() for hole in holes] == [[[2, 1], [1, 1], [1, 2], [2, 2]]]
    assert len(shell) == 6


def test_an_island_in_a_lake_is_a_polygon_of_its_own():
    """A hole belongs to the polygon round it, not to the island in it."""
    polygons = trace(rows("#######", "#.....#", "#.###.#", "#.#.#.#", "#.###.#", "#.....#", "#######"))
    sizes = sorted((area(shell), [area(hole) for hole in holes]) for shell, holes in polygons)
    assert sizes == [(9.0, [-1.0]), (49.0, [-25.0])]


def test_a_large_map_is_traced_in_moments():
    """Four million cells with hundreds of boxes: 0.05 s when it was written."""
    occupied = np.zeros((2000, 2000), dtype=bool)
    rng = np.random.default_rng(1)
    for r, c in rng.integers(0, 1980, (800, 2)).tolist():
        occupied[r : r + 17, c : c + 11] = True
    started = time.perf_counter()
    polygons = trace(occupied)
    assert time.perf_counter() - started < 3
    assert sum(area(shell) + sum(area(hole) for hole in holes) for shell, holes in polygons) == occupied.sum()


def floor_plan(side: int, noise: float) -> np.ndarray:
    """Rooms of 250 x 250 cells with a door in each wall and seven racks in each, and stray cells all over."""
    rng = np.random.default_rng(1)
    occupied = np.zeros((side, side), dtype=bool)
    for k in range(0, side, 250):
        occupied[k : k + 4] = occupied[:, k : k + 4] = True
    for r, c in np.ndindex(side // 250, side // 250):
        y, x, door = 250 * r, 250 * c, int(rng.integers(20, 200))
        occupied[y : y + 4, x + door : x + door + 30] = occupied[y + door : y + door + 30, x : x + 4] = False
        for rack in range(30, 220, 30):
            occupied[y + rack : y + rack + 12, x + 40 : x + 200] = True
    return occupied | (rng.random((side, side)) < noise)


@pytest.mark.parametrize(("side", "noise", "seconds"), [(2000, 0.001, 1.0), (750, 0.5, 15.0)])
def test_floor_plans_are_traced_in_moments_and_even_noise_in_seconds(side, noise, seconds):
    """Four million cells with 0.1 % of stray cells: 0.03 s; 50 % of stray cells: 1.5 s a million, when it was written."""
    occupied = floor_plan(side, noise)
    started = time.perf_counter()
    polygons = trace(occupied)
    assert time.perf_counter() - started < seconds
    assert len(polygons) > 3000
