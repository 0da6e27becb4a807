"""From the numbers of a solver to a profile that ends exactly where it should."""

from __future__ import annotations

import math

import numpy as np

from coord.model.arrays import Array
from coord.model.profile import VelocityProfile, integrate

#: [s] Phases shorter than this are dropped; the correction makes up for them.
_SHORTEST = 1e-7


def land_exactly(durations: Array, jerks: Array, length: float, departure: float = 0.0) -> VelocityProfile | None:
    """The profile with these phases, its jerks changed as little as possible so that it ends at rest at ``length``.

    With the durations kept, the last state is linear in the jerks, so the least change in the sense of
    least squares follows from a 3 x 3 system. None where that system is singular or numbers are not finite.
    """
    keep = durations > _SHORTEST
    h, j = durations[keep], jerks[keep].copy()
    if len(h) < 3 or not (np.all(np.isfinite(h)) and np.all(np.isfinite(j))):
        return None
    rest = np.sum(h) - np.cumsum(h)  # time left after each phase
    effect = np.stack([h**3 / 6 + rest * h**2 / 2 + rest**2 * h / 2, h**2 / 2 + rest * h, h])
    # scaled rows keep the 3 x 3 system well conditioned on long motions
    scale = np.abs(effect).max(axis=1)
    rows = effect / scale[:, None]
    for _ in range(3):
        states = integrate((0.0, 0.0, 0.0), h.tolist(), j.tolist())
        s, v, a = states[-1]
        gap = [(length - s) / scale[0], -v / scale[1], -a / scale[2]]
        change = _least_norm(rows, gap)
        if change is None:
            return None
        j = j + change
    states = integrate((0.0, 0.0, 0.0), h.tolist(), j.tolist())
    if max(abs(states[-1][0] - length), abs(states[-1][1]), abs(states[-1][2])) > 1e-10:
        return None
    states[-1] = (length, 0.0, 0.0)
    times = departure + np.concatenate([[0.0], np.cumsum(h)])
    return VelocityProfile(times, states, j)  # type: ignore[arg-type]


def _least_norm(rows: Array, gap: list[float]) -> Array | None:
    """The shortest x with rows x = gap, through the 3 x 3 normal equations, solved by Cramer's rule.

    Written out because the bytes of numpy's own solvers change with threads and processors.
    """
    g = [[math.fsum((rows[i] * rows[k]).tolist()) for k in range(3)] for i in range(3)]

    def det(m: list[list[float]]) -> float:
        return (
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        )

    whole = det(g)
    if not abs(whole) > 0:
        return None
    y = [det([[gap[i] if k == column else g[i][k] for k in range(3)] for i in range(3)]) / whole for column in range(3)]
    return np.asarray(y[0] * rows[0] + y[1] * rows[1] + y[2] * rows[2])
