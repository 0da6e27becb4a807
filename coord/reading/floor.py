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
from coord.reading.files import UnreadableError
from coord.reading.form import ObstacleForm, WorkspaceForm, sound_fields
from coord.reading.not_yet import without_refused
from coord.reading.report import Report, shown
from coord.reading.ros_map import RosMap, map_obstacles, read_ros_map

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
    ros_map = _map(fields, folder, report)
    if workspace is not None and not workspace.keys() & {"bounds", "map"}:
        report.add(path, "bounds = [xmin, ymin, xmax, ymax] are missing; only with a map they may be left out")
    given: dict[str, Any] = {key: fields[key] for key in ("bounds", "clearance", "after_arrival") if key in fields}
    if ros_map is not None:
        given = {"bounds": ros_map.bounds, **given}
    space, bounded = _workspace(given, report)
    found = [_obstacle(table, k, report) for k, table in enumerate(obstacles)]
    if ros_map is not None:
        found += report.attempt(("workspace", "map"), lambda: map_obstacles(ros_map)) or []
    sound = tuple(obstacle for obstacle in found if obstacle is not None)
    return Floor(space, bounded, sound, ros_map.files if ros_map else ())


def _map(fields: dict[str, Any], folder: Path, report: Report) -> RosMap | None:
    if "map" not in fields:
        return None
    try:
        return read_ros_map(folder / fields["map"], fields.get("unknown", "occupied"))
    except UnreadableError as error:
        report.add(("workspace", "map"), f"the map {shown(fields['map'])} {error}")
    except BadFileError as error:
        report.add_faults(error.faults)
    return None


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
