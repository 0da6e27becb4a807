import io
import subprocess
import sys
from dataclasses import replace
from pathlib import Path as File

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from coord.errors import InvalidValueError
from coord.model.path import Path, straight
from coord.model.result import Plan
from coord.output.plots import KINDS, draw, profiles, st, workspace
from coord.output.plots.forbidden import windows
from coord.output.plots.outlines import band, distance_field, line


@pytest.fixture(autouse=True)
def _no_settings_leak():
    """A picture leaves the settings of matplotlib as they were."""
    before = dict(mpl.rcParams)
    yield
    assert dict(mpl.rcParams) == before


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_plan_gives_the_same_bytes(sample: Plan, kind: str):
    """Whatever the user's own settings are, and without a date or a version in the file."""
    first = draw(sample, kind)
    with mpl.rc_context({"font.size": 20, "savefig.dpi": 50, "axes.facecolor": "red"}):
        assert draw(sample, kind) == first
    image = Image.open(io.BytesIO(first))
    assert set(image.info) <= {"dpi"}
    assert min(image.size) > 300


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_that_stays_and_a_long_narrow_floor_can_be_drawn(parked: Plan, many: Plan, kind: str):
    """No path, no motion, no pair, or hardly any height: a picture all the same, without a warning."""
    assert draw(parked, kind)
    floor = replace(many.problem.workspace, bounds=(0.0, 0.0, 400.0, 8.0))
    assert draw(replace(many, problem=replace(many.problem, workspace=floor)), kind)


@pytest.mark.parametrize("kind", KINDS)
def test_names_with_odd_letters_can_be_drawn(many: Plan, kind: str):
    """Mathematics, hidden labels, line breaks, letters that the font has not: all are only letters."""
    odd = ["a$b$c$", "_hidden", "two\nlines", "机器人", "x" * 200, "\\alpha^{", "%s", "<b>"]
    robots = [replace(part.robot, name=name) for part, name in zip(many.robots, odd, strict=False)]
    parts = tuple(replace(part, robot=robot) for part, robot in zip(many.robots, robots, strict=False))
    problem = replace(many.problem, robots=tuple(robots), name="$x_$ _")
    assert draw(replace(many, problem=problem, robots=parts, order=tuple(odd)), kind)


def test_drawing_into_given_axes_gives_their_figure(sample: Plan):
    """Pictures can be put together to larger ones."""
    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert workspace(sample, ax=left) is figure
    assert st(sample, ax=right) is figure
    assert left.get_xlabel() == "x [m]"
    assert right.get_xlabel() == "time [s]"


def test_a_robot_that_is_not_there_is_an_error_with_the_names_that_are(sample: Plan):
    """The remedy stands in the sentence."""
    for kind in KINDS:
        with pytest.raises(InvalidValueError, match='no robot is named "ghost"; the plan has red, blue'):
            draw(sample, kind, "ghost")
    with pytest.raises(InvalidValueError, match='no picture "floor"; there are workspace, profiles, st'):
        draw(sample, "floor")


def test_the_diagram_shows_the_most_delayed_robot_unless_asked_otherwise(sample: Plan):
    """Blue waits 4.5 s, the others nothing."""
    assert (
        "How blue, the most delayed robot," in st(sample).axes[0].get_title(loc="left") + st(sample).axes[0].get_title()
    )
    chosen = st(sample, "red").axes[0]
    assert "How red drives along its path" in chosen.get_title(loc="left") + chosen.get_title()


def test_more_than_twelve_robots_are_a_selection_and_the_title_says_which(many: Plan):
    """Of 15 robots the 7 delayed ones are shown, three axes each."""
    figure = profiles(many)
    assert len(figure.axes) == 21
    assert "(the 7 delayed robots; 15 robots in all;" in figure.get_suptitle()
    assert len(profiles(many, "agv-3").axes) == 3
    late = tuple(replace(part, solo_arrival=part.arrival - 1.0) for part in many.robots)
    assert "the first 12 of 15 delayed robots; 15" in profiles(replace(many, robots=late)).get_suptitle()
    on_time = tuple(replace(part, solo_arrival=part.arrival) for part in many.robots)
    figure = profiles(replace(many, robots=on_time))
    assert len(figure.axes) == 36
    assert "the first 12 of 15 robots; nobody is delayed" in figure.get_suptitle()


def test_a_window_is_where_two_robots_are_too_close_and_nowhere_else(sample: Plan):
    """Blue crosses red's line at right angles at s = 3 m, red is there after 4 m: an ellipse about that moment."""
    red, blue = sample.robots[:2]
    (window,) = windows(sample, blue, 20.0)
    assert window.robot is red
    times = np.linspace(0.0, 20.0, 20001)
    there = float(times[np.argmin(np.abs(red.profile.state(times)[:, 0] - 4.0))])
    rows, columns = np.nonzero(window.gap < 0)
    assert window.s[rows].min() == pytest.approx(3.0 - 0.65, abs=0.02)
    assert window.s[rows].max() == pytest.approx(3.0 + 0.65, abs=0.02)
    assert window.t[columns].min() < there < window.t[columns].max()
    assert window.gap.min() == pytest.approx(-0.65, abs=0.02)


def test_robots_that_leave_forbid_nothing_after_their_arrival(sample: Plan):
    """Parked across blue's path red is in the way for ever; with "leave" only until it has arrived."""
    red = sample.robots[0]
    path = straight((1.0, 4.0), (5.0, 4.0))
    parts = (replace(red, path=path, profile=replace(red.profile, states=red.profile.states * 0.4)), *sample.robots[1:])
    floor = sample.problem.workspace
    for rule, last in (("stay", 60.0), ("leave", 20.0)):
        problem = replace(sample.problem, workspace=replace(floor, after_arrival=rule))
        (window,) = windows(replace(sample, problem=problem, robots=parts), parts[1], 60.0)
        assert window.t[np.nonzero(window.gap < 0)[1]].max() == pytest.approx(last)


def test_the_band_of_a_straight_path_has_the_area_of_a_stadium():
    """2 r L + pi r^2, up to the corners of the drawn half circles."""
    ring = band(straight((1.0, 2.0), (4.0, 6.0)), 0.5)
    x, y = ring.T
    area = 0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))
    assert area == pytest.approx(5.0 + np.pi * 0.25, rel=2e-3)


def test_the_line_of_a_path_bends_so_little_at_a_time_that_it_looks_round():
    """From point to point it turns by 0.06 rad at most, and it ends where the path does."""
    path = Path((0.0, 0.0, 0.0), [(2.0, 0.0, 1.0), (3.0, 1.0, 1.0), (1.0, 0.0, 0.0)])
    poses = line(path)
    assert np.diff(poses[:, 2]).max() <= 0.06
    assert poses[-1, :2] == pytest.approx(path.end)


def test_the_reach_of_obstacles_is_their_distance(sample: Plan):
    """Right wherever it is below the reach, for circles, polygons and inside of rooms."""
    field = distance_field(sample.problem.obstacles, (0.0, 0.0, 12.0, 8.0), 0.35)
    row, column = int(np.searchsorted(field.y, 6.0)), int(np.searchsorted(field.x, 2.9))
    assert field.distance[row, column] == pytest.approx(np.hypot(field.x[column] - 2, field.y[row] - 6) - 0.7)
    row, column = int(np.searchsorted(field.y, 6.0)), int(np.searchsorted(field.x, 6.7))
    assert field.distance[row, column] == pytest.approx(field.x[column] - 6.5)


def test_drawing_needs_no_global_state_of_matplotlib(tmp_path: File):
    """pyplot keeps figures and opens windows; nothing of coord loads it."""
    code = "import sys, coord.output.plots; sys.exit('matplotlib.pyplot' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path)
