"""The robot whose profile is sought, with all that does not depend on the others."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from coord.alone.fastest import fastest, solo_bound
from coord.alone.ramp import Ramp, landing, launch
from coord.alone.speed_limit import SpeedLimit, speed_limit
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Robot


@dataclass(frozen=True, slots=True, eq=False)
class Ego:
    """One robot on its path.

    Parameters
    ----------
    alone : its quickest profile with nobody else, departing at the release time.
    solo_bound : time [s] that no profile can beat, release included.
    launch, landing : ramps that bound how early it can be somewhere and how long it still needs.
    """

    robot: Robot
    path: Path
    caps: SpeedLimit
    alone: VelocityProfile
    solo_bound: float
    launch: Ramp
    landing: Ramp

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
    bound = robot.release + solo_bound(path, limits)
    return Ego(robot, path, caps, alone, min(bound, alone.arrival), launch(top), landing(top))
