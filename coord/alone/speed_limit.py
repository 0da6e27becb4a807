"""How fast a path may be driven: bends cap the speed through the lateral acceleration."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from coord.model.arrays import Array, frozen
from coord.model.path import Path
from coord.model.robot import Limits


@dataclass(frozen=True, slots=True, eq=False)
class SpeedLimit:
    """Speed caps along a path: section m reaches from ``ends[m-1]`` (0 for the first) to ``ends[m]`` [m].

    ``caps`` : (m,) largest speed [m/s]: min(speed, sqrt(lateral_acceleration / |curvature|)), the lowest of
    the section where the curvature varies. Neighbours with the same cap are one section.
    """

    ends: Array
    caps: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "ends", frozen(self.ends))
        object.__setattr__(self, "caps", frozen(self.caps))

    @property
    def is_constant(self) -> bool:
        """Whether one cap holds along the whole path."""
        return len(self.caps) <= 1

    def lowest(self, s_from: Array, s_to: Array) -> Array:
        """Lowest caps (m,) [m/s] on the closed intervals from s_from (m,) to s_to (m,) [m]."""
        last = len(self.caps) - 1
        first = np.minimum(np.searchsorted(self.ends, s_from, side="left"), last)
        final = np.minimum(np.searchsorted(self.ends, s_to, side="right"), last)
        return np.array([self.caps[i : k + 1].min() for i, k in zip(first, np.maximum(final, first), strict=True)])


def speed_limit(path: Path, limits: Limits, cap_ratio: float = 1.2) -> SpeedLimit:
    """The caps that the lateral acceleration sets along a path; see ``speed_limit_of``."""
    return speed_limit_of(path.pieces.tolist(), limits, cap_ratio)


def speed_limit_of(pieces: Iterable[tuple[float, float, float]], limits: Limits, cap_ratio: float) -> SpeedLimit:
    """The caps along the pieces of a path: length [m], curvature [1/m] at the start and at the end of each.

    A clothoid is cut where its cap has changed by the factor ``cap_ratio``; within a cut the lowest cap holds.
    Cuts of clothoids that differ by less than its root are one section: some curves have very many pieces.
    """
    ends: list[float] = []
    caps: list[float] = []
    position, highest = 0.0, 0.0  # the highest cap of the section if clothoids made it, else 0
    for length, k0, k1 in pieces:
        for cut, cap in _cuts(length, k0, k1, limits, cap_ratio):
            top = 0.0 if k0 == k1 or cap == limits.speed else max(cap, highest)
            if caps and (caps[-1] == cap or (highest and top and top**2 < cap_ratio * min(cap, caps[-1]) ** 2)):
                ends[-1], caps[-1], highest = position + cut, min(cap, caps[-1]), top
            else:
                ends.append(position + cut)
                caps.append(cap)
                highest = 0.0 if top == 0.0 else cap
        position += length
    return SpeedLimit(frozen(ends), frozen(caps))


def cap(curvature: float, limits: Limits) -> float:
    """Largest speed [m/s] at a curvature [1/m]."""
    if limits.speed**2 * abs(curvature) <= limits.lateral_acceleration:
        return limits.speed
    return math.sqrt(limits.lateral_acceleration / abs(curvature))


def _cuts(length: float, k0: float, k1: float, limits: Limits, cap_ratio: float) -> list[tuple[float, float]]:
    """Ends within the piece and caps of its cuts: where the cap has changed by the factor, or full speed is allowed."""
    if k0 == k1:
        return [(length, cap(k0, limits))]
    # the cap falls with the root of the curvature, so these are the curvatures at which the piece is cut
    level = limits.lateral_acceleration / limits.speed**2
    levels = [level]
    while levels[-1] < max(abs(k0), abs(k1)):
        levels.append(levels[-1] * cap_ratio**2)
    inside = {side * k for k in levels for side in (1, -1) if min(k0, k1) < side * k < max(k0, k1)}
    edges = [k0, *sorted(inside, reverse=k1 < k0), k1]
    return [
        (length * (after - k0) / (k1 - k0), cap(max(abs(before), abs(after)), limits))
        for before, after in itertools.pairwise(edges)
    ]
