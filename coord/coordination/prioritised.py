"""One robot after the other: each is planned against those before it, which never change any more."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from coord.conflicts.chords import Chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import conflict_regions
from coord.coordination import diagnose
from coord.errors import NoPlanError
from coord.model.result import BlockingArc
from coord.timing.ego import Ego
from coord.timing.meeting import Ends, Meeting, first_violated
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


def blocked_places(arcs: Sequence[BlockingArc], names: Sequence[str]) -> frozenset[tuple[int, int, str]]:
    """Arcs as (resting robot, driving robot, where it rests)."""
    index = {name: i for i, name in enumerate(names)}
    places = set()
    for arc in arcs:
        resting, driving = (arc.first, arc.then) if arc.at == "start" else (arc.then, arc.first)
        places.add((index[resting], index[driving], arc.at))
    return frozenset(places)


def plan_in_order(
    scene: Scene, order: Sequence[int], done: Callable[[int], None], time_is_up: Callable[[], bool] = lambda: False
) -> dict[int, Timing]:
    """A profile for every robot, each against those before it in the order.

    Parameters
    ----------
    done : called after each robot with the number of robots that have a profile.
    time_is_up : asked before each robot.

    Raises
    ------
    NoPlanError
        When the time is up, or a robot stays blocked for ever, which an order that respects the blocking arcs
        excludes.
    """
    timings: dict[int, Timing] = {}
    for i in order:
        if time_is_up():
            raise NoPlanError([diagnose.time_is_up(len(timings), len(order))])
        meetings = scene.meetings(i, [k for k in scene.neighbours[i] if k in timings], timings)
        is_last = all(k in timings for k in scene.neighbours[i])
        timing = time_robot(scene.egos[i], meetings, is_last=is_last)
        if timing is None:
            ego = scene.egos[i]
            late = ego.alone.shifted(max(timings[k].profile.arrival for k in timings))
            violated = first_violated(meetings, late)
            others = [] if violated is None else [scene.egos[meetings[violated[0]].other].robot.name]
            raise NoPlanError([diagnose.stuck(ego.robot.name, others, ego.robot.start)])
        timings[i] = timing
        done(len(timings))
    return timings
