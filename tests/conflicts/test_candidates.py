"""Who can meet whom."""

from __future__ import annotations

import numpy as np

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.model.path import Path, straight


def test_every_pair_that_comes_near_is_a_candidate(wild_path):
    """12 scenes of 14 robots of different sizes, all pairs compared at 200 x 200 places: none is missing."""
    rng = np.random.default_rng(1)
    near_pairs = far_pairs = 0
    for _ in range(12):
        paths = []
        for _ in range(12):
            path, shift = wild_path(rng), rng.uniform(-11, 11, 2)
            paths.append(Path((path.start[0] + shift[0], path.start[1] + shift[1], path.start[2]), path.pieces))
        paths += [straight((3, 3), (3, 3)), straight((-12, -10), (12, 10))]
        reaches = rng.uniform(0.1, 0.8, len(paths)).tolist()
        found = set(candidate_pairs([chords(path) for path in paths], reaches))
        at = [path.point(np.linspace(0, path.length, 200)) for path in paths]
        for i in range(len(paths)):
            for k in range(i + 1, len(paths)):
                gap = at[i][:, None] - at[k][None]
                if np.hypot(gap[..., 0], gap[..., 1]).min() < reaches[i] + reaches[k]:
                    near_pairs += 1
                    assert (i, k) in found
                else:
                    far_pairs += (i, k) not in found
    assert near_pairs > 60
    assert far_pairs > 300


def test_pairs_come_once_in_ascending_order():
    """The smaller index first; nobody meets itself, though its own chunks touch."""
    lines = [straight((0, k / 10), (30, k / 10)) for k in range(5)]
    assert candidate_pairs([chords(line) for line in lines], [0.2] * 5) == [
        (i, k) for i in range(5) for k in range(i + 1, 5)
    ]


def test_a_robot_alone_meets_nobody():
    """No pairs with one robot."""
    assert candidate_pairs([chords(straight((0, 0), (30, 0)))], [0.3]) == []


def test_a_long_diagonal_does_not_meet_all_that_lies_in_its_box():
    """Its chunks are compared, not the box of the whole: of 100 resting robots only those near the line remain."""
    places = [(3.0 * i + 1, 3.0 * k + 1) for i in range(10) for k in range(10)]
    paths = [straight((0, 0), (30, 30)), *(straight(place, place) for place in places)]
    found = candidate_pairs([chords(path) for path in paths], [0.3] * 101)
    assert 10 <= len(found) <= 30
