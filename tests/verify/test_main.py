"""The checker runs on its own, and on nothing but the standard library."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import coord.verify

FOLDER = Path(coord.verify.__file__).parent


def test_it_imports_nothing_of_the_planner_and_nothing_foreign():
    """Every import in it is of the standard library or of the checker itself."""
    files = list(FOLDER.glob("*.py"))
    assert len(files) > 10
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0
                names = [node.module]
            for name in names:
                own = name == "coord.verify" or name.startswith("coord.verify.")
                assert own or name.split(".")[0] in sys.stdlib_module_names, (file.name, name)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plans")

    def run(data):
        file = folder / "plan.json"
        if data is None:
            file.unlink(missing_ok=True)
        else:
            file.write_bytes(data)
        command = [sys.executable, "-m", "coord.verify", str(file)]
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)

    return run


def test_exit_codes_and_words(run, build):
    """0 certified, 4 refused, 2 malformed or not there; findings on standard output."""
    robots = [build.robot("a", (0, 0), (4, 0)), build.robot("b", (0, 3), (4, 3))]
    done = run(build.data(build.plan(robots)))
    assert (done.returncode, done.stderr) == (0, "")
    assert "certified: 2 robots" in done.stdout
    assert "least clearance 2.400000 m" in done.stdout
    done = run(build.data(build.plan([*robots, build.robot("c", (9, 9), (4, 3))])))
    assert done.returncode == 4
    assert "collision" in done.stdout
    assert run(b"{}").returncode == 2
    done = run(None)
    assert (done.returncode, done.stdout) == (2, "")
    assert "cannot be read" in done.stderr
