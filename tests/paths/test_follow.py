"""Following the edge of what is in the way: the line, the edge at the set distance, and fillets between them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coord.geometry.growth import grow
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.robot import Limits
from coord.paths.follow import follow
from coord.paths.skeleton import NoWay, search_floor, skeleton

BOUNDS = (0.0, 0.0, 20.0, 15.0)
LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
TRAP = Polygon("trap", [(8, 4), (12, 4), (12, 10), (8, 10), (8, 9), (11, 9), (11, 5), (8, 5)])


def floor_of(obstacles, bounds, reach, start, goal):
    return search_floor(grow(obstacles, Footprint(reach), 0.0, bounds), (start, goal))


def way(obstacles, reach, start, goal, side=None, corner_radius=0.2, bounds=BOUNDS):
    return follow(floor_of(obstacles, bounds, reach, start, goal), start, goal, LIMITS, side, corner_radius)


@pytest.mark.parametrize("seed", range(600, 640))
def test_it_keeps_clear_ends_in_the_goal_and_is_no_shorter_than_the_shortest_way(keeps_clear, floors, seed):
    """On 40 random floors, with obstacles that overlap each other and the edge of the floor."""
    scene = floors(seed, 6)
    floor = floor_of(*scene)
    bones = skeleton(floor, *scene[3:])
    shaped = follow(floor, *scene[3:], LIMITS)
    if isinstance(bones, NoWay):
        assert isinstance(shaped, str)
        return
    keeps_clear(shaped.path, *scene)
    assert shaped.path.length >= bones.length - 1e-6
    assert not shaped.remarks


@pytest.mark.parametrize(("radius", "offset"), [(0.2, 0.0), (0.01, 0.0), (0.5, 0.7)])
def test_round_a_circle_it_is_lines_fillets_and_an_arc_of_known_length(radius, offset):
    """Grown to R = 1.8 m, at an offset d, with fillets r: their centres are R + r from the circle's and r from the line."""
    shaped = way([Circle("c", (10.0, 7.0 - offset), 1.5)], 0.3, (2.0, 7.0), (18.0, 7.0), "left", radius)
    R, d = 1.8, offset
    beta = math.asin((d + radius) / (R + radius))  # from the circle's centre to the fillets' centres
    half = (R + radius) * math.cos(beta)
    expected = 16 - 2 * half + 2 * radius * (math.pi / 2 - beta) + R * (math.pi - 2 * beta)
    assert shaped.path.length == pytest.approx(expected, abs=1e-4)
    assert len(shaped.path.pieces) == 5


@pytest.mark.parametrize("obstacle", [TRAP, rectangle("r", (8, 5, 12, 9), 0.4), Circle("c", (10, 6.5), 2.0)])
def test_the_side_is_left_or_right_of_the_obstacle_and_the_shorter_one_by_default(obstacle):
    """Seen from start to goal; the lengths of both sides are compared."""
    left, right, best = (way([obstacle], 0.3, (2.0, 7.2), (18.0, 7.2), side) for side in ("left", "right", None))
    s = np.linspace(0, 1, 2001)
    assert left.path.point(s * left.path.length)[:, 1].min() > 7.2 - 3.0
    for shaped, sign in ((left, 1), (right, -1)):
        above = sign * (shaped.path.point(s * shaped.path.length)[:, 1] - 7.2)
        beside = np.abs(shaped.path.point(s * shaped.path.length)[:, 0] - 12.2) < 0.05
        assert above.max() > 1
        assert np.all(above[beside] > -1e-9)
    assert best.path.length == min(left.path.length, right.path.length)


def test_it_follows_into_a_trap_and_out_again_at_the_set_distance():
    """Every place is on the straight line, or at the set distance from the trap, but for what fillets cut off."""
    start, goal = (2.0, 7.1), (18.0, 7.1)
    shaped = way([TRAP], 0.3, start, goal)
    assert shaped.path.length > 25
    places = shaped.path.point(np.linspace(0, shaped.path.length, 3000))
    a = TRAP.vertices
    b = np.roll(a, -1, axis=0)
    share = ((places[:, None] - a) * (b - a)).sum(axis=2) / ((b - a) ** 2).sum(axis=1)
    foot = a + np.clip(share, 0, 1)[..., None] * (b - a)
    far = np.hypot(*(places[:, None] - foot).transpose(2, 0, 1)).min(axis=1)
    off = np.minimum(np.abs(far - 0.3), np.abs(places[:, 1] - 7.1))
    assert off.max() < 0.2 * (math.sqrt(2) - 1) + 1e-5
    assert far.min() >= 0.3


def test_where_grown_obstacles_meet_the_corner_is_a_fillet_too():
    """Between two overlapping grown columns the edge has a concave corner; nothing is tighter than was asked for."""
    shaped = way([Circle("a", (8.5, 7.0), 1.0), Circle("b", (11.0, 7.0), 1.0)], 0.3, (2.0, 7.0), (18.0, 7.0))
    bends = shaped.path.pieces[shaped.path.pieces[:, 1] != 0]
    assert len(bends) == 5
    assert 1 / np.abs(bends[:, 1]).max() == pytest.approx(0.2)
    # with the obstacle to one side, the edge bends towards it, and fillets away from it
    signs = np.sign(bends[:, 1])
    assert signs.tolist() == (signs[0] * np.array([1, -1, 1, -1, 1])).tolist()


def test_where_the_edge_leaves_the_floor_the_other_side_is_taken():
    """A wall from the lower edge of the floor: only its upper end can be passed, and asking for the other has a reason."""
    wall = [rectangle("w", (9.0, 0.0, 10.0, 7.0))]
    over = way(wall, 0.3, (3.0, 2.0), (16.0, 2.0))
    assert not over.remarks
    assert over.path.point([over.path.length / 2])[0, 1] == pytest.approx(7.3, abs=1e-4)
    reason = way(wall, 0.3, (3.0, 2.0), (16.0, 2.0), "right")
    assert reason == "after 5.70 m of the straight line the edge of the obstacle leaves the floor there"


def test_several_obstacles_are_followed_one_after_the_other():
    """Three columns on the line, three times the length that one costs."""
    columns = [Circle(f"c{k}", (6.0 + 4 * k, 7.0), 0.5) for k in range(3)]
    one = way(columns[:1], 0.3, (2.0, 7.0), (18.0, 7.0)).path.length - 16
    all_three = way(columns, 0.3, (2.0, 7.0), (18.0, 7.0)).path.length - 16
    assert all_three == pytest.approx(3 * one, abs=1e-9)


def test_a_start_and_a_goal_that_touch_the_obstacle_lie_on_its_edge():
    """From one side of a column to the other at exactly the reach: half a circle, without fillets."""
    shaped = way([Circle("c", (5.0, 7.5), 1.0)], 0.4, (5.0, 6.1), (5.0, 8.9))
    assert not shaped.remarks
    assert shaped.path.length == pytest.approx(math.pi * 1.4, abs=1e-6)


def test_where_nothing_is_in_the_way_or_nowhere_to_go_the_path_is_straight():
    """One line; no pieces."""
    assert way([], 0.3, (3.0, 2.0), (16.0, 2.0)).path.pieces.tolist() == [[13.0, 0.0, 0.0]]
    assert len(way([], 0.3, (3.0, 2.0), (3.0, 2.0)).path.pieces) == 0


def test_the_mirrored_floor_has_the_mirrored_path():
    """Left and right are alike."""
    one = way([Circle("a", (8.0, 7.3), 1.0), Circle("b", (9.5, 8.1), 1.0)], 0.3, (2.0, 7.0), (18.0, 7.0))
    other = way([Circle("a", (8.0, 6.7), 1.0), Circle("b", (9.5, 5.9), 1.0)], 0.3, (2.0, 7.0), (18.0, 7.0))
    assert other.path.pieces == pytest.approx(one.path.pieces * (1, -1, -1), abs=1e-9)
