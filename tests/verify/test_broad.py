"""The coarse search leaves out nothing that could matter."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.verify.broad import Grid, candidates, runs, sizes, slabs
from coord.verify.curve import curve
from coord.verify.motion import motion, pose

boxes = st.lists(
    st.tuples(st.floats(-20, 20), st.floats(-20, 20), st.floats(0, 9), st.floats(0, 9)).map(
        lambda b: (b[0], b[1], b[0] + b[2], b[1] + b[3])
    ),
    min_size=2,
    max_size=25,
)


def overlap(one, other):
    return one[1] <= other[3] and other[1] <= one[3] and one[2] <= other[4] and other[2] <= one[4]


@settings(max_examples=100, deadline=None, derandomize=True)
@given(found=boxes, size=st.sampled_from([0.1, 1.0, 7.0, 100.0]))
def test_a_grid_finds_every_box_that_overlaps(found, size):
    """In cells far smaller and far larger than the boxes, on both sides of 0."""
    found = [(k, *box) for k, box in enumerate(found)]
    grid = Grid(size)
    for box in found:
        assert set(grid.near(box)) == {other for other in found[: box[0]] if overlap(box, other)}
        grid.add(box)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(found=st.lists(boxes, min_size=1, max_size=4), still=boxes, size=st.sampled_from([1.0, 7.0]))
def test_all_pairs_of_movers_and_all_rests_are_found_slab_by_slab(found, still, size):
    """Exactly those whose boxes overlap, with every slab in which they do."""
    slabs_of = [(n, [(k, *box) for k, box in enumerate(part)]) for n, part in enumerate(found)]
    still = [(k, *box) for k, box in enumerate(still)]
    result = candidates(slabs_of, [0.0] * 25, still, size, 10**6)
    pairs, passings = {}, {}
    for n, part in slabs_of:
        for one in part:
            for other in part[: one[0]]:
                if overlap(one, other):
                    pairs.setdefault((other[0], one[0]), []).append(n)
            for other in still:
                if overlap(one, other):
                    passings.setdefault((one[0], other[0]), []).append(n)
    assert (result.meetings, result.passings, result.crowded) == (pairs, passings, False)


def test_too_many_pairs_are_admitted():
    """A search that ends early says so."""
    crowd = [(0, [(k, 0.0, 0.0, 1.0, 1.0) for k in range(50)])]
    assert candidates(crowd, [0.0] * 50, [], 1.0, 100).crowded
    assert not candidates(crowd, [0.0] * 50, [], 1.0, 50 * 49 // 2).crowded


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    k=st.floats(-8, 8),
    more=st.floats(-8, 8),
    late=st.sampled_from([0.0, 0.7, 3.0]),
    slab=st.sampled_from([0.5, 2.0, 9.0]),
)
def test_the_boxes_of_a_slab_hold_all_of_a_motion_in_it(build, k, more, late, slab):
    """Bends that turn by half a circle and more between the ends of a slab bulge out of the box of these ends."""
    robot = build.robot("a", (1, 2), pieces=[[1.0, k, k], [1.0, more, k]], departure=late)
    profile = robot["profile"]
    path = curve(tuple(robot["path"]["start"]), robot["path"]["pieces"])
    whole = motion(path, profile["times"], profile["states"], profile["jerks"])
    seen = dict(slabs([(7, whole)], slab))
    assert min(seen) == int(late // slab)
    for i in range(401):
        t = late + (whole.arrival - late) * i / 400
        x, y, _ = pose(whole, t)
        (box,) = seen[min(int(t // slab), max(seen))]
        assert box[0] == 7
        assert box[1] <= x <= box[3]
        assert box[2] <= y <= box[4]


def test_slabs_pass_over_times_in_which_nobody_moves(build):
    """Two robots, one an hour after the other."""
    whole = []
    for late in (0.0, 3600.0):
        robot = build.robot("a", (0, 0), (3, 0), departure=late)
        profile = robot["profile"]
        path = curve((0.0, 0.0, 0.0), robot["path"]["pieces"])
        whole.append(motion(path, profile["times"], profile["states"], profile["jerks"]))
    numbers = [n for n, found in slabs(list(enumerate(whole)), 1.0) if found]
    last = math.ceil(whole[0].arrival)
    assert numbers == [*range(last), *range(3600, 3600 + last)]
    slab, cell = sizes([0.35, 0.35], whole)
    assert slab == pytest.approx(4 * 0.7 * whole[0].arrival / 3)
    assert cell > 0.7
    assert runs([1, 2, 3, 7, 9, 10]) == [(1, 3), (7, 7), (9, 10)]
