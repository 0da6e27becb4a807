"""By how much later than alone a robot may be at each place of its way, and must be: a corridor of delays.

A window passed after asks for some delay at each of its places, one passed before allows no more than some. A motion
that is its quickest profile with a delay that grows in steps has to rise within this corridor.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from coord.alone.inverse import time_at
from coord.conflicts.window import Window
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile

#: Between the ends of a window's strips delays are known at so many places.
_PLACES = 3

#: [s] Delays but the last keep so far from what is allowed, which is not known between the places.
_APART = 0.02

#: [s] A step smaller than this is none.
_STEP = 1e-6

#: Steps at most.
_MOST_STEPS = 8

#: The room for a step before the place that needs it, as shares of the way in which a robot stops and sets off again.
_ROOMS = (2.0, 1.0, 0.5, 0.25)


@dataclass(frozen=True, slots=True, eq=False)
class Corridor:
    """The least delays (n,) [s] at places (n,) [m], and the largest ones (m,) [s] at places (m,) [m]."""

    least_at: Array
    least: Array
    most_at: Array
    most: Array


@dataclass(frozen=True, slots=True)
class Step:
    """A delay [s] that is allowed behind one place [m] and needed from another one [m] on."""

    delay: float
    allowed: float
    needed: float


def corridor(profile: VelocityProfile, afters: Sequence[Window], befores: Sequence[Window]) -> Corridor:
    """The delays of a profile that windows passed after need, and that those passed before allow, on its way."""
    least_at, least = _delays(profile, afters, [window.low for window in afters])
    most_at, most = _delays(profile, befores, [window.high for window in befores])
    later, sooner = least_at < profile.length, (most_at > 0) & (most_at <= profile.length)
    return Corridor(least_at[later], least[later], most_at[sooner], most[sooner])


def stairs(bounds: Corridor, delay: float, stretch: float, length: float) -> Iterator[tuple[Step, ...]]:
    """Ways to rise on the way to a last delay [s], the most promising first; the first of all steps is at the start.

    Parameters
    ----------
    stretch : the way [m] in which the robot stops and sets off again.
    """
    allowed = max(min(delay, float(bounds.most.min(initial=np.inf)) - _APART), 0.0)
    found: set[tuple[Step, ...]] = set()
    for room in _ROOMS:
        for first in dict.fromkeys((allowed, 0.0)):
            steps = _stairs(bounds, first, delay, room * stretch, length)
            if steps is not None and len(steps) > 1 and steps not in found:
                found.add(steps)
                yield steps


def _stairs(bounds: Corridor, first: float, last: float, room: float, length: float) -> tuple[Step, ...] | None:
    """Steps that rise as far as is allowed wherever more is needed; None where that is not enough."""
    steps = [Step(first, 0.0, 0.0)]
    while steps[-1].delay < last - _STEP:
        before = steps[-1].delay
        needed = float(bounds.least_at[bounds.least > before].min(initial=length))
        most = float(bounds.most[bounds.most_at > needed - room].min(initial=np.inf))
        delay = min(last, most - _APART)
        if delay < before + _STEP or len(steps) > _MOST_STEPS:
            return None
        allowed = float(bounds.most_at[bounds.most < delay].max(initial=0.0))
        steps.append(Step(delay, allowed, max(needed, 0.0)))
    return tuple(steps)


def _delays(profile: VelocityProfile, windows: Sequence[Window], lines: Sequence[Array]) -> tuple[Array, Array]:
    """Places and delays (n,), (n,) on the lines (K, 2) of windows, those at the end of time left out."""
    share = np.linspace(0.0, 1.0, _PLACES)
    times, places = [np.empty(0)], [np.empty(0)]
    for window, line in zip(windows, lines, strict=True):
        ends = np.stack([window.times[:-1], window.times[1:]], axis=1)
        lasts = np.isfinite(ends[:, 1])
        for points, of in ((times, ends[lasts]), (places, line[lasts])):
            points.append((of[:, :1] + (of[:, 1:] - of[:, :1]) * share).ravel())
        if window.lasts:  # for ever, and so from its beginning on
            times.append(ends[-1:, 0])
            places.append(line[-1:, 0])
    at = np.concatenate(places)
    return at, np.concatenate(times) - time_at(profile, at)
