"""Well-known text: one geometry a line, with a name before a colon if it has one."""

from __future__ import annotations

import re
from pathlib import Path

from coord.errors import BadFileError, Fault
from coord.geometry.cutting import polygons_of_wkt, rings_fault
from coord.importing.polygons import MARGIN, bounds_of, obstacle_tables, robot_between
from coord.importing.text import read_text
from coord.importing.values import DRIVE, RADIUS, ImportOptions
from coord.output.problem_file import Draft, Fields
from coord.reading.report import shown

_LINE = re.compile(r"(?:(?P<name>[^:(]*):)?\s*(?P<geometry>[A-Za-z]+.*)")


def wkt_draft(source: Path, folder: Path, options: ImportOptions) -> Draft:
    """Obstacles from the polygons of all lines; empty lines and those that begin with # are passed over.

    Raises
    ------
    BadFileError
        With all faults of the lines, or when there is no polygon.
    """
    tables: list[Fields] = []
    faults: list[Fault] = []
    others = 0
    corners: list[list[float]] = []
    for number, line in enumerate(read_text(source).splitlines(), start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        match = _LINE.fullmatch(line.strip())
        try:
            if match is None:
                raise ValueError("it begins with no geometry")
            polygons, rest = polygons_of_wkt(match["geometry"])
        except ValueError as error:
            faults.append(Fault(str(source), number, "", f"this is no well-known text: {error} (got {shown(line)})"))
            continue
        others += rest
        found = [fault for rings in polygons if (fault := rings_fault(rings))]
        faults += [Fault(str(source), number, "", fault) for fault in found]
        if polygons and not found:
            tables += obstacle_tables((match["name"] or "").strip() or f"obstacle {number}", polygons)
            corners += [corner for rings in polygons for corner in rings[0].tolist()]
    if not faults and not tables:
        faults.append(Fault(str(source), None, "", "there is no polygon in it, so nothing to import"))
    if faults:
        raise BadFileError(faults)
    bounds = bounds_of(corners, MARGIN + 2 * (options.radius or RADIUS))
    remarks = [f"Imported from {source.name}."]
    if others:
        remarks.append(f"Left out, points and lines, which cover no floor: {others}.")
    return Draft(
        name=source.stem,
        remarks=tuple(remarks),
        workspace={"bounds": list(bounds), "clearance": 0.0},
        defaults={"footprint": {"disc": options.radius or RADIUS}, **DRIVE},
        robots=(robot_between(tables, bounds, source, options),),
        obstacles=tuple(tables),
    )
