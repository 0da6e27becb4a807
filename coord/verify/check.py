"""The checker from bytes to report: which checks there are, in order."""

from __future__ import annotations

import math
from collections.abc import Sequence

from coord.verify.curve import Curve, curve, total_turn
from coord.verify.document import read
from coord.verify.figures import check_bounds, check_figures, check_order
from coord.verify.kinematics import check_lateral, check_limits, check_profile
from coord.verify.motion import Motion, motion
from coord.verify.obstacles import check_obstacles, check_workspace
from coord.verify.pairs import check_pairs
from coord.verify.records import Circle, Plan, Robot
from coord.verify.report import Clearance, Findings, Report, who
from coord.verify.separation import Mover
from coord.verify.tolerances import DISTANCE, LARGEST_COORDINATE, LARGEST_TURN


def verify(data: bytes) -> Report:
    """Decide whether a plan is safe and drivable and says the truth about itself, from the bytes of its file alone.

    Certified means, at all times from 0 on and not only at samples: every two robots keep the clearance, and every
    robot keeps it to all obstacles and to the edge of the workspace; speed, acceleration, deceleration, jerk and
    lateral acceleration stay within their limits; every robot leaves after its release and comes to rest at its goal;
    sums, bounds and order are as reported. Distances may fall short by 1e-9 m, and by rounding.

    Parameters
    ----------
    data : the bytes of a plan file of the format coord-plan/1.

    Returns
    -------
    Report
        The verdict, up to 20 findings, and the least clearance. Nothing is raised, whatever the bytes are.
    """
    findings = Findings()
    plan = read(data, findings)
    if plan is None:
        return Report("malformed", findings.found)
    count = len(plan.robots)
    check_order(plan, findings)
    if not _within_reach(plan, findings):
        return Report(findings.verdict, findings.found, None, count)
    paths = [curve(robot.pose, robot.pieces) for robot in plan.robots]
    motions = [_check_robot(robot, path, plan, findings) for robot, path in zip(plan.robots, paths, strict=True)]
    check_figures(plan, findings)
    check_obstacles(plan.robots, paths, plan, findings)
    clearance = _check_pairs(plan, motions, findings)
    return Report(findings.verdict, findings.found, clearance, count)


def _check_robot(robot: Robot, path: Curve, plan: Plan, findings: Findings) -> Motion | None:
    """Everything that concerns one robot alone; None if its profile does not say where it is."""
    _check_ends(robot, path, findings)
    usable = check_profile(robot, path, findings)
    check_limits(robot, path, findings)
    check_bounds(robot, path, findings)
    check_workspace(robot, path, plan, findings)
    if not usable:
        return None
    whole = motion(path, robot.times, robot.states, robot.jerks)
    check_lateral(robot, whole, findings)
    return whole


def _check_ends(robot: Robot, path: Curve, findings: Findings) -> None:
    """Check that a path leads from the start to the goal."""
    for words, said, pose in (("start", robot.start, path.start), ("goal", robot.goal, path.goal)):
        off = math.hypot(pose[0] - said[0], pose[1] - said[1])
        if not off <= DISTANCE + path.slack:
            verb = "begins" if words == "start" else "ends"
            text = f"robot {who(robot.name)}: its path {verb} {off:.3g} m away from its {words}"
            findings.add(words, text, [robot.name], said)


def _check_pairs(plan: Plan, motions: list[Motion | None], findings: Findings) -> Clearance | None:
    """All pairs of robots of which it is known where they are; the least clearance only if that is all of them."""
    known = [(robot, whole) for robot, whole in zip(plan.robots, motions, strict=True) if whole is not None]
    movers = [Mover(robot.body, whole) for robot, whole in known]
    if not movers:
        return None
    names = [robot.name for robot, _ in known]
    clearance = check_pairs(names, movers, plan.clearance, plan.leave, findings)
    return clearance if len(known) == len(plan.robots) else None


def _within_reach(plan: Plan, findings: Findings) -> bool:
    """Check that places are not so far out, nor paths so tangled, that doubles say nothing about them."""
    sizes: list[tuple[str, Sequence[float]]] = [("the workspace", plan.bounds), ("the clearance", (plan.clearance,))]
    for k, obstacle in enumerate(plan.obstacles):
        if isinstance(obstacle, Circle):
            sizes.append((f"obstacles[{k}]", (*obstacle.center, obstacle.radius)))
        else:
            sizes.append((f"obstacles[{k}]", [value for ring in obstacle.rings for point in ring for value in point]))
    for robot in plan.robots:
        length = math.fsum(piece[0] for piece in robot.pieces)
        sizes.append((f"robot {who(robot.name)}", (*robot.start, *robot.goal, *robot.pose, robot.body.reach, length)))
    before = len(findings.found)
    for words, values in sizes:
        largest = max(map(abs, values))
        if not largest <= LARGEST_COORDINATE:
            findings.add("range", f"{words}: {largest:g} m is beyond {LARGEST_COORDINATE:g} m")
    for robot in plan.robots:
        turn = total_turn(robot.pieces)
        if not (turn <= LARGEST_TURN and all(math.isfinite((k1 - k0) / h) for h, k0, k1 in robot.pieces)):
            text = f"robot {who(robot.name)}: its path turns by up to {turn:.6g} rad, more than {LARGEST_TURN:g}"
            findings.add("range", text, [robot.name])
    return len(findings.found) == before
