"""Of profiles that arrive equally early, the one that holds up those who come later the least.

Each later robot is looked at by itself: by how much it would have to wait at its start, had it to let this robot
pass and nobody else. So the look ahead costs a delayed robot's meetings once more, however large the fleet is.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence

from coord.coordination.scene import Scene
from coord.model.profile import VelocityProfile
from coord.timing.delay import start_delay
from coord.timing.ego import Ego
from coord.timing.meeting import Meeting
from coord.timing.passing import Timing
from coord.timing.ties import equally_early

#: [s] Sums of delays that differ by less are equal, and the robot waits at its start if it does so now.
_EQUAL = 1e-6


def courteous(scene: Scene, i: int, timing: Timing, meetings: list[Meeting], timings: Mapping[int, Timing]) -> Timing:
    """The profile of robot i, or another one that arrives as early and holds up those who come later less.

    With nobody coming later, it rolls and slows down rather than waiting at its start.

    Parameters
    ----------
    meetings : of robot i with those before it.
    timings : of the robots planned before.
    """
    if timing.how not in ("start delay", "splice"):
        return timing
    after = [k for k in scene.neighbours[i] if k not in timings]
    later = [(scene.egos[k], scene.meetings(k, [i], {i: timing}, remember=True)) for k in after]
    best, least = timing, _held_up(later, timing.profile)
    if later and least == (0, 0.0):
        return timing
    others = equally_early(scene.egos[i], meetings, timing)
    if not later:
        return others[0] if others and timing.how == "start delay" else timing
    for one in others:
        cost = _held_up(later, one.profile)
        if cost[0] < least[0] or (cost[0] == least[0] and cost[1] < least[1] - _EQUAL):
            best, least = one, cost
    return best


def _held_up(later: Sequence[tuple[Ego, list[Meeting]]], profile: VelocityProfile) -> tuple[int, float]:
    """How many robots cannot let a profile pass by waiting, and how long the others wait altogether [s]."""
    stuck, waits = 0, []
    for ego, meetings in later:
        delayed = start_delay(ego.alone, [dataclasses.replace(meeting, profile=profile) for meeting in meetings])
        if delayed is None:
            stuck += 1
        else:
            waits.append(delayed.departure - ego.alone.departure)
    return stuck, math.fsum(waits)
