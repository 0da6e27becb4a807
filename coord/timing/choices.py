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

from coord.conflicts.window import Window
from coord.model.profile import VelocityProfile
from coord.timing.bounds import Claim, Fits, Forbidden, are_compatible, forbidden, window_claim
from coord.timing.closing import CLOSED
from coord.timing.corridor import Corridor, corridor
from coord.timing.delay import Contact, after_contact, before_contact
from coord.timing.ego import Ego, sharpened
from coord.timing.grid import Course
from coord.timing.haste import hasty_course
from coord.timing.meeting import Meeting, first_violated
from coord.timing.program import course_of, through_tube
from coord.timing.splice import spliced
from coord.timing.tube import Tube, after_bound, before_bound
from coord.tolerances import OPTIMAL

#: The bounds of bends are tightened in so many rounds before a program is solved; and where windows are refined.
_SHARP, _SHARPER = 1, 4

#: What a subproblem yields when it is still to be branched: no motion but a course that forgets the jerk.
_COURSE = "course"

#: Nor is any branched whose bound, looked at more closely, is too late.
_BEATEN = "beaten"

#: Subproblems looked at for one robot before the best profile found is taken as it is.
MOST_NODES = 60


@dataclass(slots=True, eq=False)
class Search:
    """What the subproblems of one robot share: contacts are worked out once a window.

    Parameters
    ----------
    best, how : the quickest profile found so far, and how it came about.
    contacts : with windows passed after, as far as they are known already.
    known : meetings, by index, that came up.
    effort : how much time may be spent: 0 where a closer search may follow, else 1, or 2 for the closest there is.
    sharp : rounds in which the bounds of bends were tightened.
    failed : choices that contradict nothing, but no program found a motion with them.
    """

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
    known: set[int] = field(default_factory=set)
    effort: int = 0
    sharp: int = 0
    failed: list[dict[int, bool]] = field(default_factory=list)

    def window(self, index: int) -> Window:
        """The window of a meeting."""
        return self.meetings[index].window

    def after(self, index: int) -> Contact:
        """Where the profile alone touches a window when it is as little late as passing after asks for."""
        if index not in self.afters:
            self.known.add(index)
            found = self.contacts.get(index)
            self.afters[index] = after_contact(self.ego.alone, self.window(index)) if found is None else found
        return self.afters[index]

    def before(self, index: int) -> Contact:
        """The same when it is as late as passing before allows."""
        if index not in self.befores:
            self.known.add(index)
            self.befores[index] = before_contact(self.ego.alone, self.window(index))
        return self.befores[index]

    def claim(self, index: int) -> Claim:
        """What a window asks of ego."""
        if index not in self.claims:
            self.known.add(index)
            self.claims[index] = window_claim(self.ego, self.window(index))
        return self.claims[index]

    def can_be_between(self, after: int, before: int) -> bool:
        """Whether ego can pass after the one and before the other, as far as their claims tell."""
        if (after, before) not in self.fits:
            self.fits[after, before] = are_compatible(self.ego, self.claim(after), self.claim(before))
        return self.fits[after, before]

    def forbidden(self, index: int) -> list[Forbidden]:
        """What is truly forbidden in a meeting."""
        if index not in self.truly:
            self.truly[index] = forbidden(self.ego, self.meetings[index])
        return self.truly[index]

    def sharpen(self) -> bool:
        """Tighten what is known of bends, before much time is spent on what that may settle; whether it was not yet."""
        rounds = (_SHARPER if self.effort else _SHARP) - self.sharp
        if rounds <= 0 or self.ego.caps.is_constant:
            return False
        self.ego, self.sharp = sharpened(self.ego, rounds), self.sharp + rounds
        self.claims.clear()
        self.fits.clear()
        return True

    def take(self, profile: VelocityProfile, how: str) -> None:
        """Keep a profile that is clear of all meetings if it is the quickest so far."""
        if profile.arrival < self.best.arrival:
            self.best, self.how = profile, how


def branch_and_bound(search: Search) -> tuple[int, bool]:
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
        if how == _BEATEN:
            continue
        if profile is None:
            undecided = True
            continue
        # on a path with bends a program's motion is the best of those about its course, not of all
        is_best = how != "program" or search.ego.caps.is_constant or profile.arrival * (1 - CLOSED) <= bound
        if not _can_beat(profile.arrival, search.best):
            undecided |= not is_best
            continue
        violated = _first_violated(search, profile, chosen if how == _COURSE else {})
        if violated is None:
            undecided |= not is_best
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


def _bound(search: Search, chosen: dict[int, bool]) -> float:
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
    search: Search, chosen: dict[int, bool], bound: float, near: Course | None
) -> tuple[VelocityProfile | None, str]:
    """A quick profile that keeps the choices made, whatever it does elsewhere; ``near``: one with a choice less."""
    afters = [search.after(index) for index, passes_after in chosen.items() if passes_after]
    befores = [search.before(index) for index, passes_after in chosen.items() if not passes_after]
    delay = max((contact.delay for contact in afters), default=0.0)
    if delay <= min((contact.delay for contact in befores), default=np.inf):
        return search.ego.alone.shifted(max(delay, 0.0)), "start delay"
    tube = Tube(
        [after_bound(search.window(index)) for index, passes_after in chosen.items() if passes_after],
        [before_bound(search.window(index)) for index, passes_after in chosen.items() if not passes_after],
    )
    ego = search.ego
    course = None if ego.caps.is_constant else hasty_course(ego, tube)
    if course is not None and _first_violated(search, course.profile, chosen) is not None:
        return course.profile, _COURSE
    if np.isfinite(delay) and min((contact.delay for contact in befores), default=0.0) >= 0:
        for profile in spliced(ego, _corridor(search, chosen), delay):
            if _keeps_choices(search, chosen, profile):
                return profile, "splice"
    if search.sharpen():
        bound = max(bound, _bound(search, chosen))
        if not _can_beat(bound, search.best):
            return None, _BEATEN
    most = search.best.arrival * (1 - 10 * OPTIMAL)
    if bound >= most:
        return None, ""

    def runs_elsewhere(profile: VelocityProfile) -> bool:  # then it only tells where to branch
        return _first_violated(search, profile, chosen) is not None

    program = through_tube(ego, tube, bound, most, near or course, effort=search.effort, is_enough=runs_elsewhere)
    if program is None or not _keeps_choices(search, chosen, program):
        search.failed.append(chosen)
        return None, ""
    return program, "program"


def _corridor(search: Search, chosen: Mapping[int, bool]) -> Corridor:
    """The delays that the choices ask for and allow."""
    sides = [[search.window(index) for index, after in chosen.items() if after is side] for side in (True, False)]
    return corridor(search.ego.alone, *sides)


def _first_violated(search: Search, profile: VelocityProfile, besides: Mapping[int, bool]) -> int | None:
    """The meeting, by index, at which a profile first runs into another robot, some of them left out."""
    kept = [index for index in range(len(search.meetings)) if index not in besides]
    violated = first_violated([search.meetings[index] for index in kept], profile)
    return None if violated is None else kept[violated[0]]


def _keeps_choices(search: Search, chosen: dict[int, bool], profile: VelocityProfile) -> bool:
    for index, passes_after in chosen.items():
        gap = search.meetings[index].excess(profile)
        if gap is not None and not gap.is_clear:
            return False
        if gap is not None and gap.passes_after != passes_after:
            return False
    return True
