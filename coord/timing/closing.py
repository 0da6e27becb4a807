"""Closing the gap between a robot's arrival and its certified bound, from both sides, with the outer program.

The outer program is asked whether any motion can arrive by some time. A no raises the bound. Otherwise it shows what
a motion might be like that does, and through the tube along that the inner program seeks one that can be driven.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from coord.conflicts.window import Window
from coord.model.profile import VelocityProfile
from coord.timing.bounds import Forbidden, parts_of
from coord.timing.ego import Ego
from coord.timing.grid import Course
from coord.timing.meeting import Meeting, first_violated
from coord.timing.outer import Verdict, could_arrive, sides_of
from coord.timing.program import through_tube
from coord.timing.reach import Part
from coord.timing.tube import Tube, after_bound, before_bound

#: [1] A gap below this share of the arrival is closed.
CLOSED = 1e-3

#: The first step up from the bound: a share of it, and [s]. Steps then grow by a factor.
_SHARE, _STEP, _GROWTH = 1e-3, 0.02, 4.0

#: One question takes at most this share of all relaxations: a later arrival, or another course, may be easier.
_A_QUESTION = 0.4

#: So many times nothing may come of what seems possible: a later arrival seems so, too.
_FAILURES = 2

#: Relaxations with which it is asked whether no other choice can be better: often that is plain to see.
_GLANCE = 3

#: [1] As long as a step leaves less than this share of the gap, the next one is no larger.
_MUCH = 0.8

#: [1] A profile is taken for a better one when it saves this share of the arrival.
_WORTH = 1e-4

#: [1] The bound is not raised any more where times nearer than this share would have to be told apart.
_RESOLVED = 2e-4


@dataclass(frozen=True, slots=True, eq=False)
class Closing:
    """What is known in the end.

    Parameters
    ----------
    profile, is_new : the best profile, and whether it is another one than at first.
    bound : certified bound [s] on any arrival.
    is_decided : whether it is proved that no other choice of before and after saves more than the share CLOSED.
    """

    profile: VelocityProfile
    is_new: bool
    bound: float
    is_decided: bool


class _Chase:
    """The best profile and the bound, as they are improved in turn."""

    def __init__(
        self, ego: Ego, meetings: Sequence[Meeting], forbidden: Callable[[int], Sequence[Forbidden]],
        near: Sequence[int], best: VelocityProfile, bound: float, *, most: int, fine: bool,
        failed: Sequence[Mapping[int, bool]] = (),
    ) -> None:  # fmt: skip
        self.ego, self.meetings, self.best, self.bound = ego, meetings, best, bound
        self.forbidden = forbidden
        self.most, self.fine, self.programs = most, fine, 0
        self.near: list[int] = []
        self.failed = list(failed)
        self.parts: list[Part] = []
        self.owners: list[int] = []
        for index in near:
            self.add(index)

    def add(self, index: int) -> None:
        found = parts_of(self.ego, self.forbidden(index))
        self.near.append(index)
        self.parts += found
        self.owners += [index] * len(found)

    @property
    def is_spent(self) -> bool:
        return self.programs >= self.most

    def is_closed(self, share: float) -> bool:
        return self.bound >= self.best.arrival * (1 - share)

    def asked(self, arrival: float, besides: Mapping[int, bool] | None = None, share: float = 1.0) -> Verdict:
        """The verdict on an arrival, with a share of all relaxations; a no about all motions raises the bound."""
        most = min(self.most - self.programs, math.ceil(share * self.most))
        verdict = could_arrive(self.ego, self.parts, arrival, most, besides, fine=self.fine)
        self.programs += max(verdict.programs, 1)
        if verdict.cannot and besides is None:
            self.bound = max(self.bound, arrival)
        return verdict

    def follow(self, verdict: Verdict) -> bool:
        """Seek a better profile along the course of a verdict; whether it is worth asking again.

        It is where a better one was found, and where one ran into a robot that had been left out so far.
        """
        if verdict.course is None:
            return False
        chosen = {index: _passes_after(verdict.course, self.meetings[index].window) for index in self.near}
        chosen |= {self.owners[k]: after for k, after in verdict.sides.items()}
        if any(failed.items() <= chosen.items() for failed in self.failed):  # there is less room yet
            return False
        profile = _along(self.ego, self.meetings, chosen, verdict.course, self.bound, self.best.arrival * (1 - _WORTH))
        if profile is None:
            self.failed.append(chosen)
            return False
        violated = first_violated(list(self.meetings), profile)
        if violated is None:
            self.best = profile
        elif violated[0] in chosen:  # a bound of the tube was missed by rounding
            return False
        else:
            self.add(violated[0])
        return True


def close_gap(
    ego: Ego, meetings: Sequence[Meeting], forbidden: Callable[[int], Sequence[Forbidden]], near: Sequence[int],
    best: VelocityProfile, bound: float, *, most: int, enough: float, decided: bool, is_real: bool,
    failed: Sequence[Mapping[int, bool]] = (),
) -> Closing:  # fmt: skip
    """Raise a certified bound [s] and improve on a profile until they are as good as equal.

    Parameters
    ----------
    forbidden : what is truly forbidden in a meeting, by index.
    near : meetings, by index, that are likely to matter; leaving one out never makes a bound too late.
    most : so many relaxations may be solved.
    enough : gaps below this share of the arrival are left; CLOSED or less asks for a finer relaxation, too.
    decided : whether it is known already that no other choice of before and after is better.
    is_real : whether the profile can be driven, or only stands for one that is sought: then the bound is of no use.
    failed : sides of meetings with which no motion was found.
    """
    fine = enough <= CLOSED or not decided
    chase = _Chase(ego, meetings, forbidden, near, best, bound, most=most, fine=fine, failed=failed)
    while not decided and not chase.is_spent and not chase.is_closed(CLOSED):
        others = _other_sides(chase, _A_QUESTION)
        decided = others.cannot
        if not decided and not chase.follow(others):
            break
    if decided or enough <= CLOSED:
        _from_below(chase, enough)
    if (decided or enough <= CLOSED) and (is_real or chase.best is not best):
        _halving(chase, enough)
    decided = decided or chase.is_closed(CLOSED)
    return Closing(chase.best, chase.best is not best, min(chase.bound, chase.best.arrival), decided)


def _other_sides(chase: _Chase, share: float) -> Verdict:
    """Whether anybody who passes some part on its other side could be earlier."""
    return chase.asked(chase.best.arrival * (1 - CLOSED), sides_of(chase.parts, chase.best), share)


def is_plainly_best(
    ego: Ego, meetings: Sequence[Meeting], forbidden: Callable[[int], Sequence[Forbidden]], near: Sequence[int],
    best: VelocityProfile,
) -> bool:  # fmt: skip
    """Whether a glance shows that no other choice of before and after saves more than the share CLOSED."""
    chase = _Chase(ego, meetings, forbidden, near, best, ego.solo_bound, most=_GLANCE, fine=False)
    return _other_sides(chase, 1.0).cannot


def _from_below(chase: _Chase, enough: float) -> None:
    """Ask for arrivals from the bound up, in steps that grow where nothing comes of it, until the gap is small."""
    step, failures = _SHARE * chase.bound + _STEP, 0
    while failures < _FAILURES and not chase.is_spent and not chase.is_closed(enough):
        arrival = chase.bound + step
        if arrival >= chase.best.arrival * (1 - CLOSED):
            return
        verdict = chase.asked(arrival, share=_A_QUESTION)
        gap = chase.best.arrival - chase.bound
        failed = not verdict.cannot and not chase.follow(verdict)
        failures += failed
        if verdict.cannot or failed or chase.best.arrival - chase.bound > _MUCH * gap:
            step *= _GROWTH


def _halving(chase: _Chase, enough: float) -> None:
    """Raise the bound towards the arrival, halving what is between a time that is proved and one that is not."""
    high = chase.best.arrival
    arrival = high * (1 - CLOSED)
    while not chase.is_spent and not chase.is_closed(enough) and high - chase.bound > _RESOLVED * high:
        if not chase.asked(arrival).cannot:
            high = arrival
        arrival = (chase.bound + high) / 2


def _along(
    ego: Ego, meetings: Sequence[Meeting], sides: Mapping[int, bool], course: Course, least: float, most: float
) -> VelocityProfile | None:
    """The quickest profile about a course that passes some meetings on the given sides; None where none is found."""
    tube = Tube(
        [after_bound(meetings[index].window) for index, after in sides.items() if after],
        [before_bound(meetings[index].window) for index, after in sides.items() if not after],
    )
    profile = through_tube(ego, tube, least, most, None if ego.caps.is_constant else course)
    return profile if profile is not None and profile.arrival <= most else None


def _passes_after(course: Course, window: Window) -> bool:
    """Whether a course is mostly behind the middle of a window."""
    if window.lasts or bool((window.low[:, 0] > window.high[:, 0]).all()):  # the other stays, or never gets there
        return False
    middle = (window.low[:, 0] + window.high[:, 0]) / 2
    return bool(np.median(course.at(window.times[:-1]) - middle) < 0)
