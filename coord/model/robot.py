"""A robot: what it is shaped like, what it can do, where it stands and where it goes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from coord.errors import InvalidValueError
from coord.model.arrays import Point
from coord.model.rules import range_fault
from coord.tolerances import LARGEST_COORDINATE, LARGEST_LIMIT, LATEST_RELEASE, SMALLEST_LIMIT, SMALLEST_RADIUS


@dataclass(frozen=True, slots=True)
class Footprint:
    """The floor a robot covers: a disc about its reference point.

    Raises
    ------
    InvalidValueError
        When the radius [m] is not positive, or larger than any floor.
    """

    radius: float

    def __post_init__(self) -> None:
        fault = range_fault("the disc's radius", self.radius, " m", SMALLEST_RADIUS, LARGEST_COORDINATE)
        if fault:
            raise InvalidValueError([("footprint", fault)])


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
    """

    name: str
    footprint: Footprint
    limits: Limits
    start: Point
    goal: Point
    priority: float | None = None
    release: float = 0.0
    weight: float = 1.0

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
        if faults:
            raise InvalidValueError(faults)
