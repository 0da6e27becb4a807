"""Before or after: which robots to let pass and whom to precede, by branch and bound.

The search starts from the profile alone. Where it first runs into another robot there are two choices, to
pass after it or before it; each is a subproblem with one more bound on s(t). Subproblems are taken in the
order of their lower bounds, until none is left below the best profile found.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from coord.alone.check import keeps_limits
from coord.conflicts.window import Window
from coord.model.profile import VelocityProfile
from coord.timing.bounds import (
    Claim,
    Fits,
    Forbidden,
    are_compatible,
    claims_of,
    could_hold_up,
    forbidden,
    least_arrival,
    window_claim,
)
from coord.timing.closing import CLOSED, close_gap
from coord.timing.delay import Contact, after_contact, before_contact, start_delay
from coord.timing.ego import Ego
from coord.timing.gentle import gentle
from coord.timing.grid import Course
from coord.timing.haste import hasty_course
from coord.timing.meeting import Meeting, first_violated
from coord.timing.program import course_of, through_tube
from coord.timing.splice import spliced
from coord.timing.tube import Tube, after_bound, before_bound
from coord.tolerances import OPTIMAL

#: To close the gap to a robot's bound: so many relaxations are solved at most, and a gap below such a share of the
#: arrival is left as it is. The second effort is made where proof is asked for.
_EFFORTS = ((60, 5e-3), (600, CLOSED))

#: How a robot drives for which nothing has been found yet.
_NONE = "none"

#: What a subproblem yields when it is still to be branched: no motion but a course that forgets the jerk.
_COURSE = "course"

#: Subproblems looked at for one robot before the best profile found is taken as it is.
MOST_NODES = 60


@dataclass(frozen=True, slots=True, eq=False)
class Timing:
    """One robot's profile against those before it.

    Parameters
    ----------
    after, before : indices of the other robots that it lets pass, and that it precedes, where they meet.
    how : "alone", "start delay", "splice", "program", "gentle", "stop" or "waited".
    lower_bound : arrival [s] that no motion can beat, given the motions of those before it.
    nodes : subproblems looked at.
    open : whether some choice of before or after was left undecided that might save a thousandth of the arrival.
    """

    profile: VelocityProfile
    after: tuple[int, ...]
    before: tuple[int, ...]
    how: str
    lower_bound: float = 0.0
    nodes: int = 0
    open: bool = False


@dataclass(slots=True, eq=False)
class _Search:
    """What the subproblems of one robot share: contacts are worked out once a window."""

    ego: Ego
    meetings: list[Meeting]
    best: VelocityProfile
    how: str
    contacts: dict[int, Contact]
    afters: dict[int, Contact] = field(default_factory=dict)
    befores: dict[int, Contact] = field(default_factory=dict)
    claims: dict[int, Claim] = field(default_factory=dict)
    truly: dict[int, list[Forbidden]] = field(default_factory=dict)
    fits: Fits = field(default_factory=dict)

    @property
    def known(self) -> set[int]:
        """The meetings that came up."""
        return {*self.afters, *self.befores, *self.claims}

    def window(self, index: int) -> Window:
        return self.meetings[index].window

    def after(self, index: int) -> Contact:
        if index not in self.afters:
            found = self.contacts.get(index)
            self.afters[index] = after_contact(self.ego.alone, self.window(index)) if found is None else found
        return self.afters[index]

    def before(self, index: int) -> Contact:
        if index not in self.befores:
            self.befores[index] = before_contact(self.ego.alone, self.window(index))
        return self.befores[index]

    def claim(self, index: int) -> Claim:
        if index not in self.claims:
            self.claims[index] = window_claim(self.ego, self.window(index))
        return self.claims[index]

    def can_be_between(self, after: int, before: int) -> bool:
        """Whether ego can pass after the one and before the other, as far as their claims tell."""
        if (after, before) not in self.fits:
            self.fits[after, before] = are_compatible(self.ego, self.claim(after), self.claim(before))
        return self.fits[after, before]

    def forbidden(self, index: int) -> list[Forbidden]:
        if index not in self.truly:
            self.truly[index] = forbidden(self.ego, self.meetings[index])
        return self.truly[index]

    def take(self, profile: VelocityProfile, how: str) -> None:
        if profile.arrival < self.best.arrival:
            self.best, self.how = profile, how


def time_robot(
    ego: Ego,
    meetings: list[Meeting],
    *,
    profile: str = "fastest",
    certify: bool = False,
    hurried: bool = False,
) -> Timing | None:
    """The quickest profile found for ego that is clear of all meetings.

    None where none is found. Then even waiting at the start does not help, because another robot comes there or
    never leaves ego's way; with an order that respects the blocking arcs this does not happen.

    Parameters
    ----------
    profile : "fastest": as early as possible; "gentle": a delayed robot may arrive a little later where it then
        drives more smoothly.
    hurried : whether the first profile found will do, without a bound that tells how good it is.
    """
    violated = first_violated(meetings, ego.alone)
    if violated is None:
        return _finished(ego.alone, meetings, "alone", ego.solo_bound, 0, False)
    contacts: dict[int, Contact] = {}
    delayed = start_delay(ego.alone, meetings, contacts)
    # where no delay helps, ego has to be gone before somebody comes: then anything is better than a time far away
    how = _NONE if delayed is None else "start delay"
    search = _Search(ego, meetings, delayed or _far_away(ego, meetings), how, contacts)
    nodes, is_open = _branch_and_bound(search)
    if hurried and search.how != _NONE:
        return _finished(search.best, meetings, search.how, ego.solo_bound, nodes, True)
    bound, near = _certified(search, OPTIMAL if certify or ego.caps.is_constant else CLOSED)
    is_open = is_open and bound < search.best.arrival * (1 - CLOSED)
    for most, enough in _EFFORTS if certify else _EFFORTS[:1]:
        if bound < search.best.arrival * (1 - (CLOSED if is_open else enough)):
            closing = close_gap(
                ego, meetings, search.forbidden, near, search.best, bound,
                most=most, enough=enough, decided=not is_open, is_real=search.how != _NONE,
            )  # fmt: skip
            bound, is_open = closing.bound, not closing.is_decided
            if closing.is_new:
                search.take(closing.profile, "program")
    if search.how == _NONE:
        return None
    if profile == "gentle":
        calm = gentle(ego, meetings, search.best, sorted(search.known))
        if calm is not None:
            return _finished(calm, meetings, "gentle", bound, nodes, is_open)
    return _finished(search.best, meetings, search.how, bound, nodes, is_open)


def _far_away(ego: Ego, meetings: list[Meeting]) -> VelocityProfile:
    """The profile alone so late that nobody who has a motion moves any more when it begins."""
    return ego.alone.shifted(max(meeting.profile.arrival for meeting in meetings))


def _branch_and_bound(search: _Search) -> tuple[int, bool]:
    """Improve ``search.best``; the number of subproblems looked at, and whether any was left open."""
    queue: list[tuple[float, int, dict[int, bool], Course | None]] = [(search.ego.solo_bound, 0, {}, None)]
    nodes = pushed = 0
    undecided = False
    while queue and nodes < MOST_NODES:
        bound, _, chosen, course = heapq.heappop(queue)
        if not _can_beat(bound, search.best):
            return nodes, undecided
        nodes += 1
        profile, how = _relaxed(search, chosen, bound, course)
        if profile is None:
            undecided = True
            continue
        # on a path with bends a program's motion is the best of those about its course, not of all
        undecided |= how == "program" and not search.ego.caps.is_constant
        if not _can_beat(profile.arrival, search.best):
            continue
        violated = _first_violated(search, profile, chosen if how == _COURSE else {})
        if violated is None:
            search.take(profile, how)
            continue
        index = violated
        if index in chosen:  # a bound of the tube was missed by rounding
            undecided = True
            continue
        is_bent = how == "program" and not search.ego.caps.is_constant
        course = course_of(profile, search.ego.alone.departure) if is_bent else None
        for passes_after in (True, False):
            choice = chosen | {index: passes_after}
            lower = max(bound, _bound(search, choice))
            if _can_beat(lower, search.best):
                pushed += 1
                heapq.heappush(queue, (lower, pushed, choice, course))
    return nodes, undecided or bool(queue)


def _can_beat(bound: float, best: VelocityProfile) -> bool:
    return bound < best.arrival * (1 - OPTIMAL)


def _bound(search: _Search, chosen: dict[int, bool]) -> float:
    """A time no profile with these choices can beat; infinite where the choices contradict each other.

    A window passed after: from each point (t, s) of its bound the robot still needs the landing. A window
    passed before: even the quickest start must be there in time. Two windows: the time in between must suffice
    for the way from the one passed after to the one passed before.
    """
    bound = search.ego.solo_bound
    claims = {index: search.claim(index) for index in chosen}
    for index, passes_after in chosen.items():
        if passes_after:
            bound = max(bound, claims[index].after)
        elif not claims[index].can_precede:
            return np.inf
    for a in (index for index, passes_after in chosen.items() if passes_after):
        for b in (index for index, passes_after in chosen.items() if not passes_after):
            if not search.can_be_between(a, b):
                return np.inf
    return bound


def _relaxed(
    search: _Search, chosen: dict[int, bool], bound: float, near: Course | None
) -> tuple[VelocityProfile | None, str]:
    """A quick profile that keeps the choices made, whatever it does elsewhere; ``near``: one with a choice less."""
    ego = search.ego
    afters = [search.after(index) for index, passes_after in chosen.items() if passes_after]
    befores = [search.before(index) for index, passes_after in chosen.items() if not passes_after]
    delay = max((contact.delay for contact in afters), default=0.0)
    if delay <= min((contact.delay for contact in befores), default=np.inf):
        return ego.alone.shifted(max(delay, 0.0)), "start delay"
    for profile in spliced(ego, afters, befores):
        if _keeps_choices(search, chosen, profile) and keeps_limits(profile, ego.robot.limits, ego.caps):
            return profile, "splice"
    tube = Tube(
        [after_bound(search.window(index)) for index, passes_after in chosen.items() if passes_after],
        [before_bound(search.window(index)) for index, passes_after in chosen.items() if not passes_after],
    )
    course = None if ego.caps.is_constant else hasty_course(ego, tube)
    if course is not None and _first_violated(search, course.profile, chosen) is not None:
        return course.profile, _COURSE
    most = search.best.arrival * (1 - 10 * OPTIMAL)
    program = through_tube(ego, tube, bound, most, near or course) if bound < most else None
    if program is None or not _keeps_choices(search, chosen, program):
        return None, ""
    return program, "program"


def _first_violated(search: _Search, profile: VelocityProfile, besides: Mapping[int, bool]) -> int | None:
    """The meeting, by index, at which a profile first runs into another robot, some of them left out."""
    kept = [index for index in range(len(search.meetings)) if index not in besides]
    violated = first_violated([search.meetings[index] for index in kept], profile)
    return None if violated is None else kept[violated[0]]


def _keeps_choices(search: _Search, chosen: dict[int, bool], profile: VelocityProfile) -> bool:
    for index, passes_after in chosen.items():
        gap = search.meetings[index].excess(profile)
        if gap is not None and not gap.is_clear:
            return False
        if gap is not None and gap.passes_after != passes_after:
            return False
    return True


def _certified(search: _Search, enough: float) -> tuple[float, list[int]]:
    """An arrival [s] that no motion can beat, and the meetings, by index, that are likely to hold ego up.

    It comes from what is truly forbidden in the meetings that came up in the search, and where these leave much open,
    in all others that could hold ego up for longer. Leaving out a meeting never makes a bound too late, so they are
    added one after the other until the gap is below the share ``enough`` of the arrival.
    """
    ego, arrival = search.ego, search.best.arrival
    bound, claims = ego.solo_bound, []
    fits: Fits = {}
    # those that cost most when passed after tell most: often a few of them prove all that there is to prove
    known = sorted(search.known, key=lambda index: (-search.claim(index).after, index))
    further = [
        index
        for index, meeting in enumerate(search.meetings)
        if index not in search.known and could_hold_up(ego, meeting, ego.solo_bound)
    ]
    for count, index in enumerate([*known, *further], start=1):
        claims += claims_of(ego, search.forbidden(index))
        bound = max(bound, least_arrival(ego, claims, arrival, known=fits))
        if bound >= arrival * (1 - (enough if count < len(known) else CLOSED)):
            break
    return bound, sorted({*known, *further})


def _finished(
    profile: VelocityProfile, meetings: list[Meeting], how: str, lower_bound: float, nodes: int, is_open: bool
) -> Timing:
    lower_bound = min(lower_bound, profile.arrival)  # a splice may arrive sooner by its rounding
    return Timing(profile, *passed(meetings, profile), how, lower_bound, nodes, is_open)


def passed(meetings: list[Meeting], profile: VelocityProfile) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Of the other robots those that a profile lets pass, and those that it precedes."""
    after = {meeting.other for meeting in meetings if meeting.passes_after(profile)}
    before = {meeting.other for meeting in meetings} - after
    return tuple(sorted(after)), tuple(sorted(before))
