"""From one end of a bend to the next: least times from and to each of many accelerations there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.timing.clock import clock
from coord.timing.quickest import Ramps, Rows, ramps
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


@dataclass(frozen=True, slots=True, eq=False)
class _Side:
    """A way that begins at a node, with the least times from states there that are known.

    Parameters
    ----------
    steps, caps : (P,) [m], [m/s] of its parts; ``top`` : the highest cap of the whole path.
    most : limit [m/s2] of the acceleration.
    known : for speeds and accelerations the times to its places, and what lines in between have.
    """

    steps: Array
    caps: Array
    top: float
    most: float
    known: dict[tuple[float, float], tuple[Array, Array]] = field(default_factory=dict)

    def rows(self, speeds: Array, accelerations: Array) -> tuple[Array, Array]:
        """Of states that are known: times (n, P+1) [s], and (n, P) what the lines have at the parts' ends."""
        rows = [self.known[state] for state in zip(speeds.tolist(), accelerations.tolist(), strict=True)]
        return np.stack([at for at, _ in rows]), np.stack([lines for _, lines in rows])

    @property
    def is_free(self) -> bool:
        """Whether no cap holds anybody up."""
        return bool(np.all(self.caps >= self.top))


class Stretch:
    """What two neighbouring nodes' links have in common, however their cells are cut."""

    def __init__(self, a: Node, b: Node, ends: Array, caps: Array, limits: Limits) -> None:
        self.limits, self.length = limits, b.s - a.s
        borders = ends[(ends > a.s + SAME_PLACE) & (ends < b.s - SAME_PLACE)]
        self.places = np.unique(np.concatenate([[a.s, b.s], a.s + _graded(self.length), borders]))
        between = (self.places[:-1] + self.places[1:]) / 2
        own = caps[np.minimum(np.searchsorted(ends, between, side="right"), len(caps) - 1)]
        self.peak, top, steps = float(own.max()), float(caps.max()), np.diff(self.places)
        self.ahead = _Side(steps, own, top, limits.acceleration)
        self.back = _Side(steps[::-1], own[::-1], top, limits.deceleration)

    def link(self, a: Node, b: Node, least: Array) -> Link:
        """The link of the nodes as they are cut now; ``least`` : (n, m) times from cell to cell for another reason."""
        since, ahead_lines = self.ahead.rows(a.speeds, a.high)
        until, back_lines = self.back.rows(b.speeds, -b.low)
        until, back_lines = until[:, ::-1], back_lines[:, ::-1]
        times = least.copy()
        for k in np.unique(np.linspace(0, len(self.places) - 1, _MEETINGS).astype(int)):
            np.maximum(times, since[:, k, None] + until[None, :, k], out=times)
        # from the one acceleration to the other takes time as well
        np.maximum(times, (b.low[None] - a.high[:, None]) / self.limits.jerk, out=times)
        np.maximum(times, (a.low[:, None] - b.high[None]) / self.limits.jerk, out=times)
        return Link(self.places, since, ahead_lines, until, back_lines, times)


def links_of(stretches: Sequence[Stretch], nodes: Sequence[Node]) -> list[Link]:
    """The links of neighbouring nodes as they are cut now; what takes time is worked out for all of them at once."""
    asked = []
    for stretch, (a, b) in zip(stretches, itertools.pairwise(nodes), strict=True):
        asked += [(stretch.ahead, a.speeds, a.high), (stretch.back, b.speeds, -b.low)]
    _learn(asked, stretches[0].limits.jerk)
    tables = _least_tables(stretches, nodes)
    return [
        stretch.link(a, b, least)
        for stretch, (a, b), least in zip(stretches, itertools.pairwise(nodes), tables, strict=True)
    ]


def _least_tables(stretches: Sequence[Stretch], nodes: Sequence[Node]) -> list[Array]:
    """For each link the least times (n, m) between states at both ends in closed form."""
    limits, from_, to = stretches[0].limits, nodes[:-1], nodes[1:]
    sizes = [(len(a.low), len(b.low)) for a, b in itertools.pairwise(nodes)]
    n, m, area = np.array([(n, m, n * m) for n, m in sizes]).T
    peaks, lengths = np.array([(stretch.peak, stretch.length) for stretch in stretches]).T
    first = rise(
        np.concatenate([a.speeds for a in from_]), np.concatenate([a.low for a in from_]),
        np.concatenate([a.high for a in from_]), np.full(n.sum(), limits.acceleration), limits.jerk,
        np.repeat(peaks, n),
    )  # fmt: skip
    last = rise(
        np.concatenate([b.speeds for b in to]), np.concatenate([-b.high for b in to]),
        np.concatenate([-b.low for b in to]), np.full(m.sum(), limits.deceleration), limits.jerk, np.repeat(peaks, m),
    )  # fmt: skip
    of_link = np.arange(area.sum()) - np.repeat(np.cumsum(area) - area, area)
    row, column = np.divmod(of_link, np.repeat(m, area))
    row, column = row + np.repeat(np.cumsum(n) - n, area), column + np.repeat(np.cumsum(m) - m, area)
    found = least_times(first.of(row), last.of(column), np.repeat(lengths, area), np.repeat(peaks, area))
    return [part.reshape(size) for part, size in zip(np.split(found, np.cumsum(area)[:-1]), sizes, strict=True)]


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


def _learn(asked: Sequence[tuple[_Side, Array, Array]], jerk: float) -> None:
    """Work out the least times from states, speeds (n,) [m/s] and accelerations (n,) [m/s2], that are not known yet."""
    groups: list[tuple[_Side, list[tuple[float, float]]]] = []
    for side, speeds, accelerations in asked:
        wanted = dict.fromkeys(zip(speeds.tolist(), accelerations.tolist(), strict=True))
        missing = [state for state in wanted if state not in side.known]
        groups += [(side, missing)] if missing else []
    if not groups:
        return
    counts = [len(states) for _, states in groups]
    speeds, accelerations = np.array([state for _, states in groups for state in states]).T
    most = np.repeat([side.most for side, _ in groups], counts)
    quickest = ramps(speeds, accelerations, groups[0][0].top, most, jerk)
    rows = np.split(np.arange(len(speeds)), np.cumsum(counts)[:-1])
    free = [k for k, (side, _) in enumerate(groups) if side.is_free]
    held = [k for k, (side, _) in enumerate(groups) if not side.is_free]
    at: dict[int, Array] = {}
    for some, times in ((free, _unhindered), (held, _hindered)):
        at |= dict(zip(some, times(quickest, [(groups[k][0], rows[k]) for k in some]) if some else (), strict=True))
    lines = _lines(quickest, [(side, rows[k], at[k]) for k, (side, _) in enumerate(groups)])
    for k, (side, states) in enumerate(groups):
        side.known.update(zip(states, zip(at[k], lines[k], strict=True), strict=True))


def _unhindered(quickest: Ramps, sides: Sequence[tuple[_Side, Rows]]) -> list[Array]:
    """Times (n, P+1) [s] of some ramps to the places of ways on which no cap holds anybody up."""
    tables = [np.repeat(np.append(0.0, np.cumsum(side.steps))[None], len(row), axis=0) for side, row in sides]
    which = np.concatenate([np.repeat(row, table.shape[1]) for (_, row), table in zip(sides, tables, strict=True)])
    return _apart(quickest.time(np.concatenate([table.ravel() for table in tables]), which), tables)


def _hindered(quickest: Ramps, sides: Sequence[tuple[_Side, Rows]]) -> list[Array]:
    """The same where caps do: part after part no more quickly than the cap, nor than the ramp from then on."""
    longest = max(len(side.steps) for side, _ in sides)
    steps = np.concatenate([_padded(side.steps, longest, 0.0, len(row)) for side, row in sides])
    caps = np.concatenate([_padded(side.caps, longest, np.inf, len(row)) for side, row in sides])
    which = np.concatenate([row for _, row in sides])
    at = np.zeros((len(which), longest + 1))
    for p in range(longest):
        ramped = quickest.time(quickest.way(at[:, p], which) + steps[:, p], which)
        at[:, p + 1] = np.maximum(at[:, p] + steps[:, p] / caps[:, p], ramped)
    parts = np.split(at, np.cumsum([len(row) for _, row in sides])[:-1])
    return [part[:, : len(side.steps) + 1] for part, (side, _) in zip(parts, sides, strict=True)]


def _padded(values: Array, length: int, with_: float, rows: int) -> Array:
    row = np.concatenate([values, np.full(length - len(values), with_)])
    return np.repeat(row[None], rows, axis=0)


def _lines(quickest: Ramps, sides: Sequence[tuple[_Side, Rows, Array]]) -> list[Array]:
    """For times (n, P+1) what lines (n, P) [s] from one place have at the next, below all motions in between.

    Who gains speed is nowhere before the straight line; who loses some no faster than at one of both ends.
    """
    which = np.concatenate([np.repeat(row, at.shape[1]) for _, row, at in sides])
    fast = _apart(quickest.speed(np.concatenate([at.ravel() for *_, at in sides]), which), [at for *_, at in sides])
    found = []
    for (side, row, at), speeds in zip(sides, fast, strict=True):
        slower = at[:, :-1] + side.steps / np.maximum(np.maximum(speeds[:, :-1], speeds[:, 1:]), _SLOWEST)
        loses = at[:, :-1] < quickest.dips[row, None]
        found.append(np.where(loses, np.minimum(slower, at[:, 1:]), at[:, 1:]))
    return found


def _apart(values: Array, tables: Sequence[Array]) -> list[Array]:
    """Values one after the other in the shapes of tables."""
    parts = np.split(values, np.cumsum([table.size for table in tables])[:-1])
    return [part.reshape(table.shape) for part, table in zip(parts, tables, strict=True)]
