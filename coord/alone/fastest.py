"""The quickest profile of one robot with nobody else on the floor, and the bound no profile can beat."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from coord.alone.check import keeps_limits
from coord.alone.polish import land_exactly
from coord.alone.speed_limit import SpeedLimit, speed_limit
from coord.errors import SolverError
from coord.model.arrays import Array
from coord.model.path import Path
from coord.model.profile import VelocityProfile, advance
from coord.model.robot import Limits
from coord.solvers.jerk import motion, rest_to_rest
from coord.tolerances import LIMIT_MARGIN

#: The border speeds of a chain of motions are lowered by this factor until the motions exist.
_BACK_OFF = 0.95

#: [m/s] Below this a border speed is taken as a stop.
_SLOWEST = 1e-3


def fastest(path: Path, limits: Limits) -> VelocityProfile:
    """The quickest profile along a path alone, from t = 0.

    Without caps from curvature it is time-optimal (ruckig). With caps it is a local optimum over free
    phases (Fatrop), or, where that is worse or fails, a chain of motions from section to section.

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
    found = [slow, *_chained(caps, limits)]
    found = [profile for profile in found if keeps_limits(profile, limits, caps)]
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


def _chained(caps: SpeedLimit, limits: Limits) -> list[VelocityProfile]:
    """The chain of motions between the sections' ends, and what the nonlinear program makes of it."""
    from coord.solvers.nonlinear import quickest_phases  # loads casadi, which straight paths do not need

    tight = _scaled(limits, 1 - LIMIT_MARGIN)
    tight_caps = caps.caps * (1 - 10 * LIMIT_MARGIN)
    chain = _chain(caps.ends, tight_caps, tight)
    if chain is None:
        return []
    profile = _joined(chain)
    durations, jerks = quickest_phases(caps.ends, tight_caps, tight, _phases(chain))
    better = land_exactly(durations, jerks, float(caps.ends[-1]))
    return [profile] if better is None else [profile, better]


def _chain(ends: Array, caps: Array, limits: Limits) -> list[VelocityProfile] | None:
    """One motion a section, with zero acceleration at the borders and border speeds as high as they go."""
    speeds = [0.0, *np.minimum(caps[:-1], caps[1:]).tolist(), 0.0]
    starts = [0.0, *ends.tolist()]

    def link(m: int) -> VelocityProfile | None:
        capped = dataclasses.replace(limits, speed=float(caps[m]))
        return motion((starts[m], speeds[m], 0.0), (starts[m + 1], speeds[m + 1], 0.0), capped)

    for forward in (True, False):  # a border that cannot be reached is lowered, then one that cannot be left
        for m in range(len(caps)) if forward else reversed(range(len(caps))):
            border = m + 1 if forward else m
            while link(m) is None and speeds[border] > max(_SLOWEST, speeds[2 * m + 1 - border]):
                speeds[border] *= _BACK_OFF
    links = [link(m) for m in range(len(caps))]
    return None if any(part is None for part in links) else [part for part in links if part is not None]


def _joined(chain: list[VelocityProfile]) -> VelocityProfile:
    times, states, jerks = [0.0], [chain[0].states[0]], []
    for part in chain:
        times += (times[-1] + part.times[1:]).tolist()
        states += list(part.states[1:])
        jerks += part.jerks.tolist()
    return VelocityProfile(times, states, jerks)  # type: ignore[arg-type]


def _phases(chain: list[VelocityProfile]) -> Array:
    """Rows s, v, a, duration, jerk, seven a section: long phases are halved until there are seven."""
    from coord.solvers.nonlinear import PHASES

    rows: list[list[float]] = []
    for part in chain:
        columns = np.column_stack([part.states[:-1], np.diff(part.times), part.jerks])
        phases: list[list[float]] = columns.tolist()
        while len(phases) < PHASES:
            k = max(range(len(phases)), key=lambda i: phases[i][3])
            s, v, a, h, j = phases[k]
            middle = advance(np.array([[s, v, a]]), np.array([j]), np.array([h / 2]))[0]
            phases[k : k + 1] = [[s, v, a, h / 2, j], [*middle.tolist(), h / 2, j]]
        rows += phases[:PHASES]
    return np.array(rows)


def _scaled(limits: Limits, factor: float) -> Limits:
    return Limits(
        limits.speed * factor,
        limits.acceleration * factor,
        limits.deceleration * factor,
        limits.jerk * factor,
        limits.lateral_acceleration,
    )


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
