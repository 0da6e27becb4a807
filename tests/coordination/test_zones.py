"""Zones: where each of two robots must not be while the other is in its own stretch, and who owns one from the start."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.coordination.blocking import find_blocks, reaches_of
from coord.coordination.scene import scene_of
from coord.coordination.zones import zones_of
from coord.model.footprint import Footprint
from coord.model.path import straight
from coord.model.robot import Limits, Robot
from coord.timing.ego import ego

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)

#: [m] How near the centres may come: two radii of 0.3 m and the clearance.
APART = 0.65


def zones(*ends, stay=True):
    """The zones of robots on straight lines between these starts and goals."""
    robots = [Robot(f"r{k}", Footprint(0.3), LIMITS, *pair) for k, pair in enumerate(ends)]
    paths = [straight(*pair) for pair in ends]
    reaches = reaches_of(robots, 0.05)
    pairs = list(candidate_pairs([chords(path) for path in paths], reaches))
    blocks = find_blocks(robots, paths, pairs, 0.05, stay=stay)
    scene = scene_of([ego(one, path) for one, path in zip(robots, paths, strict=True)], reaches, blocks, 0.05)
    return zones_of(scene)


def test_of_two_lines_at_right_angles_a_zone_is_the_distance_to_keep_before_and_behind():
    """On each of the paths, and at first it is nobody's."""
    (zone,) = zones([(-4.0, 0.0), (6.0, 0.0)], [(0.0, -5.0), (0.0, 5.0)])
    assert zone.owner is None
    assert not zone.is_open_to(0)
    assert (zone.begins(0), zone.ends(0)) == pytest.approx((4 - APART, 4 + APART), abs=1e-3)
    assert (zone.begins(1), zone.ends(1)) == pytest.approx((5 - APART, 5 + APART), abs=1e-3)
    assert (zone.other(0), zone.other(1)) == (1, 0)


@pytest.mark.parametrize("slant", [0.3, 1.0, 2.5])
def test_outside_the_stretches_two_robots_are_far_enough_apart(slant):
    """Whenever one of the two is outside its own stretch, wherever the other is."""
    far = (8 * np.cos(slant), 8 * np.sin(slant))
    lines = [(-9.0, 0.0), (9.0, 0.0)], [(-far[0], -far[1]), (float(far[0]), float(far[1]))]
    (zone,) = zones(*lines)
    s = np.linspace(0, 18, 400), np.linspace(0, 16, 400)
    places = [straight(*line).point(along) for line, along in zip(lines, s, strict=True)]
    gap = np.hypot(*(places[0][:, None] - places[1][None]).transpose(2, 0, 1))
    inside = [(zone.begins(i) < s[i]) & (s[i] < zone.ends(i)) for i in range(2)]
    assert np.all(gap[~(inside[0][:, None] & inside[1][None])] >= APART)


def test_who_starts_on_the_others_way_owns_the_zone():
    """Whichever of the two it is in the file."""
    crosses, starts = [(-4.0, 0.0), (6.0, 0.0)], [(0.0, 0.0), (0.0, 5.0)]
    for k, ends in enumerate([(starts, crosses), (crosses, starts)]):
        (zone,) = zones(*ends)
        assert zone.owner == k
        assert zone.begins(k) == -np.inf < zone.begins(1 - k)
        assert zone.ends(k) == pytest.approx(APART, abs=1e-3)


@pytest.mark.parametrize("stay", [True, False])
def test_who_ends_on_the_others_way_never_leaves_the_zone_unless_it_vanishes(stay):
    """Parked there it stays for ever; if robots leave on arrival the stretch ends at the goal."""
    crosses, ends_there = [(-4.0, 0.0), (6.0, 0.0)], [(0.0, -5.0), (0.0, 0.0)]
    for k, ends in enumerate([(ends_there, crosses), (crosses, ends_there)]):
        (zone,) = zones(*ends, stay=stay)
        assert zone.parks(k) is stay
        assert zone.ends(k) == (np.inf if stay else 5.0)
        assert not zone.parks(1 - k)


def test_robots_that_do_not_come_near_each_other_have_no_zone():
    """Parallel lines just far enough apart."""
    assert zones([(-4.0, 0.0), (6.0, 0.0)], [(-4.0, 0.66), (6.0, 0.66)]) == []
