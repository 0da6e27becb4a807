"""The motion a robot would have alone: the plan file does not keep it, so pictures compute it again."""

from __future__ import annotations

from coord.alone.fastest import fastest
from coord.model.profile import VelocityProfile
from coord.model.result import RobotPlan


def alone(robot: RobotPlan) -> VelocityProfile:
    """The quickest profile along the robot's path with nobody else on the floor, from its release on."""
    return fastest(robot.path, robot.robot.limits).shifted(robot.robot.release)
