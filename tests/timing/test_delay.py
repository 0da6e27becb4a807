"""Waiting at the start: the least delays that help."""

from __future__ import annotations

import numpy as np
import pytest

from coord.conflicts.chords import chords
from coord.conflicts.region import conflict_regions
from coord.model.path import straight
from coord.model.robot import Limits
from coord.solvers.jerk import rest_to_rest
from coord.timing.clear import excess
from coord.timing.delay import after_contact, before_contact, start_delay
from coord.timing.meeting import Ends, Meeting

FREE = Ends(start_free=True, goal_free=True, other_waits=False, other_parks=False)


def meeting(ego, other, reach, profile, ends=FREE):
    (region,) = conflict_regions(
        chords(ego), chords(other), reach, start_free=ends.start_free, goal_free=ends.goal_free
    )
    return Meeting(region, 1, profile, ends, ego.length)


def random_crossing(rng):
    """Two straight ways that cross, and both robots' quickest motions, the other's at some other time."""
    turn = rng.uniform(0.3, np.pi - 0.3)
    c, s = 8 * np.cos(turn), 8 * np.sin(turn)
    ego, other = straight((-8, 0), (8, 0)), straight((-c, -s), (c, s))
    drives = [Limits(*rng.uniform((0.5, 0.3, 0.3, 0.5, 0.3), (2, 1, 1, 3, 1)).tolist()) for _ in range(2)]
    mine, others = (rest_to_rest(16.0, limits) for limits in drives)
    return meeting(ego, other, 0.65, others.shifted(rng.uniform(0, 12))), mine


def test_the_least_delay_after_and_the_largest_before_are_tight():
    """100 crossings: with it the profile is clear on the right side, with 2 ms less (or more) it is not."""
    rng = np.random.default_rng(1)
    for _ in range(100):
        crossing, mine = random_crossing(rng)
        after, before = after_contact(mine, crossing.window), before_contact(mine, crossing.window)
        assert before.delay < after.delay
        assert excess(mine.shifted(after.delay), crossing.window).passes_after
        assert not excess(mine.shifted(after.delay - 2e-3), crossing.window).is_clear
        earlier = mine.shifted(before.delay)
        assert excess(earlier, crossing.window).is_clear
        assert not excess(earlier, crossing.window).passes_after
        assert not excess(mine.shifted(before.delay + 2e-3), crossing.window).is_clear


def test_delays_between_before_and_after_all_collide():
    """The forbidden start delays of a window are one interval."""
    rng = np.random.default_rng(2)
    for _ in range(30):
        crossing, mine = random_crossing(rng)
        after, before = after_contact(mine, crossing.window).delay, before_contact(mine, crossing.window).delay
        for share in (0.05, 0.25, 0.5, 0.75, 0.95):
            assert not excess(mine.shifted(before + share * (after - before)), crossing.window).is_clear


def test_the_start_delay_is_the_least_one_that_is_clear_of_all():
    """Four crossings of one way: clear of all with it, not with any smaller delay, in steps of 50 ms; a contact sets it."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        mine = rest_to_rest(20.0, Limits(1.0, 0.5, 0.5, 1.0, 0.5))
        ego, meetings = straight((0, 0), (20, 0)), []
        for x in (4, 8, 12, 16):
            limits = Limits(*rng.uniform((0.5, 0.3, 0.3, 0.5, 0.3), (2, 1, 1, 3, 1)).tolist())
            other = rest_to_rest(10.0, limits).shifted(rng.uniform(0, 10))
            meetings.append(meeting(ego, straight((x, -5), (x, 5)), 0.65, other))
        contacts = {}
        delayed = start_delay(mine, meetings, contacts)
        assert delayed is not None
        assert contacts == {k: after_contact(mine, meetings[k].window) for k in contacts}
        assert max((one.delay for one in contacts.values()), default=0.0) == pytest.approx(delayed.departure, abs=1e-6)
        assert all(excess(delayed, one.window).is_clear for one in meetings)
        for delay in np.arange(0.0, delayed.departure - 5e-3, 0.05).tolist():
            assert not all(excess(mine.shifted(delay), one.window).is_clear for one in meetings)


def test_nobody_waits_for_a_robot_that_never_leaves():
    """Parked on the way, the other can only be passed before it comes; later than that there is no delay."""
    ego, other = straight((0, 0), (20, 0)), straight((10, -5), (10, 0))
    parks = Ends(start_free=True, goal_free=True, other_waits=False, other_parks=True)
    profile = rest_to_rest(5.0, Limits(1.0, 0.5, 0.5, 1.0, 0.5))
    mine = rest_to_rest(20.0, Limits(1.0, 0.5, 0.5, 1.0, 0.5))
    late = meeting(ego, other, 0.65, profile.shifted(30.0), parks)
    soon = meeting(ego, other, 0.65, profile, parks)
    assert np.isinf(after_contact(mine, late.window).delay)
    waited = start_delay(mine, [late])
    assert waited is not None
    assert waited.departure == 0.0
    assert start_delay(mine, [soon]) is None


@pytest.mark.parametrize("is_in_the_way", [True, False])
def test_a_start_in_the_way_cannot_be_waited_at(is_in_the_way):
    """Where the other's path runs over ego's start, ego must have left before; where it only touches, waiting is free."""
    mine = rest_to_rest(10.0, Limits(1.0, 0.5, 0.5, 1.0, 0.5))
    offset = 0.6 if is_in_the_way else 0.65
    ego, other = straight((offset, 0), (offset + 10, 0)), straight((0, -5), (0, 5))
    ends = Ends(start_free=not is_in_the_way, goal_free=True, other_waits=False, other_parks=False)
    profile = rest_to_rest(10.0, Limits(1.0, 0.5, 0.5, 1.0, 0.5)).shifted(20.0)
    crossing = meeting(ego, other, 0.65, profile, ends)
    assert np.isinf(after_contact(mine, crossing.window).delay) == is_in_the_way
    waited = start_delay(mine.shifted(17.0), [crossing])
    assert (waited is None) == is_in_the_way or (waited is not None and waited.departure == 17.0)
