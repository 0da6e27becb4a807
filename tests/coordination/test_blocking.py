"""Who must go before whom."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.coordination.blocking import Block, blocking_arcs, find_blocks, is_blocked, whose_place
from coord.model.footprint import Footprint, square
from coord.model.path import Path, straight
from coord.model.robot import Limits, Robot

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def arcs(*ways, shape=Footprint(0.3), clearance=0.05):  # noqa: B008 - a frozen value
    """Arcs (first, then, at) between robots 0, 1, ... that drive straight."""
    robots = [Robot(str(k), shape, LIMITS, *way) for k, way in enumerate(ways)]
    paths = [straight(*way) for way in ways]
    pairs = candidate_pairs([chords(path) for path in paths], [shape.radius + clearance / 2] * len(paths))
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


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("clearance", [0.0, 0.05])
def test_squares_that_touch_the_way_of_squares_do_not_block(side, clearance):
    """A start or goal beside the way at a side and the clearance is free, 1 mm and even 2e-9 m nearer blocks."""
    shape = square(0.6)
    for gap, blocks in ((0.0, False), (2e-9, True), (1e-3, True)):
        beside = (5.0, side * (0.6 + clearance - gap))
        leaves, parks = (beside, (5.0, side * 9.0)), ((5.0, side * 9.0), beside)
        assert arcs(WAY, leaves, shape=shape, clearance=clearance) == [("1", "0", "start")] * blocks
        assert arcs(WAY, parks, shape=shape, clearance=clearance) == [("0", "1", "goal")] * blocks


def test_a_square_that_turns_blocks_as_the_disc_round_it():
    """Beside the way at a side and a bit it blocks; at the diagonal and the clearance it does not."""
    shape = square(0.6, "path")
    near, far = (5.0, 0.7), (5.0, 0.6 * 2**0.5 + 0.05 + 1e-12)
    assert arcs(WAY, (near, (5.0, 9.0)), shape=shape) == [("1", "0", "start")]
    assert arcs(WAY, (far, (5.0, 9.0)), shape=shape) == []


def test_a_disc_and_a_square_keep_the_clearance_to_its_side_and_its_corner():
    """Whichever of the two rests: 0.3 m of each, and where the way ends before the corner, the distance to it."""
    limits, disc, box = LIMITS, Footprint(0.3), square(0.6)
    for resting, driving in ((disc, box), (box, disc)):
        for gap, blocks in ((0.0, False), (-4e-9, True)):
            for place in ((5.0, 0.65 + gap), (10.3 + 0.6 * (0.35 + gap), 0.3 + 0.8 * (0.35 + gap))):
                robots = [Robot("0", driving, limits, *WAY), Robot("1", resting, limits, place, (5.0, 9.0))]
                found = blocking_arcs(robots, [straight(*WAY), straight(place, (5.0, 9.0))], [(0, 1)], 0.05)
                assert (("1", "0", "start") in [(arc.first, arc.then, arc.at) for arc in found]) == blocks


def test_the_quick_look_misses_no_block():
    """Six scenes of discs and squares on winding paths: the blocks are exactly those of the exact test of every place, pair by pair."""
    rng = np.random.default_rng(2)
    count = 0
    for _ in range(6):
        shapes = [Footprint(0.3) if rng.random() < 0.5 else square(0.5) for _ in range(6)]
        pieces = [np.column_stack([rng.uniform(0.5, 3.0, 4), rng.uniform(-1.0, 1.0, (4, 2))]) for _ in range(6)]
        paths = [Path(tuple(rng.uniform(0, 6, 3).tolist()), rows) for rows in pieces]
        robots = [
            Robot(str(k), shape, LIMITS, tuple(path.poses[0, :2].tolist()), path.end)
            for k, (shape, path) in enumerate(zip(shapes, paths, strict=True))
        ]
        pairs = [(i, k) for i in range(6) for k in range(i + 1, 6)]
        expected = [
            block
            for i, k in pairs
            for block in (Block(a, b, at) for a, b in ((i, k), (k, i)) for at in ("start", "goal"))
            if is_blocked(paths[block.driving], block, robots, 0.05)
        ]
        assert find_blocks(robots, paths, pairs, 0.05) == expected
        count += len(expected)
    assert count > 20


def test_a_block_comes_from_the_end_points_if_the_driving_robot_has_a_place_there():
    """Its start, its goal or a via point nearer than the distance; on the way between it is nobody's."""
    robots = [
        Robot("drives", Footprint(0.3), LIMITS, (0.0, 0.0), (9.0, 0.0), via=((5.0, 0.0),)),
        Robot("near the start", Footprint(0.3), LIMITS, (0.3, 0.2), (20.0, 9.0)),
        Robot("near the goal", Footprint(0.3), LIMITS, (8.6, -0.3), (20.0, 9.0)),
        Robot("near the via point", Footprint(0.3), LIMITS, (5.5, 0.3), (20.0, 9.0)),
        Robot("between", Footprint(0.3), LIMITS, (3.0, 0.0), (20.0, 9.0)),
    ]
    told = [whose_place(Block(k, 0, "start"), robots, 0.05) for k in range(1, 5)]
    assert told == ["start", "goal", "via point", ""]
