"""Who must go before whom: the blocking graph.

A robot that rests at its start blocks everybody whose path runs over that place, until it leaves; one that
rests at its goal blocks everybody from then on. So with i's start on k's path, i is planned before k, and
with i's goal on k's path, k before i. Without a cycle every order that respects these arcs gives every robot a
finite plan, whatever plans those before it got: it can wait at its start until all of them have arrived.
"""

from __future__ import annotations

from collections.abc import Sequence

from coord.conflicts.core import conflict_core
from coord.conflicts.rest import runs_over
from coord.model.path import Path
from coord.model.result import BlockingArc
from coord.model.robot import Robot


def blocking_arcs(
    robots: Sequence[Robot], paths: Sequence[Path], pairs: Sequence[tuple[int, int]], clearance: float
) -> list[BlockingArc]:
    """All arcs between the candidate pairs, by exact tests; touching does not block."""
    arcs = []
    for i, k in pairs:
        for resting, driving in ((i, k), (k, i)):
            place, way = robots[resting].footprint, robots[driving].footprint
            distance, core = place.margin + way.margin + clearance, conflict_core(way.core, place.core)
            first, then = robots[resting].name, robots[driving].name
            if runs_over(paths[driving], robots[resting].start, distance, core) is not None:
                arcs.append(BlockingArc(first, then, "start", robots[resting].start))
            if runs_over(paths[driving], robots[resting].goal, distance, core) is not None:
                arcs.append(BlockingArc(then, first, "goal", robots[resting].goal))
    return arcs
