"""The speed that a robot's path allows it, over time: exact, from the pieces of the path."""

from __future__ import annotations

from typing import Final

import numpy as np

from coord.alone.inverse import time_at
from coord.model.arrays import Array
from coord.model.result import RobotPlan

#: Samples in a piece whose curvature changes.
_SAMPLES: Final = 40


def speed_cap(robot: RobotPlan, end: float) -> tuple[Array, Array]:
    """Times and speeds to draw as a line: the highest speed allowed where the robot is, until ``end`` [s].

    In a bend the lateral acceleration caps the speed at sqrt(lateral_acceleration / |curvature|). Each piece of
    the path, however short, lasts from when the robot enters it to when it leaves it; the cap jumps between.
    """
    limits, path, profile = robot.robot.limits, robot.path, robot.profile
    t, bends = [np.array([0.0])], [np.array([0.0])]
    for (length, k0, k1), begin in zip(path.pieces.tolist(), path.breaks.tolist(), strict=False):
        share = np.linspace(0.0, 1.0, 2 if k0 == k1 else _SAMPLES)
        t.append(time_at(profile, begin + share * length))
        bends.append(np.abs(k0 + (k1 - k0) * share))
    with np.errstate(divide="ignore"):
        allowed = np.sqrt(limits.lateral_acceleration / np.concatenate(bends))
    caps = np.minimum(limits.speed, allowed)
    times = np.concatenate(t)
    return np.append(times, max(end, profile.arrival)), np.append(caps, caps[-1])
