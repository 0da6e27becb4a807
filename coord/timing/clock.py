"""Ego's clock: a place on its way is told by the time at which the motion with the jerk forgotten is there.

No motion is faster anywhere, so in this clock every motion advances by at most one second a second.
"""

from __future__ import annotations

import numpy as np

from coord.model.arrays import Array
from coord.model.profile import VelocityProfile


def clock(relaxed: VelocityProfile, s: Array) -> Array:
    """The times (m,) [s] at which the motion without jerk is at the arc lengths s (m,) [m], or at the nearer end."""
    s = np.minimum(np.maximum(s, 0.0), relaxed.length)
    k = np.maximum(np.minimum(relaxed.states[:, 0].searchsorted(s, side="right") - 1, len(relaxed.times) - 2), 0)
    s0, v, a = relaxed.states[k].T
    root = v + np.sqrt(np.maximum(v * v + 2 * a * (s - s0), 0.0))
    u = np.divide(2 * (s - s0), root, out=np.zeros_like(s), where=root > 0)
    return np.asarray(np.minimum(relaxed.times[k] + u, relaxed.times[k + 1]))
