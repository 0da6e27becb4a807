"""Where times are long and jerks high, the last digit of a time is worth more acceleration than the checker lets pass."""

from __future__ import annotations

import pytest

from coord.model.footprint import Footprint
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan


@pytest.mark.xfail(
    strict=True, reason="alone profiles use the limits to the last digit; ulp(27,700 s) x jerk = 4e-10 m/s2"
)
def test_hours_of_slow_driving_with_a_high_jerk_limit_are_certified():
    """948 m at 34 mm/s with a deceleration of 0.024 m/s2 and a jerk of 99 m/s3: the planner's own plan is not refused."""
    limits = Limits(0.034197999206648295, 1.155734957152316, 0.02358669394706742, 98.64441647562442, 1.8324254931196762)
    start, goal = (1252.6198664905082, -684.2787404813903), (1385.960834670114, 253.5689309231568)
    robot = Robot("r", Footprint(28.860898694251524), limits, start, goal)
    result = plan(Problem("slow", Workspace((1000.0, -1000.0, 2400.0, 400.0)), (robot,)))
    assert result.certified, result.diagnoses
