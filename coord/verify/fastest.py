"""The least time for a straight line, from rest to rest: what no robot can beat."""

from __future__ import annotations

import math

from coord.verify.records import Limits


def ramp(speed: float, acceleration: float, jerk: float) -> float:
    """The least time [s] from rest to a speed [m/s] reached with no acceleration left, or back.

    The acceleration rises and falls with the full jerk; it reaches its limit a where v >= a^2 / j. The ramp is
    symmetric about its middle, so its way is v/2 times this time.
    """
    if speed >= acceleration * acceleration / jerk:
        return speed / acceleration + acceleration / jerk
    return 2 * math.sqrt(speed / jerk)


def fastest(length: float, limits: Limits) -> float:
    """The least time [s] over a length [m] from rest to rest under speed, acceleration, deceleration and jerk.

    Some peak speed v is reached; before it no motion gains more way than the ramp up to v, after it none more than
    the ramp down, and at v itself it may cruise. The way v/2 (up(v) + down(v)) of both ramps grows with v: either it
    is the length at some v below the speed limit (found here by halving), or the limit is held for the rest.
    """

    def ramps(v: float) -> float:
        return ramp(v, limits.acceleration, limits.jerk) + ramp(v, limits.deceleration, limits.jerk)

    top = limits.speed
    way = top / 2 * ramps(top)
    if way <= length:
        return ramps(top) + (length - way) / top
    low, high = 0.0, top
    while low < (v := (low + high) / 2) < high:
        low, high = (v, high) if v / 2 * ramps(v) <= length else (low, v)
    return ramps(low)
