"""The greatest speed there can be from some state on: ramps for many accelerations at once, and their inverse.

Acceleration rises by ``jerk`` at most and must be gone when full speed is reached, so
v' <= f(t, v) = min(most, a0 + jerk t, sqrt(2 jerk (top - v))). By comparison v lies below the solution of
v' = f(t, v) that starts no slower and with no less acceleration, and the way lies below its integral.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from coord.alone.inverse import increasing_root
from coord.model.arrays import Array

#: Which ramps are meant.
Rows: TypeAlias = npt.NDArray[np.intp]

#: [m] Ways are asked for that much shorter: more than rounding can do, also where a ramp almost stands still.
_ROUNDING = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Ramps:
    """Ramps (n,) from speeds and accelerations up to full speed, three phases each.

    Parameters
    ----------
    knots : (n, 4) times [s] at which phases begin; from the last on speed is ``top`` [m/s].
    states : (n, 4, 3) way [m], speed and acceleration there; ``jerks`` : (3,) of the phases.
    dips : (n,) up to these times [s] a ramp loses speed.
    """

    knots: Array
    states: Array
    jerks: Array
    top: float
    dips: Array

    def way(self, times: Array, row: Rows) -> Array:
        """Ways [m] after times [s] of the ramps ``row``, or whatever these arrays make together."""
        return self._at(times, row)[0]

    def speed(self, times: Array, row: Rows) -> Array:
        """Speeds [m/s] after times [s], likewise."""
        return self._at(times, row)[1]

    def time(self, ways: Array, row: Rows) -> Array:
        """Times [s] before which the ramps have not gone some ways [m], likewise; short by rounding at most."""
        phase = np.maximum((self.states[row, :, 0] <= ways[..., None]).sum(axis=-1) - 1, 0)
        row = np.broadcast_to(row, ways.shape)
        (s, v, a), begin = np.moveaxis(self.states[row, phase], -1, 0), self.knots[row, phase]
        more = np.maximum(ways - _ROUNDING - s, 0.0)
        times = begin + more / self.top
        bent = phase < 3
        if bent.any():
            k, p = row[bent], phase[bent]
            cubic = (-more[bent], v[bent], a[bent] / 2, self.jerks[p] / 6)
            times[bent] = begin[bent] + increasing_root(cubic, self.knots[k, p + 1] - begin[bent])
        return np.asarray(times)

    def _at(self, times: Array, row: Rows) -> tuple[Array, Array]:
        phase = (self.knots[row, 1:] <= times[..., None]).sum(axis=-1)
        s, v, a = np.moveaxis(self.states[row, phase], -1, 0)
        h = times - self.knots[row, phase]
        j = np.append(self.jerks, 0.0)[phase]
        return np.asarray(s + h * (v + h * (a / 2 + h * j / 6))), np.asarray(v + h * (a + h * j / 2))


def ramps(speeds: Array, accelerations: Array, top: float, most: Array | float, jerk: float) -> Ramps:
    """The ramps from speeds (n,) [m/s] and accelerations (n,) [m/s2] up to ``top``.

    They keep within accelerations ``most``, (n,) or one for all [m/s2], and ``jerk`` [m/s3].
    """
    spare = np.maximum(top - speeds, 0.0)
    # a speed that leaves no room for the acceleration to end: the comparison starts with what there is room for
    a = np.minimum(accelerations, np.sqrt(2 * jerk * spare))
    peak = np.minimum(most, np.sqrt(jerk * spare + a**2 / 2))
    rise, fall = (peak - a) / jerk, peak / jerk
    rest = spare - (2 * peak**2 - a**2) / (2 * jerk)
    hold = np.maximum(np.divide(rest, peak, out=np.zeros_like(a), where=peak > 0), 0.0)
    knots = np.cumsum([np.zeros_like(a), rise, hold, fall], axis=0).T
    jerks = np.array([jerk, 0.0, -jerk])
    states = np.zeros((len(a), 4, 3))
    states[:, 0, 1], states[:, 0, 2] = speeds, a
    for p, h in enumerate((rise, hold, fall)):
        s, v, b = states[:, p].T
        j = jerks[p]
        states[:, p + 1] = np.stack([s + h * (v + h * (b / 2 + h * j / 6)), v + h * (b + h * j / 2), b + h * j], axis=1)
    states[:, 3, 1:] = top, 0.0
    return Ramps(knots, states, jerks, top, np.maximum(-a, 0.0) / jerk)
