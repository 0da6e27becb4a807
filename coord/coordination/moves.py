"""Moves, one robot at a time, that bring a whole group home: a search in the lattice of their places.

Whoever can move on to where it stands in nobody's way more than before does so at once, since that never harms. Only
where nobody can, it is tried who goes first, the way with the least left to drive before the others. What two robots
could not both come home from is never tried.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import Final, NamedTuple, TypeAlias

from coord.coordination.lattice import Lattice

#: Where all robots of a group are: for each the index of its place.
_State: TypeAlias = tuple[int, ...]

#: States from which it is tried who goes first, where nothing else is said.
MOST_STATES: Final = 300

#: Choices from a state, about as many as eight robots have; of more robots fewer states are looked at.
_CHOICES: Final = 40

#: Of the places that a robot could move on to, one in so many is looked at.
_STRIDE: Final = 3


class Move(NamedTuple):
    """A robot, by its position in the group, goes from one of its places to a later one."""

    robot: int
    start: int
    end: int


class Outcome(NamedTuple):
    """What a search found.

    ``moves`` : after them all are home; None where none were found. ``is_whole`` : whether all that there is in the
    lattice was looked at; ``stuck`` : the robots not home in the state with the least ``left`` to drive [m];
    ``looks`` : how often a robot was looked at, which takes about as long each time.
    """

    moves: list[Move] | None
    is_whole: bool
    stuck: tuple[int, ...]
    left: float
    looks: int


@dataclass(slots=True, eq=False)
class _Search:
    """States seen, each with the one that it came from and the moves from there."""

    lattice: Lattice
    came: dict[_State, tuple[_State | None, list[Move]]] = field(default_factory=dict)

    def moves(self, state: _State) -> list[Move]:
        found: list[Move] = []
        at: _State | None = state
        while at is not None:
            at, last = self.came[at]
            found = last + found
        return found


def moves_home(lattice: Lattice, most: int) -> Outcome:
    """Moves after which all robots are at their goals; ``most`` : states from which it is tried who goes first."""
    search, home = _Search(lattice), tuple(len(at) - 1 for at in lattice.places)
    first, moves, looks = _onward(lattice, tuple(0 for _ in home), range(len(home)))
    search.came[first] = (None, moves)
    queue = [(_left(lattice, first), 0, first)]
    best = queue[0]
    pushed = tried = moved = 0
    while queue and tried < most and moved < most * _CHOICES:
        now = heapq.heappop(queue)
        if now[2] == home:
            return Outcome(search.moves(now[2]), False, (), 0.0, looks)
        best = min(best, now)
        tried += 1
        for move in _choices(lattice, now[2]):
            moved += 1
            beside = (move.robot, *lattice.neighbours[move.robot])
            after, moves, more = _onward(lattice, _moved(now[2], move), beside)
            looks += more
            if after not in search.came:
                search.came[after] = (now[2], [move, *moves])
                if after == home:
                    return Outcome(search.moves(after), False, (), 0.0, looks)
                pushed += 1
                heapq.heappush(queue, (_left(lattice, after), pushed, after))
    stuck = tuple(n for n, (a, end) in enumerate(zip(best[2], home, strict=True)) if a < end)
    return Outcome(None, not queue, stuck, best[0], looks)


def _left(lattice: Lattice, state: _State) -> float:
    """What all robots still have to drive [m]."""
    return float(sum(at[-1] - at[a] for at, a in zip(lattice.places, state, strict=True)))


def _moved(state: _State, move: Move) -> _State:
    return (*state[: move.robot], move.end, *state[move.robot + 1 :])


def _onward(lattice: Lattice, state: _State, waiting: Iterable[int]) -> tuple[_State, list[Move], int]:
    """The state after all moves that harm nobody, these, and the looks; ``waiting`` : who may have such a move."""
    moves: list[Move] = []
    queue, looks = list(waiting), 0
    while queue:
        i, looks = queue.pop(0), looks + 1
        move = _harmless(lattice, state, i)
        if move is not None:
            state = _moved(state, move)
            moves.append(move)
            queue += [k for k in lattice.neighbours[i] if k not in queue]
    return state, moves, looks


def _harmless(lattice: Lattice, state: _State, i: int) -> Move | None:
    """A far move of a robot to where it stands in nobody's way more than before."""
    if state[i] == len(lattice.places[i]) - 1:
        return None
    near = []  # for each other: what a place forbids it, and which of its moves are still to come and were free so far
    for k in lattice.neighbours[i]:
        if state[k] < len(lattice.places[k]) - 1:
            stopped = lattice.stopped[k, i]
            near.append((stopped, ~stopped[state[i]] >> state[k] << state[k]))
    for end in islice(_ends(lattice, state, i), 0, None, _STRIDE):
        for m, (stopped, free) in enumerate(near):
            if stopped[end] & free:
                near.insert(0, near.pop(m))  # who is hindered here is hindered at the next place, too, as a rule
                break
        else:
            return Move(i, state[i], end)
    return None


def _ends(lattice: Lattice, state: _State, i: int) -> Iterator[int]:
    """Places that a robot can move on to without anybody else moving and without dooming a pair, the farthest first."""
    a, last = state[i], len(lattice.places[i]) - 1
    stopped = lost = 0
    for k in lattice.neighbours[i]:
        stopped |= lattice.stopped[i, k][state[k]]
        lost |= lattice.lost[i, k][state[k]]
    ahead = stopped >> a
    reach = last if not ahead else a + (ahead & -ahead).bit_length() - 1
    return (end for end in range(reach, a, -1) if not lost >> end & 1)


def _choices(lattice: Lattice, state: _State) -> Iterator[Move]:
    """Moves worth a try: of each robot to the farthest place, and to those before where it hinders the least."""
    for i, a in enumerate(state):
        ends = list(islice(_ends(lattice, state, i), 0, None, _STRIDE))
        hinders = [_hindered(lattice, state, i, end) for end in ends]
        for n, end in enumerate(ends):
            before, after = hinders[n - 1] if n else None, hinders[n + 1] if n + 1 < len(ends) else None
            if before is None or (hinders[n] < before and (after is None or hinders[n] <= after)):
                yield Move(i, a, end)


def _hindered(lattice: Lattice, state: _State, i: int, end: int) -> int:
    """How many moves of others a robot at a place forbids."""
    return sum((lattice.stopped[k, i][end] >> state[k]).bit_count() for k in lattice.neighbours[i])
