"""Paths on which everybody can come home: rings opened, and room to pass or to wait for those that leave together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from coord.coordination.bays import with_bays
from coord.coordination.homeward import Homeward, Untied, with_holding_places
from coord.coordination.passing_by import separated_pairs, with_room_to_pass
from coord.coordination.records import unopened
from coord.coordination.rerouting import Rerouting, without_rings
from coord.model.problem import Problem
from coord.model.result import Diagnosis
from coord.model.route import Route


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """What came of it.

    ``hopeless`` : for each group in which two robots cannot pass each other, why not; ``otherwise`` : for all groups
    of ``found.together``, in their order, what is to be said if they find no way to leave together; ``homeward`` : of
    some groups, moves that bring them home.
    """

    found: Rerouting
    hopeless: tuple[Diagnosis, ...]
    otherwise: tuple[Diagnosis, ...]
    homeward: Mapping[tuple[int, ...], Homeward] = field(default_factory=dict)


def settle(
    problem: Problem,
    quickest: Sequence[Route],
    shape: str,
    *,
    keep_paths: bool,
    done: Callable[[int, int], None],
    check_time: Callable[[], None] = lambda: None,
) -> Settled:
    """Paths for all robots, from their quickest routes; parameters as in ``without_rings``."""
    found = without_rings(problem, quickest, shape, keep_paths=keep_paths, done=done, check_time=check_time)
    untied = Untied(found)
    if found.together and not keep_paths:
        untied = with_holding_places(problem, untied, shape, check_time, only_tangled=True)
        found = with_room_to_pass(problem, untied.found, shape, check_time, untied.homeward)
        untied = with_holding_places(problem, replace(untied, found=found), shape, check_time)
        found = with_bays(problem, untied.found, shape, check_time, (*untied.homeward, *untied.fine))
    apart = separated_pairs(problem, found, untied.homeward)
    told = tuple(unopened(problem, found, apart, keep_paths=keep_paths))
    lost = {i for pair in apart for i in pair}
    hopeless = tuple(what for group, what in zip(found.together, told, strict=True) if lost & set(group))
    return Settled(found, hopeless, told, untied.homeward)
