"""Fitted paths: never slower than taut ones, clear of everything, smooth where it pays."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.fastest import fastest, solo_bound
from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, rectangle
from coord.model.robot import Limits
from coord.paths.fitted import fitted
from coord.paths.skeleton import NoWay, search_floor, skeleton
from coord.paths.taut import taut

BOUNDS = (0.0, 0.0, 20.0, 15.0)
LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def both(obstacles, bounds, reach, start, goal, limits=LIMITS):
    """Skeleton, fitted and taut path; None where there is no way."""
    floor = search_floor(grow(obstacles, Footprint(reach), 0.0, bounds), (start, goal))
    found = skeleton(floor, start, goal)
    return None if isinstance(found, NoWay) else (found, fitted(found, limits, floor), taut(found, floor))


@pytest.mark.parametrize("seed", range(300, 330))
def test_a_fitted_path_keeps_clear_and_is_no_slower_than_the_taut_one(keeps_clear, floors, seed):
    """On 30 random floors: from start to goal, at its reach from everything, and timed never later than the shortest way."""
    floor = floors(seed, 6)
    found = both(*floor)
    if found is None:
        return
    bones, smooth, tight = found
    keeps_clear(smooth, *floor)
    assert smooth.length >= bones.length - 1e-9
    time = fastest(smooth, LIMITS).arrival
    assert time <= fastest(tight, LIMITS).arrival * (1 + 1e-6)
    assert time >= solo_bound(smooth, LIMITS)


def test_wide_turns_pay_where_there_is_room():
    """Round a pillar's corner a tight turn must be slow; with room about it the fitted path is at least 3 % quicker."""
    _, smooth, tight = both([rectangle("p", (9.0, 0.0, 10.0, 7.0))], BOUNDS, 0.3, (3.0, 2.0), (16.0, 2.0))
    assert fastest(smooth, LIMITS).arrival < 0.97 * fastest(tight, LIMITS).arrival
    assert np.abs(smooth.pieces[:, 1:]).max() < 0.7 * np.abs(tight.pieces[:, 1:]).max()


def test_where_nothing_is_in_the_way_the_path_is_straight():
    """No turns, one line."""
    _, smooth, tight = both([], BOUNDS, 0.3, (3.0, 2.0), (16.0, 2.0))
    assert smooth.pieces.tolist() == tight.pieces.tolist() == [[13.0, 0.0, 0.0]]


def test_a_slow_robot_takes_the_shortest_way():
    """At 0.2 m/s no turn has to be slowed down for: taut and fitted are the same time within a hair."""
    slow = Limits(0.2, 0.5, 0.5, 1.0, 0.5)
    bones, smooth, _ = both([Circle("c", (10.0, 7.0), 2.0)], BOUNDS, 0.3, (3.0, 7.2), (17.0, 7.0), slow)
    assert smooth.length == pytest.approx(bones.length, abs=1e-4)


@pytest.mark.parametrize("seed", range(340, 350))
def test_a_mirrored_floor_has_a_path_as_quick(floors, seed):
    """Left and right are alike: the same length and the same time on the mirrored floor."""
    obstacles, bounds, reach, start, goal = floors(seed, 4)
    circles = [Circle(f"c{k}", tuple(np.mean(o.vertices, axis=0)) if hasattr(o, "vertices") else o.center, 0.8)
               for k, o in enumerate(obstacles)]  # fmt: skip
    mirror = [Circle(c.name, (c.center[0], 15.0 - c.center[1]), c.radius) for c in circles]
    one = both(circles, bounds, 0.2, (0.5, start[1]), (19.5, goal[1]))
    two = both(mirror, bounds, 0.2, (0.5, 15 - start[1]), (19.5, 15 - goal[1]))
    assert (one is None) == (two is None)
    if one is not None:
        assert two[1].length == pytest.approx(one[1].length, abs=1e-6)
        assert fastest(two[1], LIMITS).arrival == pytest.approx(fastest(one[1], LIMITS).arrival, rel=1e-6)


def test_a_start_that_touches_an_obstacle_can_turn_at_once(keeps_clear):
    """Beside a column at exactly the reach, the way leads round it."""
    floor = ([Circle("c", (5.0, 7.5), 1.0)], BOUNDS, 0.4, (5.0, 6.1), (5.0, 8.9))
    _, smooth, _ = both(*floor)
    keeps_clear(smooth, *floor)
    assert smooth.length == pytest.approx(np.pi * 1.4, abs=1e-4)
