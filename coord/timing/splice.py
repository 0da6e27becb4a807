"""Giving way on the move: the quickest profile, delayed in steps.

Up to some place the robot follows its quickest profile with one delay, so that it passes before some robots;
then it slows down, lets others pass and speeds up again, and from then on follows the same profile with a
larger delay. Each step is one arc of ruckig with exactly the duration in between.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from coord.alone.inverse import time_at
from coord.model.arrays import frozen
from coord.model.profile import VelocityProfile
from coord.solvers.jerk import SHORTEST_PHASE, motion
from coord.timing.delay import Contact
from coord.timing.ego import Ego

#: Shares of the time between two contacts at which an arc may begin, counted back from its end.
_BEGINNINGS = (1.0, 0.6, 0.35)

#: [s] How long after the contact the arc may end: the profile must be joined with its speed and acceleration.
_ENDINGS = (0.0, 0.25, 0.6, 1.2, 2.5)


@dataclass(frozen=True, slots=True)
class _Step:
    """At the contact's place the delay must be at least (after) or at most (before) the contact's."""

    contact: Contact
    is_after: bool


def spliced(ego: Ego, afters: list[Contact], befores: list[Contact]) -> Iterator[VelocityProfile]:
    """Profiles with stepwise delays for these contacts, the most promising first; the caller checks them.

    Parameters
    ----------
    afters, befores : for each window passed after (before), the least (largest) delay and where it binds.
    """
    levels = _levels(afters, befores)
    if levels is None:
        return
    passed = time_at(ego.alone, [s for _, s, _ in levels]).tolist()
    for ending, share in product(_ENDINGS, _BEGINNINGS):
        profile = _chain(ego, levels, passed, ending, share)
        if profile is not None:
            yield profile


def _levels(afters: list[Contact], befores: list[Contact]) -> list[tuple[float, float, float]] | None:
    """Rising delays as (delay, arc length from which it must hold, arc length up to which the previous one must).

    Contacts are taken in the order of their places; None where a place must be passed before somebody with
    less delay than a place behind it already needs.
    """
    steps = sorted(
        [_Step(contact, True) for contact in afters] + [_Step(contact, False) for contact in befores],
        key=lambda step: (step.contact.s, step.is_after),
    )
    levels = [(0.0, 0.0, 0.0)]
    bound_at = 0.0
    for step in steps:
        delay, s = step.contact.delay, step.contact.s
        if step.is_after and delay > levels[-1][0]:
            levels.append((delay, s, bound_at))
        elif not step.is_after:
            if delay < levels[-1][0]:
                return None
            bound_at = s
    return levels


def _chain(
    ego: Ego, levels: list[tuple[float, float, float]], passed: list[float], ending: float, share: float
) -> VelocityProfile | None:
    """The alone profile through all levels, each joined by one arc; None where an arc does not exist.

    ``passed`` : when the alone profile is at the place of each level [s].
    """
    current = ego.alone
    earliest = current.departure
    for (delay, _, kept_to), at in zip(levels[1:], passed[1:], strict=True):
        target = ego.alone.shifted(delay)
        end = at + delay + ending
        if kept_to > 0:
            earliest = max(float(time_at(current, kept_to)[0]), earliest)
        begin = end - (end - earliest) * share
        joined = _arc(ego, current, target, begin, min(end, target.arrival))
        if joined is None:
            return None
        current, earliest = joined, end
    return current


def _arc(
    ego: Ego, current: VelocityProfile, target: VelocityProfile, begin: float, end: float
) -> VelocityProfile | None:
    """Follow one profile up to ``begin`` and the other from ``end`` on, with a ruckig arc in between."""
    if end <= begin or begin >= current.arrival:
        return None
    start, goal = current.state(begin)[0], target.state(end)[0]
    if goal[0] < start[0]:
        return None
    limits = ego.robot.limits
    cap = float(ego.caps.lowest(start[:1], goal[:1])[0])
    arc = motion(
        (float(start[0]), float(start[1]), float(start[2])),
        (float(goal[0]), float(goal[1]), float(goal[2])),
        dataclasses.replace(limits, speed=cap),
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
