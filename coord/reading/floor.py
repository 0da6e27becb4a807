"""The floor of a problem file: workspace, map and obstacles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coord.errors import BadFileError, InvalidValueError
from coord.geometry.shapes import polygon_fault
from coord.model.arrays import frozen
from coord.model.obstacle import Circle, Obstacle, Polygon, rectangle
from coord.model.problem import Workspace
from coord.model.rules import range_fault
from coord.reading.files import UnreadableError
from coord.reading.form import ObstacleForm, WorkspaceForm, sound_fields
from coord.reading.grid_map import GridMap, map_obstacles, read_movingai, read_picture
from coord.reading.not_yet import without_refused
from coord.reading.report import Report, shown
from coord.reading.ros_map import read_ros_map
from coord.tolerances import LARGEST_COORDINATE, SMALLEST_RADIUS

#: What kind of map a file is, by its ending; any other is an image.
_KINDS = {".yaml": "ROS map", ".yml": "ROS map", ".map": "MovingAI map"}

#: Fields that say how to read a map, and the kinds they belong to.
_BELONGS = {"unknown": ["ROS map"], "resolution": ["MovingAI map", "image"], "occupied_below": ["image"]}
_GRID_DEFAULTS = {"unknown": "occupied", "resolution": 1.0, "occupied_below": 0.5}

#: Stands in for bounds that are missing or faulty, so that the other rules can be checked; never handed out.
_ANY_BOUNDS = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class Floor:
    """What was sound of the floor.

    Parameters
    ----------
    workspace : faulty fields have given way to their defaults.
    bounded : whether the workspace's bounds are those of the file; if not, they mean nothing.
    files : the bytes of the map's files, in the order in which they name each other.
    """

    workspace: Workspace
    bounded: bool
    obstacles: tuple[Obstacle, ...]
    files: tuple[bytes, ...] = ()


def read_floor(
    workspace: dict[str, Any] | None, obstacles: Sequence[dict[str, Any]], folder: Path, report: Report
) -> Floor:
    """The floor from the tables [workspace] (None: it is no table) and [[obstacles]]; files relative to the folder."""
    path = ("workspace",)
    fields = without_refused("workspace", sound_fields(WorkspaceForm, workspace or {}, path, report), path, report)
    grid = _map(fields, folder, report)
    if workspace is not None and not workspace.keys() & {"bounds", "map"}:
        report.add(path, "bounds = [xmin, ymin, xmax, ymax] are missing; only with a map they may be left out")
    given: dict[str, Any] = {key: fields[key] for key in ("bounds", "clearance", "after_arrival") if key in fields}
    if grid is not None:
        given = {"bounds": grid.bounds, **given}
    space, bounded = _workspace(given, report)
    found = [_obstacle(table, k, report) for k, table in enumerate(obstacles)]
    if grid is not None:
        found += report.attempt(("workspace", "map"), lambda: map_obstacles(grid)) or []
    sound = tuple(obstacle for obstacle in found if obstacle is not None)
    return Floor(space, bounded, sound, grid.files if grid else ())


def _map(fields: dict[str, Any], folder: Path, report: Report) -> GridMap | None:
    """The map, read by the reader for its kind of file; what belongs to another kind is a fault."""
    name = fields.get("map", "")
    kind = "" if not name else _KINDS.get(Path(name).suffix.lower(), "image")
    for field, kinds in _BELONGS.items():
        if field in fields and kind not in kinds:
            report.add(
                ("workspace", field), f"{field} belongs to a map that is {_named(kinds)} (this is {_named([kind])})"
            )
    values = {**_GRID_DEFAULTS, **fields}
    if kind == "image" and "resolution" not in fields:
        report.add(("workspace", "map"), "a map that is an image needs resolution, the side of a cell in m")
        return None
    if not name or any(_range_faults(values, report)):
        return None
    file = folder / name
    try:
        if kind == "ROS map":
            return read_ros_map(file, values["unknown"])
        if kind == "MovingAI map":
            return read_movingai(file, values["resolution"])
        return read_picture(file, values["resolution"], values["occupied_below"])
    except UnreadableError as error:
        report.add(("workspace", "map"), f"the map {shown(name)} {error}")
    except BadFileError as error:
        report.add_faults(error.faults)
    return None


def _range_faults(values: dict[str, Any], report: Report) -> list[str]:
    """Faults of the numbers that say how to read a map, reported."""
    rules = {
        "resolution": range_fault("resolution", values["resolution"], " m", SMALLEST_RADIUS, LARGEST_COORDINATE),
        "occupied_below": range_fault("occupied_below", values["occupied_below"], "", 0.0, 1.0),
    }
    faults = [(field, fault) for field, fault in rules.items() if fault is not None]
    report.add_rules(("workspace",), faults)
    return [fault for _, fault in faults]


def _named(kinds: Sequence[str]) -> str:
    names = {"ROS map": "a ROS map (.yaml)", "MovingAI map": "a MovingAI map (.map)", "image": "an image", "": "no map"}
    return " or ".join(names[kind] for kind in kinds)


def _workspace(given: dict[str, Any], report: Report) -> tuple[Workspace, bool]:
    """The workspace without its faulty fields, and whether its bounds are known."""
    fields = {"bounds": _ANY_BOUNDS, **given}
    try:
        return Workspace(**{**fields, "bounds": tuple(fields["bounds"])}), "bounds" in given
    except InvalidValueError as error:
        report.add_rules(("workspace",), error.faults)
        faulty = {field for field, _ in error.faults}
        return _workspace({key: value for key, value in given.items() if key not in faulty}, report)


def _obstacle(table: dict[str, Any], k: int, report: Report) -> Obstacle | None:
    """The obstacle that is k-th in the file, from 0, or None when something is wrong with it."""
    path = ("obstacles", k)
    fields = sound_fields(ObstacleForm, table, path, report)
    kinds = [kind for kind in ("rectangle", "circle", "polygon") if kind in table]
    if not kinds and fields.keys() != table.keys():
        return None  # a misspelt key, reported already, may have been meant
    if len(kinds) != 1:
        got = " and ".join(kinds) or "none"
        report.add(path, f"an obstacle is one of rectangle, circle, polygon (got {got})")
    elif "angle" in table and kinds != ["rectangle"]:
        report.add((*path, "angle"), f"angle belongs to a rectangle (this is a {kinds[0]})")
    elif fields.keys() == table.keys():
        name = fields.get("name", f"obstacle {k + 1}")
        return report.attempt(path, lambda: _shape(name, kinds[0], fields))
    return None


def _shape(name: str, kind: str, fields: dict[str, Any]) -> Obstacle:
    if kind == "rectangle":
        return rectangle(name, tuple(fields[kind]), fields.get("angle", 0.0))
    if kind == "circle":
        return Circle(name, tuple(fields[kind]["center"]), fields[kind]["radius"])
    polygon = Polygon(name, frozen(fields[kind], 2))
    if fault := polygon_fault(frozen(fields[kind], 2)):
        raise InvalidValueError([(kind, fault)])
    return polygon
