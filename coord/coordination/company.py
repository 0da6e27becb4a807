"""Robots on their paths, some of them with a profile: whom one more robot meets, and who blocks it or is blocked."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import Chords, chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import ConflictRegion, conflict_regions
from coord.coordination.blocking import Block, find_blocks, reaches_of
from coord.model.arrays import Array
from coord.model.footprint import Footprint
from coord.model.path import Path
from coord.model.problem import Problem
from coord.model.profile import VelocityProfile
from coord.timing.meeting import Ends, Meeting

#: A robot on its path: its index, what it is shaped like, and the path as chords.
Lane: TypeAlias = tuple[int, Footprint, Chords]


@dataclass(slots=True, eq=False)
class Company:
    """All robots of a problem, each on a path; only what one of them needs of the others is worked out.

    Parameters
    ----------
    paths : of all robots, in the order of the problem.
    profiles : of those that have one; these never change.
    """

    problem: Problem
    paths: list[Path]
    profiles: dict[int, VelocityProfile] = field(default_factory=dict)
    _reaches: Array = field(init=False)
    _boxes: Array = field(init=False)
    _chains: dict[int, Chords] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self._reaches = np.array(reaches_of(self.problem.robots, self.problem.workspace.clearance))
        self._boxes = _boxes(self.paths, self._reaches)

    def take(self, i: int, path: Path, profile: VelocityProfile) -> None:
        """Give a robot its path and its profile."""
        self.paths[i], self.profiles[i] = path, profile
        self._boxes[i] = _boxes([path], self._reaches[[i]])[0]
        self._chains.pop(i, None)

    def near(self, i: int, path: Path) -> list[int]:
        """Whom robot i might meet on a path, ascending."""
        xmin, ymin, xmax, ymax = _boxes([path], self._reaches[[i]])[0]
        boxes = self._boxes
        touch = (boxes[:, 0] <= xmax) & (boxes[:, 2] >= xmin) & (boxes[:, 1] <= ymax) & (boxes[:, 3] >= ymin)
        touch[i] = False
        others = np.flatnonzero(touch).tolist()
        if not others:
            return []
        chains = [chords(path), *(self._chain(k) for k in others)]
        pairs = candidate_pairs(chains, self._reaches[[i, *others]].tolist())
        return [others[second - 1] for first, second in pairs if first == 0]

    def blocks(self, i: int, path: Path, others: Sequence[int]) -> list[Block]:
        """The blocking graph between robot i on a path and some others."""
        workspace, paths = self.problem.workspace, [*self.paths[:i], path, *self.paths[i + 1 :]]
        pairs = [(min(i, k), max(i, k)) for k in others]
        return find_blocks(
            self.problem.robots, paths, pairs, workspace.clearance, stay=workspace.after_arrival == "stay"
        )

    def meetings(
        self, i: int, path: Path, others: Sequence[int], blocks: Sequence[Block], known: Sequence[Meeting] = ()
    ) -> list[Meeting]:
        """All meetings of robot i on a path with those of some others that have a profile.

        ``known`` : all meetings with some of them, which are not worked out anew.
        """
        robots, clearance = self.problem.robots, self.problem.workspace.clearance
        own, blocked = chords(path), frozenset(blocks)
        done = {meeting.other for meeting in known}
        found: list[Meeting] = []
        for k in (k for k in others if k in self.profiles):
            if k in done:
                found += [meeting for meeting in known if meeting.other == k]
                continue
            lanes = (i, robots[i].footprint, own), (k, robots[k].footprint, self._chain(k))
            found += meetings_of(*lanes, self.profiles[k], blocked, clearance)
        return found

    def _chain(self, k: int) -> Chords:
        if k not in self._chains:
            self._chains[k] = chords(self.paths[k])
        return self._chains[k]


def meetings_of(
    ego: Lane, other: Lane, profile: VelocityProfile, blocked: Set[tuple[int, int, str]], clearance: float
) -> list[Meeting]:
    """All meetings of one robot with another.

    Parameters
    ----------
    profile : of the other.
    blocked : (resting, driving, "start" or "goal") for every arc of the blocking graph between the two, and any more.
    """
    ends = ends_of(ego[0], other[0], blocked)
    return [
        Meeting(region, other[0], profile, ends, float(ego[2].s[-1]))
        for region in regions_of(ego, other, ends, clearance)
    ]


def ends_of(i: int, k: int, blocked: Set[tuple[int, int, str]]) -> Ends:
    """Where robots i and k rest in each other's way."""
    return Ends(
        start_free=(i, k, "start") not in blocked,
        goal_free=(i, k, "goal") not in blocked,
        other_waits=(k, i, "start") in blocked,
        other_parks=(k, i, "goal") in blocked,
    )


def regions_of(ego: Lane, other: Lane, ends: Ends, clearance: float) -> tuple[ConflictRegion, ...]:
    """Where two robots meet, whatever their profiles."""
    (_, shape, own), (_, beside, chain) = ego, other
    return conflict_regions(
        own,
        chain,
        shape.margin + beside.margin + clearance,
        conflict_core(shape.core, beside.core),
        start_free=ends.start_free,
        goal_free=ends.goal_free,
    )


def _boxes(paths: Sequence[Path], reaches: Array) -> Array:
    """xmin, ymin, xmax, ymax (n, 4) [m] of the floor that each robot may sweep."""
    first = np.cumsum([0, *(len(path.poses) for path in paths[:-1])])
    at = np.concatenate([path.poses[:, :2] for path in paths])
    pieces = np.concatenate([part for path in paths for part in (path.pieces, np.zeros((1, 3)))])  # one a pose
    bent = np.where(pieces[:, 1:].any(axis=1), pieces[:, 0], 0.0)
    # a piece lies within half its length of its ends
    room = (reaches + np.maximum.reduceat(bent, first) / 2)[:, None]
    return np.hstack([np.minimum.reduceat(at, first) - room, np.maximum.reduceat(at, first) + room])
