"""How a plan is to be made: the flags of the plan command and the [plan] table of a problem."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from coord.errors import InvalidValueError

#: Shapes of a path, the default first.
SHAPES: Final = ("fitted", "exponential", "taut", "follow")

_CHOICES: Final[Mapping[str, tuple[str, ...]]] = {
    "method": ("velocity", "stop", "nearest"),
    "shape": SHAPES,
    "order": ("priority",),
    "profile": ("gentle", "fastest"),
}

#: Values that the contract names and later work brings.
_LATER = {
    "method": (),
    "shape": (),
    "order": ("longest", "shortest", "heading", "random", "search"),
    "profile": (),
}


@dataclass(frozen=True, slots=True)
class Options:
    """Planning options.

    Parameters
    ----------
    method : how a collision is settled. "velocity": by priority, the later robot changes its velocity; "stop": by
        priority, the later robot stops before the conflict, waits until the other has left it, and goes on; "nearest":
        no priority, whoever is nearest to the conflict goes first and the other stops, which may jam.
    shape : "fitted": every turn as wide as pays in time; "exponential": detours along least-squares exponentials;
        "taut": the shortest way of arcs and tangents; "follow": along the edges of the obstacles.
    order : "priority": the user's priorities, else the longest alone first.
    profile : "gentle": whoever has to give way slows down in time and rolls, at a few per mille of its time;
        "fastest": each robot arrives as early as it can. Robots that stop and go ("stop", "nearest") know only this.
    time_limit : wall time [s] after which a run without a plan gives up; None for no limit.
    gap_target : None; the gap at which a search over orders would end comes with that search.
    seed : of every random draw; nothing is drawn yet.
    keep_paths : every robot keeps its quickest path, also where robots on such paths block each other in a ring.
    certify : spend the time to prove of every robot that, given those before it, it could not be much earlier: its
        lower bound is raised until it is a thousandth below its arrival, or nothing more can be proved. Only for the
        method "velocity".
    """

    method: str = "velocity"
    shape: str = "fitted"
    order: str = "priority"
    profile: str = "gentle"
    time_limit: float | None = None
    gap_target: float | None = None
    seed: int = 0
    keep_paths: bool = False
    certify: bool = False

    def __post_init__(self) -> None:
        faults = []
        for field, choices in _CHOICES.items():
            value = getattr(self, field)
            if value not in choices:
                later = "is not supported yet" if value in _LATER[field] else "is unknown"
                known = ", ".join(f'"{choice}"' for choice in choices)
                faults.append((field, f'{field} "{value}" {later}; it can be {known}'))
        limit = self.time_limit
        if limit is not None and not (math.isfinite(limit) and limit > 0):
            faults.append(("time_limit", f"time_limit must be > 0 s (got {limit:g})"))
        if self.gap_target is not None:
            faults.append(("gap_target", "gap_target is not supported yet: there is no search that it could end"))
        if self.seed < 0:
            faults.append(("seed", f"seed must be >= 0 (got {self.seed})"))
        if faults:
            raise InvalidValueError(faults)
