"""The quickest profile of one robot with nobody else on the floor, and the bound no profile can beat."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from coord.alone.chain import chained
from coord.alone.check import keeps_limits
from coord.alone.speed_limit import speed_limit
from coord.errors import SolverError
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest


def fastest(path: Path, limits: Limits) -> VelocityProfile:
    """The quickest profile along a path alone, from t = 0.

    Without caps from curvature it is time-optimal (ruckig). With caps it is a local optimum over the states
    at the borders of the sections, and time-optimal between these.

    Raises
    ------
    SolverError
        When not even a motion with the lowest cap everywhere is found, which no known input causes.
    """
    if path.length == 0:
        return VelocityProfile([0.0], [(0.0, 0.0, 0.0)], [])  # type: ignore[arg-type]
    caps = speed_limit(path, limits)
    if caps.is_constant:
        return rest_to_rest(path.length, dataclasses.replace(limits, speed=float(caps.caps[0])))
    slow = rest_to_rest(path.length, dataclasses.replace(limits, speed=float(caps.caps.min())))
    chain = chained(caps, limits)
    found = [one for one in (slow, chain) if one is not None and keeps_limits(one, limits, caps)]
    if not found:
        raise SolverError(f"no profile keeps the speed caps {caps.caps.tolist()} m/s")
    return min(found, key=lambda profile: profile.arrival)


def solo_bound(path: Path, limits: Limits) -> float:
    """A time [s] that no profile along the path can beat: the larger of two relaxations.

    One forgets the bends (jerk-limited, on the length), the other forgets the jerk (forward and backward
    pass under the caps, the classic time-optimal path parametrisation for a double integrator).
    """
    if path.length == 0:
        return 0.0
    free = rest_to_rest(path.length, limits).arrival
    caps = speed_limit(path, limits)
    return free if caps.is_constant else max(free, _without_jerk(path, limits))


def _without_jerk(path: Path, limits: Limits) -> float:
    """Least time [s] with speed caps and acceleration limits only.

    On a section with a constant cap the squared speed w(s) rises by at most 2 acc and falls by at most
    2 dec a metre; the largest w at the borders follows from one pass in each direction, and within a
    section the time is that of a trapezoid.
    """
    pieces = path.pieces
    least = np.where(pieces[:, 1] * pieces[:, 2] <= 0, 0.0, np.abs(pieces[:, 1:]).min(axis=1))
    # a bound must not be too tight: where the curvature varies, the highest cap of the piece holds
    cap = np.minimum(limits.speed, np.sqrt(limits.lateral_acceleration / np.maximum(least, 1e-300)))
    length, up, down = pieces[:, 0], limits.acceleration, limits.deceleration
    w = [0.0, *(np.minimum(cap[:-1], cap[1:]) ** 2).tolist(), 0.0]
    for m in range(len(length)):
        w[m + 1] = min(w[m + 1], w[m] + 2 * up * float(length[m]))
    for m in reversed(range(len(length))):
        w[m] = min(w[m], w[m + 1] + 2 * down * float(length[m]))
    v = [math.sqrt(square) for square in w]
    return math.fsum(_trapezoid(float(length[m]), v[m], v[m + 1], float(cap[m]), up, down) for m in range(len(length)))


def _trapezoid(length: float, v0: float, v1: float, cap: float, up: float, down: float) -> float:
    """Least time over a length between two speeds under a cap, without a jerk limit."""
    peak = min(cap, math.sqrt((2 * up * down * length + down * v0 * v0 + up * v1 * v1) / (up + down)))
    peak = max(peak, v0, v1)
    ramps = (peak**2 - v0**2) / (2 * up) + (peak**2 - v1**2) / (2 * down)
    return (peak - v0) / up + (peak - v1) / down + max(length - ramps, 0.0) / peak
