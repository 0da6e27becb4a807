"""A velocity profile: how a robot moves along its path in time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array, frozen

#: arc length [m], speed [m/s], acceleration [m/s2]
State: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class VelocityProfile:
    """Time parametrisation s(t) of a path by phases of constant jerk (Kant & Zucker 1986).

    Parameters
    ----------
    times : (K+1,) array [s], increasing; before the first knot and after the last the robot rests.
    states : (K+1, 3) array: arc length s [m], speed v [m/s], acceleration a [m/s2] at the knots.
        Kept at every knot because a chain of rounded jerks would drift.
    jerks : (K,) array [m/s3], one a phase.
    """

    times: Array
    states: Array
    jerks: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", frozen(self.times))
        object.__setattr__(self, "states", frozen(self.states, 3))
        object.__setattr__(self, "jerks", frozen(self.jerks))

    def __reduce__(self) -> tuple[type[VelocityProfile], tuple[object, ...]]:
        return (VelocityProfile, (self.times, self.states, self.jerks))

    @property
    def departure(self) -> float:
        """The time of the first knot [s]; the robot rests before it."""
        return float(self.times[0])

    @property
    def arrival(self) -> float:
        """The time of the last knot [s]; the robot rests after it."""
        return float(self.times[-1])

    @property
    def length(self) -> float:
        """The arc length at the end [m]."""
        return float(self.states[-1, 0])

    def state(self, t: npt.ArrayLike) -> Array:
        """States (m, 3): s, v, a at the times t (m,) [s]."""
        t = np.clip(np.atleast_1d(np.asarray(t, dtype=np.float64)), self.departure, self.arrival)
        if not len(self.jerks):
            return np.repeat(self.states[:1], len(t), axis=0)
        k = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.jerks) - 1)
        states = advance(self.states[k], self.jerks[k], t - self.times[k])
        states[t >= self.arrival] = self.states[-1]  # rest is rest, to the last digit
        return states

    def shifted(self, delay: float) -> VelocityProfile:
        """The same motion, later by ``delay`` [s]."""
        return VelocityProfile(self.times + delay, self.states, self.jerks)


def advance(states: Array, jerks: Array, durations: Array) -> Array:
    """States (m, 3) after constant jerks (m,) held for durations (m,)."""
    s, v, a = states.T
    j, h = jerks, durations
    return np.stack([s + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j], axis=1)


def integrate(start: State, durations: Iterable[float], jerks: Iterable[float]) -> list[State]:
    """The states at all knots of phases of constant jerk that follow each other, the start first."""
    states = [start]
    for h, j in zip(durations, jerks, strict=True):
        s, v, a = states[-1]
        states.append((s + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j))
    return states
