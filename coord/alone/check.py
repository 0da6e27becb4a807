"""Does a profile keep the limits? Exact on every phase; the last word has the independent checker."""

from __future__ import annotations

import numpy as np

from coord.alone.inverse import time_at
from coord.alone.speed_limit import SpeedLimit
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile, advance
from coord.model.robot import Limits

#: Excess [m/s, m/s2, m/s3] and mismatch between knots [m, m/s, m/s2] that rounding may leave.
_SLACK = 2e-10


def keeps_limits(profile: VelocityProfile, limits: Limits, caps: SpeedLimit) -> bool:
    """Whether the profile is consistent from knot to knot, starts and ends at rest and keeps every limit and cap."""
    states, jerks, h = profile.states, profile.jerks, np.diff(profile.times)
    if not len(jerks):
        return True
    if np.any(h <= 0) or np.any(np.abs(advance(states[:-1], jerks, h) - states[1:]) > _SLACK):
        return False
    if np.any(states[0] != 0) or np.any(states[-1, 1:] != 0):
        return False
    acceleration, low, high = states[:, 2], *speed_range(states[:-1], jerks, h)
    return bool(
        np.all(acceleration <= limits.acceleration + _SLACK)
        and np.all(acceleration >= -limits.deceleration - _SLACK)
        and np.all(np.abs(jerks) <= limits.jerk + _SLACK)
        and np.all(low >= -_SLACK)
        and np.all(high <= limits.speed + _SLACK)
        and (caps.is_constant or _keeps_caps(profile, caps))
    )


def speed_range(states: Array, jerks: Array, h: Array) -> tuple[Array, Array]:
    """Least and largest speed (K,) [m/s] in phases that begin in states (K, 3) and last h (K,) [s]."""
    v, a = states[:, 1], states[:, 2]
    after = v + h * (a + h * jerks / 2)
    turning = np.divide(-a, jerks, out=np.zeros_like(a), where=jerks != 0)
    inside = (turning > 0) & (turning < h)
    extremum = np.where(inside, v + turning * (a + turning * jerks / 2), v)
    return np.minimum(np.minimum(v, after), extremum), np.maximum(np.maximum(v, after), extremum)


def split(profile: VelocityProfile, s: Array) -> VelocityProfile:
    """The same profile with further knots where it passes the arc lengths s (m,) [m]."""
    cuts = time_at(profile, s)
    cuts = cuts[(cuts > profile.departure) & (cuts < profile.arrival)]
    times = np.unique(np.concatenate([profile.times, cuts]))
    phase = np.clip(np.searchsorted(profile.times, times[:-1], side="right") - 1, 0, len(profile.jerks) - 1)
    return VelocityProfile(times, profile.state(times), profile.jerks[phase])


def _keeps_caps(profile: VelocityProfile, caps: SpeedLimit) -> bool:
    """Whether the speed stays below the cap of the section in which each part of the motion lies."""
    cut = split(profile, caps.ends[:-1])
    h = np.diff(cut.times)
    middle = cut.state(cut.times[:-1] + h / 2)[:, 0]
    section = np.minimum(np.searchsorted(caps.ends, middle, side="right"), len(caps.caps) - 1)
    _, high = speed_range(cut.states[:-1], cut.jerks, h)
    return bool(np.all(high <= caps.caps[section] * (1 + 1e-9)))
