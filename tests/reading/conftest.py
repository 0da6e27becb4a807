"""A good problem file, and ways to read changed ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from coord.errors import BadFileError
from coord.model.problem import Problem
from coord.reading.problem_file import read_problem

GOOD = """\
format = "coord-problem/1"
name = "loading bay"

[workspace]
bounds = [0.0, 0.0, 20.0, 15.0]
clearance = 0.05
after_arrival = "stay"

[plan]
seed = 3
time_limit = 4.5
plots = true

[defaults]
footprint = { disc = 0.3 }
speed = 1.5
acceleration = 0.5

[[robots]]
name = "red"
start = [1.0, 1.0]
goal = [9.0, 9.0]
priority = 1
release = 2.0

[[robots]]
name = "blue"
start = [3.0, 1.0]
goal = [9.0, 1.0]
speed = 0.7
footprint.disc = 0.2

[[obstacles]]
name = "rack"
rectangle = [4.0, 4.0, 6.0, 5.0]

[[obstacles]]
circle = { center = [12.0, 6.0], radius = 1.0 }

[[obstacles]]
polygon = [[1, 6], [3, 6], [2, 8]]
"""


@pytest.fixture(scope="session")
def good() -> str:
    """The text of a problem file without a fault."""
    return GOOD


@pytest.fixture
def read(tmp_path: Path) -> Callable[[str], Problem]:
    """Reads a text as problem.toml."""

    def read_text(text: str) -> Problem:
        file = tmp_path / "problem.toml"
        file.write_text(text, encoding="utf-8")
        return read_problem(file)

    return read_text


@pytest.fixture
def faults_of(read: Callable[[str], Problem], tmp_path: Path) -> Callable[[str], list[str]]:
    """The faults of a text read as problem.toml, as people see them, without the folder."""

    def told(text: str) -> list[str]:
        with pytest.raises(BadFileError) as caught:
            read(text)
        return [str(fault).replace(f"{tmp_path}/", "") for fault in caught.value.faults]

    return told
