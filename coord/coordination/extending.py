"""One more robot: those that a plan lacks are planned after all that it has, whose motion stays as it is.

Nobody makes way for a robot that comes last. Where its start lies on somebody's path, it has to leave in time, if need
be to a place aside; where somebody's goal lies on its own, it has to pass before that robot parks there, or go round.
So unlike in a full run there may be no plan although an order would bring everybody home: then it is told what is in
the way.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from coord.coordination import diagnose, joining
from coord.coordination.aside import ways_aside
from coord.coordination.blocking import Block, arc_of, in_order, place_of, whose_place
from coord.coordination.company import Company
from coord.coordination.kept import Kept
from coord.coordination.latecomer import Joined, comes_too_late, joined, passing
from coord.coordination.order import topological_order, urgency
from coord.coordination.records import plan_with, record_of, reroute_record, unopened
from coord.coordination.rerouting import Rerouting, without_rings
from coord.coordination.way_round import Rests, Way, rests, way_round
from coord.errors import InvalidValueError, NoPlanError
from coord.model.options import Options
from coord.model.problem import Problem
from coord.model.result import Diagnosis, Plan, Reroute
from coord.model.route import Route
from coord.paths.routes import find_routes


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
        first = joined(company, i, ways.opened.routes[j], options)
        best, passers = _best(company, first, known, options)
        if best.timing is None:
            failed.append(_cannot_join(company, first, options))
            continue
        rerouted += ways.told(j) if best is first else [_told(company, first, best, passers, ways.quickest[j])]
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


def _best(
    company: Company, first: Joined, known: Callable[[], Rests], options: Options
) -> tuple[Joined, Sequence[Block]]:
    """A robot on the route that it has; where it finds no time there, on the first of its other ways where it does.

    And who passes its start, where it goes aside for them. To take another way as well where it need not was measured
    to gain as often as it loses, for twice the time.
    """
    if first.timing is not None or options.keep_paths or company.problem.robots[first.i].path:
        return first, ()
    if any(comes_too_late(company, first.i, block) for block in first.late if block.resting == first.i):
        return first, ()
    for way, passers in _other_ways(company, first, known, options.shape):
        found = _on_way(company, first, way, options)
        if found.timing is not None:
            return found, passers
    return first, ()


def _other_ways(
    company: Company, first: Joined, known: Callable[[], Rests], shape: str
) -> Iterator[tuple[Way, Sequence[Block]]]:
    """Ways round the goals on a robot's route, and round all that rest; where some pass its start, ways aside for them.

    These come first where it is sure that it cannot be ahead of one of them, on its route at least.
    """
    robots, clearance = company.problem.robots, company.problem.workspace.clearance
    movable = frozenset(block for block in first.own if not whose_place(block, robots, clearance))
    passers = tuple(block for block in first.late if block.resting == first.i)
    is_chased = any(block in first.shut for block in passers)

    def aside() -> Iterator[tuple[Way, Sequence[Block]]]:
        ways = ways_aside(company, known(), first.route, passers, first.own - movable, shape) if passers else ()
        return ((way, passers) for way in ways)

    if is_chased:
        yield from aside()
    parked = movable.intersection(first.late)
    for gone in (parked, movable) if movable > parked else (movable,):
        way = way_round(known(), first.i, first.route, first.own - gone, shape) if gone else None
        if way is not None:
            yield way, ()
    if not is_chased:
        yield from aside()


def _on_way(company: Company, first: Joined, way: Way, options: Options) -> Joined:
    """A robot on another way; who passes its own places is the same on all of them."""
    passing_by = (block for block in (*first.blocks, *first.late) if block.resting == first.i)
    return joined(company, first.i, way.route, options, sorted((*way.blocks, *passing_by), key=in_order))


def _told(company: Company, first: Joined, best: Joined, passers: Sequence[Block], quickest: Route) -> Reroute:
    """What another way has changed for a robot: whom it goes round, and for whom it goes aside."""
    robots, route, name = company.problem.robots, best.route, company.problem.robots[first.i].name
    around = sorted(first.own - best.own, key=in_order)
    places = [(robots[block.resting].name, block.at) for block in around]
    extra = route.time - quickest.time
    if passers:
        when = sorted((passing(company, block)[0], robots[block.driving].name) for block in passers)
        text = joining.gone_aside(name, [(other, at) for at, other in when], places, extra)
    else:
        text = joining.gone_round(name, places, extra)
    arcs = tuple(arc_of(robots, block) for block in around)
    return Reroute(name, (), arcs, route.path.length - quickest.path.length, extra, text)


def _cannot_join(company: Company, first: Joined, options: Options) -> Diagnosis:
    """Why a robot cannot come last: who would have to make way for it, where and when."""
    robots, name = company.problem.robots, company.problem.robots[first.i].name
    reasons = []
    for block in first.late:
        if block.driving == first.i:
            other, when = robots[block.resting], company.profiles[block.resting].arrival
        else:
            other, when = robots[block.driving], passing(company, block)[0]
        reasons.append((other.name, block.at, place_of(robots, block), when))
    may_go_round = not (options.keep_paths or robots[first.i].path)
    return joining.cannot_join(name, sorted(reasons, key=lambda reason: reason[3]), may_go_round=may_go_round)
