"""Times that no motion can beat: what passing after, or before, another robot costs at least.

From outer windows these bounds steer the search among the motions that the planner may choose from. From inner
ones, where every place is truly forbidden, they hold for every motion there is, and are certified.
"""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from coord.alone.inverse import time_at
from coord.conflicts.inner import inner_regions
from coord.conflicts.region import ConflictRegion
from coord.conflicts.window import Window
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.timing.bends import Passages
from coord.timing.clock import clock
from coord.timing.ego import Ego, earliest, still_needed
from coord.timing.meeting import Meeting
from coord.timing.reach import Part, part
from coord.tolerances import SAME_PLACE

#: Combinations of before and after looked at for one robot's certified bound.
_MOST_NODES = 200


@dataclass(frozen=True, slots=True, eq=False)
class Claim:
    """What a place that is taken for a while asks of ego.

    Parameters
    ----------
    after : arrival [s] that no motion passing after can beat; infinite where none can.
    can_precede : whether the quickest start gets past in time.
    leaves, since : (n,) times [s], increasing, and the least times [s] from ego's start to where it may be by then at
        most, passing after; infinite where it may be anywhere.
    comes, by : (m,) times [s] and the least times [s] from the start to where it must be by then, passing before.
    tight : what matters of both where bends lie in between; None on paths without any.
    """

    after: float
    can_precede: bool
    leaves: Array
    since: Array
    comes: Array
    by: Array
    tight: Tight | None


def window_claim(ego: Ego, window: Window) -> Claim:
    """What a window asks."""
    times = np.stack([window.times[:-1], window.times[1:]], axis=1).ravel()
    return _claim(ego, times, window.low.ravel(), window.high.ravel(), window.lasts)


def could_hold_up(ego: Ego, meeting: Meeting, arrival: float) -> bool:
    """Whether passing after the other robot there could make ego later than an arrival [s], by a look at the box."""
    _, last, low, _ = meeting.box
    return bool(last + still_needed(ego, np.array([low]))[0] > arrival)


#: Whether ego can pass after the one and before the other of two claims, by their places in a sequence.
Fits: TypeAlias = dict[tuple[int, int], bool]

#: Moments (m,) [s], least and largest forbidden arc length (m,), (m,) [m] then, and whether the last hold for ever.
Forbidden: TypeAlias = tuple[Array, Array, Array, bool]


def forbidden(ego: Ego, meeting: Meeting) -> list[Forbidden]:
    """The parts of a meeting where every place is truly forbidden."""
    found: list[Forbidden] = []
    for region in inner_regions(meeting.region, ego.length):
        times = _moments(region, meeting.profile)
        if len(times):
            lasts = meeting.ends.other_parks and bool(region.sigma[-1] >= meeting.profile.length)
            found.append((times, *_ends(region, meeting.profile.places(times)), lasts))
    return found


def inner_claims(ego: Ego, meeting: Meeting) -> list[Claim]:
    """What is asked by the parts of a meeting that are truly forbidden."""
    return claims_of(ego, forbidden(ego, meeting))


def claims_of(ego: Ego, truly: Sequence[Forbidden]) -> list[Claim]:
    """What forbidden parts ask."""
    found = []
    for times, low, high, lasts in truly:
        if lasts:
            times, low, high = np.append(times, np.inf), np.append(low, low[-1]), np.append(high, high[-1])
        found.append(_claim(ego, times, low, high, lasts))
    return found


def parts_of(ego: Ego, truly: Sequence[Forbidden]) -> list[Part]:
    """The same for forbidden parts that are known."""
    return [part(ego, times, low, high, lasts=lasts) for times, low, high, lasts in truly]


def _claim(ego: Ego, times: Array, low: Array, high: Array, lasts: bool) -> Claim:
    length = ego.length
    at, past = np.minimum(np.maximum(low, 0.0), length), np.minimum(np.maximum(high, 0.0), length)
    at_clock, past_clock = clock(ego.relaxed, at), clock(ego.relaxed, past)
    after = np.inf
    if not lasts and float(low.min()) >= -SAME_PLACE:
        after = float((times + still_needed(ego, at, at_clock))[low < length].max(initial=-np.inf))
    is_late = (earliest(ego, past, past_clock) > times) & (high > 0)
    can_precede = float(high.max()) <= length + SAME_PLACE and not is_late.any()
    order = np.argsort(times, kind="stable")
    since = np.where(low < length, at_clock, np.inf)
    by = np.where(high > 0, past_clock, -np.inf)
    leaves, since = times[order], since[order]
    return Claim(after, can_precede, leaves, since, times, by, _tight(ego, leaves, since, times, by))


def are_compatible(ego: Ego, after: Claim, before: Claim) -> bool:
    """Whether the time suffices from every point of the one bound to every point of the other."""
    # a point of the one that lies later holds as it is; one that lies earlier lets the robot go on at its quickest
    finite = np.isfinite(after.leaves) & np.isfinite(after.since)
    leaves, since = after.leaves[finite], after.since[finite]
    later = np.append(np.minimum.accumulate(since[::-1])[::-1], np.inf)
    earlier = np.append(np.inf, np.minimum.accumulate(since - leaves))
    count = np.searchsorted(leaves, before.comes, side="left")
    if not np.all(np.minimum(later[count], earlier[count] + before.comes) >= before.by):
        return False
    return ego.bends is None or _go_through_bends(ego.bends, after.tight, before.tight)


@dataclass(frozen=True, slots=True, eq=False)
class Tight:
    """The points of a claim that leave the robot least time, one between each two marks of the bends.

    Parameters
    ----------
    at, clocks, marks : of the points where it passes after: times [s], least times from the start [s], and the marks
        that follow; ``by``, ``by_clocks``, ``by_marks`` : where it passes before, the marks before them.
    """

    at: Array
    clocks: Array
    marks: npt.NDArray[np.intp]
    by: Array
    by_clocks: Array
    by_marks: npt.NDArray[np.intp]


def _tight(ego: Ego, leaves: Array, since: Array, comes: Array, by: Array) -> Tight | None:
    if ego.bends is None:
        return None
    marks = clock(ego.relaxed, ego.bends.marks)
    after = np.flatnonzero(np.isfinite(leaves) & (since < marks[-1]))
    before = np.flatnonzero(np.isfinite(comes) & (by > 0))
    i = np.searchsorted(marks, since[after], side="left")
    k = np.searchsorted(marks, by[before], side="right") - 1
    first, last = _least_of_each(i, (since - leaves)[after]), _least_of_each(k, (comes - by)[before])
    after, before = after[first], before[last]
    return Tight(leaves[after], since[after], i[first], comes[before], by[before], k[last])


def _least_of_each(groups: npt.NDArray[np.intp], values: Array) -> npt.NDArray[np.intp]:
    """The index of the least value of each group."""
    order: npt.NDArray[np.intp] = np.lexsort((values, groups))
    first: npt.NDArray[np.intp] = order[np.append(True, np.diff(groups[order]) > 0)[: len(order)]]
    return first


def _go_through_bends(bends: Passages, after: Tight | None, before: Tight | None) -> bool:
    """Whether the time suffices with the jerk at bends in between as well."""
    if after is None or before is None:
        return True
    spare = (before.by[None] - after.at[:, None]) - (before.by_clocks[None] - after.clocks[:, None])
    needed = bends.between[after.marks[:, None], before.by_marks[None]]
    comes_later = (before.by[None] > after.at[:, None]) & (before.by_marks[None] > after.marks[:, None])
    return not bool(np.any(comes_later & (spare < needed)))


def least_arrival(
    ego: Ego, claims: Sequence[Claim], enough: float, ahead_of: Claim | None = None, known: Fits | None = None
) -> float:
    """The least arrival [s] over all combinations of before and after, as far as the claims tell; at most ``enough``.

    Parameters
    ----------
    ahead_of : one of the claims, which is passed before; it must be one that costs something when passed after.
    known : for pairs of these claims, by their places, what ``are_compatible`` says; what is asked is added.

    Best first over combinations: a claim whose one side is impossible is settled; else the claim that costs most
    when passed after is tried on both sides.
    """
    known = {} if known is None else known
    places = sorted((k for k in range(len(claims)) if claims[k].after > ego.solo_bound), key=lambda k: -claims[k].after)
    for a, b in itertools.product(places, places):
        if (a, b) not in known:
            known[a, b] = a == b or are_compatible(ego, claims[a], claims[b])
    costly, fits = [claims[k] for k in places], [[known[a, b] for b in places] for a in places]
    chosen = {k: False for k, claim in enumerate(costly) if claim is ahead_of}
    queue: list[tuple[float, int, dict[int, bool]]] = [(ego.solo_bound, 0, chosen)]
    pushed = itertools.count(1)
    for _ in range(_MOST_NODES):
        if not queue:
            return enough
        bound, _, chosen = heapq.heappop(queue)
        settled = _settled(costly, fits, chosen, bound)
        if settled is None:
            continue
        bound, chosen, undecided = settled
        if bound >= enough or undecided is None:
            if queue and queue[0][0] < bound:
                heapq.heappush(queue, (bound, next(pushed), chosen))
                continue
            return min(bound, enough)
        for passes_after in (True, False):
            heapq.heappush(queue, (bound, next(pushed), chosen | {undecided: passes_after}))
    return min(queue[0][0], enough)


def _settled(
    claims: Sequence[Claim], fits: Sequence[Sequence[bool]], chosen: dict[int, bool], bound: float
) -> tuple[float, dict[int, bool], int | None] | None:
    """The bound with all that follows from the sides chosen, and a claim to decide next; None if it is impossible.

    No claim to decide is left where passing after all the others costs nothing more.
    """
    chosen = dict(chosen)
    while True:
        undecided = None
        changed = False
        for k, claim in enumerate(claims):
            if chosen.get(k) is None:
                after = np.isfinite(claim.after) and _fits_all(fits, chosen, k, True)
                before = claim.can_precede and _fits_all(fits, chosen, k, False)
                if not after and not before:
                    return None
                if after and before:
                    if undecided is None and claim.after > bound:
                        undecided = k
                    continue
                chosen[k], changed = after, True
            if chosen[k]:
                bound = max(bound, claim.after)
        if not changed:
            break
    for k, passes_after in chosen.items():
        possible = np.isfinite(claims[k].after) if passes_after else claims[k].can_precede
        if not possible or not _fits_all(fits, chosen, k, passes_after):
            return None
    if undecided is not None and claims[undecided].after <= bound:
        undecided = next((k for k, claim in enumerate(claims) if k not in chosen and claim.after > bound), None)
    return bound, chosen, undecided


def _fits_all(fits: Sequence[Sequence[bool]], chosen: dict[int, bool], k: int, passes_after: bool) -> bool:
    """Whether a side of one claim goes with the sides chosen of all others."""
    if passes_after:
        return all(fits[k][other] for other, after in chosen.items() if not after)
    return all(fits[other][k] for other, after in chosen.items() if after)


def _moments(part: ConflictRegion, profile: VelocityProfile) -> Array:
    """Times [s] at which the other robot is in a part: about when it passes nodes, and when its motion changes."""
    if not len(profile.jerks):
        return np.array([0.0]) if part.sigma[0] <= 0 <= part.sigma[-1] else np.empty(0)
    times = np.unique(np.concatenate([[0.0], time_at(profile, part.sigma), profile.times]))
    times = np.concatenate([times, (times[:-1] + times[1:]) / 2])
    sigma = profile.places(times)
    return np.sort(times[(sigma >= part.sigma[0]) & (sigma <= part.sigma[-1])])


def _ends(part: ConflictRegion, sigma: Array) -> tuple[Array, Array]:
    """The bounds (m,) [m] at places sigma (m,) [m] of the other's path."""
    k = np.clip(np.searchsorted(part.sigma, sigma, side="right") - 1, 0, len(part.low) - 1)
    width = np.diff(part.sigma)[k]
    share = np.divide(sigma - part.sigma[k], width, out=np.zeros_like(sigma), where=width > 0)
    low, high = (line[k, 0] + (line[k, 1] - line[k, 0]) * share for line in (part.low, part.high))
    return low, high
