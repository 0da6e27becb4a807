"""The shortest path against second opinions that share no code with it, on random fields."""

from __future__ import annotations

import importlib.util
import math
import sys
from pathlib import Path

import numpy as np
import pytest
import shapely

from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.problem import Workspace
from coord.paths.skeleton import NoWay, skeleton

ANALYSIS = Path(__file__).resolve().parents[2] / "analysis"
if not ANALYSIS.is_dir():
    pytest.skip("the second opinions live in analysis/, which is not here", allow_module_level=True)

#: [m] How well two ways of adding up the same tangents and arcs agree.
SAME = 1e-9


def load(name):
    spec = importlib.util.spec_from_file_location(f"coord_analysis_{name}", ANALYSIS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


fields, oracle = load("fields"), load("oracle")


def ways(field, robot):
    """The search's length, infinite for no way, and the oracle's scene with start and goal."""
    found = skeleton(fields.floor_of(field, robot), robot.start, robot.goal)
    ends = complex(*robot.start), complex(*robot.goal)
    grown = oracle.scene(field.workspace, field.obstacles, robot.footprint, ends)
    return math.inf if isinstance(found, NoWay) else found.length, grown, *ends


def check(count, seed, robots, whole):
    """Robots on one field against the graph, the polygons and the proof; ``whole``: nothing of the graph is left out."""
    field, rng = fields.random_field(count, seed), np.random.default_rng(seed)
    for k in range(robots):
        robot = fields.random_robot(field, f"r{k}", rng, ("disc", "square")[k % 2])
        length, grown, start, goal = ways(field, robot)
        where = f"field ({count}, {seed}), robot {k}"
        assert oracle.separated(grown, start, goal) == (length == math.inf), where
        if whole or length < math.inf:
            least = oracle.tangent_length(grown, start, goal, math.inf if whole else length + SAME)
            assert least == length or abs(least - length) <= SAME, where
        if length < math.inf:
            assert oracle.visibility_length(grown, start, goal, 1.001 * length) >= length - SAME, where


@pytest.mark.parametrize(("count", "seed"), [(10, 1), (10, 2), (12, 212), (20, 1), (20, 2), (35, 208)])
def test_the_lazy_search_finds_the_shortest_way_of_the_whole_graph(count, seed):
    """Discs and squares on six fields of 10 to 35 obstacles: the whole graph's length to 1e-9 m, no polygon way below it, no way only if proved."""
    check(count, seed, 4, whole=True)


@pytest.mark.parametrize("seed", [221, 228])
def test_far_across_a_field_nothing_shorter_is_left(seed):
    """Two fields of 150 obstacles: among all places that a shorter way could pass, the whole graph has none."""
    check(150, seed, 3, whole=False)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(10, 30))
@pytest.mark.parametrize(("count", "robots"), [(10, 6), (25, 5), (60, 3)])
def test_hundreds_of_robots_take_the_shortest_way(count, robots, seed):
    """Twenty fields each of 10, 25 and 60 obstacles, 280 discs and squares: as in the short form."""
    check(count, seed, robots, whole=True)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(226, 234))
@pytest.mark.parametrize("count", [150, 500])
def test_on_large_fields_nothing_shorter_is_left(count, seed):
    """Fields of 150 and 500 obstacles: as far across smaller fields."""
    check(count, seed, 3, whole=False)


def test_the_oracle_knows_the_way_round_one_column():
    """Two tangents and an arc, known in closed form to 1e-12 m."""
    workspace, column = Workspace((0.0, 0.0, 20.0, 15.0)), Circle("c", (10.0, 7.5), 1.0)
    grown = oracle.scene(workspace, [column], Footprint(0.3), margin=0.0)
    a, b, radius = math.hypot(8.0, 0.4), math.hypot(7.0, 0.4), 1.3
    angle = math.acos((a * a + b * b - 15.0**2) / (2 * a * b))
    turn = angle - math.acos(radius / a) - math.acos(radius / b)
    expected = math.sqrt(a * a - radius**2) + math.sqrt(b * b - radius**2) + radius * turn
    assert oracle.tangent_length(grown, 2 + 7.1j, 17 + 7.1j) == pytest.approx(expected, abs=1e-12)


def test_the_oracle_knows_the_way_round_a_wall():
    """Round the two corners of a wall's end: two tangents, two quarter turns less the tangents' slope, and the wall's width."""
    workspace, wall = Workspace((0.0, 0.0, 20.0, 15.0)), rectangle("w", (9.0, 0.0, 11.0, 9.0))
    grown = oracle.scene(workspace, [wall], Footprint(0.4), margin=0.0)
    far = math.hypot(7.0, 6.0)
    turn = math.pi / 2 - (math.atan2(7.0, 6.0) - math.asin(0.4 / far))
    expected = 2 * math.sqrt(far**2 - 0.4**2) + 2 * 0.4 * turn + 2.0
    assert oracle.tangent_length(grown, 2 + 3j, 18 + 3j) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(("width", "is_open"), [(0.8 + 1e-5, True), (0.8 - 1e-5, False)])
def test_the_oracle_knows_how_wide_a_gap_must_be(width, is_open):
    """A wall from edge to edge with a gap of twice the reach: 10 micrometres more let through, 10 less do not."""
    walls = [rectangle("low", (9.0, 0.0, 11.0, 9.0)), rectangle("high", (9.0, 9.0 + width, 11.0, 15.0))]
    grown = oracle.scene(Workspace((0.0, 0.0, 20.0, 15.0)), walls, Footprint(0.4))
    assert (oracle.tangent_length(grown, 2 + 3j, 18 + 3j) < math.inf) == is_open
    assert oracle.separated(grown, 2 + 3j, 18 + 3j) != is_open


def test_distances_of_arcs_from_segments_are_those_of_their_points():
    """300 random arcs and segments: 4,000 points of the arc come as near as the closed form says, and never nearer."""
    rng = np.random.default_rng(5)
    for _ in range(300):
        center, radius = complex(*rng.uniform(-1, 1, 2)), float(rng.uniform(0.05, 1.5))
        begin, turn = rng.uniform(-4, 4, 1), rng.uniform(0.0, 6.2, 1)
        edges = rng.uniform(-2, 2, (3, 2)) + 1j * rng.uniform(-2, 2, (3, 2))
        edges[2, 1] = edges[2, 0]  # a point
        exact = oracle._arc_distances(center, radius, begin, turn, edges)[0]
        points = center + radius * np.exp(1j * (begin + np.linspace(0.0, turn, 4000).ravel()))
        at = shapely.points(points.real, points.imag)
        for edge, distance in zip(edges, exact, strict=True):
            line = shapely.LineString([(place.real, place.imag) for place in edge])
            sampled = shapely.distance(line, at).min()
            assert distance - 1e-12 <= sampled <= distance + radius * turn[0] / 3999


def test_squares_sum_up_as_places_where_they_would_touch():
    """A fixed square against an L: a place is nearer to the sum than 0 exactly if the square there meets the L."""
    letter = Polygon("l", np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)], float))
    square = fields.square(0.6)
    core = oracle.scene(Workspace((-9.0, -9.0, 9.0, 9.0)), [letter], square, margin=0.0).cores[0]
    body, shape = shapely.Polygon(square.vertices), shapely.Polygon(letter.vertices)
    for x, y in np.random.default_rng(3).uniform(-1, 4, (400, 2)):
        there = shapely.affinity.translate(body, x, y)
        assert shapely.distance(core, shapely.Point(x, y)) == pytest.approx(shapely.distance(shape, there), abs=1e-12)
