"""When a profile is at a place: the inverse of s(t)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.model.profile import VelocityProfile


def time_at(profile: VelocityProfile, s: npt.ArrayLike) -> Array:
    """The earliest times (m,) [s] at which the profile reaches the arc lengths s (m,) [m].

    Beyond the ends the times of the ends are given. Near a stop s(t) is flat, so that the time is only
    good to about the cube root of the rounding; the ends themselves are exact.
    """
    s = np.atleast_1d(np.asarray(s, dtype=np.float64))
    if not len(profile.jerks):
        return np.full(len(s), profile.departure)
    knots = np.maximum.accumulate(profile.states[:, 0])
    k = np.clip(np.searchsorted(knots, s, side="left") - 1, 0, len(profile.jerks) - 1)
    s0, v, a = profile.states[k].T
    h = np.diff(profile.times)[k]
    u = increasing_root(np.stack([s0 - s, v, a / 2, profile.jerks[k] / 6]), h)
    times = profile.times[k] + u
    times = np.where(s <= knots[0], profile.departure, times)
    return np.where(s >= knots[-1], profile.times[np.searchsorted(knots, knots[-1])], times)


def increasing_root(coefficients: Array, h: Array) -> Array:
    """Roots (m,) in [0, h] of cubics that do not decrease there; coefficients (4, m), lowest first.

    Newton's method kept inside a shrinking bracket, so that it cannot leave or stall.
    """
    c0, c1, c2, c3 = coefficients
    low, high = np.zeros_like(h), h
    u = np.where(c1 * h > 0, np.clip(-c0 / np.where(c1 * h > 0, c1, 1.0), 0.0, h), h / 2)
    resolved = 4e-16 * (1 + h)
    roots, rows = np.empty_like(h), np.arange(len(h))
    for _ in range(80):
        value = c0 + u * (c1 + u * (c2 + u * c3))
        below = value < 0
        low, high = np.where(below, u, low), np.where(below, high, u)
        slope = c1 + u * (2 * c2 + u * 3 * c3)
        step = u - value / np.where(slope > 0, slope, np.inf)
        inside = (slope > 0) & (step >= low) & (step <= high)
        following = np.where(inside, step, (low + high) / 2)
        found = (np.abs(following - u) <= resolved) | (high - low <= resolved)
        u = following
        if found.all():
            break
        if found.any():  # few near a stop need many more rounds
            roots[rows[found]] = u[found]
            left = np.flatnonzero(~found)
            rows, resolved = rows[left], resolved[left]
            c0, c1, c2, c3, low, high, u = (value[left] for value in (c0, c1, c2, c3, low, high, u))
    roots[rows] = u
    return roots
