"""Paths on which everybody can come home: rings opened, and room to pass or to wait for those that leave together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from coord.coordination.bays import with_bays
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
    of ``found.together``, in their order, what is to be said if they find no way to leave together.
    """

    found: Rerouting
    hopeless: tuple[Diagnosis, ...]
    otherwise: tuple[Diagnosis, ...]


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
    if found.together and not keep_paths:
        found = with_bays(problem, with_room_to_pass(problem, found, shape, check_time), shape, check_time)
    apart = separated_pairs(problem, found)
    told = tuple(unopened(problem, found, apart, keep_paths=keep_paths))
    lost = {i for pair in apart for i in pair}
    hopeless = tuple(what for group, what in zip(found.together, told, strict=True) if lost & set(group))
    return Settled(found, hopeless, told)
