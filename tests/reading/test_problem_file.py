"""Problem files as a whole: what a good one says, and that a bad one is told apart without a traceback."""

from __future__ import annotations

import hashlib
import os
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from coord.errors import BadFileError, Fault
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Polygon
from coord.model.robot import Limits, Robot
from coord.reading.problem_file import digest, read_problem


def test_a_good_file_is_read_field_by_field(read, good):
    """Every value of the file arrives in the problem, and the rest has the documented defaults."""
    problem = read(good)
    assert problem.name == "loading bay"
    assert problem.workspace.bounds == (0.0, 0.0, 20.0, 15.0)
    assert problem.workspace.clearance == 0.05
    assert problem.workspace.after_arrival == "stay"
    assert problem.options == {"seed": 3, "time_limit": 4.5, "plots": True}
    limits = Limits(speed=1.5, acceleration=0.5, deceleration=0.5, jerk=1.0, lateral_acceleration=0.5)
    slow = Limits(speed=0.7, acceleration=0.5, deceleration=0.5, jerk=1.0, lateral_acceleration=0.5)
    assert problem.robots == (
        Robot("red", Footprint(0.3), limits, (1.0, 1.0), (9.0, 9.0), priority=1.0, release=2.0),
        Robot("blue", Footprint(0.2), slow, (3.0, 1.0), (9.0, 1.0)),
    )
    rack, column, triangle = problem.obstacles
    assert isinstance(rack, Polygon)
    assert isinstance(triangle, Polygon)
    assert column == Circle("obstacle 2", (12.0, 6.0), 1.0)
    assert (rack.name, triangle.name) == ("rack", "obstacle 3")
    assert np.array_equal(rack.vertices, [(4, 4), (6, 4), (6, 5), (4, 5)])
    assert np.array_equal(triangle.vertices, [(1, 6), (3, 6), (2, 8)])


def test_the_name_defaults_to_the_stem_of_the_file(read, good):
    """A file that gives itself no name is called like its file."""
    assert read(good.replace('name = "loading bay"', "")).name == "problem"


def test_windows_line_ends_and_a_byte_order_mark_change_nothing(read, good, faults_of):
    """Notepad's way of writing a file gives the same problem, and the same lines in faults."""
    assert read("\ufeff" + good.replace("\n", "\r\n")).robots == read(good).robots
    bad = good.replace("speed = 0.7", "speed = 0")
    assert faults_of(bad.replace("\n", "\r\n")) == faults_of(bad)


def test_the_digest_is_that_of_the_bytes_of_the_files(read, good):
    """SHA-256 over the file led by its length; any other byte, or another cut between files, is another digest."""
    data = good.encode()
    assert read(good).digest == hashlib.sha256(len(data).to_bytes(8, "big") + data).hexdigest()
    assert read(good + "\n").digest != read(good).digest
    assert digest([b"ab", b"c"]) != digest([b"a", b"bc"])


def test_all_faults_come_at_once_from_top_to_bottom(faults_of, good):
    """Form, rules, names and places are told in one go, in the order of their lines."""
    bad = (
        good.replace("seed = 3", 'seed = "x"')
        .replace("speed = 1.5", "speed = -1")
        .replace('"stay"', '"vanish"')
        .replace('"blue"', '"red"')
        .replace("start = [3.0, 1.0]", "start = [5.0, 4.5]")
        .replace("speed = 0.7", "speed = 0\njerk = true")
        .replace("radius = 1.0", "radius = -1.0")
    )
    assert faults_of(bad) == [
        'problem.toml:7: [workspace]: after_arrival must be "stay" or "leave" (got "vanish")',
        'problem.toml:10: [plan]: seed must be a whole number (got "x")',
        "problem.toml:16: [defaults]: speed must be > 0 m/s (got -1)",
        'problem.toml:27: robots[2] "red": the name is taken by robots[1]; names must differ',
        'problem.toml:28: robots[2] "red": start (5, 4.5) is 0.75 m too deep in obstacle "rack": '
        "its centre is 0.5 m inside it, radius 0.2 m + clearance 0.05 m are needed",
        'problem.toml:30: robots[2] "red": speed must be > 0 m/s (got 0)',
        'problem.toml:31: robots[2] "red": jerk must be a number in m/s3 (got true)',
        "problem.toml:39: obstacles[2]: the radius must be > 0 m (got -1)",
    ]


def test_a_file_of_ten_thousand_faulty_robots_is_told_quickly(faults_of):
    """One fault a robot, each on its own line, in seconds: nothing in reading is quadratic."""
    head = 'format = "coord-problem/1"\n[workspace]\nbounds = [-1, -1, 101, 101]\n'
    robot = '[[robots]]\nname = "{0}"\nstart = [{1}, {2}]\ngoal = [{1}, {2}]\nspeed = -{0}\n'
    text = head + "".join(robot.format(k + 1, k % 100, k // 100) for k in range(10_000))
    started = time.perf_counter()
    told = faults_of(text)
    assert time.perf_counter() - started < 10  # 0.7 s when it was written; quadratic would be minutes
    assert len(told) == 10_000
    assert told[6] == 'problem.toml:38: robots[7] "7": speed must be > 0 m/s (got -7)'
    assert told[-1] == 'problem.toml:50003: robots[10000] "10000": speed must be > 0 m/s (got -10000)'


def test_ten_thousand_robots_on_one_spot_are_one_fault_each(faults_of):
    """A crowd does not give a fault for each of its fifty million pairs."""
    head = 'format = "coord-problem/1"\n[workspace]\nbounds = [-1, -1, 101, 101]\n'
    robot = '[[robots]]\nname = "{0}"\nstart = [50, 50]\ngoal = [{1}, {2}]\n'
    text = head + "".join(robot.format(k + 1, k % 100, k // 100) for k in range(3_000))
    told = faults_of(text)
    assert len(told) == 2_999
    assert all('overlaps the start of robots[1] "1"' in fault for fault in told)


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (b"", ':1: format is missing; the file should begin with format = "coord-problem/1"'),
        (b'format = "coord\xff"', ":1: the file is no text in UTF-8"),
        (b'format = "x"\nname = "\xc3\x28"', ":2: the file is no text in UTF-8"),
        (b"a = 1\nb = \n", ":2: this is no TOML: Invalid value"),
        (b"a = 1\na = 2\n", ":2: this is no TOML: this key is given twice"),
        (b"a = [1,\n2", ":2: this is no TOML: Unclosed array"),
        (b"a = " + b"[" * 5000, ": the file is nested too deeply"),
        (b"a = " + b"9" * 5000, ": this is no TOML: Exceeds the limit"),
    ],
)
def test_a_file_that_is_no_toml_is_a_bad_file(tmp_path, data, fault):
    """Broken bytes, broken TOML and what Python's reader cannot hold are told with the line where there is one."""
    file = tmp_path / "x.toml"
    file.write_bytes(data)
    with pytest.raises(BadFileError) as caught:
        read_problem(file)
    assert str(caught.value.faults[0]).startswith(f"{file}{fault}")


def test_a_file_that_is_not_there_is_a_bad_file(tmp_path):
    """A missing file is named."""
    with pytest.raises(BadFileError, match=r"nothing\.toml: the problem file does not exist"):
        read_problem(tmp_path / "nothing.toml")


def test_a_folder_is_a_bad_file(tmp_path):
    """A folder is no problem file."""
    with pytest.raises(BadFileError, match="is not a regular file"):
        read_problem(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_a_pipe_is_refused_without_waiting_for_it(tmp_path):
    """Reading from a pipe that nobody writes to would hang for ever."""
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(BadFileError, match="is not a regular file"):
        read_problem(tmp_path / "pipe.toml")


@pytest.mark.parametrize("name", ["a" * 5000 + ".toml", "nul\0.toml"])
def test_a_name_that_no_file_can_have_is_a_bad_file(tmp_path, name):
    """The operating system's refusal of a name is told, not raised."""
    with pytest.raises(BadFileError, match="the problem file cannot be read"):
        read_problem(tmp_path / name)


def test_a_file_of_more_than_64_mib_is_refused(tmp_path):
    """Nobody writes such a file by hand; it is refused before it is parsed."""
    file = tmp_path / "large.toml"
    with file.open("wb") as stream:
        stream.truncate(2**26 + 1)
    with pytest.raises(BadFileError, match="the problem file is larger than 64 MiB"):
        read_problem(file)


def test_a_key_nested_thousands_deep_is_an_unknown_key(faults_of):
    """What TOML's reader takes, however deep, is shown in a fault cut short."""
    told = faults_of('format = "coord-problem/1"\nname' + ".a" * 2000 + " = 1\n")
    assert told[0].startswith("problem.toml:1: a problem needs at least one robot")
    assert told[2] == "problem.toml:2: name must be a text (got { a = { a = { a = { a = { ... } } } } })"


VALUES = st.sampled_from(
    [
        "-1",
        "0",
        "-0.0",
        "nan",
        "inf",
        "true",
        '"a"',
        '""',
        "[]",
        "{}",
        "[1]",
        "[1, [2]]",
        "1e300",
        "1e-320",
        "123456789012345678901234567890",
        "1979-05-27",
        "[5, 4.5]",
        "[1.0, 1.0]",
        "[nan, 1]",
        "[9, 9, 1, 1]",
        "[1e6, 0, 1e-9, 1]",
        "[[0, 0], [0, 0], [1, 1]]",
        "[[1, 1], [2, 2], [1, 2], [2, 1]]",
        "{ disc = -1 }",
        "{ disc = 1, square = 2 }",
        "{ square = 0.6 }",
        "{ polygon = [[0.3, 0], [0, 0.3], [-0.3, 0]] }",
        "[[1, 1], [9, 9]]",
        "{ center = [1, 1], radius = -1 }",
        "{ center = 1 }",
        '"floor.yaml"',
        '"\\u0000"',
        "'''x'''",
        "0xffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff",
        '"path"',
        '"left"',
        '"leave"',
    ]
)
KEYS = st.sampled_from(
    [
        "name",
        "start",
        "goal",
        "speed",
        "via",
        "path",
        "polygon",
        "circle",
        "rectangle",
        "angle",
        "format",
        "foo",
        "map",
        "bounds",
        "heading",
        "resolution",
        "side",
        "x.y",
        "robots",
        "'q u'",
        "footprint.disc",
        "footprint",
        "corner_radius",
        "robots_file",
    ]
)
TABLES = st.sampled_from(["[robots]", "[[robots]]", "[workspace]", "[[obstacles]]", "[robots.x]", "[plan]", "[[plan]]"])
PLACES = st.integers(0, 10_000)
CHANGES = st.one_of(
    st.tuples(st.just("value"), PLACES, VALUES),
    st.tuples(st.just("key"), PLACES, KEYS),
    st.tuples(st.just("add"), PLACES, st.one_of(TABLES, st.builds("{} = {}".format, KEYS, VALUES))),
    st.tuples(st.just("drop"), PLACES, st.just("")),
    st.tuples(st.just("write"), PLACES, st.text(max_size=3)),
)


def changed(text: str, change: tuple[str, int, str]) -> str:
    """The text with one line, or one character, changed, added or dropped."""
    kind, place, new = change
    if kind == "write":
        at = place % len(text)
        return text[:at] + new + text[at + 1 :]
    lines = text.split("\n")
    at = place % len(lines)
    if kind == "drop" and len(lines) > 1:
        del lines[at]
    elif kind == "add":
        lines.insert(at, new)
    elif "=" in lines[at]:
        key, value = lines[at].split("=", 1)
        lines[at] = f"{key}= {new}" if kind == "value" else f"{new} ={value}"
    return "\n".join(lines)


@settings(max_examples=300, deadline=None)
@given(changes=st.lists(CHANGES, min_size=1, max_size=4))
@example(changes=[("value", 4, "[0, 0, inf, 1]"), ("value", 33, "[0, 0, 1e300, 1]")])
@example(changes=[("add", 37, "angle = inf"), ("value", 5, "nan")])
def test_whatever_is_changed_in_a_good_file_it_is_read_or_bad(tmp_path_factory, good, changes):
    """No change of a good file makes reading raise anything but BadFileError, and that names a fault."""
    text = good
    for change in changes:
        text = changed(text, change) or "\n"
    file = tmp_path_factory.getbasetemp() / "changed.toml"
    file.write_bytes(text.encode("utf-8", "replace"))
    robots, faults = outcome(file)
    assert robots or faults
    lines = text.count("\n") + 1
    assert all(fault.line is None or 1 <= fault.line <= lines for fault in faults)
    assert all(fault.text.isprintable() for fault in faults)


def outcome(file: Path) -> tuple[tuple[Robot, ...], tuple[Fault, ...]]:
    """The robots of a file, or its faults."""
    try:
        return read_problem(file).robots, ()
    except BadFileError as error:
        return (), error.faults
