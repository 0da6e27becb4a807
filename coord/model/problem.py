"""A problem: a floor with obstacles, and robots that each want to go somewhere."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from coord.errors import InvalidValueError
from coord.model.obstacle import Obstacle
from coord.model.robot import Robot
from coord.model.rules import range_fault
from coord.tolerances import LARGEST_COORDINATE


@dataclass(frozen=True, slots=True)
class Workspace:
    """The floor robots move on.

    Parameters
    ----------
    bounds : xmin, ymin, xmax, ymax [m].
    clearance : smallest distance [m] kept to robots, obstacles and the edge of the workspace.
    after_arrival : "stay" (a robot rests at its goal for ever) or "leave" (it vanishes on arrival).
    """

    bounds: tuple[float, float, float, float]
    clearance: float = 0.0
    after_arrival: str = "stay"

    def __post_init__(self) -> None:
        faults = []
        xmin, ymin, xmax, ymax = self.bounds
        if not all(math.isfinite(value) for value in self.bounds) or not (xmin < xmax and ymin < ymax):
            text = "bounds are [xmin, ymin, xmax, ymax], finite, xmin < xmax and ymin < ymax"
            faults.append(("bounds", f"{text} (got {list(self.bounds)})"))
        elif max(abs(value) for value in self.bounds) > LARGEST_COORDINATE:
            text = f"coordinates must stay within {LARGEST_COORDINATE:g} m (got {list(self.bounds)})"
            faults.append(("bounds", text + "; move the origin nearer"))
        if fault := range_fault("clearance", self.clearance, " m", 0.0, LARGEST_COORDINATE):
            faults.append(("clearance", fault))
        if self.after_arrival not in ("stay", "leave"):
            faults.append(("after_arrival", f'after_arrival must be "stay" or "leave" (got "{self.after_arrival}")'))
        if faults:
            raise InvalidValueError(faults)


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """Everything a plan is made from; ``options`` are the [plan] table, ``digest`` names the very files read."""

    name: str
    workspace: Workspace
    robots: tuple[Robot, ...]
    obstacles: tuple[Obstacle, ...] = ()
    options: Mapping[str, object] = field(default_factory=dict)
    digest: str = ""

    def __post_init__(self) -> None:
        uses = Counter(robot.name for robot in self.robots)
        faults = [
            ("name", f'the name "{name}" is used {count} times; names must differ')
            for name, count in uses.items()
            if count > 1
        ]
        if not self.robots:
            faults.append(("robots", "a problem needs at least one robot"))
        if faults:
            raise InvalidValueError(faults)
