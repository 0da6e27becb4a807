"""Giving way on the move: the quickest profile, delayed in steps.

From its start on, or up to some place, the robot follows its quickest profile with one delay, so that it passes before
some robots; then it slows down, lets others pass and speeds up again, and from then on follows the same profile with a
larger delay. Each step is one arc of ruckig with exactly the duration in between.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from coord.alone.check import keeps_limits
from coord.alone.inverse import time_at
from coord.model.arrays import frozen
from coord.model.profile import VelocityProfile
from coord.solvers.jerk import SHORTEST_PHASE, motion
from coord.timing.corridor import Corridor, Step, stairs
from coord.timing.ego import Ego

#: [s] An arc begins so long before more delay is allowed and ends so long after it is needed, if need be: how much of
#: either the windows bear only the check of the whole tells.
_BEYOND = (
    (0.0, 0.0), (0.0, 0.25), (0.25, 0.0), (0.3, 0.3), (0.0, 0.6), (0.6, 0.0), (0.6, 0.6), (0.0, 1.2), (1.2, 0.0),
    (1.2, 1.2),
)  # fmt: skip

#: [m] Nor does it begin or end at the border of a bend that is nearer than this to where it would anyway.
_NEAR = 0.05

#: An arc may begin after these shares of the time for it.
_BEGINNINGS = (0.0, 0.4, 0.65)

#: So many arcs are tried for a step, so many of those that exist are kept, and so many profiles up to there.
_TRIED, _KEPT, _MOST = 8, 3, 3


def spliced(ego: Ego, bounds: Corridor, delay: float) -> Iterator[VelocityProfile]:
    """Profiles within the limits whose delay rises to the last one [s], the most promising first.

    Whether they are clear of the windows the caller checks: the corridor holds where the delay is constant.
    """
    for steps in stairs(bounds, delay, _stretch(ego), ego.length):
        for sooner, later in _BEYOND:
            yield from _joined(ego, steps, sooner, later)


def _stretch(ego: Ego) -> float:
    """About the way [m] in which the robot stops from its largest speed and is as fast again."""
    limits, speed = ego.robot.limits, float(ego.alone.states[:, 1].max())
    largest = max(limits.acceleration, limits.deceleration)
    return speed * (speed / 2 / limits.acceleration + speed / 2 / limits.deceleration + largest / limits.jerk)


def _joined(ego: Ego, steps: Sequence[Step], sooner: float, later: float) -> list[VelocityProfile]:
    """The alone profile through all steps, each joined by one arc."""
    first = ego.alone.shifted(steps[0].delay)
    found = [(first, first.departure)]
    for before, step in itertools.pairwise(steps):
        target = ego.alone.shifted(step.delay)
        following = []
        for profile, since in found:
            arcs = _arcs(ego, profile, target, since, before.delay, step, sooner, later)
            following += [arc for arc, _ in zip(arcs, range(_KEPT), strict=False)]
        found = following[:_MOST]
    return [profile for profile, _ in found]


def _arcs(
    ego: Ego, profile: VelocityProfile, target: VelocityProfile, since: float, delay: float, step: Step,
    sooner: float, later: float,
) -> Iterator[tuple[VelocityProfile, float]]:  # fmt: skip
    """A profile joined with a target behind it, and when it is, longer arcs first.

    Beside the longest arc there are those between the borders of bends: one may have to be crossed at its own speed.
    """
    borders = ego.caps.ends[:-1]
    borders = borders[(borders > step.allowed + _NEAR) & (borders < step.needed - _NEAR)]
    places = np.concatenate([[step.allowed, step.needed], borders])
    alone = time_at(ego.alone, places)
    begin = max((float(alone[0]) + delay if step.allowed > 0 else profile.departure) - sooner, since)
    end = min(float(alone[1]) + step.delay + later, target.arrival)
    begins = [*(begin + (end - begin) * share for share in _BEGINNINGS), *(alone[2:] + delay).tolist()]
    ends = [end, *(alone[:1:-1] + step.delay).tolist()]
    spans = sorted(((a - b, b, a) for b in begins for a in ends if begin <= b < a <= end), reverse=True)
    for _, b, a in spans[:_TRIED]:
        arc = _arc(ego, profile, target, b, a)
        if arc is not None and keeps_limits(arc, ego.robot.limits, ego.caps):
            yield arc, a


def _arc(
    ego: Ego, current: VelocityProfile, target: VelocityProfile, begin: float, end: float
) -> VelocityProfile | None:
    """Follow one profile up to ``begin`` and the other from ``end`` on, with a ruckig arc in between."""
    if end <= begin or begin >= current.arrival:
        return None
    start, goal = current.state(begin)[0], target.state(end)[0]
    if goal[0] < start[0]:
        return None
    # it slows down at once, and may go into a bend faster than through it
    cap = max(float(ego.caps.lowest(start[:1], goal[:1])[0]), float(start[1]), float(goal[1]))
    arc = motion(
        (float(start[0]), float(start[1]), float(start[2])),
        (float(goal[0]), float(goal[1]), float(goal[2])),
        dataclasses.replace(ego.robot.limits, speed=cap),
        end - begin,
    )
    return None if arc is None else _join(current, arc.shifted(begin), target)


def _join(head: VelocityProfile, arc: VelocityProfile, tail: VelocityProfile) -> VelocityProfile:
    """The head up to the arc's beginning, the arc, then the tail from the arc's end on."""
    before = _between(head, head.departure, arc.departure)
    behind = _between(tail, arc.arrival, tail.arrival)
    return VelocityProfile(
        np.concatenate([before.times[:-1], arc.times, behind.times[1:]]),
        np.concatenate([before.states[:-1], arc.states, behind.states[1:]]),
        np.concatenate([before.jerks, arc.jerks, behind.jerks]),
    )


def _between(profile: VelocityProfile, start: float, end: float) -> VelocityProfile:
    """The part of a profile between two times, which become knots; a single knot where nothing lies between."""
    if end - start <= SHORTEST_PHASE:
        return VelocityProfile(frozen([start]), profile.state([start]), frozen([]))
    inside = (profile.times > start + SHORTEST_PHASE) & (profile.times < end - SHORTEST_PHASE)
    ends = profile.state([start, end])
    times = np.concatenate([[start], profile.times[inside], [end]])
    phase = np.searchsorted(profile.times, (times[:-1] + times[1:]) / 2, side="right") - 1
    return VelocityProfile(times, np.concatenate([ends[:1], profile.states[inside], ends[1:]]), profile.jerks[phase])
