"""Scenarios of the Moving AI Lab: a map and rows of starts and goals in cells.

A row is: bucket, map, width and height of the map, start x and y, goal x and y, length. Cells are counted from the
upper left corner, from 0; a robot stands in the middle of its cell.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coord.errors import BadFileError, Fault
from coord.importing.maps import CELL_SHARE, read, relative
from coord.importing.text import read_text
from coord.importing.values import DRIVE, ImportOptions
from coord.model.arrays import Point
from coord.output.problem_file import Draft
from coord.reading.grid_map import GridMap, read_movingai
from coord.reading.report import shown
from coord.tolerances import DISTANCE

#: Robots taken where the user does not say how many.
_ROBOTS = 10

_COLUMNS = ("bucket", "map", "width", "height", "start x", "start y", "goal x", "goal y", "length")


@dataclass(frozen=True, slots=True)
class Row:
    """One row: its number among the rows, from 1, the line it stands on, the map, its size, and cells (x, y)."""

    number: int
    line: int
    map: str
    size: tuple[int, int]
    start: tuple[int, int]
    goal: tuple[int, int]


def scenario_draft(source: Path, folder: Path, options: ImportOptions) -> Draft:
    """A scenario: its map, and the first rows whose robots have room and stand in nobody's way.

    Raises
    ------
    BadFileError
        With all faults of the rows, when the map is not found or of another size, or when no robot is left.
    """
    rows = _rows(source)
    file = options.map or _beside(source, rows[0])
    size = options.resolution or 1.0
    grid = read(file, lambda: read_movingai(file, size))
    height, width = grid.occupied.shape
    if rows[0].size != (width, height):
        text = f"the row is for a map of {rows[0].size[0]} x {rows[0].size[1]} cells, {file} has {width} x {height}"
        raise BadFileError([Fault(str(source), rows[0].line, "", text)])
    radius = options.radius or CELL_SHARE * size
    wanted = options.robots or _ROBOTS
    taken, left_out = _taken(rows, grid, radius, wanted)
    if not taken:
        reasons = "; ".join(f"{reason}: {count}" for reason, count in left_out.items())
        raise BadFileError([Fault(str(source), rows[0].line, "", f"no robot has room ({reasons})")])
    return Draft(
        name=source.stem,
        remarks=tuple(_remarks(source, file, rows, taken, left_out, wanted, options)),
        workspace={"map": relative(file, folder), "resolution": size, "clearance": 0.0},
        defaults={"footprint": {"disc": radius}, **DRIVE},
        robots=tuple(
            {
                "name": f"robot {row.number}",
                "start": list(_centre(row.start, grid)),
                "goal": list(_centre(row.goal, grid)),
            }
            for row in taken
        ),
    )


def _rows(source: Path) -> list[Row]:
    text = read_text(source)
    lines = [(number, line.rstrip()) for number, line in enumerate(text.splitlines(), start=1)]
    if lines and lines[0][1].split()[:1] == ["version"]:
        if lines[0][1].split()[1:] not in (["1"], ["1.0"]):
            raise BadFileError([Fault(str(source), 1, "", f"version must be 1 (got {shown(lines[0][1][8:])})")])
        lines = lines[1:]
    rows: list[Row] = []
    faults: list[Fault] = []
    for number, line in lines:
        if not line:
            continue
        try:
            rows.append(_row(line, number, len(rows) + 1))
        except ValueError:
            text = f"a row is {', '.join(_COLUMNS)}, with whole numbers >= 0 for cells (got {shown(line)})"
            faults.append(Fault(str(source), number, "", text))
    if faults:
        raise BadFileError(faults)
    if not rows:
        raise BadFileError([Fault(str(source), None, "", "the scenario has no rows")])
    return rows


def _row(line: str, number: int, count: int) -> Row:
    cells = line.split("\t") if "\t" in line else line.split()
    if len(cells) != len(_COLUMNS):
        raise ValueError(line)
    width, height, *places = (int(cell) for cell in cells[2:8])
    if min(width, height) < 1 or min(places) < 0:
        raise ValueError(line)
    float(cells[8])
    return Row(count, number, cells[1].strip(), (width, height), (places[0], places[1]), (places[2], places[3]))


def _beside(source: Path, row: Row) -> Path:
    """The map that a row names, in the folder of the scenario; its own folders may be missing there."""
    for file in (source.parent / row.map, source.parent / Path(row.map).name):
        if file.is_file():
            return file
    text = f"the map {shown(row.map)} is not found beside the scenario; say where it is with --map"
    raise BadFileError([Fault(str(source), row.line, "", text)])


def _taken(rows: Sequence[Row], grid: GridMap, radius: float, wanted: int) -> tuple[list[Row], Counter[str]]:
    """The first rows that fit, and why others before the last of them do not."""
    taken: list[Row] = []
    left_out: Counter[str] = Counter()
    for row in rows:
        if len(taken) == wanted:
            break
        reason = _reason(row, rows[0], taken, grid, radius)
        if reason:
            left_out[reason] += 1
        else:
            taken.append(row)
    return taken, left_out


def _reason(row: Row, first: Row, taken: Sequence[Row], grid: GridMap, radius: float) -> str:
    """Why a row cannot be taken, or nothing."""
    if row.map != first.map or row.size != first.size:
        return "on another map"
    for which in ("start", "goal"):
        place = _centre(getattr(row, which), grid)
        if not _has_room(place, grid, radius):
            return f"{which} without room"
        others = np.array([_centre(getattr(other, which), grid) for other in taken]).reshape(-1, 2)
        if (np.hypot(*(others - place).T) < 2 * radius - DISTANCE).any():
            return f"{which} too near to that of a robot taken before"
    return ""


def _has_room(place: Point, grid: GridMap, radius: float) -> bool:
    """Whether a disc on a map touches no occupied cell and nothing beyond the edge."""
    rows, columns = grid.occupied.shape
    size = grid.resolution
    x, y = (place[0] - grid.origin[0]) / size, (place[1] - grid.origin[1]) / size
    reach = (radius - DISTANCE) / size
    if min(x, y, columns - x, rows - y) < reach:
        return False
    left, low = max(0, int(x - reach)), max(0, int(y - reach))
    window = grid.occupied[low : int(y + reach) + 1, left : int(x + reach) + 1]
    r, c = (index.astype(float) for index in np.nonzero(window))
    dx = np.maximum(np.maximum(c + left - x, x - c - left - 1), 0.0)
    dy = np.maximum(np.maximum(r + low - y, y - r - low - 1), 0.0)
    return not (np.hypot(dx, dy) < reach).any()


def _centre(cell: tuple[int, int], grid: GridMap) -> Point:
    """The middle of a cell (x, y), y counted downwards from the top [m]."""
    size = grid.resolution
    return (size * (cell[0] + 0.5), size * (grid.occupied.shape[0] - cell[1] - 0.5))


def _remarks(
    source: Path,
    file: Path,
    rows: Sequence[Row],
    taken: Sequence[Row],
    left_out: Counter[str],
    wanted: int,
    options: ImportOptions,
) -> list[str]:
    counts = f"{len(taken)} of its {len(rows)} rows, named by their number"
    remarks = [f"Imported from {source.name} with the map {file.name}: {counts}."]
    if left_out:
        reasons = ", ".join(f"{reason} ({count})" for reason, count in left_out.items())
        remarks.append(f"Left out of the first {len(taken) + left_out.total()} rows: {reasons}.")
    if len(taken) < wanted:
        remarks.append(f"No more than {len(taken)} robots fit.")
    elif options.robots is None and len(taken) < len(rows):
        remarks.append("More rows are imported with --robots.")
    return remarks
