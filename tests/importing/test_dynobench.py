"""Problems of dynobench and db-CBS."""

from __future__ import annotations

import pytest

from coord.model.footprint import polygon

FLOOR = """\
environment:
  max: [10, 10]
  min: [0, 0]
  obstacles:
  - center: [3.0, 4.0]
    size: [1.0, 0.5]
    type: box
"""
TWO = """\
robots:
- goal: [6.8, 1.1, -2.2]
  start: [9.4, 5.1, 3.1]
  type: unicycle_first_order_0_sphere
- {type: double_integrator_0, start: [4.1, 9.3, 0, 0], goal: [5.4, 6.3, 0, 0]}
"""


def robots(kind, start=(1, 2), goal=(8, 8)):
    return f"robots:\n- {{type: {kind}, start: {[*start, 0]}, goal: {[*goal, 0]}}}\n"


def test_boxes_and_discs_come_with_what_is_known_of_the_models(bring):
    """Starts and goals without their headings, published radii and limits, boxes by centre and size."""
    found = bring("a.yaml", FLOOR + TWO)
    first, second = found.problem.robots
    assert (first.name, first.start, first.goal) == ("r0", (9.4, 5.1), (6.8, 1.1))
    assert (first.footprint.radius, first.limits.speed, first.limits.acceleration) == (0.4, 0.5, 0.5)
    assert (second.footprint.radius, second.limits.speed, second.limits.acceleration) == (0.1, 0.5, 2.0)
    (box,) = found.problem.obstacles
    assert box.vertices.tolist() == [[2.5, 3.75], [3.5, 3.75], [3.5, 4.25], [2.5, 4.25]]
    assert found.problem.workspace.bounds == (0, 0, 10, 10)
    assert "# Dropped: the headings" in found.text


@pytest.mark.parametrize("kind", ["unicycle_first_order_0", "car_first_order_with_1_trailers_0"])
def test_robots_that_are_boxes_become_polygons_that_turn(bring, kind):
    """0.5 x 0.25 m with the heading of the path; a dropped trailer is said."""
    found = bring("a.yaml", FLOOR + robots(kind))
    sides = [(-0.25, -0.125), (0.25, -0.125), (0.25, 0.125), (-0.25, 0.125)]
    assert found.problem.robots[0].footprint == polygon(sides, "path")
    assert any("trailers" in remark for remark in found.remarks) == ("trailers" in kind)


def test_a_radius_that_is_given_makes_discs_of_all(bring):
    """Whatever the model says."""
    found = bring("a.yaml", FLOOR + robots("unicycle_first_order_0"), radius=0.2)
    assert found.problem.robots[0].footprint.radius == 0.2
    assert not found.problem.robots[0].footprint.vertices


def test_an_unknown_model_is_a_small_disc_and_that_is_said(bring):
    """0.2 m, with its name in the remark."""
    found = bring("a.yaml", FLOOR + robots("hovercraft_7"))
    assert found.problem.robots[0].footprint.radius == 0.2
    assert any("hovercraft_7" in remark for remark in found.remarks)


def test_robots_that_stand_at_the_edge_get_a_wider_floor(bring):
    """The middle of a disc of 0.4 m is 0.1 m from the edge: the floor grows by 0.3 m, and that is said."""
    found = bring("a.yaml", FLOOR + robots("unicycle1_sphere_v0", start=(0.1, 5)))
    assert found.problem.workspace.bounds == pytest.approx((-0.3, -0.3, 10.3, 10.3))
    assert any("0.3 m wider" in remark for remark in found.remarks)


def test_all_faults_are_told_with_their_lines(refused):
    """Bounds, obstacles and robots at once."""
    text = (
        "environment:\n  min: [0]\n  max: [1, 2]\n  obstacles:\n  - {type: blob, center: [1, 1]}\n"
        "  - {type: box, center: [1, .inf], size: [1, 1]}\n  - {type: box, center: [1, 1]}\n  - 3\n"
        "robots:\n- {type: quad3d_v0, start: [1, 1, 1], goal: [2, 2, 2]}\n- {type: x, start: [1, 1]}\n"
    )
    assert refused("a.yml", text) == [
        "a.yml:2: environment: min: must be a list of 2 finite numbers or more",
        'a.yml:5: obstacles[1]: type must be "box" (got "blob")',
        "a.yml:6: obstacles[2]: center: must be a list of 2 finite numbers or more",
        "a.yml:7: obstacles[3]: size is missing",
        "a.yml:8: obstacles[4]: must have the keys type, center",
        'a.yml:10: robots[1]: "quad3d_v0" does not drive on a floor by itself',
        "a.yml:11: robots[2]: goal is missing",
    ]


def test_floors_only_and_robots_that_fit(refused):
    """Three dimensions are refused; a start in a box is told of the source, with the robot's name."""
    flying = FLOOR.replace("[10, 10]", "[10, 10, 3]").replace("[0, 0]", "[0, 0, 0]")
    (said,) = refused("a.yaml", flying + TWO)
    assert said == "a.yaml:3: environment: is in three dimensions; coord plans on a floor"
    (said,) = refused("a.yaml", FLOOR + robots("unicycle1_sphere_v0", start=(3, 4)), force=True)
    assert said.startswith('a.yaml: robots[1] "r0": start (3, 4) is')


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("a: 1\n", "a.yaml:1: this YAML is neither a ROS map (key image) nor a dynobench problem"),
        ("[1, 2]\n", "a.yaml:1: this YAML is neither"),
        ("", "a.yaml: the file is empty"),
        ("environment: [\n", "a.yaml:2: this is no YAML: "),
        ("environment: 3\nrobots: 4\n", "a.yaml:1: environment: must have the keys min, max"),
        ("[" * 3000, "a.yaml: the file is nested too deeply"),
    ],
)
def test_what_is_no_such_problem_is_refused(refused, text, fault):
    """Other YAML, no YAML, nothing."""
    assert refused("a.yaml", text)[0].startswith(fault)
