"""The quickest motion with the jerk forgotten: no motion that keeps all limits is faster anywhere.

Under speed caps and acceleration limits alone, the largest speed with which a place can be passed, coming from
rest and ending at rest, follows from one pass forward and one backward (the classic time-optimal path
parametrisation). Every motion within all limits is slower at every place, so between any two places it takes at
least the time that this one takes.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from coord.model.arrays import Array
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits

#: Pieces with varying curvature are cut into this many: in each the highest cap holds, since a bound must not be tight.
_CUTS = 8

#: [s] Phases shorter than this are left out.
_SHORTEST = 1e-12


def without_jerk(path: Path, limits: Limits) -> VelocityProfile:
    """The quickest motion under speed caps and acceleration limits, from rest to rest, from t = 0.

    Its phases have jerk 0, and the acceleration jumps between them: a bound, not a motion to be driven.
    """
    length, cap = _stretches(path, limits)
    up, down = limits.acceleration, limits.deceleration
    w = [0.0, *(np.minimum(cap[:-1], cap[1:]) ** 2).tolist(), 0.0]
    for m, stretch in enumerate(length.tolist()):
        w[m + 1] = min(w[m + 1], w[m] + 2 * up * stretch)
    for m, stretch in reversed(list(enumerate(length.tolist()))):
        w[m] = min(w[m], w[m + 1] + 2 * down * stretch)
    times, states = [0.0], []
    at = 0.0
    for m, stretch in enumerate(length.tolist()):
        phases = _trapezoid(stretch, math.sqrt(w[m]), math.sqrt(w[m + 1]), float(cap[m]), up, down)
        s = at
        for h, v, a in phases:
            if h > _SHORTEST:
                times.append(times[-1] + h)
                states.append((s, v, a))
            s += h * (v + h * a / 2)
        at += stretch
    states.append((path.length, 0.0, 0.0))
    return VelocityProfile(times, states, [0.0] * (len(times) - 1))  # type: ignore[arg-type]


def _stretches(path: Path, limits: Limits) -> tuple[Array, Array]:
    """Lengths [m] and highest caps [m/s] of the path's pieces, those of varying curvature cut up."""
    rows = []
    for length, k0, k1 in path.pieces.tolist():
        count = 1 if k0 == k1 else _CUTS
        for a, b in itertools.pairwise(np.linspace(k0, k1, count + 1).tolist()):
            least = 0.0 if a * b <= 0 else min(abs(a), abs(b))
            rows.append(
                (length / count, min(limits.speed, math.sqrt(limits.lateral_acceleration / max(least, 1e-300))))
            )
    lengths, caps = np.array(rows).reshape(-1, 2).T
    return lengths, caps


def _trapezoid(
    length: float, v0: float, v1: float, cap: float, up: float, down: float
) -> list[tuple[float, float, float]]:
    """Phases (duration, speed, acceleration) of the quickest way over a length between two speeds under a cap."""
    peak = min(cap, math.sqrt((2 * up * down * length + down * v0 * v0 + up * v1 * v1) / (up + down)))
    peak = max(peak, v0, v1)
    ramps = (peak**2 - v0**2) / (2 * up) + (peak**2 - v1**2) / (2 * down)
    return [((peak - v0) / up, v0, up), (max(length - ramps, 0.0) / peak, peak, 0.0), ((peak - v1) / down, peak, -down)]
