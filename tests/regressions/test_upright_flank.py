"""An exponential detour whose flank is upright: the goal touches the offset of what is in the way."""

from __future__ import annotations

import pytest

from coord.model.footprint import Footprint
from coord.model.obstacle import rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan


@pytest.mark.parametrize("goal", [11.35, 11.350001, 11.36])
def test_a_detour_without_room_for_a_foot_is_fitted_and_says_so(goal: float):
    """It once divided by the width of the flank, which is 0."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    robot = Robot("r", Footprint(0.3), limits, (2.0, 7.0), (goal, 7.0))
    floor = Workspace((0.0, 0.0, 20.0, 15.0), 0.05)
    found = plan(
        Problem("p", floor, (robot,), (rectangle("box", (9.0, 6.0, 11.0, 8.5)),)), Options(shape="exponential")
    )
    assert found.certified
