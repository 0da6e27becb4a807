"""ROS maps: where cells lie, which are occupied, and what is wrong with a bad map."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest

from coord.errors import BadFileError
from coord.reading.grid_map import map_obstacles
from coord.reading.problem_file import read_problem
from coord.reading.ros_map import read_ros_map

YAML = """\
image: floor.pgm
resolution: 0.5
origin: [-1.0, 2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
# black, unknown grey and white, the top row first
PGM = b"P5 3 2 255\n" + bytes([0, 205, 254, 254, 254, 254])
PROBLEM = """\
format = "coord-problem/1"
[workspace]
map = "maps/floor.yaml"
[[robots]]
name = "a"
start = [0.25, 2.25]
goal = [0.25, 2.5]
footprint = { disc = 0.1 }
"""


@pytest.fixture
def folder(tmp_path):
    """A folder with a problem, and a map beside it in maps/."""
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "floor.yaml").write_text(YAML)
    (tmp_path / "maps" / "floor.pgm").write_bytes(PGM)
    (tmp_path / "problem.toml").write_text(PROBLEM)
    return tmp_path


def change(folder, old: str, new: str) -> None:
    """Change the map's YAML file."""
    assert old in YAML
    (folder / "maps" / "floor.yaml").write_text(YAML.replace(old, new))


def faults(folder) -> list[str]:
    """All faults of the problem, as people see them, without the folder."""
    with pytest.raises(BadFileError) as caught:
        read_problem(folder / "problem.toml")
    return [str(fault).replace(f"{folder}/", "") for fault in caught.value.faults]


def occupied(folder, unknown: str = "occupied") -> list[list[int]]:
    """The cells of the map, the lowest row first."""
    return read_ros_map(folder / "maps" / "floor.yaml", unknown).occupied.astype(int).tolist()


def test_the_top_row_of_the_image_is_the_far_edge_of_the_floor(folder):
    """Row 0 of the image is at the largest y; origin is the lower left corner; obstacles lie there in metres."""
    ros_map = read_ros_map(folder / "maps" / "floor.yaml", "occupied")
    assert occupied(folder) == [[0, 0, 0], [1, 1, 0]]
    assert ros_map.bounds == (-1.0, 2.0, 0.5, 3.0)
    (obstacle,) = map_obstacles(ros_map)
    assert obstacle.name == "map 1"
    assert np.array_equal(obstacle.vertices, [(-1, 2.5), (0, 2.5), (0, 3), (-1, 3)])


def test_unknown_cells_are_free_only_when_asked_for(folder):
    """Grey between the thresholds counts as occupied unless the problem says that it is free."""
    assert occupied(folder, "free") == [[0, 0, 0], [1, 0, 0]]
    text = PROBLEM.replace("[[robots]]", 'unknown = "free"\n[[robots]]', 1)
    (folder / "problem.toml").write_text(text)
    (obstacle,) = read_problem(folder / "problem.toml").obstacles
    assert obstacle.vertices[:, 0].max() == -0.5


def test_thresholds_are_met_by_equality(folder):
    """p >= occupied_thresh is occupied and p < free_thresh is free: p = 1/255 for 254, 50/255 for 205."""
    change(folder, "free_thresh: 0.196", f"free_thresh: {50 / 255!r}")
    assert occupied(folder) == [[0, 0, 0], [1, 1, 0]]  # 205 is not below it: unknown, so occupied
    change(folder, "occupied_thresh: 0.65", f"occupied_thresh: {50 / 255!r}")
    assert occupied(folder, "free") == [[0, 0, 0], [1, 1, 0]]


def test_negate_makes_white_occupied(folder):
    """With negate, p is v/255."""
    change(folder, "negate: 0", "negate: 1")
    assert occupied(folder) == [[1, 1, 1], [0, 1, 1]]


def test_bounds_may_be_left_out_or_given(folder):
    """Without bounds the workspace is the map's extent; given ones win."""
    assert read_problem(folder / "problem.toml").workspace.bounds == (-1.0, 2.0, 0.5, 3.0)
    (folder / "problem.toml").write_text(PROBLEM.replace("map =", "bounds = [-5, -5, 5, 5]\nmap ="))
    assert read_problem(folder / "problem.toml").workspace.bounds == (-5.0, -5.0, 5.0, 5.0)


def test_the_digest_covers_problem_map_and_image(folder):
    """SHA-256 over the three files in the order in which they name each other, each led by its length."""
    total = hashlib.sha256()
    for data in (PROBLEM.encode(), YAML.encode(), PGM):
        total.update(len(data).to_bytes(8, "big") + data)
    assert read_problem(folder / "problem.toml").digest == total.hexdigest()


def test_numbers_are_read_as_map_server_reads_them(folder):
    """5e-1 is a number, although YAML 1.1 takes it for a word; keys that map_server does not know are passed over."""
    change(folder, "resolution: 0.5", "resolution: 5e-1\nmode: trinary\nauthor: me")
    assert read_ros_map(folder / "maps" / "floor.yaml", "free").resolution == 0.5


def test_a_robot_in_an_occupied_cell_is_told_with_the_part_of_the_map(folder):
    """Cells of the map are obstacles like any other."""
    (folder / "problem.toml").write_text(PROBLEM.replace("start = [0.25, 2.25]", "start = [-0.75, 2.75]"))
    assert faults(folder) == [
        'problem.toml:6: robots[1] "a": start (-0.75, 2.75) is 0.35 m too deep in obstacle "map 1": '
        "its centre is 0.25 m inside it, radius 0.1 m is needed"
    ]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("image: floor.pgm\n", "", "maps/floor.yaml:1: image is missing"),
        ("floor.pgm", "else.pgm", 'maps/floor.yaml:1: the image "else.pgm" does not exist'),
        ("floor.pgm", ".", 'maps/floor.yaml:1: the image "." is not a regular file'),
        ("floor.pgm", "floor.yaml", "maps/floor.yaml: the image is no PGM, PNG, BMP or JPEG image"),
        ("0.5", "0", 'maps/floor.yaml:2: resolution must be a number > 0 in m, the side of a cell (got "0")'),
        ("0.5", ".nan", 'maps/floor.yaml:2: resolution must be a number > 0 in m, the side of a cell (got ".nan")'),
        (
            "0.5",
            "1e300",
            "maps/floor.yaml:3: the map reaches 3e+300 m from the origin; coordinates must stay within 1e+06 m",
        ),
        (
            "[-1.0, 2.0, 0.0]",
            "[-1.0, 2.0]",
            "maps/floor.yaml:3: origin must be [x, y, yaw], the pose of the lower left corner in m and rad "
            '(got ["-1.0", "2.0"])',
        ),
        (
            "0.0]",
            "0.5]",
            "maps/floor.yaml:3: a map that is turned (origin's third number is not 0) is not supported yet",
        ),
        ("negate: 0", "negate: 2", 'maps/floor.yaml:4: negate must be 0 or 1 (got "2")'),
        ("0.65", "65", 'maps/floor.yaml:5: occupied_thresh must be a number from 0 to 1 (got "65")'),
        ("0.196", "{}", "maps/floor.yaml:6: free_thresh must be a number from 0 to 1 (got {})"),
        ("0.196", "0.196\nmode: scale", 'maps/floor.yaml:7: a mode other than "trinary" is not supported yet'),
        ("negate: 0", "negate: [0", "maps/floor.yaml:5: the map is no YAML: did not find expected ',' or ']'"),
    ],
)
def test_a_bad_map_is_told_in_its_own_file(folder, old, new, fault):
    """Faults of a map name the map's file and line."""
    change(folder, old, new)
    (told,) = faults(folder)
    assert told.startswith(fault.split("no YAML")[0])
    assert "no YAML" in fault or told == fault


@pytest.mark.parametrize("text", ["", "- 1", "just words", "&a [*a]", "[" * 3000, "a: &a {b: *a}", "a: b: c", "\0"])
def test_a_file_that_is_no_map_is_told(folder, text):
    """Any YAML, or none, that is no map is a bad file."""
    (folder / "maps" / "floor.yaml").write_text(text)
    assert all(fault.startswith("maps/floor.yaml") for fault in faults(folder))


def test_a_map_that_is_not_there_is_told_in_the_problem(folder):
    """The line is that of the problem file which names it."""
    (folder / "maps" / "floor.yaml").unlink()
    assert faults(folder) == ['problem.toml:3: [workspace]: the map "maps/floor.yaml" does not exist']


def test_faults_of_the_map_come_after_those_of_the_problem(folder):
    """All faults of both files are told in one go."""
    change(folder, "negate: 0", "negate: x")
    (folder / "problem.toml").write_text(PROBLEM + "speed = 0\n")
    assert faults(folder) == [
        'problem.toml:9: robots[1] "a": speed must be > 0 m/s (got 0)',
        'maps/floor.yaml:4: negate must be 0 or 1 (got "x")',
    ]
