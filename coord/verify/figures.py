"""What a plan says about itself: who was planned when, lower bounds, sums."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping

from coord.verify.curve import Curve
from coord.verify.fastest import fastest
from coord.verify.records import Plan, Robot
from coord.verify.report import Findings, who
from coord.verify.tolerances import BOUND, RELATIVE, TIME


def check_order(plan: Plan, findings: Findings) -> None:
    """Check that the order names every robot once and keeps the blocking arcs, and who let whom pass."""
    rank, names = {name: k for k, name in enumerate(plan.order)}, {robot.name for robot in plan.robots}
    for name, times in Counter(plan.order).items():
        if times > 1:
            findings.add("order", f"the order names {who(name)} {times} times", [name])
        if name not in names:
            findings.add("order", f"the order names {who(name)}, but there is no such robot", [name])
    for robot in plan.robots:
        if robot.name not in rank:
            findings.add("order", f"robot {who(robot.name)} is missing in the order", [robot.name])
    for first, then, place in plan.blocking:
        if not {first, then} <= names:
            findings.add("blocking", f"a blocking arc from {who(first)} to {who(then)} names no two robots of the plan")
        elif not rank.get(first, 0) < rank.get(then, 0):
            owner = first if place == "start" else then
            reason = f"the {place} of {who(owner)} is in the way of the other"
            text = f"robot {who(first)} must be planned before {who(then)}, since {reason}; the order has it after"
            findings.add("blocking", text, [first, then])
    for robot in plan.robots:
        _check_passing(robot, rank, names, findings)


def _check_passing(robot: Robot, rank: Mapping[str, int], names: set[str], findings: Findings) -> None:
    for key, others in (("after", robot.after), ("before", robot.before)):
        for other in others:
            if other not in names or not rank.get(other, 0) < rank.get(robot.name, 0):
                text = f'robot {who(robot.name)} names {who(other)} in "{key}", which was not planned earlier'
                findings.add("passing", text, [robot.name, other])


def check_bounds(robot: Robot, path: Curve, findings: Findings) -> None:
    """Check what is claimed of one robot's best arrival; on a straight line, against the fastest motion there is."""
    claims = [
        ("solo_bound", robot.solo_bound, "arrival", robot.arrival),
        ("lower_bound", robot.lower_bound, "arrival", robot.arrival),
    ]
    for name, value, other, above in claims:
        if not value <= above + RELATIVE * abs(above) + TIME:
            text = f"robot {who(robot.name)}: {name} {value:.12g} s is above its {other} {above:.12g} s"
            findings.add("bound", text, [robot.name])
    apart = math.hypot(robot.goal[0] - robot.start[0], robot.goal[1] - robot.start[1])
    least = robot.release + (fastest(apart, robot.limits) if apart > 0.0 else 0.0)
    if not robot.solo_arrival >= least - BOUND:
        text = f"solo_arrival {robot.solo_arrival:.12g} s is below {least:.12g} s, the least on any path"
        findings.add("bound", f"robot {who(robot.name)}: {text}", [robot.name])
    if path.straight:
        best = robot.release + fastest(path.length, robot.limits)
        if not robot.solo_bound <= best + BOUND:
            text = (
                f"solo_bound {robot.solo_bound:.12g} s is above {best:.12g} s, when it can arrive on its straight path"
            )
            findings.add("bound", f"robot {who(robot.name)}: {text}", [robot.name])


def check_figures(plan: Plan, findings: Findings) -> None:
    """Check sums, makespan, bound and gap as reported."""
    figures, arrivals = plan.figures, [robot.arrival for robot in plan.robots]
    total, last, bound = math.fsum(arrivals), max(arrivals), figures.lower_bound
    gap = (total - bound) / total if total > 0.0 else 0.0
    for code, name, value, right in (
        ("sum", "sum_of_arrivals", figures.sum_of_arrivals, total),
        ("makespan", "makespan", figures.makespan, last),
        ("gap", "optimality_gap", figures.optimality_gap, gap),
    ):
        unit = "" if code == "gap" else " s"
        if not abs(value - right) <= RELATIVE * max(abs(right), 1.0):
            findings.add(code, f"{name} is said to be {value:.12g}{unit}, but it is {right:.12g}{unit}")
    if not bound <= total + RELATIVE * abs(total):
        text = f"lower_bound {bound:.12g} s is above the sum of the arrivals {total:.12g} s, so it is none"
        findings.add("bound", text)
    alone = math.fsum(robot.solo_bound for robot in plan.robots)
    if figures.lower_bound_by == "solo_bound" and not bound <= alone + RELATIVE * abs(alone):
        text = f"lower_bound {bound:.12g} s is above the sum of the robots' solo_bound {alone:.12g} s it is said to be"
        findings.add("bound", text)
