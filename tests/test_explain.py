"""The story before planning: is it true?"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coord.explain
from coord.errors import NoPlanError
from coord.explain import explain
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((0.0, 0.0, 12.0, 12.0), 0.05)
DISC = Footprint(0.3)

#: Two radii and the clearance [m].
APART = 0.65


def robot(name, start, goal, **more):
    return Robot(name, DISC, LIMITS, start, goal, **more)


def scene(*robots, obstacles=(), workspace=FLOOR):
    return Problem("scene", workspace, robots, obstacles)


def crowd(seed, count):
    """Robots between random places on a free floor, no two starts and no two goals nearer than 1 m; some priorities."""
    rng = np.random.default_rng(seed)
    ends = []
    for _ in range(2):
        places = []
        while len(places) < count:
            place = rng.uniform(0.5, 11.5, 2)
            if all(np.hypot(*(place - other)) > 1.0 for other in places):
                places.append(place)
        ends.append([tuple(place.tolist()) for place in places])
    wishes = [None if rng.random() < 0.5 else float(rng.integers(1, 4)) for _ in range(count)]
    return scene(*(robot(f"r{k}", *way, priority=wishes[k]) for k, way in enumerate(zip(*ends, strict=True))))


ACROSS = ((1.0, 6.0), (11.0, 6.0))


@pytest.mark.parametrize("shape", ["fitted", "taut", "follow", "exponential"])
def test_in_a_symmetrical_world_both_sides_are_as_long_and_as_quick(shape):
    """A column in the middle of the straight line and of the floor: neither side is better, to 1e-6."""
    told = explain(scene(robot("red", *ACROSS), obstacles=(Circle("column", (6.0, 6.0), 1.0),)), Options(shape=shape))
    (trip,) = told.trips
    ways = {way.side: way for way in trip.route.ways}
    assert set(ways) == {"left", "right"}
    assert ways["left"].length == pytest.approx(ways["right"].length, rel=1e-6)
    assert ways["left"].time == pytest.approx(ways["right"].time, rel=1e-6)
    assert ways["left"].length > 10.0
    assert trip.past == ("column",)


def test_both_sides_are_told_in_full_also_where_the_length_of_one_shows_that_it_is_slower():
    """A rack that reaches far to the left: its right side is taken, its left side has a length and a time, no bounds."""
    rack = rectangle("rack", (5.0, 5.0, 7.0, 10.5))
    (trip,) = explain(scene(robot("red", *ACROSS), obstacles=(rack,))).trips
    left = next(way for way in trip.route.ways if way.side == "left")
    assert trip.route.side == "right"
    assert not left.is_bound
    assert left.time > trip.route.time + 1.0
    assert left.length > trip.route.path.length + 1.0


def test_a_side_that_does_not_exist_has_a_reason_and_no_figures():
    """Between the rack and the upper edge there is no gap."""
    rack = rectangle("rack", (5.0, 5.0, 7.0, 12.0))
    (trip,) = explain(scene(robot("red", *ACROSS), obstacles=(rack,))).trips
    left = next(way for way in trip.route.ways if way.side == "left")
    assert (left.length, left.time) == (None, None)
    assert '"rack"' in left.reason


def test_only_obstacles_on_the_straight_line_are_passed_on_a_side():
    """What stands beside the line is not named, and where nothing stands on it no side is."""
    box, wall = rectangle("box", (5.0, 5.5, 7.0, 6.5)), rectangle("wall", (2.0, 9.0, 10.0, 9.5))
    told = explain(scene(robot("red", *ACROSS), robot("blue", (1.0, 2.0), (11.0, 2.0)), obstacles=(box, wall)))
    assert [trip.past for trip in told.trips] == [("box",), ()]
    assert [bool(trip.route.side) for trip in told.trips] == [True, False]


def test_a_right_angled_crossing_is_met_where_the_lines_cross_and_for_two_radii_and_the_clearance_either_way():
    """Lines along x and y that cross after 4 m and 6 m."""
    told = explain(scene(robot("red", (1.0, 7.0), (11.0, 7.0)), robot("blue", (5.0, 1.0), (5.0, 11.0))))
    (met,) = told.encounters
    assert met.robots == ("red", "blue")
    assert met.place == pytest.approx((5.0, 7.0), abs=0.03)
    assert np.ravel(met.stretches) == pytest.approx([4 - APART, 4 + APART, 6 - APART, 6 + APART], abs=2e-3)


@pytest.mark.parametrize("seed", range(4))
def test_robots_can_be_too_near_only_on_the_stretches_of_their_meetings_and_they_are_at_each_place(seed):
    """Against 300 by 300 samples of every pair of paths; at the place told both are nearer than they may be."""
    told = explain(crowd(seed, 8))
    paths = {trip.robot.name: trip.route.path for trip in told.trips}
    for met in told.encounters:
        for name in met.robots:
            gaps = np.hypot(*(paths[name].point(np.linspace(0, paths[name].length, 3000)) - met.place).T)
            assert gaps.min() < APART / 2 + 0.01
    names, close = list(paths), 0
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            s, sigma = np.linspace(0, paths[a].length, 300), np.linspace(0, paths[b].length, 300)
            gap = paths[a].point(s)[:, None] - paths[b].point(sigma)[None]
            near = np.hypot(gap[..., 0], gap[..., 1]) < APART
            for (first, last), (begin, end) in (met.stretches for met in told.encounters if met.robots == (a, b)):
                inside = (s >= first)[:, None] & (s <= last)[:, None] & (sigma >= begin) & (sigma <= end)
                close += int((near & inside).sum())
                near &= ~inside
            assert not near.any()
    assert close > 1000


def test_every_robot_that_goes_before_a_more_urgent_one_has_a_chain_of_arcs_that_leads_there():
    """30 crowds: one deviation for each such robot, from it to the most urgent one behind it; nobody else has one."""
    count = longest = 0
    for seed in range(30):
        told = explain(crowd(seed, 7))
        if told.order is None:
            continue
        place, rank = {n: k for k, n in enumerate(told.order)}, {n: k for k, n in enumerate(told.urgent)}
        assert all(place[arc.first] < place[arc.then] for arc in told.arcs)
        expected = {}
        for k, name in enumerate(told.order):
            overtaken = sorted((rank[other], other) for other in told.order[k + 1 :] if rank[other] < rank[name])
            if overtaken:
                expected[name] = (overtaken[0][1], len(overtaken) - 1)
        assert {one.robot: (one.before, one.others) for one in told.deviations} == expected
        for one in told.deviations:
            assert [arc.first for arc in one.chain] == [one.robot, *(arc.then for arc in one.chain[:-1])]
            assert one.chain[-1].then == one.before
            assert set(one.chain) <= set(told.arcs)
            longest = max(longest, len(one.chain))
        count += len(told.deviations)
    assert count > 20
    assert longest > 1


@pytest.mark.parametrize("seed", [1, 2, 5])
def test_paths_order_and_arcs_are_those_of_the_plan(seed):
    """The story is that of the very plan that is made afterwards."""
    problem = replace(crowd(seed, 6), obstacles=(Circle("column", (6.0, 6.0), 0.2),))
    free = tuple(
        one
        for one in problem.robots
        if min(np.hypot(x - 6.0, y - 6.0) for x, y in (one.start, one.goal)) > 0.2 + 0.3 + 0.05
    )
    problem = replace(problem, robots=free)
    told, made = explain(problem), plan(problem).plan
    assert (made is None) == (told.order is None)
    if made is None:
        return
    assert told.order == made.order
    assert told.arcs == made.blocking
    assert told.rerouted == made.rerouted
    for trip, part in zip(told.trips, made.robots, strict=True):
        assert np.array_equal(trip.route.path.pieces, part.path.pieces)


def test_a_robot_in_a_ring_is_told_as_re_routed_and_its_quickest_way_stays_known():
    """Each starts on the other's line: one of them goes round, the arcs told are those of the new paths, no ring."""
    problem = scene(robot("red", (2.0, 6.0), (10.0, 6.0)), robot("blue", (6.0, 6.0), (2.0, 6.4)))
    told, kept = explain(problem), explain(problem, Options(keep_paths=True))
    assert kept.together == (("red", "blue"),)
    assert kept.rerouted == ()
    assert told.together == ()
    ((one,), trips) = told.rerouted, {trip.robot.name: trip for trip in told.trips}
    assert told.order is not None
    assert told.diagnoses == ()
    moved = trips[one.robot]
    assert one.extra_length == pytest.approx(moved.route.path.length - moved.quickest.path.length)
    assert one.extra_length > 0
    assert set(one.around) <= set(kept.arcs)
    assert not set(one.around) & set(told.arcs)


def test_without_a_way_for_one_robot_the_story_of_the_others_goes_on():
    """The walled-in robot has its diagnosis, the others their ways, meeting and arc; there is no order."""
    walls = rectangle("a", (8.0, 8.0, 11.5, 8.5)), rectangle("b", (8.0, 8.0, 8.5, 11.9))
    walls = (*walls, rectangle("c", (11.0, 8.0, 11.5, 11.9)))
    shut = robot("shut", (2.0, 11.0), (9.8, 10.0))
    told = explain(scene(robot("red", *ACROSS), shut, robot("blue", (6.0, 6.0), (6.0, 1.0)), obstacles=walls))
    assert [trip.route is None for trip in told.trips] == [False, True, False]
    assert [trip.diagnosis is None for trip in told.trips] == [True, False, True]
    assert told.diagnoses == (told.trips[1].diagnosis,)
    assert [met.robots for met in told.encounters] == [("red", "blue")]
    assert [(arc.first, arc.then) for arc in told.arcs] == [("blue", "red")]
    assert told.order is None
    assert told.deviations == ()


def test_where_nobody_has_a_way_there_are_only_diagnoses():
    """Both goals stand in the rack."""
    rack = rectangle("rack", (5.0, 5.0, 7.0, 7.0))
    told = explain(
        scene(robot("red", (1.0, 6.0), (6.0, 6.0)), robot("blue", (1.0, 2.0), (6.0, 5.5)), obstacles=(rack,))
    )
    assert [one.robots for one in told.diagnoses] == [("red",), ("blue",)]
    assert (told.encounters, told.arcs, told.order) == ((), (), None)


def test_robots_that_swap_places_leave_together_or_have_no_order_but_a_diagnosis_and_all_arcs():
    """Starts and goals are handed over: four arcs. They leave each other room; on kept paths they cannot pass."""
    problem = scene(robot("red", *ACROSS), robot("blue", *ACROSS[::-1]))
    told, kept = explain(problem), explain(problem, Options(keep_paths=True))
    assert told.together == kept.together == (("red", "blue"),)
    assert (told.order, told.diagnoses) == (("red", "blue"), ())
    assert [one.around for one in told.rerouted] == [(), ()]
    assert kept.order is None
    assert [one.code for one in kept.diagnoses] == ["blocking-cycle"]
    for one in (told, kept):
        assert sorted((arc.first, arc.then) for arc in one.arcs) == [("blue", "red")] * 2 + [("red", "blue")] * 2


def test_a_robot_that_only_the_comparison_of_both_sides_fails_is_not_lost(monkeypatch):
    """A plan does not always look at both sides; who has a way in a plan has one in the story."""

    def fragile(problem, shape, *more, thorough=False):
        if thorough and "red" in [one.name for one in problem.robots]:
            find_routes(scene(robot("red", *ACROSS), obstacles=(rectangle("rack", (5.0, 5.0, 12.0, 7.0)),)), shape)
        return find_routes(problem, shape, *more, thorough=thorough)

    problem = scene(robot("blue", (1.0, 2.0), (11.0, 2.0)), robot("red", *ACROSS))
    monkeypatch.setattr(coord.explain, "find_routes", fragile)
    with pytest.raises(NoPlanError):
        coord.explain.find_routes(problem, "fitted", thorough=True)
    told = explain(problem)
    assert [trip.route.path.length for trip in told.trips] == pytest.approx([10.0, 10.0])
    assert told.diagnoses == ()


def test_a_release_counts_for_the_arrival_but_not_for_the_way():
    """Released after 3 s, a robot arrives 3 s later, on a way that takes as long."""
    free, late = (explain(scene(robot("red", *ACROSS, release=release))).trips[0] for release in (0.0, 3.0))
    assert late.route.time == free.route.time
    assert late.arrival == pytest.approx(free.arrival + 3.0)


def test_progress_is_told_for_paths_and_meetings_up_to_all_of_them():
    """Each stage counts up to its total."""
    seen = []
    explain(crowd(1, 6), progress=lambda *step: seen.append(step))
    for stage in ("paths", "meetings"):
        steps = [(done, total) for name, done, total in seen if name == stage]
        assert steps[-1][0] == steps[-1][1]
        assert [done for done, _ in steps] == sorted(done for done, _ in steps)
