"""Room to pass: two robots that meet head-on get paths beside each other, and are refused only where that is proved."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.coordination.passing_by import is_proved_separated, is_separated, separated_pairs, with_room_to_pass
from coord.coordination.rerouting import without_rings
from coord.errors import NoPlanError
from coord.model.footprint import Footprint, square
from coord.model.obstacle import rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
CLEARANCE = 0.05
DISC = Footprint(0.3)

#: With a limit nobody seeks remedies, which takes longer than all the rest and is tested elsewhere.
QUICK = Options(time_limit=600.0)

#: [m] What two of these robots keep between their centres.
REACH = 0.65


def robot(name, start, goal, shape=DISC, limits=LIMITS, **more):
    return Robot(name, shape, limits, start, goal, **more)


def scene(*robots, obstacles=(), bounds=(-30.0, -30.0, 30.0, 30.0), after="stay"):
    return Problem("scene", Workspace(bounds, CLEARANCE, after), tuple(robots), tuple(obstacles))


def swap(half, angle=0.0, **more):
    """Two robots about the origin, each where the other wants to be."""
    end = (half * math.cos(angle), half * math.sin(angle))
    back = (-end[0], -end[1])
    return scene(robot("a", back, end, **more), robot("b", end, back, **more))


def lane(width, half=4.0, **more):
    """Two robots that swap places in a lane with walls to the edges of the floor, and closed at both ends."""
    low, high = -width / 2, width / 2
    walls = rectangle("lower wall", (-6.0, -3.0, 6.0, low)), rectangle("upper wall", (-6.0, high, 6.0, 3.0))
    ends = (-half, 0.0), (half, 0.0)
    robots = robot("a", *ends, **more), robot("b", *ends[::-1], **more)
    return scene(*robots, obstacles=walls, bounds=(-6.0, -3.0, 6.0, 3.0))


def unopened(problem):
    """The routes before any room to pass is made."""
    quickest = find_routes(problem)
    return without_rings(problem, quickest, "fitted", keep_paths=False, done=lambda count, total: None)


@st.composite
def drives(draw):
    """Speed limits from slow to quick, up and down independently."""
    speed, up, down, jerk = (draw(st.sampled_from([0.4, 0.7, 1.0, 1.6])) for _ in range(4))
    return Limits(speed, up, down, jerk, 0.5)


@settings(deadline=None, derandomize=True, max_examples=8)
@given(st.floats(0.7, 8.0), st.floats(-math.pi, math.pi), drives(), drives(), st.sampled_from([0.0, 2.0, 20.0]))
def test_two_robots_swap_places_on_a_free_floor(half, angle, mine, theirs, release):
    """Whatever their distance from 1.4 m on, direction, limits and releases: certified, and they leave together."""
    problem = swap(half, angle)
    first, second = problem.robots
    robots = dataclasses.replace(first, limits=mine), dataclasses.replace(second, limits=theirs, release=release)
    result = plan(dataclasses.replace(problem, robots=robots))
    assert result.certified
    assert result.plan.blocking == ()
    early, late = sorted(one.profile.departure for one in result.plan.robots)
    assert late < max(one.arrival for one in result.plan.robots)
    assert any("room to pass" in one.text for one in result.plan.rerouted)


@st.composite
def ways(draw):
    """Two given paths of up to three legs; often from each other's goals, and one beside the other."""

    def place():
        return tuple(draw(st.floats(-3.0, 3.0).map(lambda x: round(x, 3))) for _ in range(2))

    def aside(at):
        return tuple(x + draw(st.sampled_from([-0.5, -0.2, 0.0, 0.3])) for x in at)

    first = [place() for _ in range(draw(st.integers(2, 4)))]
    kind = draw(st.sampled_from(["back", "beside", "swap", "any"]))
    inner = [place() for _ in range(draw(st.integers(0, 2)))]
    second = {
        "back": first[::-1],
        "beside": [first[-1], *map(aside, first[-2:0:-1]), first[0]],
        "swap": [first[-1], *inner, first[0]],
        "any": [place(), *inner, place()],
    }[kind]
    return first, second, draw(st.sampled_from(["stay", "leave"]))


@pytest.mark.parametrize("examples", [pytest.param(25, id="few"), pytest.param(250, id="many", marks=pytest.mark.long)])
def test_pairs_are_separated_exactly_where_a_walk_over_a_grid_says_so(monkeypatch, arrival, examples):
    """Given paths, staying or leaving: whom a walk brings home is neither separated nor proved so; whom none does is separated, if in one group."""
    monkeypatch.setattr(arrival, "GRIDS", (400, 1200))
    seen = set()

    @settings(deadline=None, derandomize=True, database=None, max_examples=examples)
    @given(ways())
    def check(drawn):
        first, second, after = drawn
        near = math.dist(first[0], second[0]), math.dist(first[-1], second[-1])
        legs = [math.dist(a, b) for way in (first, second) for a, b in itertools.pairwise(way)]
        if near[0] < REACH or (near[1] < REACH and after == "stay") or min(legs) < 0.1:
            return
        robots = (
            robot("a", first[0], first[-1], path=tuple(first)),
            robot("b", second[0], second[-1], path=tuple(second)),
        )
        problem = scene(*robots, after=after)
        try:
            found = unopened(problem)
        except NoPlanError:  # a path that turns straight back
            return
        mine, theirs = (route.path for route in found.routes)
        separated, proved = is_separated(problem, found, 0, 1), is_proved_separated(problem, found, 0, 1)
        if arrival.can_pass(problem, 0, mine, 1, theirs):
            assert (separated, proved) == (False, False)
            seen.add((after, "can"))
        elif arrival.cannot_pass(problem, 0, mine, 1, theirs) and found.together:
            assert separated
            seen.add((after, "cannot"))

    check()
    assert examples < 100 or seen == {(after, what) for after in ("stay", "leave") for what in ("can", "cannot")}
    assert {what for _, what in seen} == {"can", "cannot"}


@pytest.mark.parametrize("half", [0.34, 0.4, 0.5, 0.6])
def test_two_robots_swap_places_side_by_side(half):
    """Nearer to each other than two reaches, where no body on the line between them leaves its ends free."""
    assert 2 * half > REACH
    assert plan(swap(half, 0.4)).certified


@settings(deadline=None, derandomize=True, max_examples=8)
@given(st.floats(1.0, 6.0), st.floats(-math.pi, math.pi), st.sampled_from(["fixed", "path"]))
def test_squares_swap_places(half, angle, heading):
    """Fixed or turning with their paths, in any direction."""
    assert plan(swap(half, angle, shape=square(0.5, heading))).certified


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0])
def test_robots_that_leave_swap_places(angle):
    """Each is gone when it arrives, but still starts at the other's goal."""
    problem = swap(4.0, angle)
    leaving = dataclasses.replace(problem.workspace, after_arrival="leave")
    result = plan(dataclasses.replace(problem, workspace=leaving))
    assert result.certified
    assert result.plan.blocking == ()


def test_a_lane_too_narrow_for_two_is_refused_with_the_proof():
    """1 cm less than two robots and three clearances need: the pair is named, at whatever speeds."""
    result = plan(lane(4 * 0.3 + 3 * CLEARANCE - 0.01), QUICK)
    assert (result.plan, result.certified) == (None, False)
    (told,) = result.diagnoses
    assert told.code == "blocking-cycle"
    assert '"a" and "b" cannot pass each other, at whatever speeds' in told.text


def test_in_a_lane_wide_enough_for_two_they_pass():
    """15 cm more than that: certified."""
    assert plan(lane(4 * 0.3 + 3 * CLEARANCE + 0.15)).certified


def test_a_lane_with_a_bay_lets_them_pass():
    """Too narrow for two but for a bay in the middle: one goes into it."""
    narrow = 0.5
    walls = (
        rectangle("lower wall", (-6.0, -3.0, 6.0, -narrow)),
        rectangle("upper wall, left", (-6.0, narrow, -1.2, 3.0)),
        rectangle("upper wall, right", (1.2, narrow, 6.0, 3.0)),
    )
    robots = robot("a", (-4.0, 0.0), (4.0, 0.0)), robot("b", (4.0, 0.0), (-4.0, 0.0))
    result = plan(scene(*robots, obstacles=walls, bounds=(-6.0, -3.0, 6.0, 3.0)))
    assert result.certified


@settings(deadline=None, derandomize=True, max_examples=15)
@given(st.floats(1.5, 6.0), st.floats(-math.pi, math.pi), st.floats(-0.5, 0.5))
def test_a_pair_that_got_room_is_separated_no_more(half, angle, aside):
    """Before, the pair is separated, and that is proved; after, neither; the ends of the paths are the same."""
    problem = swap(half, angle)
    first, second = problem.robots
    moved = (first.goal[0] - aside * math.sin(angle) / 10, first.goal[1] + aside * math.cos(angle) / 10)
    problem = dataclasses.replace(problem, robots=(dataclasses.replace(first, goal=moved), second))
    before = unopened(problem)
    assert before.together == ((0, 1),)
    assert separated_pairs(problem, before) == [(0, 1)]
    assert is_proved_separated(problem, before, 0, 1)
    after = with_room_to_pass(problem, before, "fitted")
    assert not is_separated(problem, after, 0, 1)
    assert not is_proved_separated(problem, after, 0, 1)
    for one, route in zip(problem.robots, after.routes, strict=True):
        assert (route.path.start[:2], route.path.end) == (one.start, pytest.approx(one.goal, abs=1e-9))


@settings(deadline=None, derandomize=True, max_examples=15)
@given(st.floats(1.5, 6.0), st.floats(-math.pi, math.pi))
def test_separation_does_not_depend_on_who_is_asked_first(half, angle):
    """Neither the planner's view nor the proof, before and after room was made."""
    problem = swap(half, angle)
    before = unopened(problem)
    for found in (before, with_room_to_pass(problem, before, "fitted")):
        for asked in (is_separated, is_proved_separated):
            assert asked(problem, found, 0, 1) == asked(problem, found, 1, 0)


def test_given_paths_are_kept_and_the_other_makes_room():
    """One of a pair has a given path: it stays on it, the other leaves the room."""
    problem = swap(4.0)
    for given_path in range(2):
        robots = list(problem.robots)
        mine = robots[given_path]
        robots[given_path] = dataclasses.replace(mine, path=(mine.start, mine.goal))
        result = plan(dataclasses.replace(problem, robots=tuple(robots)))
        assert result.certified
        assert result.plan.robots[given_path].path.length == pytest.approx(8.0)
        assert [one.robot for one in result.plan.rerouted] == ["ab"[1 - given_path]]


def test_two_given_paths_on_one_line_are_refused_with_the_proof():
    """Nobody may leave its path, so the pair is separated for good."""
    robots = [dataclasses.replace(one, path=(one.start, one.goal)) for one in swap(4.0).robots]
    (told,) = plan(scene(*robots), QUICK).diagnoses
    assert "cannot pass each other, at whatever speeds" in told.text


def test_two_given_paths_with_a_bend_between_them_are_kept():
    """Given paths that leave room already: planned, and nobody is re-routed."""
    above = ((-4.0, 0.0), (-2.0, 1.0), (2.0, 1.0), (4.0, 0.0))
    robots = robot("a", above[0], above[-1], path=above), robot("b", above[-1], above[0], path=(above[-1], above[0]))
    result = plan(scene(*robots))
    assert result.certified
    assert result.plan.rerouted == ()


def test_with_kept_paths_nobody_makes_room():
    """The pair is refused, and the remedy is to allow ways round."""
    result = plan(swap(4.0), Options(keep_paths=True, time_limit=600.0))
    assert result.plan is None
    assert "Allow ways round" in result.diagnoses[0].remedy


def test_mirrored_pairs_need_the_same_time():
    """A swap beside a wall, mirrored left to right of the direction of travel: the same sum of arrivals."""
    wall = (-6.0, -1.6, 6.0, -0.6)
    sums = []
    for sign in (1, -1):
        low, high = sorted((sign * wall[1], sign * wall[3]))
        robots = robot("a", (-4.0, 0.0), (4.0, sign * 0.2)), robot("b", (4.0, sign * 0.2), (-4.0, 0.0))
        sums.append(plan(scene(*robots, obstacles=[rectangle("wall", (wall[0], low, wall[2], high))])))
    assert all(one.certified for one in sums)
    assert sums[0].plan.sum_of_arrivals == pytest.approx(sums[1].plan.sum_of_arrivals, rel=1e-6)


def test_a_pair_makes_room_round_others_that_rest():
    """A third robot that starts beside the line, and goes away: the paths of the pair run over no place of its."""
    beside = robot("third", (0.0, 0.9), (0.0, 9.0))
    result = plan(scene(*swap(4.0).robots, beside))
    assert result.certified
    for one in result.plan.robots[:2]:
        s = np.linspace(0.0, one.path.length, 2000)
        for place in (beside.start, beside.goal):
            assert np.hypot(*(one.path.point(s) - place).T).min() > REACH - 1e-6
