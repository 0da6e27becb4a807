"""Pictures of robots that are no discs."""

import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.patches import Circle as Disc

from coord.geometry.shapes import grown_outlines, hull_outlines
from coord.model.footprint import Footprint, polygon, square
from coord.model.obstacle import Circle, Polygon, rectangle
from coord.model.path import Path, straight
from coord.model.result import Plan
from coord.output.plots import KINDS, draw, floor, workspace
from coord.output.plots.footprints import drawn, extents, posed, swept, words
from coord.output.plots.forbidden import windows
from coord.output.plots.outlines import line

TRUCK = polygon([(-0.3, -0.2), (0.9, -0.2), (0.9, 0.2), (-0.3, 0.2)])


def area(ring: np.ndarray) -> float:
    """Area of a ring, by the shoelace formula; positive counter-clockwise."""
    x, y = ring.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2


def shaped(plan: Plan, *footprints: Footprint) -> Plan:
    """The plan, its robots of these shapes."""
    parts = tuple(
        replace(part, robot=replace(part.robot, footprint=shape))
        for part, shape in zip(plan.robots, footprints, strict=True)
    )
    problem = replace(plan.problem, robots=tuple(part.robot for part in parts))
    return replace(plan, problem=problem, robots=parts)


@pytest.mark.parametrize("kind", KINDS)
def test_squares_and_polygons_that_turn_can_be_drawn(sample: Plan, kind: str):
    """Any mixture of shapes gives a picture, the same bytes each time."""
    plan = shaped(sample, square(0.6), TRUCK, Footprint(0.3))
    assert draw(plan, kind) == draw(plan, kind)


def test_a_footprint_that_keeps_its_heading_is_drawn_as_it_is_given():
    """Wherever it stands and however the path runs there."""
    ring = drawn(square(0.6), (2.0, 3.0), 0.7).get_path().vertices
    assert ring[:4].tolist() == pytest.approx(np.array([(1.7, 2.7), (2.3, 2.7), (2.3, 3.3), (1.7, 3.3)]))


def test_a_footprint_that_turns_lies_along_the_path_at_its_ends(sample: Plan):
    """A path that ends upwards has its goal drawn upwards, its start to the right."""
    path = Path((1.0, 1.0, 0.0), [(2.0, 0.0, 0.0), (math.pi / 2, 1.0, 1.0)])
    first, last = posed(TRUCK, path.pose([0.0, path.length]))
    assert first.tolist() == pytest.approx(np.add(TRUCK.vertices, 1.0))
    ahead = last - path.end
    assert ahead[:, 1].max() == pytest.approx(0.9)
    assert np.abs(ahead[:, 0]).max() == pytest.approx(0.2)
    red = replace(sample.robots[0], path=path)
    plan = shaped(replace(sample, robots=(red, *sample.robots[1:])), TRUCK, TRUCK, TRUCK)
    goals = workspace(plan).axes[0].collections[-1].get_paths()
    assert goals[0].vertices[:4].tolist() == pytest.approx(ahead + red.robot.goal)


def test_a_problem_without_a_plan_shows_shapes_turned_towards_their_goals(sample: Plan):
    """Before there is a path, the straight line to the goal says which way a robot heads."""
    plan = shaped(sample, TRUCK, TRUCK, TRUCK)
    starts = floor(plan.problem).axes[0].collections[-3].get_paths()
    blue = plan.problem.robots[1]
    assert starts[1].vertices[:4].tolist() == pytest.approx(posed(TRUCK, np.array([(*blue.start, math.pi / 2)]))[0])


def test_a_disc_is_a_disc_whichever_way_it_heads():
    """Nothing about a disc turns."""
    patch = drawn(Footprint(0.3, heading="path"), (1.0, 2.0), 0.4)
    assert isinstance(patch, Disc)
    assert (patch.center, patch.radius) == ((1.0, 2.0), 0.3)


def test_the_floor_that_a_fixed_square_sweeps_on_a_line_is_their_sum():
    """Area of the square, and its width across the line times the length: exact."""
    path = straight((1.0, 1.0), (4.0, 5.0))
    (ring,) = hull_outlines(posed(square(0.6), line(path)))
    assert abs(area(ring)) == pytest.approx(0.36 + 5.0 * 0.6 * (0.6 + 0.8))
    (ring,) = hull_outlines(posed(square(0.6, "path"), line(path)))
    assert abs(area(ring)) == pytest.approx((5.0 + 0.6) * 0.6)


def test_the_floor_swept_holds_every_pose_on_the_way():
    """Between the poses that are drawn, too, up to a hair of the corner's own arc."""
    path = Path((0.0, 0.0, 0.3), [(1.0, 0.0, 0.0), (2.0, 0.8, 0.8), (1.0, -0.5, -0.5)])
    outline = swept(path, TRUCK)
    for ring in posed(TRUCK, path.pose(np.linspace(0.0, path.length, 500))):
        inner = ring.mean(axis=0) + 0.995 * (ring - ring.mean(axis=0))
        assert outline.contains_points(inner).all()


def test_the_floor_swept_in_a_ring_has_a_hole():
    """What lies inside a full circle is not swept, and not filled: its ring runs the other way round."""
    path = Path((0.0, 0.0, 0.0), [(2 * math.pi * 2.0, 0.5, 0.5)])
    rings = hull_outlines(posed(square(0.4, "path"), line(path)))
    assert len(rings) == 2
    assert area(rings[0]) * area(rings[1]) < 0


def test_obstacles_are_grown_by_the_square_itself_and_the_clearance_round_it():
    """A wall grows by half the side to each side, corners round with the clearance alone; a column by the square."""
    (ring,) = grown_outlines([rectangle("wall", (0.0, 0.0, 2.0, 1.0))], square(0.6).core, 0.1)
    assert (*ring.min(axis=0), *ring.max(axis=0)) == pytest.approx((-0.4, -0.4, 2.4, 1.4))
    assert abs(area(ring)) == pytest.approx(2.6 * 1.6 + 2 * 0.1 * (2.6 + 1.6) + math.pi * 0.01, abs=1e-4)
    (ring,) = grown_outlines([Circle("column", (0.0, 0.0), 1.0)], square(0.6).core, 0.1)
    assert abs(area(ring)) == pytest.approx(0.36 + 4 * 0.6 * 1.1 + math.pi * 1.21, rel=2e-3)


def test_obstacles_that_grow_together_have_one_outline_and_rooms_keep_theirs():
    """Two walls 0.5 m apart are one for a square of 0.6 m; a room of 2 m keeps an inner ring of 1.2 m."""
    walls = [rectangle("a", (0.0, 0.0, 1.0, 1.0)), rectangle("b", (1.5, 0.0, 2.5, 1.0))]
    assert len(grown_outlines(walls, square(0.6).core, 0.1)) == 1
    assert len(grown_outlines(walls, square(0.2).core, 0.1)) == 2
    room = Polygon("room", [(0, 0), (4, 0), (4, 4), (0, 4)], ([(1, 1), (1, 3), (3, 3), (3, 1)],))
    outer, inner = sorted(grown_outlines([room], square(0.6).core, 0.1), key=lambda ring: -abs(area(ring)))
    assert abs(area(inner)) == pytest.approx(1.2 * 1.2)
    assert area(outer) * area(inner) < 0


def test_what_keeps_a_centre_away_is_said_in_words():
    """Shapes as they count in planning: what turns counts as its circumscribed disc."""
    assert words(Footprint(0.3)) == "radius 0.3 m"
    assert words(square(0.6)) == "square of 0.6 m"
    assert words(square(0.6, "path")) == "radius 0.424 m, as it turns,"
    assert words(replace(TRUCK, heading="fixed")) == "polygon of 1.2 x 0.4 m"
    assert extents(replace(TRUCK, heading="fixed")) == pytest.approx((0.3, 0.2, 0.9, 0.2))
    assert extents(TRUCK) == pytest.approx((TRUCK.radius,) * 4)


def test_a_window_of_two_fixed_squares_is_where_the_squares_are_too_close(sample: Plan):
    """Blue crosses red's line at right angles at s = 3 m: a square of 0.6 m and one of 0.4 m, clearance 0.05 m."""
    plan = shaped(sample, square(0.6), square(0.4), Footprint(0.3))
    (window,) = windows(plan, plan.robots[1], 20.0)
    rows = np.nonzero(window.gap < 0)[0]
    assert window.s[rows].min() == pytest.approx(3.0 - 0.55, abs=0.02)
    assert window.s[rows].max() == pytest.approx(3.0 + 0.55, abs=0.02)
    assert window.gap.min() == pytest.approx(-0.55, abs=0.02)


def test_a_window_of_a_square_that_turns_is_that_of_its_disc(sample: Plan):
    """Planning keeps the circumscribed discs apart, and so says the picture."""
    plan = shaped(sample, square(0.6, "path"), Footprint(0.2), Footprint(0.3))
    (window,) = windows(plan, plan.robots[1], 20.0)
    rows = np.nonzero(window.gap < 0)[0]
    assert window.s[rows].max() == pytest.approx(3.0 + 0.3 * math.sqrt(2) + 0.25, abs=0.02)
