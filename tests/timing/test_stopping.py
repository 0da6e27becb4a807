"""Stop and go: a stop is a stop, in nobody's way, and never better than changing the velocity."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from coord.alone.check import keeps_limits
from coord.alone.inverse import time_at
from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan
from coord.timing.meeting import first_violated
from coord.timing.stopping import stop_robot

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((-20.0, -20.0, 40.0, 20.0), 0.05)
RADIUS = 0.3

#: [m] How near the centres of two such robots may come.
APART = 2 * RADIUS + 0.05


def robot(name, start, goal, **more):
    return Robot(name, Footprint(RADIUS), LIMITS, start, goal, **more)


def at_right_angles(name="up", x=0.0, release=0.0, **more):
    """A robot that crosses the x axis at x, half a second of driving from its start at y = -8."""
    return robot(name, (x, -8.0), (x, 8.0), release=release, **more)


def rests(profile):
    """(place, from, until) of every rest on the way that takes time."""
    still = (profile.jerks == 0) & np.all(profile.states[:-1, 1:] == 0, axis=1)
    return [(profile.states[k, 0], profile.times[k], profile.times[k + 1]) for k in np.flatnonzero(still)]


def test_one_stop_before_one_crossing(timed):
    """It stands where the conflict begins, with speed exactly 0, until the other has left it, and then goes on."""
    egos, timings, met = timed(Problem("p", FLOOR, (at_right_angles(), robot("ego", (-8.0, 0.0), (9.0, 0.0)))))
    found = stop_robot(egos[1], met[1])
    ((place, since, until),) = rests(found.profile)
    assert (found.how, found.after, found.before) == ("stop", (0,), ())
    assert place == pytest.approx(8.0 - APART, abs=1e-3)
    assert place <= met[1][0].region.s_range[0]
    assert until == pytest.approx(time_at(timings[0].profile, 8.0 + APART)[0], abs=1e-3)
    still = found.profile.state(np.linspace(since, until, 200))
    assert np.all(still == [place, 0.0, 0.0])
    assert found.profile.state(since - 0.01)[0, 1] > 0 < found.profile.state(until + 0.01)[0, 1]


def test_before_the_stop_it_drives_as_if_alone(timed):
    """Up to the moment at which it has to brake the motion is that of the robot with nobody else there."""
    egos, _, met = timed(Problem("p", FLOOR, (at_right_angles(), robot("ego", (-8.0, 0.0), (9.0, 0.0)))))
    found, alone = stop_robot(egos[1], met[1]).profile, egos[1].alone
    ((_, since, _),) = rests(found)
    t = np.linspace(0.0, since, 400)
    differs = np.abs(found.state(t) - alone.state(t)).max(axis=1) > 1e-9
    brakes_at = t[differs][0]
    assert not differs[t < brakes_at].any()
    # from 1 m/s down to 0 takes 1 / 0.5 + 0.5 / 1 s
    assert since - brakes_at == pytest.approx(2.5, abs=0.02)


def test_who_gets_past_ahead_does_not_stop(timed):
    """A robot that is through before the other comes keeps the profile it would have alone."""
    egos, _, met = timed(Problem("p", FLOOR, (at_right_angles(release=6.0), robot("ego", (-8.0, 0.0), (9.0, 0.0)))))
    found = stop_robot(egos[1], met[1])
    assert (found.profile, found.how, found.before) == (egos[1].alone, "alone", (0,))


@pytest.mark.parametrize("x", [0.5, 4.0, 7.3])
def test_changing_the_velocity_beats_stopping_at_a_single_crossing(timed, x):
    """Wherever the crossing is, the quickest profile is earlier than stop and go by more than a hair."""
    # released so that both are there at one time
    problem = Problem("p", FLOOR, (at_right_angles(x=x, release=x), robot("ego", (-8.0, 0.0), (12.0, 0.0))))
    egos, timings, met = timed(problem)
    found = stop_robot(egos[1], met[1])
    assert found.how == "stop"
    assert timings[1].profile.arrival < found.profile.arrival - 0.1


@pytest.mark.parametrize("seed", range(12))
def test_against_the_same_robots_stopping_is_never_earlier(lanes, crossroads, timed, seed):
    """Robot by robot: not earlier than the quickest profile, not before the certified bound, and clear of all."""
    for problem in (lanes(seed), crossroads(seed)):
        all_timed = timed(problem)
        if all_timed is None:
            continue
        for mine, quickest, met in zip(*all_timed, strict=True):
            found = stop_robot(mine, met)
            assert found.profile.arrival >= quickest.profile.arrival * (1 - 1e-4)
            assert mine.solo_bound <= found.lower_bound <= found.profile.arrival
            assert found.lower_bound <= quickest.profile.arrival * (1 + 1e-9)
            assert first_violated(met, found.profile) is None
            assert keeps_limits(found.profile, mine.robot.limits, mine.caps)


def test_it_does_not_stop_in_the_way_of_a_third(timed):
    """Just before the conflict somebody else passes during the wait: the stop is before both, and there is one."""
    first, third = at_right_angles("first", 2.0, 2.0), at_right_angles("third", 0.9, 2.5)
    ego = robot("ego", (-8.0, 0.0), (12.0, 0.0))
    egos, timings, met = timed(Problem("p", FLOOR, (first, third, ego)))
    found = stop_robot(egos[2], met[2])
    ((place, _, until),) = rests(found.profile)
    assert place == pytest.approx(8.9 - APART, abs=1e-3)
    assert until == pytest.approx(time_at(timings[0].profile, 8.0 + APART)[0], abs=1e-3)
    assert found.after == (0, 1)
    alone = stop_robot(egos[2], [meeting for meeting in met[2] if meeting.other == 0])
    assert rests(alone.profile)[0][0] == pytest.approx(10.0 - APART, abs=1e-3)


def test_without_room_to_stop_on_the_way_it_waits_at_its_start(timed):
    """A conflict that begins 3 cm ahead of the start is waited for there: the drive alone, later."""
    first = at_right_angles(x=0.0)
    ego = robot("ego", (-APART - 0.03, 0.0), (9.0, 0.0), release=8.0)
    egos, timings, met = timed(Problem("p", FLOOR, (first, ego)))
    found = stop_robot(egos[1], met[1])
    assert found.how == "start delay"
    assert found.profile.departure == pytest.approx(time_at(timings[0].profile, 8.0 + APART)[0], abs=1e-3)
    assert np.array_equal(found.profile.states, egos[1].alone.states)


def test_two_conflicts_far_apart_are_two_stops(timed):
    """At each it waits until that other is clear."""
    first, second = at_right_angles("first", 0.0), at_right_angles("second", 6.0, 9.0)
    egos, timings, met = timed(Problem("p", FLOOR, (first, second, robot("ego", (-8.0, 0.0), (14.0, 0.0)))))
    found = stop_robot(egos[2], met[2])
    places = [place for place, *_ in rests(found.profile)]
    left = [until for *_, until in rests(found.profile)]
    assert places == pytest.approx([8.0 - APART, 14.0 - APART], abs=1e-3)
    assert left == pytest.approx([time_at(timings[k].profile, 8.0 + APART)[0] for k in range(2)], abs=1e-3)


def test_where_nobody_ever_makes_way_there_is_none(timed):
    """Behind somebody who stays on the way for ever no stop helps."""
    egos, _, met = timed(Problem("p", FLOOR, (robot("ego", (-8.0, 0.0), (9.0, 0.0)), at_right_angles())))
    parked = dataclasses.replace(met[1][0].ends, other_parks=True)
    stays = dataclasses.replace(met[1][0], ends=parked, profile=_shortened(met[1][0].profile, 8.0))
    assert stop_robot(egos[1], [stays]) is None


def _shortened(profile, length):
    """A profile that ends at rest at a place, however abruptly."""
    t = time_at(profile, length)[0]
    kept = profile.times < t
    states = np.concatenate([profile.states[kept], [[length, 0.0, 0.0]]])
    return type(profile)(np.append(profile.times[kept], t), states, profile.jerks[: int(kept.sum())])


@pytest.mark.parametrize("seed", range(4))
def test_stops_in_bends_are_certified(bent_crossing, seed):
    """The checker accepts stop and go on ways with bends, and some robot did stop."""
    result = plan(bent_crossing(seed), Options(method="stop"))
    assert result.certified
    assert "stop" in {one.how for one in result.plan.robots}


def test_how_gently_robots_give_way_is_no_question_when_they_stop(crossroads):
    """The default profile is no error, and makes no difference."""
    for seed in range(4):
        gentle, fastest = (plan(crossroads(seed), Options(method="stop", profile=one)) for one in ("gentle", "fastest"))
        assert gentle.document == fastest.document
