"""What the difference of two robots' places must keep away from."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.conflicts.core import POINT, conflict_core, swept
from coord.model.footprint import Footprint, square


def support(core, directions):
    """How far polygons reach in some directions."""
    return (np.array(core) @ directions.T).max(axis=0)


def turns(core):
    """Sines of the turns at the corners."""
    edges = np.roll(core, -1, axis=0) - np.array(core)
    edges /= np.hypot(edges[:, :1], edges[:, 1:])
    after = np.roll(edges, -1, axis=0)
    return edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]


def test_two_discs_have_a_point():
    """And so have a disc and a polygon that turns, which is planned as a disc."""
    assert conflict_core(Footprint(0.3).core, Footprint(0.4).core) == POINT
    assert conflict_core(Footprint(0.3).core, square(0.4, "path").core) == POINT


def test_two_squares_have_the_square_of_both_sides():
    """0.6 m and 0.4 m make 1 m, with four corners."""
    core = conflict_core(square(0.6).core, square(0.4).core)
    assert core == ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))


def test_it_reaches_as_far_as_both_together(wild_shape):
    """200 pairs: in every direction as far as the other, and ego against that direction (the sum's definition)."""
    rng = np.random.default_rng(1)
    angles = np.linspace(0, 2 * math.pi, 720)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for _ in range(200):
        ego, other = wild_shape(rng).core, wild_shape(rng).core
        both = support(other, directions) + support(ego, -directions)
        assert support(conflict_core(ego, other), directions) == pytest.approx(both, abs=1e-11)


def test_it_is_convex_and_has_no_corner_on_an_edge(wild_shape, regular):
    """Also where the two are turned by the same angle, so that edges are parallel but for rounding."""
    rng = np.random.default_rng(2)
    for k in range(100):
        ego = wild_shape(rng)
        core = conflict_core(ego.core, wild_shape(rng).core)
        assert core == POINT or turns(core).min() > 1e-6
        turn = 0.07 * k
        core = conflict_core(regular(4, 0.3, turn).core, regular(4, 0.7, turn).core)
        assert len(core) == 4
        assert turns(core) == pytest.approx(1.0)


def test_exchanging_the_two_robots_reflects_it_at_the_origin(wild_shape):
    """x_i - x_j is -(x_j - x_i)."""
    rng = np.random.default_rng(3)
    angles = np.linspace(0, 2 * math.pi, 360)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for _ in range(50):
        ego, other = wild_shape(rng).core, wild_shape(rng).core
        mine, theirs = conflict_core(ego, other), conflict_core(other, ego)
        assert support(mine, directions) == pytest.approx(support(theirs, -directions), abs=1e-12)
        assert len(mine) == len(theirs)


def test_what_it_sweeps_reaches_as_far_as_it_and_its_way(wild_shape):
    """50 cores on 40 ways each, also of no length: convex, counter-clockwise, support as of the Minkowski sum."""
    rng = np.random.default_rng(4)
    angles = np.linspace(0, 2 * math.pi, 90)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for _ in range(50):
        core = np.array(conflict_core(square(0.5).core, wild_shape(rng).core))
        ways = np.concatenate([rng.uniform(-3, 3, (36, 2)), [[0, 0], [2, 0], [0, -1], [-1, 1]]])
        for way, outline in zip(ways, swept(core, ways), strict=True):
            along = np.maximum((directions * way).sum(axis=1), 0.0)
            assert support(outline, directions) == pytest.approx(support(core, directions) + along, abs=1e-12)
            edges = np.roll(outline, -1, axis=0) - outline
            edges = edges[np.hypot(edges[:, 0], edges[:, 1]) > 1e-12]
            after = np.roll(edges, -1, axis=0)
            assert np.all(edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0] > -1e-12)
