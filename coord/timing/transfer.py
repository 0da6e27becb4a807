"""The least time from one speed and acceleration to another over some way: closed forms, for many pairs at once.

A motion between two places has somewhere its greatest speed p, unless it is greatest at an end. To get there it needs
at least the time of the quickest rise from the first state to p with the acceleration gone, from there on at least
that of the quickest fall, read backwards; and where both together are shorter than the way, the rest at speed p. The
first grows with p, the second falls, so that no motion is quicker than that whose rise and fall just fill the way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array

#: Newton steps for the greatest speed; they come down to it from above, so few are enough.
_STEPS = 7

#: [m/s] Steps below this are the last.
_SETTLED = 1e-10

#: [m/s] The greatest speed is taken a little too low by this, and by so many times the last step.
_BELOW, _STEP_SHARE = 1e-9, 2.0


@dataclass(frozen=True, slots=True, eq=False)
class Rise:
    """The quickest ways (n,) from speeds [m/s] and accelerations up to any greater speed without acceleration.

    Parameters
    ----------
    most, jerk : limits (n,) [m/s2] and [m/s3].
    virtual : (n,) the speed [m/s] from which, without acceleration, the same rise would have begun ``since`` (n,) [s]
        and ``behind`` (n,) [m] earlier.
    least : (n,) the least greatest speed [m/s] that says something.
    """

    most: Array
    jerk: float
    virtual: Array
    since: Array
    behind: Array
    least: Array

    def time(self, speed: Array) -> Array:
        """The times (n,) [s] up to speeds (n,)."""
        return self._whole(speed) - self.since

    def way(self, speed: Array) -> Array:
        """The ways (n,) [m] up to speeds (n,)."""
        return (self.virtual + speed) / 2 * self._whole(speed) - self.behind

    def way_and_growth(self, speed: Array) -> tuple[Array, Array]:
        """The same, and how quickly they grow with the speeds (n,) [s]."""
        more, mean, most = np.maximum(speed - self.virtual, 1e-300), (self.virtual + speed) / 2, self.most
        root = np.sqrt(more / self.jerk)
        is_long = more >= most**2 / self.jerk
        whole = np.where(is_long, more / most + most / self.jerk, 2 * root)
        growth = np.where(is_long, speed / most + most / (2 * self.jerk), root + mean / (root * self.jerk))
        return mean * whole - self.behind, growth

    def most_speed(self, other: Rise, way: Array) -> Array:
        """Speeds (n,) [m/s] that are too high for this rise and an ``other`` one to fit into ways (n,) [m], or just.

        A rise takes no less than the difference of the speeds over the limit of the acceleration.
        """
        own, theirs = 1 / (2 * self.most), 1 / (2 * other.most)
        room = way + self.behind + other.behind + own * self.virtual**2 + theirs * other.virtual**2
        return np.asarray(np.sqrt(np.maximum(room, 0.0) / (own + theirs)))

    def _whole(self, speed: Array) -> Array:
        more = np.maximum(speed - self.virtual, 0.0)
        return np.where(
            more >= self.most**2 / self.jerk, more / self.most + self.most / self.jerk, 2 * np.sqrt(more / self.jerk)
        )

    def of(self, some: npt.NDArray[np.intp]) -> Rise:
        """Some of them, in that order."""
        arrays = (self.virtual[some], self.since[some], self.behind[some], self.least[some])
        return Rise(self.most[some], self.jerk, *arrays)


def rise(speed: Array, low: Array, high: Array, most: Array, jerk: float, top: Array) -> Rise:
    """The rises of motions that begin with at most speeds (n,) [m/s], accelerations between two (n,), (n,) [m/s2].

    ``most`` : (n,) limits [m/s2] of the acceleration; ``top`` : (n,) they never go faster [m/s]. Where the acceleration
    falls from the beginning on, the greatest speed may have been before, so that no lesser one than that counts.
    """
    # a speed that leaves no room for the acceleration to end: the comparison starts with what there is room for
    a = np.minimum(high, np.sqrt(2 * jerk * np.maximum(top - speed, 0.0)))
    since = a / jerk
    virtual = speed - a**2 / (2 * jerk)
    behind = virtual * since + jerk * since**3 / 6
    least = speed + np.maximum(np.maximum(a, 0.0), np.maximum(-low, 0.0)) ** 2 / (2 * jerk)
    return Rise(most, jerk, virtual, since, behind, least)


def least_times(first: Rise, last: Rise, length: Array, top: Array) -> Array:
    """Times (n,) [s] that no motion of lengths (n,) [m] beats, from the beginning of the one to that of the other.

    The other is read backwards. ``top`` : (n,) the motions never go faster [m/s]. 0 where the way is too short for a
    rise and a fall: then other bounds must do.
    """
    low = np.maximum(first.least, last.least)
    spare = length - first.way(top) - last.way(top)
    times = first.time(top) + last.time(top) + np.maximum(spare, 0.0) / top
    slower = np.flatnonzero(spare < 0)
    some = first.of(slower), last.of(slower), length[slower], top[slower], low[slower]
    times[slower] = _below_top(*some)
    fits = (low <= top) & (length - first.way(low) - last.way(low) >= 0)
    return np.where(fits, times, 0.0)


def _below_top(first: Rise, last: Rise, length: Array, top: Array, low: Array) -> Array:
    """The same where rise and fall up to the top speed are longer than the way: they fill it."""
    speed = np.maximum(np.minimum(top, first.most_speed(last, length)), low)
    step = np.zeros_like(low)
    for _ in range(_STEPS):
        (way, growth), (way_down, growth_down) = first.way_and_growth(speed), last.way_and_growth(speed)
        slower = np.maximum(speed + np.minimum((length - way - way_down) / (growth + growth_down), 0.0), low)
        step, speed = speed - slower, slower
        if step.max(initial=0.0) < _SETTLED:
            break
    below = np.maximum(speed - _BELOW - _STEP_SHARE * step, low)
    below = np.where(length - first.way(below) - last.way(below) >= 0, below, low)
    return first.time(below) + last.time(below)
