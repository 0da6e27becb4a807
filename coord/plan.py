"""The method in one file: paths first, then who meets whom, then one velocity profile after the other."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable

from coord.coordination import diagnose
from coord.coordination.advice import MOST_LOOKS, advised
from coord.coordination.blocking import arc_of, reaches_of
from coord.coordination.extending import extended
from coord.coordination.kept import Kept
from coord.coordination.nearest import plan_nearest_first
from coord.coordination.order import order_of_groups, urgency
from coord.coordination.prioritised import plan_in_order
from coord.coordination.records import plan_of
from coord.coordination.scene import scene_of
from coord.coordination.settled import settle
from coord.errors import InvalidValueError, NoPlanError
from coord.model.options import Options
from coord.model.problem import Problem
from coord.model.result import Clearance, Diagnosis, Plan, Result
from coord.output.plan_file import serialise
from coord.paths.routes import find_routes
from coord.timing.ego import ego
from coord.verify import Report, verify

#: Called with a stage's name, how much of it is done, and how much there is.
Progress = Callable[[str, int, int], None]


def plan(
    problem: Problem,
    options: Options | None = None,
    progress: Progress | None = None,
    *,
    extend: Kept | None = None,
) -> Result:
    """Plan the motion of all robots of a problem, and certify the plan.

    First every robot gets a path, the quickest round the obstacles; where robots on these paths would block each
    other in a ring, some are sent round the places where others rest. Then the robots get their velocity
    profiles, one after the other in an order that respects who blocks whom, each the quickest that is found
    against those before it. The plan is written out and verified, by the independent checker, as the very
    bytes that are handed back.

    Parameters
    ----------
    progress : called with a stage's name, how much of it is done, and how much there is.
    extend : what holds of a plan, from ``coord.coordination.kept.kept(problem, plan)``: the robots that it names keep
        their motion, and only the others are planned, after them.

    Returns
    -------
    Result
        With a plan and ``certified`` true; or without a plan and with diagnoses that say why; or, should the
        checker refuse what the planner made, with the plan, ``certified`` false and the checker's findings.

    Raises
    ------
    InvalidValueError
        When the outline of an obstacle crosses itself, which the reader of problem files would have told; when
        ``extend`` belongs to another problem.
    """
    began = time.perf_counter()
    options = options or Options()

    def time_is_up() -> bool:
        return options.time_limit is not None and time.perf_counter() - began > options.time_limit

    if extend is not None and extend.problem is not problem:
        raise InvalidValueError([("extend", "extend must be what holds of a plan for this very problem")])
    progress = progress or (lambda stage, done, total: None)
    try:
        if extend is None:
            found = _planned(problem, options, progress, time_is_up)
        else:
            found = extended(extend, options, progress, time_is_up)
    except NoPlanError as failure:
        told = failure.diagnoses
        if extend is None and options.time_limit is None:
            told = advised(problem, told, lambda changed: _works(changed, options))
        seconds = time.perf_counter() - began
        return Result(problem, None, False, diagnoses=told, stopped="no plan", seconds=seconds)
    document = serialise(found)
    report = verify(document)
    return _result(problem, found, document, report, time.perf_counter() - began)


def _works(problem: Problem, options: Options) -> bool:
    """Whether there is a certified plan that takes little search; it is not kept."""
    looks, most = itertools.count(), MOST_LOOKS * len(problem.robots)
    try:
        found = _planned(problem, options, lambda stage, done, total: None, lambda: next(looks) >= most)
    except (NoPlanError, InvalidValueError):
        return False
    return verify(serialise(found)).certified


def _planned(problem: Problem, options: Options, progress: Progress, time_is_up: Callable[[], bool]) -> Plan:
    """The stages in order: paths, who blocks whom, ways round, alone, order, timing."""
    robots, clearance, total = problem.robots, problem.workspace.clearance, len(problem.robots)
    names = [robot.name for robot in robots]

    def check_time() -> None:
        if time_is_up():
            raise NoPlanError([diagnose.time_is_up(0, total)])

    quickest = find_routes(problem, options.shape, lambda done: progress("paths", done, total))
    settled = settle(
        problem,
        quickest,
        options.shape,
        keep_paths=options.keep_paths,
        done=lambda done, rings: progress("ways round", done, rings),
        check_time=check_time,
    )
    if settled.hopeless:
        raise NoPlanError(settled.hopeless)
    found = settled.found

    egos = []
    for robot, route in zip(robots, found.routes, strict=True):
        egos.append(ego(robot, route.path, route.alone))
        progress("alone", len(egos), total)
    urgent = urgency([robot.priority for robot in robots], [one.alone.arrival for one in egos])
    arcs = [arc_of(robots, block) for block in found.blocks]
    order = order_of_groups(urgent, names, arcs, found.together)
    if order is None:
        raise RuntimeError("robots block each other in a ring although none is left outside of groups")
    scene = scene_of(egos, reaches_of(robots, clearance), found.blocks, clearance)

    def show(done: int) -> None:
        progress("velocities", done, total)

    if options.method == "nearest":
        order, timings = plan_nearest_first(scene, names, arcs, show, time_is_up)
    else:
        timings = plan_in_order(
            scene,
            order,
            show,
            time_is_up,
            profile=options.profile,
            method=options.method,
            certify=options.certify,
            together=dict(zip(found.together, settled.otherwise, strict=True)),
            homeward=settled.homeward,
        )
        order = list(timings)
    return plan_of(problem, quickest, found, egos, order, timings)


def _result(problem: Problem, found: Plan, document: bytes, report: Report, seconds: float) -> Result:
    least = report.min_clearance
    clearance = None if least is None else Clearance(least.value, least.robots, least.time)
    remedy = "This is a defect of coord: please report it."
    diagnoses = tuple(
        Diagnosis("not-certified", tuple(fault.robots), fault.text, remedy=remedy) for fault in report.faults
    )
    return Result(problem, found, report.certified, document, clearance, diagnoses, "done", seconds)
