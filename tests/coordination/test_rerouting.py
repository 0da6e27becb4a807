"""Rings are opened by as few robots as possible, and nothing else changes."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.coordination.blocking import find_blocks, is_blocked
from coord.coordination.rerouting import reroute
from coord.coordination.rings import rings
from coord.coordination.way_round import rests, way_round
from coord.errors import NoPlanError
from coord.model.footprint import Footprint, square
from coord.model.obstacle import rectangle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((-30.0, -30.0, 30.0, 30.0), 0.05)

#: Each starts on the other's way; "b" starts nearer to the side of its way, so it loses less by going round.
PAIR = (("a", (-2.0, 0.0), (9.0, 0.0)), ("b", (2.0, 0.3), (-9.0, 0.0)))


def robot(name, start, goal, shape=Footprint(0.3), **more):  # noqa: B008 - a frozen value
    return Robot(name, shape, LIMITS, start, goal, **more)


def scene(*robots, obstacles=()):
    return Problem("scene", FLOOR, tuple(robots), obstacles)


def prepared(problem):
    """Routes and the blocking graph of a problem."""
    routes = find_routes(problem)
    paths, clearance = [route.path for route in routes], problem.workspace.clearance
    reaches = [one.footprint.radius + clearance / 2 for one in problem.robots]
    pairs = candidate_pairs([chords(path) for path in paths], reaches)
    return routes, find_blocks(problem.robots, paths, pairs, clearance)


def opened(problem, **more):
    return reroute(problem, *prepared(problem), **more)


def changed(found):
    return sorted(found.around)


@pytest.mark.parametrize("swapped", [False, True])
def test_of_two_robots_in_each_others_way_the_one_goes_round_that_loses_less(swapped):
    """Exactly one leaves its path, whichever stands first in the file."""
    robots = [robot(*one) for one in PAIR]
    problem = scene(*(robots[::-1] if swapped else robots))
    routes, blocks = prepared(problem)
    found = reroute(problem, routes, blocks)
    known = rests(problem)
    times = [way_round(known, i, routes[i], frozenset(), "fitted").route.time - routes[i].time for i in range(2)]
    assert abs(times[0] - times[1]) > 1e-3
    assert changed(found) == [int(np.argmin(times))]
    assert not found.left
    assert not rings(range(2), found.blocks)


def test_a_ring_of_four_needs_one_robot():
    """Four robots round a square, each starting on the way of the next: one goes round, three keep their paths."""
    corners = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)]
    beyond = [(9.0, -3.0), (3.0, 9.0), (-9.0, 3.0), (-3.0, -9.0)]
    problem = scene(*(robot(f"r{k}", *ends) for k, ends in enumerate(zip(corners, beyond, strict=True))))
    routes, blocks = prepared(problem)
    assert rings(range(4), blocks) == [[0, 1, 2, 3]]
    found = reroute(problem, routes, blocks)
    assert len(changed(found)) == 1
    assert sum(new is not old for new, old in zip(found.routes, routes, strict=True)) == 1


def test_a_robot_in_two_rings_opens_both():
    """One that stands in the way of two others and they in its: it alone goes round, though the two could."""
    problem = scene(
        robot("middle", (0.0, 0.0), (12.0, 0.0)),
        robot("one", (3.0, -0.5), (-9.0, 1.5)),
        robot("two", (8.0, 0.6), (-12.0, -0.9)),
    )
    _, blocks = prepared(problem)
    assert sorted({(block.resting, block.driving) for block in blocks}) == [(0, 1), (0, 2), (1, 0), (2, 0)]
    assert changed(opened(problem)) == [0]


def test_rings_apart_are_opened_apart():
    """Two pairs far from each other: one robot of each."""
    pairs = [robot(*one) for one in PAIR]
    far = [robot(name * 2, (x, y + 15), (u, v + 15)) for name, (x, y), (u, v) in PAIR]
    found = opened(scene(*pairs, *far))
    assert [i // 2 for i in changed(found)] == [0, 1]


def test_without_rings_nothing_changes():
    """The same routes, the same blocks, in the same order."""
    problem = scene(robot("a", (-9.0, 0.0), (9.0, 0.0)), robot("b", (0.0, 0.0), (0.0, 9.0)))
    routes, blocks = prepared(problem)
    found = reroute(problem, routes, blocks)
    assert blocks
    assert (found.routes, found.blocks, found.around, found.left) == (tuple(routes), tuple(blocks), {}, ())


@pytest.mark.parametrize(
    ("shape", "crowds"),
    [(Footprint(0.3), 8), (square(0.5), 4), (square(0.5, "path"), 4)],
    ids=["disc", "square", "turning"],
)
def test_crowds_are_opened_by_few_robots_that_run_over_nothing_new(crowd, shape, crowds):
    """Crowds: no ring is left; the blocks are those of the new paths; none is new; nobody could keep its path; where one opens a ring, it is one."""
    whole = one_enough = 0
    for seed in range(crowds):
        problem = crowd(seed, shape=shape)
        routes, blocks = prepared(problem)
        found = reroute(problem, routes, blocks)
        everybody = range(len(routes))
        assert not found.left
        assert not rings(everybody, found.blocks)
        paths = [route.path for route in found.routes]
        pairs = [(i, k) for i in everybody for k in everybody if i < k]
        assert list(found.blocks) == find_blocks(problem.robots, paths, pairs, 0.05)
        assert set(found.blocks) <= set(blocks)
        assert all(found.routes[i] is routes[i] for i in everybody if i not in found.around)
        for i in found.around:
            own_again = [b for b in found.blocks if b.driving != i] + [b for b in blocks if b.driving == i]
            assert rings(everybody, own_again)
        for ring in rings(everybody, blocks):
            whole += 1
            if any(not rings(ring, [b for b in blocks if b.driving != i]) for i in ring):
                one_enough += 1
                assert len(set(ring) & set(found.around)) == 1
    assert whole >= crowds / 2
    assert one_enough >= crowds / 4


def test_a_new_path_keeps_the_distance_to_all_who_rest(crowd):
    """Whoever was re-routed in an open crowd runs over no place of anybody."""
    seen = 0
    for seed in range(8):
        found = opened(crowd(seed))
        for i in found.around:
            seen += 1
            assert not [block for block in found.blocks if block.driving == i]
    assert seen >= 6


def test_a_given_path_is_kept_and_the_other_goes_round():
    """Of two that block each other only one may leave its path, whatever it costs."""
    for given in range(2):
        robots = [robot(*one) for one in PAIR]
        robots[given] = dataclasses.replace(robots[given], path=(robots[given].start, robots[given].goal))
        assert changed(opened(scene(*robots))) == [1 - given]


def test_two_given_paths_in_each_others_way_are_told():
    """Nothing is re-routed; the diagnosis says that the paths are given."""
    robots = [dataclasses.replace(robot(*one), path=one[1:]) for one in PAIR]
    result = plan(scene(*robots))
    assert result.plan is None
    (told,) = result.diagnoses
    assert told.code == "blocking-cycle"
    assert 'the path of "a" is given' in told.text
    assert 'the path of "b" is given' in told.text


def test_kept_paths_lead_to_the_diagnosis_of_each_ring():
    """With keep_paths one diagnosis a ring, naming only its robots, and the remedy names the way out."""
    far = [robot(name * 2, (x, y + 15), (u, v + 15)) for name, (x, y), (u, v) in PAIR]
    problem = scene(*(robot(*one) for one in PAIR), *far, robot("free", (0.0, -20.0), (5.0, -20.0)))
    result = plan(problem, Options(keep_paths=True))
    assert (result.plan, result.document) == (None, b"")
    assert [set(told.robots) for told in result.diagnoses] == [{"a", "b"}, {"aa", "bb"}]
    assert all(told.code == "blocking-cycle" for told in result.diagnoses)
    assert all("Allow ways round" in told.remedy for told in result.diagnoses)


def test_places_handed_over_in_a_ring_are_told_with_the_reason():
    """Two robots that swap places in a lane: the diagnosis says whose place it is; a third is not named."""
    walls = tuple(rectangle(f"wall {k}", (-29.9, y, 29.9, y + 0.2)) for k, y in enumerate((-0.7, 0.5)))
    problem = scene(
        robot("a", (-5.0, 0.0), (5.0, 0.0)),
        robot("b", (5.0, 0.0), (-5.0, 0.0)),
        robot("c", (0.0, 3.0), (9.0, 9.0)),
        obstacles=walls,
    )
    (told,) = plan(problem).diagnoses
    assert set(told.robots) == {"a", "b"}
    places = [f'no way round: the {at} of "{name}" is there' for name in "ab" for at in ("start", "goal")]
    assert sum(told.text.count(place) for place in places) == 2
    assert "cannot pass each other, at whatever speeds" in told.text
    assert "room" not in told.remedy


def test_a_lane_without_room_is_told():
    """Head-on in a lane with no way round: both robots are named, and that they find no way."""
    walls = tuple(rectangle(f"wall {k}", (-12.0, y, 12.0, y + 0.2)) for k, y in enumerate((-0.7, 0.5)))
    problem = scene(robot("a", (-3.0, 0.0), (9.0, 0.0)), robot("b", (3.0, 0.0), (-9.0, 0.0)), obstacles=walls)
    (told,) = plan(problem).diagnoses
    assert told.code == "blocking-cycle"
    assert '"a" finds no way round' in told.text
    assert '"b" finds no way round' in told.text


def test_where_not_all_places_can_be_gone_round_those_of_the_ring_are():
    """In a lane stands one who leaves first; the ring further on is opened although no way leads round that one."""
    walls = tuple(rectangle(f"wall {k}", (-12.0, y, -4.0, y + 0.2)) for k, y in enumerate((-0.7, 0.5)))
    first = robot("first", (-6.0, 0.0), (-3.0, -9.0))
    pair = [
        robot("a", (-9.0, 0.0), (9.0, 0.0)),
        dataclasses.replace(robot("b", (2.0, 0.0), (-10.5, 0.0)), path=((2.0, 0.0), (-10.5, 0.0))),
    ]
    problem = scene(first, *pair, obstacles=walls)
    found = opened(problem)
    assert not found.left
    assert changed(found) == [1]
    assert [(block.resting, block.at) for block in found.blocks if block.driving == 1] == [(0, "start")]


def test_a_robot_that_never_moves_is_gone_round():
    """It blocks by its start and by its goal, at one place; the other drives round it."""
    problem = scene(robot("rests", (0.0, 0.1), (0.0, 0.1)), robot("goes", (-9.0, 0.0), (9.0, 0.0)))
    found = opened(problem)
    assert changed(found) == [1]
    assert found.blocks == ()


def test_places_far_from_the_way_are_not_forgotten():
    """A wall forces the way round far out, where somebody rests: it runs over nobody there either."""
    wall = rectangle("wall", (-0.5, -2.0, 0.5, 14.0))
    problem = scene(
        robot("a", (-2.0, 0.0), (2.0, 0.0)),
        robot("b", (0.0, -2.7), (-2.5, 0.9)),
        *(robot(f"far {k}", (0.0, -3.9 - 1.2 * k), (20.0, -3.9 - 1.2 * k)) for k in range(12)),
        obstacles=(wall,),
    )
    routes, _ = prepared(problem)
    way = way_round(rests(problem), 0, routes[0], frozenset(), "fitted")
    for k in range(1, len(problem.robots)):
        for at in ("start", "goal"):
            block = rests(problem).block(2 * k + (at == "goal"), 0)
            assert not is_blocked(way.route.path, block, problem.robots, 0.05)


def test_what_is_told_while_rings_are_opened_only_grows_and_ends_at_all(crowd):
    """Counts rise strictly up to the number of robots in rings."""
    told = []
    problem = crowd(3)
    _, blocks = prepared(problem)
    opened(problem, done=lambda count, total: told.append((count, total)))
    counts = [count for count, _ in told]
    assert counts
    assert counts == sorted(set(counts))
    assert {total for _, total in told} == {counts[-1]} == {sum(map(len, rings(range(15), blocks)))}


def test_the_time_limit_ends_the_search():
    """What the check raises comes out."""

    def up():
        raise NoPlanError([])

    with pytest.raises(NoPlanError):
        opened(scene(*(robot(*one) for one in PAIR)), check_time=up)


def test_the_plan_says_who_was_rerouted_why_and_at_what_cost():
    """One entry: the robot, its ring, the places gone round, metres and seconds; the sum alone is that of the quickest paths."""
    problem = scene(*(robot(*one) for one in PAIR))
    routes, _ = prepared(problem)
    result = plan(problem)
    assert result.certified
    (told,) = result.plan.rerouted
    index = {"a": 0, "b": 1}[told.robot]
    other = "ab"[1 - index]
    assert set(told.ring) == {"a", "b"}
    assert [(arc.first, arc.then, arc.at) for arc in told.around] == [(other, told.robot, "start")]
    now = result.plan.robots[index]
    assert told.extra_length == pytest.approx(now.path.length - routes[index].path.length)
    assert told.extra_length > 0
    assert told.extra_time > 0
    assert f'"{told.robot}" goes round "{other}" at its start' in told.text
    assert f"{told.extra_time:.2f} s" in told.text
    assert result.plan.sum_of_solo_arrivals == pytest.approx(sum(route.time for route in routes))
    assert now.solo_bound > now.solo_arrival
