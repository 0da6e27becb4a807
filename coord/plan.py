"""The method in one file: paths first, then who meets whom, then one velocity profile after the other."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.coordination import diagnose
from coord.coordination.blocking import blocking_arcs
from coord.coordination.order import shortest_cycle, topological_order, urgency
from coord.coordination.prioritised import Scene, blocked_places, plan_in_order
from coord.errors import InvalidValueError, NoPlanError
from coord.model.options import Options
from coord.model.problem import Problem
from coord.model.result import Clearance, Diagnosis, Plan, Result, RobotPlan
from coord.output.plan_file import serialise
from coord.paths.routes import find_routes
from coord.timing.ego import ego
from coord.verify import Report, verify

#: Called with a stage's name, how much of it is done, and how much there is.
Progress = Callable[[str, int, int], None]


def plan(problem: Problem, options: Options | None = None, progress: Progress | None = None) -> Result:
    """Plan the motion of all robots of a problem, and certify the plan.

    First every robot gets a path, the shortest round the obstacles. Then the robots get their velocity
    profiles, one after the other in an order that respects who blocks whom, each the quickest that is found
    against those before it. The plan is written out and verified, by the independent checker, as the very
    bytes that are handed back.

    Returns
    -------
    Result
        With a plan and ``certified`` true; or without a plan and with diagnoses that say why; or, should the
        checker refuse what the planner made, with the plan, ``certified`` false and the checker's findings.

    Raises
    ------
    InvalidValueError
        When the problem asks for something that is not supported yet.
    """
    began = time.perf_counter()
    options = options or Options()
    if problem.workspace.after_arrival != "stay":
        raise InvalidValueError(
            [("after_arrival", f'after_arrival "{problem.workspace.after_arrival}" is not supported yet')]
        )

    def time_is_up() -> bool:
        return options.time_limit is not None and time.perf_counter() - began > options.time_limit

    try:
        found = _planned(problem, options, progress or (lambda stage, done, total: None), time_is_up)
    except NoPlanError as failure:
        seconds = time.perf_counter() - began
        return Result(problem, None, False, diagnoses=failure.diagnoses, stopped="no plan", seconds=seconds)
    document = serialise(found)
    report = verify(document)
    return _result(problem, found, document, report, time.perf_counter() - began)


def _planned(problem: Problem, options: Options, progress: Progress, time_is_up: Callable[[], bool]) -> Plan:
    """The stages in order: paths, alone, conflicts, order, timing."""
    robots, clearance = problem.robots, problem.workspace.clearance
    names = [robot.name for robot in robots]
    routes = find_routes(problem, options.shape, lambda done: progress("paths", done, len(robots)))
    paths = [route.path for route in routes]
    egos = []
    for robot, route in zip(robots, routes, strict=True):
        egos.append(ego(robot, route.path, route.alone))
        progress("alone", len(egos), len(robots))

    chains = [chords(path) for path in paths]
    pairs = candidate_pairs(chains, [robot.footprint.radius + clearance / 2 for robot in robots])
    arcs = blocking_arcs(robots, paths, pairs, clearance)
    urgent = urgency([robot.priority for robot in robots], [one.alone.arrival for one in egos])
    order = topological_order(urgent, names, arcs)
    if order is None:
        raise NoPlanError([diagnose.cycle(shortest_cycle(names, arcs))])

    neighbours: list[list[int]] = [[] for _ in robots]
    for i, k in pairs:
        neighbours[i].append(k)
        neighbours[k].append(i)
    scene = Scene(egos, chains, neighbours, blocked_places(arcs, names), clearance)
    timings = plan_in_order(scene, order, lambda done: progress("velocities", done, len(robots)), time_is_up)

    records = tuple(
        RobotPlan(
            robot,
            egos[i].path,
            timings[i].profile,
            solo_arrival=egos[i].alone.arrival,
            solo_bound=egos[i].solo_bound,
            lower_bound=egos[i].solo_bound,
            after=tuple(names[k] for k in timings[i].after),
            before=tuple(names[k] for k in timings[i].before),
            how=timings[i].how,
        )
        for i, robot in enumerate(robots)
    )
    bound = math.fsum(one.solo_bound for one in egos)
    return Plan(problem, records, tuple(names[i] for i in order), tuple(arcs), bound, "solo_bound")


def _result(problem: Problem, found: Plan, document: bytes, report: Report, seconds: float) -> Result:
    least = report.min_clearance
    clearance = None if least is None else Clearance(least.value, least.robots, least.time)
    remedy = "This is a defect of coord: please report it."
    diagnoses = tuple(
        Diagnosis("not-certified", tuple(fault.robots), fault.text, remedy=remedy) for fault in report.faults
    )
    return Result(problem, found, report.certified, document, clearance, diagnoses, "done", seconds)
