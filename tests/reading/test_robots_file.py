"""Robots as rows of a CSV file beside the problem."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coord.errors import BadFileError, Fault
from coord.model.footprint import Footprint, polygon, square
from coord.model.problem import Problem
from coord.model.robot import Robot
from coord.reading.problem_file import digest, read_problem

HEAD = 'format = "coord-problem/1"\nrobots_file = "robots.csv"\n[workspace]\nbounds = [0, 0, 10, 10]\n'
ROBOT = '[[robots]]\nname = "a"\nstart = [1, 1]\ngoal = [9, 1]\n'
HEADER = "name,start,goal,speed,footprint\n"

Read = Callable[..., Problem]


@pytest.fixture
def rows(tmp_path: Path) -> Read:
    """Reads a problem whose robots.csv has this text."""

    def read_text(table: str, problem: str = HEAD) -> Problem:
        (tmp_path / "robots.csv").write_bytes(table.encode("utf-8", "surrogatepass"))
        (tmp_path / "problem.toml").write_text(problem, encoding="utf-8")
        return read_problem(tmp_path / "problem.toml")

    return read_text


@pytest.fixture
def faults(rows: Read, tmp_path: Path) -> Callable[..., list[str]]:
    """The faults of such a problem, as people see them, without the folder."""

    def told(table: str, problem: str = HEAD) -> list[str]:
        with pytest.raises(BadFileError) as caught:
            rows(table, problem)
        return [str(fault).replace(f"{tmp_path}/", "") for fault in caught.value.faults]

    return told


def test_rows_come_after_the_robots_of_the_problem(rows):
    """First those of the TOML file, then the rows, each group in its own order."""
    table = 'name,start,goal\nc,"[1, 3]","[9, 3]"\nb,"[1, 5]","[9, 5]"\n'
    assert [robot.name for robot in rows(table, HEAD + ROBOT).robots] == ["a", "c", "b"]


def test_a_row_says_what_a_table_says(rows, read):
    """Every field of a robot can be a column, and gives the very robot that [[robots]] would give."""
    columns = (
        "name,start,goal,footprint,heading,speed,acceleration,deceleration,jerk,lateral_acceleration,corner_radius,"
        "weight,release,priority,side,via,path\n"
    )
    by_rows = rows(
        columns
        + 'agv 7,"[1.0, 1]","[9, 1]",{ square = 0.6 },path,2,1,0.5,3,0.25,0.1,2,1.5,1,left,"[[5, 1], [6, 1]]",\n'
        + 'b,"[1, 5]","[9, 5]",,,,,,,,,,,,,,"[[1, 5], [5, 6], [9, 5]]"\n'
        + 'c,"[1, 8]","[9, 8]","{ polygon = [[0.3, 0], [0, 0.3], [-0.3, 0]] }"\n'
    ).robots
    by_tables = read(
        HEAD.replace('robots_file = "robots.csv"\n', "")
        + '[[robots]]\nname = "agv 7"\nstart = [1.0, 1]\ngoal = [9, 1]\nfootprint = { square = 0.6 }\nheading = "path"\n'
        + "speed = 2\nacceleration = 1\ndeceleration = 0.5\njerk = 3\nlateral_acceleration = 0.25\ncorner_radius = 0.1\n"
        + 'weight = 2\nrelease = 1.5\npriority = 1\nside = "left"\nvia = [[5, 1], [6, 1]]\n'
        + '[[robots]]\nname = "b"\nstart = [1, 5]\ngoal = [9, 5]\npath = [[1, 5], [5, 6], [9, 5]]\n'
        + '[[robots]]\nname = "c"\nstart = [1, 8]\ngoal = [9, 8]\n'
        + "footprint = { polygon = [[0.3, 0], [0, 0.3], [-0.3, 0]] }\n"
    ).robots
    assert by_rows == by_tables
    assert by_rows[0].footprint == square(0.6, "path")
    assert by_rows[2].footprint == polygon([(0.3, 0), (0, 0.3), (-0.3, 0)])


def test_an_empty_cell_is_a_field_that_is_not_given(rows):
    """The defaults of the problem file hold for rows, too; blank rows and empty cells at the end are nothing."""
    table = HEADER + '\na,"[1, 1]","[9, 1]",,,\n  ,,\nb,"[1, 5]","[9, 5]",2\n'
    robots = rows(table, HEAD + "[defaults]\nspeed = 1.5\nfootprint = { disc = 0.4 }\n").robots
    assert [robot.limits.speed for robot in robots] == [1.5, 2.0]
    assert {robot.footprint for robot in robots} == {Footprint(0.4)}


@pytest.mark.parametrize("name", ["7", "true", "[x]", "'quo,ted'", "机器人", "007", "agv #3"])
def test_a_name_needs_no_quotes(rows, name):
    """Whatever stands in the column of names is a text, TOML's own quotes are taken off."""
    (robot,) = rows(f'name,start,goal\n"{name}","[1, 1]","[9, 1]"\n').robots
    assert robot.name == name.strip("'")


def test_spreadsheets_ways_of_writing_change_nothing(rows):
    """A byte order mark, Windows line ends, blanks after commas, empty columns at the end."""
    plain = 'name,start,goal\na,"[1, 1]","[9, 1]"\n'
    other = '\ufeffname, start, goal,,\r\na, "[1, 1]", "[9, 1]",,\r\n,,,,\r\n'
    assert rows(other).robots == rows(plain).robots


def test_the_digest_covers_the_robots_file(rows, tmp_path):
    """Another byte in the rows is another problem."""
    table = 'name,start,goal\na,"[1, 1]","[9, 1]"\n'
    assert rows(table).digest == digest([HEAD.encode(), table.encode()])
    assert rows(table + "\n").digest != rows(table).digest


def test_a_fault_of_a_row_names_its_file_its_line_and_its_robot(faults):
    """Robots are counted on from those of the problem; a cell over several lines moves the lines of the next."""
    table = HEADER + 'b,"[1,\n3]","[9, 3]",-1,\nc,"[1, 5]","[9, 11]",1,{ disk = 1 }\n"",[],,fast\n'
    assert faults(table, HEAD + ROBOT + "speed = 0\n") == [
        'problem.toml:9: robots[1] "a": speed must be > 0 m/s (got 0)',
        'robots.csv:2: robots[2] "b": speed must be > 0 m/s (got -1)',
        'robots.csv:4: robots[3] "c": unknown key "disk"; did you mean "disc"?',
        'robots.csv:5: robots[4]: speed must be a number in m/s (got "fast")',
        "robots.csv:5: robots[4]: start must be [x, y], two numbers in m (got [])",
        "robots.csv:5: robots[4]: name is missing; every robot needs a name",
        "robots.csv:5: robots[4]: goal is missing; every robot needs a goal",
    ]


def test_names_must_differ_over_both_files(faults):
    """A row that bears the name of a robot of the problem is told, and so is the second of two rows."""
    table = 'name,start,goal\na,"[1, 3]","[9, 3]"\nb,"[1, 5]","[9, 5]"\nb,"[1, 7]","[9, 7]"\n'
    assert faults(table, HEAD + ROBOT) == [
        'robots.csv:2: robots[2] "a": the name is taken by robots[1]; names must differ',
        'robots.csv:4: robots[4] "b": the name is taken by robots[3]; names must differ',
    ]


def test_places_are_checked_over_both_files(faults):
    """A row's start on that of a robot of the problem is told on the row's line."""
    assert faults('name,start,goal\nb,"[1.5, 1]","[9, 5]"\n', HEAD + ROBOT) == [
        'robots.csv:2: robots[2] "b": start (1.5, 1) overlaps the start of robots[1] "a": 0.5 m apart, '
        "radii 0.3 m + 0.3 m are needed"
    ]


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ("", "robots.csv:1: the first row names the columns, and name and start and goal must be among them"),
        ("\n\nname,start\n", "robots.csv:3: the first row names the columns, and goal must be among them"),
        (
            "name;start;goal\n",
            'robots.csv:1: unknown column "name;start;goal"; known are',
        ),
        ("name,start,goal,spede\n", 'robots.csv:1: unknown column "spede"; did you mean "speed"?'),
        ("name,start,goal,bounds\n", 'robots.csv:1: unknown column "bounds"; it belongs in [workspace]'),
        ("name,start,goal,speed,speed\n", 'robots.csv:1: the column "speed" stands 2 times'),
        ("name,,start,goal\n", "robots.csv:1: column 2 has no name"),
        (
            "name,start,goal\na,[1, 1],[9, 1]\n",
            "robots.csv:2: the row has 5 cells, but there are 3 columns; a cell with a comma in it stands in quotes",
        ),
        ('name,start,goal\na,"[1, 1\n', "robots.csv:2: this is no CSV: unexpected end of data"),
        ("name,start,goal\n\ud800", "robots.csv:2: the file is no text in UTF-8"),
        ("name,start,goal\n", "problem.toml:2: a problem needs at least one robot"),
    ],
)
def test_a_file_that_is_no_table_of_robots_is_told(faults, table, told):
    """The header is judged once, not again in each row."""
    assert faults(table)[0].startswith(told)


def test_semicolons_are_told_apart(faults):
    """What some spreadsheets write instead of commas has a hint of its own."""
    assert faults("name;start;goal\n")[1].endswith("must be among them; columns are separated by commas")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_a_pipe_is_no_robots_file(tmp_path):
    """Files that a problem names are regular files; nobody waits for a pipe."""
    os.mkfifo(tmp_path / "robots.csv")
    (tmp_path / "problem.toml").write_text(HEAD, encoding="utf-8")
    with pytest.raises(BadFileError, match=r'the robots file "robots\.csv" is not a regular file'):
        read_problem(tmp_path / "problem.toml")


def test_a_robots_file_of_more_than_64_mib_is_refused(tmp_path):
    """It is refused before it is read as a table."""
    with (tmp_path / "robots.csv").open("wb") as stream:
        stream.truncate(2**26 + 1)
    (tmp_path / "problem.toml").write_text(HEAD, encoding="utf-8")
    with pytest.raises(BadFileError, match=r'the robots file "robots\.csv" is larger than 64 MiB'):
        read_problem(tmp_path / "problem.toml")


def test_malformed_robots_of_the_problem_do_not_hide_the_rows(faults):
    """A list that is none leaves its own fault, and those of the rows."""
    problem = HEAD.replace("[workspace]", "robots = [1, 2]\n[workspace]")
    assert faults('name,start,goal,speed\nb,"[1, 3]","[9, 3]",0\n', problem) == [
        "problem.toml:3: robots[1]: robots must be a list of tables, each written [[robots]] with two brackets (got 1 as item 1)",
        'robots.csv:2: robots[3] "b": speed must be > 0 m/s (got 0)',
    ]


CELLS = st.one_of(
    st.sampled_from(
        ["a", '"[1, 1]"', '"[9, 1]"', "1", "-1", "nan", "{ disc = 1 }", "", '"1\nspeed = 3"', "1 # x", "[["]
    ),
    st.text(alphabet="\"',;[]{}=\n\r\0 a1.\ud800", max_size=6),
)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.one_of(
        st.permutations(["name", "start", "goal", "speed", "via", "path"]),
        st.lists(st.sampled_from(["name", "start", "goal", "side", "foo", ""]), max_size=6),
    ),
    st.lists(st.lists(CELLS, max_size=6), max_size=5),
)
def test_whatever_stands_in_a_robots_file_it_is_read_or_bad(rows, columns, cells):
    """No file makes reading raise anything but BadFileError, whose faults are sentences on lines of a file."""
    text = "\n".join(",".join(row) for row in [columns, *cells])
    robots, faults = outcome(rows, text)
    assert robots or faults
    assert all(fault.text.isprintable() and fault.subject.isprintable() for fault in faults)
    most = text.count("\n") + text.count("\r") + 5
    assert all(fault.line is not None and 1 <= fault.line <= most for fault in faults)


def outcome(rows: Read, text: str) -> tuple[tuple[Robot, ...], tuple[Fault, ...]]:
    """The robots of a problem with these rows, or its faults."""
    try:
        return rows(text, HEAD + ROBOT).robots, ()
    except BadFileError as error:
        return (), error.faults
