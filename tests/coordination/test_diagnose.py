"""Sentences that say why there is no plan."""

from __future__ import annotations

from coord.coordination import diagnose
from coord.model.result import BlockingArc


def test_a_cycle_is_told_with_every_robot_and_every_place():
    """Names in quotes, where who stands or would park, and what to move."""
    arcs = [BlockingArc("red", "blue", "start", (1.0, 2.0)), BlockingArc("blue", "red", "goal", (3.0, 4.5))]
    told = diagnose.cycle(arcs)
    assert told.code == "blocking-cycle"
    assert set(told.robots) == {"red", "blue"}
    for part in ('"red"', '"blue"', "(1.00, 2.00)", "(3.00, 4.50)"):
        assert part in told.text
    assert told.place in {(1.0, 2.0), (3.0, 4.5)}
    assert told.remedy


def test_the_reason_why_an_arc_stays_stands_behind_it():
    """One reason an arc, in brackets; none where there is none."""
    arcs = [BlockingArc("red", "blue", "start", (1.0, 2.0)), BlockingArc("blue", "red", "goal", (3.0, 4.5))]
    told = diagnose.cycle(arcs, [diagnose.handed_over("blue", "goal"), ""])
    assert 'can pass there (no way round: the goal of "blue" is there), and' in told.text
    assert "parks there, at its goal. Each" in told.text


def test_a_rerouted_robot_is_told_with_places_ring_and_seconds():
    """Who, round whom, at what cost, and who is in the ring."""
    told = diagnose.rerouted("red", [("blue", "start"), ("green", "goal")], ["blue", "green"], 1.234)
    for part in ('"red" goes round "blue" at its start and "green" at its goal, 1.23 s more alone', "ring"):
        assert part in told
    assert "no time" in diagnose.rerouted("red", [("blue", "start")], ["blue"], 0.001)


def test_long_lists_are_cut():
    """Of 30 robots four are named, and how many more there are."""
    names = [f"robot {k}" for k in range(30)]
    told = diagnose.rerouted("red", [("blue", "start")], names, 1.0)
    assert '"robot 3" and 26 more would' in told
    assert "robot 4" not in told
