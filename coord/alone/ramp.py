"""The ramp: as fast as a robot can get away from rest, and, read backwards, come to rest."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.alone.inverse import time_at
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile, integrate
from coord.model.robot import Limits


@dataclass(frozen=True, slots=True, eq=False)
class Ramp:
    """The motion from rest to full speed without a thought for braking.

    It is ahead of every other motion from rest at every time, because it keeps the largest acceleration
    from which full speed can still be met with zero acceleration. So ``time`` is a lower bound on when
    a robot can have gone a distance; with the deceleration in the acceleration's place and read
    backwards, on how long it still needs over the last metres to rest.
    """

    profile: VelocityProfile
    speed: float

    def time(self, distance: npt.ArrayLike) -> Array:
        """Least time (m,) [s] for the distances (m,) [m] from rest; 0 for distances below 0."""
        distance = np.atleast_1d(np.asarray(distance, dtype=np.float64))
        times = self.profile.arrival + np.maximum(distance - self.profile.length, 0.0) / self.speed
        inside = distance < self.profile.length
        if inside.any():
            times[inside] = time_at(self.profile, np.maximum(distance[inside], 0.0))
        return times


def launch(limits: Limits) -> Ramp:
    """The ramp from rest to full speed."""
    return _ramp(limits.speed, limits.acceleration, limits.jerk)


def landing(limits: Limits) -> Ramp:
    """The ramp from full speed to rest, read backwards: ``time(D)`` is needed at least over the last D metres."""
    return _ramp(limits.speed, limits.deceleration, limits.jerk)


def _ramp(speed: float, acceleration: float, jerk: float) -> Ramp:
    rise = min(acceleration / jerk, math.sqrt(speed / jerk))
    hold = max(speed / (jerk * rise) - rise, 0.0)
    phases = [(h, j) for h, j in ((rise, jerk), (hold, 0.0), (rise, -jerk)) if h > 0]
    durations, jerks = [h for h, _ in phases], [j for _, j in phases]
    states = integrate((0.0, 0.0, 0.0), durations, jerks)
    times = [0.0, *itertools.accumulate(durations)]
    return Ramp(VelocityProfile(times, states, jerks), speed)  # type: ignore[arg-type]
