"""A robot: what it is shaped like, what it can do, where it stands and where it goes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from coord.errors import InvalidValueError
from coord.model.arrays import Point
from coord.model.footprint import Footprint
from coord.model.rules import range_fault
from coord.tolerances import LARGEST_COORDINATE, LARGEST_LIMIT, LATEST_RELEASE, SMALLEST_LIMIT


@dataclass(frozen=True, slots=True)
class Limits:
    """What a robot's drive can do; the names are those of ruckig.

    Parameters
    ----------
    speed [m/s], acceleration [m/s2], deceleration [m/s2], jerk [m/s3] : along the path, all positive.
    lateral_acceleration [m/s2] : across the path; it caps the speed in bends at sqrt(lateral / |curvature|).
    """

    speed: float
    acceleration: float
    deceleration: float
    jerk: float
    lateral_acceleration: float

    def __post_init__(self) -> None:
        units = {"speed": "m/s", "jerk": "m/s3"}
        faults = []
        for name in self.__slots__:
            unit = " " + units.get(name, "m/s2")
            if fault := range_fault(name, getattr(self, name), unit, SMALLEST_LIMIT, LARGEST_LIMIT):
                faults.append((name, fault))
        if faults:
            raise InvalidValueError(faults)


@dataclass(frozen=True, slots=True)
class Robot:
    """One robot of a problem.

    Parameters
    ----------
    start, goal : centre of the footprint [m].
    priority : smaller goes first; None comes after all that have one.
    release : earliest departure [s].
    weight : for the objective "weighted".
    side : "left" or "right", seen along the straight line, of whatever blocks that line; "quickest": by time.
    via : places to pass in this order [m].
    path : a given polyline from start to goal [m], instead of ``side`` and ``via``; none: a path is sought.
    corner_radius : the corners of a given path become fillets of up to this radius [m].
    """

    name: str
    footprint: Footprint
    limits: Limits
    start: Point
    goal: Point
    priority: float | None = None
    release: float = 0.0
    weight: float = 1.0
    side: str = "quickest"
    via: tuple[Point, ...] = ()
    path: tuple[Point, ...] = ()
    corner_radius: float = 0.2

    def __post_init__(self) -> None:
        faults = []
        if not self.name:
            faults.append(("name", "a robot needs a name that is not empty"))
        for field in ("start", "goal"):
            if not all(math.isfinite(value) for value in getattr(self, field)):
                faults.append((field, f"{field} must be two finite numbers [m] (got {getattr(self, field)})"))
        if self.priority is not None and not math.isfinite(self.priority):
            faults.append(("priority", f"priority must be a finite number (got {self.priority})"))
        if fault := range_fault("release", self.release, " s", 0.0, LATEST_RELEASE):
            faults.append(("release", fault))
        if fault := range_fault("weight", self.weight, "", 0.0, LARGEST_COORDINATE):
            faults.append(("weight", fault))
        if fault := range_fault("corner_radius", self.corner_radius, " m", 0.0, LARGEST_COORDINATE):
            faults.append(("corner_radius", fault))
        faults += self._way_faults()
        if faults:
            raise InvalidValueError(faults)

    def _way_faults(self) -> list[tuple[str, str]]:
        faults = []
        if self.side not in ("quickest", "left", "right"):
            faults.append(("side", f'side must be "quickest", "left" or "right" (got "{self.side}")'))
        for field in ("via", "path"):
            points = getattr(self, field)
            if not all(math.isfinite(value) for point in points for value in point):
                faults.append((field, f"{field} must be points of two finite numbers [m]"))
        if not self.path:
            return faults
        if self.via or self.side != "quickest":
            faults.append(("path", "a robot with a given path has neither side nor via: the path says it all"))
        if len(self.path) < 2 or self.path[0] != self.start or self.path[-1] != self.goal:
            faults.append(("path", "a given path begins at the robot's start and ends at its goal"))
        return faults
