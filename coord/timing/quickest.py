"""The greatest speed there can be from some state on: ramps for many accelerations at once, and their inverse.

Acceleration rises by ``jerk`` at most and must be gone when full speed is reached, so
v' <= f(t, v) = min(most, a0 + jerk t, sqrt(2 jerk (top - v))). By comparison v lies below the solution of
v' = f(t, v) that starts no slower and with no less acceleration, and the way lies below its integral.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coord.model.arrays import Array

#: Moments at which a ramp is tabulated.
_MOMENTS = 128


@dataclass(frozen=True, slots=True, eq=False)
class Ramps:
    """Ramps (n,) from one speed and n accelerations up to full speed, three phases each.

    Parameters
    ----------
    knots : (n, 4) times [s] at which phases begin; from the last on speed is ``top`` [m/s].
    states : (n, 4, 3) way [m], speed and acceleration there; ``jerks`` : (3,) of the phases.
    times, ways, speeds : (n, m) tables, the ways increasing.
    """

    knots: Array
    states: Array
    jerks: Array
    top: float
    times: Array
    ways: Array
    speeds: Array

    def way(self, times: Array) -> Array:
        """Ways (n, m) [m] after the times (n, m) [s]."""
        return _at(self.knots, self.states, self.jerks, times)[0]

    def time(self, ways: Array) -> Array:
        """Times (n, m) [s] before which no ramp has gone the ways (n, m) [m]; short by less than a millisecond."""
        k = (self.ways[:, None, :] <= ways[:, :, None]).sum(axis=2) - 1
        k = np.clip(k, 0, self.times.shape[1] - 1)
        row = np.arange(len(k))[:, None]
        following = np.minimum(k + 1, self.times.shape[1] - 1)
        # within a step of the table no speed is above that at its ends: a dip is convex, the rest rises
        speed = np.maximum(self.speeds[row, k], self.speeds[row, following])
        speed = np.where(k == following, self.top, speed)
        more = np.divide(np.maximum(ways - self.ways[row, k], 0.0), speed, out=np.zeros_like(ways), where=speed > 0)
        latest = np.where(k == following, np.inf, self.times[row, following])
        return np.asarray(np.minimum(self.times[row, k] + more, latest))


def ramps(speed: float, accelerations: Array, top: float, most: float, jerk: float) -> Ramps:
    """The ramps from a speed [m/s] and accelerations (n,) [m/s2] up to ``top`` with at most ``most`` and ``jerk``."""
    spare = max(top - speed, 0.0)
    # a speed that leaves no room for the acceleration to end: the comparison starts with what there is room for
    a = np.minimum(accelerations, np.sqrt(2 * jerk * spare))
    peak = np.minimum(most, np.sqrt(jerk * spare + a**2 / 2))
    rise, fall = (peak - a) / jerk, peak / jerk
    rest = spare - (2 * peak**2 - a**2) / (2 * jerk)
    hold = np.maximum(np.divide(rest, peak, out=np.zeros_like(a), where=peak > 0), 0.0)
    knots = np.cumsum([np.zeros_like(a), rise, hold, fall], axis=0).T
    jerks = np.array([jerk, 0.0, -jerk])
    states = np.zeros((len(a), 4, 3))
    states[:, 0, 1], states[:, 0, 2] = speed, a
    for p, h in enumerate((rise, hold, fall)):
        s, v, b = states[:, p].T
        j = jerks[p]
        states[:, p + 1] = np.stack([s + h * (v + h * (b / 2 + h * j / 6)), v + h * (b + h * j / 2), b + h * j], axis=1)
    states[:, 3, 1:] = top, 0.0
    times = np.concatenate([knots[:, -1:] * np.linspace(0.0, 1.0, _MOMENTS)[None], knots], axis=1)
    times.sort(axis=1)
    ways, speeds = _at(knots, states, jerks, times)
    return Ramps(knots, states, jerks, top, times, np.maximum.accumulate(ways, axis=1), speeds)


def _at(knots: Array, states: Array, jerks: Array, times: Array) -> tuple[Array, Array]:
    """Ways and speeds (n, m) at the times (n, m)."""
    phase = (knots[:, None, 1:] <= times[:, :, None]).sum(axis=2)
    row = np.arange(len(times))[:, None]
    s, v, a = (states[row, phase, k] for k in range(3))
    h = times - knots[row, phase]
    j = np.append(jerks, 0.0)[phase]
    return s + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2)
