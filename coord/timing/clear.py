"""Is a profile clear of a window? Exact: the extremes of cubics between all knots and strip borders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.conflicts.window import Window
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile

#: [m] Bounds may be missed by this much: a thousandth of the margin that the regions carry.
SLACK = 1e-9


@dataclass(frozen=True, slots=True)
class Excess:
    """How far [m] a profile reaches above a window's lower and below its upper bound, at worst.

    ``over_low`` <= 0: it passes after the other; ``under_high`` <= 0: before. Both above 0: a collision course,
    the first time [s] of which is ``time``.
    """

    over_low: float
    under_high: float
    time: float

    @property
    def is_clear(self) -> bool:
        """Whether the profile passes on one side of the window."""
        return self.over_low <= SLACK or self.under_high <= SLACK

    @property
    def passes_after(self) -> bool:
        """Whether it passes after the other robot; where it is clear on neither side, which it is nearer to."""
        return self.over_low <= SLACK or SLACK < self.under_high > self.over_low


def excess(profile: VelocityProfile, window: Window) -> Excess:
    """How far a profile is from passing after, and from passing before the robot of a window."""
    first, last = float(window.times[0]), float(window.times[-1])
    if np.isinf(last):
        last = max(profile.arrival, float(window.times[-2])) + 1.0
    edges = np.concatenate([window.times[:-1], [last]])
    inside = profile.times[(profile.times > first) & (profile.times < last)]
    times = np.sort(np.concatenate([edges, inside]))
    times = times[np.append(True, times[1:] > times[:-1])]
    start, h = times[:-1], np.diff(times)
    # the middle of a part of one ulp is one of its ends: hence the clip
    middle = start + h / 2
    strip = np.maximum(np.minimum(edges.searchsorted(middle, side="right") - 1, len(edges) - 2), 0)
    state = profile.state(start)
    moving = (start >= profile.departure) & (start < profile.arrival)
    if len(profile.jerks):
        phase = np.minimum(profile.times.searchsorted(middle, side="right") - 1, len(profile.jerks) - 1)
        phase = np.maximum(phase, 0)
        jerk = np.where(moving, profile.jerks[phase], 0.0)
    else:
        jerk = np.zeros_like(start)
    state[~moving, 1:] = 0.0
    # how far the cubics are above the lower line, and below the upper one, for both at once
    since, n = start - edges[strip], len(start)
    (low, low_slope), (high, high_slope) = (_line(line, edges, strip, since) for line in (window.low, window.high))
    s, v, c2 = state[:, 0], state[:, 1], state[:, 2] / 2
    c3 = jerk / 6
    most = _highest(
        np.concatenate([s - low, high - s]), np.concatenate([v - low_slope, high_slope - v]),
        np.concatenate([c2, -c2]), np.concatenate([c3, -c3]), np.concatenate([h, h]),
    )  # fmt: skip
    over, under = most[:n], most[n:]
    both = np.flatnonzero((over > SLACK) & (under > SLACK))
    return Excess(float(over.max()), float(under.max()), float(start[both[0]]) if len(both) else np.inf)


def _line(bound: Array, edges: Array, strip: npt.NDArray[np.intp], since: Array) -> tuple[Array, Array]:
    """Values of the strips' lines some time [s] after their beginnings, and their slopes."""
    slope = ((bound[:, 1] - bound[:, 0]) / (edges[1:] - edges[:-1]))[strip]
    return bound[strip, 0] + slope * since, slope


def _highest(c0: Array, c1: Array, c2: Array, c3: Array, h: Array) -> Array:
    """Largest values of cubics on [0, h]: at the ends or where the derivative vanishes."""
    root = np.sqrt(np.maximum(c2 * c2 - 3 * c1 * c3, 0.0))
    # both roots of c1 + 2 c2 u + 3 c3 u^2, written so that neither loses its digits
    q = -(c2 + np.where(c2 >= 0, root, -root))
    with np.errstate(divide="ignore", invalid="ignore"):
        u1, u2 = q / (3 * c3), c1 / q
    # fmin and fmax: a root that is none is an end
    candidates = np.fmin(np.fmax(np.stack([h, u1, u2]), 0.0), h)
    values = c0 + candidates * (c1 + candidates * (c2 + candidates * c3))
    return np.asarray(np.maximum(values.max(axis=0), c0))
