"""No robot comes nearer to an obstacle or to the edge of the workspace than the clearance, anywhere on its path."""

from __future__ import annotations

import math
import time

import pytest

from coord.verify import verify

R = 0.35  # a disc of 0.3 m at the clearance of 0.05 m


def check(build, robot, *obstacles, **given):
    return verify(build.data(build.plan([robot], obstacles=list(obstacles), **given)))


def codes(report):
    return {fault.code for fault in report.faults}


@pytest.mark.parametrize("short", [0.0, 1e-7, 1e-3])
def test_sliding_along_a_wall_and_past_corners_and_posts(build, short):
    """At exactly the clearance: a wall along the path, the tip of a wedge, a post; a hair nearer is refused."""
    walls = [
        build.rectangle("wall", -5, -2, 20, 0),
        build.polygon("wedge", (5, 0), (4, -2), (6, -2)),
        build.circle("post", 5, -1.5, 1.5),
    ]
    for obstacle in walls:
        report = check(build, build.robot("a", (0, R - short), (10, R - short)), obstacle)
        assert report.verdict == ("refused" if short else "certified")
        if short:
            (fault,) = report.faults
            assert fault.code == "obstacle"
            assert f'"{obstacle["name"]}"' in fault.text


@pytest.mark.parametrize("turn", [1.0, -2.5])
def test_hugging_a_corner_on_an_arc(build, turn):
    """The taut way round a corner touches it all along the arc; it is certified, quickly, and 1e-7 m less is not."""
    for short in (0.0, 1e-7):
        radius = R - short
        robot = build.robot(
            "a",
            (0, -radius),
            pieces=[[abs(turn) * radius, math.copysign(1 / radius, turn), math.copysign(1 / radius, turn)]],
            limits={"lateral_acceleration": 100.0},
        )
        centre = (0.0, 0.0) if turn > 0 else (0.0, -2 * radius)
        middle = (-math.pi / 2 if turn > 0 else math.pi / 2) + turn / 2  # where the arc is, seen from its centre
        away = [(centre[0] - math.cos(middle + a), centre[1] - math.sin(middle + a)) for a in (-0.1, 0.1)]
        tip = build.polygon("tip", centre, *away)
        begun = time.perf_counter()
        assert check(build, robot, tip).verdict == ("refused" if short else "certified")
        assert time.perf_counter() - begun < 0.2


def test_an_arc_bulges_between_its_ends(build):
    """Ends and chord of an arc are clear of a block that its middle comes 1 mm too near to."""
    radius, half = 4.0, 0.5
    top = radius * (1 - math.cos(half))
    start = [-radius * math.sin(half), 0.0]
    robot = build.robot("a", start, pieces=[[2 * half * radius, -1 / radius, -1 / radius]], turned=half)
    for gap, verdict in ((0.0, "certified"), (1e-3, "refused"), (1e-7, "refused")):
        block = build.rectangle("block", -0.2, top + R - gap, 0.2, top + 1)
        assert check(build, robot, block).verdict == verdict
        far = build.rectangle("far", -45, -45, 45, -40)  # makes the cells of the coarse search longer than the arc
        assert check(build, robot, block, far).verdict == verdict


def test_a_clothoid_is_followed_exactly(build):
    """A block set by the planner's own kind of sum at the clearance from a clothoid's end, moved by 1e-6 m."""
    robot = build.robot("a", (0, 0), pieces=[[3.0, 0.0, 1.0]], limits={"lateral_acceleration": 9.0})
    x, y = build.end_of([0.0, 0.0, 0.0], [[3.0, 0.0, 1.0]])
    c, s = math.cos(1.5), math.sin(1.5)  # heading at the end

    def wall(gap):
        far = [(x + c * u - s * v, y + s * u + c * v) for u, v in ((R + gap, -2), (R + gap + 1, -2), (R + gap + 1, 2))]
        return build.polygon("wall", *far, (x + c * (R + gap) - s * 2, y + s * (R + gap) + c * 2))

    assert check(build, robot, wall(1e-6)).certified
    assert not check(build, robot, wall(-1e-6)).certified


def test_a_robot_deep_inside_an_obstacle_is_found(build):
    """All edges are far away; only a count of turns round the point tells. A hole is free, an island in it is not."""
    robot = build.robot("a", (0, 0), (1, 0))
    hole = [[-30.0, -30.0], [-30.0, 30.0], [30.0, 30.0], [30.0, -30.0]]
    block = build.rectangle("block", -40, -40, 40, 40)
    report = check(build, robot, block)
    assert codes(report) == {"obstacle"}
    assert "inside" in report.faults[0].text
    assert check(build, robot, {**block, "holes": [hole]}).certified
    assert not check(build, robot, {**block, "holes": [hole]}, build.rectangle("island", -20, -20, 20, 20)).certified
    assert not check(build, robot, build.circle("pond", 3, 3, 40)).certified
    comb = [(-40, -40), (40, -40), (40, 40), (30, 40), (30, -30), (-30, -30), (-30, 40), (-40, 40)]
    assert check(build, robot, build.polygon("comb", *comb)).certified


def test_a_footprint_whose_reference_point_lies_on_its_edge_is_found_inside(build):
    """Its reference point lies on the obstacle's edge, neither in nor out; its middle tells."""
    box = {"polygon": [[0, -0.2], [1, -0.2], [1, 0.2], [0, 0.2]]}
    for x, goal, certified in ((2.0, 5.0, False), (6.0, 9.0, True)):
        robot = build.robot("a", (x, 0), (goal, 0), footprint=box)
        block = build.rectangle("block", 2, -3, 6, 3)
        assert check(build, robot, block, clearance=0.0).certified == certified


def test_a_robot_without_a_way_is_checked_where_it_stands(build):
    """At a wall and beside a post, at exactly the clearance and 1e-7 m nearer."""
    for short, verdict in ((0.0, "certified"), (1e-7, "refused")):
        y = R - short
        assert check(build, build.robot("a", (0, y), (0, y)), build.rectangle("w", -5, -1, 5, 0)).verdict == verdict
        assert check(build, build.robot("a", (0, y), (0, y)), build.circle("p", 0, -2, 2)).verdict == verdict


def test_something_small_between_the_corners_of_a_square_is_found(build):
    """A post inside the footprint touches none of its edges."""
    robot = build.robot("a", (0, 0), (9, 0), footprint={"square": 2.0})
    assert not check(build, robot, build.circle("pin", 4.5, 0.2, 0.01)).certified
    assert not check(
        build, build.robot("a", (0, 0), (0, 0), footprint={"square": 2.0}), build.circle("pin", 0.5, 0.2, 0.01)
    ).certified


@pytest.mark.parametrize("heading", ["fixed", "path"])
def test_squares_slide_between_walls_that_touch_them(build, heading):
    """No clearance at all: side on wall is certified, 1e-7 m into the wall is not, nor a slant of 1e-7 m."""
    walls = [build.rectangle("low", -5, -1, 20, 0), build.rectangle("high", 2, 0.6, 4, 3)]
    for end, verdict in ((0.3, "certified"), (0.3 + 1e-7, "refused"), (0.3 - 1e-7, "refused")):
        robot = build.robot("a", (0, 0.3), (10, end), footprint={"square": 0.6}, heading="fixed")
        assert check(build, robot, *walls, clearance=0.0).verdict == verdict
    robot = build.robot("a", (0, 0.3), (10, 0.3), footprint={"square": 0.6}, heading=heading)
    assert check(build, robot, *walls, clearance=0.0).certified


def test_a_box_that_turns_with_its_path_swings_its_corners_out(build):
    """In a bend to the left the outer front corner of a box runs on a larger circle than its middle."""
    box = {"polygon": [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.3], [-0.5, 0.3]]}
    reach = math.hypot(2 + 0.3, 0.5)  # of the outer corners, from the centre of the bend
    piece = [[math.pi, 0.5, 0.5]]
    for gap, verdict in ((1e-6, "certified"), (-1e-6, "refused")):
        robot = build.robot("a", (0, 0), pieces=piece, footprint=box, heading="path")
        wall = build.rectangle("wall", reach + 0.05 + gap, -9, 9, 9)
        assert check(build, robot, wall).verdict == verdict
        fixed = build.robot("a", (0, 0), pieces=piece, footprint=box)
        assert check(build, fixed, build.rectangle("wall", 2.5 + 0.05 + gap, -9, 9, 9)).verdict == verdict


@pytest.mark.parametrize("turn", [0, 1, 2, 3])
def test_the_edge_of_the_workspace(build, turn):
    """Touching it at the clearance is certified on every side; leaving it in the middle of an arc is refused."""
    for short, verdict in ((0.0, "certified"), (1e-7, "refused")):
        reach = 1.0 + R - short
        bounds = [-9.0, -9.0, 9.0, 9.0]
        bounds[turn] = -reach if turn < 2 else reach
        angle = (math.pi, -math.pi / 2, 0.0, math.pi / 2)[turn]  # where the circle is nearest to that side
        begin = angle - 0.4  # so that the nearest place is at no simple share of the arc
        robot = build.robot(
            "a",
            (math.cos(begin), math.sin(begin)),
            pieces=[[1.0, 1, 1]],
            turned=begin + math.pi / 2,
            limits={"lateral_acceleration": 9.0},
        )
        report = check(build, robot, bounds=bounds)
        assert report.verdict == verdict
        assert codes(report) <= {"workspace"}
    x, y = ((-9, 0), (0, -9), (9, 0), (0, 9))[turn]
    assert "workspace" in codes(check(build, build.robot("a", (0, 0), (x, y)), bounds=[-9, -9, 9, 9]))


def test_a_map_with_twenty_thousand_corners_takes_about_a_second(build):
    """A jagged outline, as maps have, and robots that slide along it at exactly the clearance."""
    n = 10_000
    low = [(0.005 * k, 0.0 if k % 4 < 2 else -0.05) for k in range(n)]
    high = [(0.005 * k, 3.0 if k % 4 < 2 else 3.05) for k in range(n - 1, -1, -1)]
    room = [list(p) for p in reversed([*low, *high])]
    walls = build.polygon("walls", (-5, -5), (60, -5), (60, 9), (-5, 9), holes=[room])
    robots = [build.robot(f"r{k}", (1 + 0.7 * k, R), (31 + 0.7 * k, R), departure=20 - k) for k in range(20)]
    data = build.data(build.plan(robots, obstacles=[walls], bounds=[-5, -5, 60, 9]))
    begun = time.process_time()
    report = verify(data)
    assert report.certified, report
    assert time.process_time() - begun < 6  # generous: the machine may be busy
    robots[7] = build.robot("r7", (1 + 0.7 * 7, R), (31 + 0.7 * 7, R - 1e-6), departure=13)
    report = verify(build.data(build.plan(robots, obstacles=[walls], bounds=[-5, -5, 60, 9])))
    assert [fault.robots for fault in report.faults] == [("r7",)]
