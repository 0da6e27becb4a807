"""The raster is generous: what it denies is denied to every way."""

from __future__ import annotations

import math

import pytest

from coord.coordination.flood import Raster, inner_radius
from coord.errors import NoPlanError
from coord.model.footprint import Footprint, square
from coord.model.obstacle import rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
DISC = Footprint(0.3)
START, GOAL = (1.0, 2.0), (9.0, 2.0)


def with_gap(gap, body=DISC):
    """A wall between a robot and its goal, with a gap [m] above it, or none."""
    wall = rectangle("wall", (5.0, 0.0, 5.2, 4.0 - gap))
    robot = Robot("red", body, LIMITS, START, GOAL)
    return Problem("gap", Workspace((0.0, 0.0, 10.0, 4.0), 0.05), (robot,), (wall,))


def leads_home(problem):
    raster, robot = Raster(problem), problem.robots[0]
    goal = raster.cell(robot.goal)
    return bool(raster.reached(robot.start, raster.ground(robot.footprint), goal) & goal)


@pytest.mark.parametrize("body", [DISC, square(0.6)])
@pytest.mark.parametrize("gap", [0.0, 0.3, 0.6, 0.69, 0.71, 0.8, 1.5])
def test_where_the_raster_knows_no_way_there_is_none(gap, body):
    """A gap that a robot drives through is open in the raster; a clearly narrower one is shut."""
    problem = with_gap(gap, body)
    try:
        find_routes(problem)
    except NoPlanError:
        assert gap < 0.7
    else:
        assert leads_home(problem)
    if gap < 0.5:
        assert not leads_home(problem)


def test_a_robot_that_stands_in_the_gap_shuts_it():
    """Without it cells lead through, past it none do."""
    problem = with_gap(0.8)
    raster, goal = Raster(problem), Raster(problem).cell(GOAL)
    free = raster.ground(DISC)
    assert raster.reached(START, free) & goal
    assert not raster.reached(START, free & ~raster.beside(DISC, DISC, (5.1, 3.6))) & goal


@pytest.mark.parametrize("place", [(0.0, 0.0), (9.99, 0.02), (3.14, 2.72), (9.5, 3.99)])
def test_cells_next_to_a_cell_are_nine_and_fewer_at_the_edge(place):
    """Widening takes in what lies beside, below and above, of a place within the floor at least four cells."""
    raster = Raster(with_gap(0.8))
    cells = raster.widened(raster.cell(place)).bit_count()
    assert 4 <= cells <= 9
    inside = all(0.2 < x < size - 0.2 for x, size in zip(place, (10.0, 4.0), strict=True))
    assert cells == 9 or not inside


def test_rows_do_not_lead_into_each_other():
    """From the right end of a row nothing leads to the left end of the next, where a wall keeps both apart."""
    wall = rectangle("wall", (4.0, 0.0, 6.0, 4.0))
    robots = (Robot("red", DISC, LIMITS, START, GOAL),)
    raster = Raster(Problem("halves", Workspace((0.0, 0.0, 10.0, 4.0), 0.05), robots, (wall,)))
    free = raster.ground(DISC)
    left, right = raster.reached(START, free), raster.reached(GOAL, free)
    assert left & right == 0
    assert (left | right) & free == free


def test_the_inner_radius_is_that_of_the_largest_disc_inside():
    """A disc's own; half the side of a square, not half its diagonal."""
    assert inner_radius(DISC) == 0.3
    assert inner_radius(square(0.6)) == pytest.approx(0.3, abs=1e-12)
    assert square(0.6).radius == pytest.approx(0.3 * math.sqrt(2))
