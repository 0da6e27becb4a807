"""The quickest motion through sections with a speed cap each: a chain of ruckig motions with good borders.

Between two section borders the time-optimal motion under one cap is known in closed form (ruckig). What is
left to find are speed and acceleration at the borders. They are sought border by border, and for both ends of
a section together, by a pattern search whose steps shrink where nothing helps; it needs no derivatives, ends
by itself, and every state it visits is a valid motion.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np

from coord.alone.speed_limit import SpeedLimit
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.jerk import LinkTimes, motion

#: A border speed that cannot be reached (or left) is lowered by this factor.
_BACK_OFF = 0.95

#: First steps of the search, as shares of the limits of speed and acceleration; and how they change.
_FIRST_STEPS = (0.1, 0.3)
_SHRINK, _GROW = 0.5, 1.3

#: Probes of one border in one sweep, sweeps at most, and the relative gain of a sweep below which it ends.
_PROBES, _SWEEPS, _LEAST_GAIN = 4, 40, 1e-6

#: [s] A move must gain this much, so that rounding is not mistaken for progress.
_PROGRESS = 1e-9

#: A border whose steps have shrunk to this share of the first ones is left as it is: no move gains that much any more.
_SETTLED = 1e-9

#: Directions of the pattern, in (speed, acceleration).
_PATTERN = ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, -1), (1, -1), (-1, 1))

#: Directions for both ends of a section at once: shared change of speed, changes of the two accelerations.
_PAIR_PATTERN = tuple((v, a, sign * a) for a in (1, -1) for sign in (1, -1) for v in (0, 1, -1))


def chained(caps: SpeedLimit, limits: Limits) -> VelocityProfile | None:
    """A quick motion from rest to rest under the caps; None where ruckig finds no chain at all."""
    borders = _Borders(caps, limits)
    if not borders.lower_until_possible():
        return None
    borders.improve()
    return borders.profile()


def quick_estimate(caps: SpeedLimit, limits: Limits, time_of: LinkTimes | None = None) -> float:
    """The time [s] of the chain before its borders are improved: a few per cent too long, and quick to have.

    ``time_of`` : of the same limits, when many similar paths are compared.
    """
    borders = _Borders(caps, limits, time_of)
    return math.fsum(borders.times) if borders.lower_until_possible() else math.inf


class _Borders:
    """Speed and acceleration at the borders of sections, and the times of the links between them."""

    def __init__(self, caps: SpeedLimit, limits: Limits, time_of: LinkTimes | None = None) -> None:
        self.limits = limits
        self.caps = caps.caps.tolist()
        self.lengths = np.diff(caps.ends, prepend=0.0).tolist()
        self.top = [0.0, *np.minimum(caps.caps[:-1], caps.caps[1:]).tolist(), 0.0]
        self.states = [(speed, 0.0) for speed in self.top]
        self.time_of = time_of or LinkTimes(limits)
        self.times = [0.0] * len(self.caps)

    def link(self, m: int, start: tuple[float, float], goal: tuple[float, float]) -> float:
        return self.time_of(start, goal, self.lengths[m], self.caps[m])

    def lower_until_possible(self) -> bool:
        """Lower borders that cannot be reached, from the front, then those that cannot be left, from the back."""
        self._lower_as_without_jerk()
        count = len(self.caps)
        for reached in (True, False):
            for m in range(count) if reached else reversed(range(count)):
                border, other = (m + 1, m) if reached else (m, m + 1)
                while math.isinf(self.link(m, self.states[m], self.states[m + 1])):
                    speed, least = self.states[border][0], self.states[other][0]
                    if speed <= least:
                        break
                    self.states[border] = (max(_BACK_OFF * speed, least), 0.0)
        self.times = [self.link(m, self.states[m], self.states[m + 1]) for m in range(count)]
        return not any(math.isinf(time) for time in self.times)

    def _lower_as_without_jerk(self) -> None:
        """Lower borders that are out of reach even without a jerk limit, which is known in closed form."""
        speeds = [speed for speed, _ in self.states]
        for m, length in enumerate(self.lengths):
            speeds[m + 1] = min(speeds[m + 1], math.sqrt(speeds[m] ** 2 + 2 * self.limits.acceleration * length))
        for m, length in reversed(list(enumerate(self.lengths))):
            speeds[m] = min(speeds[m], math.sqrt(speeds[m + 1] ** 2 + 2 * self.limits.deceleration * length))
        self.states = [(speed, 0.0) for speed in speeds]

    def improve(self) -> None:
        """Sweep over the borders until a sweep gains next to nothing."""
        limits, (of_speed, of_acceleration) = self.limits, _FIRST_STEPS
        first = (of_speed * limits.speed, of_acceleration * min(limits.acceleration, limits.deceleration))
        steps = [first] * len(self.states)
        for _ in range(_SWEEPS):
            before = math.fsum(self.times)
            loose = [m for m in range(1, len(self.caps)) if steps[m][0] > _SETTLED * first[0]]
            for m in loose:
                steps[m] = self._search(m, steps[m])
            for m in (m for m in loose if m < len(self.caps) - 1):
                self._search_pair(m, steps[m])
            if before - math.fsum(self.times) < _LEAST_GAIN * before:
                return

    def _search(self, m: int, step: tuple[float, float]) -> tuple[float, float]:
        """A few probes of the pattern about one border; the steps to go on with."""
        for _ in range(_PROBES):
            v, a = self.states[m]
            moved = [self._moved(m, v + dv * step[0], a + da * step[1]) for dv, da in _PATTERN]
            step = _scaled(step, _GROW if self._take_best(m, [(state,) for state in moved]) else _SHRINK)
        return step

    def _search_pair(self, m: int, step: tuple[float, float]) -> None:
        """One probe of both ends of section m: where it is short they can only move together."""
        (v0, a0), (v1, a1) = self.states[m], self.states[m + 1]
        moved = [
            (
                self._moved(m, v0 + dv * step[0], a0 + da0 * step[1]),
                self._moved(m + 1, v1 + dv * step[0], a1 + da1 * step[1]),
            )
            for dv, da0, da1 in _PAIR_PATTERN
        ]
        self._take_best(m, moved)

    def _moved(self, m: int, speed: float, acceleration: float) -> tuple[float, float]:
        return (min(max(speed, 0.0), self.top[m]), acceleration)

    def _take_best(self, m: int, candidates: Sequence[tuple[tuple[float, float], ...]]) -> bool:
        """Take the candidate for the states from border m on that saves most time, if any does."""
        count = len(candidates[0])
        best, taken = math.fsum(self.times[m - 1 : m + count]) - _PROGRESS, None
        for states in candidates:
            times: list[float] = []
            for k, (start, goal) in enumerate(self._links(m, states)):
                times.append(self.link(m - 1 + k, start, goal))
                if sum(times) >= best:
                    break
            else:
                best, taken = sum(times), (states, times)
        if taken is None:
            return False
        self.states[m : m + count], self.times[m - 1 : m + count] = list(taken[0]), taken[1]
        return True

    def _links(
        self, m: int, states: tuple[tuple[float, float], ...]
    ) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
        chain = [self.states[m - 1], *states, self.states[m + len(states)]]
        return itertools.pairwise(chain)

    def profile(self) -> VelocityProfile | None:
        """The motions of all links, one after the other."""
        times, states, jerks = [0.0], [(0.0, 0.0, 0.0)], []
        at = 0.0
        for m, length in enumerate(self.lengths):
            capped = dataclasses.replace(self.limits, speed=self.caps[m])
            part = motion((0.0, *self.states[m]), (length, *self.states[m + 1]), capped)
            if part is None:
                return None
            times += (times[-1] + part.times[1:]).tolist()
            states += [(at + s, v, a) for s, v, a in part.states[1:].tolist()]
            jerks += part.jerks.tolist()
            at += length
        return VelocityProfile(times, states, jerks)  # type: ignore[arg-type]


def _scaled(step: tuple[float, float], factor: float) -> tuple[float, float]:
    return (step[0] * factor, step[1] * factor)
