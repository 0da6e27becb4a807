"""How early a robot can be anywhere on a path with bends, and how long it still needs: bounds that no motion beats.

A bend caps the speed, so at its ends every motion is at most that quick; what is left open there is the
acceleration. It is cut into narrow cells. From the upper end of a cell the robot is given the greatest speed that
any motion can have from then on, up to the next such place; before the lower end of a cell, the greatest that any
motion can have had. Up to any place between two such places the one holds, from there on the other. The least sum
over all chains of cells is a bound, because every motion goes through one of these chains.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coord.model.arrays import Array, frozen
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.timing.clock import clock
from coord.timing.quickest import ramps
from coord.tolerances import SAME_PLACE

#: Cells into which the acceleration at an end of a bend is cut.
_CELLS = 48

#: [m] Distance of the places between two nodes at which the way so far and the rest are told apart, and their number.
_STEP, _MOST_PLACES = 0.1, 100

#: Pieces with varying curvature are cut into this many: in each the highest cap holds, since a bound must not be tight.
_CUTS = 16

#: [s] Taken off every bound: rounding, which is largest near a stop, stays far below it.
_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Passages:
    """What bends cost every motion from rest to rest, beyond what they cost with the jerk forgotten.

    Parameters
    ----------
    places : (P,) arc lengths [m], increasing, from 0 to the length.
    late, long : (P,) times [s], not negative: how much later than the motion without jerk the robot is anywhere
        from that place on, and how much longer it needs from anywhere up to that place.
    total : least time [s] for the whole way.
    marks : (Q,) some of the places; ``between`` : (Q, Q) how much longer [s] than the motion without jerk every motion
        needs from one of them to another, however it moves at both.
    """

    places: Array
    late: Array
    long: Array
    total: float
    marks: Array
    between: Array

    def later(self, s: Array) -> Array:
        """How much later (m,) [s] than the motion without jerk every motion is at the arc lengths s (m,) [m]."""
        k = np.clip(np.searchsorted(self.places, s, side="right") - 1, 0, len(self.places) - 1)
        return np.asarray(self.late[k])

    def longer(self, s: Array) -> Array:
        """How much longer (m,) [s] than the motion without jerk every motion needs from the arc lengths s (m,) [m]."""
        k = np.clip(np.searchsorted(self.places, s, side="left"), 0, len(self.places) - 1)
        return np.asarray(self.long[k])


@dataclass(frozen=True, slots=True, eq=False)
class _Node:
    """A place with an upper bound on the speed there; the accelerations (n,) at the ends of cells."""

    s: float
    speed: float
    low: Array
    high: Array


@dataclass(frozen=True, slots=True, eq=False)
class _Link:
    """Two nodes, places (P,) from the one to the other, and the least times from each cell and to each cell."""

    places: Array
    since: Array
    until: Array
    times: Array


def passages(path: Path, limits: Limits, relaxed: VelocityProfile) -> Passages | None:
    """The bounds of a path on which the speed cap varies; None where it is the same everywhere.

    Parameters
    ----------
    relaxed : the motion with the jerk forgotten, ``coord.alone.relaxed.without_jerk``.
    """
    ends, caps = _sections(path, limits)
    if len(caps) < 2:
        return None
    nodes = _nodes(ends, caps, limits, relaxed)
    links = [_link(a, b, ends, caps, limits) for a, b in itertools.pairwise(nodes)]
    reached, needed = [np.zeros(1)], [np.zeros(1)]
    for link in links:
        reached.append((reached[-1][:, None] + link.times).min(axis=0))
    for link in reversed(links):
        needed.append((link.times + needed[-1][None]).min(axis=1))
    needed.reverse()
    places = np.concatenate([link.places for link in links])
    early = np.concatenate([(e[:, None] + link.since).min(axis=0) for e, link in zip(reached, links, strict=False)])
    still = np.concatenate([(g[:, None] + link.until).min(axis=0) for g, link in zip(needed[1:], links, strict=True)])
    alone = clock(relaxed, places)
    late = np.maximum.accumulate(early - alone)
    long = np.maximum.accumulate((still - (relaxed.arrival - alone))[::-1])[::-1]
    total = max(float(reached[-1][0]), relaxed.arrival)
    return Passages(
        frozen(places), frozen(np.maximum(late - _ROUNDING, 0.0)), frozen(np.maximum(long - _ROUNDING, 0.0)),
        total - _ROUNDING, *_between(links, relaxed),
    )  # fmt: skip


def _between(links: Sequence[_Link], relaxed: VelocityProfile) -> tuple[Array, Array]:
    """Some places, close together next to nodes, and the least extra time from each to each behind a node."""
    picked = [_graded(len(link.places)) for link in links]
    first = np.cumsum([0, *(len(some) for some in picked)])
    marks = np.concatenate([link.places[some] for link, some in zip(links, picked, strict=True)])
    alone = clock(relaxed, marks)
    extra = np.zeros((len(marks), len(marks)))
    for m, link in enumerate(links):
        rows = slice(first[m], first[m + 1])
        needed = link.until[:, picked[m]].T  # from each place to each cell of the node behind the link
        for k in range(m + 1, len(links)):
            columns = slice(first[k], first[k + 1])
            since = links[k].since[:, picked[k]]
            least = (needed[:, :, None] + since[None]).min(axis=1)
            extra[rows, columns] = least - (alone[None, columns] - alone[rows, None])
            needed = (needed[:, :, None] + links[k].times[None]).min(axis=1)
    # what is needed on a part of the way is needed on the whole
    extra = np.maximum.accumulate(np.maximum.accumulate(extra[::-1], axis=0)[::-1], axis=1)
    return frozen(marks), np.maximum(extra - _ROUNDING, 0.0)


def _graded(count: int) -> list[int]:
    """Indices below a count, close together at both ends."""
    steps = [0, *(2**k for k in range(count.bit_length()) if 2**k < count)]
    return sorted({*steps, *(count - 1 - step for step in steps)})


def _sections(path: Path, limits: Limits) -> tuple[Array, Array]:
    """Ends [m] and highest caps [m/s] of sections; neighbours with the same cap are one."""
    ends: list[float] = []
    caps: list[float] = []
    at = 0.0
    for length, k0, k1 in path.pieces.tolist():
        count = 1 if k0 == k1 else _CUTS
        for a, b in itertools.pairwise(np.linspace(k0, k1, count + 1).tolist()):
            least = 0.0 if a * b <= 0 else min(abs(a), abs(b))
            cap = min(limits.speed, math.sqrt(limits.lateral_acceleration / max(least, 1e-300)))
            at += length / count
            if caps and caps[-1] == cap:
                ends[-1] = at
            else:
                ends.append(at)
                caps.append(cap)
    if ends:
        ends[-1] = path.length
    return np.array(ends), np.array(caps)


def _nodes(ends: Array, caps: Array, limits: Limits, relaxed: VelocityProfile) -> list[_Node]:
    """Start, both ends of every section that is slower than its neighbours, goal."""
    padded = np.concatenate([[np.inf], caps, [np.inf]])
    slow = np.flatnonzero((caps < padded[:-2]) & (caps <= padded[2:]) | (caps <= padded[:-2]) & (caps < padded[2:]))
    rest = np.zeros(1)
    nodes = [_Node(0.0, 0.0, rest, rest)]
    borders = np.concatenate([[0.0], ends])
    length = float(ends[-1])
    for m in slow.tolist():
        for k in (m, m + 1):
            s = float(borders[k])
            if not nodes[-1].s + SAME_PLACE < s < length - SAME_PLACE:
                continue
            at = float(clock(relaxed, np.array([s]))[0])
            reachable = float(relaxed.state([at])[0, 1]) * (1 + 1e-9) + 1e-6
            speed = min(float(min(caps[k - 1], caps[k])), reachable)
            nodes.append(_node(s, speed, limits))
    nodes.append(_Node(length, 0.0, rest, rest))
    return nodes


def _node(s: float, speed: float, limits: Limits) -> _Node:
    """Cells of all accelerations with which a robot can pass that neither stops at once nor has just started."""
    most = math.sqrt(2 * limits.jerk * speed)
    edges = np.linspace(-min(limits.deceleration, most), min(limits.acceleration, most), _CELLS + 1)
    return _Node(s, speed, edges[:-1], edges[1:])


def _link(a: _Node, b: _Node, ends: Array, caps: Array, limits: Limits) -> _Link:
    length = b.s - a.s
    count = int(min(max(math.ceil(length / _STEP), 1), _MOST_PLACES))
    borders = ends[(ends > a.s + SAME_PLACE) & (ends < b.s - SAME_PLACE)]
    places = np.unique(np.concatenate([np.linspace(a.s, b.s, count + 1), borders]))
    cap = caps[np.minimum(np.searchsorted(ends, (places[:-1] + places[1:]) / 2, side="right"), len(caps) - 1)]
    top = float(caps.max())
    since = _times(a.speed, a.high, np.diff(places), cap, limits.acceleration, limits.jerk, top)
    until = _times(b.speed, -b.low, np.diff(places)[::-1], cap[::-1], limits.deceleration, limits.jerk, top)[:, ::-1]
    times = (since[:, None, :] + until[None]).max(axis=2)
    # from the one acceleration to the other takes time as well
    np.maximum(times, (b.low[None] - a.high[:, None]) / limits.jerk, out=times)
    np.maximum(times, (a.low[:, None] - b.high[None]) / limits.jerk, out=times)
    return _Link(places, since, until, times)


def _times(
    speed: float, accelerations: Array, steps: Array, caps: Array, most: float, jerk: float, top: float
) -> Array:
    """Least times (n, P) at which the places after the steps (P-1,) are reached from a speed and accelerations (n,)."""
    quickest = ramps(speed, accelerations, top, most, jerk)
    n = len(accelerations)
    if bool(np.all(caps >= top)):
        return quickest.time(np.repeat(np.append(0.0, np.cumsum(steps))[None], n, axis=0))
    times = np.zeros((n, len(steps) + 1))
    for p, (step, cap) in enumerate(zip(steps.tolist(), caps.tolist(), strict=True)):
        now = times[:, p : p + 1]
        ramped = quickest.time(quickest.way(now) + step)
        times[:, p + 1] = np.maximum(now + step / cap, ramped)[:, 0]
    return times
