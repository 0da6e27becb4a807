"""The outer program: can any motion at all arrive by some time? A search whose no is a proof.

Every motion passes each place that is taken for a while on one side of it, and is at one time on one side of each
bend. With some of that settled, the ranges of ``coord.timing.reach`` and a linear relaxation bound how far a motion
can get. Where they leave it too short of the goal, there is no such motion. Else the relaxation's own solution
shows what to settle next: a place that it runs through, or a bend that it takes too fast.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.solvers.relaxation import Stages, farthest_bound
from coord.timing.clock import clock
from coord.timing.ego import Ego
from coord.timing.grid import Course
from coord.timing.reach import Cut, Marks, Part, Reach, ranges, reach_by, settled

#: [s] About the duration of the cells of the relaxation; and how many there are at least and at most.
_CELL, _FEWEST, _MOST = 0.3, 48, 160

#: Nor are there ever more cells than these.
MOST_CELLS = 512

#: [m] Less than this inside a place that is taken, and [m/s] faster than a bend allows: nothing is left to settle.
_DEEP, _FAST = 2e-3, 5e-3

#: Knots added in one search where bounds are missed between knots.
_FURTHER = 60

#: [s] Where nothing seems left to settle, knots so much before and after each bend tell whether that is so.
_ABOUT_A_BEND = tuple(round(0.08 * k, 2) for k in range(-6, 7))

#: [s] Knots are no nearer to each other.
_APART = 5e-3

#: [m, m/s, s] What holds for every motion is loosened by this, for rounding.
_MARGIN = 1e-6

#: [m] A motion that falls short of its goal by less than this may be there: rounding.
_SHORT = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """Whether a motion can arrive by a time.

    Parameters
    ----------
    cannot : it is proved that none can.
    course, sides : else what a motion might be like that does: its course, and the sides on which it passes parts.
    programs : relaxations solved.
    """

    cannot: bool
    course: Course | None
    sides: Mapping[int, bool]
    programs: int


def could_arrive(
    ego: Ego, parts: Sequence[Part], arrival: float, most: int, besides: Mapping[int, bool] | None = None, *,
    fine: bool = False,
) -> Verdict:  # fmt: skip
    """Whether any motion past the parts can be at the goal, at rest, by an arrival [s].

    Parameters
    ----------
    most : so many relaxations are solved at most; if no answer is found with them, the verdict is open.
    besides : a side for each part: asked is only for motions that pass some part on its other side.
    fine : where nothing seems left to settle, look again with shorter cells about the bends.
    """
    reach = reach_by(ego, parts, arrival)
    stack: list[tuple[dict[int, bool], tuple[Cut, ...]]] = [({}, ())]
    if besides is not None:
        same = list(besides.items())
        stack = [(dict(same[:k]) | {same[k][0]: not same[k][1]}, ()) for k in range(len(same))]
    programs = 0
    further: list[float] = []
    is_fine = not fine or ego.bends is None
    course: Course | None = None
    sides: dict[int, bool] = {}
    while stack:
        if programs >= most:
            return Verdict(False, course, sides, programs)
        chosen, cuts = stack.pop()
        left = settled(reach, chosen, cuts)
        if left is None:
            continue
        now, bounds = left
        stages, times = _stages(reach, bounds, [*further, *(time for time, _, _ in cuts)])
        if stages is None:
            continue
        programs += 1
        farthest, states = farthest_bound(stages, ego.robot.limits)
        if farthest < ego.length - _SHORT:
            continue
        motion = _Motion(times, states)
        course, sides = motion.course, now
        missed = _bound_missed(motion, parts, now)
        choices = _place_run_through(motion, parts, now)
        if choices is None and missed is not None and len(further) < _FURTHER:
            further.append(missed)
            choices = (({}, ()),)
        choices = choices or _bend_taken_too_fast(ego, motion)
        if choices is None and not is_fine:
            further += _about_bends(ego, motion)
            is_fine, choices = True, (({}, ()),)
        if choices is None:
            return Verdict(False, course, sides, programs)
        stack += [(now | side, cuts + cut) for side, cut in reversed(choices)]
    return Verdict(True, None, {}, programs)


def sides_of(parts: Sequence[Part], profile: VelocityProfile) -> dict[int, bool]:
    """On which side of each part a profile passes; after: True."""
    found = {}
    for k, one in enumerate(parts):
        s = profile.places(one.times)
        found[k] = bool((s - one.low).max() < (one.high - s).max())
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _Motion:
    """The relaxation's solution between its knots, as cubics through place and speed at the knots."""

    knots: Array
    states: Array

    @property
    def course(self) -> Course:
        """Where it is when."""
        times = np.unique(np.concatenate([np.linspace(a, b, 9) for a, b in itertools.pairwise(self.knots.tolist())]))
        return Course(times, np.maximum.accumulate(self.at(times)[0]))

    def at(self, times: Array) -> tuple[Array, Array]:
        """Places and speeds (m,) at the times (m,)."""
        k = np.clip(np.searchsorted(self.knots, times, side="right") - 1, 0, len(self.knots) - 2)
        h = np.diff(self.knots)[k]
        u = (times - self.knots[k]) / h
        (s0, v0, _), (s1, v1, _) = self.states[k].T, self.states[k + 1].T
        rise, m0, m1 = s1 - s0, v0 * h, v1 * h
        s = s0 + u * (m0 + u * (3 * rise - 2 * m0 - m1 + u * (m0 + m1 - 2 * rise)))
        v = (m0 + u * (2 * (3 * rise - 2 * m0 - m1) + u * 3 * (m0 + m1 - 2 * rise))) / h
        return s, v


_Choices = tuple[tuple[dict[int, bool], tuple[Cut, ...]], ...]


def _place_run_through(motion: _Motion, parts: Sequence[Part], sides: Mapping[int, bool]) -> _Choices | None:
    """Both sides of the part that a motion runs through most deeply; None where it runs through none."""
    worst, deepest, nearer = None, _DEEP, True
    for k, one in enumerate(parts):
        if k in sides:
            continue
        s, _ = motion.at(np.minimum(one.times, motion.knots[-1]))
        to_low, to_high = s - one.low, one.high - s
        depth = float(np.minimum(to_low, to_high).max(initial=-np.inf))
        if depth > deepest:
            worst, deepest, nearer = k, depth, bool(to_low.max() < to_high.max())
    return None if worst is None else (({worst: nearer}, ()), ({worst: not nearer}, ()))


def _bound_missed(motion: _Motion, parts: Sequence[Part], sides: Mapping[int, bool]) -> float | None:
    """The time [s] at which a motion, between its knots, most misses a bound that is settled; None if it keeps all."""
    worst, deepest = None, _DEEP
    for k, passes_after in sides.items():
        one = parts[k]
        within = (one.times > motion.knots[0]) & (one.times < motion.knots[-1])
        s, _ = motion.at(one.times[within])
        miss = s - one.low[within] if passes_after else one.high[within] - s
        if len(miss) and miss.max() > deepest:
            worst, deepest = float(one.times[within][int(np.argmax(miss))]), float(miss.max())
    if worst is None or np.abs(motion.knots - worst).min() < _APART:
        return None
    return worst


def _bend_taken_too_fast(ego: Ego, motion: _Motion) -> _Choices | None:
    """Before or behind the place that a motion passes with most too much speed, at that time; None if it is not so."""
    course = motion.course
    places = np.unique(np.concatenate([ego.relaxed.states[:, 0], motion.states[:, 0]]))
    places = places[(places > 0) & (places < min(ego.length, float(course.s[-1])))]
    if ego.bends is None or not len(places):
        return None
    times = course.passes(places)
    clocks = clock(ego.relaxed, places)
    over = motion.at(times)[1] - ego.relaxed.state(clocks)[:, 1]
    k = int(np.argmax(over))
    if over[k] <= _FAST:
        return None
    return tuple(({}, ((float(times[k]), float(clocks[k]), up),)) for up in (True, False))


def _about_bends(ego: Ego, motion: _Motion) -> list[float]:
    """Further knots [s] where a motion passes the places at which the largest speed is least."""
    v = ego.relaxed.states[:, 1]
    slow = np.flatnonzero((v[1:-1] <= v[:-2]) & (v[1:-1] <= v[2:])) + 1
    times = motion.course.passes(ego.relaxed.states[slow, 0])
    return [time + offset for time in times.tolist() for offset in _ABOUT_A_BEND]


def _stages(reach: Reach, bounds: Marks, further: Sequence[float]) -> tuple[Stages | None, Array]:
    """The relaxation's grid, with knots at further times [s], and its bounds; no stages where a range is empty."""
    ego = reach.ego
    times = _knots(ego.alone.departure, reach.arrival, further)
    low, high = ranges(reach, bounds, times)
    if np.any(low > high + _MARGIN):
        return None, times
    low = np.minimum(low, high)
    relaxed = ego.relaxed
    at_low, at_high = relaxed.state(low), relaxed.state(high)
    speed = _fastest(ego, low, high)
    slope, offset = _speed_over_place(ego, low, high, at_low, at_high)
    stages = Stages(
        np.diff(times), at_low[:, 0] - _MARGIN, at_high[:, 0] + _MARGIN, speed + _MARGIN,
        _fastest(ego, low[:-1], high[1:]) + _MARGIN, slope, offset + _MARGIN,
    )  # fmt: skip
    return stages, times


def _knots(departure: float, arrival: float, further: Sequence[float]) -> Array:
    """Knots at about even distances and at further times [s]."""
    count = int(np.clip(np.ceil((arrival - departure) / _CELL), _FEWEST, _MOST))
    given = np.unique(np.clip(np.array([departure, arrival, *further]), departure, arrival))
    given = given[np.append(True, np.diff(given) > _APART)]
    if len(given) > MOST_CELLS + 1:  # bends beyond number: fewer knots only loosen the bounds
        given = given[np.linspace(0, len(given) - 1, MOST_CELLS + 1).astype(int)]
    given[-1] = arrival
    knots = given.tolist()
    size = max(count, len(knots) - 1)
    parts = np.maximum(1, np.floor(np.diff(given) / (arrival - departure) * size)).astype(int)
    while parts.sum() > size:
        parts[int(np.argmax(parts))] -= 1
    while parts.sum() < size:
        parts[int(np.argmax(np.diff(given) / parts))] += 1
    spans = zip(knots[:-1], knots[1:], parts.tolist(), strict=True)
    pieces = [np.linspace(a, b, n, endpoint=False) for a, b, n in spans]
    return np.append(np.concatenate(pieces), arrival)


def _fastest(ego: Ego, low: Array, high: Array) -> Array:
    """The largest speed (m,) [m/s] of any motion at places between two clocks (m,) [s]."""
    relaxed = ego.relaxed
    top = np.maximum(relaxed.state(low)[:, 1], relaxed.state(high)[:, 1])
    inside = (relaxed.times >= low[:, None]) & (relaxed.times <= high[:, None])
    return np.asarray(np.maximum(top, np.where(inside, relaxed.states[:, 1], 0.0).max(axis=1)))


def _speed_over_place(ego: Ego, low: Array, high: Array, at_low: Array, at_high: Array) -> tuple[Array, Array]:
    """Lines v <= slope s + offset (m,), (m,) above the largest speed of any motion at all places between two clocks.

    The slope is that between the ends of the range. Where the quickest motion's acceleration is a, speed over place
    has the slope a / v, so the line touches it where v = a / slope, at a knot or at an end of the range.
    """
    relaxed = ego.relaxed
    width = at_high[:, 0] - at_low[:, 0]
    slope = np.divide(at_high[:, 1] - at_low[:, 1], width, out=np.zeros_like(width), where=width > 1e-6)
    offset = np.maximum(at_low[:, 1] - slope * at_low[:, 0], at_high[:, 1] - slope * at_high[:, 0])
    s, v, a = relaxed.states.T
    inside = (relaxed.times >= low[:, None]) & (relaxed.times <= high[:, None])
    offset = np.maximum(offset, np.where(inside, v - slope[:, None] * s, -np.inf).max(axis=1))
    with np.errstate(divide="ignore", invalid="ignore"):
        touching = relaxed.times[:-1] + (a[:-1] / slope[:, None] - v[:-1]) / a[:-1]
    begin, end = np.maximum(relaxed.times[:-1], low[:, None]), np.minimum(relaxed.times[1:], high[:, None])
    touches = np.isfinite(touching) & (touching > begin) & (touching < end)
    h = np.where(touches, touching - relaxed.times[:-1], 0.0)
    values = v[:-1] + h * a[:-1] - slope[:, None] * (s[:-1] + h * (v[:-1] + h * a[:-1] / 2))
    return slope, np.maximum(offset, np.where(touches, values, -np.inf).max(axis=1, initial=-np.inf))
