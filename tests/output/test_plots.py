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
from coord.model.profile import VelocityProfile
from coord.model.result import Plan, Result
from coord.output.plots import KINDS, draw, draw_failure, floor, profiles, st, workspace
from coord.output.plots.caps import speed_cap
from coord.output.plots.forbidden import Window, matters, passes, windows
from coord.output.plots.giving_way import giving_way
from coord.output.plots.labels import Clutter, Label, place
from coord.output.plots.lanes import side_by_side
from coord.output.plots.outlines import band, line


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


def title(plan: Plan, robot: str | None = None) -> str:
    return str(st(plan, robot).axes[0].get_title(loc="left") + st(plan, robot).axes[0].get_title())


def test_the_diagram_shows_the_most_delayed_robot_unless_asked_otherwise(sample: Plan):
    """Blue waits 4.5 s, the others nothing."""
    assert "How blue, the most delayed robot," in title(sample)
    assert "How red drives along its path" in title(sample, "red")


def test_the_diagram_prefers_a_robot_that_gives_way_on_the_move(sample: Plan):
    """A wait at the start is a flat line; but a delay of almost nothing is not preferred."""
    red, blue, bend = sample.robots
    moving = replace(red, how="splice", solo_arrival=red.arrival - 2.0)
    assert "How red, the most delayed of those that give way" in title(replace(sample, robots=(moving, blue, bend)))
    hardly = replace(red, how="splice", solo_arrival=red.arrival - 0.1)
    assert "How blue, the most delayed robot," in title(replace(sample, robots=(hardly, blue, bend)))


def test_areas_far_from_all_that_a_robot_does_are_grey_and_not_listed(sample: Plan):
    """Red crosses blue's line at 10 s. A blue that leaves at 100 s has nothing to do with it, alone or as planned."""
    blue = sample.robots[1]
    (window,) = windows(sample, blue, 150.0)
    late = blue.profile.shifted(100.0)
    assert matters(window, (blue.profile, late), 150.0)
    assert not matters(window, (late, late), 150.0)
    early = replace(blue.profile, times=blue.profile.times - 100.0)
    assert matters(window, (early, late), 150.0)
    away = replace(blue, profile=late, solo_arrival=blue.arrival + 100.0, robot=replace(blue.robot, release=100.0))
    parts = (sample.robots[0], away, sample.robots[2])
    legend = st(replace(sample, robots=parts), "blue").axes[0].get_legend()
    assert legend is not None
    told = [text.get_text() for text in legend.get_texts()]
    assert not any("red" in line for line in told)
    assert "others, which it never comes near to" in told


def test_more_than_twelve_robots_are_a_selection_and_the_title_says_which(many: Plan):
    """Of 15 robots the 7 delayed ones are shown, three axes each; of more delayed ones the most delayed."""
    figure = profiles(many)
    assert len(figure.axes) == 21
    assert "(the 7 delayed robots of 15 robots, the most delayed first;" in figure.get_suptitle()
    assert len(profiles(many, "agv-3").axes) == 3
    late = [replace(part, solo_arrival=part.arrival - 1.0 - k) for k, part in enumerate(many.robots)]
    figure = profiles(replace(many, robots=tuple(late)))
    assert "the 12 most delayed of 15 robots" in figure.get_suptitle()
    names = [axes.get_title(loc="left").split(":")[0] + axes.get_title().split(":")[0] for axes in figure.axes[::3]]
    assert names == [f"agv-{k}" for k in range(14, 2, -1)]
    on_time = tuple(replace(part, solo_arrival=part.arrival) for part in many.robots)
    figure = profiles(replace(many, robots=on_time))
    assert len(figure.axes) == 36
    assert "the first 12 of 15 robots; nobody is delayed" in figure.get_suptitle()


@pytest.mark.parametrize(("speeds", "shared"), [((1.0, 0.7), True), ((1.0, 0.05), False)])
def test_speeds_share_one_axis_unless_one_would_be_flat(sample: Plan, speeds: tuple[float, float], shared: bool):
    """Panels that look alike mean the same; all have the same ticks of time."""
    parts = []
    for part, speed in zip(sample.robots[:2], speeds, strict=True):
        limits = replace(part.robot.limits, speed=speed)
        profile = replace(part.profile, states=part.profile.states * speed, jerks=part.profile.jerks * speed)
        parts.append(replace(part, robot=replace(part.robot, limits=limits), profile=profile))
    axes = profiles(replace(sample, robots=tuple(parts))).axes[::3]
    assert (axes[0].get_ylim() == axes[1].get_ylim()) is shared
    assert axes[0].get_xticks().tolist() == axes[1].get_xticks().tolist()


def test_the_cap_on_speed_is_exact_however_short_a_bend_is(sample: Plan):
    """A bend of 1 mm caps the speed at sqrt(0.5 / 2) = 0.5 m/s from when the robot enters it to when it leaves it."""
    red = sample.robots[0]
    path = Path((1.0, 4.0, 0.0), [(4.0, 0.0, 0.0), (0.001, 2.0, 2.0), (5.999, 0.0, 0.0)])
    t, cap = speed_cap(replace(red, path=path), 30.0)
    inside = np.nonzero(cap < 1.0)[0]
    assert cap[inside].tolist() == [0.5, 0.5]
    assert red.profile.state(t[inside])[:, 0] == pytest.approx([4.0, 4.001], abs=1e-9)
    assert (t[0], t[-1]) == (0.0, 30.0)
    assert np.all(np.diff(t) >= 0)


def test_the_place_where_a_robot_gives_way_is_where_it_comes_closest(sample: Plan):
    """Blue lets red pass at (5, 4); nobody else is delayed."""
    (mark,) = giving_way(sample)
    assert (mark.robot.robot.name, mark.other.robot.name) == ("blue", "red")
    times = np.linspace(0.0, mark.robot.arrival, 20001)
    red, blue = (part.path.point(part.profile.state(times)[:, 0]) for part in sample.robots[:2])
    closest = int(np.argmin(np.hypot(*(red - blue).T)))
    assert mark.place == pytest.approx(tuple(blue[closest]), abs=0.02)
    assert mark.time == pytest.approx(times[closest], abs=0.02)
    legend = workspace(sample).axes[0].get_legend()
    assert legend is not None
    assert "here blue lets red pass" in [text.get_text() for text in legend.get_texts()]


def test_a_name_takes_the_free_place_and_moves_for_another():
    """Of two names the first likes the place best that the second needs; it ends elsewhere, off the line too."""
    spots = np.array([(50.0, 50.0), (50.0, 80.0), (50.0, 20.0)])
    picky = Label(spots[:1], np.zeros(1), (20.0, 10.0))
    easy = Label(spots, np.array([0.0, 1.0, 2.0]), (20.0, 10.0))
    clutter = Clutter((0.0, 0.0, 100.0, 100.0), np.empty((0, 4)), np.array([(0.0, 80.0, 100.0, 80.0, 5.0)]))
    assert place([easy, picky], clutter) == [2, 0]
    disc = np.array([(50.0, 20.0, 5.0, 100.0)])
    assert place([easy, picky], clutter._replace(discs=disc)) == [1, 0]
    assert place([easy, picky], clutter._replace(frame=(0.0, 40.0, 100.0, 100.0))) == [1, 0]


def test_many_places_where_robots_give_way_are_marked_but_not_told(many: Plan):
    """Nine lines of legend would be too many; one says what the mark means."""
    late = tuple(replace(part, solo_arrival=part.arrival - 1.0, after=("agv-0",)) for part in many.robots[1:])
    legend = workspace(replace(many, robots=(many.robots[0], *late))).axes[0].get_legend()
    assert legend is not None
    told = [text.get_text() for text in legend.get_texts() if text.get_text().startswith("here")]
    assert told == ["here this robot lets another pass"]


def test_names_on_the_floor_cover_neither_each_other_nor_the_discs_of_others(many: Plan):
    """Fifteen robots half a metre apart: thirty names, none over another, none over a start or goal."""
    figure = workspace(many)
    figure.draw_without_rendering()
    ax = figure.axes[0]
    boxes = np.array([text.get_window_extent().extents for text in ax.texts if text.get_text()])
    assert len(boxes) == 30
    for k, (x0, y0, x1, y1) in enumerate(boxes.tolist()):
        others = np.delete(boxes, k, axis=0)
        width = np.minimum(others[:, 2], x1) - np.maximum(others[:, 0], x0)
        height = np.minimum(others[:, 3], y1) - np.maximum(others[:, 1], y0)
        assert not np.any((width > 0) & (height > 0)), ax.texts[k].get_text()
        for robot in many.problem.robots:
            for end in (robot.start, robot.goal):
                x, y = ax.transData.transform(end)
                assert not (x0 < x < x1 and y0 < y < y1), (ax.texts[k].get_text(), end)


def test_paths_that_share_a_way_are_drawn_side_by_side_there_and_only_there():
    """Three on one line, one of them coming the other way, keep one width apart; a crossing path stays as it is."""
    paths = [
        straight((0.0, 0.0), (20.0, 0.0)),
        straight((2.0, 0.0), (30.0, 0.0)),
        straight((25.0, 0.0), (1.0, 0.0)),
        straight((10.0, -5.0), (10.0, 5.0)),
    ]
    lines = side_by_side(paths, 0.1)
    heights = sorted(float(np.interp(10.0, *(way if way[0, 0] < way[-1, 0] else way[::-1]).T)) for way in lines[:3])
    assert heights == pytest.approx([-0.1, 0.0, 0.1], abs=1e-6)
    assert lines[3].tolist() == line(paths[3])[:, :2].tolist()
    alone = lines[1][lines[1][:, 0] > 26.0]
    assert len(alone)
    assert np.abs(alone[:, 1]).max() < 1e-9


def test_a_problem_without_a_plan_can_be_drawn_with_what_the_diagnosis_points_to(failure: Result):
    """Starts, goals and walls, and a cross at the place; the same bytes each time."""
    assert draw_failure(failure) == draw_failure(failure)
    figure = floor(failure.problem, failure.diagnoses)
    legend = figure.axes[0].get_legend()
    assert legend is not None
    assert "reason: no_way" in [text.get_text() for text in legend.get_texts()]
    crosses = [mark.get_xydata().tolist() for mark in figure.axes[0].lines if mark.get_marker() == "X"]
    assert crosses == [[[2.5, 1.75]]]


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


def test_a_robot_that_is_passed_twice_is_passed_on_both_sides(sample: Plan):
    """What the motion does at each place of the area counts, not one word for all of it."""
    red, blue = sample.robots[:2]
    (window,) = windows(sample, blue, 20.0)
    assert passes(window, blue.profile) == "passes after it"
    assert passes(window, blue.profile.shifted(-60.0)) == "passes before it"
    twice = Window(red, np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0]), np.array([[-1.0, 1.0, 1.0], [1.0, 1.0, -1.0]]))
    steady = VelocityProfile([0.5, 1.5], [(0.0, 1.0, 0.0), (1.0, 1.0, 0.0)], [0.0])
    assert passes(twice, steady) == "passes after and before it"


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


def test_drawing_needs_no_global_state_of_matplotlib(tmp_path: File):
    """pyplot keeps figures and opens windows; nothing of coord loads it."""
    code = "import sys, coord.output.plots; sys.exit('matplotlib.pyplot' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path)
