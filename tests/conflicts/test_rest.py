"""Does a path run over a place? Exact."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.conflicts.rest import closest, runs_over
from coord.model.path import Path, straight


def test_the_closest_point_of_a_path_is_found(wild_path):
    """300 places against 4,000 points of random paths: never farther, at most a hair nearer, and really there."""
    rng = np.random.default_rng(1)
    for _ in range(60):
        path = wild_path(rng)
        at = path.point(np.linspace(0, path.length, 4000))
        for place in rng.uniform(-6, 6, (5, 2)):
            distance, s = closest(path, tuple(place))
            sampled = np.hypot(*(at - place).T).min()
            assert sampled - (path.length / 4000) ** 2 / max(sampled, 1e-3) - 1e-9 <= distance <= sampled + 1e-9
            assert np.hypot(*(path.point(s)[0] - place)) == pytest.approx(distance, abs=1e-9)
            assert 0 <= s <= path.length + 1e-12


@settings(deadline=None, derandomize=True, max_examples=100)
@given(st.floats(-9, 9), st.floats(0.1, 3), st.floats(-math.pi, math.pi), st.floats(-100, 100), st.floats(-100, 100))
def test_touching_is_not_running_over(along, distance, turn, x, y):
    """At the distance from a line, turned and moved at will, a place is free; 2e-9 m nearer it is not."""
    c, s = math.cos(turn), math.sin(turn)
    path = Path((x, y, turn), [(20.0, 0.0, 0.0)])
    for gap, is_free in ((0.0, True), (-2e-9, False), (2e-9, True)):
        d = distance + gap
        place = (x + c * (along + 10) - s * d, y + s * (along + 10) + c * d)
        assert (runs_over(path, place, distance) is None) == is_free


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("distance", [0.3, 0.65, 1.9])
def test_touching_an_arc_is_not_running_over(side, distance):
    """Inside and outside a bend of radius 2 m alike."""
    path = Path((0.0, 0.0, 0.0), [(2.0, 0, 0), (math.pi, side / 2, side / 2), (2.0, 0, 0)])
    centre, toward = np.array([2.0, 2.0 * side]), np.array([math.sin(0.7), -side * math.cos(0.7)])
    for radius, outward in ((2 + distance, 1), (2 - distance, -1)):
        for gap, is_free in ((0.0, True), (-2e-9, False)):
            place = centre + toward * (radius + outward * gap)
            assert (runs_over(path, tuple(place.tolist()), distance) is None) == is_free


def test_a_path_without_length_runs_over_what_is_near_its_place():
    """The distance between two resting robots, exact."""
    nowhere = straight((1.0, 1.0), (1.0, 1.0))
    assert runs_over(nowhere, (1.0, 1.6), 0.6) is None
    assert runs_over(nowhere, (1.0, 1.6 - 2e-9), 0.6) == 0.0


def test_beyond_its_ends_a_path_runs_over_nothing():
    """A place ahead of the goal counts by its distance from the goal."""
    path = straight((0, 0), (10, 0))
    assert runs_over(path, (10.6, 0.0), 0.6) is None
    assert runs_over(path, (10.6 - 2e-9, 0.0), 0.6) == 10.0
    assert runs_over(path, (-0.6, 0.0), 0.6) is None
