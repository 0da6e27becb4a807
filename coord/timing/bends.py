"""How early a robot can be anywhere on a path with bends, and how long it still needs: bounds that no motion beats.

A bend caps the speed, so at its ends every motion is at most that quick; what is left open there is the
acceleration. It is cut into narrow cells. From the upper end of a cell the robot is given the greatest speed that
any motion can have from then on, up to the next such place; before the lower end of a cell, the greatest that any
motion can have had. Up to any place between two such places the one holds, from there on the other. The least sum
over all chains of cells is a bound, because every motion goes through one of these chains.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array, frozen
from coord.model.path import Path
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.timing.clock import clock
from coord.timing.links import Link, Node, Stretch, links_of, nodes_of, sections

#: One of so many places is a mark.
_EVERY = 2

#: [s] Taken off every bound: rounding, which is largest near a stop, stays far below it.
_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Chains:
    """The way from node to node.

    Parameters
    ----------
    nodes, stretches : all of them, and what lies between neighbours; ``links`` : the same as the nodes are cut now.
    reached, needed : for the cells of the nodes before and behind each link least times from the start, and to the
        goal.
    """

    nodes: Sequence[Node]
    stretches: Sequence[Stretch]
    links: list[Link]
    reached: list[Array]
    needed: list[Array]


@dataclass(frozen=True, slots=True, eq=False)
class Passages:
    """What bends cost every motion from rest to rest, beyond what they cost with the jerk forgotten.

    Parameters
    ----------
    places : (P,) arc lengths [m], increasing, from 0 to the length.
    late, long : (P,) times [s], not negative: how much later than the motion without jerk the robot is anywhere
        from that place on, and how much longer it needs from anywhere up to that place.
    early, still : (P-1, 2) between two places a line over s below all times [s] since departure, and below all times
        [s] to the goal.
    total : least time [s] for the whole way.
    marks : (Q,) some of the places; ``between`` : (Q, Q) how much longer [s] than the motion without jerk every motion
        needs from one of them to another, however it moves at both.
    chains : what all this was taken from.
    """

    places: Array
    late: Array
    long: Array
    early: Array
    still: Array
    total: float
    marks: Array
    between: Array
    chains: Chains

    def earliest(self, s: Array, clocks: Array) -> Array:
        """Least times (m,) [s] from rest at the start to the arc lengths s (m,) [m].

        ``clocks`` : (m,) those of the motion without jerk.
        """
        k = np.clip(np.searchsorted(self.places, s, side="right") - 1, 0, len(self.places) - 1)
        return np.maximum(clocks + self.late[k], self._on_lines(self.early, s))

    def needed(self, s: Array, left: Array) -> Array:
        """Least times (m,) [s] from the arc lengths s (m,) [m] to rest at the goal.

        ``left`` : (m,) those of the motion without jerk.
        """
        k = np.clip(np.searchsorted(self.places, s, side="left"), 0, len(self.places) - 1)
        return np.maximum(left + self.long[k], self._on_lines(self.still, s))

    def reached(self, times: Array) -> Array:
        """The largest arc lengths (m,) [m] at the times (m,) [s], from 0 on, since departure."""
        return self._last_below(self.early.ravel(), np.repeat(self.places, 2)[1:-1], times)

    def due(self, left: Array) -> Array:
        """The least arc lengths (m,) [m] from which the goal can be reached in the times (m,) [s], from 0 on."""
        behind = self.places[-1] - np.repeat(self.places, 2)[-2:0:-1]
        return np.asarray(self.places[-1] - self._last_below(self.still.ravel()[::-1], behind, left))

    def _on_lines(self, lines: Array, s: Array) -> Array:
        k = np.clip(np.searchsorted(self.places, s, side="right") - 1, 0, len(lines) - 1)
        share = np.clip((s - self.places[k]) / (self.places[k + 1] - self.places[k]), 0.0, 1.0)
        return np.asarray(lines[k, 0] + share * (lines[k, 1] - lines[k, 0]))

    @staticmethod
    def _last_below(values: Array, places: Array, times: Array) -> Array:
        """The last places at which lines through the values, which never fall, are no higher than some times."""
        k = np.clip(np.searchsorted(values, times, side="right") - 1, 0, len(values) - 1)
        n = np.minimum(k + 1, len(values) - 1)
        rise = values[n] - values[k]
        share = np.divide(times - values[k], rise, out=np.zeros_like(times), where=rise > 0)
        return np.asarray(places[k] + np.clip(share, 0.0, 1.0) * (places[n] - places[k]))


def passages(path: Path, limits: Limits, relaxed: VelocityProfile) -> Passages | None:
    """The bounds of a path on which the speed cap varies; None where it is the same everywhere.

    ``relaxed`` : the motion with the jerk forgotten, ``coord.alone.relaxed.without_jerk``.
    """
    ends, caps = sections(path, limits)
    if len(caps) < 2:
        return None
    nodes = nodes_of(ends, caps, limits, relaxed)
    return _passages(_linked([Stretch(a, b, ends, caps, limits) for a, b in itertools.pairwise(nodes)], nodes), relaxed)


def narrower(bends: Passages, relaxed: VelocityProfile, rounds: int) -> Passages:
    """Tighter bounds: so often cells are cut, each time for longer, and half of what the bounds lack is gained.

    Cells are cut where the bounds come from: elsewhere narrower ones would change nothing.
    """
    chains = bends.chains
    for _ in range(rounds):
        nodes = [node.split(cells) for node, cells in zip(chains.nodes, _decisive(chains), strict=True)]
        chains = _linked(chains.stretches, nodes)
    return _passages(chains, relaxed)


def _passages(chains: Chains, relaxed: VelocityProfile) -> Passages:
    links = chains.links
    places = np.concatenate([link.places for link in links])
    early, early_lines = _over_places(chains.reached, [(link.since, link.since_lines) for link in links])
    back = [(link.until[:, ::-1], link.until_lines[:, ::-1]) for link in reversed(links)]
    still, still_lines = (found[::-1] for found in _over_places(chains.needed[::-1], back))
    alone = clock(relaxed, places)
    late = np.maximum.accumulate(early - alone)
    long = np.maximum.accumulate((still - (relaxed.arrival - alone))[::-1])[::-1]
    total = max(float(chains.reached[-1][0]), relaxed.arrival)
    return Passages(
        frozen(places), frozen(np.maximum(late - _ROUNDING, 0.0)), frozen(np.maximum(long - _ROUNDING, 0.0)),
        frozen(early_lines - _ROUNDING, 2), frozen(still_lines[:, ::-1] - _ROUNDING, 2),
        total - _ROUNDING, *_between(links, relaxed), chains,
    )  # fmt: skip


def _over_places(before: Sequence[Array], links: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Least times (P,) over all cells at the places of all links, and lines (P-1, 2) below those in between.

    ``before`` : what the cells at the beginning of each link need before; ``links`` : times and lines of the cells.
    """
    values, ends = [], []
    for least, (times, lines) in zip(before, links, strict=False):
        values.append((least[:, None] + times).min(axis=0))
        ends.append(np.append((least[:, None] + lines).min(axis=0), np.inf))
    at, end = np.concatenate(values), np.concatenate(ends)
    lines = np.stack([at[:-1], np.minimum(end[:-1], at[1:])], axis=1)
    return at, np.maximum.accumulate(lines.ravel()).reshape(-1, 2)  # they rise but for rounding


def _linked(stretches: Sequence[Stretch], nodes: Sequence[Node]) -> Chains:
    links = links_of(stretches, nodes)
    reached, needed = [np.zeros(1)], [np.zeros(1)]
    for link in links:
        reached.append((reached[-1][:, None] + link.times).min(axis=0))
    for link in reversed(links):
        needed.append((link.times + needed[-1][None]).min(axis=1))
    return Chains(nodes, stretches, links, reached, needed[-2::-1])


def _decisive(chains: Chains) -> list[npt.NDArray[np.bool_]]:
    """Which cells of each node some bound comes from."""
    links, reached, needed = chains.links, chains.reached, [*chains.needed]
    ahead = [np.zeros(len(cells), bool) for cells in reached]
    behind = [np.zeros(len(cells), bool) for cells in reached]
    ahead[-1][:] = behind[0][:] = True
    for m in range(len(links) - 1, -1, -1):
        ahead[m][(reached[m][:, None] + links[m].since).argmin(axis=0)] = True
        ahead[m][(reached[m][:, None] + links[m].times).argmin(axis=0)[ahead[m + 1]]] = True
    for m, link in enumerate(links):
        behind[m + 1][(needed[m][:, None] + link.until).argmin(axis=0)] = True
        behind[m + 1][(link.times + needed[m][None]).argmin(axis=1)[behind[m]]] = True
    return [a | b for a, b in zip(ahead, behind, strict=True)]


def _between(links: Sequence[Link], relaxed: VelocityProfile) -> tuple[Array, Array]:
    """Some places, close together next to nodes, and the least extra time from each to each behind a node."""
    picked = [sorted({*range(0, len(link.places), _EVERY), len(link.places) - 1}) for link in links]
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
