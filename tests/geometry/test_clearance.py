"""Does a whole path keep the distance?"""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.path import Path

BOUNDS = (0.0, 0.0, 12.0, 12.0)
OBSTACLES = [
    rectangle("r", (2.0, 2.0, 4.0, 7.0), 0.3),
    Circle("c", (8.0, 3.0), 1.0),
    Polygon("l", np.array([(6, 6), (10, 6), (10, 7), (7, 7), (7, 10), (6, 10)], float)),
]


@pytest.fixture(scope="module")
def floor():
    grown = grow(OBSTACLES, Footprint(0.4), 0.0, BOUNDS)
    return Floor(grown, grown.rho)


def least(floor, path):
    """Sampled distance, less what is kept, to parts and to the box."""
    at = path.point(np.linspace(0, path.length, 4000))
    gaps = [
        shapely.distance(part, shapely.points(at)).min() - rho
        for part, rho in zip(floor.grown.parts, floor.rho, strict=True)
    ]
    xmin, ymin, xmax, ymax = floor.grown.box
    return min(*gaps, (at - [xmin, ymin]).min(), ([xmax, ymax] - at).min())


def test_a_path_is_clear_exactly_if_all_its_points_are(floor):
    """150 paths of lines, arcs and clothoids: the same verdict as 4,000 points, except where it is about a micrometre."""
    rng = np.random.default_rng(1)
    clear = 0
    for _ in range(150):
        rows = []
        for _ in range(rng.integers(1, 5)):
            k0, k1 = rng.uniform(-1.2, 1.2, 2)
            length = rng.uniform(0.2, 2.5)
            rows.append((length, *((0, 0), (k0, k0), (k0, k1), (0, k1))[rng.integers(4)]))
        path = Path((*rng.uniform(0.5, 11.5, 2), rng.uniform(-math.pi, math.pi)), rows)
        gap = least(floor, path)
        if abs(gap) > 5e-6:
            assert keeps_distance(floor, path) == (gap > 0)
        clear += gap > 0
    assert 15 < clear < 135


@pytest.mark.parametrize("excess", [-1e-5, 1e-5])
def test_a_bend_round_a_column_is_judged_to_a_hundredth_of_a_millimetre(floor, excess):
    """An arc about the centre, a hair inside or outside the distance; a clothoid that only dips towards it likewise."""
    radius = 1.4 + excess
    arc = Path((8.0, 3.0 - radius, 0.0), [(radius * 2.5, 1 / radius, 1 / radius)])
    assert keeps_distance(floor, arc) == (excess > 0)
    dip = Path((8.0 - 1.5, 3.0 + radius, 0.0), [(1.5, 0.01, 0.0), (1.5, 0.0, 0.01)])
    lowest = least(floor, dip)
    lowered = Path((dip.start[0], dip.start[1] - lowest + excess, 0.0), dip.pieces)
    assert keeps_distance(floor, lowered) == (excess > 0)


@pytest.mark.parametrize("bulge", [1e-5, -1e-5])
def test_a_bend_may_not_leave_the_floor_between_its_ends(floor, bulge):
    """A half circle that rises to the right edge: beyond it by a hundredth of a millimetre, or short of it by as much."""
    radius = 1.0
    path = Path((11.6 + bulge - radius, 2.5, 0.0), [(math.pi * radius, 1 / radius, 1 / radius)])
    assert keeps_distance(floor, path) == (bulge < 0)
