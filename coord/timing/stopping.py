"""Stop and go: by priority, whoever has to give way comes to rest before the conflict and waits there.

This is the plainest way to settle a collision, kept for comparison with changing the velocity: a robot drives as
if alone until the first conflict with somebody planned before it that it would not get past ahead of; it stops at
the latest place before that region where it stands in nobody's way, waits until the other has left the region, and
goes on from rest, as quickly as it can, to the next conflict.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coord.conflicts.window import Window
from coord.model.profile import VelocityProfile
from coord.timing.bounds import inner_claims, least_arrival
from coord.timing.clear import excess
from coord.timing.ego import Ego
from coord.timing.legs import braked, followed, last_moment, onward
from coord.timing.meeting import Meeting, first_violated
from coord.timing.passing import Timing

#: [m] For less than this a robot does not start to move, only to stop again.
LEAST_MOVE = 0.05


@dataclass(frozen=True, slots=True, eq=False)
class _Halt:
    """A rest: the way there (None for the start), and the leg that leaves from there for the goal."""

    way: VelocityProfile | None
    leg: VelocityProfile

    @property
    def whole(self) -> VelocityProfile:
        return followed(self.way, self.leg)

    @property
    def place(self) -> float:
        return float(self.leg.states[0, 0])

    def longer(self, until: float) -> _Halt:
        return _Halt(self.way, self.leg.shifted(until - self.leg.departure))


def stop_robot(ego: Ego, meetings: list[Meeting]) -> Timing | None:
    """The stop-and-go profile of ego that is clear of all meetings.

    Where no stop on the way stands in nobody's way for as long as it lasts, the robot waits longer where it stood
    before, at its start in the end. Each wait ends when a robot has left a conflict, always later than the wait
    before, so this ends. None where another robot never leaves ego's way; with an order that respects the blocking
    arcs this does not happen.

    Returns
    -------
    Timing
        ``how`` is "alone"; "start delay" where it waits at its start only; "stop" where it stops on its way.
    """
    halts, held = [_Halt(None, ego.alone)], set()
    while True:
        profile = halts[-1].whole
        violated = first_violated(meetings, profile)
        if violated is None:
            break
        meeting = meetings[violated[0]]
        until = float(meeting.window.times[-1])
        if not halts[-1].leg.departure < until < np.inf:
            return None
        halts = _held(ego, meetings, halts, meeting, until)
        held.add(violated[0])
    how = "stop" if len(halts) > 1 else "start delay" if held else "alone"
    claims = [claim for index in sorted(held) for claim in inner_claims(ego, meetings[index])]
    bound = min(max(ego.solo_bound, least_arrival(ego, claims, profile.arrival)), profile.arrival)
    after = {meeting.other for meeting in meetings if meeting.passes_after(profile)}
    before = {meeting.other for meeting in meetings} - after
    return Timing(profile, tuple(sorted(after)), tuple(sorted(before)), how, bound)


def _held(ego: Ego, meetings: list[Meeting], halts: list[_Halt], conflict: Meeting, until: float) -> list[_Halt]:
    """The rests of a robot that lets another leave a conflict: a stop before it, or a longer wait at one it had."""
    for k in range(len(halts) - 1, 0, -1):
        stop = _stop(ego, meetings, halts[k], conflict, until)
        if stop is not None:
            return [*halts[: k + 1], stop]
        way = halts[k].way
        if way is not None and not _hindered(meetings, way, until):
            return [*halts[:k], halts[k].longer(until)]
    stop = _stop(ego, meetings, halts[0], conflict, until)
    # at its start nobody planned before it ever comes by, or it would have been planned before them
    return [halts[0].longer(until)] if stop is None else [halts[0], stop]


def _stop(ego: Ego, meetings: list[Meeting], halt: _Halt, conflict: Meeting, until: float) -> _Halt | None:
    """A stop on the leg from a rest, as late as possible before a conflict; None where it would be in the way."""
    place, limits = _begins(conflict), ego.robot.limits
    while place >= halt.place + LEAST_MOVE:
        way = followed(halt.way, braked(halt.leg, last_moment(halt.leg, place, limits), limits))
        leaves = max(until, way.arrival)
        hindered = _hindered(meetings, way, leaves)
        if not hindered:
            return _Halt(way, onward(ego, way.length, leaves))
        place = max(_begins(meeting) for meeting in hindered)
    return None


def _begins(meeting: Meeting) -> float:
    """Where ego is never too near to the other [m], whenever it is there; a window lies a hair below its region."""
    return float(meeting.window.low.min())


def _hindered(meetings: list[Meeting], way: VelocityProfile, until: float) -> list[Meeting]:
    """Whom a robot meets that drives a way and rests at its end until a time [s]."""
    found = []
    for meeting in meetings:
        if meeting.box[0] >= until or meeting.is_avoided(way) or meeting.window.times[0] >= until:
            continue
        if not excess(way, _up_to(meeting.window, until)).is_clear:
            found.append(meeting)
    return found


def _up_to(window: Window, until: float) -> Window:
    """The part of a window before a time [s] that is later than its beginning."""
    if window.times[-1] <= until:
        return window
    count = int(np.searchsorted(window.times[:-1], until, side="left"))
    times, low, high = window.times[: count + 1].copy(), window.low[:count].copy(), window.high[:count].copy()
    if np.isfinite(times[-1]):
        share = (until - times[-2]) / (times[-1] - times[-2])
        low[-1, 1] = low[-1, 0] + share * (low[-1, 1] - low[-1, 0])
        high[-1, 1] = high[-1, 0] + share * (high[-1, 1] - high[-1, 0])
    times[-1] = until
    return Window(window.other, times, low, high)
