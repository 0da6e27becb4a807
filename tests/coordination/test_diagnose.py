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


def test_a_robot_that_is_never_free_is_told_with_those_it_waits_for():
    """Who, whom, where."""
    told = diagnose.stuck("red", ["blue"], (1.0, 2.0))
    assert told.robots == ("red", "blue")
    assert '"red"' in told.text
    assert '"blue"' in told.text
    assert told.remedy
