import math
from dataclasses import replace

import pytest

from coord.model.footprint import Footprint, polygon, square
from coord.model.obstacle import Circle
from coord.model.result import Plan
from coord.output.compare import differences
from coord.output.plan_file import parse, serialise


@pytest.fixture
def read(sample: Plan) -> Plan:
    return parse(serialise(sample))


def test_a_plan_agrees_with_the_problem_it_was_made_from(sample: Plan, read: Plan):
    """Writing and reading changes nothing that is compared."""
    assert differences(read, sample.problem) == []


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("footprint", Footprint(0.31)),
        ("start", (1.0, math.nextafter(4.0, 5.0))),
        ("goal", (11.5, 4.0)),
        ("priority", 1.0),
        ("release", 0.5),
    ],
)
def test_each_field_of_a_robot_counts_to_the_last_bit(sample: Plan, read: Plan, field: str, value: object):
    """One changed field, one difference, which names it."""
    problem = sample.problem
    robots = (replace(problem.robots[0], **{field: value}), *problem.robots[1:])
    (found,) = differences(read, replace(problem, robots=robots))
    assert found.startswith(f'robot "red": {field} is')


def test_a_limit_counts(sample: Plan, read: Plan):
    """A robot with another jerk limit is another robot."""
    problem = sample.problem
    robot = problem.robots[1]
    other = replace(robot, limits=replace(robot.limits, jerk=2.0))
    (found,) = differences(read, replace(problem, robots=(problem.robots[0], other, problem.robots[2])))
    assert found.startswith('robot "blue": limits')


def test_robots_that_only_one_side_has_are_named(sample: Plan, read: Plan):
    """A robot more or less is said once, not field by field."""
    problem = sample.problem
    renamed = replace(problem, robots=(*problem.robots[:2], replace(problem.robots[2], name="new")))
    found = differences(read, renamed)
    assert found == [
        'robot "grün, "3" [bold]": 1 in the plan, 0 in the problem',
        'robot "new": 0 in the plan, 1 in the problem',
    ]


def test_workspace_and_obstacles_count(sample: Plan, read: Plan):
    """A different clearance, a moved column, a missing rack."""
    problem = sample.problem
    column = Circle("column", (2.0, 6.0), 0.8)
    other = replace(
        problem,
        workspace=replace(problem.workspace, clearance=0.1, after_arrival="leave"),
        obstacles=(column, problem.obstacles[2]),
    )
    assert differences(read, other) == [
        "workspace: clearance is 0.05 in the plan, 0.1 in the problem",
        'workspace: after_arrival is "stay" in the plan, "leave" in the problem',
        'obstacle "rack": 1 in the plan, 0 in the problem',
        'obstacle "column": its shape in the plan is not that in the problem',
    ]


def test_another_digest_alone_is_a_difference_and_says_what_it_may_be(sample: Plan, read: Plan):
    """The files have changed in something that the plan does not repeat."""
    (found,) = differences(read, replace(sample.problem, digest="cd34"))
    assert 'digest "ab12"' in found
    assert "an option, a weight or a comment" in found


def test_shapes_of_robots_are_told_as_problem_files_write_them(sample: Plan, read: Plan):
    """A square that keeps its heading is not one that turns, and neither is a disc."""
    problem = sample.problem
    for footprint, words in (
        (square(0.6), '{ square = 0.6 } with heading "fixed"'),
        (square(0.6, "path"), '{ square = 0.6 } with heading "path"'),
        (
            polygon([(1, 0), (0, 1), (-1, -1)]),
            '{ polygon = [[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]] } with heading "path"',
        ),
    ):
        robots = (replace(problem.robots[0], footprint=footprint), *problem.robots[1:])
        (found,) = differences(read, replace(problem, robots=robots))
        assert found == f'robot "red": footprint is {{ disc = 0.3 }} in the plan, {words} in the problem'
