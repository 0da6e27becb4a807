"""Where the robots of a group can be at once: places along their paths, and which moves others at rest forbid.

The paths of a group span a space of as many dimensions as it has robots. Cut into places along each path, it becomes
a lattice in which one robot at a time moves on to its next place while all others rest. Of each pair there are tables:
who rests in whose way, and from which pairs of places both still come home.
"""

from __future__ import annotations

import math
from collections.abc import Sequence, Set
from dataclasses import dataclass
from itertools import combinations
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from coord.conflicts.chords import Chords, chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import ConflictRegion, conflict_regions
from coord.model.arrays import Array
from coord.model.path import Path
from coord.model.robot import Robot

#: [m] Places are about so far from each other; on long paths farther, so that none has more of them than this.
_STEP, _MOST_PLACES = 0.05, 300

_Table: TypeAlias = npt.NDArray[np.bool_]

#: For each place of one robot the places of another as bits of a number, the first the lowest.
Bits: TypeAlias = tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Floor:
    """Robots on their paths; ``blocked`` : (resting, driving, "start" or "goal") for all blocking arcs."""

    robots: Sequence[Robot]
    paths: Sequence[Path]
    blocked: Set[tuple[int, int, str]]
    clearance: float


@dataclass(frozen=True, slots=True, eq=False)
class Lattice:
    """The places of the robots of a group, by their positions in it, and what each pair allows.

    Parameters
    ----------
    places : for each robot the arc lengths [m] of its places, from 0 to the length of its path.
    neighbours : for each robot those that it may meet.
    stopped : ``stopped[i, k][b]`` : the moves of i, by where they begin, that are forbidden while k rests at place b.
    lost : ``lost[i, k][b]`` : the places of i from which the two do not both come home once k has come to its place b.
    crossed : ``crossed[i, k][a, b]`` : whether the moves of both from these places must not happen at one time.
    """

    places: Sequence[Array]
    neighbours: list[list[int]]
    stopped: dict[tuple[int, int], Bits]
    lost: dict[tuple[int, int], Bits]
    crossed: dict[tuple[int, int], _Table]


def lattice_of(floor: Floor, group: Sequence[int]) -> Lattice | None:
    """The lattice of a group of robots; None where one of them never moves, or two do not both come home in it."""
    places = [_places(floor.paths[i]) for i in group]
    if any(len(at) < 2 for at in places):
        return None
    lattice = Lattice(places, [[] for _ in group], {}, {}, {})
    chains = [chords(floor.paths[i]) for i in group]
    for n, m in combinations(range(len(group)), 2):
        if not _add(lattice, n, m, _pair(floor, group[n], group[m], chains[n], chains[m], places[n], places[m])):
            return None
    return lattice


def with_other_path(lattice: Lattice, floor: Floor, group: Sequence[int], n: int) -> Lattice | None:
    """The lattice once the robot at a position in the group is on another path; None as in ``lattice_of``."""
    places = [*lattice.places]
    places[n] = _places(floor.paths[group[n]])
    stopped, lost = (
        {pair: one for pair, one in table.items() if n not in pair} for table in (lattice.stopped, lattice.lost)
    )
    crossed = {pair: one for pair, one in lattice.crossed.items() if n not in pair}
    near = [[m for m in some if m != n] if k != n else [] for k, some in enumerate(lattice.neighbours)]
    changed, own = Lattice(places, near, stopped, lost, crossed), chords(floor.paths[group[n]])
    for m in range(len(group)):
        if m != n:
            other = chords(floor.paths[group[m]])
            if not _add(changed, n, m, _pair(floor, group[n], group[m], own, other, places[n], places[m])):
                return None
    return changed


def _places(path: Path) -> Array:
    if path.length <= 0:
        return np.zeros(1)
    return np.linspace(0.0, path.length, 1 + min(math.ceil(path.length / _STEP), _MOST_PLACES))


@dataclass(frozen=True, slots=True, eq=False)
class _Pair:
    """Tables of two robots over their places: ``first`` moves while the other rests, ``second`` does, or both move."""

    first: _Table
    second: _Table
    both: _Table


def _pair(floor: Floor, i: int, k: int, own: Chords, other: Chords, s: Array, sigma: Array) -> _Pair | None:
    """The tables of two robots; None where they never come near each other."""
    body, beside = floor.robots[i].footprint, floor.robots[k].footprint
    regions = conflict_regions(
        own,
        other,
        body.margin + beside.margin + floor.clearance,
        conflict_core(body.core, beside.core),
        start_free=(i, k, "start") not in floor.blocked,
        goal_free=(i, k, "goal") not in floor.blocked,
    )
    if not regions:
        return None
    first: _Table = np.zeros((len(s) - 1, len(sigma)), dtype=np.bool_)
    second: _Table = np.zeros((len(s), len(sigma) - 1), dtype=np.bool_)
    both: _Table = np.zeros((len(s) - 1, len(sigma) - 1), dtype=np.bool_)
    for region in regions:
        low, high = _interval_at(region, sigma)
        first |= (low[None] < s[1:, None]) & (high[None] > s[:-1, None])
        lows, highs = region.low.min(axis=1)[:, None], region.high.max(axis=1)[:, None]
        second |= _any_cell((lows < s) & (s < highs), region, sigma).T
        both |= _any_cell((lows < s[1:]) & (highs > s[:-1]), region, sigma).T
    # an exact test knows whether somebody at rest is in the way, bounds do not
    first[:, 0] &= (k, i, "start") in floor.blocked
    first[:, -1] &= (k, i, "goal") in floor.blocked
    return _Pair(first, second, both | first[:, 1:] | first[:, :-1] | second[1:] | second[:-1])


def _interval_at(region: ConflictRegion, sigma: Array) -> tuple[Array, Array]:
    """Forbidden at places of the other (m,): least and largest arc length [m], the least above where there are none."""
    nodes, last = region.sigma, len(region.low) - 1
    low, high = np.full(len(sigma), np.inf), np.full(len(sigma), -np.inf)
    sides: tuple[Literal["left", "right"], ...] = ("left", "right")
    for side in sides:  # a place may be where two cells meet
        cell = np.clip(np.searchsorted(nodes, sigma, side=side) - 1, 0, last)
        width = np.maximum(nodes[cell + 1] - nodes[cell], 1e-300)
        share = np.clip((sigma - nodes[cell]) / width, 0.0, 1.0)
        low = np.minimum(low, region.low[cell, 0] + share * (region.low[cell, 1] - region.low[cell, 0]))
        high = np.maximum(high, region.high[cell, 0] + share * (region.high[cell, 1] - region.high[cell, 0]))
    inside = (nodes[0] <= sigma) & (sigma <= nodes[-1])
    return np.where(inside, low, np.inf), np.where(inside, high, -np.inf)


def _any_cell(holds: _Table, region: ConflictRegion, sigma: Array) -> _Table:
    """Whether something that holds in some cells of a region (n, m) does in any that a move (b,) of the other meets."""
    count = np.concatenate([np.zeros((1, holds.shape[1]), dtype=np.intp), np.cumsum(holds, axis=0)])
    first = np.clip(np.searchsorted(region.sigma, sigma[:-1], side="left") - 1, 0, len(holds))
    last = np.clip(np.searchsorted(region.sigma, sigma[1:], side="right"), 0, len(holds))
    return np.asarray(count[last] > count[np.minimum(first, last)])


def _add(lattice: Lattice, i: int, k: int, pair: _Pair | None) -> bool:
    """Note what a pair allows, seen from both; whether both come home."""
    if pair is None:
        return True
    lost = _lost(pair)
    lattice.neighbours[i].append(k)
    lattice.neighbours[k].append(i)
    lattice.stopped[i, k], lattice.stopped[k, i] = _bits(pair.first.T), _bits(pair.second)
    lattice.lost[i, k], lattice.lost[k, i] = _bits(_table(lost, pair.first.shape[1]).T), lost
    lattice.crossed[i, k], lattice.crossed[k, i] = pair.both, pair.both.T
    return not lost[0] & 1


def _lost(pair: _Pair) -> Bits:
    """For each place of the first robot the places of the second from which not both come home."""
    count = pair.first.shape[1]
    every = (1 << count) - 1
    first, second = _bits(pair.first), _bits(pair.second)
    home = 1 << (count - 1)
    found: list[int] = []
    for a in range(len(second) - 1, -1, -1):
        reached = home if a == len(second) - 1 else found[-1] & ~first[a]
        found.append(_filled(reached, every >> 1 & ~second[a], count))
    return tuple(every & ~reached for reached in reversed(found))


def _filled(reached: int, passable: int, count: int) -> int:
    """The bits reached, and each below one of them from which only passable moves lead there."""
    step = 1
    while step < count:
        reached |= passable & (reached >> step)
        passable &= passable >> step
        step *= 2
    return reached


def _bits(rows: _Table) -> Bits:
    packed = np.packbits(rows, axis=1, bitorder="little")
    size, whole = packed.shape[1], packed.tobytes()
    return tuple(int.from_bytes(whole[at : at + size], "little") for at in range(0, len(whole), size))


def _table(rows: Bits, count: int) -> _Table:
    size = (count + 7) // 8
    whole = np.frombuffer(b"".join(row.to_bytes(size, "little") for row in rows), dtype=np.uint8).reshape(-1, size)
    return np.unpackbits(whole, axis=1, count=count, bitorder="little").astype(np.bool_)
