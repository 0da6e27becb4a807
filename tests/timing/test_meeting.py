"""Meetings: a look at the box saves the window, and never changes the answer."""

from __future__ import annotations

import numpy as np

from coord.conflicts.chords import chords
from coord.conflicts.region import conflict_regions
from coord.conflicts.rest import runs_over
from coord.model.path import Path, straight
from coord.model.profile import VelocityProfile
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest
from coord.timing.clear import excess
from coord.timing.delay import start_delay
from coord.timing.meeting import Ends, Meeting, first_run_into, first_violated


def random_meetings(rng, count):
    """One robot's way and those of others about it, with exact tests of all resting places."""

    def way():
        k = rng.uniform(-0.8, 0.8)
        rows = [(rng.uniform(1, 5), 0, 0), (rng.uniform(0.2, 1.5), k, k), (rng.uniform(1, 5), 0, 0)]
        return Path((*rng.uniform(-3, 3, 2), rng.uniform(-np.pi, np.pi)), rows)

    def motion(path):
        limits = Limits(*rng.uniform((0.5, 0.3, 0.3, 0.5, 0.3), (2, 1, 1, 3, 1)).tolist())
        return rest_to_rest(path.length, limits).shifted(rng.uniform(0, 8))

    mine = way()
    found = []
    for k in range(count):
        other, reach = way(), 0.5
        profile = motion(other)
        ends = Ends(
            start_free=runs_over(other, tuple(mine.poses[0, :2].tolist()), reach) is None,
            goal_free=runs_over(other, mine.end, reach) is None,
            other_waits=runs_over(mine, tuple(other.poses[0, :2].tolist()), reach) is not None,
            other_parks=runs_over(mine, other.end, reach) is not None,
        )
        regions = conflict_regions(
            chords(mine), chords(other), reach, start_free=ends.start_free, goal_free=ends.goal_free
        )
        found += [(Meeting(region, k, profile, ends, mine.length), other, profile) for region in regions]
    return mine, motion(mine), found


def test_a_box_that_says_clear_is_never_wrong():
    """Whenever the box alone says that a profile is clear, the exact check of the window agrees."""
    rng = np.random.default_rng(1)
    avoided = met = 0
    for _ in range(80):
        _, profile, found = random_meetings(rng, 4)
        for meeting, *_ in found:
            if meeting.is_avoided(profile):
                avoided += 1
                assert excess(profile, meeting.window).is_clear
            else:
                met += 1
    assert avoided > 40
    assert met > 20


def test_a_rough_look_never_tells_a_wrong_side():
    """Whenever spans of the window tell a side, the exact check says that it is passed there; they tell more than the box."""
    rng = np.random.default_rng(4)
    sides, beyond_the_box = set(), 0
    for _ in range(80):
        _, profile, found = random_meetings(rng, 4)
        for meeting, *_ in found:
            for delay in (0.0, 2.0, 5.0):
                delayed = profile.shifted(delay)
                side, gap = meeting.side(delayed), excess(delayed, meeting.window)
                if side is None:
                    continue
                sides.add(side)
                beyond_the_box += not meeting.is_avoided(delayed)
                assert gap.over_low <= 0 if side else gap.under_high <= 0
    assert sides == {True, False}
    assert beyond_the_box > 10


def test_the_first_violated_meeting_is_the_one_that_collides_first():
    """Against sampled distances: none is found only if nobody comes too close; else it is the earliest, within 0.1 s."""
    rng = np.random.default_rng(2)
    hit = 0
    for _ in range(80):
        mine, profile, found = random_meetings(rng, 4)
        t = np.linspace(0.0, 40.0, 8001)
        at = mine.point(profile.state(t)[:, 0])
        first = np.inf
        for _, other, theirs in found:
            close = np.hypot(*(at - other.point(theirs.state(t)[:, 0])).T) < 0.5 - 1e-6
            if close.any():
                first = min(first, float(t[close.argmax()]))
        violated = first_violated([meeting for meeting, *_ in found], profile)
        if np.isfinite(first):
            hit += 1
            assert violated is not None
            assert violated[1].time <= first + 1e-6
        if violated is None:
            assert np.isinf(first)
    assert hit > 15


def test_a_goal_a_centimetre_within_the_reach_of_a_resting_robot_is_not_avoided():
    """Nor is a start; a goal or a start a centimetre beyond it is."""
    resting, limits = VelocityProfile([0.0], [(0.0, 0.0, 0.0)], []), Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    profile = rest_to_rest(5.0, limits)
    for gap in (0.64, 0.66):
        for x in (5.0 + gap, -gap):
            ends = Ends(start_free=x > 0, goal_free=x < 0, other_waits=True, other_parks=True)
            mine, other = straight((0.0, 0.0), (5.0, 0.0)), straight((x, 0.0), (x, 0.0))
            found = [
                Meeting(region, 1, resting, ends, 5.0)
                for region in conflict_regions(chords(mine), chords(other), 0.65, start_free=x > 0, goal_free=x < 0)
            ]
            assert all(meeting.is_avoided(profile) for meeting in found) == (gap > 0.65)
            assert (first_violated(found, profile) is None) == (gap > 0.65)


def test_who_is_clear_of_refined_windows_runs_into_nobody():
    """Delayed at the start no more than these ask for: some are not clear of the windows as they are, none runs in.

    And both say the same about whom it passes after.
    """
    rng = np.random.default_rng(3)
    closer = 0
    for _ in range(120):
        _, profile, found = random_meetings(rng, 4)
        meetings = [meeting for meeting, *_ in found]
        delayed = start_delay(profile, [meeting.refined() for meeting in meetings], {})
        if delayed is None or delayed.departure == profile.departure:
            continue
        assert first_run_into(meetings, delayed) is None
        sides = [meeting.passes_after(delayed) for meeting in meetings]
        assert sides == [meeting.refined().passes_after(delayed) for meeting in meetings]
        closer += first_violated(meetings, delayed) is not None
    assert closer >= 5
