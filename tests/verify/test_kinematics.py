"""A profile is certified exactly if it is one and keeps the limits at all times."""

from __future__ import annotations

import pytest

from coord.verify import verify


def codes(build, robot, **given):
    return {fault.code for fault in verify(build.data(build.plan([robot], **given))).faults}


def driven(build, phases, length, **limits):
    """A robot on a line whose profile is integrated from (duration, jerk) as it is."""
    robot = build.robot("a", (0, 0), (length, 0), limits=limits)
    times, states = [0.0], [[0.0, 0.0, 0.0]]
    for h, j in phases:
        s, v, a = states[-1]
        times.append(times[-1] + h)
        states.append([s + v * h + a * h * h / 2 + j * h**3 / 6, v + a * h + j * h * h / 2, a + j * h])
    robot["profile"] = {"times": times, "states": states, "jerks": [j for _, j in phases]}
    robot["arrival"] = times[-1]
    robot["solo_bound"] = robot["lower_bound"] = 0.0
    return robot


def test_a_motion_with_rests_on_the_way_is_certified(build):
    """Stop and go, with asymmetric limits, on a line."""
    assert codes(build, build.robot("a", (0, 0), (9, 0), runs=[(2, 1.5), (3, 0.25), (4, 0)])) == set()


@pytest.mark.parametrize("column", [0, 1, 2])
def test_a_shifted_knot_is_refused(build, column):
    """A state that is off by 1e-7 does not follow from the one before."""
    robot = build.robot("a", (0, 0), (5, 0))
    robot["profile"]["states"][3][column] += 1e-7
    assert "profile" in codes(build, robot)


def test_knots_out_of_order_are_refused(build):
    """Times increase."""
    robot = build.robot("a", (0, 0), (5, 0))
    times = robot["profile"]["times"]
    times[2], times[3] = times[3], times[2]
    assert "profile" in codes(build, robot)


def test_a_cut_tail_is_refused(build):
    """The profile must end at rest at the end of the path."""
    robot = build.robot("a", (0, 0), (5, 0))
    for key in ("times", "states", "jerks"):
        robot["profile"][key].pop()
    robot["arrival"] = robot["profile"]["times"][-1]
    robot["solo_bound"] = robot["lower_bound"] = 0.0
    assert "profile" in codes(build, robot)


def test_a_profile_for_another_length_is_refused(build):
    """The last arc length is that of the path."""
    robot, other = build.robot("a", (0, 0), (5, 0)), build.robot("a", (0, 0), (5 - 1e-6, 0))
    robot["profile"] = other["profile"]
    assert "profile" in codes(build, robot)


@pytest.mark.parametrize(
    ("limit", "code"),
    [("speed", "speed"), ("acceleration", "acceleration"), ("deceleration", "deceleration"), ("jerk", "jerk")],
)
def test_a_limit_is_kept_or_refused(build, limit, code):
    """A motion at its limits is certified; a limit lower by a millionth refuses it, naming that limit."""
    robot = build.robot("a", (0, 0), (5, 0))
    assert codes(build, robot) == set()
    robot["limits"][limit] *= 1 - 1e-6
    # the arrival that it is said to have alone is one that no robot of the lower limit has, too
    assert codes(build, robot) - {"bound"} == {code}


def test_a_peak_of_speed_between_knots_is_found(build):
    """Speed may peak inside a phase, both ends of which are within the limit: here 0.75 at the ends, 1 inside."""
    robot = driven(build, [(1.0, 0.5), (1.0, 0.0), (2.0, -0.5)], 1.0, deceleration=2.0)
    states = robot["profile"]["states"]
    assert states[2][1] == states[3][1] == 0.75
    for limit, refused in ((1 + 1e-6, False), (1 - 1e-6, True)):
        robot["limits"]["speed"] = limit
        assert ("speed" in codes(build, robot)) == refused


def test_driving_backwards_within_a_phase_is_refused(build):
    """Speed 0 at both ends of a swing, negative in between, and the arc lengths at the knots increase all the same."""
    w = 0.1
    forward = [(1, 0.4), (1, -0.4), (1, -0.4), (1, 0.4)]
    swing = [(w, -1.0), (2 * w, 1.0), (w, -1.0)]
    still = driven(build, [*forward, *forward], 1.6)
    assert codes(build, still) == set()
    robot = driven(build, [*forward, *swing, *forward], 1.6 - 2 * w**3)
    robot["profile"]["states"][-1][0] = 1.6 - 2 * w**3
    assert "profile" in codes(build, robot)
    assert "speed" in codes(build, robot)


def test_creeping_backwards_from_knot_to_knot_is_refused(build):
    """Each phase rolls back by less than the margin, all of them together by ten times as much."""
    robot = build.robot("a", (0, 0), (5, 0))
    profile, n = robot["profile"], 20
    for k in [*range(n), *range(n, 0, -1)]:
        profile["states"].insert(-1, [5.0 - 5e-10 * k, 0.0, 0.0])
        profile["times"].append(profile["times"][-1] + 1.0)
        profile["jerks"].append(0.0)
    robot["arrival"] = profile["times"][-1]
    assert profile["states"][-1] == [5.0, 0.0, 0.0]
    assert "profile" in codes(build, robot)


def test_departure_before_release_is_refused(build):
    """A robot may wait, but not leave early."""
    assert codes(build, build.robot("a", (0, 0), (5, 0), release=2.0, departure=2.5)) == set()
    assert "release" in codes(build, build.robot("a", (0, 0), (5, 0), release=2.0, departure=2.0 - 1e-6))


def test_a_false_arrival_is_refused(build):
    """The arrival is the last knot."""
    robot = build.robot("a", (0, 0), (5, 0))
    robot["arrival"] += 1e-6
    assert codes(build, robot) == {"arrival"}


def test_a_robot_that_is_at_its_goal_needs_no_phases(build):
    """K = 0, and it arrives at its release."""
    assert codes(build, build.robot("a", (1, 1), (1, 1), departure=3.0, release=3.0)) == set()
    robot = build.robot("a", (1, 1), (1, 1))
    robot["profile"] = {"times": [0.0, 1.0], "states": [[0.0, 0.0, 0.0]] * 2, "jerks": [0.0]}
    robot["arrival"] = 1.0
    assert "profile" in codes(build, robot)


def test_a_bend_is_driven_at_the_limit_but_not_above(build):
    """v^2 |k| at full speed, on an arc whose ends are jumps of the curvature: 1e-6 decides."""
    pieces = [[6, 0, 0], [2, -0.5, -0.5], [6, 0, 0]]
    robot = build.robot("a", (0, 0), pieces=pieces)
    assert codes(build, robot) == set()
    pieces[1][1] = pieces[1][2] = -0.5 - 1e-6
    assert codes(build, build.robot("a", (0, 0), pieces=pieces)) == {"lateral_acceleration"}


def test_a_jump_of_curvature_counts_on_both_sides(build):
    """A robot that brakes into an arc is refused for the instant in which it enters it, and only for that."""
    robot = build.robot("a", (0, 0), (6, 0))
    s, v, _ = next(state for state in robot["profile"]["states"] if state[2] < 0)
    assert 0.5 < v < 1.0
    k = 0.5 / v**2
    for enter, expected in ((s + 1e-6, set()), (s - 1e-6, {"lateral_acceleration"})):
        assert codes(build, build.robot("a", (0, 0), pieces=[[enter, 0, 0], [6 - enter, k, k]])) == expected


def test_a_clothoid_is_judged_by_speed_and_curvature_at_the_same_time(build):
    """Peak speed times peak curvature would refuse this motion; the true peak lies in between and is tight."""
    pieces = [[3.0, 0.0, 0.0], [3.0, 0.0, 2.0]]
    robot = build.robot("a", (0, 0), pieces=pieces, limits={"lateral_acceleration": 100.0})
    profile = robot["profile"]
    peak = 0.0
    for k, j in enumerate(profile["jerks"]):
        (s, v, a), h = profile["states"][k], profile["times"][k + 1] - profile["times"][k]
        for i in range(20_001):
            t = h * i / 20_000
            here = max(s + v * t + a * t * t / 2 + j * t**3 / 6 - 3.0, 0.0) * 2 / 3
            peak = max(peak, (v + a * t + j * t * t / 2) ** 2 * here)
    assert 0.3 < peak < 1.5
    for share, expected in ((1 + 1e-6, set()), (1 - 1e-6, {"lateral_acceleration"})):
        robot["limits"]["lateral_acceleration"] = peak * share
        assert codes(build, robot) == expected
