"""Problems of dynobench and db-CBS: boxes on a floor, robots by the name of their model.

Models, shapes and limits are those of github.com/quimortiz/dynobench, folder models. What coord has no word for is
dropped and said: headings at start and goal, driving backwards, limits of turning, trailers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import yaml

from coord.errors import BadFileError, Fault
from coord.importing.text import read_text
from coord.importing.values import DRIVE, ImportOptions
from coord.output.problem_file import Draft, Fields
from coord.reading.report import shown

#: [m] Radius of robots whose model is not known.
_RADIUS = 0.2

#: [m] A box of 0.5 x 0.25 about the middle, the x axis along the path.
_BOX: Final[Fields] = {
    "footprint": {"polygon": [[-0.25, -0.125], [0.25, -0.125], [0.25, 0.125], [-0.25, 0.125]]},
    "heading": "path",
}


def _disc(radius: float, **limits: float) -> Fields:
    return {"footprint": {"disc": radius}, "speed": 0.5, **limits}


#: What is known of the models on a floor.
_MODELS: Final[Mapping[str, Fields]] = {
    "unicycle_first_order_0": {**_BOX, "speed": 0.5},
    "unicycle1_v0": {**_BOX, "speed": 0.5},
    "unicycle_first_order_0_sphere": _disc(0.4),
    "unicycle1_sphere_v0": _disc(0.4),
    "unicycle_second_order_0": {**_BOX, "speed": 0.5, "acceleration": 0.25},
    "unicycle2_v0": {**_BOX, "speed": 0.5, "acceleration": 0.25},
    "differential_drive_v0": _disc(0.1),
    "single_integrator_0": _disc(0.1),
    "integrator1_2d_v0": _disc(0.3),
    "double_integrator_0": _disc(0.1, acceleration=2.0),
    "integrator2_2d_v0": _disc(0.1, acceleration=2.0),
    "car_first_order_0": {**_BOX, "speed": 0.5},
    "car_first_order_with_1_trailers_0": {**_BOX, "speed": 0.5},
    "car1_v0": {**_BOX, "speed": 0.5},
}
#: Words in the names of models that fly, or carry something together.
_NOT_ON_A_FLOOR = ("quad", "3d", "joint", "payload", "rods", "cables")
_TRAILERS = ("car_first_order_with_1_trailers_0", "car1_v0")


@dataclass(slots=True)
class _Reader:
    """Walks over the nodes of the file and collects faults with their lines."""

    file: str
    faults: list[Fault]

    def fault(self, node: yaml.Node, subject: str, text: str) -> None:
        self.faults.append(Fault(self.file, node.start_mark.line + 1, subject, text))

    def table(self, node: yaml.Node, subject: str, keys: tuple[str, ...]) -> dict[str, yaml.Node]:
        """The entries of a mapping; those that must be there and are not are faults."""
        if not isinstance(node, yaml.MappingNode):
            self.fault(node, subject, f"must have the keys {', '.join(keys)}")
            return {}
        entries = {str(key.value): value for key, value in node.value}
        for key in keys:
            if key not in entries:
                self.fault(node, subject, f"{key} is missing")
        return entries

    def items(self, node: yaml.Node | None, subject: str) -> list[yaml.Node]:
        if node is None:
            return []
        if not isinstance(node, yaml.SequenceNode):
            self.fault(node, subject, "must be a list")
            return []
        return list(node.value)

    def numbers(self, node: yaml.Node | None, subject: str, least: int) -> list[float] | None:
        """A list of at least so many finite numbers."""
        if node is None:
            return None
        try:
            values = [float(item.value) for item in node.value] if isinstance(node, yaml.SequenceNode) else []
        except (TypeError, ValueError):
            values = []
        if len(values) < least or not all(math.isfinite(value) for value in values):
            self.fault(node, subject, f"must be a list of {least} finite numbers or more")
            return None
        return values

    def text(self, node: yaml.Node | None) -> str:
        return str(node.value) if isinstance(node, yaml.ScalarNode) else ""


def dynobench_draft(source: Path, folder: Path, options: ImportOptions) -> Draft:
    """A problem of dynobench; its boxes become rectangles.

    Raises
    ------
    BadFileError
        With all faults, when it is no such problem, is not on a floor, or has robots that move together.
    """
    reader = _Reader(str(source), [])
    top = reader.table(compose(source), "", ("environment", "robots"))
    environment = reader.table(top["environment"], "environment", ("min", "max")) if "environment" in top else {}
    low, high = (reader.numbers(environment.get(key), f"environment: {key}", 2) for key in ("min", "max"))
    if low is not None and len(low) > 2:
        reader.fault(environment["min"], "environment", "is in three dimensions; coord plans on a floor")
    obstacles = [
        table
        for k, node in enumerate(reader.items(environment.get("obstacles"), "environment: obstacles"), start=1)
        if (table := _obstacle(reader, node, k)) is not None
    ]
    unknown: dict[str, None] = {}
    nodes = reader.items(top.get("robots"), "robots")
    robots = [_robot(reader, node, k, options.radius, unknown) for k, node in enumerate(nodes)]
    if reader.faults or low is None or high is None:
        raise BadFileError(reader.faults)
    found = [robot for robot in robots if robot is not None]
    kinds = list(dict.fromkeys(str(robot["type"]) for robot in found))
    wider = _overhang(found, (*low[:2], *high[:2]))
    bounds = [value - wider for value in low[:2]] + [value + wider for value in high[:2]]
    defaults, found = _common(found)
    return Draft(
        name=source.stem,
        remarks=tuple(_remarks(source, kinds, unknown, wider)),
        workspace={"bounds": bounds, "clearance": 0.0},
        defaults=defaults,
        robots=tuple({key: value for key, value in robot.items() if key != "type"} for robot in found),
        obstacles=tuple(obstacles),
    )


def compose(source: Path) -> yaml.Node:
    """The nodes of a YAML file.

    Raises
    ------
    BadFileError
        When the file cannot be read, or is no YAML.
    """
    try:
        top = yaml.compose(read_text(source), Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        text = f"this is no YAML: {getattr(error, 'problem', None) or error}"
        raise BadFileError([Fault(str(source), mark.line + 1 if mark else None, "", text)]) from None
    except RecursionError:
        raise BadFileError([Fault(str(source), None, "", "the file is nested too deeply")]) from None
    if top is None:
        raise BadFileError([Fault(str(source), None, "", "the file is empty")])
    return top


def _obstacle(reader: _Reader, node: yaml.Node, k: int) -> Fields | None:
    subject = f"obstacles[{k}]"
    entries = reader.table(node, subject, ("type", "center"))
    kind = reader.text(entries.get("type"))
    center = reader.numbers(entries.get("center"), f"{subject}: center", 2)
    if kind != "box":
        if "type" in entries:
            reader.fault(entries["type"], subject, f'type must be "box" (got {shown(kind)})')
        return None
    if "size" not in entries:
        reader.fault(node, subject, "size is missing")
    size = reader.numbers(entries.get("size"), f"{subject}: size", 2)
    if center is None or size is None:
        return None
    (x, y), (width, height) = center[:2], size[:2]
    return {"name": f"box {k}", "rectangle": [x - width / 2, y - height / 2, x + width / 2, y + height / 2]}


def _robot(
    reader: _Reader, node: yaml.Node, k: int, radius: float | None, unknown: dict[str, None]
) -> dict[str, object] | None:
    subject = f"robots[{k + 1}]"
    entries = reader.table(node, subject, ("type", "start", "goal"))
    kind = reader.text(entries.get("type"))
    start, goal = (reader.numbers(entries.get(key), f"{subject}: {key}", 2) for key in ("start", "goal"))
    if start is None or goal is None:
        return None
    if any(word in kind.lower() for word in _NOT_ON_A_FLOOR):
        reader.fault(entries["type"], subject, f"{shown(kind)} does not drive on a floor by itself")
        return None
    model: Fields = _MODELS.get(kind, _disc(_RADIUS, speed=DRIVE["speed"]))
    if kind not in _MODELS:
        unknown[kind] = None
    if radius is not None:
        model = {key: value for key, value in model.items() if key != "heading"} | {"footprint": {"disc": radius}}
    return {"name": f"r{k}", "start": start[:2], "goal": goal[:2], "type": kind, **DRIVE, **model}


def _common(robots: list[dict[str, object]]) -> tuple[Fields, list[dict[str, object]]]:
    """What all robots have in common, and the robots without it."""
    keys = [key for key in ("footprint", "heading", *DRIVE) if robots and all(key in robot for robot in robots)]
    common: dict[str, Any] = {key: robots[0][key] for key in keys if all(r[key] == robots[0][key] for r in robots)}
    return common, [{key: value for key, value in robot.items() if key not in common} for robot in robots]


def _overhang(robots: Iterable[Mapping[str, Any]], bounds: tuple[float, ...]) -> float:
    """How far robots at rest reach over the edge [m], to a whole centimetre: dynobench bounds their middles only."""
    xmin, ymin, xmax, ymax = bounds
    most = 0.0
    for robot in robots:
        shape = robot["footprint"]
        reach = shape.get("disc") or max(math.hypot(x, y) for x, y in shape["polygon"])
        for x, y in (robot["start"], robot["goal"]):
            most = max(most, reach - min(x - xmin, y - ymin, xmax - x, ymax - y))
    return math.ceil(most * 100 - 1e-6) / 100


def _remarks(source: Path, kinds: list[str], unknown: Iterable[str], wider: float) -> list[str]:
    remarks = [
        f"Imported from {source.name}, a problem of dynobench with robots of the type {', '.join(kinds)}.",
        "Dropped: the headings at start and goal, driving backwards, limits of turning and of steering.",
        f"Where the model has no acceleration, it is {DRIVE['acceleration']:g} m/s2; no model has a jerk.",
    ]
    if unknown:
        remarks.append(
            f"Nothing is known here of {', '.join(unknown)}: discs of {_RADIUS:g} m, {DRIVE['speed']:g} m/s."
        )
    if wider:
        remarks.append(f"The floor is {wider:g} m wider on all sides: dynobench bounds the middles of robots only.")
    if any(kind in _TRAILERS for kind in kinds):
        remarks.append("Dropped: trailers; a robot is its car alone.")
    return remarks
