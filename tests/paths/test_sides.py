"""Left or right: the quicker by time, the one that was asked for, or the reason why there is none."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.errors import NoPlanError
from coord.model.footprint import Footprint, square
from coord.model.obstacle import Circle, rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
BOUNDS = (0.0, 0.0, 20.0, 15.0)
DISC = Footprint(0.3)


def problem(*robots, obstacles=(), clearance=0.05, bounds=BOUNDS):
    return Problem("p", Workspace(bounds, clearance), tuple(robots), tuple(obstacles))


def robot(start=(2.0, 7.0), goal=(18.0, 7.0), footprint=DISC, **fields):
    return Robot("r", footprint, LIMITS, start, goal, **fields)


def route(obstacles, thorough=True, shape="fitted", clearance=0.05, **fields):
    (found,) = find_routes(problem(robot(**fields), obstacles=obstacles, clearance=clearance), shape, thorough=thorough)
    return found


def heights(path):
    return path.point(np.linspace(0.0, path.length, 2000))[:, 1]


@pytest.mark.parametrize(("side", "above"), [("left", True), ("right", False)])
@pytest.mark.parametrize("shape", ["fitted", "taut", "exponential", "follow"])
def test_a_side_that_is_asked_for_is_taken_whatever_it_costs(side, above, shape):
    """Past a box that reaches farther to one side than to the other, in every shape."""
    box = rectangle("box", (9.0, 4.0, 11.0, 9.0))
    found = route([box], side=side, shape=shape)
    ys = heights(found.path)
    assert found.side == side
    assert (ys.max() > 9.3) == above
    assert (ys.min() < 3.7) == (not above)


def test_both_sides_are_told_and_the_quicker_is_taken():
    """The other way's length and time are those of asking for it."""
    box = rectangle("box", (9.0, 4.0, 11.0, 9.0))
    found = route([box])
    assert {way.side for way in found.ways} == {"left", "right"}
    for way in found.ways:
        asked = route([box], side=way.side)
        assert (way.length, way.time) == pytest.approx((asked.path.length, asked.time), rel=1e-12)
    assert found.time == min(way.time for way in found.ways)


def test_the_quickest_is_not_always_the_shortest():
    """Left of the pillars is shorter by a little, but between them it winds; a slow turner goes straight past on the right."""
    slow_turner = Limits(1.0, 0.5, 0.5, 1.0, 0.02)
    pillars = [rectangle("a", (7.0, 5.0, 8.0, 7.2)), rectangle("b", (11.0, 6.8, 12.0, 9.0))]
    one = Robot("r", Footprint(0.3), slow_turner, (2.0, 7.0), (18.0, 7.0))
    shortest = find_routes(problem(one, obstacles=pillars), "taut")[0]
    chosen = find_routes(problem(one, obstacles=pillars))[0]
    assert chosen.time <= shortest.time
    assert chosen.path.length >= chosen.least_length - 1e-9


def test_without_thoroughness_a_side_is_bounded_and_the_choice_is_the_same():
    """A bound of a side that was not pursued lies below what the side costs."""
    box = rectangle("box", (9.0, 1.5, 11.0, 9.0))
    quick, whole = route([box], thorough=False), route([box])
    assert quick.path.pieces.tolist() == whole.path.pieces.tolist()
    by_side = {way.side: way for way in whole.ways}
    bounded = [way for way in quick.ways if way.is_bound]
    assert bounded
    for way in bounded:
        assert way.length <= by_side[way.side].length
        assert way.time <= by_side[way.side].time


def test_a_wall_from_the_edge_has_one_side_and_the_reason_names_it():
    """A wall that touches the lower edge can only be passed on the left of a robot that drives to the right."""
    wall = rectangle("wall", (9.0, 0.0, 10.0, 9.0))
    found = route([wall])
    ways = {way.side: way for way in found.ways}
    assert ways["left"].time == found.time
    assert ways["right"].length is None
    assert '"wall"' in ways["right"].reason
    assert "edge" in ways["right"].reason
    with pytest.raises(NoPlanError) as caught:
        route([wall], side="right")
    (diagnosis,) = caught.value.diagnoses
    assert diagnosis.code == "no-way-on-side"
    assert '"wall"' in diagnosis.text
    assert diagnosis.robots == ("r",)


def test_obstacles_with_gaps_too_small_are_passed_as_one():
    """Two boxes 0.5 m apart and a robot that needs 0.7 m: left is left of both."""
    boxes = [rectangle("low", (9.0, 4.0, 11.0, 6.8)), rectangle("high", (9.0, 7.3, 11.0, 10.0))]
    assert heights(route(boxes, side="left").path).max() > 10.3
    assert heights(route(boxes, side="right").path).min() < 3.7


def test_a_mirrored_world_mirrors_the_sides():
    """Reflected at y = 7: left and right change names, lengths and times stay."""
    obstacles = [rectangle("box", (6.0, 5.0, 8.0, 7.5)), Circle("c", (13.0, 7.6), 1.0)]
    mirrored = [rectangle("box", (6.0, 6.5, 8.0, 9.0)), Circle("c", (13.0, 6.4), 1.0)]
    bounds = (0.0, 0.0, 20.0, 14.0)
    here, there = (
        find_routes(problem(robot(), obstacles=those, bounds=bounds), thorough=True)[0]
        for those in (obstacles, mirrored)
    )
    other = {"left": "right", "right": "left", "both": "both"}
    assert there.side == other[here.side]
    assert there.time == pytest.approx(here.time, rel=1e-9)
    times = {way.side: way.time for way in there.ways}
    assert {other[way.side]: pytest.approx(way.time, rel=1e-6) for way in here.ways} == times


def test_via_points_are_passed_in_order():
    """Within 10 micrometres, and no tighter than a centimetre."""
    via = ((5.0, 12.0), (10.0, 3.0), (15.0, 12.0))
    found = route([rectangle("box", (9.0, 6.0, 11.0, 8.0))], via=via)
    s = np.linspace(0.0, found.path.length, 400001)
    at = found.path.point(s)
    places = [np.hypot(*(at - place).T) for place in via]
    assert max(distance.min() for distance in places) < 1e-4
    assert np.all(np.diff([s[int(distance.argmin())] for distance in places]) > 0)
    assert np.abs(found.path.pieces[:, 1:]).max() <= 100.0 * (1 + 1e-9)
    assert found.path.end == pytest.approx((18.0, 7.0), abs=1e-9)


@pytest.mark.parametrize("shape", ["fitted", "taut", "exponential", "follow"])
def test_a_robot_with_via_points_is_planned_and_certified(shape):
    """In every shape; a shape that knows no places to pass says so."""
    from coord.model.options import Options

    found = plan(
        problem(robot(via=((6.0, 10.0), (10.0, 7.0))), obstacles=[Circle("c", (8.0, 8.0), 0.5)]), Options(shape=shape)
    )
    assert found.certified


def test_a_via_point_on_the_straight_line_changes_nothing():
    """The path is the straight line, in one piece or two."""
    found = route([], via=((10.0, 7.0), (12.0, 7.0)))
    assert found.path.length == pytest.approx(16.0, abs=1e-9)
    assert not found.path.pieces[:, 1:].any()


def test_a_given_path_is_kept_and_rounded():
    """Two right angles with fillets of 1 m: lines and quarter circles, analytically."""
    path = ((2.0, 7.0), (2.0, 12.0), (18.0, 12.0), (18.0, 7.0))
    found = route([], path=path, corner_radius=1.0)
    assert found.shape == "given"
    assert found.path.length == pytest.approx(26.0 - 4.0 + math.pi, abs=1e-9)


def test_a_given_path_too_near_to_something_names_robot_obstacle_place_and_amount():
    """It runs 0.3 m past a box although 0.35 m are kept."""
    with pytest.raises(NoPlanError) as caught:
        route([rectangle("box", (9.0, 7.3, 11.0, 9.0))], path=((2.0, 7.0), (18.0, 7.0)))
    (diagnosis,) = caught.value.diagnoses
    assert diagnosis.code == "path-too-near"
    assert '"box"' in diagnosis.text
    assert "0.05 m" in diagnosis.text
    assert 8.6 < diagnosis.place[0] < 11.4


@pytest.mark.parametrize(
    ("start", "name"), [((9.0, 8.0), '"box"'), ((8.8, 8.0), '"box"'), ((0.2, 8.0), "the edge of the workspace")]
)
def test_a_start_without_room_names_what_is_too_near(start, name):
    """Inside an obstacle, too near to one, too near to the edge: also when the problem never was a file."""
    with pytest.raises(NoPlanError) as caught:
        route([rectangle("box", (9.0, 7.3, 11.0, 9.0))], start=start)
    (diagnosis,) = caught.value.diagnoses
    assert diagnosis.code == "no-room"
    assert name in diagnosis.text


@pytest.mark.parametrize("footprint", [square(0.6), square(0.6, "path"), Footprint(0.3)])
@pytest.mark.parametrize("clearance", [0.0, 0.05])
def test_squares_find_their_way_with_and_without_clearance(footprint, clearance):
    """A fixed square passes corners as exactly as its Minkowski sum says; no bend is tighter than 1 cm."""
    found = plan(
        problem(robot(footprint=footprint), obstacles=[rectangle("box", (9.0, 5.0, 11.0, 8.0))], clearance=clearance)
    )
    assert found.certified
    assert np.abs(found.plan.robots[0].path.pieces[:, 1:]).max() <= 100.0 * (1 + 1e-9)


def test_a_fixed_square_passes_a_door_of_its_own_width_and_its_disc_does_not():
    """0.6 m wide with 1 cm to spare; the circumscribed disc would need 0.85 m."""
    walls = [rectangle("low", (9.0, 0.0, 11.0, 6.69)), rectangle("high", (9.0, 7.31, 11.0, 15.0))]
    found = plan(problem(robot(footprint=square(0.6)), obstacles=walls, clearance=0.0))
    assert found.certified
    with pytest.raises(NoPlanError):
        route(walls, footprint=Footprint(0.3 * math.sqrt(2)), clearance=0.0)


@pytest.mark.parametrize(
    ("shape", "made"), [("fitted", "fitted"), ("taut", "taut"), ("exponential", "fitted"), ("follow", "fitted")]
)
def test_a_route_names_the_shape_that_it_has(shape, made):
    """Past a place beside the line only two shapes apply; the others say that their turns are fitted ones, and why."""
    found = route([], via=((10.0, 9.0),), shape=shape)
    assert found.shape == made
    assert bool(found.remarks) == (shape != made)
