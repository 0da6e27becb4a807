"""What paths must not depend on: which way the world is turned, mirrored or measured; and what may only lengthen them."""

from __future__ import annotations

import importlib.util
import math
import sys
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely

from coord.errors import NoPlanError
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits
from coord.paths.routes import find_routes
from coord.paths.skeleton import NoWay, skeleton
from coord.tolerances import PLANNING_MARGIN

FIELDS = Path(__file__).resolve().parents[2] / "analysis" / "fields.py"
if not FIELDS.is_file():
    pytest.skip("the random fields live in analysis/, which is not here", allow_module_level=True)
_SPEC = importlib.util.spec_from_file_location("coord_analysis_fields_for_properties", FIELDS)
fields = importlib.util.module_from_spec(_SPEC)
sys.modules[_SPEC.name] = fields
_SPEC.loader.exec_module(fields)

WIDE = 100.0


@dataclass(frozen=True)
class Change:
    """Mirror at the x axis, scale, turn, and move the world."""

    mirror: bool = False
    scale: float = 1.0
    turn: float = 0.0
    shift: complex = 0j

    def __call__(self, place):
        at = complex(*place)
        at = (at.conjugate() if self.mirror else at) * self.scale * complex(math.cos(self.turn), math.sin(self.turn))
        return (at + self.shift).real, (at + self.shift).imag

    def field(self, field):
        """The same field, changed; the edge stays a box about it, far away."""
        obstacles = tuple(
            Circle(one.name, self(one.center), self.scale * one.radius)
            if isinstance(one, Circle)
            else Polygon(one.name, np.array([self(vertex) for vertex in one.vertices]))
            for one in field.obstacles
        )
        (x, y), reach = self((0.0, 0.0)), self.scale * WIDE
        workspace = Workspace((x - reach, y - reach, x + reach, y + reach), self.scale * field.workspace.clearance)
        return fields.Field(workspace, obstacles)

    def robot(self, robot):
        """The same robot, as fast in its own measure."""
        limits = Limits(*(self.scale * getattr(robot.limits, name) for name in Limits.__slots__))
        footprint = Footprint(self.scale * robot.footprint.radius)
        return replace(robot, footprint=footprint, limits=limits, start=self(robot.start), goal=self(robot.goal))


SAME = Change()
MOTIONS = {
    "mirrored": Change(mirror=True),
    "moved": Change(shift=complex(1234.5, -876.25)),
    "turned": Change(turn=2.5),
    "turned far": Change(turn=40.3, shift=complex(-31.0, 17.5)),
    "mirrored and turned": Change(mirror=True, turn=-1.1),
}


def world(count, seed, number):
    """A field without a near edge, and a robot on it."""
    field, rng = fields.random_field(count, seed), np.random.default_rng((seed, count, number))
    robot = fields.random_robot(field, "robot", rng)
    return SAME.field(field), robot


WORLDS = [
    (8, 1, 0),
    (8, 2, 0),
    (8, 3, 1),
    (20, 1, 0),
    (20, 2, 0),
    (20, 3, 0),
    (40, 1, 0),
    (40, 2, 0),
    (40, 3, 0),
    (40, 4, 0),
]


def bones(field, robot):
    """The skeleton, or None where there is no way."""
    found = skeleton(fields.floor_of(field, robot), robot.start, robot.goal)
    return None if isinstance(found, NoWay) else found


def length(field, robot):
    found = bones(field, robot)
    return math.inf if found is None else found.length


def route(field, robot, shape="fitted"):
    """The route, or None where there is no way."""
    try:
        (found,) = find_routes(Problem("p", field.workspace, (robot,), field.obstacles), shape)
    except NoPlanError:
        return None
    return found


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("at", WORLDS)
def test_the_shortest_way_moves_with_the_world(at, motion):
    """Mirrored, moved and turned: the same length to 1e-9 of it."""
    change, (field, robot) = MOTIONS[motion], world(*at)
    expected = length(field, robot)
    assert length(change.field(field), change.robot(robot)) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("at", WORLDS)
def test_there_and_back_are_equally_long(at):
    """Start and goal exchanged: the same length to 1e-9 of it."""
    field, robot = world(*at)
    back = replace(robot, start=robot.goal, goal=robot.start)
    assert length(field, back) == pytest.approx(length(field, robot), rel=1e-9)


@pytest.mark.parametrize("scale", [0.3, 7.0])
@pytest.mark.parametrize("at", WORLDS)
def test_the_shortest_way_grows_with_the_world(at, scale):
    """All lengths times k: the length times k, but for the planning margin, which does not grow and acts by the turns' angles."""
    change, (field, robot) = Change(scale=scale), world(*at)
    found, other = bones(field, robot), bones(change.field(field), change.robot(robot))
    assert (found is None) == (other is None)
    if found is not None:
        extra = PLANNING_MARGIN * (1 - 1 / scale) * sum(turn.angle for turn in found.turns)
        assert other.length / scale == pytest.approx(found.length - extra, rel=1e-9)


HEAVY = pytest.mark.long
CASES = [
    pytest.param(at, shape, motion, marks=() if k == 0 and (shape in ("fitted", "taut") or n in (0, 3)) else HEAVY)
    for k, at in enumerate(WORLDS[1::3])
    for shape in ("fitted", "taut", "exponential", "follow")
    for n, motion in enumerate(MOTIONS)
]


@pytest.mark.parametrize(("at", "shape", "motion"), CASES)
def test_paths_move_with_the_world(at, shape, motion):
    """Mirrored, moved and turned: the same path, mirrored, moved and turned; left and right exchanged by mirrors only."""
    change, (field, robot) = MOTIONS[motion], world(*at)
    found, other = route(field, robot, shape), route(change.field(field), change.robot(robot), shape)
    assert (found is None) == (other is None)
    if found is None:
        return
    assert other.path.length == pytest.approx(found.path.length, rel=1e-9)
    assert other.time == pytest.approx(found.time, rel=1e-6)
    assert other.shape == found.shape
    swapped = {"left": "right", "right": "left"} if change.mirror else {}
    assert other.side == swapped.get(found.side, found.side)
    share = np.linspace(0.0, 1.0, 60)
    expected = [change(place) for place in found.path.point(share * found.path.length)]
    assert np.abs(other.path.point(share * other.path.length) - expected).max() < 1e-6
    assert {way.side: way.path is None for way in other.ways} == {
        swapped.get(way.side, way.side): way.path is None for way in found.ways
    }


@pytest.mark.parametrize("scale", [0.5, 4.0])
@pytest.mark.parametrize("at", WORLDS[1:6:3])
def test_in_a_larger_world_for_larger_robots_the_same_path_takes_the_same_time(at, scale):
    """All lengths and limits times k: the path times k, but for a few times the planning margin, in the same time."""
    change, (field, robot) = Change(scale=scale), world(*at)
    found, other = route(field, robot), route(change.field(field), change.robot(robot))
    assert (found is None) == (other is None)
    if found is not None:
        assert other.side == found.side
        assert other.time == pytest.approx(found.time, rel=1e-5)
        assert other.path.length / scale == pytest.approx(found.path.length, abs=2e-5)


@pytest.mark.parametrize("at", WORLDS)
def test_another_obstacle_never_shortens_the_way(at):
    """Obstacle by obstacle the floor fills, and the length never falls, until there may be no way."""
    field, robot = world(*at)
    lengths = [
        length(fields.Field(field.workspace, field.obstacles[:count]), robot)
        for count in range(0, len(field.obstacles) + 1, max(1, len(field.obstacles) // 10))
    ]
    assert lengths[0] == pytest.approx(math.dist(robot.start, robot.goal), rel=1e-12)
    assert all(later >= earlier - 1e-9 for earlier, later in pairwise(lengths))


@pytest.mark.parametrize("at", WORLDS)
def test_a_larger_robot_never_has_a_shorter_way(at):
    """From a tenth of its radius to all of it, the length never falls, until there may be no way."""
    field, robot = world(*at)
    sizes = [
        replace(robot, footprint=Footprint(share * robot.footprint.radius)) for share in (0.1, 0.3, 0.5, 0.7, 0.9, 1.0)
    ]
    lengths = [length(field, one) for one in sizes]
    assert all(later >= earlier - 1e-9 for earlier, later in pairwise(lengths))


@pytest.mark.parametrize("shape", ["fitted", "taut", "exponential", "follow"])
def test_a_free_straight_line_is_kept(shape):
    """Wherever the straight line keeps the distance by 2 micrometres, the path is that line and nothing else."""
    kept = 0
    for number in range(12):
        field, robot = world(8, 5, number)
        line = shapely.LineString([robot.start, robot.goal])
        reach = robot.footprint.radius + field.workspace.clearance + 2 * PLANNING_MARGIN
        free = all(
            shapely.distance(line, shapely.Point(one.center)) - one.radius >= reach
            if isinstance(one, Circle)
            else shapely.distance(line, shapely.Polygon(one.vertices)) >= reach
            for one in field.obstacles
        )
        if free:
            found = route(field, robot, shape)
            assert found.path.pieces.tolist() == [[pytest.approx(math.dist(robot.start, robot.goal)), 0.0, 0.0]]
            assert (found.shape, found.side) == ("straight", "")
            kept += 1
    assert kept >= 2
