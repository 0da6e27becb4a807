"""Floors from images and from MovingAI maps."""

from __future__ import annotations

import numpy as np
import pytest

from coord.errors import BadFileError
from coord.reading.problem_file import read_problem

ROBOT = '[[robots]]\nname = "a"\nstart = [0.5, 0.5]\ngoal = [0.5, 0.5]\nfootprint = { disc = 0.4 }\n'
MAP = "type octile\nheight 3\nwidth 4\nmap\n.TT.\n.GS@\n..W.\n"


def problem(tmp_path, workspace):
    file = tmp_path / "problem.toml"
    file.write_text(f'format = "coord-problem/1"\n[workspace]\n{workspace}\n{ROBOT}')
    return read_problem(file)


def covered(read, x, y):
    """Whether a point lies in an obstacle, by the even-odd rule over all rings."""
    inside = False
    for obstacle in read.obstacles:
        for ring in obstacle.rings:
            for (x0, y0), (x1, y1) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
                if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
                    inside = not inside
    return inside


def test_a_movingai_map_is_walkable_on_ground_grass_and_swamp_only(tmp_path):
    """Cell by cell, the first row on top, one metre each unless a resolution says otherwise."""
    (tmp_path / "small.map").write_text(MAP)
    for size in (1.0, 0.25):
        text = 'map = "small.map"' + ("" if size == 1.0 else f"\nresolution = {size}")
        if size < 1:
            with pytest.raises(BadFileError):  # the robot of 0.4 m no longer fits there
                problem(tmp_path, text)
            continue
        read = problem(tmp_path, text)
        assert read.workspace.bounds == (0.0, 0.0, 4.0 * size, 3.0 * size)
        for row, cells in enumerate(MAP.split("map\n")[1].split()):
            for column, cell in enumerate(cells):
                place = (size * (column + 0.5), size * (2.5 - row))
                assert covered(read, *place) == (cell not in ".GS")


def test_an_image_is_occupied_where_it_is_darker_than_the_threshold(tmp_path):
    """Grey 100 of 200 is half of white: occupied below 0.6, free below 0.5."""
    (tmp_path / "grey.pgm").write_bytes(b"P5 3 2 200\n" + bytes([200, 0, 200, 200, 100, 200]))
    for below, middle in ((0.6, True), (0.5, False)):
        read = problem(tmp_path, f'map = "grey.pgm"\nresolution = 1.0\noccupied_below = {below}')
        assert covered(read, 1.5, 0.5) == middle
        assert covered(read, 1.5, 1.5)
        assert not covered(read, 2.5, 0.5)


@pytest.mark.parametrize(
    ("file", "text", "line", "fault"),
    [
        (
            "a.map",
            "type octile\nheight 3\nwidth 4\n.TT.\n",
            1,
            "a MovingAI map begins with the lines type, height, width, map",
        ),
        ("a.map", MAP.replace("height 3", "height 4"), 2, "height is 4, but the map has 3 rows"),
        ("a.map", MAP.replace(".GS@", ".GS"), 6, "the row has 3 cells, but width is 4"),
        ("a.map", MAP.replace("width 4", "width 0"), 2, "0 x 3 cells cannot be read"),
    ],
)
def test_a_bad_movingai_map_is_told_with_its_line(tmp_path, file, text, line, fault):
    """Header, number of rows, length of rows."""
    (tmp_path / file).write_text(text)
    with pytest.raises(BadFileError) as caught:
        problem(tmp_path, f'map = "{file}"')
    (said,) = caught.value.faults
    assert said.file.endswith(file)
    assert said.line == line
    assert said.text.startswith(fault)


def test_the_digest_changes_with_a_cell_of_the_map(tmp_path):
    """One cell more or less makes another problem."""
    (tmp_path / "small.map").write_text(MAP)
    before = problem(tmp_path, 'map = "small.map"').digest
    (tmp_path / "small.map").write_text(MAP.replace("W", "."))
    assert problem(tmp_path, 'map = "small.map"').digest != before
