"""The quickest profile of one robot past those before it, with a certified bound on how much quicker any could be.

First the tree of choices is searched past windows that are bounds on the safe side by millimetres. Where that leaves
something open, or a gap to the certified bound, once more past windows that are nearer to the truth.
"""

from __future__ import annotations

from dataclasses import dataclass

from coord.model.profile import VelocityProfile
from coord.timing.bounds import Fits, claims_of, could_hold_up, least_arrival
from coord.timing.choices import Search, branch_and_bound
from coord.timing.closing import CLOSED, close_gap, is_plainly_best
from coord.timing.delay import Contact, start_delay
from coord.timing.ego import Ego
from coord.timing.gentle import gentle
from coord.timing.meeting import Meeting, first_violated
from coord.tolerances import OPTIMAL

#: To close the gap to a robot's bound: so many relaxations are solved at most, and a gap below such a share of the
#: arrival is left as it is. The second effort is made where proof is asked for.
_ENOUGH = 5e-3
_EFFORTS = ((40, _ENOUGH), (600, CLOSED))

#: Where more meetings came up than these, windows are not refined, and so many relaxations do.
_FEW, _MOST_OF_MANY = 16, 20

#: Where no more came up, and the robot is there within so many seconds, a gap that a program leaves is worth the finest
#: grids, whose cells become many.
_VERY_FEW, _SHORT = 3, 30.0

#: A bound is worked out from so many meetings at most.
_MOST_MEETINGS = 24

#: How a robot drives for which nothing has been found yet.
_NONE = "none"


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
    if first_violated(meetings, ego.alone) is None:
        return _finished(ego.alone, meetings, "alone", ego.solo_bound, 0, False)
    found = _found(ego, meetings, certify=certify, hurried=hurried)
    if not hurried and len(found.search.known) <= _FEW and found.is_loose:
        finer = [meeting.refined() for meeting in meetings]
        found = found.or_rather(_found(found.search.ego, finer, certify=certify, effort=1, sharp=found.search.sharp))
        if found.is_stubborn:
            finest = [meeting.refined().refined() for meeting in finer]
            found = found.or_rather(_found(ego, finest, certify=certify, effort=2))
    search = found.search
    if search.how == _NONE:
        return None
    if profile == "gentle":
        calm = gentle(ego, search.meetings, search.best, sorted(search.known))
        if calm is not None:
            return _finished(calm, search.meetings, "gentle", found.bound, found.nodes, found.is_open)
    return _finished(search.best, search.meetings, search.how, found.bound, found.nodes, found.is_open)


@dataclass(frozen=True, slots=True, eq=False)
class _Found:
    """The end of a search: its certified bound [s], how many subproblems were looked at, and whether some is open."""

    search: Search
    bound: float
    nodes: int
    is_open: bool

    @property
    def is_loose(self) -> bool:
        """Whether windows that are nearer to the truth may settle something: a choice, or a gap that is too large.

        Bounds from them lie below those from the windows at hand, which forbid more than the truth; only a program may
        gain by finer grids as well.
        """
        search, arrival = self.search, self.search.best.arrival
        few = arrival * (1 - (CLOSED if search.ego.caps.is_constant else _ENOUGH))
        if self.is_open or self.bound >= few:
            return self.is_open
        if search.how == "program":
            return True
        return least_arrival(search.ego, [search.claim(index) for index in sorted(search.known)], arrival) >= few

    @property
    def is_stubborn(self) -> bool:
        """Whether a program left a gap that the finest grids may close: a short time without bends past few robots."""
        search, arrival = self.search, self.search.best.arrival
        is_simple = search.ego.caps.is_constant and len(search.known) <= _VERY_FEW
        is_short = arrival - search.ego.alone.departure <= _SHORT
        return search.how == "program" and is_simple and is_short and self.bound < arrival * (1 - _ENOUGH)

    def or_rather(self, other: _Found) -> _Found:
        """The earlier of both, with what both have shown; the later one's choices say nothing if it is much later."""
        first, later = (other, self) if other.search.best.arrival < self.search.best.arrival else (self, other)
        is_close = first.search.best.arrival >= later.search.best.arrival * (1 - CLOSED)
        is_open = first.is_open and (later.is_open or not is_close)
        return _Found(first.search, max(self.bound, other.bound), self.nodes + other.nodes, is_open)


def _found(
    ego: Ego, meetings: list[Meeting], *, certify: bool, hurried: bool = False, effort: int = 0, sharp: int = 0
) -> _Found:
    """The quickest profile past the windows of some meetings.

    ``effort`` : whether what is open after the search of the tree is worth any more time, and how much; ``sharp`` :
    rounds in which the bounds of bends were tightened before.
    """
    contacts: dict[int, Contact] = {}
    delayed = start_delay(ego.alone, meetings, contacts)
    # where no delay helps, ego has to be gone before somebody comes: then anything is better than a time far away
    how = _NONE if delayed is None else "start delay"
    search = Search(ego, meetings, delayed or _far_away(ego, meetings), how, contacts, effort=effort, sharp=sharp)
    nodes, is_open = branch_and_bound(search)
    if hurried and search.how != _NONE:
        return _Found(search, ego.solo_bound, nodes, True)
    bound, near = _certified(search, OPTIMAL if certify or ego.caps.is_constant else CLOSED)
    if bound < search.best.arrival * (1 - (CLOSED if is_open else _ENOUGH)) and search.sharpen():
        bound, near = _certified(search, CLOSED)
    is_open = is_open and bound < search.best.arrival * (1 - CLOSED)
    if is_open and not effort and len(search.known) <= _FEW:
        is_open = not is_plainly_best(search.ego, meetings, search.forbidden, sorted(near), search.best)
        if is_open:
            return _Found(search, bound, nodes, True)
    for most, enough in _EFFORTS if certify else _EFFORTS[:1]:
        if bound < search.best.arrival * (1 - (CLOSED if is_open else enough)):
            # a proof that no other choice is better needs them all
            some = sorted(near if is_open else near[:_MOST_MEETINGS])
            closing = close_gap(
                search.ego, meetings, search.forbidden, some, search.best, bound,
                most=most if certify or len(near) <= _FEW else _MOST_OF_MANY, enough=enough,
                decided=not is_open, is_real=search.how != _NONE, failed=search.failed,
            )  # fmt: skip
            bound, is_open = closing.bound, not closing.is_decided
            if closing.is_new:
                search.take(closing.profile, "program")
    return _Found(search, bound, nodes, is_open)


def _far_away(ego: Ego, meetings: list[Meeting]) -> VelocityProfile:
    """The profile alone so late that nobody who has a motion moves any more when it begins."""
    return ego.alone.shifted(max(meeting.profile.arrival for meeting in meetings))


def _certified(search: Search, enough: float) -> tuple[float, list[int]]:
    """An arrival [s] that no motion can beat, and the meetings that may hold ego up, those first that cost most.

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
    near = [*known, *further]
    for count, index in enumerate(near[:_MOST_MEETINGS], start=1):
        claims += claims_of(ego, search.forbidden(index))
        bound = max(bound, least_arrival(ego, claims, arrival, known=fits))
        if bound >= arrival * (1 - (enough if count < len(known) else _ENOUGH)):
            break
    return bound, near


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
