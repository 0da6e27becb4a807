"""Driving gently: the same choice of whom to let pass, a little later, with the least squared jerk and acceleration.

A robot that arrives as early as it can mostly waits at its start and then hurries. With a few tenths of a second
more it can roll, slow down in time instead of standing, and brake softly.
"""

from __future__ import annotations

from collections.abc import Iterator

from coord.model.profile import VelocityProfile
from coord.timing.ego import Ego
from coord.timing.grid import Course
from coord.timing.haste import hasty_course
from coord.timing.meeting import Meeting, all_violated
from coord.timing.program import course_of, smooth_through
from coord.timing.tube import Tube, after_bound, before_bound

#: A gentle robot may arrive later by this share of the time that it needs to stop from its top speed: by the same
#: share all of its ramps get longer. Where many cross one hub the delays add up: with 0.1 the arrivals of 112 robots
#: that merge came 1 % later.
_SHARE = 0.07

#: [s] On paths with bends it may arrive later by so much more, because the cells lose something at every bend; by
#: the second where the first is too little.
_FOR_BENDS = (0.03, 0.15)

#: Scales of the cells, of the program's: the coarser one is for tubes for which the finer one would be too large.
_MESHES = (0.25, 0.8)

#: [1/s2] Weight of the squared acceleration beside the squared jerk.
_EASE = 0.1

#: How often windows that turn out to be in the way are added to the tube.
_ROUNDS = 8


def gentle(ego: Ego, meetings: list[Meeting], quickest: VelocityProfile, known: list[int]) -> VelocityProfile | None:
    """The gentle profile on the same side of every meeting as ``quickest``; None where none is found.

    ``known`` : meetings, by index, that are likely to matter. The profile is exactly clear and keeps the limits.
    """
    arrival = quickest.arrival + _SHARE * ego.landing.profile.arrival
    later = (0.0,) if ego.caps.is_constant else _FOR_BENDS
    found = (_arriving(ego, meetings, quickest, known, arrival + more) for more in later)
    return next((one for one in found if one is not None), None)


def _arriving(
    ego: Ego, meetings: list[Meeting], quickest: VelocityProfile, known: list[int], arrival: float
) -> VelocityProfile | None:
    """The same with a given arrival [s]."""
    sides = {index: meetings[index].passes_after(quickest) for index in known}
    course = None if ego.caps.is_constant else course_of(quickest, ego.alone.departure)
    for _ in range(_ROUNDS):
        tube = Tube(
            [after_bound(meetings[index].window) for index, after in sides.items() if after],
            [before_bound(meetings[index].window) for index, after in sides.items() if not after],
        )
        courses = _courses(ego, tube, course)
        found = (smooth_through(ego, tube, arrival, mesh, _EASE, one) for one in courses for mesh in _MESHES)
        profile = next((one for one in found if one is not None), None)
        if profile is None:
            return None
        violated = all_violated(meetings, profile)
        if not violated:
            return profile
        if not sides.keys().isdisjoint(violated):  # a bound of the tube was missed by rounding
            return None
        sides |= {index: meetings[index].passes_after(quickest) for index in violated}
    return None


def _courses(ego: Ego, tube: Tube, quickest: Course | None) -> Iterator[Course | None]:
    """What tells which cells are in which bend: where the quickest is when, or one in haste, who stands less."""
    yield quickest
    if quickest is not None:
        yield hasty_course(ego, tube)
