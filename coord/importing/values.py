"""What an import is asked for, and what it brings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final

from coord.errors import InvalidValueError

#: How robots drive where the file does not say: m/s, m/s2, m/s3.
DRIVE: Final[Mapping[str, float]] = {"speed": 1.0, "acceleration": 0.5, "jerk": 1.0}

#: [m] Radius of robots where neither the file nor the user says one.
RADIUS: Final = 0.3


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """How to import; the names are those of the command's flags.

    Parameters
    ----------
    map : of a scenario, where it is not found beside it.
    robots : of a scenario, how many at most.
    resolution : of images and MovingAI maps, the side of a cell [m].
    occupied_below : of images, the share of white below which a cell is occupied.
    unknown : of ROS maps, what unknown cells count as.
    radius : of the robots' discs [m], instead of what the file says of their shape.
    simplify : of maps: write polygons that are larger than the map by this much at most [m]; 0 names the map itself.
    metres : of GeoJSON: its coordinates are metres, whatever they look like.
    force : replace an output that exists.
    """

    map: Path | None = None
    robots: int | None = None
    resolution: float | None = None
    occupied_below: float | None = None
    unknown: str | None = None
    radius: float | None = None
    simplify: float = 0.0
    metres: bool = False
    force: bool = False

    def __post_init__(self) -> None:
        faults = []
        if self.robots is not None and self.robots < 1:
            faults.append(("robots", f"robots must be at least 1 (got {self.robots})"))
        for name in ("resolution", "radius"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                faults.append((name, f"{name} must be > 0 m (got {value:g})"))
        if not (math.isfinite(self.simplify) and self.simplify >= 0):
            faults.append(("simplify", f"simplify must be >= 0 m (got {self.simplify:g})"))
        if self.unknown not in (None, "occupied", "free"):
            faults.append(("unknown", f'unknown must be "occupied" or "free" (got "{self.unknown}")'))
        if self.occupied_below is not None and not 0 <= self.occupied_below <= 1:
            faults.append(
                ("occupied_below", f"occupied_below must be a number from 0 to 1 (got {self.occupied_below:g})")
            )
        if faults:
            raise InvalidValueError(faults)

    def given(self) -> dict[str, Any]:
        """The options that are not what they are without saying, without ``force``."""
        return {
            field.name: value
            for field in fields(self)
            if field.name != "force" and (value := getattr(self, field.name)) != field.default
        }


@dataclass(frozen=True, slots=True)
class Imported:
    """The text of a problem file, and what a person should know about it, a sentence each (they stand in it too)."""

    text: str
    remarks: tuple[str, ...]
