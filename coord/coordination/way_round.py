"""Another path for one robot: round the places where the others rest."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence, Set
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.coordination.blocking import Block, blocks_among
from coord.errors import NoPlanError
from coord.model.arrays import Array, Point, frozen
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle, Polygon
from coord.model.path import Path
from coord.model.problem import Problem
from coord.model.robot import Robot
from coord.model.route import Route
from coord.paths.routes import find_routes

#: [1] Places farther from the robot's start, goal and present path than this share of its extent are first left out.
_ROOM = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Rests:
    """All places where robots of a problem rest, twice as many as robots: starts and goals in turn.

    ``places`` : (2 n, 2) [m]; ``reaches`` : (2 n,) [m], how far the resting robot and the clearance reach;
    ``bodies`` : the robots there, as obstacles; ``used`` : (2 n,), false for goals where nobody stays.
    """

    problem: Problem
    places: Array
    reaches: Array
    bodies: tuple[Obstacle, ...]
    used: npt.NDArray[np.bool_]

    def block(self, index: int, driving: int) -> Block:
        """A place that is in the way of a robot."""
        return Block(index // 2, driving, ("start", "goal")[index % 2])

    def blocks(self, path: Path, driving: int) -> list[Block]:
        """All places of others that a robot's path runs over."""
        robots, at = self.problem.robots, path.point(path.breaks)
        # a piece lies within half its length of its ends: looked at first, so that few places need a closer look
        room = self.reaches + robots[driving].footprint.radius + float(path.pieces[:, 0].max(initial=0.0)) / 2
        near = np.flatnonzero(self.used & _inside(self.places, at.min(axis=0), at.max(axis=0), room)).tolist()
        places = [self.block(k, driving) for k in near if k // 2 != driving]
        return blocks_among(places, path, robots, self.problem.workspace.clearance)


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """A route, and the places that it runs over."""

    route: Route
    blocks: frozenset[Block]


def rests(problem: Problem) -> Rests:
    """Where the robots of a problem rest."""
    robots = problem.robots
    bodies: dict[tuple[Point, Footprint], Obstacle] = {}  # one where a robot starts at the goal of another
    for robot in robots:
        for at, place in (("start", robot.start), ("goal", robot.goal)):
            bodies.setdefault((place, robot.footprint), _body(robot, at, place))
    reaches = np.array([robot.footprint.radius + problem.workspace.clearance for robot in robots])
    return Rests(
        problem,
        frozen([place for robot in robots for place in (robot.start, robot.goal)], 2),
        frozen(np.repeat(reaches, 2)),
        tuple(bodies[place, robot.footprint] for robot in robots for place in (robot.start, robot.goal)),
        np.tile([True, problem.workspace.after_arrival == "stay"], len(robots)),
    )


def way_round(
    known: Rests, driving: int, route: Route, allowed: Set[Block], shape: str, also: Sequence[Obstacle] = ()
) -> Way | None:
    """A robot's way round all places where others rest, but for those that it may run over; None where there is none.

    ``also`` : more obstacles to go round. Places far from its present route are only looked at when the way runs over
    one of them.
    """
    problem, robot = known.problem, known.problem.robots[driving]
    avoided = known.used.copy()
    avoided[[2 * driving, 2 * driving + 1, *(2 * block.resting + (block.at == "goal") for block in allowed)]] = False
    ends = np.vstack([route.path.point(route.path.breaks), [robot.start, robot.goal]])
    room = _ROOM * float(np.ptp(ends, axis=0).max())
    near = _inside(known.places, ends.min(axis=0), ends.max(axis=0), known.reaches + robot.footprint.radius + room)
    for chosen in (avoided & near, avoided):
        bodies = dict.fromkeys(known.bodies[k] for k in np.flatnonzero(chosen).tolist())
        alone = dataclasses.replace(problem, robots=(robot,), obstacles=(*problem.obstacles, *bodies, *also))
        try:
            (found,) = find_routes(alone, shape)
        except NoPlanError:
            return None
        blocks = frozenset(known.blocks(found.path, driving))
        if blocks <= allowed:
            return Way(found, blocks)
    return None


def way_through(
    known: Rests,
    driving: int,
    route: Route,
    allowed: Set[Block],
    shape: str,
    via: tuple[Point, ...],
    also: Sequence[Obstacle] = (),
) -> Way | None:
    """The same for a robot that has places to pass, whatever it had before."""
    robots = [*known.problem.robots]
    robots[driving] = dataclasses.replace(robots[driving], via=via)
    changed = dataclasses.replace(known, problem=dataclasses.replace(known.problem, robots=tuple(robots)))
    return way_round(changed, driving, route, allowed, shape, also)


def _inside(places: Array, low: Array, high: Array, reach: Array) -> npt.NDArray[np.bool_]:
    """Whether places (..., 2) lie in boxes widened by their reaches."""
    return np.asarray(((places >= low - reach[..., None]) & (places <= high + reach[..., None])).all(axis=-1))


def _body(robot: Robot, at: str, place: Point) -> Obstacle:
    """A robot at rest as an obstacle, with a name that reads well in sentences about obstacles."""
    name, shape = f"{robot.name} at its {at}", robot.footprint
    if shape.is_exact:
        return Polygon(name, frozen([(place[0] + x, place[1] + y) for x, y in shape.vertices], 2))
    return Circle(name, place, shape.radius)
