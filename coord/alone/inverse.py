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
    k = np.maximum(np.minimum(knots.searchsorted(s, side="left") - 1, len(profile.jerks) - 1), 0)
    s0, v, a = profile.states[k].T
    h = np.diff(profile.times)[k]
    u = increasing_root((s0 - s, v, a / 2, profile.jerks[k] / 6), h)
    times = profile.times[k] + u
    times = np.where(s <= knots[0], profile.departure, times)
    return np.where(s >= knots[-1], profile.times[knots.searchsorted(knots[-1])], times)


def increasing_root(coefficients: tuple[Array, Array, Array, Array], h: Array) -> Array:
    """Roots (m,) in [0, h] of cubics that do not decrease there; coefficients (m,) each, lowest first.

    Each is sought from the end whose value is nearer to 0: there a motion that comes to rest is flat, and its cubic is
    as good as one power.
    """
    c0, c1, c2, c3 = coefficients
    rest = c0 + h * (c1 + h * (c2 + h * c3))
    is_back = rest < -c0
    way = np.maximum(np.where(is_back, rest, -c0), 0.0)
    slope = np.maximum(np.where(is_back, c1 + h * (2 * c2 + h * 3 * c3), c1), 0.0)
    u = _time_for(way, slope, np.where(is_back, -(c2 + 3 * h * c3), c2), c3, h)
    return np.where(is_back, h - u, u)


def _time_for(way: Array, a: Array, b: Array, c: Array, h: Array) -> Array:
    """When a u + b u^2 + c u^3, which does not decrease on [0, h] and begins with a >= 0, is as much as ``way``.

    Newton's method kept inside a shrinking bracket, so that it cannot leave or stall.
    """
    times, rows = np.empty_like(h), np.arange(len(h))
    resolved = 4e-16 * (1 + h)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = 2 * way / (a + np.sqrt(a * a + 4 * np.maximum(b, 0.0) * way))
        u = np.fmin(np.fmin(u, np.cbrt(way / np.maximum(c, 0.0))), h)
        low, high = np.zeros_like(h), h
        for _ in range(80):
            value = u * (a + u * (b + u * c)) - way
            below = value < 0
            low, high = np.where(below, u, low), np.where(below, high, u)
            step = u - value / (a + u * (2 * b + u * 3 * c))
            following = np.where((step >= low) & (step <= high), step, (low + high) / 2)
            left = np.flatnonzero((np.abs(following - u) > resolved) & (high - low > resolved))
            u = following
            if len(left) == len(rows):
                continue
            times[rows] = u
            if not len(left):
                break
            rows = rows[left]  # few near a stop need many more rounds
            way, a, b, c, low, high, u, resolved = (value[left] for value in (way, a, b, c, low, high, u, resolved))
        else:
            times[rows] = u
    return times
