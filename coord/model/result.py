"""What a run hands back: the plan, what proves it, why it stopped, or the reasons why there is none."""

from __future__ import annotations

import math
from dataclasses import dataclass

from coord.model.arrays import Point
from coord.model.path import Path
from coord.model.problem import Problem
from coord.model.profile import VelocityProfile
from coord.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Why something is not possible: a code for programs, a paragraph for people.

    ``robots`` are names, ``place`` [m] and ``time`` [s] say where and when (None where there is none),
    ``remedy`` is the smallest change that helps, as far as it is known.
    """

    code: str
    robots: tuple[str, ...]
    text: str
    place: Point | None = None
    time: float | None = None
    remedy: str = ""


@dataclass(frozen=True, slots=True)
class BlockingArc:
    """``first`` must be planned before ``then``.

    ``at`` is "start" when first's start stands in then's way, "goal" when then would park in first's way;
    ``place`` is where [m], None in a plan read from a file, which does not keep it.
    """

    first: str
    then: str
    at: str
    place: Point | None = None


@dataclass(frozen=True, slots=True)
class Reroute:
    """A robot that left its quickest path, because on it robots would block each other in a ring.

    Parameters
    ----------
    robot : its name; ``ring`` : the names of all robots of that ring.
    around : the arcs of the ring that its new path takes away: the places that it now goes round.
    extra_length, extra_time : what the new path costs it alone [m], [s].
    text : the same for people.
    """

    robot: str
    ring: tuple[str, ...]
    around: tuple[BlockingArc, ...]
    extra_length: float
    extra_time: float
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class RobotPlan:
    """One robot's part of a plan.

    Parameters
    ----------
    solo_arrival : arrival [s] alone on its quickest path, release included, before any re-routing.
    solo_bound : certified lower bound [s] on any arrival on this path, release included.
    lower_bound : certified lower bound [s] given the robots planned before.
    after, before : names of earlier robots that it let pass, and that it passed ahead of.
    how : the step of the method that found the profile: "alone", "start delay", "splice", "program", or "waited"
        where none of them did, and the robot waits for all that come near it and then drives alone.
    """

    robot: Robot
    path: Path
    profile: VelocityProfile
    solo_arrival: float
    solo_bound: float
    lower_bound: float
    after: tuple[str, ...] = ()
    before: tuple[str, ...] = ()
    how: str = "alone"

    @property
    def arrival(self) -> float:
        """Time [s] from t = 0 at which the robot is at its goal, at rest."""
        return self.profile.arrival


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Certified or not: paths and profiles of all robots, in the order of the problem.

    ``rerouted`` : who left its quickest path, and why; empty in a plan read from a file, which does not keep it.
    """

    problem: Problem
    robots: tuple[RobotPlan, ...]
    order: tuple[str, ...]
    blocking: tuple[BlockingArc, ...]
    lower_bound: float
    lower_bound_by: str
    rerouted: tuple[Reroute, ...] = ()

    @property
    def sum_of_arrivals(self) -> float:
        """Sum of all arrivals [s]."""
        return math.fsum(robot.arrival for robot in self.robots)

    @property
    def makespan(self) -> float:
        """The last arrival [s]."""
        return max(robot.arrival for robot in self.robots)

    @property
    def sum_of_solo_arrivals(self) -> float:
        """Sum of the arrivals every robot would have alone on its quickest path [s]."""
        return math.fsum(robot.solo_arrival for robot in self.robots)

    @property
    def optimality_gap(self) -> float:
        """(sum of arrivals - lower bound) / sum of arrivals, 0 where everybody arrives at t = 0."""
        total = self.sum_of_arrivals
        return (total - self.lower_bound) / total if total > 0 else 0.0


@dataclass(frozen=True, slots=True)
class Clearance:
    """The closest two robots come: their distance [m], less nothing; who; when [s]."""

    value: float
    robots: tuple[str, str]
    time: float


@dataclass(frozen=True, slots=True, eq=False)
class Result:
    """All of a run: the problem, the plan (None if there is none), its bytes as verified, the reasons why not."""

    problem: Problem
    plan: Plan | None
    certified: bool
    document: bytes = b""
    min_clearance: Clearance | None = None
    diagnoses: tuple[Diagnosis, ...] = ()
    stopped: str = "done"
    seconds: float = 0.0
