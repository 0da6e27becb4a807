"""Waiting at the start: the simplest way to give way, and often the quickest.

Delayed by d, a profile is at s at time tau(s) + d. So a window forbids exactly the delays t - tau(s) of its
points (t, s), one open interval: below it ego passes before the other, above it after.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coord.alone.inverse import time_at
from coord.conflicts.window import Window
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.timing.clear import SLACK, excess
from coord.timing.meeting import Meeting, first_violated

#: Points within the two strips next to the best strip border at which a contact is sought.
_REFINE = 17

#: [s] Delays are never raised by less than this, so that rounding cannot hold up the search.
_LEAST_STEP = 1e-7


@dataclass(frozen=True, slots=True)
class Contact:
    """The delay [s] at which a profile touches a bound of a window, and the point (t [s], s [m]) of contact.

    Infinite where resting at the start (or goal) itself is forbidden: no delay helps.
    """

    delay: float
    time: float
    s: float


def after_contact(profile: VelocityProfile, window: Window) -> Contact:
    """The least delay with which a profile passes after the robot of a window."""
    if window.lasts or float(window.low.min()) < 0:
        return Contact(np.inf, float(window.times[-1]), 0.0)
    contact = _extreme(profile, window.times, window.low, 1.0)
    # sampling the boundary leaves a hair: close it by the exact check
    delay, step = contact.delay, _LEAST_STEP
    while excess(profile.shifted(delay), window).over_low > SLACK:
        delay += step
        step *= 2
    return Contact(delay, contact.time, contact.s)


def before_contact(profile: VelocityProfile, window: Window) -> Contact:
    """The largest delay with which a profile passes before the robot of a window; may be below 0."""
    if float(window.high.max()) > profile.length:
        return Contact(-np.inf, float(window.times[0]), profile.length)
    times = window.times
    if window.lasts:
        times = np.concatenate([times[:-1], [times[-2] + 1.0]])
    contact = _extreme(profile, times, window.high, -1.0)
    delay, step = contact.delay, _LEAST_STEP
    while excess(profile.shifted(delay), window).under_high > SLACK:
        delay -= step
        step *= 2
    return Contact(delay, contact.time, contact.s)


def start_delay(
    profile: VelocityProfile, meetings: list[Meeting], contacts: dict[int, Contact] | None = None
) -> VelocityProfile | None:
    """The profile with the least delay at which it is clear of all; None where another never makes way.

    ``contacts`` : gets what ``after_contact`` says of the meetings that were looked at, by index.
    """
    contacts = {} if contacts is None else contacts
    delay = 0.0
    while True:
        delayed = profile.shifted(delay)
        violated = first_violated(meetings, delayed)
        if violated is None:
            return delayed
        contact = contacts[violated[0]] = after_contact(profile, meetings[violated[0]].window)
        if np.isinf(contact.delay):
            return None
        delay = max(contact.delay, delay + _LEAST_STEP)


def _extreme(profile: VelocityProfile, times: Array, bound: Array, sign: float) -> Contact:
    """The largest (sign > 0) or least t - tau(s) over the points of a boundary."""
    t = np.stack([times[:-1], times[1:]], axis=1)
    delays = sign * (t - time_at(profile, bound.ravel()).reshape(-1, 2))
    strip = int(np.argmax(delays.max(axis=1)))
    near = [k for k in (strip - 1, strip, strip + 1) if 0 <= k < len(bound)]
    share = np.linspace(0.0, 1.0, _REFINE)
    t = np.concatenate([times[k] + (times[k + 1] - times[k]) * share for k in near])
    s = np.concatenate([bound[k, 0] + (bound[k, 1] - bound[k, 0]) * share for k in near])
    delays = sign * (t - time_at(profile, s))
    best = int(np.argmax(delays))
    return Contact(sign * float(delays[best]), float(t[best]), float(s[best]))
