"""Driving gently: smoother by half at least, and hardly later."""

from __future__ import annotations

import pytest

from coord.alone.check import keeps_limits
from coord.timing.meeting import first_violated


def test_delayed_robots_have_less_than_half_the_squared_jerk_for_one_percent_of_the_arrivals(
    lanes, crossroads, timed, squared_jerk
):
    """Over 24 scenes together: integrals below half, arrivals at most 1 % later, bounds in both never above arrivals."""
    jerk, sums, count = {"fastest": 0.0, "gentle": 0.0}, {"fastest": 0.0, "gentle": 0.0}, 0
    for problem in [lanes(seed) for seed in range(12)] + [crossroads(seed, 5) for seed in range(12)]:
        found = {profile: timed(problem, profile) for profile in jerk}
        if found["fastest"] is None or found["gentle"] is None:
            continue
        for profile, (_, timings, _) in found.items():
            jerk[profile] += sum(squared_jerk(one.profile) for one in timings if one.how != "alone")
            sums[profile] += sum(one.profile.arrival for one in timings)
            assert all(one.lower_bound <= one.profile.arrival for one in timings)
            count += sum(one.how == "gentle" for one in timings)
    assert count >= 15
    assert jerk["gentle"] < 0.5 * jerk["fastest"]
    assert sums["gentle"] <= 1.01 * sums["fastest"]


@pytest.mark.parametrize("seed", range(8))
def test_a_gentle_profile_is_clear_of_all_and_keeps_the_limits(bent_crossing, lanes, timed, seed):
    """By the exact checks, on straight ways and on ways with bends; and it leaves no earlier than it may."""
    for problem in (bent_crossing(seed), lanes(seed)):
        found = timed(problem, "gentle")
        if found is None:
            continue
        for ego, timing, meetings in zip(*found, strict=True):
            assert keeps_limits(timing.profile, ego.robot.limits, ego.caps)
            assert first_violated(meetings, timing.profile) is None
            assert timing.profile.departure >= ego.robot.release
            assert timing.profile.states[-1].tolist() == [ego.length, 0.0, 0.0]


def test_bends_do_not_keep_robots_from_driving_gently(bent_crossing, timed, squared_jerk):
    """Over 10 scenes of ways with bends, more than half of the delayed robots do, and their squared jerk halves."""
    delayed = gentle = before = after = 0
    for seed in range(10):
        quick, calm = timed(bent_crossing(seed), "fastest"), timed(bent_crossing(seed), "gentle")
        if quick is None or calm is None:
            continue
        delayed += sum(one.how != "alone" for one in calm[1])
        gentle += sum(one.how == "gentle" for one in calm[1])
        before += sum(squared_jerk(one.profile) for one in quick[1] if one.how != "alone")
        after += sum(squared_jerk(one.profile) for one in calm[1] if one.how != "alone")
    assert delayed >= 8
    assert gentle > 0.5 * delayed
    assert after < 0.6 * before


def test_a_robot_that_nobody_holds_up_drives_its_quickest_profile(lanes, timed):
    """The first of each scene: the same bytes under both profiles."""
    for seed in range(4):
        first = [timed(lanes(seed), profile)[1][0].profile for profile in ("fastest", "gentle")]
        assert first[0].states.tobytes() == first[1].states.tobytes()
