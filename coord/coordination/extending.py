"""One more robot: those that a plan lacks are planned after all that it has, whose motion stays as it is.

Nobody makes way for a robot that comes last. Where its start lies on somebody's path, it has to leave in time; where
somebody's goal lies on its own, it has to pass before that robot parks there, or go round. So unlike in a full run
there may be no plan although an order would bring everybody home: then it is told what is in the way.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from coord.alone.inverse import time_at
from coord.conflicts.core import conflict_core
from coord.conflicts.rest import closest
from coord.coordination import diagnose, joining
from coord.coordination.blocking import Block, arc_of, in_order, place_of, whose_place
from coord.coordination.company import Company
from coord.coordination.kept import Kept
from coord.coordination.order import topological_order, urgency
from coord.coordination.prioritised import timing, waiting
from coord.coordination.records import plan_with, record_of, reroute_record, unopened
from coord.coordination.rerouting import Rerouting, without_rings
from coord.coordination.way_round import Rests, rests, way_round
from coord.errors import InvalidValueError, NoPlanError
from coord.model.options import Options
from coord.model.problem import Problem
from coord.model.result import Diagnosis, Plan, Reroute
from coord.model.route import Route
from coord.paths.routes import find_routes
from coord.timing.ego import Ego, ego
from coord.timing.meeting import first_run_into
from coord.timing.passing import Timing
from coord.timing.ties import equally_early


@dataclass(frozen=True, slots=True, eq=False)
class _Joined:
    """A robot on one route, after all who have a profile.

    Parameters
    ----------
    timing : None where it finds no time to drive on this route.
    blocks : between it and everybody near, but for ``late`` : those by which others with a profile should come later.
    """

    i: int
    route: Route
    ego: Ego
    timing: Timing | None
    blocks: tuple[Block, ...]
    late: tuple[Block, ...]

    @property
    def own(self) -> frozenset[Block]:
        """The places of others that its path runs over."""
        return frozenset(block for block in (*self.blocks, *self.late) if block.driving == self.i)


def extended(
    kept: Kept,
    options: Options,
    progress: Callable[[str, int, int], None] = lambda stage, done, total: None,
    time_is_up: Callable[[], bool] = lambda: False,
) -> Plan:
    """A plan in which some robots move as before, and the others were planned after them.

    The arcs of its blocking graph are those that this order respects: somebody who left its start in time, or passed
    a goal before another parked there, was not planned before that other.

    Parameters
    ----------
    progress : called with a stage's name, how much of it is done, and how much there is.
    time_is_up : asked before each robot.

    Raises
    ------
    NoPlanError
        When some of the others find no way, block each other in a ring, or cannot join those that are kept; or when
        the time is up.
    InvalidValueError
        When the method knows nobody who is planned later.
    """
    if options.method == "nearest":
        text = 'a plan is extended by robots that come after all others: method "nearest" has no such order'
        raise InvalidValueError([("method", f'{text}; take "velocity" or "stop"')])

    def check_time() -> None:
        if time_is_up():
            raise NoPlanError([diagnose.time_is_up(len(parts), len(problem.robots))])

    problem, parts, blocks = kept.problem, dict(kept.parts), list(kept.blocks)
    rerouted: list[Reroute] = []
    failed: list[Diagnosis] = []
    if not kept.anew:
        return plan_with(problem, parts, sorted(blocks, key=in_order), rerouted)
    ways = _ways(kept, options, progress, check_time)
    company = _company(kept, ways)
    known, names = cache(lambda: rests(problem)), [robot.name for robot in problem.robots]
    for j in ways.order:
        check_time()
        i = ways.index[j]
        first = _on(company, i, ways.opened.routes[j], options)
        best = _best(company, first, known, options)
        if best.timing is None:
            failed.append(_cannot_join(company, first, options))
            continue
        rerouted += ways.told(j) if best is first else [_round(problem, first, best, ways.quickest[j])]
        blocks += [block for block in best.blocks if block.first in company.profiles or block.then in company.profiles]
        company.take(i, best.route.path, best.timing.profile)
        parts[i] = record_of(problem.robots[i], ways.quickest[j], best.ego, best.timing, names)
        progress("velocities", len(parts) - len(kept.parts), len(ways.index))
    if failed:
        raise NoPlanError(failed)
    return plan_with(problem, parts, sorted(blocks, key=in_order), rerouted)


@dataclass(frozen=True, slots=True, eq=False)
class _Ways:
    """Those who join, as a problem of their own, on routes on which they do not block each other in rings.

    ``index`` : of each in the whole problem; ``order`` : in which they join; ``quickest`` : before any re-routing.
    """

    among: Problem
    index: tuple[int, ...]
    quickest: Sequence[Route]
    opened: Rerouting
    order: Sequence[int]

    def told(self, j: int) -> list[Reroute]:
        """What is to be said where one was re-routed for the sake of the others who join."""
        if j not in self.opened.around:
            return []
        return [reroute_record(self.among, self.quickest[j], self.opened, j)]


def _ways(
    kept: Kept,
    options: Options,
    progress: Callable[[str, int, int], None],
    check_time: Callable[[], None],
) -> _Ways:
    """Routes of those who are planned anew, and their order: by urgency, as far as they do not block each other."""
    problem, index = kept.problem, tuple(kept.anew)
    among = dataclasses.replace(problem, robots=tuple(problem.robots[i] for i in index))
    quickest = find_routes(among, options.shape, lambda done: progress("paths", done, len(index)))
    opened = without_rings(
        among,
        quickest,
        options.shape,
        keep_paths=options.keep_paths,
        done=lambda done, rings: progress("ways round", done, rings),
        check_time=check_time,
    )
    if opened.left:
        told = unopened(among, opened, (), keep_paths=options.keep_paths)
        raise NoPlanError(dataclasses.replace(ring, remedy=f"{joining.ANEW}. {ring.remedy}") for ring in told)
    robots = among.robots
    arrivals = [route.time + robot.release for route, robot in zip(opened.routes, robots, strict=True)]
    urgent = urgency([robot.priority for robot in robots], arrivals)
    arcs = [arc_of(robots, block) for block in opened.blocks]
    order = topological_order(urgent, [robot.name for robot in robots], arcs)
    if order is None:
        raise RuntimeError("robots block each other in a ring although all rings were opened")
    return _Ways(among, index, quickest, opened, order)


def _company(kept: Kept, ways: _Ways) -> Company:
    """Everybody: those who are kept with their profiles, and those who join on the routes they have so far."""
    paths = {i: part.path for i, part in kept.parts.items()}
    paths |= {i: route.path for i, route in zip(ways.index, ways.opened.routes, strict=True)}
    profiles = {i: part.profile for i, part in kept.parts.items()}
    return Company(kept.problem, [paths[i] for i in range(len(paths))], profiles)


def _on(company: Company, i: int, route: Route, options: Options) -> _Joined:
    """A robot on a route: its profile against all who have one."""
    one = ego(company.problem.robots[i], route.path, route.alone)
    near = company.near(i, route.path)
    blocks = company.blocks(i, route.path, near)
    late = tuple(block for block in blocks if block.first == i and block.then in company.profiles)
    meetings = company.meetings(i, route.path, near, blocks)
    found = timing(
        one,
        meetings,
        profile=options.profile,
        method=options.method,
        certify=options.certify,
    )
    is_last = options.method == "velocity" and all(k in company.profiles for k in near)
    if found is not None and found.how == "start delay" and is_last:
        found = next(iter(equally_early(one, meetings, found)), found)
    if not late:
        found = found or waiting(one, meetings)
    elif found is not None and first_run_into(meetings, found.profile) is not None:
        found = None  # no order promises that waiting helps
    return _Joined(i, route, one, found, tuple(block for block in blocks if block not in late), late)


def _best(company: Company, first: _Joined, known: Callable[[], Rests], options: Options) -> _Joined:
    """A robot on the route that it has; where it finds no time there, round the goals on it; else round all that rest.

    To go round as well where it need not was measured to gain as often as it loses, for twice the time.
    """
    if first.timing is not None or options.keep_paths or company.problem.robots[first.i].path:
        return first
    robots, clearance = company.problem.robots, company.problem.workspace.clearance
    movable = frozenset(block for block in first.own if not whose_place(block, robots, clearance))
    parked = movable.intersection(first.late)
    for gone in (parked, movable) if movable > parked else (movable,):
        way = way_round(known(), first.i, first.route, first.own - gone, options.shape) if gone else None
        found = None if way is None else _on(company, first.i, way.route, options)
        if found is not None and found.timing is not None:
            return found
    return first


def _round(problem: Problem, first: _Joined, best: _Joined, quickest: Route) -> Reroute:
    """What going round others at rest has changed for a robot."""
    robots, route = problem.robots, best.route
    around = sorted(first.own - best.own, key=in_order)
    extra = route.time - quickest.time
    text = joining.gone_round(robots[first.i].name, [(robots[block.resting].name, block.at) for block in around], extra)
    arcs = tuple(arc_of(robots, block) for block in around)
    return Reroute(robots[first.i].name, (), arcs, route.path.length - quickest.path.length, extra, text)


def _cannot_join(company: Company, first: _Joined, options: Options) -> Diagnosis:
    """Why a robot cannot come last: who would have to make way for it, where and when."""
    robots, name = company.problem.robots, company.problem.robots[first.i].name
    reasons = []
    for block in first.late:
        if block.driving == first.i:
            other, when = robots[block.resting], company.profiles[block.resting].arrival
        else:
            other, when = robots[block.driving], _passing(company, block)
        reasons.append((other.name, block.at, place_of(robots, block), when))
    may_go_round = not (options.keep_paths or robots[first.i].path)
    return joining.cannot_join(name, sorted(reasons, key=lambda reason: reason[3]), may_go_round=may_go_round)


def _passing(company: Company, block: Block) -> float:
    """When [s] the driving robot of a block is closest to the place."""
    robots, path = company.problem.robots, company.paths[block.driving]
    core = conflict_core(robots[block.driving].footprint.core, robots[block.resting].footprint.core)
    _, s = closest(path, place_of(robots, block), core)
    return float(time_at(company.profiles[block.driving], np.array([s]))[0])
