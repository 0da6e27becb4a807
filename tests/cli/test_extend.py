"""``coord plan --extend``: what is written and said, and which files are refused."""

from __future__ import annotations

import json
import sys

import pytest

from coord.cli import main

HEAD = """
format = "coord-problem/1"
name = "hall"
[workspace]
bounds = [0.0, 0.0, 12.0, 8.0]
clearance = 0.05
[defaults]
footprint = { disc = 0.3 }
speed = 1.0
acceleration = 0.5
jerk = 1.0
"""

RED = '[[robots]]\nname = "red"\nstart = [1.0, 1.0]\ngoal = [11.0, 1.0]\n'
BLUE = '[[robots]]\nname = "blue"\nstart = [6.0, 7.0]\ngoal = [6.0, 3.0]\n'
NEW = '[[robots]]\nname = "new"\nstart = [1.0, 5.0]\ngoal = [11.0, 5.0]\n'

#: It stands on red's way and may not leave before red has passed.
LATE = '[[robots]]\nname = "late"\nstart = [8.0, 1.0]\ngoal = [8.0, 7.0]\nrelease = 60.0\n'


@pytest.fixture
def coord(tmp_path, monkeypatch, capsys):
    """Runs ``coord`` in a folder of its own, in this process: exit code, standard output, standard error."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("COORD_DEBUG", raising=False)

    def run(*args):
        monkeypatch.setattr(sys, "argv", ["coord", *map(str, args)])
        with pytest.raises(SystemExit) as ended:
            main()
        captured = capsys.readouterr()
        return int(ended.value.code or 0), captured.out, captured.err

    return run


@pytest.fixture
def write(tmp_path):
    """Writes a problem of some robots, and gives its path."""

    def write(name, *robots):
        file = tmp_path / f"{name}.toml"
        file.write_text(HEAD + "".join(robots))
        return file

    return write


@pytest.fixture
def older(coord, write, tmp_path):
    """A plan of red and blue."""
    assert coord("plan", write("two", RED, BLUE), "-o", "old")[0] == 0
    return tmp_path / "old" / "plan.json"


def robots_of(file):
    """The lines of each robot in a plan file, by name."""
    body = file.read_text().split('"robots": [\n ', 1)[1].split('\n],\n"order"', 1)[0]
    parts = [f'{{"name"{text}'.rstrip(",\n ") for text in body.split('{"name"')[1:]]
    return {json.loads(part)["name"]: part for part in parts}


def test_the_others_keep_their_lines_and_the_new_robot_is_named(coord, write, older, tmp_path):
    """Of three robots one is planned; the text of the others' records is the same, and the table counts all three."""
    code, out, err = coord("plan", write("three", RED, NEW, BLUE), "--extend", older, "-o", "out")
    assert code == 0
    assert "3 of 3" in out
    assert err.splitlines() == ["kept: 2 robots", 'planned: "new": the plan lacks it']
    before, after = robots_of(older), robots_of(tmp_path / "out" / "plan.json")
    assert list(after) == ["red", "new", "blue"]
    assert {name: after[name] for name in before} == before
    assert coord("verify", "out/plan.json", "--problem", "three.toml")[0] == 0


def test_the_object_names_who_was_kept_planned_and_dropped(coord, write, older):
    """With --json: the same keys as ever, and "extended" last; nothing on standard error."""
    changed = BLUE.replace("3.0", "2.5")
    code, out, err = coord("plan", write("other", NEW, changed), "--extend", older, "--json")
    found = json.loads(out)
    assert (code, err) == (0, "")
    assert list(found)[-1] == "extended"
    assert found["extended"] == {
        "kept": [],
        "planned": [
            {"robot": "new", "reason": "the plan lacks it"},
            {"robot": "blue", "reason": "its goal changed"},
        ],
        "dropped": ["red"],
        "priority_unheeded": [],
    }
    assert found["arrived"] == 2
    assert "extended" not in json.loads(coord("plan", "other.toml", "--json")[1])


def test_changes_are_told_in_sentences(coord, write, older):
    """A robot that changed, one that is gone, and a priority that only a full run heeds."""
    robots = (BLUE + "priority = 1\n", NEW)
    code, _, err = coord("plan", write("other", *robots), "--extend", older)
    assert code == 0
    assert err.splitlines() == [
        "kept: 1 robot",
        'planned: "new": the plan lacks it',
        'dropped: "red": the problem has it no more',
        'the priority of "blue" has changed: a matter for a full run',
    ]


def test_a_robot_that_cannot_join_ends_with_the_reason_and_the_remedy(coord, write, older, tmp_path):
    """Exit code 1, both robots named, and the full run that is advised works."""
    problem = write("late", RED, BLUE, LATE)
    code, out, err = coord("plan", problem, "--extend", older, "-o", "out")
    assert (code, out) == (1, "")
    assert "cannot-join (late, red at (8.00, 1.00) m at" in err
    assert "Plan all robots anew, without extending" in err
    assert json.loads((tmp_path / "out" / "diagnosis.json").read_text())["diagnoses"][0]["code"] == "cannot-join"
    code, out, _ = coord("plan", problem, "--extend", older, "-o", "out", "--json")
    found = json.loads(out)
    assert (code, found["certified"], found["order"]) == (1, False, None)
    assert found["extended"]["kept"] == ["red", "blue"]
    assert coord("plan", problem, "-o", "out")[0] == 0


def test_a_plan_may_be_extended_where_it_stands(coord, write, older, tmp_path):
    """Written over the plan that was read; a second time nothing is new, and not a byte changes."""
    problem = write("three", RED, NEW, BLUE)
    assert coord("plan", problem, "--extend", older, "-o", "old")[0] == 0
    first = older.read_bytes()
    code, _, err = coord("plan", problem, "--extend", older, "-o", "old")
    assert (code, err) == (0, "kept: 3 robots\n")
    assert older.read_bytes() == first
    assert sorted(path.name for path in (tmp_path / "old").iterdir()) == ["plan.json"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("{", "not JSON"),
        ('{"format": "coord-plan/2"}', "format"),
        ('{"format": "coord-diagnosis/1", "diagnoses": []}', "format"),
        ("[]", "plan.json"),
    ],
)
def test_what_is_no_plan_is_a_bad_file(coord, write, tmp_path, text, says):
    """Exit code 2 and the reader's message with the file's name; nothing is written."""
    file = tmp_path / "plan.json"
    file.write_text(text)
    code, out, err = coord("plan", write("two", RED, BLUE), "--extend", file, "-o", "out")
    assert (code, out) == (2, "")
    assert str(file) in err
    assert says in err
    assert not (tmp_path / "out").exists()


def test_a_missing_plan_is_a_bad_file(coord, write):
    """Exit code 2, and which file it was."""
    code, _, err = coord("plan", write("two", RED, BLUE), "--extend", "nowhere.json")
    assert code == 2
    assert "nowhere.json" in err


def test_a_plan_that_is_not_certified_is_refused(coord, write, older):
    """Red's bound is above its arrival: exit code 4, with what the checker found and what to do."""
    document = json.loads(older.read_text())
    document["robots"][0]["solo_bound"] += 100.0
    older.write_text(json.dumps(document))
    code, out, err = coord("plan", write("three", RED, NEW, BLUE), "--extend", older)
    assert (code, out) == (4, "")
    assert "not certified" in err
    assert "solo_bound" in err
    assert "without --extend" in err


def test_a_method_without_an_order_cannot_extend(coord, write, older):
    """Exit code 2, and what can."""
    code, _, err = coord("plan", write("three", RED, NEW, BLUE), "--extend", older, "--method", "nearest")
    assert code == 2
    assert '"velocity" or "stop"' in err


def test_many_names_are_counted(coord, write, older):
    """Of thirty new robots twenty are named."""
    rows = [
        f'[[robots]]\nname = "n{k}"\nstart = [{1 + (k % 10)}.0, {3 + k // 10}.5]\ngoal = [{1 + (k % 10)}.0, {3 + k // 10}.6]\n'
        for k in range(30)
        if (k % 10, k // 10) not in {(5, 0), (5, 1), (5, 2)}
    ]
    code, _, err = coord("plan", write("many", RED, *rows), "--extend", older)
    assert code == 0, err
    assert err.splitlines()[0] == "kept: 1 robot"
    assert err.splitlines()[-1] == "and 8 more"
