"""One robot after the other: each is planned against those before it, which never change any more."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import Chords, chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import conflict_regions
from coord.coordination import diagnose
from coord.coordination.blocking import Block
from coord.errors import NoPlanError, SolverError
from coord.model.result import BlockingArc
from coord.timing.ego import Ego
from coord.timing.meeting import Ends, Meeting
from coord.timing.passing import Timing, time_robot


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Robots on their paths, who is near whom, and who blocks whom.

    ``neighbours`` : for each robot the indices of those it might meet; ``blocked`` : (resting, driving, "start"
    or "goal") for every arc of the blocking graph.
    """

    egos: Sequence[Ego]
    chords: Sequence[Chords]
    neighbours: Sequence[Sequence[int]]
    blocked: frozenset[tuple[int, int, str]]
    clearance: float

    def meetings(self, i: int, others: Sequence[int], timings: dict[int, Timing]) -> list[Meeting]:
        """All meetings of robot i with others that have a profile."""
        found = []
        for k in others:
            ends = Ends(
                start_free=(i, k, "start") not in self.blocked,
                goal_free=(i, k, "goal") not in self.blocked,
                other_waits=(k, i, "start") in self.blocked,
                other_parks=(k, i, "goal") in self.blocked,
            )
            ego, other = self.egos[i].robot.footprint, self.egos[k].robot.footprint
            regions = conflict_regions(
                self.chords[i],
                self.chords[k],
                ego.margin + other.margin + self.clearance,
                conflict_core(ego.core, other.core),
                start_free=ends.start_free,
                goal_free=ends.goal_free,
            )
            found += [Meeting(region, k, timings[k].profile, ends, self.egos[i].length) for region in regions]
        return found


def scene_of(egos: Sequence[Ego], reaches: Sequence[float], blocks: Iterable[Block], clearance: float) -> Scene:
    """The scene of robots that reach so far [m] from their paths, their share of the clearance included."""
    chains = [chords(ego.path) for ego in egos]
    neighbours: list[list[int]] = [[] for _ in egos]
    for i, k in candidate_pairs(chains, reaches):
        neighbours[i].append(k)
        neighbours[k].append(i)
    return Scene(egos, chains, neighbours, frozenset(blocks), clearance)


def blocked_places(arcs: Sequence[BlockingArc], names: Sequence[str]) -> frozenset[tuple[int, int, str]]:
    """Arcs as (resting robot, driving robot, where it rests)."""
    index = {name: i for i, name in enumerate(names)}
    places = set()
    for arc in arcs:
        resting, driving = (arc.first, arc.then) if arc.at == "start" else (arc.then, arc.first)
        places.add((index[resting], index[driving], arc.at))
    return frozenset(places)


def plan_in_order(
    scene: Scene,
    order: Sequence[int],
    done: Callable[[int], None],
    time_is_up: Callable[[], bool] = lambda: False,
    *,
    profile: str = "fastest",
) -> dict[int, Timing]:
    """A profile for every robot, each against those before it in an order that respects the blocking arcs.

    Parameters
    ----------
    done : called after each robot with the number of robots that have a profile.
    time_is_up : asked before each robot.
    profile : "fastest" or "gentle", as in ``time_robot``.

    Raises
    ------
    NoPlanError
        When the time is up.
    """
    timings: dict[int, Timing] = {}
    for i in order:
        if time_is_up():
            raise NoPlanError([diagnose.time_is_up(len(timings), len(order))])
        meetings = scene.meetings(i, [k for k in scene.neighbours[i] if k in timings], timings)
        is_last = all(k in timings for k in scene.neighbours[i])
        found = _timing(scene.egos[i], meetings, is_last=is_last, profile=profile)
        timings[i] = found or _waiting(scene.egos[i], meetings)
        done(len(timings))
    return timings


def _timing(ego: Ego, meetings: list[Meeting], *, is_last: bool, profile: str) -> Timing | None:
    """The profile that the timing stage finds; None where it finds none, or a library fails it."""
    try:
        return time_robot(ego, meetings, is_last=is_last, profile=profile)
    except SolverError:
        return None


def _waiting(ego: Ego, meetings: list[Meeting]) -> Timing:
    """Wait at the start until all that come near have arrived, then drive alone: with acyclic blocks always possible.

    Nobody who rests at its goal by then is in the way, since it would come later in the order; and the robot itself
    is in nobody's way while it waits, since it would come earlier. So this needs no check but the certificate.
    """
    last = max((meeting.profile.arrival for meeting in meetings), default=0.0)
    alone = ego.alone.shifted(max(last - ego.alone.departure, 0.0))
    return Timing(alone, tuple(sorted({meeting.other for meeting in meetings})), (), "waited")
