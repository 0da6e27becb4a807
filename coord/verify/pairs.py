"""All pairs of robots, at all times from 0 on: the clearance is kept, and how close the closest two come."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from coord.verify.approach import approach, resting
from coord.verify.broad import Grid, candidates, grown, runs, sizes, slabs
from coord.verify.curve import Pose
from coord.verify.motion import pose, time_at, travelled
from coord.verify.report import Clearance, Findings, at, who
from coord.verify.separation import Mover, meeting
from coord.verify.shapes import translated, turned
from coord.verify.tolerances import BOX, DISTANCE, FINDINGS, RESOLUTION, TIME

#: Pairs that come near each other; with more of them something is so wrong that the rest does not matter.
_PAIRS = 3_000_000


@dataclass(frozen=True, slots=True)
class _Rest:
    """A robot at rest from t0 to t1 [s], maybe for ever."""

    robot: int
    pose: Pose
    t0: float
    t1: float


@dataclass(slots=True)
class _Search:
    """What is known so far: the closest approach of all, and that of each pair that comes too close."""

    need: float
    best: float = math.inf
    closest: tuple[int, int, float] | None = None
    near: dict[tuple[int, int], tuple[float, float]] = field(default_factory=dict)
    open: dict[tuple[int, int], float] = field(default_factory=dict)
    crowded: bool = False

    @property
    def full(self) -> bool:
        """Whether enough pairs failed; of the others it is only of interest whether they come closer still."""
        return len(self.near) + len(self.open) >= FINDINGS

    def goal(self, i: int, j: int) -> tuple[float, float]:
        """What to prove of a pair and below what to look for less [m], see ``descend``."""
        need = -DISTANCE if self.full else self.need
        known = self.near.get((min(i, j), max(i, j)))
        return need, max(self.best, need) if known is None else known[0]

    def note(self, i: int, j: int, value: float, time: float) -> None:
        """Keep the distance of two robots at a time, if it is the least of all or too small."""
        pair = (i, j) if i < j else (j, i)
        if value < self.best:
            self.best, self.closest = value, (*pair, time)
        known = self.near.get(pair, (math.inf,))[0]
        if value < min(self.need, known) and (pair in self.near or not self.full):
            self.near[pair] = (value, time)


def check_pairs(
    names: Sequence[str], movers: Sequence[Mover], clearance: float, leave: bool, findings: Findings
) -> Clearance | None:
    """Check that every two robots keep the clearance [m] at all times, and find the least distance.

    Robots rest at their starts until they depart and, unless they leave, at their goals for ever after.
    """
    search = _Search(clearance - DISTANCE)
    rests = _rests(movers, leave)
    _seed(movers, rests, search)
    # a little farther out than asked for, since that is where the closest pair mostly is
    reach = clearance + 0.2 * math.fsum(mover.body.reach for mover in movers) / len(movers)
    _search_all(movers, rests, reach, search)
    _report(names, movers, clearance, search, findings)
    if search.best > reach + RESOLUTION and len(movers) > 1:
        # everybody is farther apart than that: look again as far out as the closest pair seen
        search.need = -DISTANCE
        _sample(movers, rests, leave, search)
        _search_all(movers, rests, search.best, search)
    if search.closest is None:
        return None
    i, j, time = search.closest
    return Clearance(max(search.best, 0.0), (names[i], names[j]), time)


def _rests(movers: Sequence[Mover], leave: bool) -> list[_Rest]:
    rests = []
    for k, mover in enumerate(movers):
        motion = mover.motion
        if not motion.stretches:
            rests.append(_Rest(k, motion.path.start, 0.0, motion.arrival if leave else math.inf))
            continue
        if motion.departure > 0.0:
            rests.append(_Rest(k, motion.path.start, 0.0, motion.departure))
        if not leave:
            rests.append(_Rest(k, motion.path.goal, motion.arrival, math.inf))
    return rests


def _seed(movers: Sequence[Mover], rests: Sequence[_Rest], search: _Search) -> None:
    """Start with the closest pair at t = 0, and at the end if robots stay: a bound that cuts most of the work."""
    _closest([_Rest(k, mover.motion.path.start, 0.0, 0.0) for k, mover in enumerate(movers)], movers, search)
    _closest([rest for rest in rests if rest.t1 == math.inf], movers, search)


def _sample(movers: Sequence[Mover], rests: Sequence[_Rest], leave: bool, search: _Search) -> None:
    """The closest pairs at a few times in between."""
    last = max(mover.motion.arrival for mover in movers)
    for t in (last * k / 12 for k in range(1, 12)):
        there = [k for k, mover in enumerate(movers) if not leave or mover.motion.arrival >= t]
        _closest([_Rest(k, pose(movers[k].motion, t), t, t) for k in there], movers, search)


def _closest(places: list[_Rest], movers: Sequence[Mover], search: _Search) -> None:
    """Note the closest of some robots that are there at one time, sweeping from left to right."""
    places = sorted(places, key=lambda rest: rest.pose[0])
    widest = max((mover.body.reach for mover in movers), default=0.0)
    time = max((rest.t0 for rest in places), default=0.0)
    for k, one in enumerate(places):
        for n in range(k - 1, -1, -1):
            other = places[n]
            aside = one.pose[0] - other.pose[0] - movers[one.robot].body.reach
            if aside - widest >= search.best:
                break
            if abs(one.pose[1] - other.pose[1]) - movers[one.robot].body.reach - widest < search.best:
                search.note(one.robot, other.robot, _at_rest(movers, one, other), time)


def _at_rest(movers: Sequence[Mover], one: _Rest, other: _Rest) -> float:
    body = movers[other.robot].body
    still = translated(turned(body, other.pose[2]), other.pose[:2])
    return resting(movers[one.robot].body, one.pose, still, body.radius)


def _search_all(movers: Sequence[Mover], rests: Sequence[_Rest], reach: float, search: _Search) -> None:
    """Look at every two robots whenever they may be nearer to each other than the reach [m]."""
    margins = [mover.body.reach + reach / 2 + BOX for mover in movers]
    still = [grown((k, *rest.pose[:2], *rest.pose[:2]), margins[rest.robot]) for k, rest in enumerate(rests)]
    moving = [(k, mover.motion) for k, mover in enumerate(movers) if mover.motion.stretches]
    slab, size = sizes(margins, [motion for _, motion in moving])
    grid = Grid(size)
    for box in still:
        for other in grid.near(box):
            _both_rest(movers, rests[other[0]], rests[box[0]], search)
        grid.add(box)
        if search.best <= 0.0 and search.full:
            return
    found = candidates(slabs(moving, slab), margins, still, size, _PAIRS)
    search.crowded |= found.crowded
    for (i, k), when in found.passings.items():
        if rests[k].t0 <= (when[-1] + 1) * slab + TIME and when[0] * slab - TIME <= rests[k].t1:
            _one_moves(movers, i, rests[k], search)
    for (i, j), when in found.meetings.items():
        for first, last in runs(when):
            _both_move(movers, i, j, (first * slab - TIME, (last + 1) * slab + TIME), search)


def _both_rest(movers: Sequence[Mover], one: _Rest, other: _Rest, search: _Search) -> None:
    time = max(one.t0, other.t0)
    if time <= min(one.t1, other.t1) and one.robot != other.robot:
        search.note(one.robot, other.robot, _at_rest(movers, one, other), time)


def _one_moves(movers: Sequence[Mover], i: int, rest: _Rest, search: _Search) -> None:
    mover, body = movers[i], movers[rest.robot].body
    t0, t1 = max(mover.motion.departure, rest.t0), min(mover.motion.arrival, rest.t1)
    if t0 > t1 or i == rest.robot:
        return
    span = travelled(mover.motion, t0), travelled(mover.motion, t1)
    still = translated(turned(body, rest.pose[2]), rest.pose[:2])
    least = approach(mover.motion.path, mover.body, span, still, body.radius, search.goal(i, rest.robot))
    if least.at is not None:
        search.note(i, rest.robot, least.value, time_at(mover.motion, least.at, t0))
    if least.open is not None:
        search.open.setdefault((i, rest.robot), time_at(mover.motion, least.open, t0))


def _both_move(movers: Sequence[Mover], i: int, j: int, window: tuple[float, float], search: _Search) -> None:
    one, two = movers[i], movers[j]
    t0 = max(window[0], one.motion.departure, two.motion.departure)
    t1 = min(window[1], one.motion.arrival, two.motion.arrival)
    if t0 >= t1:
        return
    least = meeting(one, two, t0, t1, *search.goal(i, j))
    if least.at is not None:
        search.note(i, j, least.value, least.at)
    if least.open is not None:
        search.open.setdefault((i, j), least.open)


def _report(
    names: Sequence[str], movers: Sequence[Mover], clearance: float, search: _Search, findings: Findings
) -> None:
    for (i, j), (value, time) in sorted(search.near.items(), key=lambda item: item[1][1]):
        text = f"overlap by {-value:.6g} m" if value < 0.0 else f"come within {value:.9g} m of each other"
        where, place = _where(movers, i, j, time)
        text = f"robots {who(names[i])} and {who(names[j])} {text} {where}; the clearance is {clearance:g} m"
        findings.add("collision", text, [names[i], names[j]], place, time)
    if search.crowded:
        findings.add("undecided", f"more than {_PAIRS} pairs of robots come near each other; not all were looked at")
    for (i, j), time in sorted(search.open.items(), key=lambda item: item[1]):
        where, place = _where(movers, i, j, time)
        text = f"whether robots {who(names[i])} and {who(names[j])} keep the clearance could not be decided {where}"
        findings.add("undecided", text, [names[i], names[j]], place, time)


def _where(movers: Sequence[Mover], i: int, j: int, time: float) -> tuple[str, tuple[float, float]]:
    p, q = pose(movers[i].motion, time), pose(movers[j].motion, time)
    place = ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
    return f"at t = {time:.9g} s near {at(place)}", place
