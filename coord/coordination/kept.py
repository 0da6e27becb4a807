"""Which robots of a plan keep their motion when the problem has changed, and why the others do not."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from coord.conflicts.chords import Chords, chords
from coord.conflicts.rest import closest
from coord.coordination.blocking import Block
from coord.coordination.company import Company
from coord.errors import InvalidValueError
from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle
from coord.model.path import Path
from coord.model.problem import Problem
from coord.model.result import Plan, RobotPlan
from coord.model.robot import Robot
from coord.paths.given import given
from coord.paths.sides import Ground, Ways
from coord.timing.meeting import first_run_into

LACKING: Final = "the plan lacks it"
OFF_THE_FLOOR: Final = "an obstacle or the edge of the workspace is now in the way of its path"

#: [m, rad, 1/m] A path that was drawn by the same rules differs by rounding only; via points are met to 1e-12 m.
_SAME: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Kept:
    """The robots of a problem that keep their part of a plan, and why the others do not; by index.

    Parameters
    ----------
    problem : the new one.
    parts : in the order of the plan; ``blocks`` : between these robots.
    anew : why each of the others is planned, in the order of the problem.
    dropped : names of robots of the plan that the problem has no more.
    unheeded : robots that are kept although their priority has changed: it would matter to a full run only.
    """

    problem: Problem
    parts: Mapping[int, RobotPlan]
    blocks: tuple[Block, ...]
    anew: Mapping[int, str]
    dropped: tuple[str, ...]
    unheeded: tuple[int, ...]


def kept(problem: Problem, plan: Plan) -> Kept:
    """Compare a plan with a problem.

    A robot keeps its motion if all is as it was that the plan tells of: footprint, limits, start, goal and release;
    if its path is the one that the problem gives, or leads past its via points on the side that it asks for; and
    if that path is still free and clear of those planned before. A priority only says who is planned first: where it
    alone has changed, the motion stays. Neither a weight, nor a side, a via point or a given path that is gone can be
    seen in a plan.
    """
    index = {robot.name: i for i, robot in enumerate(problem.robots)}
    before = {part.robot.name: part for part in plan.robots}
    anew = {i: LACKING for name, i in index.items() if name not in before}
    grounds, may_be_hit = _Grounds(problem), _floor_changed(problem, plan.problem)
    parts: dict[int, RobotPlan] = {}
    for name in (name for name in plan.order if name in index):
        i, part = index[name], before[name]
        if fault := _changed(problem.robots[i], part, grounds):
            anew[i] = fault
        elif may_be_hit and not grounds.is_free(problem.robots[i], part.path):
            anew[i] = OFF_THE_FLOOR
        else:
            parts[i] = part
    if _rules(problem) == _rules(plan.problem):
        blocks = _blocks_of(plan, {name: i for name, i in index.items() if i in parts})
    elif parts:
        clashes, blocks = _together(problem, parts)
        anew |= clashes
        parts = {i: part for i, part in parts.items() if i not in clashes}
    else:
        blocks = ()
    robots, names = problem.robots, {problem.robots[i].name for i in parts}
    now, then = problem.workspace, plan.problem.workspace
    eased = now.clearance < then.clearance or (now.after_arrival, then.after_arrival) == ("leave", "stay")
    return Kept(
        problem,
        {i: _still_true(robots[i], part, names, eased=eased) for i, part in parts.items()},
        blocks,
        dict(sorted(anew.items())),
        tuple(part.robot.name for part in plan.robots if part.robot.name not in index),
        tuple(i for i, part in parts.items() if robots[i].priority != part.robot.priority),
    )


def _still_true(robot: Robot, part: RobotPlan, known: Set[str], *, eased: bool) -> RobotPlan:
    """A robot's part of the plan, without what it says of robots that are gone or come later now.

    Without them, and on a floor whose rules are ``eased``, it might arrive earlier: then its bound is the one alone.
    """
    after, before = (tuple(name for name in told if name in known) for told in (part.after, part.before))
    eased |= len(after) + len(before) < len(part.after) + len(part.before)
    bound = min(part.solo_bound, part.lower_bound) if eased else part.lower_bound
    return dataclasses.replace(part, robot=robot, after=after, before=before, lower_bound=bound)


def _rules(problem: Problem) -> tuple[float, str]:
    """What decides how near two robots may come to each other."""
    return (problem.workspace.clearance, problem.workspace.after_arrival)


def _floor_changed(problem: Problem, old: Problem) -> bool:
    """Whether paths that were free may not be free any more."""
    now, then = problem.workspace, old.workspace
    here, there = ([_shape(obstacle) for obstacle in one.obstacles] for one in (problem, old))
    return now.bounds != then.bounds or now.clearance > then.clearance or here != there


def _shape(obstacle: Obstacle) -> object:
    if isinstance(obstacle, Circle):
        return (*obstacle.center, obstacle.radius)
    return [ring.tolist() for ring in obstacle.rings]


def _changed(robot: Robot, part: RobotPlan, floor: _Grounds) -> str:
    """What has changed about a robot, as a sentence; empty if nothing that its motion depends on."""
    old = part.robot
    fields = ["footprint"] if _outline(robot.footprint) != _outline(old.footprint) else []
    fields += [name for name in ("limits", "start", "goal", "release") if getattr(robot, name) != getattr(old, name)]
    if not fields and not floor.is_way_of(robot, part.path):
        fields = ["given path"] if robot.path else ["via points or side"]
    return f"its {' and '.join(fields)} changed" if fields else ""


def _outline(footprint: Footprint) -> object:
    return footprint if footprint.vertices else footprint.radius  # turning changes nothing about a disc


class _Grounds:
    """The floor as the robots of a problem see it; obstacles are grown when they are first asked for."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._grounds: dict[Footprint, Ground] = {}

    def ground(self, shape: Footprint) -> Ground:
        """The obstacles, grown for a footprint."""
        if shape not in self._grounds:
            workspace = self.problem.workspace
            grown = grow(self.problem.obstacles, shape, workspace.clearance, workspace.bounds)
            self._grounds[shape] = Ground(grown)
        return self._grounds[shape]

    def is_free(self, robot: Robot, path: Path) -> bool:
        """Whether a robot keeps the distance to everything along its path."""
        grown = self.ground(robot.footprint).grown
        floor = Floor(grown, grown.rho)
        if len(path.pieces):
            return keeps_distance(floor, path)
        return not len(floor.hit_parts(np.array([[*robot.start, *robot.start]])))

    def is_way_of(self, robot: Robot, path: Path) -> bool:
        """Whether a path is the one that a robot was given, or leads past its places on its side."""
        if robot.path:
            return _is_given(robot, path)
        if not robot.via and robot.side == "quickest":
            return True
        met = [closest(path, place) for place in robot.via]
        far, at = max((distance for distance, _ in met), default=0.0), [0.0, *(s for _, s in met), path.length]
        in_order = all(a <= b for a, b in pairwise(at)) or len(set(robot.via)) < len(robot.via)
        return far <= _SAME and in_order and (robot.side == "quickest" or self._is_on_side(robot, chords(path), at))

    def _is_on_side(self, robot: Robot, chain: Chords, at: Sequence[float]) -> bool:
        """Whether a path, at its places at these arc lengths [m], goes round nothing on the side not asked for."""
        side = 1 if robot.side == "left" else -1
        places = [robot.start, *robot.via, robot.goal]
        if any(a == b for a, b in pairwise(places)):
            return True
        for blocker in Ways(self.ground(robot.footprint), places).blockers():
            leg = (chain.s >= at[blocker.leg] - _SAME) & (chain.s <= at[blocker.leg + 1] + _SAME)
            (dx, dy), gap = blocker.direction, chain.points[leg] - blocker.place
            along, across = gap[:, 0] * dx + gap[:, 1] * dy, side * (gap[:, 1] * dx - gap[:, 0] * dy)
            crossing = np.flatnonzero((along[:-1] < 0) != (along[1:] < 0))
            share = along[crossing] / (along[crossing] - along[crossing + 1])
            if np.any(across[crossing] + share * (across[crossing + 1] - across[crossing]) < 0):
                return False
        return True


def _is_given(robot: Robot, path: Path) -> bool:
    try:
        drawn = given(robot.path, robot.corner_radius, robot.start, robot.goal)
    except InvalidValueError:
        return False
    same = drawn.pieces.shape == path.pieces.shape and np.allclose(drawn.pieces, path.pieces, _SAME, _SAME)
    return same and bool(np.allclose(drawn.start, path.start, _SAME, _SAME))


def _blocks_of(plan: Plan, index: Mapping[str, int]) -> tuple[Block, ...]:
    """The arcs of a plan between some robots, by index."""
    arcs = ((arc.first, arc.then, arc.at) for arc in plan.blocking)
    rests = ((first, then, at) if at == "start" else (then, first, at) for first, then, at in arcs)
    return tuple(Block(index[a], index[b], at) for a, b, at in rests if a in index and b in index)


def _together(problem: Problem, parts: Mapping[int, RobotPlan]) -> tuple[dict[int, str], tuple[Block, ...]]:
    """Who, in the order of the plan, is not clear of those before it any more; and who blocks whom of the others."""
    robots, index = tuple(problem.robots[i] for i in parts), list(parts)
    company = Company(dataclasses.replace(problem, robots=robots), [part.path for part in parts.values()])
    clashes: dict[int, str] = {}
    blocks: list[Block] = []
    for k, (i, part) in enumerate(parts.items()):
        near = [other for other in company.near(k, part.path) if other in company.profiles]
        found = company.blocks(k, part.path, near)
        meetings = company.meetings(k, part.path, near, found)
        violated = first_run_into(meetings, part.profile)
        if violated is None:
            company.take(k, part.path, part.profile)
            blocks += [Block(index[b.resting], index[b.driving], b.at) for b in found if b.then == k]
        else:
            clashes[i] = f'it no longer keeps clear of "{robots[meetings[violated].other].name}"'
    return clashes, tuple(blocks)
