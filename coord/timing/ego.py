"""The robot whose profile is sought, with all that does not depend on the others."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from coord.alone.fastest import fastest, solo_bound
from coord.alone.ramp import Ramp, landing, launch
from coord.alone.relaxed import without_jerk
from coord.alone.speed_limit import SpeedLimit, speed_limit
from coord.model.arrays import Array
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Robot
from coord.timing.bends import Passages, narrower, passages
from coord.timing.clock import clock


@dataclass(frozen=True, slots=True, eq=False)
class Ego:
    """One robot on its path.

    Parameters
    ----------
    alone : its quickest profile with nobody else, departing at the release time.
    solo_bound : time [s] that no profile can beat, release included.
    launch, landing : ramps that bound how early it can be somewhere and how long it still needs.
    relaxed : its quickest motion with the jerk forgotten, from t = 0: between any two places it needs that time.
    bends : what bends cost beyond that; None where the path has none.
    """

    robot: Robot
    path: Path
    caps: SpeedLimit
    alone: VelocityProfile
    solo_bound: float
    launch: Ramp
    landing: Ramp
    relaxed: VelocityProfile
    bends: Passages | None

    @property
    def length(self) -> float:
        """Length of the path [m]."""
        return self.path.length


def ego(robot: Robot, path: Path, alone: VelocityProfile | None = None) -> Ego:
    """Work out what a robot can do alone on its path; ``alone``: its quickest profile from t = 0, if it is known."""
    limits = robot.limits
    alone = (alone or fastest(path, limits)).shifted(robot.release)
    caps = speed_limit(path, limits)
    # no cap is reached anywhere on a path of bends only: the ramps may use the highest cap there is
    top = dataclasses.replace(limits, speed=max(caps.caps.tolist(), default=limits.speed))
    relaxed = without_jerk(path, limits)
    bends = passages(path, limits, relaxed)
    bound = robot.release + max(solo_bound(path, limits), 0.0 if bends is None else bends.total)
    return Ego(robot, path, caps, alone, min(bound, alone.arrival), launch(top), landing(top), relaxed, bends)


def sharpened(one: Ego, rounds: int) -> Ego:
    """The same with tighter bounds of what bends cost, which take some tens of milliseconds; see ``narrower``."""
    if one.bends is None:
        return one
    bends = narrower(one.bends, one.relaxed, rounds)
    bound = min(max(one.solo_bound, one.robot.release + bends.total), one.alone.arrival)
    return dataclasses.replace(one, bends=bends, solo_bound=bound)


def earliest(one: Ego, s: Array, clocks: Array | None = None) -> Array:
    """The earliest times (m,) [s] at which it can be at the arc lengths s (m,) [m]; ``clocks``: these in its clock."""
    clocks = clock(one.relaxed, s) if clocks is None else clocks
    clocks = clocks if one.bends is None else one.bends.earliest(s, clocks)
    return one.alone.departure + np.maximum(one.launch.time(s), clocks)


def still_needed(one: Ego, s: Array, clocks: Array | None = None) -> Array:
    """The least times (m,) [s] that it still needs from there to rest at its goal; as for ``earliest``."""
    left = one.relaxed.arrival - (clock(one.relaxed, s) if clocks is None else clocks)
    left = left if one.bends is None else one.bends.needed(s, left)
    return np.maximum(one.landing.time(one.length - s), left)
