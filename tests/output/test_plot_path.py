"""The picture of one robot's path: everything that decided it is there, and the numbers are right."""

from __future__ import annotations

import io
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

from coord.alone.fastest import fastest
from coord.errors import InvalidValueError
from coord.geometry.growth import grow
from coord.model.obstacle import Circle
from coord.model.path import Path, straight
from coord.model.result import Plan
from coord.model.route import Route, Way
from coord.output.plots.path import draw_path, path, table, turn_ends
from coord.paths.exponential import exponential
from coord.paths.follow import follow
from coord.paths.skeleton import search_floor, skeleton


@pytest.fixture
def scene(sample: Plan) -> tuple[Plan, Route]:
    """Red's line is blocked by a column; the exponential detour passes it on the left, the edge on the right."""
    red = sample.robots[0]
    obstacles = (Circle("column", (6.0, 3.9), 0.8),)
    problem = replace(sample.problem, obstacles=obstacles)
    grown = grow(obstacles, red.robot.footprint, 0.05, problem.workspace.bounds)
    start, goal = red.robot.start, red.robot.goal
    floor = search_floor(grown, [start, goal])
    bones = skeleton(floor, start, goal)
    shaped = exponential(bones, red.robot.limits, floor)
    other = follow(floor, start, goal, red.robot.limits, "right")
    alone = fastest(shaped.path, red.robot.limits)
    ways = (
        Way("left", shaped.path.length, alone.arrival, shaped.path),
        Way("right", other.path.length, 19.25, other.path),
        Way("under", None, None, reason="a wall closes it"),
        Way("over", 30.0, 32.5, is_bound=True),
    )
    parts = (replace(red, path=shaped.path), *sample.robots[1:])
    route = Route(
        shaped.path, alone, "exponential", "left", bones.length, ways, shaped.fits, ("A remark, to be read.",)
    )
    return replace(sample, problem=problem, robots=parts), route


def told(plan: Plan, route: Route) -> tuple[list[str], str]:
    """The legend's lines and the words below it."""
    axes = path(plan, "red", route).axes[2]
    legend = axes.get_legend()
    return [text.get_text() for text in legend.get_texts()], axes.texts[0].get_text()


def test_the_same_plan_and_route_give_the_same_bytes(scene):
    """Whatever the user's own settings are."""
    before = dict(mpl.rcParams)
    first = draw_path(scene[0], "red", scene[1])
    with mpl.rc_context({"font.size": 20, "savefig.dpi": 50}):
        assert draw_path(scene[0], "red", scene[1]) == first
    assert dict(mpl.rcParams) == before
    assert min(Image.open(io.BytesIO(first)).size) > 300


def test_the_picture_names_all_that_decided_the_path(scene):
    """The line, the other side, the turns, the fitted points; fits with their numbers, closed sides, remarks."""
    legend, words = told(*scene)
    assert "straight line from start to goal" in legend
    assert "other ways" in legend
    assert "a turn begins or ends" in legend
    assert "hull points: rise and fall are fitted to them" in legend
    for fit in scene[1].fits:
        assert f"{fit.flank}  y = {fit.A:.3g} exp({fit.B:+.3g} x)   R² {fit.r_squared:.3f}" in words
    assert "under: a wall closes it" in words
    assert "A remark, to be read." in words


def test_the_table_says_length_and_time_of_each_way(scene):
    """The chosen path first, then the others or what they take at least, then what no path can beat, then the line."""
    _, route = scene
    rows = table(route, route.ways[1:], ((1.0, 4.0), (11.0, 4.0)))
    assert rows[1].split() == ["this", "path", "(left)", f"{route.path.length:.2f}", "m", f"{route.time:.2f}", "s"]
    assert rows[2].split() == ["the", "other", "(right)", f"{route.ways[1].path.length:.2f}", "m", "19.25", "s"]
    assert rows[3].split() == ["over,", "at", "least", "30.00", "m", "32.50", "s"]
    assert rows[4].split()[-2:] == [f"{route.least_length:.2f}", "m"]
    assert rows[5].split()[-2:] == ["10.00", "m"]


def test_hull_points_lie_on_the_hull_and_not_below_the_offset(scene):
    """Every point drawn is at least radius and clearance from the column, and between the line and its offset's top."""
    figure = path(scene[0], "red", scene[1])
    dots = [mark.get_xydata() for mark in figure.axes[0].lines if mark.get_marker() == "."]
    assert len(dots) == 2
    places = np.concatenate(dots)
    assert np.hypot(*(places - (6.0, 3.9)).T).min() > 0.8 + 0.3 + 0.05
    assert places[:, 1].min() > 4.0
    assert places[:, 1].max() < 3.9 + 0.8 + 0.3 + 0.05


def test_turns_are_marked_where_they_begin_and_end():
    """A left turn of two clothoids and an arc, a line, and a right turn: four marks."""
    way = Path(
        (0.0, 0.0, 0.0),
        [(1.0, 0.0, 0.0), (1.0, 0.0, 0.5), (0.5, 0.5, 0.5), (1.0, 0.5, 0.0), (2.0, 0.0, 0.0), (1.0, -0.2, -0.2)],
    )
    assert turn_ends(way).tolist() == pytest.approx([1.0, 3.5, 5.5, 6.5])
    assert len(turn_ends(straight((0.0, 0.0), (1.0, 0.0)))) == 0


def test_a_straight_path_and_a_robot_that_stays_can_be_drawn(sample: Plan, parked: Plan):
    """No turns, no other side, no length: a picture all the same, without a warning."""
    red = sample.robots[0]
    assert draw_path(sample, "red", Route(red.path, red.profile, "straight", "", red.path.length))
    still = parked.robots[0]
    assert draw_path(parked, "still", Route(still.path, still.profile, "straight", "", 0.0))


def test_a_robot_that_is_not_there_is_an_error_with_the_names_that_are(scene):
    """The remedy stands in the sentence."""
    with pytest.raises(InvalidValueError, match='no robot is named "ghost"; the plan has red, blue'):
        draw_path(scene[0], "ghost", scene[1])
