import csv
import json
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from coord.alone.fastest import fastest, solo_bound
from coord.cli import MOST_FAULTS, RESERVED, main
from coord.errors import BadFileError, Fault, InvalidValueError
from coord.model.options import Options
from coord.model.path import straight
from coord.model.problem import Problem
from coord.model.result import Diagnosis, Plan, Result, RobotPlan
from coord.output.plan_file import serialise
from coord.reading.problem_file import read_problem

PROBLEM = """
format = "coord-problem/1"
name = "two lanes"
[workspace]
bounds = [0.0, 0.0, 10.0, 6.0]
clearance = 0.05
[defaults]
footprint = { disc = 0.3 }
speed = 1.0
acceleration = 0.5
jerk = 1.0
[[robots]]
name = "red"
start = [1.0, 1.0]
goal = [9.0, 1.0]
[[robots]]
name = "blue"
start = [9.0, 5.0]
goal = [2.0, 5.0]
release = 1.0
"""

KEYS = "certified robots arrived sum_of_arrivals makespan sum_of_solo_arrivals lower_bound optimality_gap min_clearance"


@dataclass
class Answer:
    """What the command has said, and the code it ended with."""

    code: int
    out: str
    err: str


@pytest.fixture
def coord(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Answer]:
    """Runs ``coord`` in an empty folder, in this process."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("COORD_DEBUG", raising=False)

    def run(*args: object) -> Answer:
        monkeypatch.setattr(sys, "argv", ["coord", *map(str, args)])
        with pytest.raises(SystemExit) as ended:
            main()
        captured = capsys.readouterr()
        return Answer(int(ended.value.code or 0), captured.out, captured.err)

    return run


@pytest.fixture
def problem(tmp_path: Path) -> Path:
    """Two robots in two lanes that never meet."""
    file = tmp_path / "lanes.toml"
    file.write_text(PROBLEM)
    return file


@pytest.fixture
def plan_file(problem: Path, tmp_path: Path) -> Path:
    """A plan for them."""
    file = tmp_path / "plan.json"
    file.write_bytes(serialise(driven(read_problem(problem))))
    return file


@pytest.fixture
def planner(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[Problem, Options], Result]], None]:
    """Puts a planner in place of coord's own, one that answers what the test is about."""

    def install(answer: Callable[[Problem, Options], Result]) -> None:
        module = ModuleType("coord.plan")
        vars(module)["plan"] = lambda problem, options, progress: answer(problem, options)
        monkeypatch.setitem(sys.modules, "coord.plan", module)

    return install


@pytest.fixture
def checker(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Puts a checker in place of coord's own, with this verdict."""

    def install(verdict: str) -> None:
        faults = () if verdict == "certified" else (SimpleNamespace(text="red comes too close to blue"),)
        report = SimpleNamespace(verdict=verdict, faults=faults, robots=2, min_clearance=None)
        module = ModuleType("coord.verify")
        vars(module)["verify"] = lambda data: report
        monkeypatch.setitem(sys.modules, "coord.verify", module)

    return install


def driven(problem: Problem) -> Plan:
    """Everybody straight to the goal, as fast as possible: a valid plan where nobody meets anybody."""
    parts = []
    for robot in problem.robots:
        path = straight(robot.start, robot.goal)
        profile = fastest(path, robot.limits).shifted(robot.release)
        bound = solo_bound(path, robot.limits) + robot.release
        parts.append(RobotPlan(robot, path, profile, profile.arrival, bound, bound))
    names = tuple(robot.name for robot in problem.robots)
    return Plan(problem, tuple(parts), names, (), sum(part.solo_bound for part in parts), "solo bounds")


def certified(problem: Problem, options: Options) -> Result:
    plan = driven(problem)
    return Result(problem, plan, True, serialise(plan))


def refused(problem: Problem, options: Options) -> Result:
    return replace(certified(problem, options), certified=False, diagnoses=(Diagnosis("refused", (), "too fast"),))


def impossible(problem: Problem, options: Options) -> Result:
    diagnosis = Diagnosis("cycle", ("red", "blue"), "each stands in the other's way", (1.0, 2.0), 3.0, "move red")
    return Result(problem, None, False, diagnoses=(diagnosis,))


def test_a_plan_is_written_and_a_table_printed(coord: Any, planner: Any, problem: Path, tmp_path: Path):
    """By default into plans/<name of the problem>/, and the table says where; nothing stands on stderr."""
    planner(certified)
    answer = coord("plan", problem)
    assert (answer.code, answer.err) == (0, "")
    assert "2 of 2" in answer.out
    assert f"written: {Path('plans/lanes/plan.json')}" in answer.out
    assert (tmp_path / "plans/lanes/plan.json").read_bytes() == serialise(driven(read_problem(problem)))


def test_with_json_standard_output_is_one_object_with_the_keys_of_the_contract(coord: Any, planner: Any, problem: Path):
    """On success and without a plan alike; what cannot be had is null."""
    for answer_of, code in ((certified, 0), (impossible, 1), (refused, 4)):
        planner(answer_of)
        answer = coord("plan", problem, "-o", "out", "--json", "--plots")
        assert (answer.code, answer.err) == (code, "")
        found = json.loads(answer.out)
        assert list(found) == [*KEYS.split(), "seconds", "order", "diagnoses"]
        assert found["certified"] is (code == 0)
        assert (found["makespan"] is None) is (code != 0)
        assert 0 < found["seconds"] < 60


def test_without_a_plan_the_exit_code_is_1_and_the_reasons_are_told_and_kept(
    coord: Any, planner: Any, problem: Path, tmp_path: Path
):
    """diagnosis.json appears, the older plan is kept under another name, and the next plan clears up."""
    planner(certified)
    coord("plan", problem, "-o", "out")
    older = (tmp_path / "out/plan.json").read_bytes()
    planner(impossible)
    answer = coord("plan", problem, "-o", "out")
    assert (answer.code, answer.out) == (1, "")
    assert "each stands in the other's way" in answer.err
    assert "Remedy: move red" in answer.err
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["diagnosis.json", "plan.old.json"]
    assert (tmp_path / "out/plan.old.json").read_bytes() == older
    planner(certified)
    coord("plan", problem, "-o", "out")
    assert not (tmp_path / "out/diagnosis.json").exists()


def test_a_plan_that_is_refused_is_not_handed_out(coord: Any, planner: Any, problem: Path, tmp_path: Path):
    """Exit code 4, and nothing is written but the diagnosis, pictures neither."""
    planner(refused)
    answer = coord("plan", problem, "-o", "out", "--plots")
    assert (answer.code, answer.out) == (4, "")
    assert "too fast" in answer.err
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["diagnosis.json"]


def test_pictures_are_drawn_when_asked_for(coord: Any, planner: Any, problem: Path, tmp_path: Path):
    """Three files beside the plan."""
    planner(certified)
    assert coord("plan", problem, "-o", "out", "--plots").code == 0
    names = sorted(file.name for file in (tmp_path / "out").iterdir())
    assert names == ["plan.json", "profiles.png", "st.png", "workspace.png"]


def test_without_a_plan_only_the_floor_is_drawn(coord: Any, planner: Any, problem: Path, tmp_path: Path):
    """Exit code 1 and one picture, to read the diagnosis with; nothing else is written, and without asking neither."""
    planner(impossible)
    answer = coord("plan", problem, "-o", "out", "--plots")
    assert (answer.code, answer.out) == (1, "")
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["diagnosis.json", "workspace.png"]
    assert "workspace.png" in answer.err
    coord("plan", problem, "-o", "other")
    assert [file.name for file in (tmp_path / "other").iterdir()] == ["diagnosis.json"]


def test_a_problem_can_ask_for_pictures_and_the_command_line_can_decline(
    coord: Any, planner: Any, problem: Path, tmp_path: Path
):
    """plots = true in [plan] is the flag --plots; --no-plots wins over it."""
    planner(certified)
    problem.write_text(PROBLEM + "[plan]\nplots = true\n")
    assert coord("plan", problem, "-o", "out").code == 0
    assert (tmp_path / "out/st.png").exists()
    assert coord("plan", problem, "-o", "none", "--no-plots").code == 0
    assert [file.name for file in (tmp_path / "none").iterdir()] == ["plan.json"]


def test_a_bad_value_in_the_table_of_options_names_the_file(coord: Any, planner: Any, problem: Path):
    """Unlike one of the command line, which names the flag."""
    planner(certified)
    problem.write_text(PROBLEM + '[plan]\norder = "curly"\n')
    answer = coord("plan", problem)
    assert (answer.code, answer.out) == (2, "")
    assert answer.err.startswith(f"{problem}: [plan]: order ")
    assert coord("plan", problem, "--order", "priority").code == 0


def test_the_help_of_plan_lists_the_values_that_are_supported_and_no_others(coord: Any):
    """The sentence that refuses an unknown value names the same ones."""
    text = coord("plan", "--help").out
    later = {"heading", "random", "search"}
    for option in ("method", "shape", "order", "profile"):
        with pytest.raises(InvalidValueError) as refused_value:
            Options(**{option: "?"})  # type: ignore[arg-type]
        described = text[text.index(f"--{option} NAME") :].split(" --", 1)[0]
        assert later & set(re.findall(r"\w+", described)) == set()
        known = re.findall(r'"(\w+)"', str(refused_value.value).split("it can be")[1])
        assert known, option
        assert all(f"{name}" in described for name in known), (option, known)


@pytest.mark.parametrize("command", RESERVED)
def test_commands_to_come_say_so(coord: Any, command: str, tmp_path: Path):
    """Exit code 2 and a sentence, whatever follows; no other command is suggested, and nothing is written."""
    for rest in ([], ["x.toml", "-o", "y"], ["--help"]):
        answer = coord(command, *rest)
        assert (answer.code, answer.out) == (2, "")
        assert "not supported yet" in answer.err
    assert list(tmp_path.iterdir()) == []


def test_the_command_line_wins_over_the_table_of_the_problem(coord: Any, planner: Any, problem: Path):
    """What neither says has its default."""
    seen = []

    def answer_of(read: Problem, options: Options) -> Result:
        seen.append(options)
        return certified(read, options)

    planner(answer_of)
    problem.write_text(PROBLEM + '[plan]\nshape = "taut"\nseed = 5\ntime_limit = 7.5\n')
    coord("plan", problem)
    coord("plan", problem, "--seed", "9")
    table = Options(shape="taut", seed=5, time_limit=7.5)
    assert seen == [table, replace(table, seed=9)]
    assert coord("plan", problem, "--gap-target", "0.01").code == 2  # not supported yet, never ignored


def test_an_option_that_is_not_supported_names_the_flag_or_the_table(coord: Any, planner: Any, problem: Path):
    """Exit code 2; nothing is planned with another option than the one asked for."""
    planner(certified)
    answer = coord("plan", problem, "--shape", "curly")
    assert (answer.code, answer.out) == (2, "")
    assert "coord: --shape:" in answer.err
    answer = coord("plan", problem, "--time-limit", "-1")
    assert (answer.code, answer.err.count("\n")) == (2, 1)
    assert "--time-limit: time_limit must be > 0 s (got -1)" in answer.err


def test_bad_files_and_bad_usage_end_with_2_and_a_sentence(
    coord: Any, planner: Any, checker: Any, problem: Path, tmp_path: Path
):
    """A file that is not there, a folder, no TOML, an output that cannot be written, an unknown flag: no traceback."""
    planner(certified)
    checker("certified")
    (tmp_path / "bad.toml").write_text("x = [")
    (tmp_path / "blocked").write_text("")
    cases = [
        ("plan", "none.toml"),
        ("plan", tmp_path),
        ("plan", tmp_path / "bad.toml"),
        ("plan", problem, "-o", "blocked"),
        ("plan", problem, "-o", "blocked/deep"),
        ("plan", problem, "--colour", "red"),
        ("plan", problem, "--seed", "many"),
        ("plan",),
        ("plan", problem, "--json", "--shape", "curly"),
        ("verify", "none.json"),
        ("plot", tmp_path, "--what", "st"),
        ("export", problem, "--to", "csv", "-o", "x.csv"),
        ("fly",),
    ]
    for case in cases:
        answer = coord(*case)
        assert (answer.code, answer.out) == (2, ""), case
        assert answer.err, case
        assert "Traceback" not in answer.err, case


def test_faults_are_told_all_at_once_but_not_by_the_hundred(coord: Any, planner: Any, monkeypatch: pytest.MonkeyPatch):
    """Fifty, and how many more there are."""
    module = ModuleType("coord.reading.problem_file")

    def read(path: Path) -> Problem:
        raise BadFileError(Fault(str(path), k, "robots", "is wrong") for k in range(MOST_FAULTS + 7))

    vars(module)["read_problem"] = read
    monkeypatch.setitem(sys.modules, "coord.reading.problem_file", module)
    planner(certified)
    lines = coord("plan", "x.toml").err.splitlines()
    assert len(lines) == MOST_FAULTS + 1
    assert lines[0] == "x.toml:0: robots: is wrong"
    assert lines[-1] == "and 7 more"


def test_a_defect_is_one_line_and_says_that_it_is_ours(
    coord: Any, planner: Any, problem: Path, monkeypatch: pytest.MonkeyPatch
):
    """Exit code 70; the traceback only for those who ask for it."""

    def broken(read: Problem, options: Options) -> Result:
        raise RuntimeError("two\nlines")

    planner(broken)
    answer = coord("plan", problem)
    assert (answer.code, answer.out, answer.err.count("\n")) == (70, "", 1)
    assert "a defect of coord" in answer.err
    assert answer.err.endswith("RuntimeError: two lines\n")
    monkeypatch.setenv("COORD_DEBUG", "1")
    assert "Traceback" in coord("plan", problem).err


def test_an_interrupt_ends_with_130(coord: Any, planner: Any, problem: Path):
    """As shells expect of a program that was stopped by Ctrl-C."""

    def interrupted(read: Problem, options: Options) -> Result:
        raise KeyboardInterrupt

    planner(interrupted)
    answer = coord("plan", problem)
    assert (answer.code, answer.out, answer.err) == (130, "", "interrupted\n")


def test_names_do_not_steer_the_terminal(coord: Any, planner: Any, problem: Path):
    """An escape sequence in a text is shown, not obeyed."""

    def odd(read: Problem, options: Options) -> Result:
        return Result(read, None, False, diagnoses=(Diagnosis("odd", (), "\x1b[31mred"),))

    planner(odd)
    assert r"\x1b[31mred" in coord("plan", problem).err


def test_a_problem_becomes_a_plan_that_the_checker_certifies(coord: Any, problem: Path):
    """The whole way with coord's own planner and checker: plan, verify, compare, draw, export."""
    answer = coord("plan", problem, "-o", "out", "--json")
    assert (answer.code, answer.err) == (0, "")
    assert json.loads(answer.out)["min_clearance"]["robots"] == ["red", "blue"]
    answer = coord("verify", "out/plan.json", "--problem", problem)
    assert (answer.code, answer.err) == (0, "")
    assert answer.out.startswith("certified: 2 robots")
    assert coord("plot", "out/plan.json", "--what", "profiles").code == 0
    assert coord("export", "out/plan.json", "--to", "csv", "-o", "out/plan.csv").code == 0


def test_who_stops_reading_does_not_change_the_answer(plan_file: Path):
    """``coord verify plan.json | head -0``: a closed pipe is no failure of the plan."""
    code = "import sys, coord.cli; sys.argv = ['coord', 'verify', sys.argv[1]]; coord.cli.main()"
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(plan_file)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    with process.stderr as errors:
        assert errors.read() == ""
    assert process.wait(timeout=60) == 0


@pytest.mark.parametrize(("verdict", "code"), [("certified", 0), ("refused", 4), ("undecided", 4), ("malformed", 2)])
def test_the_verdict_of_the_checker_is_the_exit_code_of_verify(
    coord: Any, checker: Any, plan_file: Path, verdict: str, code: int
):
    """Undecided is not certified; a malformed file is a bad file, with nothing on standard output."""
    checker(verdict)
    answer = coord("verify", plan_file, "--json")
    assert answer.code == code
    if code == 2:
        assert answer.out == ""
        assert "red comes too close to blue" in answer.err
    else:
        found = json.loads(answer.out)
        assert list(found) == ["certified", "verdict", "robots", "min_clearance", "faults", "differences"]
        assert (found["certified"], found["verdict"]) == (code == 0, verdict)
        assert found["faults"] == ([] if code == 0 else ["red comes too close to blue"])
        assert found["differences"] is None


def test_verify_compares_the_plan_with_a_problem(coord: Any, checker: Any, plan_file: Path, problem: Path):
    """Its own problem agrees; another speed is another problem, exit code 4."""
    checker("certified")
    answer = coord("verify", plan_file, "--problem", problem)
    assert (answer.code, answer.out.splitlines()[-1]) == (0, "the plan and the problem agree")
    problem.write_text(PROBLEM.replace("speed = 1.0", "speed = 1.1"))
    answer = coord("verify", plan_file, "--problem", problem)
    assert answer.code == 4
    assert 'robot "red": limits' in answer.out
    assert len(json.loads(coord("verify", plan_file, "--problem", problem, "--json").out)["differences"]) == 3


def test_plot_writes_a_picture_beside_the_plan_or_where_told(coord: Any, plan_file: Path, tmp_path: Path):
    """Messages go to stderr, and an older picture is replaced."""
    answer = coord("plot", plan_file, "--what", "workspace")
    assert (answer.code, answer.out) == (0, "")
    assert (tmp_path / "workspace.png").read_bytes().startswith(b"\x89PNG")
    assert coord("plot", plan_file, "--what", "st", "--robot", "blue", "-o", "deep/blue.png").code == 0
    assert (tmp_path / "deep/blue.png").read_bytes().startswith(b"\x89PNG")


def test_plot_refuses_what_it_cannot_draw(coord: Any, plan_file: Path, tmp_path: Path):
    """A robot that is not there, a kind of picture or of file that does not exist: exit code 2, and no file."""
    for args in (["st", "--robot", "ghost"], ["floor"], ["st", "-o", "x.pdf"]):
        answer = coord("plot", plan_file, "--what", *args)
        assert (answer.code, answer.out) == (2, "")
    assert "no robot is named" in coord("plot", plan_file, "--what", "st", "--robot", "ghost").err
    assert sorted(file.name for file in tmp_path.iterdir()) == ["lanes.toml", "plan.json"]


def test_export_writes_csv(coord: Any, plan_file: Path, problem: Path, tmp_path: Path):
    """One header, then each robot until its arrival, at the time step asked for."""
    assert coord("export", plan_file, "--to", "csv", "-o", "a.csv").code == 0
    assert coord("export", plan_file, "--to", "csv", "-o", "b.csv", "--dt", "0.5").code == 0
    rows = list(csv.DictReader((tmp_path / "b.csv").read_text().splitlines()))
    assert [row["t"] for row in rows[:3]] == ["0.0", "0.5", "1.0"]
    assert float(rows[-1]["t"]) == driven(read_problem(problem)).robots[1].arrival
    assert len((tmp_path / "a.csv").read_bytes().splitlines()) > 9 * len(rows)
    answer = coord("export", plan_file, "--to", "csv", "-o", "c.csv", "--dt", "0")
    assert answer.code == 2
    assert "time step" in answer.err
    assert not (tmp_path / "c.csv").exists()


def test_asking_for_help_loads_nothing_heavy():
    """``coord --help`` answers at once."""
    code = (
        "import sys, coord.cli\n"
        "sys.argv = ['coord', '--help']\n"
        "try:\n    coord.cli.main()\nexcept SystemExit as end:\n    assert not end.code\n"
        "heavy = {'numpy', 'casadi', 'ruckig', 'shapely', 'matplotlib', 'pydantic', 'rich', 'PIL', 'yaml'}\n"
        "sys.exit(str(heavy & set(sys.modules)) if heavy & set(sys.modules) else 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert all(command in done.stdout for command in ("plan", "verify", "plot", "export"))
