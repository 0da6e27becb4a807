"""How far polygons are from points, segments and arcs, against dense sampling and another library."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from coord.conflicts.apart import on_arc, on_segments, signed_distance
from coord.conflicts.core import conflict_core
from coord.model.footprint import square
from coord.model.path import Path


def some_core(rng, wild_shape):
    return np.array(conflict_core(wild_shape(rng).core, square(rng.uniform(0.2, 0.8)).core))


def test_the_signed_distance_is_that_to_the_outline(wild_shape):
    """Of 60,000 places: positive outside, negative inside, in size the distance to the outline."""
    rng = np.random.default_rng(1)
    inside = 0
    for _ in range(30):
        core = some_core(rng, wild_shape)
        z = rng.uniform(-2, 2, (2000, 2))
        points, body = shapely.points(z), shapely.Polygon(core)
        within = shapely.contains(body, points)
        truth = shapely.distance(points, body.exterior) * np.where(within, -1.0, 1.0)
        assert signed_distance(z, core) == pytest.approx(truth, abs=1e-12)
        inside += within.sum()
    assert inside > 3000


def test_segments_are_no_nearer_than_their_nearest_point(wild_shape):
    """Of 1,200 segments the least is never above 2,000 samples, at most a hair below, and really there."""
    rng = np.random.default_rng(2)
    shares = np.linspace(0, 1, 2001)[:, None, None]
    signs = set()
    for _ in range(30):
        core = some_core(rng, wild_shape)
        a, b = rng.uniform(-2, 2, (2, 40, 2))
        b[0] = a[0]
        distance, share = on_segments(a, b, core)
        sampled = signed_distance(a + (b - a) * shares, core).min(axis=0)
        assert np.all(distance <= sampled + 1e-12)
        assert np.all(distance >= sampled - np.hypot(*(b - a).T) / 4000 - 1e-12)
        assert signed_distance(a + (b - a) * share[:, None], core) == pytest.approx(distance, abs=1e-12)
        signs |= set(np.sign(distance).tolist())
    assert signs >= {-1.0, 1.0}


def test_arcs_are_no_nearer_than_their_nearest_point(wild_shape):
    """Of 600 arcs, of all sizes and up to a full turn, likewise."""
    rng = np.random.default_rng(3)
    deep = 0
    for _ in range(600):
        core = some_core(rng, wild_shape)
        curvature = rng.choice([-1, 1]) / rng.uniform(0.05, 3.0)
        length = rng.uniform(0.1, 2 * math.pi) / abs(curvature)
        pose = (*rng.uniform(-1.5, 1.5, 2).tolist(), rng.uniform(-4, 4))
        path = Path(pose, [(length, curvature, curvature)])
        distance, s = on_arc(pose, length, curvature, core)
        sampled = float(signed_distance(path.point(np.linspace(0, length, 1501)), core).min())
        assert sampled - length / 3000 - 1e-12 <= distance <= sampled + 1e-12
        assert 0 <= s <= length + 1e-12
        assert signed_distance(path.point(s), core)[0] == pytest.approx(distance, abs=1e-12)
        deep += distance < 0
    assert 100 < deep < 550


def test_an_arc_round_a_corner_keeps_its_radius():
    """All of a quarter circle round a corner of the square is as far away as its radius, to 1e-15 m."""
    core = np.array(square(1.0).core)
    distance, _ = on_arc((0.5, -0.8, 0.0), 0.15 * math.pi, 1 / 0.3, core)
    assert distance == pytest.approx(0.3, abs=1e-15)
