"""Equally early: other profiles with which a robot arrives no later, but slows down elsewhere, or elsewhen.

For the robot itself it is the same whether it waits at its start or rolls and slows down on the way. For others it
is not: where it waits it stands in nobody's way for long, and where it rolls it may have passed before they come.
"""

from __future__ import annotations

import dataclasses

from coord.errors import SolverError
from coord.model.profile import VelocityProfile
from coord.timing.corridor import Corridor, corridor
from coord.timing.ego import Ego
from coord.timing.meeting import Meeting, all_violated, first_violated
from coord.timing.passing import Timing, passed
from coord.timing.splice import spliced
from coord.tolerances import OPTIMAL

#: [s] With so much less delay, the window that a delay is for is violated.
_A_LITTLE = 1e-3


def equally_early(ego: Ego, meetings: list[Meeting], timing: Timing) -> list[Timing]:
    """Other profiles that are clear of all meetings and arrive as early, give or take the share OPTIMAL.

    Each slows down once, at another time; empty where the robot neither waits at its start nor slows down like that,
    or a library fails.
    """
    if timing.how not in ("start delay", "splice"):
        return []
    delay = timing.profile.arrival - ego.alone.arrival
    in_the_way = all_violated(meetings, ego.alone.shifted(delay))
    sooner = all_violated(meetings, ego.alone.shifted(delay - _A_LITTLE))
    reasons = [index for index in sooner if index not in in_the_way]
    bounds = corridor(ego.alone, *([meetings[index].window for index in some] for some in (reasons, in_the_way)))
    latest = timing.profile.arrival * (1 + OPTIMAL)
    found = []
    for profile in _motions(ego, bounds, delay):
        if profile.arrival <= latest and first_violated(meetings, profile) is None:
            after, before = passed(meetings, profile)  # it may precede somebody whom the other one lets pass
            found.append(dataclasses.replace(timing, profile=profile, after=after, before=before, how="splice"))
    return found


def _motions(ego: Ego, bounds: Corridor, delay: float) -> list[VelocityProfile]:
    try:
        return list(spliced(ego, bounds, delay))
    except SolverError:  # the robot has a profile already
        return []
