"""From what the stages found to what a plan says: one record a robot, who was re-routed, the bound."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from coord.coordination import diagnose
from coord.coordination.blocking import Block, arc_of, whose_place
from coord.coordination.passing_by import is_proved_separated
from coord.coordination.rerouting import Rerouting
from coord.model.problem import Problem
from coord.model.result import Diagnosis, Plan, Reroute, RobotPlan
from coord.model.robot import Robot
from coord.model.route import Route
from coord.timing.ego import Ego
from coord.timing.passing import Timing


def plan_of(
    problem: Problem,
    quickest: Sequence[Route],
    found: Rerouting,
    egos: Sequence[Ego],
    order: Sequence[int],
    timings: Mapping[int, Timing],
) -> Plan:
    """The whole plan; ``quickest`` are the routes before any re-routing."""
    names = [robot.name for robot in problem.robots]
    parts = {i: record_of(problem.robots[i], quickest[i], egos[i], timings[i], names) for i in order}
    rerouted = tuple(reroute_record(problem, quickest[i], found, i) for i in sorted({*found.around, *found.beside}))
    return plan_with(problem, parts, found.between, rerouted)


def plan_with(
    problem: Problem, parts: Mapping[int, RobotPlan], blocks: Sequence[Block], rerouted: Sequence[Reroute]
) -> Plan:
    """The plan of these parts, one for each robot, by index, in the order in which they were planned."""
    records = tuple(parts[i] for i in sorted(parts))
    order = tuple(problem.robots[i].name for i in parts)
    arcs = tuple(arc_of(problem.robots, block) for block in blocks)
    bound = math.fsum(part.solo_bound for part in records)
    return Plan(problem, records, order, arcs, bound, "solo_bound", tuple(rerouted))


def record_of(robot: Robot, quickest: Route, ego: Ego, timing: Timing, names: Sequence[str]) -> RobotPlan:
    """One robot's part of a plan; ``names`` : of all robots."""
    return RobotPlan(
        robot,
        ego.path,
        timing.profile,
        # a way found later may happen to be quicker: then that one is the quickest known
        solo_arrival=min(quickest.alone.shifted(robot.release).arrival, ego.alone.arrival),
        solo_bound=ego.solo_bound,
        lower_bound=max(ego.solo_bound, timing.lower_bound),
        after=tuple(names[k] for k in timing.after),
        before=tuple(names[k] for k in timing.before),
        how=timing.how,
    )


def unopened(
    problem: Problem, found: Rerouting, apart: Sequence[tuple[int, int]], *, keep_paths: bool
) -> list[Diagnosis]:
    """For each ring that is left, why its robots cannot come home; ``apart`` : pairs that cannot pass each other."""
    told = []
    for ring, group in zip(found.left, found.together, strict=True):
        arcs = [arc_of(problem.robots, block) for block in ring]
        own = [whose_place(block, problem.robots, problem.workspace.clearance) for block in ring]
        why = [_why(problem.robots[block.driving], which) for block, which in zip(ring, own, strict=True)]
        remedy = diagnose.MOVE if all(own) else diagnose.MAKE_ROOM
        if keep_paths:
            why, remedy = [], diagnose.ALLOW_WAYS_ROUND
        pairs = [pair for pair in apart if set(pair) <= set(group)]
        told.append(diagnose.cycle(arcs, why, remedy, _not_together(problem, found, pairs)))
    return told


def _not_together(problem: Problem, found: Rerouting, apart: Sequence[tuple[int, int]]) -> str:
    """Why the robots of a ring do not come home by leaving together."""
    if not apart:
        return diagnose.NO_DEADLINES
    i, k = apart[0]
    names = (problem.robots[i].name, problem.robots[k].name)
    return diagnose.cannot_pass(names, proved=is_proved_separated(problem, found, i, k))


def _why(driver: Robot, which: str) -> str:
    """Why a robot cannot go round a place: it has a place of its own there, its path is given, or there is no way."""
    if which:
        return diagnose.handed_over(driver.name, which)
    return diagnose.given(driver.name) if driver.path else diagnose.no_way_round(driver.name)


def reroute_record(problem: Problem, before: Route, found: Rerouting, i: int) -> Reroute:
    """What re-routing changed for robot i, whose own route was ``before``."""
    robots, after = problem.robots, found.routes[i]
    name, extra = robots[i].name, after.time - before.time
    blocks, members = found.around.get(i, ((), ()))
    arcs, ring = tuple(arc_of(robots, block) for block in blocks), tuple(robots[k].name for k in members)
    texts = []
    if blocks:
        places = [(robots[block.resting].name, block.at) for block in blocks]
        texts.append(diagnose.rerouted(name, places, [other for other in ring if other != name], extra))
    if i in found.beside:
        rivals = [robots[k].name for k in found.beside[i]]
        ring = tuple(dict.fromkeys((*ring, name, *rivals)))
        texts.append(diagnose.leaves_room(name, rivals, extra))
    return Reroute(name, ring, arcs, after.path.length - before.path.length, extra, " ".join(texts))
