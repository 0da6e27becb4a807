"""A* over tangents: the shortest way from start to goal among the obstacles that take part.

Two things make it quick. Looked at one by one, states cost what calling numpy costs, so the most promising few are
entered together: a state entered at too great a length is entered again, and the goal counts as reached only when
nothing is more promising. And when more obstacles join, what they do not touch stays as it was found: a path
among more obstacles is never shorter, so every state entered before would have to be entered again.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array
from coord.paths.tangents import END, TangentGraph, turn, turns

#: States that are entered together.
_TOGETHER = 12

#: Tangents from one state that are tested at once; the rest waits until the search comes to them.
_BATCH = 24

#: [m] A way is not shorter than another by less than this.
_SAME_LENGTH = 1e-12

_NOTHING: npt.NDArray[np.intp] = np.empty(0, dtype=np.intp)


@dataclass(frozen=True, slots=True)
class Arrival:
    """A state: a node, in which direction [rad] it is reached, and how long [m] the way was.

    ``before`` : the number of the arrival it follows, -1 at the start; ``left`` : in which direction that was left;
    ``tangent`` : by which tangent.
    """

    node: int
    arriving: float
    length: float
    before: int
    left: float
    tangent: int


@dataclass(slots=True, eq=False)
class _Fan:
    """Tangents that lead on from an arrival, by number, the most promising first.

    ``estimate`` and ``reached`` : for each the least length to the goal through it, and the length up to its end;
    ``queued`` : how many of them were tested.
    """

    arrival: int
    tangents: npt.NDArray[np.intp]
    estimate: Array
    reached: Array
    queued: int = 0


# least length to the goal, number, fan, place in it; -1: the rest of the fan is to be tested
_Entry = tuple[float, int, int, int]


class Search:
    """A search on a graph; where that grows, ``renew`` must be called before it goes on."""

    def __init__(self, graph: TangentGraph) -> None:
        """Begin at the start."""
        self.graph = graph
        self._arrivals: list[Arrival] = []
        self._is_valid: list[bool] = []
        self._fans: list[_Fan] = []
        self._fanned: list[int] = []  # how many tangents from its node each arrival has in fans
        self._entered: dict[int, list[tuple[float, float]]] = {}
        self._heap: list[_Entry] = []
        self._dominated: list[_Entry] = []
        self._pushed = 0
        self._enter([Arrival(END, 0.0, 0.0, -1, 0.0, -1)], [])

    def run(self, longest: float) -> list[Arrival] | None:
        """The arrivals of the shortest path, that at the goal first; None where there is none, or only longer ones."""
        while self._heap and self._heap[0][0] <= longest:
            last = self._leads_to(self._heap[0])
            if last is not None and last.node == END:
                return self._back(last)
            self._enter(*self._popped(longest))
        return None

    def renew(self) -> None:
        """Forget what the obstacles that joined the graph are in the way of, and look at their corners, too."""
        self._drop_arrivals()
        entries, self._dominated = self._heap + self._dominated, []
        waiting = [entry for entry in entries if entry[3] < 0 and self._is_valid[self._fans[entry[2]].arrival]]
        ready = [entry for entry in entries if entry[3] >= 0 and self._is_valid[self._fans[entry[2]].arrival]]
        owners = [self._fans[fan].arrival for _, _, fan, _ in ready]
        tangents = [int(self._fans[fan].tangents[place]) for _, _, fan, place in ready]
        can_go = self._can_go(owners, tangents).tolist()
        self._heap = waiting + [entry for entry, is_open in zip(ready, can_go, strict=True) if is_open]
        heapq.heapify(self._heap)
        for fan in self._fanned_out([k for k, is_valid in enumerate(self._is_valid) if is_valid]):
            self._push(fan, -1, float(self._fans[fan].estimate[0]))

    def _drop_arrivals(self) -> None:
        """Drop those that are no longer reached, with all that followed from them."""
        before = [arrival.before for arrival in self._arrivals[1:]]
        can_go = self._can_go(before, [arrival.tangent for arrival in self._arrivals[1:]]).tolist()
        for k, is_open in enumerate(can_go, 1):
            self._is_valid[k] = self._is_valid[k] and is_open and self._is_valid[before[k - 1]]
        self._entered = {}
        for arrival, is_valid in zip(self._arrivals[1:], self._is_valid[1:], strict=True):
            if is_valid:
                self._entered.setdefault(arrival.node, []).append((arrival.arriving, arrival.length))

    def _can_go(self, owners: Sequence[int], tangents: Sequence[int]) -> npt.NDArray[np.bool_]:
        """Whether one can turn, after arrivals, to tangents, and then go along them."""
        graph, chosen = self.graph, np.array(tangents, dtype=np.intp)
        free = graph.are_free(chosen)
        distinct = sorted(set(owners))
        limits = dict(zip(distinct, self._free_turns([self._arrivals[k] for k in distinct]), strict=True))
        nodes = [self._arrivals[k].node for k in owners]
        arriving = np.array([self._arrivals[k].arriving for k in owners])
        angle = turns(graph.side[nodes], arriving, graph.tangents.leaving[chosen])
        return free & (angle <= np.array([limits[k] for k in owners]))

    def _free_turns(self, arrivals: Sequence[Arrival]) -> list[float]:
        nodes, directions = [arrival.node for arrival in arrivals], [arrival.arriving for arrival in arrivals]
        return self.graph.free_turns(nodes, directions)

    def _popped(self, longest: float) -> tuple[list[Arrival], list[int]]:
        """The most promising arrivals at nodes, and fans with more to be tested."""
        arrivals: list[Arrival] = []
        waiting: list[int] = []
        while self._heap and self._heap[0][0] <= longest and len(arrivals) + len(waiting) < _TOGETHER:
            arrival = self._leads_to(self._heap[0])
            if arrival is None:
                waiting.append(self._heap[0][2])
            elif arrival.node == END:
                break
            elif self._is_dominated(arrival):
                self._dominated.append(self._heap[0])
            else:
                self._entered.setdefault(arrival.node, []).append((arrival.arriving, arrival.length))
                arrivals.append(arrival)
            heapq.heappop(self._heap)
        return arrivals, waiting

    def _leads_to(self, entry: _Entry) -> Arrival | None:
        """The arrival that an entry stands for; None for the rest of a fan."""
        _, _, number, place = entry
        if place < 0:
            return None
        fan, pool = self._fans[number], self.graph.tangents
        tangent = int(fan.tangents[place])
        arriving, left = float(pool.arriving[tangent]), float(pool.leaving[tangent])
        return Arrival(int(pool.nodes[tangent]), arriving, float(fan.reached[place]), fan.arrival, left, tangent)

    def _enter(self, arrivals: Sequence[Arrival], waiting: Sequence[int]) -> None:
        """Let new arrivals take part, and queue the best of what leads on from them and from fans that waited."""
        first = len(self._arrivals)
        self._arrivals += arrivals
        self._is_valid += [True] * len(arrivals)
        self._fanned += [0] * len(arrivals)
        self._queue([*waiting, *self._fanned_out(range(first, len(self._arrivals)))])

    def _fanned_out(self, numbers: Sequence[int]) -> list[int]:
        """New fans for arrivals with tangents that are in no fan yet: where one can go, and how long it is at least."""
        graph, pool = self.graph, self.graph.tangents
        arrivals = [self._arrivals[k] for k in numbers]
        nodes = [arrival.node for arrival in arrivals]
        found = [all_[self._fanned[k] :] for k, all_ in zip(numbers, graph.tangents_from(nodes), strict=True)]
        for k, more in zip(numbers, found, strict=True):
            self._fanned[k] += len(more)
        row = np.repeat(np.arange(len(nodes)), [len(more) for more in found])
        tangents = np.concatenate([*found, _NOTHING])
        free = np.array(self._free_turns(arrivals))
        arriving = np.array([arrival.arriving for arrival in arrivals])
        length = np.array([arrival.length for arrival in arrivals])
        angle = turns(graph.side[nodes][row], arriving[row], pool.leaving[tangents])
        allowed = angle <= free[row]
        angle, row, tangents = angle[allowed], row[allowed], tangents[allowed]
        reached = length[row] + pool.length[tangents] + graph.radius[nodes][row] * angle
        estimate = reached + pool.left[tangents]
        order = np.lexsort((estimate, row))
        ends = np.searchsorted(row, np.arange(len(nodes) + 1)).tolist()
        before = len(self._fans)
        for k, first, last in zip(numbers, ends[:-1], ends[1:], strict=True):
            own = order[first:last]
            if len(own):
                self._fans.append(_Fan(k, tangents[own], estimate[own], reached[own]))
        return list(range(before, len(self._fans)))

    def _queue(self, numbers: Sequence[int]) -> None:
        """Test some more tangents of fans, queue those that hit nothing, and remember that there are more."""
        fans = [self._fans[number] for number in numbers]
        picked = [fan.tangents[fan.queued : fan.queued + _BATCH] for fan in fans]
        free = self.graph.are_free(np.concatenate([*picked, _NOTHING])).tolist()
        for number, fan, some in zip(numbers, fans, picked, strict=True):
            first, fan.queued = fan.queued, fan.queued + len(some)
            mine, free = free[: len(some)], free[len(some) :]
            estimate = fan.estimate[first : fan.queued + 1].tolist()
            for k, is_free in enumerate(mine):
                if is_free:
                    self._push(number, first + k, estimate[k])
            if fan.queued < len(fan.tangents):
                self._push(number, -1, estimate[-1])

    def _push(self, fan: int, place: int, estimate: float) -> None:
        self._pushed += 1
        heapq.heappush(self._heap, (estimate, self._pushed, fan, place))

    def _is_dominated(self, arrival: Arrival) -> bool:
        """Whether somebody was here earlier along the turn, at no greater length, with the arc in between free."""
        graph, node = self.graph, arrival.node
        radius, side = float(graph.radius[node]), float(graph.side[node])
        for earlier, shorter in self._entered.get(node, ()):
            angle = turn(side, earlier, arrival.arriving)
            is_shorter = shorter + radius * angle <= arrival.length + _SAME_LENGTH
            if is_shorter and angle <= graph.free_turns([node], [earlier])[0]:
                return True
        return False

    def _back(self, last: Arrival) -> list[Arrival]:
        """The arrivals on the way to the last, that first."""
        found = [last]
        while found[-1].before >= 0:
            found.append(self._arrivals[found[-1].before])
        return found
