"""Robots on their paths before any has a profile: who is near whom, who blocks whom, and where they meet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import Chords, chords
from coord.conflicts.region import ConflictRegion
from coord.coordination.blocking import Block
from coord.coordination.company import ends_of, regions_of
from coord.timing.ego import Ego
from coord.timing.meeting import Meeting
from coord.timing.passing import Timing


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Robots on their paths, who is near whom, and who blocks whom.

    ``neighbours`` : for each robot the indices of those it might meet; ``blocked`` : (resting, driving, "start"
    or "goal") for every arc of the blocking graph; ``regions`` : of pairs that are looked at more than once.
    """

    egos: Sequence[Ego]
    chords: Sequence[Chords]
    neighbours: Sequence[Sequence[int]]
    blocked: frozenset[tuple[int, int, str]]
    clearance: float
    regions: dict[tuple[int, int], tuple[ConflictRegion, ...]] = field(default_factory=dict)

    def meetings(
        self, i: int, others: Sequence[int], timings: Mapping[int, Timing], *, remember: bool = False
    ) -> list[Meeting]:
        """All meetings of robot i with others that have a profile; ``remember`` where to meet, for the next time."""
        length, found = float(self.chords[i].s[-1]), []
        for k in others:
            ends = ends_of(i, k, self.blocked)
            regions = self.regions.get((i, k))
            if regions is None:
                ego, other = ((n, self.egos[n].robot.footprint, self.chords[n]) for n in (i, k))
                regions = regions_of(ego, other, ends, self.clearance)
            if remember:
                self.regions[i, k] = regions
            found += [Meeting(region, k, timings[k].profile, ends, length) for region in regions]
        return found

    def forget(self, i: int) -> None:
        """Let go of where robot i meets others: it has its profile."""
        for k in self.neighbours[i]:
            self.regions.pop((i, k), None)


def scene_of(egos: Sequence[Ego], reaches: Sequence[float], blocks: Iterable[Block], clearance: float) -> Scene:
    """The scene of robots that reach so far [m] from their paths, their share of the clearance included."""
    chains = [chords(ego.path) for ego in egos]
    neighbours: list[list[int]] = [[] for _ in egos]
    for i, k in candidate_pairs(chains, reaches):
        neighbours[i].append(k)
        neighbours[k].append(i)
    return Scene(egos, chains, neighbours, frozenset(blocks), clearance)
