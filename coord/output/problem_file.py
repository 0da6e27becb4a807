"""Problem files, written so that a person likes to read and edit them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from coord.geometry.cutting import simple_parts
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle
from coord.model.problem import Problem
from coord.model.robot import Robot

FORMAT: Final = "coord-problem/1"

#: Lines of a file are wrapped here, as far as its numbers allow.
_WIDTH: Final = 110

_LIMITS = ("speed", "acceleration", "deceleration", "jerk", "lateral_acceleration")
#: Fields that robots often have in common; what all of them have goes to [defaults].
_COMMON = ("footprint", "heading", *_LIMITS, "corner_radius", "weight", "release", "side")

Fields = Mapping[str, object]


@dataclass(frozen=True, slots=True)
class Draft:
    """A problem as it shall stand in its file: tables of plain values, in the order in which they are written.

    Parameters
    ----------
    remarks : sentences for the top of the file, written as comments.
    robots, obstacles : tables; the key "#" is no field but a comment above the table.
    """

    name: str
    remarks: tuple[str, ...] = ()
    workspace: Fields = field(default_factory=dict)
    plan: Fields = field(default_factory=dict)
    defaults: Fields = field(default_factory=dict)
    robots: tuple[Fields, ...] = ()
    obstacles: tuple[Fields, ...] = ()


def written(draft: Draft) -> str:
    """The text of a problem file. Numbers read back exactly; values are not checked, reading does that."""
    blocks = ["\n".join([*_comments(draft.remarks), f"format = {_value(FORMAT)}", f"name = {_value(draft.name)}"])]
    for head, table in (("workspace", draft.workspace), ("plan", draft.plan), ("defaults", draft.defaults)):
        if table:
            blocks.append(_table(f"[{head}]", table))
    blocks += [_table("[[robots]]", robot) for robot in draft.robots]
    blocks += [_table("[[obstacles]]", obstacle) for obstacle in draft.obstacles]
    return "\n\n".join(blocks) + "\n"


def draft_of(problem: Problem, remarks: Iterable[str] = ()) -> Draft:
    """A problem as a draft that reads back as the same problem, with its map and its files written out.

    What all robots have in common goes to [defaults]. Obstacles with holes, which come from maps, become several
    without.
    """
    workspace = problem.workspace
    tables = [_robot(robot) for robot in problem.robots]
    common = {key: tables[0][key] for key in _COMMON if all(t.get(key) == tables[0].get(key, t) for t in tables)}
    return Draft(
        problem.name,
        tuple(remarks),
        {
            "bounds": list(workspace.bounds),
            "clearance": workspace.clearance,
            "after_arrival": workspace.after_arrival,
        },
        dict(problem.options),
        common,
        tuple({key: value for key, value in table.items() if key not in common} for table in tables),
        tuple(table for obstacle in problem.obstacles for table in _obstacle(obstacle)),
    )


def outline(name: str, ring: Iterable[Sequence[float]]) -> Fields:
    """The table of an obstacle with straight edges; a rectangle along the axes is written as one."""
    corners = [[float(x), float(y)] for x, y in ring]
    xs, ys = sorted({x for x, _ in corners}), sorted({y for _, y in corners})
    straight = all((a[0] == b[0]) != (a[1] == b[1]) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    if len(corners) == 4 and len(xs) == len(ys) == 2 and straight:
        return {"name": name, "rectangle": [xs[0], ys[0], xs[1], ys[1]]}
    return {"name": name, "polygon": corners}


def _robot(robot: Robot) -> dict[str, object]:
    fields: dict[str, object] = {"name": robot.name, "start": list(robot.start), "goal": list(robot.goal)}
    fields |= _footprint(robot.footprint)
    fields |= {key: getattr(robot.limits, key) for key in _LIMITS}
    fields |= {"corner_radius": robot.corner_radius, "weight": robot.weight, "release": robot.release}
    if robot.priority is not None:
        fields["priority"] = robot.priority
    if robot.path:
        return fields | {"path": [list(point) for point in robot.path]}
    fields["side"] = robot.side
    return fields | ({"via": [list(point) for point in robot.via]} if robot.via else {})


def _footprint(footprint: Footprint) -> dict[str, object]:
    if not footprint.vertices:
        return {"footprint": {"disc": footprint.radius}}
    return {
        "footprint": {"polygon": [list(point) for point in footprint.vertices]},
        "heading": footprint.heading,
    }


def _obstacle(obstacle: Obstacle) -> list[Fields]:
    if isinstance(obstacle, Circle):
        return [{"name": obstacle.name, "circle": {"center": list(obstacle.center), "radius": obstacle.radius}}]
    if not obstacle.holes:
        return [outline(obstacle.name, obstacle.vertices.tolist())]
    parts = simple_parts(obstacle.rings)
    return [outline(f"{obstacle.name}, part {k}", part.tolist()) for k, part in enumerate(parts, start=1)]


def _table(head: str, table: Fields) -> str:
    comment = table.get("#")
    lines = _comments([str(comment)]) if comment else []
    return "\n".join([*lines, head, *(_entry(key, value) for key, value in table.items() if key != "#")])


def _entry(key: str, value: object) -> str:
    line = f"{key} = {_value(value)}"
    if len(line) <= _WIDTH or not isinstance(value, (list, tuple)):
        return line
    lines, current = [f"{key} = ["], ""
    for item in value:
        text = f"{_value(item)},"
        if current and len(current) + len(text) + 5 > _WIDTH:
            lines.append(f"    {current}")
            current = ""
        current = f"{current} {text}" if current else text
    return "\n".join([*lines, f"    {current}", "]"])


def _value(value: object) -> str:
    """A value in TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(float(value))  # numpy's own floats say their type
    if isinstance(value, str):
        return '"' + "".join(_escaped(character) for character in value) + '"'
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    raise TypeError(f"TOML has no word for {value!r}")


def _escaped(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    if character.isprintable():
        return character
    # half a surrogate pair, which JSON can bring, is no character that TOML knows
    return "\\uFFFD" if 0xD800 <= ord(character) < 0xE000 else f"\\U{ord(character):08X}"


def _comments(sentences: Iterable[str]) -> list[str]:
    """Sentences as comment lines, wrapped at words."""
    lines = []
    for sentence in sentences:
        line = "#"
        for word in "".join(c if c.isprintable() else " " for c in sentence).split():
            if len(line) + 1 + len(word) > _WIDTH and line != "#":
                lines.append(line)
                line = "#"
            line += f" {word}"
        lines.append(line)
    return lines
