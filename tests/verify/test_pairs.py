"""Two robots keep the clearance at all times, or the plan is refused."""

from __future__ import annotations

import math
import time

import pytest

from coord.verify import verify

TOUCH = 0.65  # two discs of 0.3 m at the clearance of 0.05 m


def check(build, *robots, **given):
    return verify(build.data(build.plan(robots, **given)))


def arc(radius, turn):
    """A piece: an arc of a radius through an angle."""
    return [abs(turn) * radius, math.copysign(1 / radius, turn), math.copysign(1 / radius, turn)]


def circling(build, name, radius, turn, **given):
    """A robot that drives round the origin."""
    return build.robot(
        name,
        (0, -radius if turn > 0 else radius),
        pieces=[arc(radius, turn)],
        limits={"lateral_acceleration": 100.0, **given},
    )


@pytest.mark.parametrize("angle", [0.0, 0.3, math.pi / 2, 2.0])
@pytest.mark.parametrize("way", ["resting", "passing", "meeting", "following", "overtaking"])
def test_touching_exactly_is_certified_and_at_once_and_a_hair_less_is_refused(build, way, angle):
    """Two robots at exactly the clearance, at rest and in motion on lines; 1e-7 m decides."""
    c, s = math.cos(angle), math.sin(angle)

    def place(x, y):
        return c * x - s * y, s * x + c * y

    for short in (0.0, 1e-7, 1e-3):
        d = TOUCH - short
        first = build.robot("a", place(0, 0), place(10, 0))
        second = {
            "resting": lambda d=d: build.robot("b", place(5, d), place(5, d)),
            "passing": lambda d=d: build.robot("b", place(0, d), place(10, d)),
            "meeting": lambda d=d: build.robot("b", place(10, d), place(0, d), departure=0.37),
            "following": lambda d=d: build.robot("b", place(d, 0), place(10 + d, 0)),
            "overtaking": lambda d=d: build.robot("b", place(2, d), place(8, d), limits={"speed": 0.3}),
        }[way]()
        begun = time.perf_counter()
        report = check(build, first, second)
        assert time.perf_counter() - begun < 0.2
        assert report.verdict == ("refused" if short else "certified"), report
        assert report.min_clearance.value == pytest.approx(0.05 - short, abs=1e-6)


def test_touching_exactly_is_certified_far_from_the_origin(build):
    """At 1e6 m doubles are 1e-10 m apart; the margins hold all the same."""
    x, y, far = 8e5, -9e5, [-1e6, -1e6, 1e6, 1e6]
    for short, verdict in ((0.0, "certified"), (1e-7, "refused")):
        d = TOUCH - short
        for goal in ((x, y + d), (x + 10, y + d)):
            pair = build.robot("a", (x, y), (x + 10, y)), build.robot("b", (x + 10, y + d), goal)
            assert check(build, *pair, bounds=far).verdict == verdict


@pytest.mark.parametrize("turn", [0.5, -6.2])
def test_touching_exactly_in_bends_is_certified(build, turn):
    """Round a robot at rest on an arc, and side by side on two arcs with one centre at one angle."""
    for short in (0.0, 1e-7):
        parked = build.robot("b", (0, 0), (0, 0))
        report = check(build, circling(build, "a", TOUCH - short, turn), parked)
        assert report.verdict == ("refused" if short else "certified"), report
        turn = math.copysign(0.5, turn)  # halving both bends takes a thousand steps or more a radian
        scale = (2 + TOUCH - short) / 2
        faster = {key: scale * value for key, value in build.limits.items() if key != "lateral_acceleration"}
        outer = circling(build, "b", 2 + TOUCH - short, turn, **faster)
        report = check(build, circling(build, "a", 2, turn), outer)
        assert report.verdict == ("refused" if short else "certified"), report


def test_a_collision_names_robots_place_time_and_distance(build):
    """Two robots that cross in the middle."""
    report = check(build, build.robot("a", (0, 0), (10, 0)), build.robot('b"', (5, -5), (5, 5)))
    (fault,) = report.faults
    assert (fault.code, fault.robots) == ("collision", ("a", 'b"'))
    assert fault.place == pytest.approx((5, 0), abs=1e-3)
    assert fault.time == pytest.approx(sum(h for h, _ in build.phases(10, build.limits)) / 2, abs=0.5)
    for words in ('"a"', '"b\\""', "t = ", "clearance is 0.05 m"):
        assert words in fault.text
    assert report.min_clearance.value == 0.0


def test_the_worst_of_a_collision_is_reported_although_it_lasts(build):
    """Phase after phase two robots overlap; distance and time are those of the deepest place."""
    robots = [build.robot(name, start, goal) for name, start, goal in (("a", (0, 0), (0, -1)), ("b", (0, -1), (2, 1)))]
    far = build.robot("c", (9, 9), (9.64, 9))  # too near as well, so that a lower value is known before
    report = check(build, *robots, far, build.robot("d", (9, 9), (9, 9)), clearance=0.1)
    fault = next(fault for fault in report.faults if fault.robots == ("a", "b"))
    assert fault.time == pytest.approx(1.66, abs=0.01)
    assert "overlap by 0.2084" in fault.text


def test_swapped_profiles_are_refused(build):
    """Robots cross one after the other; with their profiles exchanged they meet."""
    first, second = build.robot("a", (0, 0), (10, 0)), build.robot("b", (5, -5), (5, 5), departure=3.0)
    assert check(build, first, second).certified
    late, early = build.robot("a", (0, 0), (10, 0), departure=3.0), build.robot("b", (5, -5), (5, 5))
    assert check(build, late, early).certified
    for key in ("profile", "arrival", "solo_bound", "lower_bound"):
        first[key], second[key] = second[key], first[key]
    first, second = build.robot("a", (0, 0), (10, 0), departure=1.5), build.robot("b", (5, -5), (5, 5), departure=1.5)
    assert {fault.code for fault in check(build, first, second).faults} == {"collision"}


def test_a_meeting_far_shorter_than_any_sampling_is_found(build):
    """At 2 x 10 m/s two robots are nearer than allowed for less than 1 ms."""
    fast = {"speed": 10.0, "acceleration": 100.0, "deceleration": 100.0, "jerk": 1e4}
    for short, verdict in ((1e-6, "refused"), (-1e-6, "certified")):
        first = build.robot("a", (-20, 0), (20, 0), limits=fast)
        second = build.robot("b", (20, TOUCH - short), (-20, TOUCH - short), limits=fast)
        assert check(build, first, second).verdict == verdict


def test_a_parked_robot_is_an_obstacle_for_ever_unless_it_leaves(build):
    """One parks across the other's way, long before that one comes."""
    first, second = build.robot("a", (5, 5), (5, 0)), build.robot("b", (0, 0), (10, 0), departure=30.0)
    assert {fault.code for fault in check(build, first, second).faults} == {"collision"}
    assert check(build, first, second, after_arrival="leave").certified


def test_a_robot_that_waits_at_its_start_is_an_obstacle_from_the_beginning(build):
    """One drives over the other's start before that one has left; after it has left, it may."""
    waiting = build.robot("a", (5, 0), (5, 9), departure=20.0)
    early, late = build.robot("b", (0, 0), (10, 0)), build.robot("b", (0, 0), (10, 0), departure=22.0)
    for leave in ("stay", "leave"):
        assert not check(build, waiting, early, after_arrival=leave).certified
        assert check(build, waiting, late, after_arrival=leave).certified


def test_a_robot_without_a_way_stands_there_until_its_release_at_least(build):
    """K = 0: with "leave", the place is free after the release, and not before."""
    still = build.robot("a", (5, 0), (5, 0), departure=8.0, release=8.0)
    early, late = build.robot("b", (0, 0), (10, 0)), build.robot("b", (0, 0), (10, 0), departure=4.0)
    assert check(build, still, late, after_arrival="leave").certified
    assert not check(build, still, early, after_arrival="leave").certified
    assert not check(build, still, late).certified


def test_overlapping_starts_and_overlapping_goals_are_refused(build):
    """At t = 0, and for ever; whoever moves when."""
    first = build.robot("a", (0, 0), (5, 0), departure=1.0)
    assert not check(build, first, build.robot("b", (0.6, 0), (0.6, 9))).certified
    assert not check(build, first, build.robot("b", (9, 0), (5.6, 0))).certified
    assert check(build, first, build.robot("b", (9, 0), (5.6, 0)), after_arrival="leave").certified


@pytest.mark.parametrize("gap", [0.0, 1e-7])
def test_squares_pass_each_other_at_exactly_the_clearance(build, gap):
    """Discs round these squares would overlap; also with no clearance at all, side touching side."""
    for clearance in (0.05, 0.0):
        x = 0.6 + clearance - gap
        first = build.robot("a", (0, 0), (0, 9), footprint={"square": 0.6})
        second = build.robot("b", (x, 9), (x, 0), footprint={"square": 0.6})
        report = check(build, first, second, clearance=clearance)
        assert report.verdict == ("refused" if gap else "certified")
        assert report.min_clearance.value == pytest.approx(max(clearance - gap, 0), abs=1e-6)


def test_a_long_box_needs_its_length_across_only_if_it_turns(build):
    """A box of 2 x 0.4 m drives up past a disc: fixed as drawn it hits it, along its path it does not."""
    box = {"polygon": [[-1, -0.2], [1, -0.2], [1, 0.2], [-1, 0.2]]}
    parked = build.robot("b", (0.8, 5), (0.8, 5))
    assert not check(build, build.robot("a", (0, 0), (0, 9), footprint=box), parked).certified
    turning = build.robot("a", (0, 0), (0, 9), footprint=box, heading="path")
    report = check(build, turning, parked)
    assert report.certified
    assert report.min_clearance.value == pytest.approx(0.8 - 0.2 - 0.3, abs=1e-6)


def test_the_least_clearance_of_robots_far_apart_is_still_exact(build):
    """Known by hand: closest in the middle of the way of both, 30 m apart; and with one robot there is none."""
    first, second = build.robot("a", (-40, -15), (40, -15)), build.robot("b", (40, 15), (-40, 15))
    report = check(build, first, second, build.robot("c", (-40, 49), (-40, 49)))
    assert report.certified
    assert report.min_clearance.value == pytest.approx(30 - 0.6, abs=1e-6)
    assert report.min_clearance.robots == ("a", "b")
    assert report.min_clearance.time == pytest.approx(first["arrival"] / 2, abs=2)
    assert check(build, first).min_clearance is None


def test_turning_and_mirroring_the_world_changes_nothing(build):
    """The least clearance and the verdict belong to the motions, not to the axes."""
    values = []
    for turn, flip in ((0.0, 1), (1.0, 1), (2.5, -1)):
        pieces = [[2.0, 0, 0], [1.5, 0, 0.8 * flip], [1.5, 0.8 * flip, 0], [2.0, 0, 0]]
        robots = []
        for name, x, y, more, late in (("a", 0, 0, 0.0, 0.0), ("b", 6, 3, 2.6, 1.0), ("c", 1, 4, 4.0, 0.5)):
            y *= flip
            start = math.cos(turn) * x - math.sin(turn) * y, math.sin(turn) * x + math.cos(turn) * y
            robots.append(build.robot(name, start, pieces=pieces, turned=turn + more * flip, departure=late))
        report = check(build, *robots)
        values.append((report.verdict, report.min_clearance.robots, report.min_clearance.value))
    assert values[0][0] == values[1][0] == values[2][0]
    assert values[0][1] == values[1][1] == values[2][1]
    assert values[1][2] == pytest.approx(values[0][2], abs=1e-6)
    assert values[2][2] == pytest.approx(values[0][2], abs=1e-6)


def test_every_pair_that_rests_too_near_is_reported(build):
    """Not only the nearest one, which is found first."""
    places = [(0, 0), (0.61, 0), (9, 0), (9.62, 0), (18, 0), (18.65, 0)]
    report = check(build, *[build.robot(f"r{k}", place, place) for k, place in enumerate(places)])
    assert [fault.robots for fault in report.faults] == [("r0", "r1"), ("r2", "r3")]


def test_one_collision_excuses_no_other(build):
    """Pairs that come too near, each by less than the one before, at rest, in passing and on lines and in bends."""
    robots = [build.robot("a", (0, 0), (9, 0)), build.robot("b", (9, 0.61), (0, 0.61))]
    robots += [build.robot("c", (0, 9), (9, 9)), build.robot("d", (4, 9.62), (4, 9.62))]
    robots += [build.robot("e", (0, -9), pieces=[[3, 0, 0.2]]), build.robot("f", (0, -9.63), pieces=[[3, 0, 0.2]])]
    for order in (robots, robots[::-1]):
        report = check(build, *order)
        assert sorted(sorted(fault.robots) for fault in report.faults) == [["a", "b"], ["c", "d"], ["e", "f"]]
        assert report.min_clearance.value == pytest.approx(0.01, abs=1e-6)


def test_there_are_twenty_findings_at_most(build):
    """Fifty robots on one spot are a collision or two; the checker does not count them all."""
    report = check(build, *[build.robot(f"r{k}", (0, 0), (k + 1, 0)) for k in range(50)])
    assert report.verdict == "refused"
    assert len(report.faults) == 20
    assert report.min_clearance.value == 0.0


def test_a_thousand_robots_take_about_a_second(build):
    """Lanes in both directions, each with followers: no pair is looked at that cannot meet."""
    robots = []
    for lane in range(50):
        for place in range(20):
            x, y, d = 2.0 * place - 40, 1.5 * lane - 40, (1 if lane % 2 else -1)
            robots.append(build.robot(f"{lane}-{place}", (x, y), (x + 40 * d, y), departure=0.2 * place))
            if d > 0:
                robots[-1] = build.robot(f"{lane}-{place}", (x, y), (x + 40, y), departure=0.2 * (20 - place))
    plan = build.data(build.plan(robots, bounds=[-200, -200, 200, 200]))
    begun = time.process_time()
    report = verify(plan)
    assert report.certified, report
    assert time.process_time() - begun < 4  # generous: the machine may be busy
