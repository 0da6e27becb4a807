"""GeoJSON (RFC 7946): polygons become obstacles, points robots, lines given paths.

Properties say what a feature is: ``name`` of an obstacle; ``role`` "workspace" of a polygon that is the floor itself;
``robot`` (a name) of a point with ``role`` "start", "goal" or "via", or of a line that is its path. A robot's
start may carry its limits, named as the fields of a problem file.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from coord.errors import BadFileError, Fault
from coord.geometry.cutting import rest_of_box
from coord.importing.features import Findings, Position, collect
from coord.importing.metres import fault_of_degrees, origin_for
from coord.importing.polygons import MARGIN, bounds_of, obstacle_tables, robot_between
from coord.importing.text import read_text
from coord.importing.values import DRIVE, RADIUS, ImportOptions
from coord.output.problem_file import Draft, Fields, outline

#: [m] Coordinates that were moved are written with this many decimals.
_DECIMALS = 9


def geojson_draft(source: Path, folder: Path, options: ImportOptions) -> Draft:
    """A floor plan drawn as GeoJSON, in metres.

    Coordinates far from the origin, as those of national grids, are moved there, and the text says by how much.

    Raises
    ------
    BadFileError
        With all faults: no GeoJSON, coordinates in degrees, polygons that are not simple, robots without start or goal.
    """
    document = _document(source)
    found = collect(document)
    faults = [Fault(str(source), None, subject, text) for subject, text in found.faults]
    corners = [point for rings in (*found.floors, *found.all_obstacles()) for point in rings[0]]
    corners += [point for robot in found.robots.values() for point in robot.places()]
    if not corners and not faults:
        faults.append(Fault(str(source), None, "", "there are neither polygons nor robots in it, so nothing to import"))
    degrees = "" if faults else fault_of_degrees(corners, document, options.metres)
    if degrees:
        faults.append(Fault(str(source), None, "", degrees))
    faults += [
        Fault(str(source), None, f'robot "{robot.name}"', text)
        for robot in found.robots.values()
        if (text := robot.fault())
    ]
    if faults:
        raise BadFileError(faults)
    origin = origin_for(corners)
    moved = found.moved(lambda point: _moved(point, origin))
    return _draft(source, moved, origin, options)


def _draft(source: Path, found: Findings, origin: Position, options: ImportOptions) -> Draft:
    radius = options.radius or RADIUS
    if found.floors:
        bounds = bounds_of((point for rings in found.floors for point in rings[0]), 0.0)
        rest = rest_of_box(bounds, found.floors)
    else:
        corners = [point for rings in found.all_obstacles() for point in rings[0]]
        corners += [point for robot in found.robots.values() for point in robot.places()]
        bounds, rest = bounds_of(corners, MARGIN + 2 * radius), []
    tables = [table for name, polygons in found.obstacles for table in obstacle_tables(name, polygons)]
    tables += [outline(f"outside, part {k}", ring.tolist()) for k, ring in enumerate(rest, start=1)]
    robots: list[Fields] = [robot.table() for robot in found.robots.values()]
    if not robots:
        robots.append(robot_between(tables, bounds, source, options))
    return Draft(
        name=source.stem,
        remarks=tuple(_remarks(source, found, origin)),
        workspace={"bounds": list(bounds), "clearance": 0.0},
        defaults={"footprint": {"disc": radius}, **DRIVE},
        robots=tuple(robots),
        obstacles=tuple(tables),
    )


def _remarks(source: Path, found: Findings, origin: Position) -> Iterator[str]:
    yield f"Imported from {source.name}; its coordinates are taken for metres."
    if origin != (0.0, 0.0):
        yield f"Moved to the origin: subtract ({origin[0]:.0f}, {origin[1]:.0f}) m from its coordinates to get these."
    if found.others:
        yield f"Left out, points and lines that belong to no robot: {found.others}."


def _moved(point: Position, origin: Position) -> Position:
    if origin == (0.0, 0.0):
        return point
    return (round(point[0] - origin[0], _DECIMALS), round(point[1] - origin[1], _DECIMALS))


def _document(source: Path) -> dict[str, Any]:
    try:
        document = json.loads(read_text(source))
    except json.JSONDecodeError as error:
        raise BadFileError([Fault(str(source), error.lineno, "", f"this is no JSON: {error.msg}")]) from None
    except (RecursionError, ValueError):
        raise BadFileError(
            [Fault(str(source), None, "", "the file is nested too deeply, or a number too long")]
        ) from None
    if not isinstance(document, dict) or not isinstance(document.get("type"), str):
        raise BadFileError([Fault(str(source), 1, "", 'this is no GeoJSON: it should be an object with a "type"')])
    return document
