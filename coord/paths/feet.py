"""The feet of an exponential detour: how the curve leaves the straight line, and gets back to it.

An exponential never reaches the line. So it is cut, and a polynomial leads on: a quintic that ends flat and straight,
where the robot drives on along the line; or, next to the robot's start or goal, y = a t + b t^3 + c t^4 straight
from there, which meets the line at an angle: a robot at rest may head anywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from coord.model.arrays import Array

#: Shares of the height at which the exponential is cut: the first, or the next where there is no room for its tail.
_CUTS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4)

#: Lengths of the quintic, in units of 1/B, the smoothest first; the length of the quartic that bends one way only.
_QUINTICS, _QUARTIC = (3.0, 2.0, 1.5), 2.0


class Foot(NamedTuple):
    """Where a flank is cut: x [m], y [m], y' [1] and y'' [1/m] seen uphill, and the length [m] of what is below.

    ``at_angle`` : it meets the line at an angle, not along it.
    """

    x: float
    y: float
    slope: float
    second: float
    length: float
    at_angle: bool = False

    def below(self, u: Array) -> Array:
        """y, y', y'' (3, n) at the distances u (n,) [m] uphill of the cut, up to 0; straight at the line."""
        t = np.maximum(u / self.length + 1, 0.0)
        y, m, q = self.y, self.slope * self.length, self.second * self.length**2
        found = np.zeros((3, len(t)))
        if self.at_angle:
            terms = (1, 2 * y - m + q / 6), (3, 2 * m - 2 * y - q / 2), (4, y - m + q / 3)
        else:
            terms = (3, 10 * y - 4 * m + q / 2), (4, 7 * m - 15 * y - q), (5, 6 * y - 3 * m + q / 2)
        for power, factor in terms:
            found[0] += factor * t**power
            found[1] += factor * power * t ** (power - 1)
            found[2] += factor * power * (power - 1) * t ** max(power - 2, 0)
        return np.asarray(found / np.array([[1.0], [self.length], [self.length**2]]))


def fitting(cut_at: Callable[[float], Foot], middle: float, room: float, *, at_angle: bool) -> Foot | None:
    """The foot within the room [m] from the middle of a detour to its end; None where there is none.

    Parameters
    ----------
    cut_at : the foot with the cut at a share of the height, and a length of 1/B.
    at_angle : whether it goes all the way to the end of the room, and meets the line at an angle.
    """
    if at_angle:
        feet = [foot for foot in map(cut_at, _CUTS) if abs(foot.x - middle) < room]
        long = [(room - abs(foot.x - middle)) / foot.length for foot in feet]
        if not feet:
            return None
        k = min(range(len(feet)), key=lambda k: abs(long[k] - _QUARTIC))
        return feet[k]._replace(length=long[k] * feet[k].length, at_angle=True)
    for foot in map(cut_at, _CUTS):
        for longer in _QUINTICS:
            if abs(foot.x - middle) + longer * foot.length <= room:
                return foot._replace(length=longer * foot.length)
    return None
