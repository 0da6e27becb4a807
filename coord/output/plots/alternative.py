"""The choice that was not taken: what it would have meant to pass ahead of the robot that the delay comes from."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from coord.coordination.company import Company
from coord.model.result import Plan, RobotPlan
from coord.output.plots.alone import alone
from coord.output.plots.style import is_late
from coord.timing.bounds import least_arrival, window_claim
from coord.timing.ego import Ego, earliest, ego
from coord.timing.meeting import Meeting


class Alternative(NamedTuple):
    """``other`` is the robot whose passage delays one most, too near from ``first`` to ``last`` [s].

    ``bound`` : arrival [s] that passing ahead of it could not beat, infinite where the others rule it out; None where
    it is impossible even without them, since the quickest start would come ``late`` [s] too late.
    """

    other: str
    first: float
    last: float
    bound: float | None
    late: float

    @property
    def text(self) -> str:
        """What passing before would mean, in words."""
        if self.bound == np.inf:
            return "before it: impossible between the others"
        if self.bound is not None:
            return f"before it: not below {self.bound:.2f} s"
        return (
            f"before it: {self.late:.2f} s too late" if self.late > 0 else "before it: never, one of them rests there"
        )


def alternative(plan: Plan, robot: RobotPlan) -> Alternative | None:
    """Of all that a delayed robot lets pass the one that costs most; None where it is not delayed, or not by one."""
    if not is_late(robot):
        return None
    i = plan.robots.index(robot)
    names = [one.robot.name for one in plan.robots]
    earlier = {names.index(name) for name in plan.order[: plan.order.index(robot.robot.name)]}
    problem = dataclasses.replace(plan.problem, robots=tuple(one.robot for one in plan.robots))
    company = Company(problem, [one.path for one in plan.robots])
    company.profiles = {k: plan.robots[k].profile for k in sorted(earlier)}
    others = [k for k in company.near(i, robot.path) if k in earlier]
    meetings = company.meetings(i, robot.path, others, company.blocks(i, robot.path, others))
    own = ego(robot.robot, robot.path, alone(robot).shifted(-robot.robot.release))
    passed = [meeting for meeting in meetings if meeting.passes_after(robot.profile)]
    claims = [window_claim(own, meeting.window) for meeting in passed]
    costs = [claim.after if np.isfinite(claim.after) else -np.inf for claim in claims]
    if max(costs, default=-np.inf) <= own.solo_bound:
        return None
    most = int(np.argmax(costs))
    meeting, claim = passed[most], claims[most]
    first, last = float(meeting.box[0]), float(meeting.box[1])
    name = names[meeting.other]
    if claim.can_precede:
        rest = [window_claim(own, other.window) for other in meetings if other is not meeting]
        bound = least_arrival(own, [claim, *rest], np.inf, ahead_of=claim)
        return Alternative(name, first, last, bound, 0.0)
    return Alternative(name, first, last, None, _lateness(own, meeting))


def _lateness(own: Ego, meeting: Meeting) -> float:
    """By how much [s] the quickest start misses the chance to pass first; 0 where the other is there for good."""
    window = meeting.window
    if float(window.high.max()) > own.length:
        return 0.0
    times, high = window.times[:-1], np.clip(window.high[:, 0], 0.0, own.length)
    return max(float((earliest(own, high) - times)[window.high[:, 0] > 0].max(initial=0.0)), 0.0)
