"""Out of the way first: where others pass a robot's start, it waits beside their lanes and arrives after all."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from coord.coordination.aside import joined_up
from coord.coordination.kept import kept
from coord.model.footprint import Footprint, square
from coord.model.obstacle import rectangle
from coord.model.options import Options
from coord.model.path import Path, straight
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.output.plan_file import parse
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
FLOOR = Workspace((-12.0, -12.0, 12.0, 12.0), 0.05)
DISC = Footprint(0.3)
WALLS = tuple(rectangle(f"wall {k}", (-12.0, y, 12.0, y + 0.2)) for k, y in enumerate((-0.8, 0.6)))


def extended(robots, new, obstacles=(), options=None):
    """The plan of some robots, and what comes of one more."""
    before = plan(Problem("scene", FLOOR, tuple(robots), obstacles), options)
    assert before.certified
    problem = Problem("scene", FLOOR, (*robots, new), obstacles)
    return before, plan(problem, options, extend=kept(problem, parse(before.document)))


@pytest.mark.parametrize("shape", [DISC, square(0.5)], ids=["disc", "square"])
def test_head_on_with_somebody_who_passes_its_start_it_goes_aside(shape):
    """It cannot be ahead of the van, which it would have to back away from; aside it lets it pass, and both arrive."""
    van = Robot("van", shape, LIMITS, (-9.0, 0.0), (9.0, 0.0))
    new = Robot("new", shape, LIMITS, (3.0, 0.1), (-6.0, 0.1))
    before, after = extended([van], new)
    assert after.certified, after.diagnoses
    assert json.loads(after.document)["robots"][0] == json.loads(before.document)["robots"][0]
    (told,) = after.plan.rerouted
    assert told.robot == "new"
    assert told.text.startswith('"new" first goes aside for "van", which passes its start at ')
    assert told.extra_length > 0


def test_two_who_pass_its_start_are_both_let_by():
    """One from behind and one head-on, on lanes that cross at its start: places beside both."""
    lanes = [
        Robot("van", DISC, LIMITS, (-9.0, -3.0), (9.0, 3.0)),
        Robot("cart", DISC, LIMITS, (11.0, -3.6), (-11.0, 3.6), release=6.0),
    ]
    _, after = extended(lanes, Robot("new", DISC, LIMITS, (0.0, 0.1), (-6.0, -2.0)))
    assert after.certified, after.diagnoses
    (told,) = after.plan.rerouted
    assert '"van", which passes its start' in told.text
    assert '"cart", which passes its start' in told.text


def test_a_place_behind_a_corner_will_do():
    """With a wall on the one side and a rack on the other, it drives round the end of the rack, and lets the van pass."""
    van = Robot("van", DISC, LIMITS, (-9.0, 0.0), (9.0, 0.0))
    floor = rectangle("wall", (-12.0, -0.7, 12.0, -0.5)), rectangle("rack", (2.7, 0.5, 8.0, 0.7))
    _, after = extended([van], Robot("new", DISC, LIMITS, (3.2, 0.0), (-6.0, 0.0)), floor)
    assert after.certified, after.diagnoses
    (told,) = after.plan.rerouted
    assert told.text.startswith('"new" first goes aside for "van"')


@pytest.mark.parametrize("reason", ["lane", "kept", "given"])
def test_with_nowhere_to_go_aside_it_is_told(reason):
    """Between walls, with paths kept or a given path it cannot join, and who passes when is said."""
    van = Robot("van", DISC, LIMITS, (-9.0, 0.0), (9.0, 0.0))
    path = ((3.0, 0.1), (-6.0, 0.1)) if reason == "given" else ()
    new = Robot("new", DISC, LIMITS, (3.0, 0.1), (-6.0, 0.1), path=path)
    obstacles = WALLS if reason == "lane" else ()
    _, after = extended([van], new, obstacles, Options(keep_paths=reason == "kept"))
    (told,) = after.diagnoses
    assert told.code == "cannot-join"
    assert told.robots == ("new", "van")


@pytest.mark.parametrize("angle", [-2.0, -1.0, 0.0, 0.3, 1.5, 2.1])
@pytest.mark.parametrize("bent", [False, True])
def test_two_paths_joined_up_are_smooth_and_end_where_the_second_does(angle, bent):
    """Position and heading go on without a jump, and from where the second path is met they are those of that path."""
    second = Path((1.0, 2.0, 0.4), np.array([[3.0, 0.0, 0.0], [1.0, 0.5, 0.5], [2.0, 0.0, 0.0]]))
    pieces = np.array([[0.5, 0.8, 0.8], [1.2, 0.0, 0.0]] if bent else [[1.2, 0.0, 0.0]])
    drawn = Path((0.0, 0.0, 0.0), pieces)
    turned = 0.4 - angle - float(drawn.poses[-1, 2])
    (x, y), c, s = drawn.end, math.cos(turned), math.sin(turned)
    first = Path((1.0 - c * x + s * y, 2.0 - s * x - c * y, turned), pieces)
    assert first.end == pytest.approx((1.0, 2.0), abs=1e-12)
    found = list(joined_up(first, second))
    assert len(found) == (1 if angle == 0 else 2 if bent else 3)
    for path in found:
        assert path.start[:2] == first.start[:2]
        assert path.end == pytest.approx(second.end, abs=1e-12)
        turn = float(path.poses[-1, 2] - second.poses[-1, 2])
        assert math.remainder(turn, 2 * math.pi) == pytest.approx(0, abs=1e-12)
        back = np.linspace(0.0, 3.5, 20)
        assert path.point(path.length - back) == pytest.approx(second.point(second.length - back), abs=1e-12)
        assert (path.pieces[:, 0] > 0).all()


def test_nothing_is_joined_up_that_would_turn_back():
    """Where a path leads to the place and the next straight back there is none, nor where one of them is a point."""
    there, back = straight((3.0, 2.0), (1.0, 2.0)), straight((1.0, 2.0), (4.0, 2.0))
    assert list(joined_up(there, back)) == []
    assert list(joined_up(straight((1.0, 2.0), (1.0, 2.0)), back)) == []
    assert list(joined_up(there, straight((1.0, 2.0), (1.0, 2.0)))) == []
