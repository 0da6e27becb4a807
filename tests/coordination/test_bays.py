"""Groups that are stuck on their paths although every two could pass each other: some wait in bays."""

from __future__ import annotations

import math

import pytest

from coord.coordination.bays import with_bays
from coord.coordination.lattice import Floor, lattice_of
from coord.coordination.moves import Move, moves_home
from coord.coordination.passing_by import with_room_to_pass
from coord.coordination.rerouting import without_rings
from coord.model.footprint import Footprint
from coord.model.obstacle import rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
DISC = Footprint(0.3)


def scene(*ends, obstacles=(), bounds=(-40.0, -40.0, 40.0, 40.0)):
    robots = tuple(Robot(f"r{k}", DISC, LIMITS, start, goal) for k, (start, goal) in enumerate(ends))
    return Problem("scene", Workspace(bounds, 0.05, "stay"), robots, tuple(obstacles))


def ring(count, radius):
    at = [
        (radius * math.cos(2 * math.pi * k / count), radius * math.sin(2 * math.pi * k / count)) for k in range(count)
    ]
    return [(at[k], at[(k + 1) % count]) for k in range(count)]


def before_the_door():
    """Two robots in each of two rooms hand over their places through a door as wide as one."""
    walls = [rectangle("lower", (5.0, 0.0, 5.3, 4.1)), rectangle("upper", (5.0, 4.9, 5.3, 9.0))]
    left, right = [(1.0, 3.6), (2.6, 5.4)], [(9.3, 5.4), (7.7, 3.6)]
    ends = [*zip(left, right, strict=True), *zip(right, left[::-1], strict=True)]
    return scene(*ends, obstacles=walls, bounds=(0.0, 0.0, 10.3, 9.0))


def without_bays(problem):
    found = without_rings(problem, find_routes(problem), "fitted", keep_paths=False, done=lambda done, total: None)
    return with_room_to_pass(problem, found, "fitted")


def floor(problem, found):
    paths = [route.path for route in found.routes]
    return Floor(problem.robots, paths, frozenset(found.blocks), problem.workspace.clearance)


@pytest.mark.parametrize("count", [2, 3, 5, 12])
def test_a_ring_has_moves_home(count):
    """Robots on a circle, each at the goal of the one before: moves that begin where the last one ended, up to all goals."""
    problem = scene(*ring(count, max(3.0, 0.6 * count)))
    found = without_bays(problem)
    lattice = lattice_of(floor(problem, found), range(count))
    moves = moves_home(lattice, 50).moves
    at = [0] * count
    for move in moves:
        assert move.start == at[move.robot] < move.end
        at[move.robot] = move.end
    assert at == [len(places) - 1 for places in lattice.places]


def test_nobody_comes_near_anybody_during_the_moves():
    """The robot that moves keeps its distance from all that rest meanwhile, looked at every centimetre."""
    problem = scene(*ring(5, 2.0))
    found = without_bays(problem)
    lattice = lattice_of(floor(problem, found), range(5))
    at = [0] * 5
    for n, start, end in moves_home(lattice, 50).moves:
        places = lattice.places[n]
        s = [places[start] + (places[end] - places[start]) * share / 100 for share in range(101)]
        way = found.routes[n].path.point(s)
        for m in range(5):
            if m != n:
                rests = found.routes[m].path.point([lattice.places[m][at[m]]])[0]
                assert min(math.dist(point, rests) for point in way) >= 0.65 - 1e-6
        at[n] = end


def test_a_pair_head_on_has_no_lattice():
    """Two robots that swap their places on one line do not both come home in it."""
    problem = scene(((-4.0, 0.0), (4.0, 0.0)), ((4.0, 0.0), (-4.0, 0.0)))
    routes = find_routes(problem)
    blocked = frozenset((i, 1 - i, at) for i in range(2) for at in ("start", "goal"))
    assert lattice_of(Floor(problem.robots, [one.path for one in routes], blocked, 0.05), (0, 1)) is None


def test_whoever_stands_in_nobodys_way_moves_at_once():
    """Robots that never meet: one move each, all the way."""
    problem = scene(((0.0, 0.0), (5.0, 0.0)), ((0.0, 3.0), (5.0, 3.0)), ((0.0, 6.0), (5.0, 6.0)))
    lattice = lattice_of(floor(problem, without_bays(problem)), range(3))
    assert moves_home(lattice, 1).moves == [Move(n, 0, 100) for n in range(3)]


def test_a_bay_unties_four_robots_before_a_door():
    """On their paths the lattice knows no moves home; on those with bays it does, and the plan is certified."""
    problem = before_the_door()
    found = without_bays(problem)
    (group,) = (one for one in found.together if len(one) == 4)
    assert moves_home(lattice_of(floor(problem, found), group), 300).moves is None
    untied = with_bays(problem, found, "fitted", lambda: None)
    assert moves_home(lattice_of(floor(problem, untied), group), 300).moves is not None
    assert set(untied.blocks) <= set(found.blocks)
    assert plan(problem).certified


def test_groups_with_moves_home_keep_their_paths():
    """A ring of four needs no bay: the very same routes."""
    problem = scene(*ring(4, 3.0))
    found = without_bays(problem)
    assert with_bays(problem, found, "fitted", lambda: None) is found


def test_two_robots_head_on_in_a_narrow_lane_pass_where_it_has_an_alcove():
    """One waits in the alcove; in the same lane without it there is no way, which is proved."""
    limits = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
    robots = (
        Robot("east", Footprint(0.3), limits, (0.5, 0.4), (11.0, 0.4)),
        Robot("west", Footprint(0.3), limits, (11.5, 0.4), (1.0, 0.4)),
    )
    floor = Workspace((0.0, 0.0, 12.0, 2.2), 0.05)
    beside = (rectangle("left", (0.0, 0.8, 5.4, 2.2)), rectangle("right", (6.6, 0.8, 12.0, 2.2)))
    found = plan(Problem("lane", floor, robots, beside))
    assert found.certified
    assert max(one.path.poses[:, 1].max() for one in found.plan.robots) > 1.0
    shut = plan(Problem("lane", floor, robots, (*beside, rectangle("alcove", (5.4, 0.8, 6.6, 2.2)))))
    assert shut.plan is None
    assert "cannot pass each other, at whatever speeds" in shut.diagnoses[0].text
