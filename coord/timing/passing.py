"""Before or after: which robots to let pass and whom to precede, by branch and bound.

The search starts from the profile alone. Where it first runs into another robot there are two choices, to
pass after it or before it; each is a subproblem with one more bound on s(t). Subproblems are taken in the
order of their lower bounds, until none is left below the best profile found.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field

import numpy as np

from coord.alone.check import keeps_limits
from coord.conflicts.window import Window
from coord.model.profile import VelocityProfile
from coord.timing.delay import Contact, after_contact, before_contact, start_delay
from coord.timing.ego import Ego
from coord.timing.meeting import Meeting, first_violated
from coord.timing.program import Tube, through_tube
from coord.timing.splice import spliced
from coord.timing.tube import after_bound, before_bound
from coord.tolerances import OPTIMAL

#: [s] With so much less delay, the window that a delay is for is violated.
_A_LITTLE = 1e-3

#: Subproblems looked at for one robot before the best profile found is taken as it is.
MOST_NODES = 60


@dataclass(frozen=True, slots=True, eq=False)
class Timing:
    """One robot's profile against those before it.

    Parameters
    ----------
    after, before : indices of the other robots that it lets pass, and that it precedes, where they meet.
    how : "alone", "start delay", "splice" or "program".
    nodes : subproblems looked at; ``open`` : whether the search ended with some undecided.
    """

    profile: VelocityProfile
    after: tuple[int, ...]
    before: tuple[int, ...]
    how: str
    nodes: int = 0
    open: bool = False


@dataclass(slots=True, eq=False)
class _Search:
    """What the subproblems of one robot share: contacts are worked out once a window."""

    ego: Ego
    meetings: list[Meeting]
    best: VelocityProfile
    how: str
    afters: dict[int, Contact] = field(default_factory=dict)
    befores: dict[int, Contact] = field(default_factory=dict)

    def window(self, index: int) -> Window:
        return self.meetings[index].window

    def after(self, index: int) -> Contact:
        if index not in self.afters:
            self.afters[index] = after_contact(self.ego.alone, self.window(index))
        return self.afters[index]

    def before(self, index: int) -> Contact:
        if index not in self.befores:
            self.befores[index] = before_contact(self.ego.alone, self.window(index))
        return self.befores[index]

    def take(self, profile: VelocityProfile, how: str) -> None:
        if profile.arrival < self.best.arrival:
            self.best, self.how = profile, how


def time_robot(ego: Ego, meetings: list[Meeting], *, is_last: bool = False) -> Timing | None:
    """The quickest profile found for ego that is clear of all meetings.

    None where even waiting at the start does not help, because another robot never leaves ego's way; with
    an order that respects the blocking arcs this does not happen.

    Parameters
    ----------
    is_last : nobody planned later can meet ego. Then it may roll and slow down instead of waiting at its
        start. Done by everybody, this was measured to cost those who come later more than it gains.
    """
    violated = first_violated(meetings, ego.alone)
    if violated is None:
        return _finished(ego.alone, meetings, "alone", 0, False)
    delayed = start_delay(ego.alone, meetings)
    if delayed is None:
        return None
    search = _Search(ego, meetings, delayed, "start delay")
    nodes, is_open = _branch_and_bound(search)
    if search.how == "start delay" and is_last:
        _give_way_on_the_move(search)
    return _finished(search.best, meetings, search.how, nodes, is_open)


def _give_way_on_the_move(search: _Search) -> None:
    """Replace waiting at the start by slowing down on the way, where that arrives no later.

    For the robot's own arrival the two are the same; seen from the floor, the one stands in nobody's way for
    long, and drives with fewer stops.
    """
    ego, delayed = search.ego, search.best
    delay = delayed.departure - ego.alone.departure
    binding = first_violated(search.meetings, ego.alone.shifted(delay - _A_LITTLE))
    if binding is None:
        return
    contact = search.after(binding[0])
    for profile in spliced(ego, [Contact(delay, contact.time, contact.s)], []):
        if first_violated(search.meetings, profile) is None and keeps_limits(profile, ego.robot.limits, ego.caps):
            search.best, search.how = profile, "splice"
            return


def _branch_and_bound(search: _Search) -> tuple[int, bool]:
    """Improve ``search.best``; the number of subproblems looked at, and whether any was left open."""
    queue: list[tuple[float, int, dict[int, bool]]] = [(search.ego.solo_bound, 0, {})]
    nodes = pushed = 0
    undecided = False
    while queue and nodes < MOST_NODES:
        bound, _, chosen = heapq.heappop(queue)
        if not _can_beat(bound, search.best):
            return nodes, undecided
        nodes += 1
        profile, how = _relaxed(search, chosen, bound)
        if profile is None:
            undecided = True
            continue
        if not _can_beat(profile.arrival, search.best):
            continue
        violated = first_violated(search.meetings, profile)
        if violated is None:
            search.take(profile, how)
            continue
        index = violated[0]
        if index in chosen:  # a bound of the tube was missed by rounding
            undecided = True
            continue
        for passes_after in (True, False):
            choice = chosen | {index: passes_after}
            lower = max(bound, _bound(search, choice))
            if _can_beat(lower, search.best):
                pushed += 1
                heapq.heappush(queue, (lower, pushed, choice))
    return nodes, undecided or bool(queue)


def _can_beat(bound: float, best: VelocityProfile) -> bool:
    return bound < best.arrival * (1 - OPTIMAL)


def _bound(search: _Search, chosen: dict[int, bool]) -> float:
    """A time no profile with these choices can beat; infinite where the choices contradict each other.

    A window passed after: from each point (t, s) of its bound the robot still needs the landing. A window
    passed before: even the launch must be there in time. Two windows: speed times the time in between must
    cover the way from the one passed after to the one passed before.
    """
    ego = search.ego
    bound = ego.solo_bound
    for index, passes_after in chosen.items():
        window = search.window(index)
        if passes_after:
            bound = max(bound, _after_bound(ego, window))
        elif not _can_precede(ego, window):
            return np.inf
    for a in (index for index, passes_after in chosen.items() if passes_after):
        for b in (index for index, passes_after in chosen.items() if not passes_after):
            if not _compatible(search.window(a), search.window(b), ego.robot.limits.speed):
                return np.inf
    return bound


def _after_bound(ego: Ego, window: Window) -> float:
    if window.lasts or float(window.low.min()) < 0:
        return np.inf
    times = np.stack([window.times[:-1], window.times[1:]], axis=1)
    return float((times + ego.landing.time(ego.length - window.low.ravel()).reshape(-1, 2)).max())


def _can_precede(ego: Ego, window: Window) -> bool:
    if float(window.high.max()) > ego.length:
        return False
    departure = ego.alone.departure
    earliest = departure + ego.launch.time(window.high.ravel()).reshape(-1, 2)
    times = np.stack([window.times[:-1], window.times[1:]], axis=1)
    return bool(np.all(earliest <= times))


def _compatible(after: Window, before: Window, speed: float) -> bool:
    """Whether full speed suffices from every point of the one bound to every point of the other."""
    ta, sa = np.stack([after.times[:-1], after.times[1:]], axis=1).ravel(), after.low.ravel()
    tb, sb = np.stack([before.times[:-1], before.times[1:]], axis=1).ravel(), before.high.ravel()
    order = np.argsort(ta, kind="stable")
    ta, sa = ta[order], sa[order]
    # a point of the one that lies later holds as it is; one that lies earlier lets the robot go on at full speed
    later = np.append(np.minimum.accumulate(sa[::-1])[::-1], np.inf)
    earlier = np.append(np.inf, np.minimum.accumulate(sa - speed * ta))
    count = np.searchsorted(ta, tb, side="left")
    return bool(np.all(np.minimum(later[count], earlier[count] + speed * tb) >= sb))


def _relaxed(search: _Search, chosen: dict[int, bool], bound: float) -> tuple[VelocityProfile | None, str]:
    """A quick profile that keeps the choices made, whatever it does elsewhere."""
    ego = search.ego
    afters = [search.after(index) for index, passes_after in chosen.items() if passes_after]
    befores = [search.before(index) for index, passes_after in chosen.items() if not passes_after]
    delay = max((contact.delay for contact in afters), default=0.0)
    if delay <= min((contact.delay for contact in befores), default=np.inf):
        return ego.alone.shifted(max(delay, 0.0)), "start delay"
    for profile in spliced(ego, afters, befores):
        if _keeps_choices(search, chosen, profile) and keeps_limits(profile, ego.robot.limits, ego.caps):
            return profile, "splice"
    if not ego.caps.is_constant:
        return None, ""
    tube = Tube(
        [after_bound(search.window(index)) for index, passes_after in chosen.items() if passes_after],
        [before_bound(search.window(index)) for index, passes_after in chosen.items() if not passes_after],
    )
    program = through_tube(ego, tube, bound, search.best.arrival * (1 - 10 * OPTIMAL))
    if program is None or not _keeps_choices(search, chosen, program):
        return None, ""
    return program, "program"


def _keeps_choices(search: _Search, chosen: dict[int, bool], profile: VelocityProfile) -> bool:
    for index, passes_after in chosen.items():
        gap = search.meetings[index].excess(profile)
        if gap is not None and not gap.is_clear:
            return False
        if gap is not None and gap.passes_after != passes_after:
            return False
    return True


def _finished(profile: VelocityProfile, meetings: list[Meeting], how: str, nodes: int, is_open: bool) -> Timing:
    after = {meeting.other for meeting in meetings if meeting.passes_after(profile)}
    before = {meeting.other for meeting in meetings} - after
    return Timing(profile, tuple(sorted(after)), tuple(sorted(before)), how, nodes, is_open)
