"""The quickest profile alone: times known by heart, limits kept, and how it scales."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.alone.fastest import fastest, solo_bound
from coord.model.path import Path, straight
from coord.model.robot import Limits

some = st.floats(0.1, 5.0)
limit_sets = st.builds(Limits, some, some, some, some, some)


def quickest(length, limits):
    return fastest(straight((0.0, 0.0), (length, 0.0)), limits)


def scaled(limits, k):
    """Speed, acceleration and jerk times k, k^2 and k^3."""
    return Limits(
        limits.speed * k,
        limits.acceleration * k**2,
        limits.deceleration * k**2,
        limits.jerk * k**3,
        limits.lateral_acceleration * k**2,
    )


def ramp_time(speed, acceleration, jerk):
    """From rest to a speed: v/a + a/j where the acceleration is reached, else 2 sqrt(v/j)."""
    return speed / acceleration + acceleration / jerk if speed * jerk >= acceleration**2 else 2 * (speed / jerk) ** 0.5


@settings(deadline=None, derandomize=True, max_examples=100)
@given(limit_sets, st.floats(0.0, 100.0))
def test_a_long_way_takes_the_ramps_and_the_rest_at_full_speed(limits, cruise):
    """Where both ramps fit, T = L/v + half of both ramps' times, since a ramp covers half of what full speed would."""
    up = ramp_time(limits.speed, limits.acceleration, limits.jerk)
    down = ramp_time(limits.speed, limits.deceleration, limits.jerk)
    length = limits.speed * (up + down) / 2 + cruise
    assert quickest(length, limits).arrival == pytest.approx(length / limits.speed + (up + down) / 2, rel=1e-9)


def test_textbook_numbers():
    """20 m at 1 m/s with 1/2 m/s2 and 1 m/s3: 20 + 2 (1/1 / (1/2) + 1/2 / 1) / 2 = 22.5 s."""
    assert quickest(20.0, Limits(1.0, 0.5, 0.5, 1.0, 1.0)).arrival == pytest.approx(22.5, abs=1e-12)


@settings(deadline=None, derandomize=True, max_examples=100)
@given(limit_sets, st.floats(0.01, 1.0))
def test_a_short_way_is_limited_by_jerk_alone(limits, share):
    """Where neither acceleration nor speed are reached, T = (32 L/j)^(1/3)."""
    j, a = limits.jerk, min(limits.acceleration, limits.deceleration)
    # T/4 j <= a and T^2/16 j <= v at T^3 = 32 L / j
    length = share * min(2 * a**3 / j**2, 2 * (limits.speed**3 / j) ** 0.5)
    assert quickest(length, limits).arrival == pytest.approx((32 * length / j) ** (1 / 3), rel=1e-7)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(limit_sets, st.floats(0.05, 50.0), st.floats(0.25, 4.0))
def test_limits_of_a_quicker_world_divide_the_time(limits, length, k):
    """Speed, acceleration and jerk times k, k^2, k^3: every knot's time is divided by k."""
    slow, quick = quickest(length, limits), quickest(length, scaled(limits, k))
    assert quick.arrival * k == pytest.approx(slow.arrival, rel=1e-8)
    at = np.linspace(0.0, slow.arrival, 20)
    assert np.abs(quick.state(at / k)[:, 0] - slow.state(at)[:, 0]).max() < 1e-6 * length


@settings(deadline=None, derandomize=True, max_examples=60)
@given(limit_sets, st.floats(0.05, 50.0))
def test_swapping_acceleration_and_deceleration_runs_the_film_backwards(limits, length):
    """The time is the same, and the place at t is the way left at T - t."""
    swapped = dataclasses.replace(limits, acceleration=limits.deceleration, deceleration=limits.acceleration)
    forth, back = quickest(length, limits), quickest(length, swapped)
    assert back.arrival == pytest.approx(forth.arrival, rel=1e-9)
    at = np.linspace(0.0, forth.arrival, 20)
    assert np.abs(back.state(forth.arrival - at)[:, 0] + forth.state(at)[:, 0] - length).max() < 1e-6 * (1 + length)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(limit_sets, st.floats(0.05, 50.0), st.sampled_from(["speed", "acceleration", "deceleration", "jerk"]))
def test_a_higher_limit_is_never_slower(limits, length, which):
    """Doubling any one limit does not lengthen the time."""
    more = dataclasses.replace(limits, **{which: 2 * getattr(limits, which)})
    assert quickest(length, more).arrival <= quickest(length, limits).arrival * (1 + 1e-9)


def test_no_way_takes_no_time():
    """A robot at its goal arrives when it departs, and its bound is 0."""
    nowhere = straight((1.0, 1.0), (1.0, 1.0))
    limits = Limits(1.0, 0.5, 0.5, 1.0, 1.0)
    assert fastest(nowhere, limits).arrival == solo_bound(nowhere, limits) == 0.0


def test_in_bends_the_lateral_acceleration_is_kept(bends, random_limits):
    """At 2,000 times along each motion v^2 |curvature| stays below the limit, all other limits at all knots."""
    rng = np.random.default_rng(3)
    for path in bends.values():
        for _ in range(3):
            limits = random_limits(rng)
            profile = fastest(path, limits)
            s, v, a = profile.state(np.linspace(0.0, profile.arrival, 2000)).T
            # a hair before and behind a jump of the curvature the other side counts
            for shift in (-1e-7, 0.0, 1e-7):
                bend = np.abs(path.curvature(s + shift))
                assert np.all(v**2 * bend <= limits.lateral_acceleration * (1 + 1e-6))
            assert profile.states[-1].tolist() == [path.length, 0.0, 0.0]
            assert v.max() <= limits.speed + 1e-9
            assert a.max() <= limits.acceleration + 1e-9
            assert a.min() >= -limits.deceleration - 1e-9
            assert np.abs(profile.jerks).max() <= limits.jerk + 1e-9


def test_the_bound_is_never_above_the_quickest_profile(bends, random_limits):
    """On every path with bends, and with either relaxation the tighter one; without bends they are the same."""
    rng = np.random.default_rng(4)
    for path in bends.values():
        for _ in range(4):
            limits = random_limits(rng)
            assert solo_bound(path, limits) <= fastest(path, limits).arrival
    for _ in range(50):
        limits, path = random_limits(rng), straight((0.0, 0.0), (rng.uniform(0.01, 30), 0.0))
        assert solo_bound(path, limits) == fastest(path, limits).arrival


def test_the_bound_holds_against_motions_nobody_planned(bends, random_limits, wander):
    """Random motions that keep limits and caps, timed at every place, never need less than the bound up to there."""
    rng = np.random.default_rng(5)
    tried = 0
    for path in bends.values():
        for _ in range(25):
            limits = random_limits(rng)
            slow = dataclasses.replace(limits, speed=min(limits.speed, (limits.lateral_acceleration / 3.0) ** 0.5))
            motion = wander(rng, slow, 120)
            if motion.length < path.length:
                continue
            tried += 1
            t = np.linspace(0.0, motion.arrival, 4000)
            at = np.interp(path.length, motion.state(t)[:, 0], t)
            # it does not come to rest there; a whole landing is more than that could cost
            stop = limits.speed / limits.deceleration + limits.deceleration / limits.jerk
            assert at + stop >= solo_bound(path, limits)
    assert tried > 20


def test_bends_cost_time_but_less_than_their_slowest_cap_all_the_way(bends, random_limits):
    """Between the time of the same length without bends and that at the lowest cap; without a lateral limit no cost."""
    rng = np.random.default_rng(6)
    for path in bends.values():
        limits = random_limits(rng)
        least = min(limits.speed, (limits.lateral_acceleration / np.abs(path.pieces[:, 1:]).max()) ** 0.5)
        slow = quickest(path.length, dataclasses.replace(limits, speed=float(least)))
        time = fastest(path, limits).arrival
        assert quickest(path.length, limits).arrival * (1 - 1e-9) <= time <= slow.arrival * (1 + 1e-9)
        careless = dataclasses.replace(limits, lateral_acceleration=1e4)
        assert fastest(path, careless).arrival == pytest.approx(quickest(path.length, limits).arrival, rel=1e-12)


def test_one_slow_bend_between_long_straights_is_passed_at_its_cap():
    """At least as quick as ramps before and behind the bend in closed form, never quicker than without a jerk limit."""
    limits = Limits(2.0, 0.5, 0.5, 2.0, 0.5)
    cap, bend, lead = 1.0, np.pi / 2 * 2.0, 30.0
    path = Path((0.0, 0.0, 0.0), [(lead, 0, 0), (bend, 0.5, 0.5), (lead, 0, 0)])

    def whole(jerk):
        # rest to 2 m/s, 2 to 1 m/s, bend at 1 m/s, 1 to 2 m/s, 2 m/s to rest
        rest, change = ramp_time(2.0, 0.5, jerk), ramp_time(1.0, 0.5, jerk)
        covered = rest * 1.0 + change * 1.5
        return 2 * (rest + change + (lead - covered) / 2.0) + bend / cap

    assert whole(1e9) <= fastest(path, limits).arrival <= whole(2.0) * (1 + 1e-5)
