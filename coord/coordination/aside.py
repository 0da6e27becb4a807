"""Out of the way first: places beside the lane of somebody who passes a robot's start before it can drive off.

Where it may not be ahead of the other all the way, a robot that comes last can still let it pass: it leaves its start
for a place beside the other's lane, waits there if need be, and goes on.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from coord.alone.fastest import fastest
from coord.conflicts.chords import chords
from coord.conflicts.rest import closest
from coord.coordination.blocking import Block, is_near
from coord.coordination.company import Company
from coord.coordination.way_round import Rests, Way, way_round
from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.geometry.growth import grow
from coord.model.arrays import Array, Point, frozen
from coord.model.path import Path, straight
from coord.model.robot import Robot
from coord.model.route import Route

#: [m] A place beside a lane keeps so much more than the distance from it, so that there is room to stop.
_ROOM = 0.1

#: Directions from the start and distances, in units of what two robots need, in which places are sought; of these so
#: many are tried.
_DIRECTIONS, _DISTANCES, _MOST_TRIES = 16, (1.0, 1.25, 1.5, 2.0), 8

#: Times that differ in later digits [s] only are the same, so that rounding decides nothing.
_DIGITS = 6

#: [rad] Places where it would have to turn by more than this lead too far about; a path up to there, and on to where
#: it is that of the way from there, is at most so many times as long as the straight line.
_MOST_TURN, _HEAD = 2.2, 3.0

#: [rad] Turns smaller than this are none.
_NO_TURN = 1e-12

#: Of the shorter line at a corner these shares are cut, the larger one where there is room for it.
_CUTS = (0.8, 0.4)


def ways_aside(
    company: Company, known: Rests, route: Route, passers: Sequence[Block], allowed: frozenset[Block], shape: str
) -> Iterator[Way]:
    """Ways of a robot that first lead it to a place beside the lanes of those who pass its start.

    Parameters
    ----------
    route : that it has so far.
    passers : its start on the paths of others who have a profile.
    allowed : places of others that it may run over.
    """
    i, problem = passers[0].resting, company.problem
    robot = problem.robots[i]
    if robot.path or robot.via or robot.side != "quickest" or robot.start == robot.goal:
        return  # its way is asked for, or it stays
    grown = grow(problem.obstacles, robot.footprint, problem.workspace.clearance, problem.workspace.bounds)
    floor = Floor(grown, grown.rho)
    for place in _places(company, known, passers, floor)[:_MOST_TRIES]:
        way = _way_by(known, i, route, allowed, shape, place, floor)
        if way is not None:
            yield way


def _way_by(
    known: Rests, i: int, route: Route, allowed: frozenset[Block], shape: str, place: Point, floor: Floor
) -> Way | None:
    """The way to a place and the way on from it, made one; found several times as quickly as a way past the place."""
    robot = known.problem.robots[i]
    if floor.is_hit(np.array([[*robot.start, *place]]), np.zeros(1))[0]:
        there = way_round(_with(known, i, dataclasses.replace(robot, goal=place)), i, route, allowed, shape)
        head = None if there is None else there.route.path
    else:
        head = straight(robot.start, place)
    if head is None:
        return None
    on = way_round(_with(known, i, dataclasses.replace(robot, start=place)), i, route, allowed, shape)
    for path in () if on is None else joined_up(head, on.route.path):
        if keeps_distance(floor, path, last=_HEAD * head.length):
            blocks = frozenset(known.blocks(path, i))
            if blocks <= allowed:
                return Way(Route(path, fastest(path, robot.limits), "fitted", "", path.length), blocks)
    return None


def _with(known: Rests, i: int, robot: Robot) -> Rests:
    """The same with another robot i, which rests nowhere else."""
    robots = (*known.problem.robots[:i], robot, *known.problem.robots[i + 1 :])
    return dataclasses.replace(known, problem=dataclasses.replace(known.problem, robots=robots))


def joined_up(head: Path, path: Path) -> Iterator[Path]:
    """One path after another that ends where it begins: by an arc instead of the first, or with the corner cut.

    An arc takes the place of a straight line only; a corner is cut where both are straight there. There is no such path
    where it would turn too far about.
    """
    if not len(head.pieces) or not len(path.pieces):
        return
    turn = math.remainder(path.start[2] - float(head.poses[-1, 2]), 2 * math.pi)
    (way, *bent), (first, *bends) = head.pieces[-1].tolist(), path.pieces[0].tolist()
    before, behind = head.pieces[:-1].tolist(), path.pieces[1:].tolist()
    if abs(turn) > _MOST_TURN:
        return
    if abs(turn) < _NO_TURN:
        yield _path(head.start, [*head.pieces.tolist(), *path.pieces.tolist()])
        return
    if not any(bent) and not before:
        x, y, heading = head.start
        length = way * turn / math.sin(turn)
        arc = (length, 2 * turn / length, 2 * turn / length)
        yield _path((x, y, heading - turn), [arc, *path.pieces.tolist()])
    for cut in (min(way, first) * share for share in _CUTS if not any((*bent, *bends))):
        bend = math.tan(turn / 2) / cut
        corner = [(way - cut, 0.0, 0.0), (turn / bend, bend, bend), (first - cut, 0.0, 0.0)]
        yield _path(head.start, [*before, *corner, *behind])


def _path(start: tuple[float, float, float], pieces: Sequence[Sequence[float]]) -> Path:
    return Path(start, frozen(pieces, 3))


def _places(company: Company, known: Rests, passers: Sequence[Block], floor: Floor) -> list[Point]:
    """Places on a floor clear of those lanes and of all who rest, first those for which it crosses the fewest lanes."""
    i = passers[0].resting
    robots, clearance = company.problem.robots, company.problem.workspace.clearance
    robot, own = robots[i], robots[i].footprint.radius
    reaches = [own + robots[block.driving].footprint.radius + clearance + _ROOM for block in passers]
    places = _round(robot.start, max(reaches))
    others = known.used.copy()
    others[[2 * i, 2 * i + 1]] = False
    apart = np.hypot(*np.moveaxis(places[:, None] - known.places[others], 2, 0))
    is_free = (apart >= known.reaches[others] + own).all(axis=1)
    xmin, ymin, xmax, ymax = floor.grown.box
    is_free &= ((places >= (xmin, ymin)) & (places <= (xmax, ymax))).all(axis=1)
    is_free &= ~floor.is_hit(np.hstack([places, places]), np.zeros(len(places)))
    crossed = np.zeros(len(places), dtype=np.intp)
    for block, reach in zip(passers, reaches, strict=True):
        lane = company.paths[block.driving]
        is_free &= ~is_near(chords(lane), places, np.full(len(places), reach))
        crossed += _sides(lane, places, robot.start) != _sides(lane, np.array([robot.start]), robot.start)
    times = np.round(_times(robot, places), _DIGITS)
    order = [k for k in np.lexsort((times, crossed)).tolist() if is_free[k]]
    return [(x, y) for x, y in places[order].tolist()]


def _round(start: Point, distance: float) -> Array:
    """Places (n, 2) [m] about a start, at some multiples of a distance [m]."""
    angles = 2 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    return np.concatenate([np.array(start) + share * distance * ring for share in _DISTANCES])


def _times(robot: Robot, places: Array) -> Array:
    """About how long (n,) [s] the ways through places (n, 2) take; infinite where it would have to turn back."""
    first, last = places - robot.start, np.array(robot.goal) - places
    turn = np.arctan2(last[:, 1], last[:, 0]) - np.arctan2(first[:, 1], first[:, 0])
    turn = np.abs(turn - 2 * math.pi * np.round(turn / (2 * math.pi)))
    arcs = np.hypot(*first.T) / np.sinc(np.minimum(turn, _MOST_TURN) / math.pi)  # numpy's sinc(x) is sin(pi x)/(pi x)
    limits = robot.limits
    speed = np.minimum(limits.speed, np.sqrt(limits.lateral_acceleration * arcs / np.maximum(2 * turn, 1e-9)))
    return np.asarray(np.where(turn > _MOST_TURN, np.inf, arcs / speed + np.hypot(*last.T) / limits.speed))


def _sides(lane: Path, places: Array, start: Point) -> npt.NDArray[np.bool_]:
    """Whether places (n, 2) lie to the left of a lane, as it passes a start."""
    x, y, heading = lane.pose([closest(lane, start)[1]])[0].tolist()
    return np.asarray(math.cos(heading) * (places[:, 1] - y) > math.sin(heading) * (places[:, 0] - x))
