"""One by one, with places to hold: whoever drives meets nobody, and in the end all are home."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.coordination.flood import Raster
from coord.coordination.holding import one_by_one
from coord.coordination.rerouting import without_rings
from coord.coordination.way_round import rests
from coord.model.footprint import Footprint
from coord.model.obstacle import rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
DISC = Footprint(0.3)
WALLS = (rectangle("lower", (5.0, 0.0, 5.3, 4.1)), rectangle("upper", (5.0, 4.9, 5.3, 9.0)))
LEFT, RIGHT = ((1.0, 3.6), (2.6, 5.4), (4.3, 4.5)), ((9.3, 5.4), (7.7, 3.6), (6.4, 4.5))


def before_the_door(count, *, after="stay", bounds=(0.0, 0.0, 10.3, 9.0), walls=WALLS):
    """Robots in two rooms hand over their places through a door as wide as one; of three, one stands before it."""
    left, right = LEFT[:count], RIGHT[:count]
    ends = [*zip(left, right, strict=True), *zip(right, (*left[1:], left[0]), strict=True)]
    robots = tuple(Robot(f"r{k}", DISC, LIMITS, start, goal) for k, (start, goal) in enumerate(ends))
    return Problem("door", Workspace(bounds, 0.05, after), robots, walls)


def on_their_ways(problem):
    return without_rings(problem, find_routes(problem), "taut", keep_paths=False, done=lambda done, total: None)


def planned(problem, found, group, shape="taut"):
    return one_by_one(Raster(problem), rests(problem), found, group, shape, lambda: None)


def least_gap(problem, found, legs, group):
    """Least distance [m] of the robot on each leg from the others as they stand; and the arc lengths in the end."""
    at = dict.fromkeys(group, 0.0)
    least = math.inf
    for i, end in legs:
        path = found.routes[i].path
        way = path.point(np.linspace(at[i], end, 400))
        for k in group:
            gone = problem.workspace.after_arrival == "leave" and at[k] == found.routes[k].path.length
            if k != i and not gone:
                least = min(least, np.hypot(*(way - found.routes[k].path.point([at[k]])).T).min())
        at[i] = end
    return least, at


@pytest.mark.parametrize("after", ["stay", "leave"])
@pytest.mark.parametrize("count", [2, 3])
def test_robots_before_a_door_come_home_one_by_one(count, after):
    """Nobody on its leg comes near to anybody, looked at 400 times a leg; the last leg of each ends at its goal."""
    problem = before_the_door(count, after=after)
    group = tuple(range(2 * count))
    found, legs = planned(problem, on_their_ways(problem), group)
    least, at = least_gap(problem, found, legs, group)
    assert least >= 0.65 - 1e-6
    assert all(at[i] == found.routes[i].path.length for i in group)
    assert all(math.dist(found.routes[i].path.end, problem.robots[i].goal) < 1e-6 for i in group)


def test_handed_over_places_need_one_robot_aside():
    """In a ring of places each is taken by another robot: one leg more than robots."""
    problem = before_the_door(2)
    _, legs = planned(problem, on_their_ways(problem), range(4))
    assert len(legs) == 5


def test_nobody_new_is_run_over_outside_the_group():
    """A robot that is not of the group: no path runs over its start or goal that did not before."""
    problem = before_the_door(2)
    stranger = Robot("stranger", DISC, LIMITS, (3.4, 3.4), (3.4, 1.0))
    more = Problem("door", problem.workspace, (*problem.robots, stranger), problem.obstacles)
    before = on_their_ways(more)
    found, legs = planned(more, before, range(4))
    assert {leg.robot for leg in legs} == set(range(4))
    over = [{block for block in one.blocks if block.resting == 4} for one in (before, found)]
    assert over[1] <= over[0]
    assert found.routes[4] is before.routes[4]


def test_where_nobody_can_step_aside_nothing_is_found():
    """Two robots that swap places in a lane as wide as one: no place to hold, so no legs."""
    robots = (
        Robot("east", DISC, LIMITS, (0.5, 0.4), (11.0, 0.4)),
        Robot("west", DISC, LIMITS, (11.5, 0.4), (1.0, 0.4)),
    )
    lane = Problem("lane", Workspace((0.0, 0.0, 12.0, 0.8), 0.05), robots)
    assert planned(lane, on_their_ways(lane), (0, 1)) is None


def test_an_alcove_is_a_place_to_hold():
    """The same lane with an alcove: one of the two goes there first, and both come home."""
    robots = (
        Robot("east", DISC, LIMITS, (3.0, 0.4), (11.0, 0.4)),
        Robot("west", DISC, LIMITS, (11.5, 0.4), (1.0, 0.4)),
    )
    beside = (rectangle("left", (0.0, 0.8, 5.2, 2.4)), rectangle("right", (6.8, 0.8, 12.0, 2.4)))
    lane = Problem("lane", Workspace((0.0, 0.0, 12.0, 2.4), 0.05), robots, beside)
    found, legs = planned(lane, on_their_ways(lane), (0, 1))
    assert len(legs) == 3
    assert least_gap(lane, found, legs, (0, 1))[0] >= 0.65 - 1e-6


def test_a_robot_with_a_given_path_stays_on_it():
    """It neither steps aside nor leaves its path: the very same route."""
    problem = before_the_door(2)
    first = problem.robots[0]
    path = (first.start, (5.15, 4.5), first.goal)
    fixed = Robot("fixed", DISC, LIMITS, first.start, first.goal, path=path)
    changed = Problem("door", problem.workspace, (fixed, *problem.robots[1:]), problem.obstacles)
    before = on_their_ways(changed)
    answer = planned(changed, before, range(4))
    assert answer is not None
    assert answer[0].routes[0] is before.routes[0]
    assert [leg.robot for leg in answer[1]].count(0) == 1


def test_the_same_problem_gives_the_same_legs():
    """Twice the same: robots and places to the last bit."""
    problem = before_the_door(2)
    first, second = (planned(problem, on_their_ways(problem), range(4))[1] for _ in range(2))
    assert first == second
