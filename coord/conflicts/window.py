"""When a place is taken: the forbidden arc lengths of one robot over time, given another robot's motion.

Between two nodes of a conflict region the other robot moves monotonically, so the lines that bound the
forbidden arc lengths over its path become lines over time. A window is a chain of such strips; below it the
robot passes *after* the other, above it *before*.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from coord.alone.inverse import time_at
from coord.conflicts.region import ConflictRegion
from coord.model.arrays import Array, frozen
from coord.model.profile import VelocityProfile
from coord.tolerances import SAME_PLACE

#: [m] Strips are cut until the other's motion within one differs from a line over time by less than this.
BEND: Final = 5e-4


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """Forbidden: low(t) < s < high(t) while ``times[0]`` <= t <= ``times[-1]``.

    Parameters
    ----------
    other : index of the robot that is there.
    times : (n+1,) array [s], increasing; the last may be infinite where the other stays for ever.
    low, high : (n, 2) arrays [m], the bounds at both ends of each strip; linear in between.
    """

    other: int
    times: Array
    low: Array
    high: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", frozen(self.times))
        object.__setattr__(self, "low", frozen(self.low, 2))
        object.__setattr__(self, "high", frozen(self.high, 2))

    @property
    def lasts(self) -> bool:
        """Whether the other never leaves."""
        return bool(np.isinf(self.times[-1]))


def window(
    region: ConflictRegion,
    other: int,
    profile: VelocityProfile,
    *,
    waits: bool = True,
    parks: bool = True,
    bend: float = BEND,
) -> Window | None:
    """The window of a region while the other robot follows its profile; None where it never gets there.

    Parameters
    ----------
    waits, parks : whether the other's start (goal) itself is in ego's way. An exact test knows, the padded
        region does not; if so, resting there counts from t = 0 on (for ever).
    bend : by how much [m] the other's motion may differ from a line over time within a strip.
    """
    nodes = region.sigma
    if len(profile.jerks) == 0:
        return _resting(region, other, 0.0, np.inf if parks else profile.arrival)
    if nodes[0] >= profile.length:
        return _resting(region, other, profile.arrival, np.inf) if parks else None
    times = time_at(profile, nodes)
    at_start, at_goal = nodes[0] <= SAME_PLACE, nodes[-1] >= profile.length - SAME_PLACE
    times[0] = profile.departure if at_start else times[0]
    times[-1] = profile.arrival if at_goal else times[-1]
    cuts = _cut(times, profile, bend)
    cell = np.clip(np.searchsorted(times, (cuts[:-1] + cuts[1:]) / 2, side="right") - 1, 0, len(nodes) - 2)
    sigma = np.clip(profile.places(cuts), nodes[0], nodes[-1])
    low, high = _lines_over_time(region, profile, cuts, cell, sigma)
    if at_start and waits and cuts[0] > 0:
        cuts = np.concatenate([[0.0], cuts])
        low, high = np.concatenate([low[:1, [0, 0]], low]), np.concatenate([high[:1, [0, 0]], high])
    if at_goal and parks:
        cuts = np.concatenate([cuts, [np.inf]])
        low, high = np.concatenate([low, low[-1:, [1, 1]]]), np.concatenate([high, high[-1:, [1, 1]]])
    return Window(other, cuts, low, high)


def _resting(region: ConflictRegion, other: int, since: float, until: float) -> Window:
    low, high = region.s_range
    return Window(other, frozen([since, until]), frozen([[low, low]]), frozen([[high, high]]))


def _cut(times: Array, profile: VelocityProfile, most: float) -> Array:
    """Strip borders: where nodes are passed, where phases end, and more where the motion bends."""
    inside = profile.times[(profile.times > times[0]) & (profile.times < times[-1])]
    edges = np.unique(np.concatenate([times, inside]))
    h = np.diff(edges)
    bend = np.abs(profile.state(np.concatenate([edges[:-1], edges[1:]]))[:, 2]).reshape(2, -1).max(axis=0)
    count = np.maximum(1, np.ceil(h * np.sqrt(bend / (8 * most)))).astype(int)
    within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return np.append(within * np.repeat(h / count, count) + np.repeat(edges[:-1], count), edges[-1])


def _lines_over_time(
    region: ConflictRegion, profile: VelocityProfile, cuts: Array, cell: npt.NDArray[np.intp], sigma: Array
) -> tuple[Array, Array]:
    """Lines over time on the safe side of the lines over sigma.

    Within a strip sigma(t) lies within max|a| h^2 / 8 of the line between its ends.
    """
    width = np.diff(region.sigma)[cell]
    share = (np.stack([sigma[:-1], sigma[1:]], axis=1) - region.sigma[cell][:, None]) / width[:, None]
    share = np.clip(share, 0.0, 1.0)
    a = np.abs(profile.state(cuts)[:, 2])
    bend = np.maximum(a[:-1], a[1:]) * np.diff(cuts) ** 2 / 8
    bounds = []
    for line, sign in ((region.low[cell], -1.0), (region.high[cell], 1.0)):
        slope = (line[:, 1] - line[:, 0]) / width
        values = line[:, :1] + (line[:, 1:] - line[:, :1]) * share
        bounds.append(values + sign * (np.abs(slope) * bend)[:, None])
    return bounds[0], bounds[1]


def stay_within(bounds: Window, start_free: bool, goal_free: bool, length: float) -> Window:
    """The window cut at ego's start and goal where an exact test has shown that resting there is allowed.

    A strip whose bound crosses the cut gets the constant bound: a line between clipped ends would be unsafe.
    """
    low, high = bounds.low, bounds.high
    if start_free:
        low = np.where(low.min(axis=1, keepdims=True) < 0, 0.0, low)
    if goal_free:
        high = np.where(high.max(axis=1, keepdims=True) > length, length, high)
    return Window(bounds.other, bounds.times, low, high)
