"""Robots: own fields beat [defaults], which beat the built-in ones."""

from __future__ import annotations

import pytest

from coord.model.footprint import Footprint, polygon, square
from coord.model.robot import Limits

HEAD = 'format = "coord-problem/1"\n[workspace]\nbounds = [0, 0, 10, 10]\n'
ROBOT = '[[robots]]\nname = "a"\nstart = [1, 1]\ngoal = [9, 1]\n'


def test_a_robot_of_three_lines_has_the_documented_defaults(read):
    """A disc of 0.3 m, 1 m/s, 0.5 m/s2 in every direction, 1 m/s3, weight 1, no priority, ready at once."""
    (robot,) = read(HEAD + ROBOT).robots
    assert robot.footprint == Footprint(0.3)
    assert robot.limits == Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    assert (robot.weight, robot.priority, robot.release) == (1.0, None, 0.0)


@pytest.mark.parametrize(
    ("common", "own", "limits"),
    [
        ("speed = 2", "", Limits(2.0, 0.5, 0.5, 1.0, 0.5)),
        ("speed = 2", "speed = 3", Limits(3.0, 0.5, 0.5, 1.0, 0.5)),
        ("acceleration = 2", "", Limits(1.0, 2.0, 2.0, 1.0, 2.0)),
        ("acceleration = 2", "acceleration = 3", Limits(1.0, 3.0, 3.0, 1.0, 3.0)),
        ("deceleration = 2", "acceleration = 3", Limits(1.0, 3.0, 2.0, 1.0, 3.0)),
        ("lateral_acceleration = 0.1", "deceleration = 4\njerk = 9", Limits(1.0, 0.5, 4.0, 9.0, 0.1)),
    ],
)
def test_own_fields_beat_defaults_which_beat_built_in_ones(read, common, own, limits):
    """Deceleration and lateral acceleration follow the acceleration that holds, unless given."""
    assert read(f"{HEAD}[defaults]\n{common}\n{ROBOT}{own}\n").robots[0].limits == limits


def test_footprint_weight_and_release_have_defaults_too(read):
    """[defaults] may hold all that robots can have in common."""
    common = "[defaults]\nfootprint = { disc = 0.5 }\nweight = 2\nrelease = 3\nside = 'quickest'\nheading = 'fixed'\n"
    (robot,) = read(HEAD + common + ROBOT).robots
    assert (robot.footprint.radius, robot.weight, robot.release) == (0.5, 2.0, 3.0)


def test_a_faulty_acceleration_is_one_fault(faults_of):
    """Deceleration and lateral acceleration, which follow it, are not told as well."""
    assert len(faults_of(f"{HEAD}{ROBOT}acceleration = -1\n")) == 1


@pytest.mark.parametrize("footprint", ["{ disc = -1 }", "{ square = 0 }", "0.1"])
def test_an_unknown_radius_is_not_checked_against_the_edge(faults_of, footprint):
    """Where the common footprint is faulty, nobody knows how near to the edge a robot may stand."""
    text = f"{HEAD}[defaults]\nfootprint = {footprint}\n{ROBOT.replace('[1, 1]', '[0.1, 1]')}"
    (told,) = faults_of(text)
    assert told.startswith("problem.toml:5: [defaults]: ")


def test_the_third_robot_of_a_name_points_to_the_first(faults_of):
    """Each later bearer of a name is told, on the line of its name."""
    places = [("[1, 1]", "[1, 2]"), ("[2, 3]", "[2, 4]"), ("[5, 5]", "[6, 6]")]
    robots = "".join(f'[[robots]]\nname = "a"\nstart = {start}\ngoal = {goal}\n' for start, goal in places)
    assert faults_of(HEAD + robots) == [
        f'problem.toml:{line}: robots[{k}] "a": the name is taken by robots[1]; names must differ'
        for k, line in ((2, 9), (3, 13))
    ]


@pytest.mark.parametrize(
    ("common", "own", "footprint"),
    [
        ("", "footprint = { square = 0.6 }", square(0.6, "fixed")),
        ("", 'footprint = { square = 0.6 }\nheading = "path"', square(0.6, "path")),
        ('heading = "path"', "footprint = { square = 0.6 }", square(0.6, "path")),
        ('heading = "path"', 'footprint = { square = 0.6 }\nheading = "fixed"', square(0.6, "fixed")),
        ("footprint = { square = 0.6 }", 'heading = "path"', square(0.6, "path")),
        (
            "",
            "footprint = { polygon = [[1, 0], [0, 1], [-0.5, -0.5]] }",
            polygon([(1, 0), (0, 1), (-0.5, -0.5)], "path"),
        ),
        (
            "",
            'footprint = { polygon = [[1, 0], [-0.5, -0.5], [0, 1]] }\nheading = "fixed"',
            polygon([(0, 1), (-0.5, -0.5), (1, 0)], "fixed"),
        ),
        ("footprint = { square = 0.6 }", "footprint = { disc = 0.2 }", Footprint(0.2)),
        ('heading = "path"', "footprint = { disc = 0.2 }", Footprint(0.2)),
    ],
)
def test_squares_keep_their_heading_and_polygons_turn_unless_told_otherwise(read, common, own, footprint):
    """The heading of [defaults] holds for shapes of robots and the other way round; on a disc it means nothing."""
    robot = ROBOT.replace("[1, 1]", "[3, 4]").replace("[9, 1]", "[6, 4]")
    assert read(f"{HEAD}[defaults]\n{common}\n{robot}{own}\n").robots[0].footprint == footprint


def test_a_robot_has_a_side_places_to_pass_or_a_path(read):
    """What is given arrives in the robot; a via point may be where the one before it is."""
    robot = read(HEAD + ROBOT + 'side = "left"\nvia = [[5, 5], [5, 5], [9, 1]]\n').robots[0]
    assert (robot.side, robot.via, robot.path) == ("left", ((5.0, 5.0), (5.0, 5.0), (9.0, 1.0)), ())
    robot = read(HEAD + ROBOT + "path = [[1, 1], [5, 5], [9, 1]]\ncorner_radius = 0.5\n").robots[0]
    assert (robot.path, robot.corner_radius) == (((1.0, 1.0), (5.0, 5.0), (9.0, 1.0)), 0.5)


def test_a_given_path_overrules_the_side_of_defaults_but_not_an_own_one(read, faults_of):
    """What robots have in common gives way; what one robot says itself contradicts itself."""
    text = f'{HEAD}[defaults]\nside = "left"\ncorner_radius = 0.4\n{ROBOT}path = [[1, 1], [5, 5], [9, 1]]\n'
    robot = read(text).robots[0]
    assert (robot.side, robot.corner_radius) == ("quickest", 0.4)
    assert read(text.replace("path = [[1, 1], [5, 5], [9, 1]]\n", "")).robots[0].side == "left"
    (told,) = faults_of(text + 'side = "right"\n')
    assert told == (
        'problem.toml:11: robots[1] "a": a robot with a given path has neither side nor via: the path says it all'
    )


@pytest.mark.parametrize("lost", ["start = [1, 1]\n", "goal = [9, 1]\n"])
def test_a_path_is_not_blamed_for_an_end_that_is_missing(faults_of, lost):
    """One missing start or goal is one fault."""
    text = HEAD + ROBOT.replace(lost, "") + "path = [[1, 1], [5, 5], [9, 1]]\n"
    (told,) = faults_of(text)
    assert "is missing; every robot needs a" in told


@pytest.mark.parametrize("heading", ['"north"', "1"])
def test_a_shape_whose_heading_is_faulty_is_not_checked_against_the_edge(faults_of, heading):
    """Whether a square 0.32 m from the edge has room depends on whether it turns."""
    text = f"{HEAD}{ROBOT.replace('[1, 1]', '[0.32, 1]')}footprint = {{ square = 0.6 }}\nheading = {heading}\n"
    assert len(faults_of(text)) == 1
    assert len(faults_of(text.replace(heading, '"path"'))) == 1
