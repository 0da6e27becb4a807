"""Robots as rows of a CSV file: the columns are a robot's fields, the cells hold values as TOML writes them."""

from __future__ import annotations

import csv
import io
import tomllib
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coord.errors import BadFileError, Fault
from coord.reading.files import read_bytes
from coord.reading.form import RobotForm, unknown
from coord.reading.locate import KeyPath
from coord.reading.report import Report, shown

_LARGEST = 2**26

#: Columns whose cells are texts, so that nobody has to write quotes within quotes.
_TEXTS = ("name", "side", "heading")
_NEEDED = ("name", "start", "goal")


@dataclass(frozen=True, slots=True)
class Rows:
    """The robots of one file.

    Parameters
    ----------
    file : its name, as people are told it.
    tables : the fields of each robot, as [[robots]] of a problem file would give them; ``lines`` : where they begin.
    faults : of the file as a table. data : its bytes, none where there is no such file.
    """

    file: str = ""
    tables: tuple[dict[str, Any], ...] = ()
    lines: tuple[int, ...] = ()
    faults: tuple[Fault, ...] = ()
    data: tuple[bytes, ...] = ()


class RowsReport(Report):
    """The faults of a problem whose last robots are rows: told with the name of their file and the line of the row.

    Robots are counted on from those of the problem file; ``first`` is the place of the first row's, from 0.
    """

    def __init__(self, file: str, text: str, raw: dict[str, Any], rows: Rows) -> None:
        own = raw.get("robots")
        tables = own if isinstance(own, list) else []
        super().__init__(file, text, {**raw, "robots": [*tables, *rows.tables]})
        self.first = len(tables)
        self._rows = rows
        self._told = list(rows.faults)

    def __bool__(self) -> bool:
        return bool(self._told) or super().__bool__()

    def add(self, path: KeyPath, text: str) -> None:
        """Note a broken rule, as a sentence, at a place."""
        k = path[1] if len(path) > 1 and path[0] == "robots" else -1
        if isinstance(k, int) and k >= self.first:
            self._told.append(Fault(self._rows.file, self._rows.lines[k - self.first], self.subject(path), text))
        else:
            super().add(path, text)

    def faults(self) -> list[Fault]:
        """All faults: those of the problem file, of the files it names, and of the rows from top to bottom."""
        return super().faults() + sorted(self._told, key=lambda fault: fault.line or 0)


def read_rows(file: Path) -> Rows:
    """Read a CSV file of robots: the first row names the columns, an empty cell is a field that is not given.

    Cells hold TOML: ``0.3``, ``"[1.0, 2.0]"`` (quotes of CSV, for its comma), ``{ disc = 0.3 }``; a bare word is
    taken as a text where a text belongs. What is no TOML is handed on as a text, and refused with the field's form.

    Raises
    ------
    UnreadableError
        When there is no such regular file, or it is too large.
    BadFileError
        When it is no text in UTF-8, or no CSV.
    """
    data = read_bytes(file, _LARGEST)
    records = _records(str(file), data)
    if not records:
        return Rows(str(file), faults=(_missing(str(file), 1, []),), data=(data,))
    (line, header), *rest = records
    faults = list(_header_faults(str(file), line, header))
    if not set(_NEEDED) <= set(header):
        return Rows(str(file), faults=tuple(faults), data=(data,))
    tables, lines = [], []
    for line, cells in rest:
        if len(cells) > len(header):
            text = f"the row has {len(cells)} cells, but there are {len(header)} columns"
            text += '; a cell with a comma in it stands in quotes: "[1.0, 2.0]"'
            faults.append(Fault(str(file), line, "", text))
            continue
        named = zip(header, cells, strict=False)
        tables.append({field: _value(field, cell) for field, cell in named if cell and field in RobotForm.model_fields})
        lines.append(line)
    return Rows(str(file), tuple(tables), tuple(lines), tuple(faults), (data,))


def _records(file: str, data: bytes) -> list[tuple[int, list[str]]]:
    """The rows that are not blank, each with the line it begins on; cells stripped, none empty at the end."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise BadFileError([Fault(file, line, "", "the file is no text in UTF-8")]) from None
    reader = csv.reader(io.StringIO(text, newline=""), strict=True, skipinitialspace=True)
    records, line = [], 1
    try:
        for row in reader:
            cells = [cell.strip() for cell in row]
            while cells and not cells[-1]:
                cells.pop()
            if cells:
                records.append((line, cells))
            line = reader.line_num + 1
    except csv.Error as error:
        raise BadFileError([Fault(file, line, "", f"this is no CSV: {error}")]) from None
    return records


def _header_faults(file: str, line: int, header: Sequence[str]) -> Iterator[Fault]:
    for k, name in enumerate(header):
        if not name:
            yield Fault(file, line, "", f"column {k + 1} has no name")
    for name, count in Counter(filter(None, header)).items():
        if name not in RobotForm.model_fields:
            yield Fault(file, line, "", unknown(RobotForm, name, "column"))
        elif count > 1:
            yield Fault(file, line, "", f"the column {shown(name)} stands {count} times")
    if not set(_NEEDED) <= set(header):
        yield _missing(file, line, header)


def _missing(file: str, line: int, header: Sequence[str]) -> Fault:
    missing = " and ".join(name for name in _NEEDED if name not in header)
    hint = "; columns are separated by commas" if any(";" in name or "\t" in name for name in header) else ""
    return Fault(file, line, "", f"the first row names the columns, and {missing} must be among them{hint}")


def _value(field: str, cell: str) -> object:
    if field in _TEXTS and cell[0] not in "\"'":
        return cell
    try:
        table = tomllib.loads(f"value = {cell}")
    except (ValueError, RecursionError):
        return cell
    return table["value"] if len(table) == 1 else cell
