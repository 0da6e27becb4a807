"""The robots of a problem file: each robot's own fields, over [defaults], over the built-in defaults."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from coord.errors import InvalidValueError
from coord.model.arrays import Point
from coord.model.footprint import Footprint, polygon, square
from coord.model.robot import Limits, Robot
from coord.reading.form import DefaultsForm, RobotForm, sound_fields
from coord.reading.locate import KeyPath
from coord.reading.not_yet import without_refused
from coord.reading.report import Report

#: What a robot is where neither it nor [defaults] says otherwise: a disc [m], m/s, m/s2, m/s3, m.
BUILT_IN: Mapping[str, Any] = {
    "footprint": {"disc": 0.3},
    "speed": 1.0,
    "acceleration": 0.5,
    "jerk": 1.0,
    "corner_radius": 0.2,
    "weight": 1.0,
    "release": 0.0,
}

#: Stand in for what is missing or faulty, so that the other rules can be checked; never handed out.
_ANYBODY: Mapping[str, Any] = {"name": "?", "start": (0.0, 0.0), "goal": (0.0, 0.0)}

#: What a robot's shape depends on.
_SHAPE = frozenset({"footprint", "heading"})


@dataclass(frozen=True, slots=True)
class ReadRobot:
    """What was sound of one robot, k-th of the problem from 0; None for what was not, no via points likewise."""

    k: int
    robot: Robot | None
    footprint: Footprint | None
    start: Point | None
    goal: Point | None
    via: tuple[Point, ...]


def read_robots(tables: Mapping[int, dict[str, Any]], defaults: dict[str, Any], report: Report) -> list[ReadRobot]:
    """All robots, the faulty ones too as far as they are sound; their tables by their place in the problem, from 0."""
    path: KeyPath = ("defaults",)
    common = without_refused("robot", sound_fields(DefaultsForm, defaults, path, report), path, report)
    _, faults = _build({**_ANYBODY, **BUILT_IN, **common})
    told = _told(faults, common)
    report.add_rules(path, told)
    common = {key: value for key, value in common.items() if key not in dict(told)}
    _report_same_names(tables, report)
    # a shape that is faulty is not replaced: how near to others such a robot may stand is not known
    known = _SHAPE - (defaults.keys() - common.keys())
    return [_read_robot(k, table, {**BUILT_IN, **common}, known, report) for k, table in tables.items()]


def footprint_of(fields: Mapping[str, Any]) -> Footprint:
    """The footprint that the fields ``footprint`` and ``heading`` (may be missing) of a robot say.

    A square keeps its heading unless told otherwise, a polygon turns with the path; on a disc it means nothing.

    Raises
    ------
    InvalidValueError
        When there is no such shape.
    """
    shape = fields["footprint"]
    if "disc" in shape:
        return Footprint(shape["disc"])
    if "square" in shape:
        return square(shape["square"], fields.get("heading", "fixed"))
    return polygon(shape["polygon"], fields.get("heading", "path"))


def _read_robot(
    k: int, table: dict[str, Any], common: Mapping[str, Any], known: frozenset[str], report: Report
) -> ReadRobot:
    path: KeyPath = ("robots", k)
    own = without_refused("robot", sound_fields(RobotForm, table, path, report), path, report)
    for field in ("name", "start", "goal"):
        if field not in table:
            report.add(path, f"{field} is missing; every robot needs a {field}")
    fields = {**_ANYBODY, **common, **own}
    if "path" in own:  # it says it all: no side of [defaults], and no fault because of ends that nobody knows
        ends = {"start": own["path"][0], "goal": own["path"][-1]}
        fields = {**fields, "side": "quickest", **ends, **own}
    robot, faults = _build(fields)
    told = _told(faults, own)
    report.add_rules(path, told)
    sound = {key: value for key, value in own.items() if key not in dict(told)}
    whole = robot is not None and sound.keys() == table.keys() and all(field in own for field in _ANYBODY)
    shaped = all(field in sound if field in table else field in known for field in _SHAPE)
    return ReadRobot(
        k,
        robot if whole else None,
        footprint_of({**common, **sound}) if shaped else None,
        _point(sound.get("start")),
        _point(sound.get("goal")),
        tuple((x, y) for x, y in sound.get("via", ())),
    )


def _build(fields: Mapping[str, Any]) -> tuple[Robot | None, list[tuple[str, str]]]:
    """A robot from all its fields, or None and all (field, sentence) pairs of broken rules."""
    faults: list[tuple[str, str]] = []
    footprint, limits = Footprint(1.0), Limits(1.0, 1.0, 1.0, 1.0, 1.0)  # only while their own are faulty
    try:
        footprint = footprint_of(fields)
    except InvalidValueError as error:
        faults += error.faults
    acceleration = fields["acceleration"]
    try:
        limits = Limits(
            speed=fields["speed"],
            acceleration=acceleration,
            deceleration=fields.get("deceleration", acceleration),
            jerk=fields["jerk"],
            lateral_acceleration=fields.get("lateral_acceleration", acceleration),
        )
    except InvalidValueError as error:
        faults += error.faults
    plain = ("priority", "release", "weight", "side", "corner_radius")
    others = {key: fields[key] for key in plain if key in fields}
    others |= {key: tuple((x, y) for x, y in fields[key]) for key in ("via", "path") if key in fields}
    start, goal = tuple(fields["start"]), tuple(fields["goal"])
    try:
        robot = Robot(fields["name"], footprint, limits, start, goal, **others)
    except InvalidValueError as error:
        faults += error.faults
    return (None, faults) if faults else (robot, faults)


def _told(faults: Sequence[tuple[str, str]], given: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The faults of fields that were given; those of fields derived from them would say it twice."""
    return [(field, text) for field, text in faults if field in given]


def _point(pair: Sequence[float] | None) -> Point | None:
    return None if pair is None else (pair[0], pair[1])


def _report_same_names(tables: Mapping[int, dict[str, Any]], report: Report) -> None:
    """Say of each robot that bears the name of an earlier one which one that is."""
    first: dict[str, int] = {}
    for k, table in tables.items():
        name = table.get("name")
        if isinstance(name, str) and first.setdefault(name, k) != k:
            report.add(("robots", k, "name"), f"the name is taken by robots[{first[name] + 1}]; names must differ")
