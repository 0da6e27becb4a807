"""Who must go before whom."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.coordination.blocking import blocking_arcs
from coord.model.footprint import Footprint
from coord.model.path import straight
from coord.model.robot import Limits, Robot

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def arcs(*ways, radius=0.3, clearance=0.05):
    """Arcs (first, then, at) between robots 0, 1, ... that drive straight."""
    robots = [Robot(str(k), Footprint(radius), LIMITS, *way) for k, way in enumerate(ways)]
    paths = [straight(*way) for way in ways]
    pairs = candidate_pairs([chords(path) for path in paths], [radius + clearance / 2] * len(paths))
    return [(arc.first, arc.then, arc.at) for arc in blocking_arcs(robots, paths, pairs, clearance)]


WAY = ((0.0, 0.0), (10.0, 0.0))


@pytest.mark.parametrize("side", [1, -1])
def test_a_start_beside_the_way_blocks_only_if_nearer_than_the_distance(side):
    """At exactly two radii and the clearance it does not, 2e-9 m nearer it does."""
    touching = side * 0.65
    assert arcs(WAY, ((5.0, touching), (5.0, side * 9.0))) == []
    assert arcs(WAY, ((5.0, touching - side * 2e-9), (5.0, side * 9.0))) == [("1", "0", "start")]


@pytest.mark.parametrize("side", [1, -1])
def test_a_goal_beside_the_way_blocks_only_if_nearer_than_the_distance(side):
    """Whoever parks there must come later than the one who drives past."""
    touching = side * 0.65
    assert arcs(WAY, ((5.0, side * 9.0), (5.0, touching))) == []
    assert arcs(WAY, ((5.0, side * 9.0), (5.0, touching - side * 2e-9))) == [("0", "1", "goal")]


def test_a_robot_that_never_moves_blocks_by_start_and_goal():
    """It would have to leave first and to come last: with one that must drive over it, that is a cycle."""
    assert sorted(arcs(WAY, ((5.0, 0.2), (5.0, 0.2)))) == [("0", "1", "goal"), ("1", "0", "start")]


def test_swapping_places_blocks_each_other():
    """Both starts and both goals lie on the other's way."""
    found = arcs(WAY, ((10.0, 0.0), (0.0, 0.0)))
    assert {(first, then) for first, then, _ in found} == {("0", "1"), ("1", "0")}


def test_a_convoy_blocks_from_the_front():
    """Whoever is ahead on the line leaves first; the goals order the same way."""
    found = arcs(((4.0, 0.0), (14.0, 0.0)), ((2.0, 0.0), (12.0, 0.0)), ((0.0, 0.0), (10.0, 0.0)))
    assert {(first, then) for first, then, _ in found} == {("0", "1"), ("0", "2"), ("1", "2")}


def test_crossings_block_nobody():
    """Ways that cross away from starts and goals have no arcs."""
    assert arcs(WAY, ((5.0, -5.0), (5.0, 5.0)), ((3.0, 5.0), (7.0, -5.0))) == []


def test_arcs_are_those_of_sampled_distances():
    """40 scenes of 8 robots: the same arcs as by 3,000 places of each path."""
    rng = np.random.default_rng(1)
    count = 0
    for _ in range(40):
        ways = [tuple(map(tuple, rng.uniform(0, 9, (2, 2)).tolist())) for _ in range(8)]
        found = set(arcs(*ways))
        for i, (start, goal) in enumerate(ways):
            for k, way in enumerate(ways):
                if i == k:
                    continue
                at = straight(*way).point(np.linspace(0, 20, 3000))
                for place, arc in ((start, (str(i), str(k), "start")), (goal, (str(k), str(i), "goal"))):
                    least = np.hypot(*(at - place).T).min()
                    if abs(least - 0.65) > 1e-4:
                        assert (arc in found) == (least < 0.65)
                        count += least < 0.65
    assert count > 100
