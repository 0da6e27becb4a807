"""What is truly forbidden: nothing in it is allowed, and little is left out."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.inner import inner_regions


@pytest.mark.parametrize("kinds", [("line",), ("arc",), ("clothoid",), ("line", "arc", "clothoid")], ids="-".join)
def test_every_place_of_an_inner_region_is_too_close(wild_pairs, regions, forbidden, kinds):
    """60 pairs of random paths, 60,000 places each: all inside are too close, and more than 98 % of the truth is inside."""
    must = does = 0
    for ego, other, reach, s, sigma, gaps in wild_pairs(1, 60, kinds):
        close = gaps < reach
        parts = [part for region in regions(ego, other, reach) for part in inner_regions(region, ego.length)]
        inside = forbidden(parts, s, sigma)
        assert not np.any(inside & ~close)
        must, does = must + close.sum(), does + inside.sum()
    assert does > 0.98 * must > 0


def test_for_polygons_too_every_place_is_too_close(wild_path, wild_shape, shape_regions, gaps, forbidden):
    """60 pairs of discs, squares and other polygons: all inside are too close, and more than 95 % of the truth is inside."""
    rng = np.random.default_rng(2)
    must = does = 0
    for _ in range(60):
        ego, other, shapes = wild_path(rng), wild_path(rng), (wild_shape(rng), wild_shape(rng))
        clearance = rng.choice([0.05, 0.2])
        s, sigma = np.linspace(0, ego.length, 80), np.linspace(0, other.length, 90)
        close = gaps(ego, other, s, sigma, shapes) < clearance
        found = shape_regions(ego, other, shapes, clearance)
        inside = forbidden([part for region in found for part in inner_regions(region, ego.length)], s, sigma)
        assert not np.any(inside & ~close)
        must, does = must + close.sum(), does + inside.sum()
    assert does > 0.95 * must > 0


def test_the_parts_are_connected_along_egos_way(wild_path, regions):
    """Neighbouring cells of a part have more than a point in common between start and goal."""
    rng = np.random.default_rng(3)
    seen = 0
    for _ in range(60):
        ego, other, reach = wild_path(rng), wild_path(rng), rng.uniform(0.2, 1.2)
        for region in regions(ego, other, reach):
            for part in inner_regions(region, ego.length):
                low = np.maximum(np.maximum(part.low[:-1, 1], part.low[1:, 0]), 0.0)
                high = np.minimum(np.minimum(part.high[:-1, 1], part.high[1:, 0]), ego.length)
                assert np.all(low < high)
                seen += len(low)
    assert seen > 100
