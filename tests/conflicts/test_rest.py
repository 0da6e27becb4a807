"""Does a path run over a place? Exact."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.conflicts.apart import signed_distance
from coord.conflicts.core import conflict_core
from coord.conflicts.rest import closest, runs_over
from coord.model.footprint import Footprint, square
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


@pytest.mark.parametrize("kinds", [("line",), ("arc",), ("clothoid",), ("line", "arc", "clothoid")], ids="-".join)
def test_the_closest_point_to_a_polygon_is_found(wild_path, wild_shape, kinds):
    """160 polygons, far from the origin, against 3,000 points: never farther, at most a step nearer, and really there."""
    rng = np.random.default_rng(2)
    deep = 0
    for _ in range(40):
        path = wild_path(rng, kinds)
        path = Path((path.start[0] + 3000, path.start[1] - 5000, path.start[2]), path.pieces)
        core = conflict_core(wild_shape(rng).core, square(0.5).core)
        at = path.point(np.linspace(0, path.length, 3000))
        for place in rng.uniform((2998, -5002), (3002, -4998), (4, 2)):
            distance, s = closest(path, tuple(place.tolist()), core)
            sampled = float(signed_distance(at - place, np.array(core)).min())
            assert sampled - path.length / 5998 - 1e-9 <= distance <= sampled + 1e-9
            assert float(signed_distance(path.point(s) - place, np.array(core))[0]) == pytest.approx(distance, abs=1e-9)
            assert 0 <= s <= path.length + 1e-12
            deep += distance < 0
    assert deep > 8


def test_what_is_farther_than_asked_need_not_be_exact(wild_path, wild_shape):
    """Within the distance asked for the answer is the same, beyond it stays beyond, on bent paths of all kinds."""
    rng = np.random.default_rng(3)
    for _ in range(60):
        path, core = wild_path(rng), conflict_core(wild_shape(rng).core, square(0.5).core)
        place = tuple(rng.uniform(-3, 3, 2).tolist())
        exact, rough = closest(path, place, core)[0], closest(path, place, core, within=0.3)[0]
        assert rough == pytest.approx(exact, abs=1e-9) if exact < 0.3 else rough >= 0.3 - 1e-9


@pytest.mark.parametrize("clearance", [0.0, 0.05])
@pytest.mark.parametrize(
    ("touching", "outward"),
    [((5.0, 0.5), (0, 1)), ((-0.5, 0.1), (-1, 0)), ((10.5, -0.2), (1, 0)), ((-0.5, 0.5), (-0.6, 0.8))],
    ids=["beside", "behind", "ahead", "corner to corner"],
)
def test_touching_squares_do_not_run_over_each_other(touching, outward, clearance):
    """Beside the way, behind and ahead of it, corner to corner: at the clearance free, 4e-9 m nearer not."""
    core, path = conflict_core(square(0.6).core, square(0.4).core), straight((0, 0), (10, 0))
    for gap, is_free in ((0.0, True), (-4e-9, False), (4e-9, True)):
        place = tuple((np.array(touching) + np.array(outward) * (clearance + gap)).tolist())
        assert (runs_over(path, place, clearance, core) is None) == is_free


@pytest.mark.parametrize("side", [1, -1])
def test_a_bend_round_the_corner_of_a_square_at_the_clearance_is_free(side):
    """All of the arc touches: not run over; with the square 2e-9 m nearer it is."""
    core = conflict_core(Footprint(0.3).core, square(1.0).core)
    path = Path((-1.0, -0.8 * side, 0.0), [(1.5, 0, 0), (0.15 * math.pi, side / 0.3, side / 0.3), (1.5, 0, 0)])
    for gap, is_free in ((0.0, True), (2e-9, False)):
        place = (gap * math.sqrt(0.5), -side * gap * math.sqrt(0.5))
        assert (runs_over(path, place, 0.3, core) is None) == is_free
