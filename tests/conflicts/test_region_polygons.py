"""Where two robots are too close whose footprints are polygons that keep their heading, or one such and a disc."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.model.footprint import Footprint, polygon, square
from coord.model.path import Path, straight

KINDS = [("line",), ("arc",), ("clothoid",), ("line", "arc", "clothoid")]


def axes(ego, other, count=160):
    return np.linspace(0, ego.length, count), np.linspace(0, other.length, count + 7)


@pytest.mark.parametrize("kinds", KINDS, ids="-".join)
def test_no_place_where_two_robots_are_too_close_is_left_out(
    wild_path, wild_shape, shape_regions, gaps, forbidden, kinds
):
    """40 pairs of random paths and shapes: of 27,000 places in each plane none whose bodies are too near is allowed."""
    rng = np.random.default_rng(1)
    met = 0
    for _ in range(40):
        ego, other = wild_path(rng, kinds), wild_path(rng, kinds)
        shapes, clearance = (wild_shape(rng), wild_shape(rng)), rng.choice([0.0, 0.05, 0.4])
        s, sigma = axes(ego, other)
        gap = gaps(ego, other, s, sigma, shapes)
        close = (gap < clearance - 1e-9) | (gap == 0)
        assert np.all(forbidden(shape_regions(ego, other, shapes, clearance), s, sigma)[close])
        met += close.any()
    assert met >= 10


@pytest.mark.parametrize(("kinds", "share"), [(("line",), 2e-3), (("arc",), 1e-2), (("clothoid",), 1e-2)])
def test_little_more_is_forbidden_than_must_be(wild_path, wild_shape, shape_regions, gaps, forbidden, kinds, share):
    """Over 40 pairs together the regions are less than 1 % larger than the truth, those of lines less than 0.2 %."""
    rng = np.random.default_rng(2)
    must = does = 0
    for _ in range(40):
        ego, other = wild_path(rng, kinds), wild_path(rng, kinds)
        shapes, clearance = (wild_shape(rng), wild_shape(rng)), rng.choice([0.05, 0.4])
        s, sigma = axes(ego, other)
        must += (gaps(ego, other, s, sigma, shapes) < clearance).sum()
        does += forbidden(shape_regions(ego, other, shapes, clearance), s, sigma).sum()
    assert must <= does < (1 + share) * must


def test_on_lines_nothing_is_forbidden_that_keeps_a_few_millimetres_more(
    wild_path, wild_shape, shape_regions, gaps, forbidden
):
    """100 pairs of lines: whatever is forbidden is nearer than the clearance and 3 mm, at steep ends too."""
    rng = np.random.default_rng(3)
    met = 0
    for _ in range(100):
        ego, other = wild_path(rng, ("line",)), wild_path(rng, ("line",))
        shapes, clearance = (square(0.6), wild_shape(rng)), rng.choice([0.0, 0.05, 0.4])
        s, sigma = axes(ego, other)
        taken = forbidden(shape_regions(ego, other, shapes, clearance), s, sigma)
        far = gaps(ego, other, s, sigma, shapes)[1:-1, 1:-1][taken[1:-1, 1:-1]]
        assert np.all(far < clearance + 3e-3)
        met += taken.any()
    assert met >= 30


@pytest.mark.parametrize("clearance", [0.0, 0.05, 0.4])
def test_squares_that_cross_at_a_right_angle_give_a_rounded_square(shape_regions, clearance):
    """Its straight sides lie at half of both sides and the clearance from the crossing, exactly, its corners are round."""
    ego, other = straight((0, 0), (20, 0)), straight((10, -8), (10, 8))
    (region,) = shape_regions(ego, other, (square(0.6), square(0.8)), clearance)
    assert region.s_range == pytest.approx((10 - 0.7 - clearance, 10 + 0.7 + clearance), abs=1e-3)
    assert region.sigma[[0, -1]] == pytest.approx((8 - 0.7 - clearance, 8 + 0.7 + clearance), abs=2e-6)
    inner = np.abs(region.sigma - 8) <= 0.7
    assert region.low[inner[:-1] & inner[1:]] == pytest.approx(10 - 0.7 - clearance, abs=2e-6)
    round_off = clearance * math.sqrt(0.5)
    at_corner = np.interp(8 + 0.7 + round_off, region.sigma, [*region.high[:, 0], region.high[-1, 1]])
    assert 10 + 0.7 + round_off <= at_corner + 2e-3
    assert at_corner <= 10 + 0.7 + round_off + 5e-3


def test_a_square_and_a_disc_keep_the_radius_round_the_square(shape_regions):
    """Half a side, the radius and the clearance along the axes."""
    ego, other = straight((0, 0), (20, 0)), straight((10, -8), (10, 8))
    for shapes in ((square(0.6), Footprint(0.25)), (Footprint(0.25), square(0.6))):
        (region,) = shape_regions(ego, other, shapes, 0.05)
        assert region.s_range == pytest.approx((9.4, 10.6), abs=1e-3)
        assert region.sigma[[0, -1]] == pytest.approx((7.4, 8.6), abs=2e-6)


@pytest.mark.parametrize(
    ("direction", "length"),
    [((1, 0), 1.3), ((0, -1), 1.3), ((2, 1), 1.3 * math.sqrt(1.25)), ((1, 1), 1.2 * 2**0.5 + 0.1)],
)
def test_squares_that_follow_each_other_keep_a_band(shape_regions, direction, length):
    """Sides of 1.2 m and 0.1 m between them, along the way: more where the squares drive slantwise, most on corners."""
    dx, dy = np.array(direction) / math.hypot(*direction)
    ego, other = straight((0, 0), (20 * dx, 20 * dy)), straight((3 * dx, 3 * dy), (17 * dx, 17 * dy))
    (region,) = shape_regions(ego, other, (square(1.2), square(1.2)), 0.1)
    assert region.sigma[[0, -1]] == pytest.approx((0.0, 14.0), abs=1e-12)
    inside = slice(2, -2)
    ahead = (np.stack([region.sigma[:-1], region.sigma[1:]], axis=1) + 3)[inside]
    assert region.low[inside] == pytest.approx(ahead - length, abs=5e-6)
    assert region.high[inside] == pytest.approx(np.minimum(ahead + length, 20), abs=5e-6)


@pytest.mark.parametrize(("gap", "meet"), [(0.0, False), (0.1, False), (-1e-5, True)])
@pytest.mark.parametrize("clearance", [0.0, 0.05])
def test_squares_side_by_side_meet_only_if_nearer_than_the_clearance(shape_regions, gap, meet, clearance):
    """Parallel ways at a side and the clearance apart are free, although the discs round the squares would overlap."""
    apart = 0.6 + clearance + gap
    ego, other = straight((0, 0), (20, 0)), straight((0, apart), (20, apart))
    assert bool(shape_regions(ego, other, (square(0.6), square(0.6)), clearance)) == meet


def test_robots_that_never_move_give_one_row_or_one_column(shape_regions):
    """A resting square forbids what lies within both half sides of it; a resting ego its only arc length 0."""
    way, place, shapes = straight((0, 0), (20, 0)), straight((7, 0.3), (7, 0.3)), (square(0.6), square(0.4))
    (region,) = shape_regions(way, place, shapes, 0.1)
    assert region.sigma.tolist() == [0.0, 0.0]
    assert region.s_range == pytest.approx((7 - 0.6, 7 + 0.6), abs=2e-6)
    (region,) = shape_regions(place, way, shapes, 0.1)
    assert region.sigma[[0, -1]] == pytest.approx((7 - 0.6, 7 + 0.6), abs=2e-6)
    assert np.all(region.low < 0)
    assert np.all(region.high > 0)
    beside = straight((7, 0.61), (7, 0.61))
    assert shape_regions(way, beside, shapes, 0.1) == ()
    assert shape_regions(beside, way, shapes, 0.1) == ()


def test_a_polygon_of_many_corners_is_a_disc(wild_path, shape_regions, forbidden, regular):
    """With 64 corners its region lies between those of the discs inside and around it, but for 1 % at their cells."""
    rng = np.random.default_rng(4)
    seen = 0
    for _ in range(40):
        ego, other = wild_path(rng, ("line", "arc")), wild_path(rng, ("line", "arc"))
        radius, theirs = rng.uniform(0.2, 0.6), Footprint(rng.uniform(0.2, 0.5))
        shapes = (Footprint(radius * math.cos(math.pi / 64)), regular(64, radius), Footprint(radius))
        s, sigma = axes(ego, other)
        least, many, most = (forbidden(shape_regions(ego, other, (one, theirs), 0.05), s, sigma) for one in shapes)
        assert (least & ~many).sum() <= 1e-2 * least.sum()
        assert (many & ~most).sum() <= 1e-2 * many.sum()
        seen += many.sum()
    assert seen > 10000


def turned(path, shape, turn, mirror):
    """A path and a footprint in a world that is turned, and mirrored at the x axis before."""
    c, s = math.cos(turn), math.sin(turn)
    x, y, heading = path.start
    way = Path(
        (c * x - s * mirror * y, s * x + c * mirror * y, mirror * heading + turn), path.pieces * [1, mirror, mirror]
    )
    corners = [(c * x - s * mirror * y, s * x + c * mirror * y) for x, y in shape.vertices]
    return way, polygon(corners, "fixed") if corners else shape


@pytest.mark.parametrize(("turn", "mirror"), [(0.0, -1), (math.pi / 2, 1), (2.345, 1), (-0.8, -1)])
def test_turning_and_mirroring_the_world_changes_no_region(
    wild_path, wild_shape, shape_regions, forbidden, turn, mirror
):
    """Paths and footprints together: the same extents to 1e-6 m, the same places but for 0.5 % at the edges of cells."""
    rng = np.random.default_rng(5)
    same = differs = 0
    for _ in range(40):
        paths, shapes = (wild_path(rng), wild_path(rng)), (wild_shape(rng), wild_shape(rng))
        other_paths, other_shapes = zip(
            *(turned(*both, turn, mirror) for both in zip(paths, shapes, strict=True)), strict=True
        )
        one, two = shape_regions(*paths, shapes, 0.05), shape_regions(*other_paths, other_shapes, 0.05)
        assert [r.sigma[-1] for r in one] == pytest.approx([r.sigma[-1] for r in two], abs=1e-6)
        s, sigma = axes(*paths)
        first, second = forbidden(one, s, sigma), forbidden(two, s, sigma)
        same, differs = same + (first & second).sum(), differs + (first != second).sum()
    assert same > 10000
    assert differs < 5e-3 * same


def test_exchanging_the_two_robots_transposes_the_region(wild_path, wild_shape, shape_regions, forbidden):
    """What (s, sigma) is to the one is (sigma, s) to the other; the two outer bounds differ by less than 2 %."""
    rng = np.random.default_rng(6)
    both = either = 0
    for _ in range(60):
        ego, other = wild_path(rng, ("line", "arc")), wild_path(rng, ("line", "arc"))
        shapes = wild_shape(rng), wild_shape(rng)
        s, sigma = axes(ego, other)
        one = forbidden(shape_regions(ego, other, shapes, 0.1), s, sigma)[1:-1, 1:-1]
        two = forbidden(shape_regions(other, ego, shapes[::-1], 0.1), sigma, s).T[1:-1, 1:-1]
        both, either = both + (one & two).sum(), either + (one | two).sum()
    assert 10000 < either < 1.02 * both


def test_resting_places_that_are_free_are_not_padded(wild_path, wild_shape, shape_regions, gaps, forbidden):
    """Where ego's start or goal is never in the way, not a hair of it is forbidden."""
    rng = np.random.default_rng(7)
    seen = 0
    for _ in range(80):
        ego, other = wild_path(rng, ("line", "arc")), wild_path(rng, ("line", "arc"))
        shapes, ends = (wild_shape(rng), wild_shape(rng)), np.array([0.0, ego.length])
        sigma = np.linspace(0, other.length, 1500)
        free = gaps(ego, other, ends, sigma, shapes).min(axis=1) > 0.05 + 1e-5
        taken = forbidden(shape_regions(ego, other, shapes, 0.05), ends, sigma)
        assert not taken[free].any()
        seen += free.sum()
    assert seen > 50
