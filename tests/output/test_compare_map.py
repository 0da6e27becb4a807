"""A plan's obstacles against the map of a problem, cell by cell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coord.output.compare_map import compare_map
from coord.output.plan_file import serialise
from coord.reading.problem_file import read_problem

ROBOT = '[[robots]]\nname = "a"\nstart = [3.0, 3.0]\ngoal = [3.0, 3.0]\n'
OWN = '[[obstacles]]\nname = "map 1"\nrectangle = [0.2, 0.2, 0.4, 0.4]\n'


@pytest.fixture
def problem(tmp_path):
    """A floor with a frame, stray cells and an obstacle of its own; returns the file and the problem read."""
    cells = np.where(np.random.default_rng(1).random((40, 50)) < 0.05, 0, 255).astype(np.uint8)
    cells[[0, -1]] = 0
    cells[:, [0, -1]] = 0
    cells[20:35, 20:45] = 255
    (tmp_path / "floor.pgm").write_bytes(b"P5 50 40 255\n" + cells.tobytes())
    file = tmp_path / "problem.toml"
    workspace = '[workspace]\nmap = "floor.pgm"\nresolution = 0.1\n'
    file.write_text(f'format = "coord-problem/1"\n{workspace}{ROBOT.replace("3.0, 3.0", "3.0, 1.2")}{OWN}')
    return file, read_problem(file)


def planned(plan, obstacles):
    """The bytes of a plan with these obstacles."""
    return serialise(replace(plan, problem=replace(plan.problem, obstacles=tuple(obstacles))))


def test_a_plan_with_all_outlines_of_the_map_agrees(parked, problem):
    """What planning traced is what the checker reads; the problem's own obstacles are not taken for the map's."""
    file, read = problem
    found = compare_map(planned(parked, read.obstacles), file)
    assert found.differences == ()
    assert found.remark == ""


def test_a_plan_that_lost_an_outline_is_refused_with_its_place(parked, problem):
    """Every outline is missed when it is gone, at a cell of its own."""
    file, read = problem
    for lost in range(1, len(read.obstacles)):
        obstacles = [obstacle for k, obstacle in enumerate(read.obstacles) if k != lost]
        (said,) = compare_map(planned(parked, obstacles), file).differences
        assert said.startswith("map: the cell at (")
        place = np.array(said.partition("(")[2].partition(")")[0].split(","), dtype=float)
        ring = read.obstacles[lost].vertices
        assert (ring.min(axis=0) < place).all()
        assert (place < ring.max(axis=0)).all()


def test_other_images_are_compared_by_digest_only_and_that_is_said(parked, tmp_path):
    """A PNG is none of the checker's business; a problem without a map has nothing to compare."""
    from PIL import Image

    Image.fromarray(np.full((40, 50), 255, dtype=np.uint8)).save(tmp_path / "floor.png")
    file = tmp_path / "problem.toml"
    file.write_text(f'format = "coord-problem/1"\n[workspace]\nmap = "floor.png"\nresolution = 0.1\n{ROBOT}')
    found = compare_map(planned(parked, ()), file)
    assert found.differences == ()
    assert found.remark.startswith("the cells of the map were not compared, only digests: ")
    file.write_text(f'format = "coord-problem/1"\n[workspace]\nbounds = [0, 0, 5, 5]\n{ROBOT}')
    assert compare_map(planned(parked, ()), file).remark == ""
