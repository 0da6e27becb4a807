"""Every robot's path, or the reason why there is none."""

from __future__ import annotations

import numpy as np
import pytest

from coord.errors import NoPlanError
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def robot(name, start, goal, radius=0.3):
    return Robot(name, Footprint(radius), LIMITS, start, goal)


def problem(robots, obstacles=(), clearance=0.05):
    return Problem("p", Workspace((0.0, 0.0, 20.0, 15.0), clearance), tuple(robots), tuple(obstacles))


def test_paths_come_in_the_order_of_the_robots():
    """Each from its own start to its own goal, and progress counts up to all of them."""
    robots = [robot(f"r{k}", (1.0, 1.0 + k), (19.0, 14.0 - k), 0.2 + 0.05 * k) for k in range(6)]
    seen = []
    paths = [route.path for route in find_routes(problem(robots, [Circle("c", (10.0, 7.5), 2.0)]), done=seen.append)]
    assert seen == [1, 2, 3, 4, 5, 6]
    for one, path in zip(robots, paths, strict=True):
        assert path.start[:2] == one.start
        assert path.end == pytest.approx(one.goal, abs=1e-9)


def test_larger_robots_keep_farther_away():
    """The least distance from a column is each robot's own radius and the clearance."""
    sizes = (0.2, 0.4, 0.6)
    robots = [robot(f"r{size}", (2.0, 7.5), (18.0, 7.5), size) for size in sizes]
    for size, route in zip(sizes, find_routes(problem(robots, [Circle("c", (10.0, 7.5), 1.0)])), strict=True):
        at = route.path.point(np.linspace(0, route.path.length, 5000))
        assert np.hypot(*(at - (10.0, 7.5)).T).min() == pytest.approx(1.0 + size + 0.05, abs=1e-5)


def test_a_robot_at_its_goal_has_a_path_without_length():
    """Also where it touches an obstacle."""
    (route,) = find_routes(problem([robot("r", (5.0, 5.0), (5.0, 5.0))], [Circle("c", (5.0, 6.35), 1.0)]))
    path = route.path
    assert (path.length, path.end) == (0.0, (5.0, 5.0))


def test_all_robots_without_a_way_are_named_with_what_shuts_them_in():
    """One diagnosis each: code, robot, obstacle, place; those that have a way are not mentioned."""
    room = Polygon(
        "vault",
        np.array([(4, 3), (16, 3), (16, 12), (4, 12)], float),
        (np.array([(5, 4), (15, 4), (15, 11), (5, 11)], float),),
    )
    robots = [
        robot("in", (1.0, 1.0), (10.0, 7.0)),
        robot("out", (10.0, 8.0), (1.0, 14.0)),
        robot("by", (1, 2), (1, 13)),
    ]
    with pytest.raises(NoPlanError) as caught:
        find_routes(problem(robots, [room, Circle("column", (18.0, 7.0), 0.5)]))
    diagnoses = caught.value.diagnoses
    assert [diagnosis.robots for diagnosis in diagnoses] == [("in",), ("out",)]
    assert all(diagnosis.code == "no-way" and '"vault"' in diagnosis.text for diagnosis in diagnoses)
    assert all("column" not in diagnosis.text for diagnosis in diagnoses)
    assert diagnoses[0].place == (10.0, 7.0)
    assert diagnoses[1].place == (10.0, 8.0)


def test_a_door_too_narrow_is_measured():
    """A wall with a door of 0.6 m and a robot that needs 0.7 m: both walls are named, and how much gets through."""
    walls = [rectangle("low", (9.0, 0.0, 11.0, 7.0)), rectangle("high", (9.0, 7.6, 11.0, 15.0))]
    with pytest.raises(NoPlanError) as caught:
        find_routes(problem([robot("r", (2.0, 7.0), (18.0, 7.0))], walls))
    (diagnosis,) = caught.value.diagnoses
    assert '"low"' in diagnosis.text
    assert '"high"' in diagnosis.text
    assert "0.60 m" in diagnosis.remedy
    assert "0.70 m" in diagnosis.remedy
