"""Every robot's route: a straight line where it is free, else round the obstacles on the quicker side.

The quickest way is not always the shortest. The shortest way to the left of everything on the straight line, the
shortest to the right, the shortest of all, and those that change its mind about one obstacle are made into paths,
and their times compared. A way whose length alone takes longer than the best so far is not looked at.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from coord.alone.fastest import fastest
from coord.errors import InvalidValueError, NoPlanError
from coord.geometry.blocked import Floor
from coord.geometry.clearance import keeps_distance
from coord.geometry.growth import grow
from coord.model.arrays import Point
from coord.model.footprint import Footprint
from coord.model.path import straight
from coord.model.problem import Problem
from coord.model.profile import VelocityProfile
from coord.model.result import Diagnosis
from coord.model.robot import Limits, Robot
from coord.model.route import Route, Shaped, Way
from coord.paths import no_way
from coord.paths.exponential import exponential
from coord.paths.fitted import fitted
from coord.paths.follow import follow
from coord.paths.given import given
from coord.paths.sides import NAMES, Blocker, Ground, Ways, joined, passed
from coord.paths.skeleton import NoWay, Skeleton
from coord.paths.taut import taut
from coord.solvers.jerk import rest_to_rest

#: Among more obstacles on the straight line than this, changing the side of one gains next to nothing.
_FEW = 4

#: Of the ways that pass one obstacle on the other side than the shortest, so many are looked at, the shortest first.
_MOST_CHANGED = 2

#: A way must be quicker than another by this share to be preferred to one that is named before it.
_QUICKER = 1e-6


def find_routes(
    problem: Problem,
    shape: str = "fitted",
    done: Callable[[int], None] = lambda count: None,
    *,
    thorough: bool = False,
) -> list[Route]:
    """The routes of all robots, in the order of the problem; ``done`` is called with the number found so far.

    Parameters
    ----------
    shape : "fitted" (turns as wide as pays), "exponential", "taut" (lines and arcs) or "follow" (along edges).
    thorough : make both sides into paths, also where the length of one shows that it cannot be the quicker.

    Raises
    ------
    NoPlanError
        When robots have no way at all; all of them are named, with what is in the way.
    """
    grounds: dict[Footprint, Ground] = {}
    routes: list[Route] = []
    missing: list[Diagnosis] = []
    for robot in problem.robots:
        if robot.footprint not in grounds:
            workspace = problem.workspace
            grown = grow(problem.obstacles, robot.footprint, workspace.clearance, workspace.bounds)
            grounds[robot.footprint] = Ground(grown)
        try:
            routes.append(_Router(problem, robot, grounds[robot.footprint], shape, thorough).route())
        except NoPlanError as failure:
            missing += failure.diagnoses
        done(len(routes))
    if missing:
        raise NoPlanError(missing)
    return routes


@dataclass(frozen=True, slots=True, eq=False)
class _Candidate:
    """One way as a path, with its time."""

    sides: tuple[int, ...]
    legs: Sequence[Skeleton]
    bones: Skeleton
    shaped: Shaped
    alone: VelocityProfile


class _Router:
    """One robot on its ground."""

    def __init__(self, problem: Problem, robot: Robot, ground: Ground, shape: str, thorough: bool) -> None:
        self.problem, self.robot, self.ground, self.shape, self.thorough = problem, robot, ground, shape, thorough
        self.places: list[Point] = [robot.start]
        for place in (*robot.via, robot.goal):
            if place != self.places[-1]:
                self.places.append(place)
        self.ways = Ways(ground, self.places)
        self.floor = self.ways.floor

    def route(self) -> Route:
        """The route, or NoPlanError with the reason why there is none."""
        robot = self.robot
        for place in self.places:
            if fault := no_way.shut(self.problem, robot, self.floor, place):
                raise NoPlanError([fault])
        if robot.path:
            return self._given()
        if len(self.places) == 1:
            path = straight(robot.start, robot.goal)
            return Route(path, fastest(path, robot.limits), "straight", "", 0.0)
        if self.shape == "follow" and len(self.places) == 2:
            return self._following()
        legs = self.ways.shortest()
        if isinstance(legs, NoWay):
            raise NoPlanError([self._nowhere()])
        blockers = self.ways.blockers()
        base = self._candidate(passed(legs, blockers), legs)
        if base is None:
            raise NoPlanError([no_way.no_room_to_turn(robot)])
        if not blockers:
            return self._route_of(base, "", ())
        return self._on_a_side(base, blockers)

    def _on_a_side(self, base: _Candidate, blockers: Sequence[Blocker]) -> Route:
        """The quickest way, or the quickest on the side that was asked for; both sides as ways."""
        robot = self.robot
        asked = [side for side in (-1, 1) if robot.side in ("quickest", NAMES[side])]
        found = [base] if robot.side == "quickest" or base.sides == (asked[0],) * len(blockers) else []
        ways = []
        for side in asked:
            sides = (side,) * len(blockers)
            limit = self._longest(base, found) if found and not self.thorough else math.inf
            legs = base.legs if base.sides == sides else self.ways.shortest(blockers, sides, limit)
            if isinstance(legs, NoWay) and limit < math.inf:
                ways.append(Way(NAMES[side], limit, _quickest(found).alone.arrival, is_bound=True))
            elif isinstance(legs, NoWay):
                reason = no_way.on_side(self.problem, self.ground, blockers, NAMES[side])
                ways.append(Way(NAMES[side], None, None, reason=reason))
            elif (one := base if legs is base.legs else self._candidate(sides, legs)) is None:
                ways.append(Way(NAMES[side], None, None, reason=no_way.no_room_to_turn(robot).text))
            else:
                ways.append(Way(NAMES[side], one.shaped.path.length, one.alone.arrival, one.shaped.path))
                found.append(one)
        if not found:
            raise NoPlanError([no_way.not_on_side(robot, ways[0].reason)])
        best = _quickest(found)
        if robot.side == "quickest":
            best = _quickest([best, *self._changed(base, blockers, best)])
        return self._route_of(best, NAMES[best.sides[0]] if len(set(best.sides)) == 1 else "both", tuple(ways))

    def _route_of(self, one: _Candidate, side: str, ways: tuple[Way, ...]) -> Route:
        made = one.shaped
        return Route(made.path, one.alone, made.shape, side, one.bones.length, ways, made.fits, made.remarks)

    def _changed(self, base: _Candidate, blockers: Sequence[Blocker], best: _Candidate) -> list[_Candidate]:
        """The shortest ways that pass one blocker on the other side than the shortest, if they might be quicker."""
        longest, found = self._longest(base, [best]), []
        for k in range(len(blockers) if len(blockers) <= _FEW else 0):
            sides = (*base.sides[:k], -base.sides[k], *base.sides[k + 1 :])
            if len(set(sides)) > 1:
                legs = self.ways.shortest(blockers, sides, longest)
                found += [] if isinstance(legs, NoWay) else [(sides, legs)]
        found.sort(key=lambda way: math.fsum(leg.length for leg in way[1]))
        candidates = [self._candidate(sides, legs) for sides, legs in found[:_MOST_CHANGED]]
        return [one for one in candidates if one is not None]

    def _longest(self, base: _Candidate, found: Sequence[_Candidate]) -> float:
        """The length [m] from which on a way cannot be quicker than the best so far.

        The time that a length alone takes grows by 1/speed a metre, or more.
        """
        limits, length = self.robot.limits, base.bones.length
        slack = _quickest(found).alone.arrival - rest_to_rest(length, limits).arrival
        return length + slack * limits.speed

    def _candidate(self, sides: tuple[int, ...], legs: Sequence[Skeleton]) -> _Candidate | None:
        """A way as a path; None where there is no room to turn at a place to pass."""
        limits, bones = self.robot.limits, joined(legs)
        shaped = _shaped(self.shape, bones, limits, self.floor, is_direct=len(self.places) == 2)
        if shaped is None:
            return None
        return _Candidate(sides, legs, bones, shaped, fastest(shaped.path, limits))

    def _following(self) -> Route:
        """Along the edges of what is in the way: the shorter way round, or the side that was asked for."""
        robot, limits = self.robot, self.robot.limits
        legs = self.ways.shortest()
        if isinstance(legs, NoWay):
            raise NoPlanError([self._nowhere()])
        shortest = math.fsum(leg.length for leg in legs)
        if not any(leg.turns for leg in legs):
            path = straight(robot.start, robot.goal)
            return Route(path, fastest(path, limits), "straight", "", shortest)
        sides = [side for side in ("right", "left") if robot.side in ("quickest", side)]
        followed = {side: follow(self.floor, robot.start, robot.goal, limits, side) for side in sides}
        ways = tuple(
            Way(side, None, None, reason=one)
            if isinstance(one, str)
            else Way(side, one.path.length, fastest(one.path, limits).arrival, one.path)
            for side, one in followed.items()
        )
        asked = None if robot.side == "quickest" else robot.side
        chosen = followed[asked] if asked else follow(self.floor, robot.start, robot.goal, limits)
        if isinstance(chosen, str):
            raise NoPlanError([no_way.not_on_side(robot, chosen) if asked else self._nowhere()])
        same = [way.side for way in ways if way.length == chosen.path.length]
        side = asked or (same[0] if same else "both")
        alone = fastest(chosen.path, limits)
        return Route(chosen.path, alone, chosen.shape, side, shortest, ways, chosen.fits, chosen.remarks)

    def _given(self) -> Route:
        """The polyline of the problem, with its corners rounded, if it keeps the distance."""
        robot, grown = self.robot, self.ground.grown
        try:
            path = given(robot.path, robot.corner_radius, robot.start, robot.goal)
        except InvalidValueError as error:
            raise NoPlanError([no_way.bad_path(robot, sentence) for _, sentence in error.faults]) from error
        if not keeps_distance(Floor(grown, grown.rho), path):
            raise NoPlanError([no_way.given_too_near(self.problem, robot, grown, path)])
        length = math.fsum(math.dist(a, b) for a, b in pairwise(robot.path))
        return Route(path, fastest(path, robot.limits), "given", "", min(length, path.length))

    def _nowhere(self) -> Diagnosis:
        return no_way.nowhere(self.problem, self.robot, self.ways)


def _shaped(shape: str, bones: Skeleton, limits: Limits, floor: Floor, *, is_direct: bool) -> Shaped | None:
    """A skeleton as a path; None where its turns find no room, which only places to pass bring about."""
    if not bones.turns:
        return Shaped(straight(bones.start, bones.goal), "straight")
    if shape == "exponential" and is_direct:
        return exponential(bones, limits, floor)
    if shape == "taut":
        path = taut(bones, floor)
        return None if path is None else Shaped(path, shape)
    path = fitted(bones, limits, floor)
    if path is None:
        return None
    remark = f'Fitted turns instead of shape "{shape}": the robot has places to pass.'
    return Shaped(path, "fitted", remarks=() if shape == "fitted" else (remark,))


def _quickest(candidates: Sequence[_Candidate]) -> _Candidate:
    """The quickest; the first of those that are equally quick."""
    best = candidates[0]
    for one in candidates[1:]:
        if one.alone.arrival < best.alone.arrival * (1 - _QUICKER):
            best = one
    return best
