"""Imports of texts and bytes, read back as problems."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from coord.errors import BadFileError
from coord.importing.choose import write_import
from coord.importing.values import ImportOptions
from coord.model.problem import Problem
from coord.reading.problem_file import read_problem


class Brought(NamedTuple):
    """What an import left behind: the problem as read from its file, its text, and the remarks."""

    problem: Problem
    text: str
    remarks: tuple[str, ...]


@pytest.fixture
def bring(tmp_path: Path) -> Callable[..., Brought]:
    """Writes a file, imports it, reads the problem file that came out."""

    def run(name: str, content: str | bytes, **options: Any) -> Brought:
        source, output = tmp_path / name, tmp_path / "made" / "problem.toml"
        source.write_bytes(content.encode() if isinstance(content, str) else content)
        remarks = write_import(source, output, ImportOptions(**options))
        return Brought(read_problem(output), output.read_text(encoding="utf-8"), remarks)

    return run


@pytest.fixture
def refused(bring: Callable[..., Brought], tmp_path: Path) -> Callable[..., list[str]]:
    """The faults of an import as people see them, without the folder."""

    def run(name: str, content: str | bytes, **options: Any) -> list[str]:
        with pytest.raises(BadFileError) as caught:
            bring(name, content, **options)
        assert not (tmp_path / "made" / "problem.toml").exists()
        return [str(fault).replace(f"{tmp_path}/", "") for fault in caught.value.faults]

    return run
