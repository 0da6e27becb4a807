"""Cells on a path with bends: which cap holds in which cell, and motions through tubes that need them."""

from __future__ import annotations

import numpy as np
import pytest

from coord.alone.check import keeps_limits
from coord.conflicts.window import Window
from coord.model.footprint import Footprint
from coord.model.path import Path
from coord.model.robot import Limits, Robot
from coord.timing.clear import excess
from coord.timing.ego import ego
from coord.timing.grid import Course, border_times, cells_in, time_knots
from coord.timing.haste import hasty_course
from coord.timing.program import course_of, smooth_through, through_tube
from coord.timing.tube import Tube, after_bound, before_bound, off_chords

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.3)

#: 8 m straight on, a bend to the left of 2 m that may be driven at 0.5 m/s, and 8 m straight on.
BEND = Path((0.0, 0.0, 0.0), [(8.0, 0, 0), (2.0, 1.2, 1.2), (8.0, 0, 0)])


def robot():
    return ego(Robot("e", Footprint(0.3), LIMITS, (0.0, 0.0), BEND.end), BEND)


def block(since, until, low, high):
    """The place between low and high is taken from a time until another."""
    return Window(0, np.array([since, until]), np.array([[low, low]]), np.array([[high, high]]))


def test_a_course_at_even_speed_passes_the_borders_when_it_is_there():
    """9 m in 9 s, then 9 m in 18 s: at 8 m after 8 s, at 10 m after 11 s; stretched to twice the time, after 16 and 22 s; a moment later where the cap rises."""
    course = Course(np.array([0.0, 9.0, 27.0]), np.array([0.0, 9.0, 18.0]))
    assert border_times(robot().caps, course) == pytest.approx([8.0, 11.0], abs=0.01)
    assert border_times(robot().caps, course.until(0.0, 54.0)) == pytest.approx([16.0, 22.0], abs=0.01)


def test_only_cells_in_a_bend_have_its_cap_and_all_others_keep_out_of_it():
    """Cells of 1 s at 1 m/s: 8 before the bend may not enter it, 2 in it have its cap and no bounds, 8 must be past it."""
    times = np.arange(19.0)
    cells = cells_in(Tube([], []), times, 18.0, robot().caps, Course(times, times))
    assert cells.caps == pytest.approx([1.0] * 8 + [0.5] * 2 + [1.0] * 8)
    assert np.all(cells.upper[:8] < 8.0)
    assert np.all(np.isinf(cells.upper[8:]))
    assert np.all(np.isinf(cells.lower[:10]))
    assert np.all(cells.lower[10:] > 10.0)


@pytest.mark.parametrize("where", [5.0, 8.5, 9.5, 12.0])
def test_a_place_taken_for_a_while_is_waited_for_before_in_and_behind_a_bend(where):
    """Past 3 m by its time alone, but not at a place before t = 40: within 7 % of what the rest of the way takes."""
    one = robot()
    alone = one.alone
    first = block(float(np.interp(3.0, alone.states[:, 0], alone.times)) + 2.0, 30.0, 2.0, 3.0)
    second = block(5.0, 40.0, where, where + 1.0)
    tube = Tube([after_bound(second)], [before_bound(first)])
    course = Course(np.array([0.0, 6.0, 40.0, 60.0]), np.array([0.0, 4.0, where, one.length]))
    profile = through_tube(one, tube, one.solo_bound, 80.0, course)
    assert profile is not None
    assert keeps_limits(profile, LIMITS, one.caps)
    assert excess(profile, second).passes_after
    assert not excess(profile, first).passes_after
    assert excess(profile, first).is_clear
    least = 40.0 + one.relaxed.arrival - float(np.interp(where, *_places(one.relaxed)))
    assert least <= profile.arrival <= 1.07 * least


def _places(profile):
    """Arc lengths and times at many moments."""
    times = np.linspace(0.0, profile.arrival, 4000)
    return profile.state(times)[:, 0], times


def test_with_a_little_more_time_a_bend_is_driven_more_smoothly(squared_jerk):
    """3 % more time than alone: every limit is kept, and a third of the squared jerk or more is saved."""
    one = robot()
    course = course_of(one.alone, 0.0)
    smooth = smooth_through(one, Tube([], []), 1.03 * one.alone.arrival, 0.5, course=course)
    assert smooth is not None
    assert keeps_limits(smooth, LIMITS, one.caps)
    assert squared_jerk(smooth) < 0.67 * squared_jerk(one.alone)


def test_without_a_course_there_is_no_program_for_a_path_with_bends():
    """Where it is unknown which cells are in the bend, none is promised."""
    assert through_tube(robot(), Tube([], []), 10.0, 80.0) is None


def steep(one, where, ahead, rises=0.15):
    """A window that the quickest motion passes before by a little, and that takes 0.4 m more within a moment."""
    since = float(np.interp(where, one.alone.states[:, 0], one.alone.times))
    times = since + np.append(np.linspace(0.0, rises, 31), 2.0)
    fallen = 0.4 * (1 - np.sqrt(np.minimum((times - since) / rises, 1.0)))
    s = one.alone.state(times)[:, 0] - ahead - fallen
    high = np.stack([s[:-1], s[1:]], axis=1)
    high[-1] = s[-2]
    return Window(0, times, high - 1.0, high)


@pytest.mark.parametrize("where", [4.0, 7.0, 11.0, 12.0, 14.0])
def test_a_window_that_grows_within_a_moment_does_not_shut_out_who_is_two_centimetres_ahead(where):
    """Before and behind a bend the program's motion takes less than 0.5 % more than the quickest, which passes."""
    one = robot()
    window = steep(one, where, 0.02)
    tube = Tube([], [before_bound(window)])
    assert not excess(one.alone, window).passes_after
    assert excess(one.alone, window).is_clear
    profile = through_tube(one, tube, one.solo_bound, 80.0, hasty_course(one, tube))
    assert profile is not None
    assert profile.arrival <= 1.005 * one.alone.arrival
    assert excess(profile, window).is_clear


@pytest.mark.parametrize("mesh", [1.0, 0.4, 0.16])
def test_cells_are_short_where_bounds_are_bent(mesh):
    """Where a cell is longer than 10 ms, the tube loses no more there than 25 mm times the mesh."""
    one = robot()
    tube = Tube([after_bound(block(20.0, 25.0, 14.0, 15.0))], [before_bound(steep(one, 12.0, 0.02))])
    times = time_knots(tube, 0.0, 40.0, LIMITS, mesh)
    off = off_chords(tube, times)
    assert off[np.diff(times) > 0.01].max() <= 0.025 * mesh
    assert off_chords(tube, np.array([0.0, 20.0, 25.0, 40.0])).max() > 0.025
