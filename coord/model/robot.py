"""A robot: what it is shaped like, what it can do, where it stands and where it goes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from coord.errors import InvalidValueError
from coord.model.arrays import Point


@dataclass(frozen=True, slots=True)
class Footprint:
    """The floor a robot covers: a disc about its reference point.

    Raises
    ------
    InvalidValueError
        When the radius [m] is not a positive finite number.
    """

    radius: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.radius) and self.radius > 0):
            raise InvalidValueError([("footprint", f"the disc's radius must be > 0 m (got {self.radius:g})")])


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
        faults = [
            (name, f"{name} must be > 0 {units.get(name, 'm/s2')} (got {value:g})")
            for name in self.__slots__
            if not (math.isfinite(value := getattr(self, name)) and value > 0)
        ]
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
        if not (math.isfinite(self.release) and self.release >= 0):
            faults.append(("release", f"release must be >= 0 s (got {self.release:g})"))
        if not (math.isfinite(self.weight) and self.weight >= 0):
            faults.append(("weight", f"weight must be >= 0 (got {self.weight:g})"))
        if faults:
            raise InvalidValueError(faults)
