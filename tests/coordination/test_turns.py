"""Moves of one robot at a time become motions at the same time, and these are only ever improved."""

from __future__ import annotations

import math

import pytest

from coord.coordination.blocking import Block, reaches_of
from coord.coordination.lattice import Floor, lattice_of
from coord.coordination.moves import Move, moves_home
from coord.coordination.prioritised import timing
from coord.coordination.rerouting import without_rings
from coord.coordination.scene import scene_of
from coord.coordination.turns import improved, in_turns, sum_of
from coord.model.footprint import Footprint
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.timing.ego import ego

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)


def solve(one, meetings, *, hurried=False):
    return timing(one, meetings, profile="fastest", hurried=hurried)


@pytest.fixture(scope="module", params=[3, 5])
def ring(request):
    """A scene of robots on a circle, each at the goal of the one before; and their motions in turns."""
    count = request.param
    at = [(2.5 * math.cos(2 * math.pi * k / count), 2.5 * math.sin(2 * math.pi * k / count)) for k in range(count)]
    robots = tuple(Robot(f"r{k}", Footprint(0.3), LIMITS, at[k], at[(k + 1) % count]) for k in range(count))
    problem = Problem("ring", Workspace((-9.0, -9.0, 9.0, 9.0), 0.05, "stay"), robots)
    found = without_rings(problem, find_routes(problem), "fitted", keep_paths=False, done=lambda done, total: None)
    egos = [ego(robot, route.path, route.alone) for robot, route in zip(robots, found.routes, strict=True)]
    scene = scene_of(egos, reaches_of(robots, 0.05), found.blocks, 0.05)
    lattice = lattice_of(Floor(robots, [one.path for one in egos], scene.blocked, 0.05), range(count))
    return scene, in_turns(scene, range(count), lattice, moves_home(lattice, 50).moves, {})


def least_gap(scene, timings):
    """Least distance [m] of two robots, looked at every hundredth of a second."""
    end = max(one.profile.arrival for one in timings.values())
    times = [0.01 * k for k in range(math.ceil(100 * end) + 1)]
    ways = {i: scene.egos[i].path.point(one.profile.state(times)[:, 0]) for i, one in timings.items()}
    return min(math.dist(a, b) for i in ways for k in ways if i < k for a, b in zip(ways[i], ways[k], strict=True))


def test_motions_in_turns_keep_their_distance_and_end_at_the_goals(ring):
    """Never nearer than both need; every profile is as long as its path."""
    scene, turns = ring
    assert least_gap(scene, turns) >= 0.65 - 1e-6
    for i, one in turns.items():
        assert one.profile.length == pytest.approx(scene.egos[i].length, abs=1e-9)


def test_whoever_follows_sets_off_before_the_one_ahead_has_arrived():
    """Two robots in a row on one line, the first one's start on the other's way: the second leaves once that is free."""
    ends = [((0.0, 0.0), (20.0, 0.0)), ((-2.0, 0.0), (15.0, 0.0))]
    robots = tuple(Robot(f"r{k}", Footprint(0.3), LIMITS, start, goal) for k, (start, goal) in enumerate(ends))
    problem = Problem("row", Workspace((-9.0, -9.0, 29.0, 9.0), 0.05, "stay"), robots)
    egos = [ego(robot, route.path, route.alone) for robot, route in zip(robots, find_routes(problem), strict=True)]
    blocks = [Block(0, 1, "start"), Block(1, 0, "goal")]
    scene = scene_of(egos, reaches_of(robots, 0.05), blocks, 0.05)
    lattice = lattice_of(Floor(robots, [one.path for one in egos], scene.blocked, 0.05), range(2))
    moves = [Move(n, 0, len(lattice.places[n]) - 1) for n in range(2)]
    turns = in_turns(scene, range(2), lattice, moves, {})
    assert least_gap(scene, turns) >= 0.65 - 1e-6
    assert turns[1].profile.departure < turns[0].profile.arrival / 2


def test_improving_makes_nobody_later_and_much_better(ring):
    """Each arrival at most what it was, the sum clearly below; the distances are still kept."""
    scene, turns = ring
    better = improved(scene, turns, {}, solve, lambda: None, 100)
    assert all(better[i].profile.arrival <= turns[i].profile.arrival * 1.01 for i in turns)
    assert sum_of(better) < 0.9 * sum_of(turns)
    assert least_gap(scene, better) >= 0.65 - 1e-6


def test_without_robots_to_plan_anew_nothing_changes_but_the_order(ring):
    """With no effort allowed and no profile found, the very same profiles, the first to arrive first."""
    scene, turns = ring
    same = improved(scene, turns, {}, lambda one, meetings, *, hurried=False: None, lambda: None, 0)
    arrivals = [one.profile.arrival for one in same.values()]
    assert arrivals == sorted(arrivals)
    assert all(same[i].profile is turns[i].profile for i in turns)


def test_after_and_before_name_only_robots_that_come_earlier_in_the_order(ring):
    """Whoever is named was told of before."""
    scene, turns = ring
    better = improved(scene, turns, {}, solve, lambda: None, 100)
    seen = set()
    for i, one in better.items():
        assert {*one.after, *one.before} <= seen
        seen.add(i)
