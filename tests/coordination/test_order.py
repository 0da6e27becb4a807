"""The order of planning, against all orders there are."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.coordination.order import shortest_cycle, topological_order, urgency
from coord.model.result import BlockingArc

NAMES = [f"r{k}" for k in range(1, 11)]


def arcs_of(pairs):
    return [BlockingArc(first, then, "start", (0.0, 0.0)) for first, then in pairs]


@st.composite
def graphs(draw, most):
    """Names, an urgency of all of them, and some arcs, possibly with cycles."""
    names = NAMES[: draw(st.integers(1, most))]
    pairs = draw(st.lists(st.tuples(st.sampled_from(names), st.sampled_from(names)), max_size=2 * most))
    urgent = draw(st.permutations(range(len(names))))
    return names, urgent, [(first, then) for first, then in pairs if first != then]


def all_orders(names, pairs):
    """Every order that respects all arcs, by trying all."""
    for order in itertools.permutations(range(len(names))):
        at = {names[i]: position for position, i in enumerate(order)}
        if all(at[first] < at[then] for first, then in pairs):
            yield list(order)


@settings(deadline=None, derandomize=True, max_examples=150)
@given(graphs(5))
def test_the_order_puts_the_least_urgent_last_wherever_the_arcs_allow(graph):
    """Of all orders that respect the arcs it is the one whose last robot is least urgent, then the last but one, and so on."""
    names, urgent, pairs = graph
    rank = {robot: position for position, robot in enumerate(urgent)}
    allowed = list(all_orders(names, pairs))
    found = topological_order(urgent, names, arcs_of(pairs))
    if not allowed:
        assert found is None
    else:
        assert found == max(allowed, key=lambda order: [rank[i] for i in reversed(order)])


@settings(deadline=None, derandomize=True, max_examples=100)
@given(graphs(10))
def test_every_arc_is_respected_and_nobody_is_left_out(graph):
    """An order of all robots with every first before its then; or none, and then there is a cycle."""
    names, urgent, pairs = graph
    found = topological_order(urgent, names, arcs_of(pairs))
    if found is None:
        assert shortest_cycle(names, arcs_of(pairs))
    else:
        assert sorted(found) == list(range(len(names)))
        at = {names[i]: position for position, i in enumerate(found)}
        assert all(at[first] < at[then] for first, then in pairs)
        assert not shortest_cycle(names, arcs_of(pairs))


@settings(deadline=None, derandomize=True, max_examples=50)
@given(st.permutations(range(10)))
def test_without_arcs_the_most_urgent_goes_first(urgent):
    """The order is the urgency itself."""
    assert topological_order(urgent, NAMES, []) == list(urgent)


def test_one_arc_moves_one_robot():
    """Ten robots of which the tenth must go before the first: 10, 1, 2, ..., 9, and nobody else gives way."""
    found = topological_order(range(10), NAMES, arcs_of([("r10", "r1")]))
    assert found == [9, 0, 1, 2, 3, 4, 5, 6, 7, 8]


def test_the_order_of_the_arcs_does_not_matter():
    """Nor does an arc that is given twice."""
    pairs = [("r4", "r1"), ("r9", "r4"), ("r2", "r7"), ("r9", "r2"), ("r8", "r3")]
    expected = topological_order(range(10), NAMES, arcs_of(pairs))
    for shuffled in itertools.permutations(pairs):
        assert topological_order(range(10), NAMES, arcs_of([*shuffled, shuffled[0]])) == expected


@settings(deadline=None, derandomize=True, max_examples=150)
@given(graphs(6))
def test_the_shortest_cycle_is_one_and_there_is_no_shorter(graph):
    """Each arc begins where the one before ends, the last ends where the first begins, no robot twice; by trying all lengths."""
    names, _, pairs = graph
    found = shortest_cycle(names, arcs_of(pairs))
    known = set(pairs)
    lengths = [
        count
        for count in range(2, len(names) + 1)
        if any(
            all(pair in known for pair in itertools.pairwise((*loop, loop[0])))
            for loop in itertools.permutations(names, count)
        )
    ]
    assert len(found) == min(lengths, default=0)
    if found:
        assert all((arc.first, arc.then) in known for arc in found)
        assert all(one.then == two.first for one, two in itertools.pairwise([*found, found[0]]))
        assert len({arc.first for arc in found}) == len(found)


@pytest.mark.parametrize(
    ("priorities", "alone", "expected"),
    [
        ([None, None, None], [5.0, 9.0, 7.0], [1, 2, 0]),
        ([2.0, 1.0, 3.0], [9.0, 1.0, 5.0], [1, 0, 2]),
        ([None, 5.0, None, -1.0], [9.0, 1.0, 10.0, 1.0], [3, 1, 2, 0]),
        ([1.0, 1.0, 1.0], [1.0, 9.0, 5.0], [0, 1, 2]),
        ([None, None, None], [4.0, 4.0, 4.0], [0, 1, 2]),
    ],
    ids=["longest first", "by priority", "without one last", "ties as given", "equally long as given"],
)
def test_urgency_is_priority_then_the_longest_way_then_the_file(priorities, alone, expected):
    """Smaller numbers first; robots without a number come after all that have one."""
    assert urgency(priorities, alone) == expected
