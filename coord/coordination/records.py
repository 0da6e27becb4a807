"""From what the stages found to what a plan says: one record a robot, who was re-routed, the bound."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from coord.coordination import diagnose
from coord.coordination.blocking import arc_of, whose_place
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
    records = tuple(
        RobotPlan(
            robot,
            egos[i].path,
            timings[i].profile,
            # a way found later may happen to be quicker: then that one is the quickest known
            solo_arrival=min(quickest[i].alone.shifted(robot.release).arrival, egos[i].alone.arrival),
            solo_bound=egos[i].solo_bound,
            lower_bound=max(egos[i].solo_bound, timings[i].lower_bound),
            after=tuple(names[k] for k in timings[i].after),
            before=tuple(names[k] for k in timings[i].before),
            how=timings[i].how,
        )
        for i, robot in enumerate(problem.robots)
    )
    bound = math.fsum(one.solo_bound for one in egos)
    arcs = tuple(arc_of(problem.robots, block) for block in found.blocks)
    rerouted = tuple(reroute_record(problem, quickest[i], found, i) for i in found.around)
    return Plan(problem, records, tuple(names[i] for i in order), arcs, bound, "solo_bound", rerouted)


def unopened(problem: Problem, found: Rerouting, *, keep_paths: bool) -> list[Diagnosis]:
    """One diagnosis for each ring that is left, with the reasons why no way round opens it."""
    told = []
    for ring in found.left:
        arcs = [arc_of(problem.robots, block) for block in ring]
        if keep_paths:
            told.append(diagnose.cycle(arcs, remedy=diagnose.ALLOW_WAYS_ROUND))
            continue
        own = [whose_place(block, problem.robots, problem.workspace.clearance) for block in ring]
        why = [_why(problem.robots[block.driving], which) for block, which in zip(ring, own, strict=True)]
        told.append(diagnose.cycle(arcs, why, diagnose.MOVE if all(own) else diagnose.MAKE_ROOM))
    return told


def _why(driver: Robot, which: str) -> str:
    """Why a robot cannot go round a place: it has a place of its own there, its path is given, or there is no way."""
    if which:
        return diagnose.handed_over(driver.name, which)
    return diagnose.given(driver.name) if driver.path else diagnose.no_way_round(driver.name)


def reroute_record(problem: Problem, before: Route, found: Rerouting, i: int) -> Reroute:
    """What re-routing changed for robot i, whose own route was ``before``."""
    blocks, members = found.around[i]
    robots, after = problem.robots, found.routes[i]
    name, arcs = robots[i].name, tuple(arc_of(robots, block) for block in blocks)
    ring = tuple(robots[k].name for k in members)
    extra = after.time - before.time
    places = [(robots[block.resting].name, block.at) for block in blocks]
    text = diagnose.rerouted(name, places, [other for other in ring if other != name], extra)
    return Reroute(name, ring, arcs, after.path.length - before.path.length, extra, text)
