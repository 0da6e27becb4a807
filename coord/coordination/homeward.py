"""Large groups that their paths leave stuck come home one by one, by way of holding places, as the lattice confirms.

Every other way to bring a group home begins with its paths and looks for an order. Among more than a dozen robots
before one door there is none, as a rule, and bays for one robot after the other take long to find. So here the order
and the paths are found together; the moves that come of it are kept for the planning of motions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from coord.coordination.flood import Raster
from coord.coordination.holding import Leg, one_by_one
from coord.coordination.lattice import Floor, Lattice, lattice_of
from coord.coordination.moves import Move, moves_home
from coord.coordination.rerouting import Rerouting
from coord.coordination.way_round import rests
from coord.model.problem import Problem

#: [robots] Of smaller groups bays untie those that are stuck, which changes fewer paths.
_LARGE = 12

#: States from which it is tried who goes first: a large group that finds no order soon, finds none for long.
_FEW_STATES = 30

#: Blocks for each robot; where places are merely handed over in rings there are two.
_MANY_BLOCKS = 3


@dataclass(frozen=True, slots=True, eq=False)
class Homeward:
    """Moves that bring a group home; by their positions in ``group``, in this lattice of their paths."""

    group: tuple[int, ...]
    lattice: Lattice
    moves: Sequence[Move]


@dataclass(frozen=True, slots=True, eq=False)
class Untied:
    """Paths, and of which groups it is known that they come home on them.

    ``homeward`` : of the groups that have new paths; ``fine`` : groups whose paths had moves home as they were.
    """

    found: Rerouting
    homeward: Mapping[tuple[int, ...], Homeward] = field(default_factory=dict)
    fine: tuple[tuple[int, ...], ...] = ()


def with_holding_places(
    problem: Problem,
    untied: Untied,
    shape: str,
    check_time: Callable[[], None] = lambda: None,
    *,
    only_tangled: bool = False,
) -> Untied:
    """Paths on which large groups come home, as far as holding places help; others are left as they are.

    Parameters
    ----------
    untied : paths, and the groups of which it is known that they come home on them.
    shape : of the paths, as in ``find_routes``.
    check_time : called now and then; may raise.
    only_tangled : leave groups alone that may come home on paths with room to pass.
    """
    found, homeward, fine = untied.found, {**untied.homeward}, [*untied.fine]
    large = [group for group in found.together if len(group) > _LARGE and group not in homeward]
    tangled = [group for group in large if _is_tangled(found, group)]
    todo = tangled if only_tangled else large
    if not todo:
        return untied
    raster, known = Raster(problem), rests(problem)
    for group in todo:
        check_time()
        if group not in tangled and _comes_home(problem, found, group):
            fine.append(group)
            continue
        way = one_by_one(raster, known, found, group, shape, check_time)
        lattice = None if way is None else lattice_of(_floor(problem, way[0]), group)
        moves = None if way is None or lattice is None else moves_of(lattice, group, way[1])
        if way is not None and lattice is not None and moves is not None:
            found, homeward[group] = way[0], Homeward(group, lattice, moves)
    return Untied(found, homeward, tuple(fine))


def _is_tangled(found: Rerouting, group: Sequence[int]) -> bool:
    """Whether its robots are in each other's way in so many places that no order on their paths is to be expected."""
    members = set(group)
    blocks = sum(block.first in members and block.then in members for block in found.blocks)
    return blocks > _MANY_BLOCKS * len(group)


def _comes_home(problem: Problem, found: Rerouting, group: Sequence[int]) -> bool:
    lattice = lattice_of(_floor(problem, found), group)
    return lattice is not None and moves_home(lattice, _FEW_STATES).moves is not None


def moves_of(lattice: Lattice, group: Sequence[int], legs: Sequence[Leg]) -> list[Move] | None:
    """Legs as moves in a lattice; None where one of them is forbidden, or not everybody is home in the end."""
    position = {i: n for n, i in enumerate(group)}
    at = [0 for _ in group]
    moves: list[Move] = []
    for leg in legs:
        n = position[leg.robot]
        places = lattice.places[n]
        move = Move(n, at[n], int(np.argmin(abs(places - leg.place))))
        passed = (1 << move.end) - (1 << move.start)
        if move.end < move.start or any(lattice.stopped[n, m][at[m]] & passed for m in lattice.neighbours[n]):
            return None
        at[n] = move.end
        moves.append(move)
    home = all(a == len(places) - 1 for a, places in zip(at, lattice.places, strict=True))
    return moves if home else None


def _floor(problem: Problem, found: Rerouting) -> Floor:
    paths = [route.path for route in found.routes]
    return Floor(problem.robots, paths, frozenset(found.blocks), problem.workspace.clearance)
