"""When a place is taken: windows miss no moment at which the other robot is too close."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.chords import chords
from coord.conflicts.region import conflict_regions
from coord.conflicts.rest import runs_over
from coord.conflicts.window import stay_within, window
from coord.model.path import straight
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest

UNIT = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def forbidden(windows, s, t):
    """(len(s), len(t)) whether the windows forbid it; where two strips meet, either counts."""
    taken = np.zeros((len(s), len(t)), bool)
    for one in windows:
        for k in range(len(one.low)):
            first, last = one.times[k], one.times[k + 1]
            inside = (t >= first) & (t <= last)
            share = np.zeros(inside.sum()) if np.isinf(last) else (t[inside] - first) / (last - first)
            low = one.low[k, 0] + (one.low[k, 1] - one.low[k, 0]) * share
            high = one.high[k, 0] + (one.high[k, 1] - one.high[k, 0]) * share
            taken[:, inside] |= (s[:, None] > low[None]) & (s[:, None] < high[None])
    return taken


def windows_of(ego, other, reach, profile):
    """All windows of ego, with the resting places as the planner tests them."""
    start, goal = tuple(other.poses[0, :2].tolist()), other.end
    waits, parks = runs_over(ego, start, reach) is not None, runs_over(ego, goal, reach) is not None
    mine, end = tuple(ego.poses[0, :2].tolist()), ego.end
    free = {"start_free": runs_over(other, mine, reach) is None, "goal_free": runs_over(other, end, reach) is None}
    found = [
        window(region, 0, profile, waits=waits, parks=parks)
        for region in conflict_regions(chords(ego), chords(other), reach, **free)
    ]
    return [stay_within(one, free["start_free"], free["goal_free"], ego.length) for one in found if one is not None]


def test_at_no_moment_is_a_place_too_close_to_the_other_allowed(wild_path, stop_and_go, drives):
    """120 pairs; the other waits, stops on its way, parks: of 1,000 times and 150 places each none is missed."""
    rng = np.random.default_rng(1)
    met = must = does = 0
    for _ in range(120):
        ego, other, reach = wild_path(rng), wild_path(rng), rng.uniform(0.3, 1.2)
        profile = stop_and_go(rng, other.length, drives(rng))
        found = windows_of(ego, other, reach, profile)
        t = np.unique(np.concatenate([np.linspace(0, profile.arrival + 5, 1000), profile.times]))
        s = np.linspace(0, ego.length, 150)
        gap = ego.point(s)[:, None] - other.point(profile.state(t)[:, 0])[None]
        close = np.hypot(gap[..., 0], gap[..., 1]) < reach - 1e-9
        taken = forbidden(found, s, t)
        assert np.all(taken[close])
        assert all(np.all(np.diff(one.times) > 0) for one in found)
        met, must, does = met + close.any(), must + close.sum(), does + taken.sum()
    assert met >= 25
    assert does < 1.02 * must


CROSSED, CROSSING = straight((0, 0), (20, 0)), straight((10, -5), (10, 5))


def test_a_crossing_at_full_speed_is_a_disc_in_time():
    """At 1 m/s the other is at the crossing at t0: forbidden is (s - 10)^2 + (t - t0)^2 < reach^2."""
    profile = rest_to_rest(10.0, UNIT)
    (one,) = windows_of(CROSSED, CROSSING, 0.6, profile)
    middle = (profile.departure + profile.arrival) / 2
    assert one.times[[0, -1]] == pytest.approx((middle - 0.6, middle + 0.6), abs=1e-4)
    assert not one.lasts
    at = (one.times[:-1] + one.times[1:]) / 2
    half = np.sqrt(np.maximum(0.36 - (at - middle) ** 2, 0.0))
    assert np.all(one.low.mean(axis=1) <= 10 - half + 1e-6)
    assert np.all(one.high.mean(axis=1) >= 10 + half - 1e-6)
    broad = np.abs(at - middle) < 0.45
    assert one.low.mean(axis=1)[broad] == pytest.approx(10 - half[broad], abs=3e-3)


def test_a_robot_that_stops_in_the_crossing_takes_it_while_it_stands():
    """Five metres, ten seconds' stop on the line, five metres: forbidden from before the stop until after it."""
    first, second = rest_to_rest(5.0, UNIT), rest_to_rest(5.0, UNIT)
    states = [*first.states, *(np.array(second.states) + np.array([5.0, 0.0, 0.0]))]
    stop = first.arrival
    profile = VelocityProfile([*first.times, *(stop + 10 + second.times)], states, [*first.jerks, 0.0, *second.jerks])
    (one,) = windows_of(CROSSED, CROSSING, 0.6, profile)
    assert one.times[0] < stop
    assert stop + 10 < one.times[-1] < profile.arrival
    t = np.linspace(stop, stop + 10, 50)
    assert np.all(forbidden([one], np.array([9.41, 10.0, 10.59]), t))
    assert not np.any(forbidden([one], np.array([9.395, 10.605]), t))


def test_a_robot_that_waits_in_the_way_takes_the_place_from_the_beginning():
    """Starting on the line after 7 s, it is there from t = 0 until it has left."""
    profile = rest_to_rest(5.0, UNIT).shifted(7.0)
    (one,) = windows_of(CROSSED, straight((10, 0), (10, 5)), 0.6, profile)
    assert one.times[0] == 0.0
    assert 7.0 < one.times[-1] < profile.arrival
    assert np.all(forbidden([one], np.array([9.41, 10.59]), np.linspace(0, 7.0, 50)))


def test_a_robot_that_parks_in_the_way_takes_the_place_for_ever():
    """Its window never ends, and forbids no more than its disc."""
    profile = rest_to_rest(5.0, UNIT)
    (one,) = windows_of(CROSSED, straight((10, -5), (10, 0)), 0.6, profile)
    assert one.lasts
    late = np.array([profile.arrival, 100.0, 1e6])
    assert np.all(forbidden([one], np.array([9.41, 10.59]), late))
    assert not np.any(forbidden([one], np.array([9.395, 10.605]), late))


def test_a_robot_that_never_moves_takes_its_place_at_all_times():
    """From t = 0 for ever, whenever it may depart."""
    profile = VelocityProfile([3.0], [(0.0, 0.0, 0.0)], [])
    (one,) = windows_of(CROSSED, straight((10, 0), (10, 0)), 0.6, profile)
    assert one.times.tolist() == [0.0, np.inf]
    assert (one.low[0, 0], one.high[0, 0]) == pytest.approx((9.4, 10.6), abs=5e-6)


def test_a_start_that_only_touches_the_way_is_no_obstacle_while_it_rests():
    """Exactly reach beside the line, the other forbids nothing before it departs."""
    profile = rest_to_rest(5.0, UNIT).shifted(7.0)
    found = windows_of(CROSSED, straight((10, 0.6), (10, -4.4)), 0.6, profile)
    assert all(one.times[0] >= 7.0 for one in found)
    assert found
    away = windows_of(CROSSED, straight((10, 0.6), (10, 5.6)), 0.6, profile)
    s = np.linspace(0, 20, 2001)
    assert not np.any(forbidden(away, s, np.linspace(0, 6.999, 50)))


def test_a_window_is_cut_where_ego_may_rest():
    """Behind ego's start and beyond its goal nothing is forbidden once an exact test has freed them."""
    ego, profile = straight((10.2, 0), (20, 0)), rest_to_rest(10.0, UNIT)
    (region,) = conflict_regions(chords(ego), chords(straight((10.8 + 0.6, -5), (10.8 + 0.6, 5))), 0.6)
    raw = window(region, 0, profile)
    assert raw is not None
    cut = stay_within(raw, True, True, ego.length)
    assert cut.low.min() >= 0.0
    assert np.all(cut.low >= raw.low)
