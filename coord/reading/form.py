"""The form of a problem file: which keys there are and what kind of value each takes.

Only the form: the rules (a speed is positive, names differ) live in the constructors of ``coord.model``. Each
field's description says what it takes; it is what a person reads when something else is given.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from coord.reading.locate import KeyPath
from coord.reading.report import Report, shown
from coord.tolerances import LARGEST_COORDINATE

Number = Annotated[float, Field(allow_inf_nan=False)]
Coordinate = Annotated[float, Field(allow_inf_nan=False, ge=-LARGEST_COORDINATE, le=LARGEST_COORDINATE)]
Place = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
Box = Annotated[list[Coordinate], Field(min_length=4, max_length=4)]
Bounds = Annotated[list[Number], Field(min_length=4, max_length=4)]
Table = dict[str, Any]


def _takes(description: str, **rules: Any) -> Any:
    return Field(default=None, description=description, **rules)


class Form(BaseModel):
    """A table of the file; a key that may be missing is None."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)


class FileForm(Form):
    """The top of the file."""

    format: Literal["coord-problem/1"] | None = _takes('"coord-problem/1"')
    name: str | None = _takes("a text")
    robots_file: str | None = _takes("the name of a CSV file")
    workspace: Table | None = _takes("one table, written [workspace]")
    plan: Table | None = _takes("one table, written [plan]")
    defaults: Table | None = _takes("one table, written [defaults]")
    robots: list[Table] | None = _takes("a list of tables, each written [[robots]] with two brackets")
    obstacles: list[Table] | None = _takes("a list of tables, each written [[obstacles]] with two brackets")


class WorkspaceForm(Form):
    """The table [workspace]."""

    bounds: Bounds | None = _takes("[xmin, ymin, xmax, ymax], four numbers in m")
    clearance: Number | None = _takes("a number in m")
    after_arrival: str | None = _takes('"stay" or "leave"')
    map: str | None = _takes("the name of a file")
    resolution: Number | None = _takes("a number in m")
    occupied_below: Number | None = _takes("a number between 0 and 1")
    unknown: Literal["occupied", "free"] | None = _takes('"occupied" or "free"')


class PlanForm(Form):
    """The table [plan]: the options of the plan command, which checks their values."""

    method: str | None = _takes("a text")
    shape: str | None = _takes("a text")
    order: str | None = _takes("a text")
    profile: str | None = _takes("a text")
    time_limit: Number | None = _takes("a number in s")
    gap_target: Number | None = _takes("a number")
    seed: int | None = _takes("a whole number")
    keep_paths: bool | None = _takes("true or false")
    certify: bool | None = _takes("true or false")
    plots: bool | None = _takes("true or false")


class FootprintForm(Form):
    """What a robot is shaped like: one of the three."""

    disc: Number | None = _takes("a number in m, the radius")
    square: Number | None = _takes("a number in m, the side")
    polygon: list[Place] | None = _takes("a list of points [x, y] in m")

    @model_validator(mode="after")
    def _one(self) -> FootprintForm:
        if len(self.model_fields_set) != 1:
            raise ValueError("not one shape")
        return self


class DefaultsForm(Form):
    """The table [defaults]: what robots may have in common."""

    footprint: FootprintForm | None = _takes("one of { disc = radius }, { square = side }, { polygon = [[x, y], ...] }")
    heading: Literal["fixed", "path"] | None = _takes('"fixed" or "path"')
    speed: Number | None = _takes("a number in m/s")
    acceleration: Number | None = _takes("a number in m/s2")
    deceleration: Number | None = _takes("a number in m/s2")
    jerk: Number | None = _takes("a number in m/s3")
    lateral_acceleration: Number | None = _takes("a number in m/s2")
    corner_radius: Number | None = _takes("a number >= 0 in m", ge=0)
    weight: Number | None = _takes("a number")
    release: Number | None = _takes("a number in s")
    side: Literal["quickest", "left", "right"] | None = _takes('"quickest", "left" or "right"')


class RobotForm(DefaultsForm):
    """A table [[robots]]."""

    name: str | None = _takes("a text")
    start: Place | None = _takes("[x, y], two numbers in m")
    goal: Place | None = _takes("[x, y], two numbers in m")
    priority: Number | None = _takes("a number")
    via: list[Place] | None = _takes("a list of points [x, y] in m")
    path: list[Place] | None = _takes("a list of two points [x, y] or more in m", min_length=2)


class CircleForm(Form):
    """A round obstacle."""

    center: Place | None = _takes("[x, y], two numbers in m")
    radius: Number | None = _takes("a number in m")

    @model_validator(mode="after")
    def _both(self) -> CircleForm:
        if self.center is None or self.radius is None:
            raise ValueError("a part is missing")
        return self


class ObstacleForm(Form):
    """A table [[obstacles]]."""

    name: str | None = _takes("a text")
    rectangle: Box | None = _takes("[xmin, ymin, xmax, ymax], four numbers in m")
    angle: Number | None = _takes("a number in rad")
    circle: CircleForm | None = _takes("{ center = [x, y], radius = r } in m")
    polygon: list[Place] | None = _takes("a list of points [x, y] in m")


_TABLES: dict[str, type[Form]] = {
    "at the top of the file": FileForm,
    "in [workspace]": WorkspaceForm,
    "in [plan]": PlanForm,
    "in [[robots]]": RobotForm,
    "in [[obstacles]]": ObstacleForm,
}
_INNER: dict[str, type[Form]] = {"footprint": FootprintForm, "circle": CircleForm}
_LISTS = ("polygon", "via", "path", "robots", "obstacles")


def sound_fields(form: type[Form], table: Mapping[str, Any], path: KeyPath, report: Report) -> dict[str, Any]:
    """The fields of a table that have the right form; one fault is reported for each of the others."""
    try:
        return _given(form.model_validate(table), table)
    except ValidationError as error:
        faulty: set[object] = set()
        for fault in error.errors(include_url=False):
            place = fault["loc"]
            if fault["type"] == "extra_forbidden" or place[0] not in faulty:
                report.add((*path, *place), _sentence(form, table, fault["type"], place, fault["input"]))
            faulty.add(place[0])
    sound = {key: value for key, value in table.items() if key not in faulty}
    return _given(form.model_validate(sound), sound)


def _given(model: BaseModel, keys: Iterable[str]) -> dict[str, Any]:
    """The fields that stand in the file, in its order, tables of fields as dictionaries."""
    fields = {key: getattr(model, key) for key in keys}
    return {
        key: _given(value, sorted(value.model_fields_set)) if isinstance(value, Form) else value
        for key, value in fields.items()
    }


def _sentence(form: type[Form], table: Mapping[str, Any], kind: str, place: KeyPath, given: object) -> str:
    field, names = str(place[0]), [str(part) for part in place if isinstance(part, str)]
    inner = _INNER[field] if len(names) > 1 and field in _INNER else None
    if kind == "extra_forbidden":
        return unknown(inner or form, names[-1])
    label = ".".join(names)
    got, indices = shown(given), [part for part in place if isinstance(part, int)]
    if indices and names[-1] in _LISTS:
        got += f" as item {indices[0] + 1}"
    elif indices and inner is None:
        got = shown(table[field])  # of a point or a box, the whole is clearer than one number
    if kind == "finite_number":
        return f"{label} must be finite (got {got})"
    if kind in ("less_than_equal", "greater_than_equal") and indices:
        return f"{label} must stay within {LARGEST_COORDINATE:g} m of the origin (got {got}); move the origin nearer"
    return f"{label} must be {(inner or form).model_fields[names[-1]].description} (got {got})"


@lru_cache(maxsize=256)
def unknown(form: type[Form], key: str, what: str = "key") -> str:
    """An unknown key, or column of a file of robots: where it belongs, or what may have been meant."""
    places = [place for place, other in _TABLES.items() if key in other.model_fields]
    near = difflib.get_close_matches(key[:100], list(form.model_fields), n=1)
    if places:
        hint = f"; it belongs {places[0]}"
    else:
        hint = f'; did you mean "{near[0]}"?' if near else f"; known are {', '.join(form.model_fields)}"
    return f"unknown {what} {shown(key)}{hint}"
