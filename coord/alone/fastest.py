"""The quickest profile of one robot with nobody else on the floor, and the bound no profile can beat."""

from __future__ import annotations

import dataclasses

from coord.alone.chain import chained
from coord.alone.check import keeps_limits
from coord.alone.relaxed import without_jerk
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
    return free if caps.is_constant else max(free, without_jerk(path, limits).arrival)
