"""Who must go before whom: the blocking graph.

A robot that rests at its start blocks everybody whose path runs over that place, until it leaves; one that
rests at its goal blocks everybody from then on. So with i's start on k's path, i is planned before k, and
with i's goal on k's path, k before i. Without a cycle every order that respects these arcs gives every robot a
finite plan, whatever plans those before it got: it can wait at its start until all of them have arrived.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coord.conflicts.chords import Chords, chords
from coord.conflicts.core import conflict_core
from coord.conflicts.rest import runs_over
from coord.model.arrays import Array, Point
from coord.model.path import Path, straight
from coord.model.result import BlockingArc
from coord.model.robot import Robot


class Block(NamedTuple):
    """An arc by indices: the place ``at`` ("start" or "goal") which robot ``resting`` rests lies on ``driving``'s path.

    It belongs to the robot that drives: on another path it may vanish.
    """

    resting: int
    driving: int
    at: str

    @property
    def first(self) -> int:
        """The robot to be planned earlier."""
        return self.resting if self.at == "start" else self.driving

    @property
    def then(self) -> int:
        """The robot to be planned later."""
        return self.driving if self.at == "start" else self.resting


def place_of(robots: Sequence[Robot], block: Block) -> Point:
    """Where the resting robot stands [m]."""
    robot = robots[block.resting]
    return robot.start if block.at == "start" else robot.goal


def arc_of(robots: Sequence[Robot], block: Block) -> BlockingArc:
    """The same by names, with the place."""
    return BlockingArc(robots[block.first].name, robots[block.then].name, block.at, place_of(robots, block))


def is_blocked(path: Path, block: Block, robots: Sequence[Robot], clearance: float) -> bool:
    """Whether the place of a block lies on a path of its driving robot, by an exact test; touching does not block."""
    way, place = robots[block.driving].footprint, robots[block.resting].footprint
    distance, core = place.margin + way.margin + clearance, conflict_core(way.core, place.core)
    return runs_over(path, place_of(robots, block), distance, core) is not None


def reaches_of(robots: Sequence[Robot], clearance: float) -> list[float]:
    """How far each robot reaches from its path [m], its half of the clearance included: for candidate pairs."""
    return [robot.footprint.radius + clearance / 2 for robot in robots]


def find_blocks(
    robots: Sequence[Robot],
    paths: Sequence[Path],
    pairs: Sequence[tuple[int, int]],
    clearance: float,
    *,
    stay: bool = True,
) -> list[Block]:
    """The whole graph, from the candidate pairs, in their order; who does not ``stay`` has no goal to park at."""
    others: list[list[int]] = [[] for _ in robots]
    for i, k in pairs:
        others[i].append(k)
        others[k].append(i)
    found: list[Block] = []
    for i, path in enumerate(paths):
        places = [Block(k, i, at) for k in others[i] for at in (("start", "goal") if stay else ("start",))]
        found += blocks_among(places, path, robots, clearance)
    return sorted(found, key=in_order)


def blocks_among(places: Sequence[Block], path: Path, robots: Sequence[Robot], clearance: float) -> list[Block]:
    """Those of some blocks of one driving robot that there are on a path of it."""
    if not places:
        return []
    own = robots[places[0].driving].footprint.radius + clearance
    near = is_near(
        chords(path),
        np.array([place_of(robots, block) for block in places]),
        np.array([robots[block.resting].footprint.radius + own for block in places]),
    )
    return [places[k] for k in np.flatnonzero(near).tolist() if is_blocked(path, places[k], robots, clearance)]


def is_near(chain: Chords, places: Array, distances: Array) -> npt.NDArray[np.bool_]:
    """Whether a path may come nearer to places (n, 2) than some distances (n,) [m]; only for others a proof."""
    a, along = chain.points[:-1], np.diff(chain.points, axis=0)
    gap = places[:, None] - a
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip((gap * along).sum(axis=2) / square, 0.0, 1.0)
    apart = np.hypot(*np.moveaxis(gap - share[..., None] * along, 2, 0))
    return np.asarray((apart < distances[:, None] + chain.errors).any(axis=1))


def in_order(block: Block) -> tuple[int, int, int, bool]:
    """For sorting: pair by pair, first who rests, then where."""
    return (min(block[:2]), max(block[:2]), block.resting, block.at == "goal")


def blocking_arcs(
    robots: Sequence[Robot], paths: Sequence[Path], pairs: Sequence[tuple[int, int]], clearance: float
) -> list[BlockingArc]:
    """The whole graph by names."""
    return [arc_of(robots, block) for block in find_blocks(robots, paths, pairs, clearance)]


def whose_place(block: Block, robots: Sequence[Robot], clearance: float) -> str:
    """Which place of its own the driving robot has there: "start", "goal", "via point"; "" where none.

    Such a block comes from where the robots are to be, not from the path between: no detour takes it away.
    """
    robot = robots[block.driving]
    own = [("start", robot.start), ("goal", robot.goal), *(("via point", place) for place in robot.via)]
    for name, place in own:
        if is_blocked(straight(place, place), block, robots, clearance):
            return name
    return ""
