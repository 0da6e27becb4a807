"""From one end of a bend to the next: least times from and to each of many accelerations there."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.timing.clock import clock
from coord.timing.quickest import ramps
from coord.timing.transfer import least_times, rise
from coord.tolerances import SAME_PLACE

#: Cells into which the acceleration at an end of a bend is cut at first, and each of some of them later.
_CELLS, _PARTS = 40, 4

#: [m] Distances of the places between two nodes: next to these, and how they grow, and the largest.
_STEP, _GROWTH, _LARGEST = 4e-3, 1.3, 0.6

#: [m] On shorter ways so many steps of one length do.
_SHORT, _SHORT_PARTS = 0.5, 4

#: So many of the places at most serve the times between nodes.
_MEETINGS = 16

#: [m/s] Slower is as good as standing.
_SLOWEST = 1e-9

#: Pieces with varying curvature are cut into this many: in each the highest cap holds, since a bound must not be tight.
_CUTS = 16


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """An end of a bend, or of the way, and accelerations with which it may be passed.

    Parameters
    ----------
    s : where it is [m].
    top, cap : bounds on the speed there, and in the bend [m/s].
    lasts : so long at least is a robot in the bend [s]; below 0: the bend is behind.
    jerk : the limit [m/s3].
    edges : (n+1,) borders [m/s2] of n cells of accelerations.
    """

    s: float
    top: float
    cap: float
    lasts: float
    jerk: float
    edges: Array

    @property
    def low(self) -> Array:
        """Least accelerations (n,) of the cells."""
        return self.edges[:-1]

    @property
    def high(self) -> Array:
        """Greatest accelerations (n,) of the cells."""
        return self.edges[1:]

    @property
    def speeds(self) -> Array:
        """Bounds (n,) on the speed: who leaves a bend braking was faster in it, who enters it gaining speed will be."""
        toward = np.maximum(self.low if self.lasts > 0 else -self.high, 0.0)
        time = np.minimum(toward / self.jerk, abs(self.lasts))
        return np.asarray(np.clip(self.cap - time * (toward - self.jerk * time / 2), 0.0, self.top))

    def split(self, cells: npt.NDArray[np.bool_]) -> Node:
        """The same with some cells cut into narrower ones."""
        if not self.edges.any():
            return self
        shares = np.arange(1, _PARTS) / _PARTS
        low, high = self.low[cells, None], self.high[cells, None]
        return replace(self, edges=np.unique(np.append(self.edges, low + (high - low) * shares)))


@dataclass(frozen=True, slots=True, eq=False)
class Link:
    """The way from one node to the next.

    Parameters
    ----------
    places : (P,) arc lengths [m] from the one node to the other.
    since : (n, P) least times [s] from the cells of the one; ``until`` : (m, P) to the cells of the other.
    since_lines, until_lines : (n, P-1), (m, P-1) between two places no motion is earlier than on the line from the
        nearer one to this at the farther one.
    times : (n, m) from cell to cell.
    """

    places: Array
    since: Array
    since_lines: Array
    until: Array
    until_lines: Array
    times: Array


class Stretch:
    """What two neighbouring nodes' links have in common, however their cells are cut."""

    def __init__(self, a: Node, b: Node, ends: Array, caps: Array, limits: Limits) -> None:
        self.limits, self.length = limits, b.s - a.s
        self.top = float(caps.max())
        borders = ends[(ends > a.s + SAME_PLACE) & (ends < b.s - SAME_PLACE)]
        self.places = np.unique(np.concatenate([[a.s, b.s], a.s + _graded(self.length), borders]))
        between = (self.places[:-1] + self.places[1:]) / 2
        self.caps = caps[np.minimum(np.searchsorted(ends, between, side="right"), len(caps) - 1)]
        self.peak = float(self.caps.max())
        self._since: dict[tuple[float, float], tuple[Array, Array]] = {}
        self._until: dict[tuple[float, float], tuple[Array, Array]] = {}

    def link(self, a: Node, b: Node) -> Link:
        """The link of the nodes as they are cut now."""
        limits, steps = self.limits, np.diff(self.places)
        ahead = self._rows(self._since, a.speeds, a.high, steps, self.caps, limits.acceleration)
        back = self._rows(self._until, b.speeds, -b.low, steps[::-1], self.caps[::-1], limits.deceleration)
        since, until = ahead.at, back.at[:, ::-1]
        some = np.unique(np.linspace(0, len(self.places) - 1, _MEETINGS).astype(int))
        times = (since[:, None, some] + until[None, :, some]).max(axis=2)
        # from the one acceleration to the other takes time as well
        np.maximum(times, (b.low[None] - a.high[:, None]) / limits.jerk, out=times)
        np.maximum(times, (a.low[:, None] - b.high[None]) / limits.jerk, out=times)
        first = rise(a.speeds, a.low, a.high, limits.acceleration, limits.jerk, self.peak)
        last = rise(b.speeds, -b.high, -b.low, limits.deceleration, limits.jerk, self.peak)
        np.maximum(times, least_times(first, last, self.length, self.peak), out=times)
        return Link(self.places, since, ahead.lines, until, back.lines[:, ::-1], times)

    def _rows(
        self, known: dict[tuple[float, float], tuple[Array, Array]], speeds: Array, accelerations: Array, steps: Array,
        caps: Array, most: float,
    ) -> _Times:  # fmt: skip
        """From speeds and accelerations (n,); those worked out once are kept."""
        states = list(zip(speeds.tolist(), accelerations.tolist(), strict=True))
        missing = np.array([state for state in states if state not in known])
        if len(missing):
            found = _times(missing[:, 0], missing[:, 1], steps, caps, self.top, most, self.limits.jerk)
            known.update(zip(map(tuple, missing.tolist()), zip(found.at, found.lines, strict=True), strict=True))
        rows = [known[state] for state in states]
        return _Times(np.stack([at for at, _ in rows]), np.stack([lines for _, lines in rows]))


def _graded(length: float) -> Array:
    """Places on a way [m], close together at both ends."""
    if length < _SHORT:
        return length * np.arange(1, _SHORT_PARTS) / _SHORT_PARTS
    steps = [_STEP]
    while sum(steps) < length / 2:
        steps.append(min(steps[-1] * _GROWTH, _LARGEST))
    half = np.cumsum(steps[:-1])
    return np.concatenate([half, length - half])


def sections(path: Path, limits: Limits) -> tuple[Array, Array]:
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


def nodes_of(ends: Array, caps: Array, limits: Limits, relaxed: VelocityProfile) -> list[Node]:
    """Start, both ends of every section that is slower than its neighbours, goal."""
    padded = np.concatenate([[np.inf], caps, [np.inf]])
    slow = np.flatnonzero((caps < padded[:-2]) & (caps <= padded[2:]) | (caps <= padded[:-2]) & (caps < padded[2:]))
    nodes = [Node(0.0, 0.0, 0.0, 1.0, limits.jerk, np.zeros(2))]
    borders = np.concatenate([[0.0], ends])
    length = float(ends[-1])
    for m in slow.tolist():
        for k in (m, m + 1):
            s = float(borders[k])
            if not nodes[-1].s + SAME_PLACE < s < length - SAME_PLACE:
                continue
            at = float(clock(relaxed, np.array([s]))[0])
            reachable = float(relaxed.state([at])[0, 1]) * (1 + 1e-9) + 1e-6
            top, cap = min(float(min(caps[k - 1], caps[k])), reachable), float(caps[m])
            lasts = float(borders[m + 1] - borders[m]) / cap
            nodes.append(Node(s, top, cap, lasts if k == m else -lasts, limits.jerk, _accelerations(top, limits)))
    nodes.append(Node(length, 0.0, 0.0, 1.0, limits.jerk, np.zeros(2)))
    return nodes


def _accelerations(speed: float, limits: Limits) -> Array:
    """Borders of cells of accelerations: all with which a robot passes that neither stops there nor just started."""
    most = math.sqrt(2 * limits.jerk * speed)
    return np.linspace(-min(limits.deceleration, most), min(limits.acceleration, most), _CELLS + 1)


@dataclass(frozen=True, slots=True, eq=False)
class _Times:
    """Least times (n, P) [s] from n accelerations to P places, and (n, P-1) what lines from one place have at the next.

    In between no motion is earlier than the line.
    """

    at: Array
    lines: Array


def _times(
    speeds: Array, accelerations: Array, steps: Array, caps: Array, top: float, most: float, jerk: float
) -> _Times:
    """To the places after the steps (P-1,) [m], from a speed [m/s] and accelerations (n,) [m/s2]."""
    quickest = ramps(speeds, accelerations, top, most, jerk)
    n = len(accelerations)
    if bool(np.all(caps >= top)):
        at = quickest.time(np.repeat(np.append(0.0, np.cumsum(steps))[None], n, axis=0))
    else:
        at = np.zeros((n, len(steps) + 1))
        for p, (step, cap) in enumerate(zip(steps.tolist(), caps.tolist(), strict=True)):
            now = at[:, p : p + 1]
            ramped = quickest.time(quickest.way(now) + step)
            at[:, p + 1] = np.maximum(now + step / cap, ramped)[:, 0]
    # who gains speed is nowhere before the straight line; who loses some no faster than at one of both ends
    fast = quickest.speed(at)
    slower = at[:, :-1] + steps / np.maximum(np.maximum(fast[:, :-1], fast[:, 1:]), _SLOWEST)
    return _Times(at, np.where(at[:, :-1] < quickest.dips[:, None], np.minimum(slower, at[:, 1:]), at[:, 1:]))
