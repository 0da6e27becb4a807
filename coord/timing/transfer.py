"""The least time from one speed and acceleration to another over some way: closed forms, for many pairs at once.

A motion between two places has somewhere its greatest speed p, unless it is greatest at an end. To get there it needs
at least the time of the quickest rise from the first state to p with the acceleration gone, from there on at least
that of the quickest fall, read backwards; and where both together are shorter than the way, the rest at speed p. The
first grows with p, the second falls, so that no motion is quicker than that whose rise and fall just fill the way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coord.model.arrays import Array

#: Newton steps for the greatest speed; they come down to it from above, so few are enough.
_STEPS = 7

#: [m/s] The greatest speed is taken a little too low by this, and by so many times the last step.
_BELOW, _STEP_SHARE = 1e-9, 2.0


@dataclass(frozen=True, slots=True, eq=False)
class Rise:
    """The quickest ways (n,) from speeds [m/s] and accelerations up to any greater speed without acceleration.

    ``most`` [m/s2], ``jerk`` [m/s3] : limits. ``virtual`` : (n,) the speed [m/s] from which, at rest in acceleration,
    the same rise would have begun ``since`` (n,) [s] and ``behind`` (n,) [m] earlier; ``least`` : (n,) the least
    greatest speed [m/s] that says something.
    """

    most: float
    jerk: float
    virtual: Array
    since: Array
    behind: Array
    least: Array

    def time(self, speed: Array) -> Array:
        """The time [s] up to a speed, (n,) or what broadcasts with it."""
        return self._whole(speed) - self.since

    def way(self, speed: Array) -> Array:
        """The way [m] up to a speed."""
        return (self.virtual + speed) / 2 * self._whole(speed) - self.behind

    def growth(self, speed: Array) -> Array:
        """How quickly the way grows with the speed [s]."""
        more = np.maximum(speed - self.virtual, 1e-300)
        long = speed / self.most + self.most / (2 * self.jerk)
        short = np.sqrt(more / self.jerk) + (self.virtual + speed) / (2 * np.sqrt(more * self.jerk))
        return np.where(more >= self.most**2 / self.jerk, long, short)

    def _whole(self, speed: Array) -> Array:
        more = np.maximum(speed - self.virtual, 0.0)
        return np.where(
            more >= self.most**2 / self.jerk, more / self.most + self.most / self.jerk, 2 * np.sqrt(more / self.jerk)
        )

    def along(self, axis: int) -> Rise:
        """The same as a column (axis 0) or a row (axis 1) of a table."""
        arrays = (self.virtual, self.since, self.behind, self.least)
        return Rise(self.most, self.jerk, *(np.expand_dims(values, 1 - axis) for values in arrays))


def rise(speed: Array, low: Array, high: Array, most: float, jerk: float, top: float) -> Rise:
    """The rises of motions that begin with at most speeds (n,) [m/s], accelerations between two (n,), (n,) [m/s2].

    ``top`` : they never go faster [m/s]. Where the acceleration falls from the beginning on, the greatest speed may
    have been before, so that no lesser one than that counts.
    """
    # a speed that leaves no room for the acceleration to end: the comparison starts with what there is room for
    a = np.minimum(high, np.sqrt(2 * jerk * np.maximum(top - speed, 0.0)))
    since = a / jerk
    virtual = speed - a**2 / (2 * jerk)
    behind = virtual * since + jerk * since**3 / 6
    least = speed + np.maximum(np.maximum(a, 0.0), np.maximum(-low, 0.0)) ** 2 / (2 * jerk)
    return Rise(most, jerk, virtual, since, behind, least)


def least_times(first: Rise, last: Rise, length: float, top: float) -> Array:
    """Times (n, m) [s] that no motion of a length [m] beats, from each beginning of the one to each of the other.

    The other is read backwards. ``top`` : the motions never go faster [m/s]. 0 where the way is too short for a rise
    and a fall: then other bounds must do.
    """
    up, down = first.along(0), last.along(1)
    low = np.maximum(up.least, down.least)

    def spare(speed: Array) -> Array:
        return np.asarray(length - up.way(speed) - down.way(speed))

    at_top = np.full(low.shape, top)
    cruised = spare(at_top)
    times = up.time(at_top) + down.time(at_top) + np.maximum(cruised, 0.0) / top
    is_slower = cruised < 0
    if is_slower.any():
        speed, step = at_top, np.zeros_like(low)
        for _ in range(_STEPS):
            step = spare(speed) / (up.growth(speed) + down.growth(speed))
            speed = np.maximum(speed + np.minimum(step, 0.0), low)
        below = np.maximum(speed - _BELOW - _STEP_SHARE * np.abs(step), low)
        below = np.where(spare(below) >= 0, below, low)
        times = np.where(is_slower, up.time(below) + down.time(below), times)
    return np.where((low <= top) & (spare(low) >= 0), times, 0.0)
