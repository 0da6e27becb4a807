"""Shortest paths round grown obstacles: known lengths, a second method, and what must not change them."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coord.geometry.growth
from coord.model.obstacle import Circle, Polygon, rectangle

BOUNDS = (0.0, 0.0, 20.0, 15.0)


def polygon(*vertices, holes=()):
    return Polygon("p", np.array(vertices, float), tuple(np.array(hole, float) for hole in holes))


def round_a_disc(a, b, angle, radius):
    """Two tangents and an arc: a, b from the centre, seen from it under an angle."""
    turn = angle - math.acos(radius / a) - math.acos(radius / b)
    return math.sqrt(a * a - radius * radius) + math.sqrt(b * b - radius * radius) + radius * turn


@pytest.mark.parametrize(("y", "reach", "q"), [(7.5, 0.3, 1.0), (7.1, 0.4, 2.0), (8.4, 0.25, 1.5), (7.5, 0.5, 3.0)])
def test_round_one_disc_the_length_is_two_tangents_and_an_arc(route, y, reach, q):
    """Start and goal at one height, the column between them: known to 1e-5 m, on the shorter side."""
    found, path = route([Circle("c", (10.0, 7.5), q)], BOUNDS, reach, (2.0, y), (17.0, y))
    a, b = math.hypot(8.0, y - 7.5), math.hypot(7.0, y - 7.5)
    angle = math.acos(((a * a + b * b) - 15.0**2) / (2 * a * b))
    expected = round_a_disc(a, b, angle, q + reach)
    assert expected <= found.length <= expected + 1e-5
    assert path.length == pytest.approx(found.length, abs=1e-9)
    side = np.sign(path.point(path.length / 2)[0, 1] - 7.5)
    assert y == 7.5 or side == np.sign(y - 7.5)


def test_where_nothing_is_in_the_way_the_path_is_straight(route):
    """Obstacles beside the line, one of them passed within 2 micrometres, change nothing."""
    obstacles = [Circle("c", (10.0, 9.0), 1.0), rectangle("r", (4.0, 2.0, 6.0, 7.2 - 2e-6))]
    found, path = route(obstacles, BOUNDS, 0.3, (1.0, 7.5), (19.0, 7.5))
    assert (found.length, path.pieces[:, 1:].any(), found.turns) == (18.0, False, ())


@pytest.mark.parametrize("seed", range(40))
def test_no_polyline_round_polygons_beats_it_nor_lies_it_below(route, sandwich, keeps_clear, floors, seed):
    """Visibility graphs round inner and outer polygons of the grown obstacles enclose the length; the path keeps clear."""
    floor = floors(seed, 6)
    low, high = sandwich(*floor, sides=16)
    found = route(*floor)
    if found is None:
        assert high == math.inf
    else:
        skeleton, path = found
        assert low - 1e-9 <= skeleton.length <= high + 1e-9
        assert path.length == pytest.approx(skeleton.length, abs=1e-8)
        keeps_clear(path, *floor)


LOST_CUTS = "geometry/blocked.py: arccos of 1 + 1e-16 is nan, so that a cut of a circle at a tangent is lost"


def test_floors_on_which_tangents_were_lost(route, sandwich, floors):
    """Twelve of 2,000 random floors on which the path was up to half too long, or there was none."""
    for seed in (240, 252, 387, 392, 469, 522, 549, 560, 650, 744, 828, 867):
        floor = floors(seed, 10)
        low, high = sandwich(*floor, sides=12)
        found = route(*floor)
        assert found is not None
        assert low - 1e-9 <= found[0].length <= high + 1e-9


def test_round_one_pentagon_there_is_a_way(route):
    """A single convex obstacle never shuts anybody in."""
    pentagon = polygon(
        (8.147693786064849, 13.956421656248896),
        (7.2681123648198, 14.671683274315747),
        (4.4520472904560275, 12.867003620060224),
        (6.1071112971779975, 10.809366408685058),
        (8.441888697031327, 12.291499721464143),
    )
    start, goal = (2.1740074046698132, 13.12213909850557), (16.364012363851614, 10.59444360545612)
    assert route([pentagon], BOUNDS, 0.38973386679240374, start, goal) is not None


def mirrored(obstacle):
    if isinstance(obstacle, Circle):
        return Circle(obstacle.name, (20.0 - obstacle.center[0], obstacle.center[1]), obstacle.radius)
    return Polygon(obstacle.name, np.array([20.0, 0.0]) + obstacle.vertices * np.array([-1.0, 1.0]))


@pytest.mark.parametrize("seed", range(104, 124))
def test_a_mirrored_floor_has_a_path_of_the_same_length(route, floors, seed):
    """Left and right, and start and goal, can be exchanged."""
    obstacles, bounds, reach, start, goal = floors(seed, 6)
    found = route(obstacles, bounds, reach, start, goal)
    turned = [mirrored(obstacle) for obstacle in obstacles]
    other = route(turned, bounds, reach, (20 - start[0], start[1]), (20 - goal[0], goal[1]))
    back = route(obstacles, bounds, reach, goal, start)
    assert (found is None) == (other is None) == (back is None)
    if found is not None:
        assert other[0].length == pytest.approx(found[0].length, abs=1e-8)
        assert back[0].length == pytest.approx(found[0].length, abs=1e-8)


@pytest.mark.parametrize("seed", range(200, 220))
def test_more_obstacles_or_a_larger_robot_never_shorten_the_path(route, floors, seed):
    """Leaving out the last obstacle, or 5 cm of the robot, gives no longer path."""
    obstacles, bounds, reach, start, goal = floors(seed, 6)
    whole = route(obstacles, bounds, reach, start, goal)
    fewer, slimmer = (
        route(obstacles[:-1], bounds, reach, start, goal),
        route(obstacles, bounds, reach - 0.05, start, goal),
    )
    if whole is not None:
        assert fewer[0].length <= whole[0].length + 1e-9
        assert slimmer[0].length <= whole[0].length + 1e-9


def wall_with_gap(width, reach):
    """A wall from edge to edge with a gap of a width, off the line."""
    return [rectangle("low", (9.0, 0.0, 11.0, 9.0)), rectangle("high", (9.0, 9.0 + width, 11.0, 15.0))]


def test_a_gap_a_little_wider_than_the_robot_is_used(route, keeps_clear):
    """10 micrometres more than twice the reach suffice, and the path goes through the gap."""
    obstacles = wall_with_gap(2 * 0.4 + 1e-5, 0.4)
    found, path = route(obstacles, BOUNDS, 0.4, (2.0, 3.0), (18.0, 3.0))
    keeps_clear(path, obstacles, BOUNDS, 0.4, (2.0, 3.0), (18.0, 3.0))
    rho, dx, dy = 0.4, 7.0, 6.4 - 0.4
    # into the gap round the corner (9, 9), straight through, out again round (11, 9)
    corner = math.hypot(dx, 9.0 - 3.0)
    turn = math.pi / 2 - (math.atan2(dx, 9.0 - 3.0) - math.asin(rho / corner))
    assert dy > 0
    assert found.length == pytest.approx(2 * math.sqrt(corner**2 - rho**2) + 2 * rho * turn + 2.0, abs=1e-4)


def test_a_gap_a_little_narrower_than_the_robot_is_not_used(route):
    """10 micrometres less than twice the reach, and no other way: none is found."""
    assert route(wall_with_gap(2 * 0.4 - 1e-5, 0.4), BOUNDS, 0.4, (2.0, 3.0), (18.0, 3.0)) is None


def test_through_a_narrow_door_or_a_long_way_round(route):
    """The wall ends before the edge: with the door too narrow by 10 micrometres the path goes round the end."""
    for change, through in ((1e-5, True), (-1e-5, False)):
        low, high = wall_with_gap(0.8 + change, 0.4)
        shorter = rectangle("high", (9.0, float(high.vertices[0, 1]), 11.0, 13.0))
        found, path = route([low, shorter], BOUNDS, 0.4, (2.0, 3.0), (18.0, 3.0))
        assert (path.point(np.linspace(0, path.length, 500))[:, 1].max() < 9.5) == through


def test_out_of_a_trap(route, sandwich, keeps_clear):
    """From within a U that opens away from the goal the path goes back, out, and round one arm."""
    trap = polygon((4, 4), (12, 4), (12, 11), (4, 11), (4, 10), (11, 10), (11, 5), (4, 5))
    floor = ([trap], BOUNDS, 0.35, (10.0, 7.5), (18.0, 7.5))
    low, high = sandwich(*floor, sides=48)
    found, path = route(*floor)
    assert low <= found.length <= high
    assert found.length > 20.0
    assert path.point(np.linspace(0, path.length, 500))[:, 0].min() < 4.0
    keeps_clear(path, *floor)


def test_through_a_comb(route, sandwich, keeps_clear):
    """Five walls from alternate edges make a serpentine: every tooth is turned round, two corners each."""
    teeth = [
        rectangle(f"t{k}", (3.0 + 3 * k, 0.0, 3.5 + 3 * k, 12.0) if k % 2 else (3.0 + 3 * k, 3.0, 3.5 + 3 * k, 15.0))
        for k in range(5)
    ]
    floor = (teeth, BOUNDS, 0.4, (1.0, 13.0), (19.0, 13.0))
    low, high = sandwich(*floor, sides=16)
    found, path = route(*floor)
    assert low <= found.length <= high
    assert len(found.turns) == 10
    keeps_clear(path, *floor)


@pytest.mark.parametrize("gap", [0.0, 1e-9, 1e-7, 1e-6, 2e-6, 1e-3])
def test_a_start_may_touch_an_obstacle(route, keeps_clear, gap):
    """Start and goal at exactly the reach from a column and a rack, or a hair more: a path that keeps clear of both."""
    obstacles = [Circle("c", (5.0, 7.5), 1.0), rectangle("r", (14.0, 6.0, 16.0, 9.0))]
    floor = (obstacles, BOUNDS, 0.4, (5.0 - 1.4 - gap, 7.5), (16.4 + gap, 7.5))
    found = route(*floor)
    assert found is not None
    keeps_clear(found[1], *floor)
    for behind in ((5.0 + 1.4 + gap, 7.5), (5.0, 8.9 + gap)):
        floor = (obstacles, BOUNDS, 0.4, (5.0 - 1.4 - gap, 7.5), behind)
        found = route(*floor)
        assert found is not None
        keeps_clear(found[1], *floor)


def test_a_start_may_touch_the_edge_of_the_floor(route, keeps_clear):
    """In a corner, at exactly the reach from both edges, with an obstacle before it."""
    floor = ([Circle("c", (3.0, 3.0), 1.0)], BOUNDS, 0.4, (0.4, 0.4), (19.6, 14.6))
    found = route(*floor)
    assert found is not None
    keeps_clear(found[1], *floor)


def test_overlapping_and_touching_obstacles_are_one(route):
    """Two halves, two overlapping parts, or the whole: the same length; so for a column inside a rack."""
    start, goal, reach = (2.0, 7.0), (18.0, 8.0), 0.4
    whole = [rectangle("w", (6.0, 5.0, 14.0, 10.0))]
    others = [
        [rectangle("a", (6.0, 5.0, 10.0, 10.0)), rectangle("b", (10.0, 5.0, 14.0, 10.0))],
        [rectangle("a", (6.0, 5.0, 11.0, 10.0)), rectangle("b", (9.0, 5.0, 14.0, 10.0))],
        [*whole, Circle("c", (10.0, 7.5), 1.0), rectangle("b", (7.0, 6.0, 8.0, 7.0))],
        [*whole, *whole],
    ]
    length = route(whole, BOUNDS, reach, start, goal)[0].length
    for parts in others:
        assert route(parts, BOUNDS, reach, start, goal)[0].length == pytest.approx(length, abs=1e-8)


def test_no_path_squeezes_between_obstacles_that_touch(route):
    """Columns in a row that touch, and racks that share one corner, are a wall; 10 micrometres apart from 2 reach they are none."""
    row = [Circle(f"c{k}", (10.0, 1.0 + 2 * k), 1.0) for k in range(7)] + [Circle("last", (10.0, 14.5), 0.5)]
    assert route(row, BOUNDS, 0.3, (2.0, 7.5), (18.0, 7.5)) is None
    corners = [rectangle("a", (9.0, 0.0, 10.0, 7.0)), rectangle("b", (10.0, 7.0, 11.0, 15.0))]
    assert route(corners, BOUNDS, 0.3, (2.0, 7.5), (18.0, 7.5)) is None


def test_rooms_have_a_door_or_none(route, keeps_clear):
    """An obstacle with a hole: inside it all places can be reached, nobody gets out; a C lets out through its opening."""
    room = polygon((4, 3), (16, 3), (16, 12), (4, 12), holes=[[(5, 4), (15, 4), (15, 11), (5, 11)]])
    column = Circle("c", (10.0, 7.5), 1.5)
    inside = ([room, column], BOUNDS, 0.4, (6.0, 7.5), (14.0, 7.5))
    found = route(*inside)
    assert found is not None
    keeps_clear(found[1], *inside)
    assert route([room], BOUNDS, 0.4, (10.0, 7.5), (18.0, 7.5)) is None
    assert route([room], BOUNDS, 0.4, (18.0, 7.5), (10.0, 7.5)) is None
    c_shape = polygon(
        (4, 3), (16, 3), (16, 12), (4, 12), (4, 9), (5, 9), (5, 11), (15, 11), (15, 4), (5, 4), (5, 6), (4, 6)
    )
    floor = ([c_shape], BOUNDS, 0.4, (10.0, 7.5), (18.0, 7.5))
    found = route(*floor)
    assert found is not None
    keeps_clear(found[1], *floor)


def star(count):
    """A star with deep notches: 2 count vertices."""
    angles = np.arange(2 * count) * np.pi / count
    radii = np.where(np.arange(2 * count) % 2, 4.0, 2.5)
    return polygon(*np.stack([10.0 + radii * np.cos(angles), 7.5 + radii * np.sin(angles)], axis=1))


@pytest.mark.parametrize("most", [8, 12, 16, 10**6])
def test_cutting_an_obstacle_into_parts_changes_no_length(route, keeps_clear, monkeypatch, most):
    """A star of 60 vertices, cut until no part has more than 8, 12 or 16, or not at all."""
    floor = ([star(30)], BOUNDS, 0.1, (5.2, 7.3), (14.8, 7.9))
    expected = route(*floor)[0].length
    monkeypatch.setattr(coord.geometry.growth, "_MOST_VERTICES", most)
    found, path = route(*floor)
    assert found.length == pytest.approx(expected, abs=1e-7)
    keeps_clear(path, *floor)


def test_many_obstacles_are_no_burden(route, keeps_clear):
    """300 columns in a lattice: found lazily, and clear of all of them."""
    columns = [Circle(f"c{i}-{k}", (1.5 + i, 1.5 + k * 0.95), 0.2) for i in range(18) for k in range(13)]
    floor = (columns, BOUNDS, 0.2, (0.5, 7.0), (19.5, 8.5))
    found = route(*floor)
    assert found is not None
    keeps_clear(found[1], *floor)
    assert found[0].length < 1.05 * math.hypot(19.0, 1.5)
