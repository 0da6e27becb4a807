"""Exponential detours: least-squares flanks, smooth, clear of everything, or fitted turns with a reason."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.alone.fastest import fastest
from coord.geometry.clearance import keeps_distance
from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.robot import Limits
from coord.paths.exponential import exponential, hull_points
from coord.paths.fitted import fitted
from coord.paths.skeleton import NoWay, search_floor, skeleton

BOUNDS = (0.0, 0.0, 20.0, 15.0)
LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
TRAP = Polygon("trap", [(8, 4), (12, 4), (12, 10), (8, 10), (8, 9), (11, 9), (11, 5), (8, 5)])


def solve(obstacles, bounds, reach, start, goal):
    """Floor, skeleton and the exponential answer; None where there is no way."""
    floor = search_floor(grow(obstacles, Footprint(reach), 0.0, bounds), (start, goal))
    found = skeleton(floor, start, goal)
    return None if isinstance(found, NoWay) else (floor, found, exponential(found, LIMITS, floor))


@pytest.mark.parametrize("seed", range(500, 530))
def test_it_keeps_clear_and_ends_in_the_goal_or_says_why_not(keeps_clear, floors, seed):
    """On 30 random floors; where it applies, its curvature never jumps and its distances are certified."""
    scene = floors(seed, 5)
    found = solve(*scene)
    if found is None:
        return
    floor, bones, shaped = found
    keeps_clear(shaped.path, *scene)
    assert bool(shaped.fits) != bool(shaped.remarks) or not bones.turns
    if shaped.fits:
        pieces = shaped.path.pieces
        assert pieces[:-1, 2].tolist() == pieces[1:, 1].tolist()
        assert pieces[0, 1] == pieces[-1, 2] == 0.0
        assert keeps_distance(floor, shaped.path)
        assert shaped.path.length >= bones.length


@pytest.mark.parametrize(
    "scene",
    [
        ([Circle("c", (10, 7), 1.5)], 0.3, (2.0, 7.3), (18.0, 7.3)),
        ([rectangle("r", (8, 5, 12, 9))], 0.3, (2.0, 7.1), (18.0, 7.1)),
    ],
)
def test_a_symmetric_obstacle_rises_as_it_falls(scene):
    """A and R^2 of both flanks are equal, and B is opposite; the path is its own mirror image."""
    obstacles, reach, start, goal = scene
    _, _, shaped = solve(obstacles, BOUNDS, reach, start, goal)
    rise, fall = shaped.fits
    assert (rise.flank, fall.flank) == ("rise", "fall")
    assert rise.B > 0
    assert abs(fall.B + rise.B) < 1e-9 * rise.B
    assert abs(fall.A - rise.A) < 1e-9 * rise.A
    assert abs(fall.r_squared - rise.r_squared) < 1e-9
    s = np.linspace(0, shaped.path.length, 101)
    places = shaped.path.point(s)
    assert places[::-1] * (-1, 1) + (20, 0) == pytest.approx(places, abs=1e-6)


def test_reported_flanks_are_the_least_squares_line_in_ln_y():
    """The slope, the offset and R^2 are those that numpy's own fit finds for the points of the hull."""
    start, goal = (2.0, 7.0), (18.0, 7.0)
    floor, _, shaped = solve([rectangle("r", (8, 6, 11, 9), 0.2)], BOUNDS, 0.3, start, goal)
    groups = hull_points(floor, shaped.path, LIMITS)
    assert len(groups) == len(shaped.fits) == 2
    for fit, points in zip(shaped.fits, groups, strict=True):
        x, ln_y = points[:, 0], np.log(np.abs(points[:, 1] - 7.0))
        B, offset = np.polyfit(x, ln_y, 1)
        assert pytest.approx(B, rel=1e-9) == fit.B
        assert fit.r_squared == pytest.approx(np.corrcoef(x, ln_y)[0, 1] ** 2, abs=1e-9)
    # both flanks measure x from the same place, the detour's middle
    middles = []
    for fit, points in zip(shaped.fits, groups, strict=True):
        B, offset = np.polyfit(points[:, 0], np.log(np.abs(points[:, 1] - 7.0)), 1)
        middles.append((math.log(fit.A) - offset) / B)
    assert middles[0] == pytest.approx(middles[1], abs=1e-6)
    assert 8 < middles[0] < 11


def test_the_mirrored_floor_has_the_mirrored_path():
    """Left and right are alike: the same pieces with the opposite curvature, and the same fits."""
    one = solve([Circle("c", (9, 7.5), 1.2)], BOUNDS, 0.3, (2.0, 7.0), (18.0, 7.0))[2]
    other = solve([Circle("c", (9, 6.5), 1.2)], BOUNDS, 0.3, (2.0, 7.0), (18.0, 7.0))[2]
    assert other.path.pieces == pytest.approx(one.path.pieces * (1, -1, -1), abs=1e-9)
    assert [fit.B for fit in other.fits] == pytest.approx([fit.B for fit in one.fits])


def test_two_obstacles_far_apart_get_a_detour_each_and_the_line_in_between():
    """Four flanks; half way between them the robot is on the straight line and drives along it."""
    _, _, shaped = solve(
        [Circle("a", (20, 7.3), 0.6), Circle("b", (60, 6.7), 0.6)], (0, 0, 80, 15), 0.3, (1.0, 7.0), (79.0, 7.0)
    )
    assert [fit.flank for fit in shaped.fits] == ["rise", "fall", "rise", "fall"]
    poses = shaped.path.pose(np.linspace(0, shaped.path.length, 4001))
    between = poses[np.abs(poses[:, 0] - 40) < 3]
    assert len(between)
    assert np.abs(between[:, 1] - 7).max() < 1e-9
    assert np.abs(between[:, 2]).max() < 1e-9
    assert poses[:, 1].min() < 6.4
    assert poses[:, 1].max() > 7.6


def test_obstacles_close_together_are_passed_in_one_go():
    """Two columns on the same side, closer than their detours are high, share a rise and a fall."""
    _, _, shaped = solve(
        [Circle("a", (9, 6.6), 0.8), Circle("b", (11.4, 6.6), 0.8)], BOUNDS, 0.3, (1.0, 7.0), (19.0, 7.0)
    )
    assert [fit.flank for fit in shaped.fits] == ["rise", "fall"]


@pytest.mark.parametrize(
    ("obstacle", "start", "reason"),
    [
        (TRAP, (9.5, 7.1), "turns back along the straight line"),
        (rectangle("wall", (9.0, 0.0, 10.0, 7.0)), (8.2, 2.0), "too little room for its feet"),
    ],
)
def test_where_a_detour_has_no_graph_or_no_room_the_turns_are_fitted_and_a_remark_says_so(obstacle, start, reason):
    """Out of a trap one must go back first; right in front of a wall nothing can rise along the line."""
    floor, bones, shaped = solve([obstacle], BOUNDS, 0.3, start, (18.0, start[1]))
    assert not shaped.fits
    (remark,) = shaped.remarks
    assert remark.startswith("Fitted turns instead of exponential ones: ")
    assert reason in remark
    assert shaped.path.pieces.tolist() == fitted(bones, LIMITS, floor).pieces.tolist()


def test_obstacles_on_both_sides_leave_no_room():
    """Through the gap of a chicane no exponential fits; the remark says where."""
    walls = [rectangle("a", (9.0, 6.0, 9.4, 14.9)), rectangle("b", (10.4, 0.1, 10.8, 8.0))]
    _, bones, shaped = solve(walls, BOUNDS, 0.3, (2.0, 7.0), (18.0, 7.0))
    assert len(bones.turns) > 1
    assert shaped.remarks


def test_it_is_hardly_slower_than_the_fitted_path():
    """With room on the line, over six scenes: 12 % at most on average, and never quicker by more than the timing's noise."""
    scenes = [
        ([Circle("c", (10, 7), 1.5)], 0.3, (2.0, 7.2), (18.0, 7.2)),
        ([Circle("c", (10, 7), 0.5)], 0.5, (2.0, 7.9), (18.0, 7.9)),
        ([rectangle("r", (8, 5, 12, 9))], 0.3, (2.0, 7.1), (18.0, 7.1)),
        ([rectangle("r", (9, 0, 10, 5))], 0.3, (2.0, 2.5), (18.0, 2.5)),
        ([Polygon("p", [(8, 6), (12, 7), (9, 9)])], 0.4, (2.0, 7.0), (18.0, 7.0)),
        ([Circle("a", (7, 7.4), 0.6), Circle("b", (13, 6.6), 0.6)], 0.2, (1.0, 7.0), (19.0, 7.0)),
    ]
    ratios = []
    for obstacles, reach, start, goal in scenes:
        floor, bones, shaped = solve(obstacles, BOUNDS, reach, start, goal)
        assert shaped.fits
        ratios.append(fastest(shaped.path, LIMITS).arrival / fastest(fitted(bones, LIMITS, floor), LIMITS).arrival)
    assert np.mean(ratios) < 1.12
    assert min(ratios) > 0.97


def test_where_nothing_is_in_the_way_the_path_is_straight():
    """No detour, one line."""
    _, _, shaped = solve([], BOUNDS, 0.3, (3.0, 2.0), (16.0, 2.0))
    assert shaped.path.pieces.tolist() == [[13.0, 0.0, 0.0]]
    assert not shaped.fits
    assert not shaped.remarks


def test_with_little_room_at_the_start_it_leaves_at_an_angle_and_is_hardly_slower():
    """A start 1 m before a box two metres wide has no room for a foot along the line: at an angle it costs 12 % at most.

    The path still begins and ends in start and goal to 1e-9 m, and comes back to the line along it or at an angle.
    """
    start, goal = (6.5, 7.0), (18.0, 7.0)
    floor, bones, shaped = solve([rectangle("r", (8, 5, 10, 8.5))], BOUNDS, 0.4, start, goal)
    assert shaped.fits
    assert abs(shaped.path.poses[0, 2]) > 0.1
    assert shaped.path.end == pytest.approx(goal, abs=1e-9)
    ratio = fastest(shaped.path, LIMITS).arrival / fastest(fitted(bones, LIMITS, floor), LIMITS).arrival
    assert ratio < 1.12
