import json
from collections.abc import Callable
from pathlib import Path

import pytest

from coord.errors import BadFileError
from coord.model.result import Plan, Result
from coord.output.files import prepare, read_plan, replacing, save, write


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_certified_plan_is_written_as_the_bytes_that_were_verified(
    tmp_path: Path, sample: Plan, result_of: Callable[..., Result]
):
    """What is on disk is what the checker has seen, and it reads back."""
    result = result_of(sample)
    written = save(tmp_path / "deep" / "er", result)
    assert written.read_bytes() == result.document
    assert names(written.parent) == ["plan.json"]
    assert read_plan(written).order == sample.order


def test_a_certified_plan_removes_an_older_diagnosis(tmp_path: Path, sample: Plan, result_of: Callable[..., Result]):
    """A folder says one thing: there is a plan."""
    (tmp_path / "diagnosis.json").write_text("{}")
    save(tmp_path, result_of(sample))
    assert names(tmp_path) == ["plan.json"]


def test_without_a_plan_an_older_plan_is_kept_under_another_name(tmp_path: Path, failure: Result):
    """Nobody takes the plan of an older run for the answer to this one, and nothing is lost."""
    (tmp_path / "plan.json").write_text("older")
    (tmp_path / "plan.old.json").write_text("oldest")
    save(tmp_path, failure)
    assert names(tmp_path) == ["diagnosis.json", "plan.old.json"]
    assert (tmp_path / "plan.old.json").read_text() == "older"
    diagnosis = json.loads((tmp_path / "diagnosis.json").read_bytes())
    assert diagnosis["problem"] == {"name": "sample", "digest": "ab12"}
    assert [entry["code"] for entry in diagnosis["diagnoses"]] == ["no_way"]


def test_a_plan_that_is_not_certified_is_not_written(tmp_path: Path, sample: Plan, result_of: Callable[..., Result]):
    """Nothing is written then but the diagnosis."""
    save(tmp_path, result_of(sample, certified=False))
    assert names(tmp_path) == ["diagnosis.json"]


def half_written(target: Path) -> None:
    with replacing(target) as stream:
        stream.write(b"half")
        raise KeyboardInterrupt


def test_a_file_that_is_not_finished_never_appears(tmp_path: Path):
    """When writing fails half way the older file stands unharmed, and no rest is left behind."""
    target = tmp_path / "plan.json"
    target.write_text("older")
    with pytest.raises(KeyboardInterrupt):
        half_written(target)
    assert target.read_text() == "older"
    assert names(tmp_path) == ["plan.json"]


def test_a_link_stays_a_link(tmp_path: Path):
    """The file that the link names gets the bytes."""
    real, link = tmp_path / "real.json", tmp_path / "link.json"
    real.write_text("older")
    link.symlink_to(real)
    write(link, b"new")
    assert link.is_symlink()
    assert real.read_bytes() == b"new"


def test_a_device_is_written_directly():
    """/dev/null stays what it is; a rename would replace it."""
    write(Path("/dev/null"), b"gone")
    assert Path("/dev/null").is_char_device()


def test_places_that_cannot_be_used_are_bad_files(tmp_path: Path):
    """A folder, a file that is not there, a file where a folder is needed: each ends in a sentence with its name."""
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(BadFileError, match="cannot be written: it is a folder"):
        write(tmp_path, b"")
    with pytest.raises(BadFileError, match="cannot be written"):
        write(blocked / "plan.json", b"")
    with pytest.raises(BadFileError, match="cannot be written"):
        prepare(blocked)
    with pytest.raises(BadFileError, match="cannot be read: no such file"):
        read_plan(tmp_path / "none.json")
    with pytest.raises(BadFileError, match="cannot be read"):
        read_plan(tmp_path)


def test_preparing_a_folder_leaves_nothing_in_it(tmp_path: Path):
    """It only proves that the folder can be written."""
    prepare(tmp_path / "plans" / "x")
    assert names(tmp_path / "plans" / "x") == []
