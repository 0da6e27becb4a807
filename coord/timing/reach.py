"""Where ego can be when: ranges of arc length over time that hold for every motion, and what follows from them.

All is said in ego's clock (``coord.timing.clock``), in which every motion advances by at most one second a second:
so a bound at one time bounds all other times.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from coord.alone.ramp import Ramp
from coord.model.arrays import Array
from coord.timing.clock import clock
from coord.timing.ego import Ego
from coord.tolerances import SAME_PLACE

#: [s] Contradictions smaller than this are rounding.
_SLACK = 1e-6

#: At a time [s], a place in ego's clock [s], and whether ego is no further than that then, or no less far.
Cut: TypeAlias = tuple[float, float, bool]


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A place that is truly taken for a while: strictly between ``low`` and ``high`` (m,) [m] at ``times`` (m,) [s].

    ``low_clock``, ``high_clock`` : the same in ego's clock [s]. ``can_follow``, ``can_precede`` : whether the bounds
    lie on ego's way at all. Every motion passes one part on one side.
    """

    times: Array
    low: Array
    high: Array
    low_clock: Array
    high_clock: Array
    can_follow: bool
    can_precede: bool


def part(ego: Ego, times: Array, low: Array, high: Array, *, lasts: bool) -> Part:
    """The part with these bounds at increasing times; ``lasts``: the other robot never leaves."""
    clocks = [clock(ego.relaxed, line) for line in (low, high)]
    can_follow = not lasts and bool(low.min() >= -SAME_PLACE)
    return Part(times, low, high, clocks[0], clocks[1], can_follow, bool(high.max() <= ego.length + SAME_PLACE))


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """Bounds at single times: in ego's clock no later than ``high`` (n,) [s], or no earlier than ``low`` (m,) [s]."""

    high_times: Array
    high: Array
    low_times: Array
    low: Array


Settled: TypeAlias = tuple[dict[int, bool], Marks]


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """Where ego can be at all if it departs from rest and is to rest at its goal by an arrival [s].

    Parameters
    ----------
    times : (M,) those of all parts [s], one part after the other; ``begins`` : (P,) where each part's begin.
    low, high : (M,) least and largest places then, in ego's clock [s], whatever the sides.
    """

    ego: Ego
    arrival: float
    parts: Sequence[Part]
    times: Array
    begins: npt.NDArray[np.intp]
    low: Array
    high: Array


def reach_by(ego: Ego, parts: Sequence[Part], arrival: float) -> Reach:
    """Where ego can be when if it is to arrive by then, past these parts."""
    times = np.concatenate([np.empty(0), *(one.times for one in parts)])
    begins = np.cumsum([0, *(len(one.times) for one in parts)])[:-1]
    return Reach(ego, arrival, parts, times, begins, _latest(ego, arrival, times), _earliest(ego, times))


def soonest(ego: Ego, times: Array, high_times: Array, high: Array) -> Array:
    """The largest arc lengths (m,) [m] at the times (m,) [s], below bounds (n,) [m] at increasing times (n,) [s]."""
    bounds = Marks(high_times, clock(ego.relaxed, high), np.empty(0), np.empty(0))
    _, most = _narrowed(bounds, times, np.zeros(len(times)), _earliest(ego, times))
    return ego.relaxed.places(np.maximum(most, 0.0))


def ranges(reach: Reach, bounds: Marks, times: Array) -> tuple[Array, Array]:
    """Least and largest places (m,), (m,) [s in ego's clock] at the times (m,) [s]."""
    low, high = _latest(reach.ego, reach.arrival, times), _earliest(reach.ego, times)
    return _narrowed(bounds, times, low, high)


def settled(reach: Reach, chosen: Mapping[int, bool], cuts: Sequence[Cut]) -> Settled | None:
    """The sides of parts that follow from those chosen (after: True), with all bounds; None where no motion is left."""
    sides = dict(chosen)
    parts = reach.parts
    if not parts:
        return sides, _marks(parts, sides, cuts)
    low_clock = np.concatenate([one.low_clock for one in parts])
    high_clock = np.concatenate([one.high_clock for one in parts])
    while True:
        bounds = _marks(parts, sides, cuts)
        low, high = _narrowed(bounds, reach.times, reach.low, reach.high)
        if np.any(low > high + _SLACK):
            return None
        too_far = np.logical_or.reduceat(low > low_clock + _SLACK, reach.begins).tolist()
        not_far_enough = np.logical_or.reduceat(high < high_clock - _SLACK, reach.begins).tolist()
        found: dict[int, bool] = {}
        for k, one in enumerate(parts):
            can_follow, can_precede = one.can_follow and not too_far[k], one.can_precede and not not_far_enough[k]
            if not (can_follow if sides.get(k, can_follow) else can_precede):
                return None
            if k not in sides and can_follow != can_precede:
                found[k] = can_follow
        if not found:
            return sides, bounds
        sides |= found


def _marks(parts: Sequence[Part], sides: Mapping[int, bool], cuts: Sequence[Cut]) -> Marks:
    """The bounds of the parts whose side is settled, and those of the cuts."""
    high = [(parts[k].times, parts[k].low_clock) for k, passes_after in sides.items() if passes_after]
    low = [(parts[k].times, parts[k].high_clock) for k, passes_after in sides.items() if not passes_after]
    for time, place, is_upper in cuts:
        (high if is_upper else low).append((np.array([time]), np.array([place])))
    return Marks(*_sorted(high), *_sorted(low))


def _sorted(pairs: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    if not pairs:
        return np.empty(0), np.empty(0)
    times, clocks = (np.concatenate([pair[k] for pair in pairs]) for k in (0, 1))
    order = np.argsort(times, kind="stable")
    return times[order], clocks[order]


def _narrowed(bounds: Marks, times: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """The ranges at some times, narrowed by bounds at other times."""
    if len(bounds.high):
        at = bounds.high_times
        since = np.append(np.inf, np.minimum.accumulate(bounds.high - at))
        until = np.append(np.minimum.accumulate(bounds.high[::-1])[::-1], np.inf)
        high = np.minimum(high, since[np.searchsorted(at, times, side="right")] + times)
        high = np.minimum(high, until[np.searchsorted(at, times, side="left")])
    if len(bounds.low):
        at = bounds.low_times
        since = np.append(-np.inf, np.maximum.accumulate(bounds.low))
        until = np.append(np.maximum.accumulate((bounds.low - at)[::-1])[::-1], -np.inf)
        low = np.maximum(low, since[np.searchsorted(at, times, side="right")])
        low = np.maximum(low, until[np.searchsorted(at, times, side="left")] + times)
    return low, high


def _earliest(ego: Ego, times: Array) -> Array:
    """The largest places (m,) [s in ego's clock] that can be reached from the start by the times (m,) [s]."""
    relaxed, t = ego.relaxed, np.maximum(times - ego.alone.departure, 0.0)
    high = np.minimum(np.minimum(t, clock(relaxed, _way(ego.launch, t))), relaxed.arrival)
    if ego.bends is None:
        return np.asarray(high)
    at = clock(relaxed, ego.bends.places)
    k = np.maximum(np.searchsorted(at + ego.bends.late, t, side="right") - 1, 0)
    high = np.minimum(high, np.minimum(t - ego.bends.late[k], np.append(at, np.inf)[k + 1]))
    return np.asarray(np.minimum(high, clock(relaxed, ego.bends.reached(t))))


def _latest(ego: Ego, arrival: float, times: Array) -> Array:
    """The least places (m,) [s in ego's clock] from which the goal can still be reached by the arrival."""
    relaxed, left = ego.relaxed, np.maximum(arrival - times, 0.0)
    low = np.maximum(relaxed.arrival - left, clock(relaxed, ego.length - _way(ego.landing, left)))
    if ego.bends is None:
        return np.maximum(low, 0.0)
    at = clock(relaxed, ego.bends.places)
    needed = relaxed.arrival - at + ego.bends.long  # falls along the way
    k = np.minimum(np.searchsorted(-needed, -left, side="left"), len(at) - 1)  # the first from which the time suffices
    low = np.maximum(low, np.append(0.0, at)[k])
    low = np.maximum(low, np.minimum(relaxed.arrival - left + ego.bends.long[k], at[k]))
    return np.asarray(np.maximum(low, clock(relaxed, ego.bends.due(left))))


def _way(ramp: Ramp, times: Array) -> Array:
    """How far (m,) [m] the ramp gets in the times (m,) [s]."""
    profile = ramp.profile
    return np.asarray(profile.places(times) + ramp.speed * np.maximum(times - profile.arrival, 0.0))
