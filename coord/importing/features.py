"""The features of a GeoJSON document, sorted by what they mean to a problem."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

from coord.geometry.cutting import rings_fault
from coord.output.problem_file import Fields
from coord.reading.form import DefaultsForm
from coord.reading.report import shown

Position: TypeAlias = tuple[float, float]
Rings: TypeAlias = list[list[Position]]

#: Deeper nesting of geometries is a slip, and could end the walk.
_DEEPEST = 50

#: What a robot's start may say of it.
_ROBOT_FIELDS = (*DefaultsForm.model_fields, "priority")


class _ShapeError(ValueError):
    """A geometry is not of its form; the text says what."""


@dataclass(slots=True)
class DrawnRobot:
    """A robot as drawn: places [m], and the fields that its features say."""

    name: str
    start: Position | None = None
    goal: Position | None = None
    via: list[Position] = field(default_factory=list)
    path: list[Position] = field(default_factory=list)
    fields: dict[str, Any] = field(default_factory=dict)

    def places(self) -> list[Position]:
        """All places it names."""
        return [*filter(None, (self.start, self.goal)), *self.via, *self.path]

    def fault(self) -> str:
        """Why it is no robot of a problem, or nothing."""
        if not self.path:
            missing = [word for word in ("start", "goal") if getattr(self, word) is None]
            return f'has no {" and no ".join(missing)}: a point with role "start" or "goal"' if missing else ""
        if self.start not in (None, self.path[0]) or self.goal not in (None, self.path[-1]):
            return "its path does not begin at its start and end at its goal"
        return "it has a path, so it cannot have via points" if self.via else ""

    def table(self) -> Fields:
        """Its table in a problem file."""
        start, goal = (self.start or self.path[0]), (self.goal or self.path[-1])
        table: dict[str, object] = {"name": self.name, "start": list(start), "goal": list(goal)}
        if self.via:
            table["via"] = [list(point) for point in self.via]
        if self.path:
            table["path"] = [list(point) for point in self.path]
        return {**table, **self.fields}


@dataclass(slots=True)
class Findings:
    """What features mean: obstacles by name, outlines of the floor, robots, how many say nothing, and faults."""

    obstacles: list[tuple[str, list[Rings]]] = field(default_factory=list)
    floors: list[Rings] = field(default_factory=list)
    robots: dict[str, DrawnRobot] = field(default_factory=dict)
    others: int = 0
    faults: list[tuple[str, str]] = field(default_factory=list)

    def all_obstacles(self) -> list[Rings]:
        """Every polygon of every obstacle."""
        return [rings for _, polygons in self.obstacles for rings in polygons]

    def moved(self, move: Callable[[Position], Position]) -> Findings:
        """The same elsewhere."""

        def all_of(rings: Rings) -> Rings:
            return [[move(point) for point in ring] for ring in rings]

        robots = {
            name: replace(
                robot,
                start=robot.start and move(robot.start),
                goal=robot.goal and move(robot.goal),
                via=[move(point) for point in robot.via],
                path=[move(point) for point in robot.path],
            )
            for name, robot in self.robots.items()
        }
        obstacles = [(name, [all_of(rings) for rings in polygons]) for name, polygons in self.obstacles]
        return replace(self, obstacles=obstacles, floors=[all_of(rings) for rings in self.floors], robots=robots)


def collect(document: dict[str, Any]) -> Findings:
    """All features of a document: a collection of them, one of them, or a geometry by itself."""
    found = Findings()
    for number, feature in enumerate(_features(document), start=1):
        if not isinstance(feature, dict):
            found.faults.append((f"features[{number}]", f"a feature is an object (got {shown(feature)})"))
            continue
        given = feature.get("properties")
        properties: dict[str, Any] = given if isinstance(given, dict) else {}
        name = properties.get("name")
        called = f"features[{number}]" + (f" {shown(name)}" if isinstance(name, str) else "")
        try:
            singles = list(_singles(feature.get("geometry"), 0))
            polygons = [_polygon(single["coordinates"]) for single in singles if single["type"] == "Polygon"]
            if polygons:
                _add_polygons(found, polygons, properties, str(name) if name else f"obstacle {number}")
            for single in singles:
                if single["type"] != "Polygon":
                    _add_drawn(found, single, properties)
        except _ShapeError as error:
            found.faults.append((called, str(error)))
    return found


def _add_polygons(found: Findings, polygons: list[Rings], properties: dict[str, Any], name: str) -> None:
    for rings in polygons:
        if fault := rings_fault(rings):
            raise _ShapeError(fault)
    if properties.get("role") == "workspace":
        found.floors += polygons
    else:
        found.obstacles.append((name, polygons))


def _add_drawn(found: Findings, single: dict[str, Any], properties: dict[str, Any]) -> None:
    """A point or a line: a place or the path of a robot, or nothing of use."""
    name, role = properties.get("robot"), properties.get("role")
    if name is None or (single["type"] == "Point" and role is None):
        found.others += 1
        return
    robot = found.robots.setdefault(str(name), DrawnRobot(str(name)))
    given = {key: properties[key] for key in _ROBOT_FIELDS if properties.get(key) is not None}
    if odd := [key for key, value in given.items() if not _is_plain(value)]:
        raise _ShapeError(f"{odd[0]} is nothing that a problem file can say (got {shown(given[odd[0]])})")
    robot.fields |= given
    if single["type"] == "LineString":
        if robot.path:
            raise _ShapeError(f"the robot {shown(str(name))} has a path already")
        robot.path = _line(single["coordinates"])
        return
    place = _position(single["coordinates"])
    if role == "via":
        robot.via.append(place)
    elif role in ("start", "goal"):
        if getattr(robot, role) is not None:
            raise _ShapeError(f"the robot {shown(str(name))} has a {role} already")
        setattr(robot, role, place)
    else:
        raise _ShapeError(f'role of a robot\'s point must be "start", "goal" or "via" (got {shown(role)})')


def _is_plain(value: Any) -> bool:
    if isinstance(value, dict):
        return all(key.isidentifier() and key.isascii() and _is_plain(item) for key, item in value.items())
    if isinstance(value, list):
        return all(_is_plain(item) for item in value)
    return isinstance(value, bool | int | float | str)


def _features(document: dict[str, Any]) -> list[Any]:
    if document["type"] == "FeatureCollection":
        features = document.get("features")
        return features if isinstance(features, list) else []
    return [document] if document["type"] == "Feature" else [{"geometry": document}]


def _singles(geometry: Any, level: int) -> Iterator[dict[str, Any]]:
    """Polygons, lines and points, each with its coordinates, out of a geometry of any kind."""
    if geometry is None:
        return
    if not isinstance(geometry, dict) or level > _DEEPEST:
        raise _ShapeError(f"a geometry is an object (got {shown(geometry)})")
    kind = geometry.get("type")
    if kind == "GeometryCollection":
        for part in _list(geometry.get("geometries")):
            yield from _singles(part, level + 1)
    elif kind in ("Polygon", "LineString", "Point"):
        yield {"type": kind, "coordinates": geometry.get("coordinates")}
    elif kind in ("MultiPolygon", "MultiLineString", "MultiPoint"):
        for coordinates in _list(geometry.get("coordinates")):
            yield {"type": kind.removeprefix("Multi"), "coordinates": coordinates}
    else:
        raise _ShapeError(f"a geometry of the type {shown(kind)} is unknown")


def _list(value: Any) -> list[Any]:
    if not isinstance(value, list):
        raise _ShapeError(f"coordinates must be a list (got {shown(value)})")
    return value


def _position(value: Any) -> Position:
    numbers = _list(value)
    if len(numbers) < 2 or any(isinstance(n, bool) or not isinstance(n, int | float) for n in numbers[:2]):
        raise _ShapeError(f"a position is [x, y], two numbers (got {shown(value)})")
    try:
        x, y = float(numbers[0]), float(numbers[1])
    except OverflowError:
        x = y = math.inf
    if not (math.isfinite(x) and math.isfinite(y)):
        raise _ShapeError(f"a position must be finite (got {shown(value)})")
    return (x, y)


def _line(value: Any) -> list[Position]:
    points = [_position(item) for item in _list(value)]
    if len(points) < 2:
        raise _ShapeError("a line needs at least 2 positions")
    return points


def _polygon(value: Any) -> Rings:
    """Outline and holes, the last corner not repeated."""
    rings = []
    for ring in _list(value):
        points = [_position(item) for item in _list(ring)]
        if len(points) > 1 and points[0] == points[-1]:
            points.pop()
        if len(points) < 3:
            raise _ShapeError(f"an outline needs at least 3 different corners (got {len(points)})")
        rings.append(points)
    if not rings:
        raise _ShapeError("a polygon needs an outline")
    return rings
