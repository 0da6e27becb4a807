"""The geometric answer for one robot: its path, why this one, and what the other side would have cost."""

from __future__ import annotations

from dataclasses import dataclass

from coord.model.path import Path
from coord.model.profile import VelocityProfile


@dataclass(frozen=True, slots=True)
class Fit:
    """The exponential y = A exp(B x) fitted to one flank of a detour, by least squares in ln y.

    ``flank`` : "rise" or "fall"; x [m] runs along the straight line from the detour's middle, y [m] is the
    distance from it; ``A`` [m], ``B`` [1/m]; ``r_squared`` [1] of the fit in ln y.
    """

    flank: str
    A: float
    B: float
    r_squared: float


@dataclass(frozen=True, slots=True, eq=False)
class Shaped:
    """A skeleton made into a path that can be driven.

    ``shape`` : the one it has, which may be another than was asked for; ``remarks`` then say in words why.
    """

    path: Path
    shape: str
    fits: tuple[Fit, ...] = ()
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """One side of what blocks the straight line.

    Parameters
    ----------
    side : "left" or "right", seen from start to goal.
    length, time : of the path [m], alone and from rest to rest [s]; None where there is no way on this side. Where
        ``is_bound``, no path on this side is shorter or quicker, which was enough to prefer another.
    path : None where there is no way, or only its bounds are known.
    reason : why there is no way.
    """

    side: str
    length: float | None
    time: float | None
    path: Path | None = None
    is_bound: bool = False
    reason: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """How a robot gets from its start to its goal.

    Parameters
    ----------
    path : the path chosen; ``alone`` : the quickest profile found along it, from rest to rest, from t = 0.
    shape : of the turns: "fitted", "exponential", "taut", "follow"; "straight" where nothing is in the way;
        "given" for a path out of the problem file.
    side : "left", "right", "both" (left of some obstacles and right of others), "" where the line is free.
    least_length : length [m] that no path on this side falls below.
    ways : the sides that were compared; ``fits`` and ``remarks`` : of the shape.
    """

    path: Path
    alone: VelocityProfile
    shape: str
    side: str
    least_length: float
    ways: tuple[Way, ...] = ()
    fits: tuple[Fit, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def time(self) -> float:
        """Time [s] alone, from rest to rest."""
        return self.alone.arrival
