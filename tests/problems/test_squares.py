"""The problems of squares: planned and certified, and hard for the reason that they give."""

from __future__ import annotations

import importlib.util
import json
from dataclasses import replace
from pathlib import Path

import pytest

from coord.model.footprint import Footprint
from coord.model.options import Options
from coord.plan import plan
from coord.reading.problem_file import read_problem
from coord.verify import verify

PROBLEMS = Path(__file__).resolve().parents[2] / "problems"


@pytest.mark.parametrize("name", ["squares_fixed", "squares_turning"])
def test_a_problem_of_squares_is_planned_and_certified(name):
    """Every robot arrives, and the file says the shapes that the problem says."""
    problem = read_problem(PROBLEMS / f"{name}.toml")
    result = plan(problem, Options())
    assert result.certified
    assert result.min_clearance is not None
    assert result.min_clearance.value >= problem.workspace.clearance - 1e-9
    written = json.loads(result.document)["robots"]
    assert {robot["heading"] for robot in written} == {"fixed" if name == "squares_fixed" else "path"}
    assert {*written[0]["footprint"]} == {"square"}
    if name == "squares_turning":
        assert {*written[-1]["footprint"]} == {"polygon"}


def test_the_aisles_of_squares_fixed_are_too_narrow_for_discs():
    """A square drives 9.6 m straight through an aisle; the disc round it, alone on the floor, has to go round the racks."""
    problem = read_problem(PROBLEMS / "squares_fixed.toml")
    first = problem.robots[0]
    disc = replace(first, footprint=Footprint(first.footprint.radius))
    lengths = []
    for robot in (first, disc):
        alone = plan(replace(problem, robots=(robot,)), Options()).plan
        assert alone is not None
        lengths.append(alone.robots[0].path.length)
    assert lengths[0] == pytest.approx(9.6)
    assert lengths[1] > 12.0


def test_a_truck_longer_than_the_one_that_was_planned_is_refused():
    """With a nose of 3.5 m instead of 1.4 m it hits something; nobody else is blamed alone."""
    document = json.loads(plan(read_problem(PROBLEMS / "squares_turning.toml"), Options()).document)
    corners = document["robots"][-1]["footprint"]["polygon"]
    document["robots"][-1]["footprint"] = {"polygon": [[2.5 * x, y] for x, y in corners]}
    report = verify(json.dumps(document).encode())
    assert report.verdict == "refused"
    assert all("truck" in fault.text for fault in report.faults)


def test_the_files_are_what_the_generator_writes():
    """Whoever changes a family changes the generator."""
    spec = importlib.util.spec_from_file_location("generate", PROBLEMS / "generate.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name, text in (("squares_fixed", module.squares_fixed()), ("squares_turning", module.squares_turning())):
        assert (PROBLEMS / f"{name}.toml").read_text(encoding="utf-8") == text
