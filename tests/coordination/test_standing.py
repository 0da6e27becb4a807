"""Ways past robots that stand somewhere, differently on each stage."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.coordination.standing import Stage, Standing, is_clear, is_passed, parts, way_past
from coord.coordination.way_round import rests
from coord.model.footprint import Footprint, square
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def scene(*ends, body=Footprint(0.3)):  # noqa: B008 - a frozen value
    robots = tuple(Robot(f"r{k}", body, LIMITS, start, goal) for k, (start, goal) in enumerate(ends))
    return Problem("scene", Workspace((-10.0, -10.0, 10.0, 10.0), 0.05), robots)


@pytest.fixture
def crossing():
    """Robot 0 drives east; robot 1 starts on its line and has its goal north."""
    return scene(((-5.0, 0.0), (5.0, 0.0)), ((0.0, 0.0), (0.0, 5.0)))


def test_parts_of_a_path_are_the_path():
    """Laid end to end they have its length, begin where the last one ended, and run through its points."""
    robot = Robot("r", Footprint(0.3), LIMITS, (-5.0, 0.0), (5.0, 0.0), via=((-2.0, 3.0), (2.0, -3.0)))
    (route,) = find_routes(Problem("via", Workspace((-10.0, -10.0, 10.0, 10.0), 0.05), (robot,)))
    cut = parts(route.path, [*robot.via, robot.goal])
    assert sum(part.length for part in cut) == pytest.approx(route.path.length, abs=1e-9)
    begin = 0.0
    for part, place in zip(cut, [*robot.via, robot.goal], strict=True):
        s = np.linspace(0.0, part.length, 50)
        assert np.abs(part.pose(s) - route.path.pose(begin + s)).max() < 1e-9
        assert math.dist(part.end, place) < 1e-6
        begin += part.length


def test_who_has_left_is_in_nobodys_way(crossing):
    """The straight line is not clear while the other stands at its start, and is once it stands at its goal."""
    path = find_routes(crossing)[0].path
    assert is_passed(crossing, 0, path, Standing(1, (0.0, 0.0)))
    assert not is_clear(crossing, 0, path, [Stage((5.0, 0.0), (Standing(1, (0.0, 0.0)),))])
    assert is_clear(crossing, 0, path, [Stage((5.0, 0.0), (Standing(1, (0.0, 5.0)),))])


@pytest.mark.parametrize(("first", "then", "clear"), [(3.0, -3.0, True), (-3.0, 3.0, False), (-3.0, -3.0, False)])
def test_stages_look_at_who_stands_then(crossing, first, then, clear):
    """Someone on the second half of the way is in the way on the second stage, not on the first."""
    path = find_routes(crossing)[0].path
    stages = [Stage((0.0, 0.0), (Standing(1, (first, 0.0)),)), Stage((5.0, 0.0), (Standing(1, (then, 0.0)),))]
    assert is_clear(crossing, 0, path, stages) is clear


@pytest.mark.parametrize("body", [Footprint(0.3), square(0.6)])
@pytest.mark.parametrize("place", [(0.0, 0.0), (1.0, 0.3), (0.0, 5.0)])
def test_a_way_past_somebody_is_clear_and_tells_all_that_it_runs_over(place, body):
    """At its start, at its goal, or aside: the way leads round; its blocks are those of all places of rest."""
    problem = scene(((-5.0, 0.0), (5.0, 0.0)), ((0.0, 0.0), (0.0, 5.0)), body=body)
    known, route = rests(problem), find_routes(problem)[0]
    stages = [Stage((5.0, 0.0), (Standing(1, place),))]
    way = way_past(known, 0, route, stages, "fitted")
    assert is_clear(problem, 0, way.route.path, stages)
    assert way.blocks == set(known.blocks(way.route.path, 0))
    assert bool(way.blocks) is (place != (0.0, 0.0))


def test_a_way_leads_through_its_places_in_turn(crossing):
    """Three stages: the path comes by both places, in order, and ends at the goal."""
    route, places = find_routes(crossing)[0], [(-2.0, -3.0), (2.0, -3.0), (5.0, 0.0)]
    stages = [Stage(place, (Standing(1, (0.0, 0.0)),)) for place in places]
    way = way_past(rests(crossing), 0, route, stages, "taut")
    ends = [part.end for part in parts(way.route.path, places)]
    assert max(math.dist(end, place) for end, place in zip(ends, places, strict=True)) < 1e-6
