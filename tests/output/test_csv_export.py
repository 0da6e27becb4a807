import csv
import io

import numpy as np
import pytest

from coord.errors import InvalidValueError
from coord.model.result import Plan
from coord.output.csv_export import samples, write_csv


def rows_of(plan: Plan, step: float = 0.05) -> list[list[str]]:
    stream = io.BytesIO()
    write_csv(plan, stream, step)
    return list(csv.reader(io.StringIO(stream.getvalue().decode())))


def test_the_header_is_that_of_the_contract(sample: Plan):
    """Other programs find columns by these names."""
    assert rows_of(sample)[0] == ["t", "robot", "x", "y", "heading", "s", "v", "a", "j"]


def test_robots_stand_in_the_order_of_the_file_and_names_survive(sample: Plan):
    """A name with a comma and quotes reads back as it is."""
    names = [row[1] for row in rows_of(sample)[1:]]
    assert list(dict.fromkeys(names)) == ["red", "blue", 'grün, "3" [bold]']


@pytest.mark.parametrize("step", [0.05, 0.3, 1.0, 7.0, 100.0])
def test_every_robot_starts_at_zero_and_ends_exactly_at_its_arrival_at_rest(sample: Plan, step: float):
    """First row: t = 0 at the start. Last row: the arrival to the last bit, at the end of the path, v = a = j = 0."""
    rows = rows_of(sample, step)[1:]
    for robot in sample.robots:
        own = [[float(value) for k, value in enumerate(row) if k != 1] for row in rows if row[1] == robot.robot.name]
        first, last = own[0], own[-1]
        assert first[0] == 0.0
        assert first[1:3] == pytest.approx(robot.robot.start)
        assert last[0] == robot.arrival
        assert last[1:3] == pytest.approx(robot.robot.goal, abs=1e-9)
        assert last[5:] == [0.0, 0.0, 0.0]
        steps = np.diff([row[0] for row in own])
        assert np.all(steps > 1e-9)
        assert np.all(steps < step + 1e-9)


def test_a_robot_that_stays_has_rows_until_its_release(parked: Plan):
    """Its arrival is its release, 1.5 s, and it never moves."""
    own = samples(parked.robots[0], 0.5)
    assert own[:, 0].tolist() == [0.0, 0.5, 1.0, 1.5]
    assert np.ptp(own[:, 1:], axis=0).tolist() == [0.0] * 7


def test_the_jerk_is_that_just_after_each_time(sample: Plan):
    """At a knot the next phase counts; before the departure and at the arrival there is none."""
    blue = sample.robots[1]
    t, jerk = samples(blue, 1.0)[:, [0, 7]].T
    j = float(blue.profile.jerks[0])
    expected = {4.0: 0.0, 5.0: j, 7.0: j, 8.0: -j, 10.0: -j, 11.0: -j, 14.0: j, 16.0: j, 17.0: 0.0}
    assert {time: float(jerk[np.flatnonzero(t == time)[0]]) for time in expected} == expected


def test_the_columns_agree_with_each_other(sample: Plan):
    """x, y, heading are the path at s, and heading is continuous: no jump by 2 pi."""
    for robot in sample.robots:
        own = samples(robot, 0.05)
        assert np.allclose(own[:, 1:4], robot.path.pose(own[:, 4]), atol=1e-12)
        assert np.all(np.abs(np.diff(own[:, 3])) < 0.1)


def test_numbers_are_written_by_repr(sample: Plan):
    """Reading a value gives the very float that was computed."""
    row = rows_of(sample, 0.05)[30]
    assert [repr(float(value)) for k, value in enumerate(row) if k != 1] == [v for k, v in enumerate(row) if k != 1]


@pytest.mark.parametrize("step", [0.0, -1.0, float("nan"), float("inf"), 1e-9])
def test_a_time_step_that_makes_no_sense_is_refused(sample: Plan, step: float):
    """Neither an endless file nor one without rows."""
    with pytest.raises(InvalidValueError, match="time step"):
        write_csv(sample, io.BytesIO(), step)
