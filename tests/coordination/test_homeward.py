"""Large groups before a door: what the lattice confirms is a plan, and what it does not is refused."""

from __future__ import annotations

import math

import pytest

from coord.coordination.holding import Leg
from coord.coordination.homeward import Untied, moves_of, with_holding_places
from coord.coordination.rerouting import without_rings
from coord.model.footprint import Footprint
from coord.model.obstacle import rectangle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.paths.routes import find_routes
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
DISC = Footprint(0.3)


def two_rooms(rows=4):
    """Robots on a lattice in each of two rooms, all of which change places with the other room through one door."""
    left = [(1.0 + 1.6 * column, 1.0 + 1.7 * row) for column in range(2) for row in range(rows)]
    deep = 1.7 * rows + 0.3
    right = [(11.5 - x, y) for x, y in left]
    ends = [*zip(left, right, strict=True), *zip(right, (*left[1:], left[0]), strict=True)]
    robots = tuple(Robot(f"r{k:02d}", DISC, LIMITS, start, goal) for k, (start, goal) in enumerate(ends))
    walls = (rectangle("lower", (5.6, 0.0, 5.9, 3.0)), rectangle("upper", (5.6, 3.8, 5.9, deep)))
    return Problem("rooms", Workspace((0.0, 0.0, 11.5, deep), 0.05), robots, walls)


def on_a_circle(count):
    radius = 0.5 * count
    at = [
        (radius * math.cos(2 * math.pi * k / count), radius * math.sin(2 * math.pi * k / count)) for k in range(count)
    ]
    robots = tuple(Robot(f"r{k}", DISC, LIMITS, at[k], at[(k + 1) % count]) for k in range(count))
    return Problem("circle", Workspace((-10.0, -10.0, 10.0, 10.0), 0.05), robots)


def on_their_ways(problem):
    routes = find_routes(problem, "taut")
    return without_rings(problem, routes, "taut", keep_paths=False, done=lambda done, total: None)


@pytest.fixture(scope="module")
def rooms():
    """A problem, its paths without rings, and what holding places make of them."""
    problem = two_rooms()
    found = on_their_ways(problem)
    return problem, found, with_holding_places(problem, Untied(found), "taut")


def test_a_large_group_before_a_door_comes_home(rooms):
    """More than a dozen robots that have to leave together get moves after which all are home."""
    _, found, untied = rooms
    (group,) = (one for one in found.together if len(one) > 12)
    home = untied.homeward[group]
    at = [0 for _ in group]
    for move in home.moves:
        assert move.start == at[move.robot] < move.end
        at[move.robot] = move.end
    assert at == [len(places) - 1 for places in home.lattice.places]


def test_order_matters(rooms):
    """The same legs in the opposite order, or without the last one: no moves come of them."""
    _, _, untied = rooms
    ((group, home),) = untied.homeward.items()
    legs = [(group[move.robot], float(home.lattice.places[move.robot][move.end])) for move in home.moves]

    def moves(some):
        return moves_of(home.lattice, group, [Leg(*one) for one in some])

    assert moves(legs) == list(home.moves)
    assert moves(legs[::-1]) is None
    assert moves(legs[:-1]) is None


def test_rings_of_handed_over_places_keep_their_paths():
    """On a circle, each at the goal of the one before: moves are found on the paths as they are."""
    problem = on_a_circle(14)
    found = on_their_ways(problem)
    untied = with_holding_places(problem, Untied(found), "taut")
    assert untied.found is found
    assert untied.fine == found.together == (tuple(range(14)),)
    assert not untied.homeward


def test_small_groups_are_left_to_bays():
    """Of twelve robots or fewer nothing is even looked at."""
    problem = two_rooms(rows=3)
    untied = Untied(on_their_ways(problem))
    assert untied.found.together
    assert with_holding_places(problem, untied, "taut") is untied


def test_only_tangled_groups_are_looked_at_first():
    """A ring on a circle has two blocks for each robot: it waits for paths with room to pass."""
    problem = on_a_circle(14)
    untied = Untied(on_their_ways(problem))
    assert with_holding_places(problem, untied, "taut", only_tangled=True) is untied


def test_the_explanation_is_true_of_the_paths(rooms):
    """Whoever is told to go round a place does not run over it; whoever has a new path leaves room to the others."""
    _, before, untied = rooms
    found = untied.found
    for i, (blocks, _) in found.around.items():
        assert not set(blocks) & set(found.blocks)
        assert found.routes[i] is before.routes[i]
    changed = {i for i, route in enumerate(found.routes) if route is not before.routes[i]}
    assert changed
    assert all(set(found.beside[i]) >= {k for k in found.together[0] if k != i} for i in changed)


@pytest.mark.long
def test_two_rooms_full_of_robots_are_planned_and_certified():
    """Sixteen robots through one door: everybody arrives, and the independent checker agrees."""
    result = plan(two_rooms())
    assert result.certified
    assert len(result.plan.robots) == 16
