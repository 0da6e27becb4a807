"""Where two robots are too close: bounds that miss nothing and take little more than they must."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.conflicts.chords import chords
from coord.conflicts.region import conflict_regions, refined
from coord.model.path import Path, straight
from coord.tolerances import REGION_MARGIN


@pytest.mark.parametrize("kinds", [("line",), ("arc",), ("clothoid",), ("line", "arc", "clothoid")], ids="-".join)
def test_no_place_where_two_robots_are_too_close_is_left_out(wild_pairs, regions, forbidden, kinds):
    """60 pairs of random paths: of 60,000 places in each coordination plane none that is too close is allowed."""
    met = 0
    for ego, other, reach, s, sigma, gaps in wild_pairs(1, 60, kinds):
        close = gaps < reach - 1e-9
        assert np.all(forbidden(regions(ego, other, reach), s, sigma)[close])
        met += close.any()
    assert met >= 10


@pytest.mark.parametrize("kinds", [("line",), ("arc",), ("clothoid",)], ids="-".join)
def test_little_more_is_forbidden_than_must_be(wild_pairs, regions, forbidden, kinds):
    """Over 60 pairs of random paths together, the regions are less than 1 % larger than the truth."""
    must = does = 0
    for ego, other, reach, s, sigma, gaps in wild_pairs(2, 60, kinds, least=0.3):
        must += (gaps < reach).sum()
        does += forbidden(regions(ego, other, reach), s, sigma).sum()
    assert must < does < 1.01 * must


def test_paths_that_cross_at_a_right_angle_give_a_disc():
    """(s - 10)^2 + (sigma - 8)^2 < reach^2 where lines cross at 10 m of the one and 8 m of the other."""
    ego, other, reach = straight((0, 0), (20, 0)), straight((10, -8), (10, 8)), 0.65
    (region,) = conflict_regions(chords(ego), chords(other), reach)
    assert region.s_range == pytest.approx((10 - reach, 10 + reach), abs=2e-5)
    assert region.sigma[[0, -1]] == pytest.approx((8 - reach, 8 + reach), abs=2e-6)
    half = np.sqrt(np.maximum((reach + REGION_MARGIN) ** 2 - (region.sigma - 8) ** 2, 0.0))
    for cells in (region.low, region.high):
        depth = np.abs(cells - 10)
        assert np.all(depth[:, 0] >= half[:-1] - 1e-9)
        assert np.all(depth[:, 1] >= half[1:] - 1e-9)
        inner = np.abs(region.sigma[:-1] - 8) < 0.6 * reach
        assert np.all(depth[inner, 0] <= half[:-1][inner] + 2e-3)


def test_paths_that_cross_at_an_angle_give_an_ellipse():
    """At 30 degrees the region reaches 1 / sin(30) = 2 reaches to both sides along either path."""
    turn, reach = math.radians(30), 0.5
    ego = straight((-10, 0), (10, 0))
    other = Path((-10 * math.cos(turn), -10 * math.sin(turn), turn), [(20.0, 0, 0)])
    (region,) = conflict_regions(chords(ego), chords(other), reach)
    assert region.s_range == pytest.approx((10 - 2 * reach, 10 + 2 * reach), abs=2e-3)
    assert region.sigma[[0, -1]] == pytest.approx((10 - 2 * reach, 10 + 2 * reach), abs=1e-5)


def test_following_on_one_line_is_a_band():
    """The robot behind must keep the distance: forbidden are all s within reach of sigma + 3, along the whole way."""
    ego, other, reach = straight((0, 0), (20, 0)), straight((3, 0), (17, 0)), 0.65
    (region,) = conflict_regions(chords(ego), chords(other), reach, start_free=True, goal_free=True)
    assert region.sigma[[0, -1]].tolist() == [0.0, 14.0]
    ahead = np.stack([region.sigma[:-1], region.sigma[1:]], axis=1) + 3
    assert region.low == pytest.approx(ahead - reach, abs=2e-6)
    assert region.high == pytest.approx(ahead + reach, abs=2e-6)


def test_cells_of_a_lane_are_made_one():
    """Along 14 m of one line bounds are straight: cells of 40 cm do there, not 5 cm."""
    ego, other = straight((0, 0), (20, 0)), straight((3, 0), (17, 0))
    (region,) = conflict_regions(chords(ego), chords(other), 0.65, start_free=True, goal_free=True)
    assert len(region.low) < 60
    assert np.diff(region.sigma).max() == pytest.approx(0.4)


@pytest.mark.parametrize("kinds", [("line",), ("line", "arc")], ids="-".join)
def test_cells_made_one_forbid_the_same(wild_path, regions, monkeypatch, kinds):
    """Of 60 pairs of random paths the bounds anywhere are those of the single cells, to a millionth of a millimetre."""
    rng, joined = np.random.default_rng(5), 0
    pairs = [(wild_path(rng, kinds), wild_path(rng, kinds), rng.uniform(0.3, 1.2)) for _ in range(60)]
    ways = ((3.0, 0, 0), (2.0, 0.6, 0.6), (3.0, 0, 0))
    pairs.append((Path((0, 0, 0), ways), Path((-1, 0.1, 0), ways), 0.5))  # behind each other along lines
    found = [regions(*pair) for pair in pairs]
    monkeypatch.setattr("coord.conflicts.region._JOINED", 1)
    for few, many in zip(found, [regions(*pair) for pair in pairs], strict=True):
        for one, other in zip(few, many, strict=True):
            joined += len(other.low) - len(one.low)
            places = (other.sigma[:-1] + other.sigma[1:]) / 2
            for bounds in ("low", "high"):
                assert _line_at(one, bounds, places) == pytest.approx(_line_at(other, bounds, places), abs=1e-9)
    assert joined > 40


def _line_at(region, bounds, sigma):
    """A bound at some places of the other's path."""
    line, cell = getattr(region, bounds), np.searchsorted(region.sigma, sigma, side="right") - 1
    share = (sigma - region.sigma[cell]) / np.diff(region.sigma)[cell]
    return line[cell, 0] + (line[cell, 1] - line[cell, 0]) * share


def test_oncoming_on_one_line_is_a_band_the_other_way():
    """Forbidden are all s within reach of 20 - sigma."""
    ego, other, reach = straight((0, 0), (20, 0)), straight((20, 0), (0, 0)), 0.65
    (region,) = conflict_regions(chords(ego), chords(other), reach)
    inside = (region.sigma[:-1] > 1.0) & (region.sigma[1:] < 19.0)
    assert inside.sum() > 20
    facing = 20 - np.stack([region.sigma[:-1], region.sigma[1:]], axis=1)
    assert region.low[inside] == pytest.approx(facing[inside] - reach, abs=2e-6)
    assert region.high[inside] == pytest.approx(facing[inside] + reach, abs=2e-6)


@pytest.mark.parametrize("gap", [0.0, 1e-5, 0.1])
def test_lines_that_keep_the_distance_have_no_region(gap):
    """Parallel lines at the reach and a margin or more apart never come too close."""
    reach = 0.65
    ego, other = straight((0, 0), (20, 0)), straight((0, reach + 2e-6 + gap), (20, reach + 2e-6 + gap))
    assert conflict_regions(chords(ego), chords(other), reach) == ()


def test_paths_that_meet_twice_have_two_regions():
    """A half circle that crosses a line twice: forbidden near both crossings, allowed in between."""
    ego = straight((-5, 0), (5, 0))
    other = Path((-3.0, -1.0, math.pi / 2), [(1.0, 0, 0), (3 * math.pi, -1 / 3, -1 / 3), (1.0, 0, 0)])
    found = conflict_regions(chords(ego), chords(other), 0.5)
    assert len(found) == 2
    ranges = sorted(region.s_range for region in found)
    assert ranges[0] == pytest.approx((1.5, 2.5), abs=0.03)
    assert ranges[1] == pytest.approx((7.5, 8.5), abs=0.03)


def test_a_robot_that_never_moves_is_one_row():
    """Forbidden is what lies within reach of it, at its only arc length; further along the line nothing is."""
    ego, other = straight((0, 0), (20, 0)), straight((7, 0.3), (7, 0.3))
    (region,) = conflict_regions(chords(ego), chords(other), 0.5)
    assert region.sigma.tolist() == [0.0, 0.0]
    assert region.s_range == pytest.approx((7 - 0.4, 7 + 0.4), abs=5e-6)


def test_an_ego_that_never_moves_is_forbidden_as_long_as_the_other_is_near():
    """Its only arc length 0 lies inside the bounds."""
    ego, other = straight((7, 0.3), (7, 0.3)), straight((0, 0), (20, 0))
    (region,) = conflict_regions(chords(ego), chords(other), 0.5)
    assert region.sigma[[0, -1]] == pytest.approx((7 - 0.4, 7 + 0.4), abs=5e-6)
    assert np.all(region.low < 0)
    assert np.all(region.high > 0)


def test_resting_places_that_are_free_are_not_padded(wild_path, regions, forbidden):
    """Where an exact test says that ego's start or goal is never in the way, not a hair of it is forbidden."""
    rng = np.random.default_rng(3)
    seen = 0
    for _ in range(150):
        ego, other, reach = wild_path(rng, ("line", "arc")), wild_path(rng, ("line", "arc")), rng.uniform(0.2, 1.2)
        free = [np.hypot(*(other.point(np.linspace(0, other.length, 3000)) - at).T).min() > reach + 1e-5 for at in
                (ego.poses[0, :2], np.array(ego.end))]  # fmt: skip
        taken = forbidden(regions(ego, other, reach), np.array([0.0, ego.length]), np.linspace(0, other.length, 500))
        for row, is_free in zip(taken, free, strict=True):
            assert not (is_free and row.any())
        seen += sum(free) if taken.size else 0
    assert seen > 100


def test_exchanging_the_two_robots_transposes_the_region(wild_path, regions, forbidden):
    """What (s, sigma) is to the one is (sigma, s) to the other; the two outer bounds differ by less than 2 %."""
    rng = np.random.default_rng(4)
    both = either = 0
    for _ in range(60):
        ego, other, reach = wild_path(rng, ("line", "arc")), wild_path(rng, ("line", "arc")), rng.uniform(0.3, 1.2)
        s, sigma = np.linspace(0, ego.length, 200)[1:-1], np.linspace(0, other.length, 200)[1:-1]
        one = forbidden(regions(ego, other, reach), s, sigma)
        two = forbidden(regions(other, ego, reach), sigma, s).T
        both, either = both + (one & two).sum(), either + (one | two).sum()
    assert 0 < either < 1.02 * both


def test_a_larger_distance_forbids_more(wild_path, regions, distances, forbidden):
    """What is forbidden with the smaller distance is so with one larger by 1 cm."""
    rng = np.random.default_rng(5)
    for _ in range(60):
        ego, other, reach = wild_path(rng, ("line", "arc")), wild_path(rng, ("line", "arc")), rng.uniform(0.3, 1.2)
        s, sigma = np.linspace(0, ego.length, 100)[1:-1], np.linspace(0, other.length, 100)[1:-1]
        less, more = (forbidden(regions(ego, other, reach + d), s, sigma) for d in (0.0, 0.01))
        assert np.all(more[less])


@pytest.mark.parametrize("kinds", [("line",), ("line", "arc", "clothoid")], ids="-".join)
def test_refined_bounds_still_miss_nothing_and_forbid_less(wild_pairs, regions, forbidden, kinds):
    """40 pairs of random paths: what is too close stays forbidden, and less than half of what is not."""
    coarse = fine = 0
    for ego, other, reach, s, sigma, gaps in wild_pairs(3, 40, kinds, places=1200):
        close = gaps < reach - 1e-9
        found = regions(ego, other, reach)
        nearer = forbidden([refined(region, 0.25) for region in found], s, sigma)
        assert np.all(nearer[close])
        coarse, fine = coarse + (forbidden(found, s, sigma) & ~close).sum(), fine + (nearer & ~close).sum()
    assert fine < 0.5 * coarse
