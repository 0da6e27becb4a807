"""Robots in a ring that no way round opens leave together: planned with deadlines, certified, and apart from the rest."""

from __future__ import annotations

import dataclasses
import math
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coord.coordination.blocking import arc_of
from coord.coordination.settled import settle
from coord.model.footprint import Footprint, square
from coord.model.obstacle import rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
DISC = Footprint(0.3)


def robot(name, start, goal, shape=DISC, **more):
    return Robot(name, shape, LIMITS, start, goal, **more)


def scene(*robots, obstacles=(), after="stay"):
    return Problem("scene", Workspace((-40.0, -40.0, 40.0, 40.0), 0.05, after), tuple(robots), tuple(obstacles))


def ring(count, radius, turn=0.0, middle=(0.0, 0.0), name="r", **more):
    """Robots on a circle, each going to where the next one starts."""
    angles = [turn + 2 * math.pi * k / count for k in range(count)]
    at = [(middle[0] + radius * math.cos(a), middle[1] + radius * math.sin(a)) for a in angles]
    return [robot(f"{name}{k}", at[k], at[(k + 1) % count], **more) for k in range(count)]


def settled(problem):
    quickest = find_routes(problem)
    return settle(problem, quickest, "fitted", keep_paths=False, done=lambda count, total: None).found


def check_together(result, names):
    """Certified; no arc inside the group; its robots in a row in the order, and all on the move before any other's arrival."""
    assert result.certified
    assert not [arc for arc in result.plan.blocking if {arc.first, arc.then} <= set(names)]
    places = sorted(result.plan.order.index(name) for name in names)
    assert places == list(range(places[0], places[0] + len(names)))


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6])
@pytest.mark.parametrize("radius", [1.0, 3.0])
def test_rings_of_handed_over_places_come_home(count, radius):
    """Two to six robots on a circle, each at the goal of the one before: certified, all in one group."""
    robots = ring(count, max(radius, 0.75 / math.sin(math.pi / count)), 0.2)
    check_together(plan(scene(*robots)), [one.name for one in robots])


@pytest.mark.long
@settings(deadline=None, derandomize=True, max_examples=30)
@given(st.integers(2, 6), st.floats(1.0, 3.0), st.floats(0.0, 6.2), st.lists(st.sampled_from([0.0, 3.0]), min_size=6))
def test_rings_of_any_size_come_home_whenever_they_may_leave(count, wide, turn, releases):
    """Two to six robots, each at the goal of the one before, of all sizes, released at different times: certified."""
    radius = wide * 0.7 / math.sin(math.pi / count)
    robots = [
        dataclasses.replace(one, release=release)
        for one, release in zip(ring(count, radius, turn), releases, strict=False)
    ]
    result = plan(scene(*robots))
    check_together(result, [one.name for one in robots])


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6])
def test_nobody_in_a_ring_arrives_before_the_one_whose_place_it_takes_has_left(count):
    """At the arrival of each robot the next one has gone as far as both need."""
    found = plan(scene(*ring(count, 1.5 / math.sin(math.pi / count)))).plan
    for one, following in zip(found.robots, [*found.robots[1:], found.robots[0]], strict=True):
        gone = following.path.point(following.profile.state([one.arrival])[:, 0])[0]
        assert math.dist(gone, one.robot.goal) >= 0.65 - 1e-6


def test_a_ring_on_the_move_loses_little():
    """Four robots that could all leave at once lose less than if each waited for one other to arrive."""
    found = plan(scene(*ring(4, 4.0))).plan
    lost = sum(one.arrival - one.solo_arrival for one in found.robots)
    assert lost < min(one.solo_arrival for one in found.robots)


def test_four_robots_swap_in_a_cross():
    """Two pairs that swap their places across each other's lines, at one time through one middle."""
    ends = [(-5.0, 0.0), (0.0, -5.0), (5.0, 0.0), (0.0, 5.0)]
    robots = [robot(f"r{k}", ends[k], ends[(k + 2) % 4]) for k in range(4)]
    result = plan(scene(*robots))
    assert result.certified
    assert result.plan.blocking == ()


@pytest.mark.parametrize("shape", [DISC, square(0.5), square(0.5, "path")], ids=["disc", "square", "turning"])
@pytest.mark.parametrize("after", ["stay", "leave"])
def test_a_ring_of_three_comes_home_whatever_its_shape_and_its_end(shape, after):
    """Discs and squares, staying or leaving."""
    result = plan(scene(*ring(3, 3.0, 0.3, shape=shape), after=after))
    check_together(result, ["r0", "r1", "r2"])


def test_a_ring_of_given_paths_is_kept():
    """Robots round a square on given paths: nobody is re-routed, everybody comes home."""
    robots = [dataclasses.replace(one, path=(one.start, one.goal)) for one in ring(4, 4.0)]
    result = plan(scene(*robots))
    check_together(result, [one.name for one in robots])
    assert result.plan.rerouted == ()
    assert [one.path.length for one in result.plan.robots] == pytest.approx([math.hypot(4.0, 4.0)] * 4)


def test_with_kept_paths_a_ring_comes_home_without_being_re_routed():
    """It needs none: each drives along a side of its own."""
    result = plan(scene(*ring(4, 4.0)), Options(keep_paths=True))
    check_together(result, [f"r{k}" for k in range(4)])
    assert result.plan.rerouted == ()


@settings(deadline=None, derandomize=True, max_examples=6)
@given(st.integers(3, 5), st.floats(0.0, 6.2), st.floats(0.0, 3.1))
def test_turned_and_mirrored_rings_need_the_same_time(count, turn, axis):
    """The sum of arrivals does not depend on where the ring looks, nor on its sense."""
    robots = ring(count, 3.0, turn)

    def mirrored(place):
        c, s = math.cos(2 * axis), math.sin(2 * axis)
        return (c * place[0] + s * place[1], s * place[0] - c * place[1])

    sums = []
    for more in (
        robots,
        ring(count, 3.0),
        [dataclasses.replace(one, start=mirrored(one.start), goal=mirrored(one.goal)) for one in robots],
    ):
        result = plan(scene(*more))
        assert result.certified
        sums.append(result.plan.sum_of_arrivals)
    assert sums[1:] == pytest.approx(sums[:1] * 2, rel=1e-3)


def test_a_group_far_away_changes_nobody_elses_motion():
    """Two that cross far from a ring: profiles and paths as without it, to the last digit."""
    others = [
        robot("one", (20.0, 0.0), (30.0, 0.0), priority=1.0),
        robot("two", (25.0, -5.0), (25.0, 5.0), priority=2.0),
    ]
    alone, both = plan(scene(*others)), plan(scene(*others, *ring(4, 4.0)))
    assert both.certified
    for before, after in zip(alone.plan.robots, both.plan.robots, strict=False):
        assert before.robot == after.robot
        assert before.path.pieces.tolist() == after.path.pieces.tolist()
        assert before.profile.times.tolist() == after.profile.times.tolist()
        assert before.profile.states.tolist() == after.profile.states.tolist()


def test_two_groups_are_planned_apart():
    """Rings far from each other: the motions of each are those that it has alone."""
    one, two = ring(3, 3.0), ring(4, 4.0, middle=(20.0, 0.0), name="s")
    both = plan(scene(*one, *two))
    check_together(both, ["r0", "r1", "r2"])
    check_together(both, ["s0", "s1", "s2", "s3"])
    alone = [*plan(scene(*one)).plan.robots, *plan(scene(*two)).plan.robots]
    assert [part.arrival for part in both.plan.robots] == [part.arrival for part in alone]


def test_whoever_stands_in_the_way_of_a_group_goes_before_it_and_whoever_parks_there_after():
    """The order respects the arcs between the group and the rest, whatever the priorities."""
    robots = ring(4, 4.0)
    stands = robot("stands", (2.0, 2.0), (20.0, 2.0), priority=9.0)
    parks = robot("parks", (-20.0, -2.0), (-2.0, -2.0), priority=1.0)
    given_paths = [dataclasses.replace(one, path=(one.start, one.goal)) for one in robots]
    result = plan(scene(*given_paths, stands, parks))
    check_together(result, [one.name for one in robots])
    at = {name: position for position, name in enumerate(result.plan.order)}
    arcs = {(arc.first, arc.then) for arc in result.plan.blocking}
    assert ("stands", "r0") in arcs
    assert any(then == "parks" for _, then in arcs)
    assert all(at[first] < at[then] for first, then in arcs)


def test_the_plan_keeps_exactly_the_arcs_that_are_not_inside_groups():
    """What is left of the graph is all blocks but those between members, and the members are the strong components."""
    robots = [*ring(3, 3.0), robot("late", (0.0, -9.0), (0.0, 0.0)), robot("c", (-9.0, 6.0), (9.0, 6.0))]
    problem = scene(*robots)
    found = settled(problem)
    group_of = {i: number for number, group in enumerate(found.together) for i in group}
    inside = [block for block in found.blocks if group_of.get(block.first, -1) == group_of.get(block.then, -2)]
    assert len(inside) >= 3
    expected = [arc_of(problem.robots, block) for block in found.blocks if block not in inside]
    assert list(plan(problem).plan.blocking) == expected


def test_bounds_of_a_group_do_not_count_its_deadlines():
    """A deadline is a choice: nobody's bound is above its arrival, and the whole plan's is the sum of those alone."""
    found = plan(scene(*ring(5, 4.0))).plan
    for one in found.robots:
        assert one.solo_bound <= one.lower_bound <= one.arrival
    assert found.lower_bound == pytest.approx(math.fsum(one.solo_bound for one in found.robots))


def test_the_same_ring_gives_the_same_bytes():
    """Planned twice."""
    problem = scene(*ring(5, 3.0))
    assert plan(problem).document == plan(problem).document


def test_two_groups_without_room_are_both_told():
    """Two pairs that swap places in two narrow lanes: two diagnoses, each with its pair and its proof."""
    walls = [rectangle(f"wall {k}", (-40.0, 2.0 * k + 0.5, 40.0, 2.0 * k + 1.5)) for k in range(-1, 2)]
    pairs = [
        robot(f"{name}{k}", (sign * 4.0, 2.0 * k), (-sign * 4.0, 2.0 * k))
        for k in range(2)
        for name, sign in (("a", -1), ("b", 1))
    ]
    result = plan(scene(*pairs, obstacles=walls), Options(time_limit=600.0))  # with a limit nobody seeks remedies
    assert [set(told.robots) for told in result.diagnoses] == [{"a0", "b0"}, {"a1", "b1"}]
    assert all(re.search("cannot pass each other, at whatever speeds", told.text) for told in result.diagnoses)


def test_a_time_limit_ends_a_group(monkeypatch):
    """The limit is asked for inside the group too: no plan, and the diagnosis says so."""
    monkeypatch.setattr("coord.coordination.together._raised", lambda *_: True)
    monkeypatch.setattr("coord.coordination.prioritised.time_robot", lambda *_, **__: None)
    result = plan(scene(*ring(3, 3.0)), Options(time_limit=0.5))
    assert result.plan is None
    assert result.diagnoses[0].code == "time-limit"


@pytest.mark.long
@pytest.mark.parametrize("kind", ["crowds", "rings", "swaps", "doors", "corridors"])
def test_generated_problems_come_home_or_have_a_confirmed_reason(arrival, kind):
    """Six of each kind, of 2 to 10 robots: certified, or refused for a reason that other means confirm."""
    for number in (2, 5, 11, 40, 63, 87):
        assert arrival.measured(kind, number).outcome in (arrival.CERTIFIED, arrival.CONFIRMED), number


@pytest.mark.parametrize("half", [0.34, 2.0])
def test_the_walk_of_the_benchmark_knows_who_can_pass(monkeypatch, arrival, half):
    """On one line nobody can, which a coarse grid proves; with a path 0.7 m beside it they can, on a fine one too."""
    monkeypatch.setattr(arrival, "GRIDS", (500, 1500))
    ends = (-half, 0.0), (half, 0.0)
    beside = (ends[0], (-half, 0.7), (half, 0.7), ends[1])
    problem = scene(robot("a", *ends), robot("b", *ends[::-1]))
    first, second = (route.path for route in find_routes(problem))
    assert arrival.cannot_pass(problem, 0, first, 1, second)
    around = dataclasses.replace(problem.robots[0], path=beside, corner_radius=0.02)
    (way,) = find_routes(dataclasses.replace(problem, robots=(around,)))
    assert not arrival.cannot_pass(problem, 0, way.path, 1, second)
    assert not arrival.cannot_pass(problem, 1, second, 0, way.path)


def test_the_benchmark_sums_up_the_points_of_a_path(arrival):
    """Bends and lines: the points that the rest of the project knows, to a hundredth of a millimetre."""
    around = robot("a", (-3.0, 0.0), (3.0, 0.0), via=((0.0, 2.0), (1.0, -1.0)))
    (route,) = find_routes(scene(around))
    s = [route.path.length * k / 200 for k in range(201)]
    assert abs(arrival.points(route.path, 200) - route.path.point(s)).max() <= arrival.ROUNDING
