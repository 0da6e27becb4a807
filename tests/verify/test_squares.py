"""A square that is certified as it is, and refused when somebody turns it."""

from __future__ import annotations

import copy
import json
import math

import pytest

from coord.model.footprint import square
from coord.model.obstacle import rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan
from coord.verify import verify

SIDE, CLEARANCE, SPARE = 0.8, 0.02, 0.001


@pytest.fixture(scope="module")
def certified() -> dict:
    """The plan of a square that drives along a wall, 1 mm farther away than it has to, and of one far away."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    beside = 1.0 + SIDE / 2 + CLEARANCE + SPARE
    robots = (
        Robot("slider", square(SIDE), limits, (2.0, beside), (8.0, beside)),
        Robot("other", square(SIDE), limits, (2.0, 6.0), (8.0, 6.0)),
    )
    floor = Workspace((0.0, 0.0, 10.0, 8.0), CLEARANCE)
    result = plan(Problem("wall", floor, robots, (rectangle("long wall", (1.0, 0.0, 9.0, 1.0)),)), Options())
    assert result.certified
    return json.loads(result.document)


def turned(document: dict, angle: float) -> bytes:
    """The plan, its first square turned about its centre by an angle [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    corners = [(-SIDE / 2, -SIDE / 2), (SIDE / 2, -SIDE / 2), (SIDE / 2, SIDE / 2), (-SIDE / 2, SIDE / 2)]
    changed = copy.deepcopy(document)
    changed["robots"][0]["footprint"] = {"polygon": [[c * x - s * y, s * x + c * y] for x, y in corners]}
    return json.dumps(changed).encode()


def test_a_square_beside_a_wall_is_certified_by_its_side_not_by_its_corners(certified):
    """Its circumscribed disc would reach into the wall; as a polygon that is not turned it is the same square."""
    assert certified["robots"][0]["footprint"] == {"square": SIDE}
    assert verify(turned(certified, 0.0)).verdict == "certified"


@pytest.mark.parametrize("degrees", [5.0, -5.0, 2.0, 45.0])
def test_a_square_turned_into_the_wall_is_refused_by_name(certified, degrees):
    """Five degrees bring a corner 3.3 cm nearer, through the clearance into the wall: robot, obstacle and depth are told."""
    report = verify(turned(certified, math.radians(degrees)))
    assert report.verdict == "refused"
    (fault,) = report.faults
    assert fault.robots == ("slider",)
    assert 'robot "slider"' in fault.text
    assert 'obstacle "long wall"' in fault.text
    reach = SIDE / math.sqrt(2) * math.cos(math.pi / 4 - math.radians(abs(degrees)))
    gap = SIDE / 2 + CLEARANCE + SPARE - reach
    assert f"{abs(gap):.6f}"[:7] in fault.text


def test_half_a_degree_is_noticed_and_a_hundredth_is_within_the_slack(certified):
    """A corner comes 3.5 mm nearer by half a degree, 0.07 mm by a hundredth; 1 mm was left."""
    assert verify(turned(certified, math.radians(0.5))).verdict == "refused"
    assert verify(turned(certified, math.radians(0.01))).verdict == "certified"


def test_a_square_said_to_turn_with_its_path_is_judged_as_turning(certified):
    """Along the wall it lies as drawn, so nothing changes; across it, it would not fit."""
    changed = copy.deepcopy(certified)
    changed["robots"][0]["heading"] = "path"
    assert verify(json.dumps(changed).encode()).verdict == "certified"
