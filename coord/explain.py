"""The story before planning: every robot's way and what the other side would cost, who meets whom, who goes first.

The stages are those of ``coord.plan``, in the same order, up to the first velocity profile. Where one of them
finds that there can be no plan, the story goes on as far as it can and carries the diagnosis.
"""

from __future__ import annotations

import dataclasses
from bisect import bisect_left, insort
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import Chords, chords
from coord.conflicts.core import conflict_core
from coord.conflicts.region import ConflictRegion, conflict_regions
from coord.coordination.blocking import arc_of, reaches_of
from coord.coordination.order import order_of_groups, urgency
from coord.coordination.records import reroute_record
from coord.coordination.settled import settle
from coord.errors import NoPlanError
from coord.geometry.clusters import names_of
from coord.geometry.growth import Grown, grow
from coord.model.arrays import Point
from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.path import Path
from coord.model.problem import Problem
from coord.model.result import BlockingArc, Diagnosis, Reroute
from coord.model.robot import Robot
from coord.model.route import Route
from coord.paths.routes import find_routes
from coord.paths.skeleton import search_floor

#: [m] Places of a meeting whose distances differ by less are equally close: the one in the middle is told.
_AS_CLOSE = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Trip:
    """What one robot does alone.

    ``quickest`` : None where it has no way, and ``diagnosis`` says why; ``route`` : the one it takes, which is another
    where it was re-routed; ``past`` : names of the obstacles on its straight line, leg by leg where it has places to
    pass, empty where nothing stands there.
    """

    robot: Robot
    quickest: Route | None
    route: Route | None
    past: tuple[str, ...] = ()
    diagnosis: Diagnosis | None = None

    @property
    def arrival(self) -> float | None:
        """Arrival [s] on its route with nobody else on the floor, release included; None without a way."""
        return None if self.route is None else self.route.alone.shifted(self.robot.release).arrival


@dataclass(frozen=True, slots=True)
class Encounter:
    """Two robots whose paths come nearer than they may: one connected part of their collision region.

    ``place`` [m] : in the middle between them where they would be closest; ``stretches`` : from which to which arc
    length [m] of the first and of the second robot's path they can be too near.
    """

    robots: tuple[str, str]
    place: Point
    stretches: tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Deviation:
    """``robot`` goes before ``before`` and ``others`` more, all of them more urgent, because of a chain of arcs.

    The chain leads from ``robot`` to ``before``, the most urgent of them; the others go after that one by their
    own urgency, so they need no arc. It is empty where ``robot`` goes so early because others leave together with it.
    """

    robot: str
    before: str
    others: int
    chain: tuple[BlockingArc, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Explanation:
    """All that is known before the first velocity profile is sought.

    Parameters
    ----------
    trips : in the order of the problem; ``shape`` : the one asked for.
    encounters, arcs : of the robots that have a way, on the routes they take.
    urgent : names, by priority, then the longest alone first, then as given; robots without a way are left out.
    order : names, first planned first; None where there is none, and ``diagnoses`` say why.
    deviations : one for each robot that goes before a more urgent one; ``rerouted`` : who left its quickest route.
    together : groups of robots that stand in each other's way in a ring, and have to leave together.
    """

    problem: Problem
    shape: str
    trips: tuple[Trip, ...]
    encounters: tuple[Encounter, ...]
    arcs: tuple[BlockingArc, ...]
    urgent: tuple[str, ...]
    order: tuple[str, ...] | None
    deviations: tuple[Deviation, ...] = ()
    rerouted: tuple[Reroute, ...] = ()
    together: tuple[tuple[str, ...], ...] = ()
    diagnoses: tuple[Diagnosis, ...] = ()


def explain(
    problem: Problem,
    options: Options | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> Explanation:
    """Tell how a plan would come about; robots without a way and cycles are part of the story, not errors.

    Parameters
    ----------
    options : shape, order and keep_paths are used; the others concern the plan itself.
    progress : called with a stage's name, how much of it is done, and how much there is.
    """
    options = options or Options()
    progress = progress or (lambda stage, done, total: None)
    trips = _trips(problem, options.shape, lambda done: progress("paths", done, len(problem.robots)))
    lost = tuple(trip.diagnosis for trip in trips if trip.diagnosis is not None)
    driving = tuple(trip.robot for trip in trips if trip.quickest is not None)
    if not driving:
        return Explanation(problem, options.shape, trips, (), (), (), None, diagnoses=lost)
    rest = dataclasses.replace(problem, robots=driving)
    quickest = [trip.quickest for trip in trips if trip.quickest is not None]
    settled = settle(
        rest,
        quickest,
        options.shape,
        keep_paths=options.keep_paths,
        done=lambda done, total: progress("ways round", done, total),
    )
    found = settled.found
    taken = {robot.name: route for robot, route in zip(driving, found.routes, strict=True)}
    trips = tuple(dataclasses.replace(trip, route=taken.get(trip.robot.name)) for trip in trips)

    encounters = _all_encounters(rest, found.routes, lambda done, total: progress("meetings", done, total))
    arcs = tuple(arc_of(driving, block) for block in found.blocks)
    names, arrivals = [robot.name for robot in driving], [trip.arrival for trip in trips if trip.arrival is not None]
    urgent = urgency([robot.priority for robot in driving], arrivals)
    order = None if lost or settled.hopeless else order_of_groups(urgent, names, arcs, found.together)
    ordered, wished = None if order is None else tuple(names[i] for i in order), tuple(names[i] for i in urgent)
    return Explanation(
        problem,
        options.shape,
        trips,
        encounters,
        arcs,
        wished,
        ordered,
        () if ordered is None else _deviations(ordered, wished, arcs),
        tuple(reroute_record(rest, quickest[i], found, i) for i in sorted({*found.around, *found.beside})),
        tuple(tuple(names[i] for i in group) for group in found.together),
        (*lost, *settled.hopeless),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Lane:
    """A robot on its path."""

    robot: Robot
    path: Path
    chords: Chords


def _lanes(robots: Sequence[Robot], routes: Sequence[Route]) -> list[_Lane]:
    return [_Lane(robot, one.path, chords(one.path)) for robot, one in zip(robots, routes, strict=True)]


def _trips(problem: Problem, shape: str, done: Callable[[int], None]) -> tuple[Trip, ...]:
    """What every robot does alone, in the order of the problem, before any re-routing."""
    routes, lost = _routes(problem, shape, done)
    grounds: dict[Footprint, Grown] = {}
    trips = []
    for robot in problem.robots:
        route = routes.get(robot.name)
        past = _in_the_way(problem, robot, grounds) if route is not None and route.side else ()
        trips.append(Trip(robot, route, route, past, lost.get(robot.name)))
    return tuple(trips)


def _routes(problem: Problem, shape: str, done: Callable[[int], None]) -> tuple[dict[str, Route], dict[str, Diagnosis]]:
    """Routes by name, both sides compared wherever there are two, and why the other robots have none."""
    try:
        return _by_name(problem, shape, done), {}
    except NoPlanError as failure:
        suspects = {name for diagnosis in failure.diagnoses for name in diagnosis.robots}
    others = tuple(robot for robot in problem.robots if robot.name not in suspects)
    routes: dict[str, Route] = {}
    lost: dict[str, Diagnosis] = {}
    if others:
        routes = _by_name(dataclasses.replace(problem, robots=others), shape, done)
    for robot in (robot for robot in problem.robots if robot.name in suspects):
        # a side that a plan would never look at may be what failed: only the plan's own search tells
        try:
            (routes[robot.name],) = find_routes(dataclasses.replace(problem, robots=(robot,)), shape)
        except NoPlanError as failure:
            lost[robot.name] = failure.diagnoses[0]
    return routes, lost


def _by_name(problem: Problem, shape: str, done: Callable[[int], None]) -> dict[str, Route]:
    found = find_routes(problem, shape, done, thorough=True)
    return {robot.name: route for robot, route in zip(problem.robots, found, strict=True)}


def _in_the_way(problem: Problem, robot: Robot, grounds: dict[Footprint, Grown]) -> tuple[str, ...]:
    """Names of the obstacles on a robot's straight lines from place to place; ``grounds`` remembers grown ones."""
    workspace, shape = problem.workspace, robot.footprint
    if shape not in grounds:
        grounds[shape] = grow(problem.obstacles, shape, workspace.clearance, workspace.bounds)
    places = (robot.start, *robot.via, robot.goal)
    segments = np.array([(*a, *b) for a, b in pairwise(places) if a != b])
    hit = search_floor(grounds[shape], places).hit_parts(segments)[:, 1]
    return tuple(names_of(problem.obstacles, grounds[shape], np.unique(hit)))


def _all_encounters(
    problem: Problem, routes: Sequence[Route], done: Callable[[int, int], None]
) -> tuple[Encounter, ...]:
    """The meetings of all pairs on the routes they take, in the order of the robots."""
    lanes, clearance = _lanes(problem.robots, routes), problem.workspace.clearance
    pairs = candidate_pairs([lane.chords for lane in lanes], reaches_of(problem.robots, clearance))
    encounters: list[Encounter] = []
    for count, pair in enumerate(pairs, 1):
        encounters += _encounters(lanes[pair[0]], lanes[pair[1]], clearance)
        done(count, len(pairs))
    return tuple(encounters)


def _encounters(ego: _Lane, other: _Lane, clearance: float) -> list[Encounter]:
    """All places where a pair can be too near, in the order in which the first of them comes there."""
    shape, beside = ego.robot.footprint, other.robot.footprint
    distance, core = shape.margin + beside.margin + clearance, conflict_core(shape.core, beside.core)
    regions = conflict_regions(ego.chords, other.chords, distance, core)
    return sorted((_encounter(ego, other, region) for region in regions), key=lambda one: one.stretches)


def _encounter(ego: _Lane, other: _Lane, region: ConflictRegion) -> Encounter:
    """A region of the coordination plane, told as a place on the floor and two stretches."""
    sigma = (region.sigma[:-1] + region.sigma[1:]) / 2
    s = np.clip((region.low.mean(axis=1) + region.high.mean(axis=1)) / 2, 0.0, ego.path.length)
    at, beside = ego.path.point(s), other.path.point(sigma)
    apart = np.hypot(*(at - beside).T)
    close = np.flatnonzero(apart <= apart.min() + _AS_CLOSE)
    x, y = (at[close[len(close) // 2]] + beside[close[len(close) // 2]]).tolist()
    first, last = np.clip(region.s_range, 0.0, ego.path.length).tolist()
    begin, end = np.clip(region.sigma[[0, -1]], 0.0, other.path.length).tolist()
    return Encounter((ego.robot.name, other.robot.name), (x / 2, y / 2), ((first, last), (begin, end)))


def _deviations(order: Sequence[str], urgent: Sequence[str], arcs: Sequence[BlockingArc]) -> tuple[Deviation, ...]:
    """Who goes before somebody more urgent, each with the arcs that lead to the most urgent robot after it.

    But for robots that leave together with a more urgent one, there is such a chain: built from the back, the order
    put that most urgent robot b behind robot a because a was not free to go there, so a chain of arcs leads from a to
    a robot that was. That one goes after a and is at least as urgent as b, so it is b.
    """
    rank = {name: position for position, name in enumerate(urgent)}
    chains: dict[str, dict[str, BlockingArc]] = {}
    later: list[int] = []
    found = []
    for name in reversed(order):
        more_urgent = bisect_left(later, rank[name])
        if more_urgent:
            before = urgent[later[0]]
            if before not in chains:
                chains[before] = _towards(before, arcs)
            chain = _chain(name, before, chains[before])
            found.append(Deviation(name, before, more_urgent - 1, chain))
        insort(later, rank[name])
    return tuple(found[::-1])


def _towards(name: str, arcs: Sequence[BlockingArc]) -> dict[str, BlockingArc]:
    """For every robot from which a chain of arcs leads to this one, the first arc of a shortest chain."""
    into: dict[str, list[BlockingArc]] = {}
    for arc in arcs:
        into.setdefault(arc.then, []).append(arc)
    step: dict[str, BlockingArc] = {}
    queue = deque([name])
    while queue:
        for arc in into.get(queue.popleft(), []):
            if arc.first not in step:
                step[arc.first] = arc
                queue.append(arc.first)
    return step


def _chain(first: str, last: str, step: Mapping[str, BlockingArc]) -> tuple[BlockingArc, ...]:
    arcs = [step[first]] if first in step else []
    while arcs and arcs[-1].then != last:
        arcs.append(step[arcs[-1].then])
    return tuple(arcs)
