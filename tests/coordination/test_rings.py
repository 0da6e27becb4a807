"""Rings of the blocking graph, against the definition."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.coordination.blocking import Block
from coord.coordination.rings import cycle_through, rings


def blocks_of(pairs):
    """Blocks by their first and their then: alternately of starts and of goals, so that both drive."""
    return [
        Block(first, then, "start") if k % 2 else Block(then, first, "goal") for k, (first, then) in enumerate(pairs)
    ]


@st.composite
def graphs(draw):
    """Up to eight robots and some blocks between them."""
    count = draw(st.integers(1, 8))
    robots = st.integers(0, count - 1)
    pairs = draw(st.lists(st.tuples(robots, robots), max_size=16))
    return count, [(first, then) for first, then in pairs if first != then]


def reachable(count, pairs):
    """Whether a chain of blocks leads from one robot to another, (count, count), by squaring."""
    reach = np.eye(count, dtype=int)
    for first, then in pairs:
        reach[first, then] = 1
    for _ in range(4):
        reach = np.minimum(reach @ reach, 1)
    return reach.astype(bool)


@settings(deadline=None, derandomize=True, max_examples=300)
@given(graphs())
def test_a_ring_is_all_robots_that_chains_of_blocks_lead_to_and_back_from(graph):
    """Two robots are in one ring exactly if chains lead both ways; nobody else is in any; ascending."""
    count, pairs = graph
    reach = reachable(count, pairs)
    together = reach & reach.T
    expected = {tuple(np.flatnonzero(row).tolist()) for row in together if row.sum() > 1}
    found = rings(range(count), blocks_of(pairs))
    assert found == [list(ring) for ring in sorted(expected)]


@settings(deadline=None, derandomize=True, max_examples=100)
@given(graphs(), st.sets(st.integers(0, 7)))
def test_robots_that_are_left_out_join_no_ring(graph, left_out):
    """The rings of some robots are those of the graph of their blocks alone."""
    count, pairs = graph
    members = set(range(count)) - left_out
    among = [pair for pair in pairs if set(pair) <= members]
    assert rings(members, blocks_of(pairs)) == rings(range(count), blocks_of(among))


@settings(deadline=None, derandomize=True, max_examples=200)
@given(graphs())
def test_a_cycle_through_a_robot_is_a_shortest_one(graph):
    """It closes, passes the robot, and no sequence of fewer robots closes; there is one exactly for those in rings."""
    count, pairs = graph
    blocks, known = blocks_of(pairs), set(pairs)
    in_rings = {i for ring in rings(range(count), blocks) for i in ring}
    for member in range(min(count, 3)):
        found = cycle_through(member, blocks)
        assert bool(found) == (member in in_rings)
        if not found:
            continue
        assert found[0].first == found[-1].then == member
        assert all(one.then == two.first for one, two in itertools.pairwise(found))
        others = [i for i in range(count) if i != member]
        for size in range(1, min(len(found) - 1, 4)):
            for way in itertools.permutations(others, size):
                assert not all(pair in known for pair in itertools.pairwise((member, *way, member)))


def test_a_ring_of_ten_thousand_is_one():
    """Longer than Python's own stack."""
    count = 10_000
    around = [(k, (k + 1) % count) for k in range(count)]
    assert rings(range(count), blocks_of(around)) == [list(range(count))]
    assert rings(range(count), blocks_of(around[:-1])) == []
