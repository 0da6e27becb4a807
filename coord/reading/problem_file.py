"""Problem files: TOML in the format coord-problem/1, with the map and the robots file it names, into a problem."""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from coord.errors import BadFileError, Fault, InvalidValueError
from coord.model.problem import Problem
from coord.reading.checks import check_rests
from coord.reading.files import UnreadableError, read_bytes
from coord.reading.floor import read_floor
from coord.reading.form import FileForm, PlanForm, sound_fields
from coord.reading.not_yet import without_refused
from coord.reading.report import shown
from coord.reading.robots import read_robots
from coord.reading.robots_file import Rows, RowsReport, read_rows

_LARGEST = 2**26


def read_problem(path: Path) -> Problem:
    """Read a problem file, the map and the robots file it names, and check that it can be planned at all.

    Robots and obstacles are counted from 1 in what people are told: ``robots[7]`` is the seventh [[robots]] of the
    file; the rows of the robots file are counted on. Lines are those of the value at fault, or of the table where
    something is missing, or of the row. The problem's digest is that of ``digest`` over the problem file, its map,
    its map's image and its robots file.

    Raises
    ------
    BadFileError
        With all faults at once: form (keys, types, missing values), rules (a speed is positive), fields that are
        not supported yet, and places: starts, goals and via points outside the workspace or in an obstacle,
        starts or goals overlapping.
    """
    path = Path(path)
    try:
        data = read_bytes(path, _LARGEST)
    except UnreadableError as error:
        raise BadFileError([Fault(str(path), None, "", f"the problem file {error}")]) from None
    text, raw = _parse(str(path), data)
    rows, report = _begin(path, text, raw)
    top = without_refused("file", sound_fields(FileForm, raw, (), report), (), report)
    options = sound_fields(PlanForm, top.get("plan", {}), ("plan",), report)
    workspace = top.get("workspace", None if "workspace" in raw else {})
    floor = read_floor(workspace, top.get("obstacles", []), path.parent, report)
    tables = {**dict(enumerate(top.get("robots", []))), **dict(enumerate(rows.tables, report.first))}
    robots = read_robots(tables, top.get("defaults", {}), report)
    check_rests(robots, floor, report)
    if report:
        raise BadFileError(report.faults())
    whole = tuple(read.robot for read in robots if read.robot is not None)
    if len(whole) < len(robots):
        raise RuntimeError(f"{len(robots) - len(whole)} robots of {path} were left out without a fault")
    name = top.get("name", path.stem)
    total = digest((data, *floor.files, *rows.data))
    try:
        return Problem(name, floor.workspace, whole, floor.obstacles, options, total)
    except InvalidValueError as error:
        raise BadFileError(Fault(str(path), None, "", text) for _, text in error.faults) from None


def _begin(path: Path, text: str, raw: dict[str, Any]) -> tuple[Rows, RowsReport]:
    """The rows of the robots file, if the problem names one, and the report, with what is wrong so far."""
    rows, trouble = Rows(), ""
    name = raw.get("robots_file")
    if isinstance(name, str):
        try:
            rows = read_rows(path.parent / name)
        except UnreadableError as error:
            trouble = f"the robots file {shown(name)} {error}"
        except BadFileError as error:
            rows = Rows(faults=error.faults)
    report = RowsReport(str(path), text, raw, rows)
    if "format" not in raw:
        report.add((), 'format is missing; the file should begin with format = "coord-problem/1"')
    if trouble:
        report.add(("robots_file",), trouble)
    elif raw.get("robots", []) == [] and not (rows.tables or rows.faults):
        where = () if name is None else ("robots_file",)
        report.add(where, "a problem needs at least one robot, a table [[robots]] with name, start and goal")
    return rows, report


def digest(files: Iterable[bytes]) -> str:
    """SHA-256, as hexadecimal digits, over the bytes of files, each led by its length as 8 bytes, big end first."""
    total = hashlib.sha256()
    for data in files:
        total.update(len(data).to_bytes(8, "big"))
        total.update(data)
    return total.hexdigest()


def _parse(file: str, data: bytes) -> tuple[str, dict[str, Any]]:
    """The text of the file, with plain line ends, and its values."""
    try:
        text = data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line_of_byte = data.count(b"\n", 0, error.start) + 1
        raise BadFileError([Fault(file, line_of_byte, "", "the file is no text in UTF-8")]) from None
    try:
        return text, tomllib.loads(text)
    except RecursionError:
        raise BadFileError([Fault(file, None, "", "the file is nested too deeply")]) from None
    except ValueError as error:  # TOMLDecodeError, and Python's own for integers of thousands of digits
        raise BadFileError([_no_toml(file, text, str(error))]) from None


def _no_toml(file: str, text: str, said: str) -> Fault:
    """What tomllib said, with the line taken out of its sentence."""
    place = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)", said)
    line: int | None = None
    if place is not None:
        said = said[: place.start()]
        line = int(place[1]) if place[1] else text.count("\n") + (not text.endswith("\n"))
    said = {"Cannot overwrite a value": "this key is given twice"}.get(said, said)
    return Fault(file, line, "", f"this is no TOML: {said}")
