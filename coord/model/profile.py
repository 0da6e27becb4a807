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
        asked = np.atleast_1d(np.asarray(t, dtype=np.float64))
        if not len(self.jerks):
            return np.repeat(self.states[:1], len(asked), axis=0)
        k, since = self._phases(asked)
        states = advance(self.states[k], self.jerks[k], since)
        states[asked >= self.times[-1]] = self.states[-1]  # rest is rest, to the last digit
        return states

    def places(self, t: Array) -> Array:
        """Arc lengths (m,) [m] at the times t (m,) [s]: the first column of ``state``."""
        if not len(self.jerks):
            return np.full(len(t), self.states[0, 0])
        k, h = self._phases(t)
        s, v, a = self.states[k].T
        places = s + h * (v + h * (a / 2 + h * self.jerks[k] / 6))
        places[t >= self.times[-1]] = self.states[-1, 0]
        return np.asarray(places)

    def _phases(self, t: Array) -> tuple[npt.NDArray[np.intp], Array]:
        """The phases (m,) in which the times t (m,) [s] lie, or the nearer end, and how long [s] they last by then."""
        times = self.times
        at = np.minimum(np.maximum(t, times[0]), times[-1])
        k = np.minimum(times.searchsorted(at, side="right") - 1, len(self.jerks) - 1)
        return k, at - times[k]

    def place(self, t: float) -> float:
        """The arc length [m] at one time [s]: as ``state`` has it, several times as quickly."""
        if t <= self.times[0] or t >= self.times[-1] or not len(self.jerks):
            return float(self.states[0 if t <= self.times[0] else -1, 0])
        k = min(int(self.times.searchsorted(t, side="right")) - 1, len(self.jerks) - 1)
        s, v, a = self.states[k].tolist()
        h, j = t - float(self.times[k]), float(self.jerks[k])
        return float(s + h * (v + h * (a / 2 + h * j / 6)))

    def shifted(self, delay: float) -> VelocityProfile:
        """The same motion, later by ``delay`` [s]."""
        return VelocityProfile(self.times + delay, self.states, self.jerks)


def advance(states: Array, jerks: Array, durations: Array) -> Array:
    """States (m, 3) after constant jerks (m,) held for durations (m,)."""
    s, v, a = states.T
    j, h = jerks, durations
    after = np.empty((len(h), 3))
    after[:, 0] = s + h * (v + h * (a / 2 + h * j / 6))
    after[:, 1] = v + h * (a + h * j / 2)
    after[:, 2] = a + h * j
    return after


def integrate(start: State, durations: Iterable[float], jerks: Iterable[float]) -> list[State]:
    """The states at all knots of phases of constant jerk that follow each other, the start first."""
    states = [start]
    for h, j in zip(durations, jerks, strict=True):
        s, v, a = states[-1]
        states.append((s + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j))
    return states
