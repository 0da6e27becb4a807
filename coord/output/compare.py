"""Whether a plan is the answer to this problem: what the plan says, field by field, against what the problem says."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeVar

from coord.model.footprint import Footprint
from coord.model.obstacle import Circle, Obstacle
from coord.model.problem import Problem
from coord.model.result import Plan
from coord.model.robot import Robot
from coord.output.plan_file import footprint_words

Named = TypeVar("Named", Robot, Obstacle)

_WORKSPACE = ("bounds", "clearance", "after_arrival")
_ROBOT = ("footprint", "limits", "start", "goal", "priority", "release")


def differences(plan: Plan, problem: Problem) -> list[str]:
    """Say in one sentence each where a plan and a problem differ; an empty list if nowhere.

    Compared are the workspace, the obstacles, every robot's fields and, last, the digest of the files: it
    differs too when only something has changed that a plan does not repeat, such as an option or a comment.
    """
    ours = plan.problem
    found = [
        f"workspace: {field} is {_text(a)} in the plan, {_text(b)} in the problem"
        for field in _WORKSPACE
        if (a := getattr(ours.workspace, field)) != (b := getattr(problem.workspace, field))
    ]
    found += _missing("obstacle", [o.name for o in ours.obstacles], [o.name for o in problem.obstacles])
    found += [
        f'obstacle "{a.name}": its shape in the plan is not that in the problem'
        for a, b in _pairs(ours.obstacles, problem.obstacles)
        if _shape(a) != _shape(b)
    ]
    found += _missing("robot", [r.name for r in ours.robots], [r.name for r in problem.robots])
    found += [
        f'robot "{a.name}": {field} is {_text(here)} in the plan, {_text(there)} in the problem'
        for a, b in _pairs(ours.robots, problem.robots)
        for field in _ROBOT
        if (here := getattr(a, field)) != (there := getattr(b, field))
    ]
    if ours.digest != problem.digest:
        found.append(
            f'digest: the plan was made from files with digest "{ours.digest}", the problem has "{problem.digest}"'
            + ("" if found else "; all that a plan repeats agrees, so an option, a weight or a comment has changed")
        )
    return found


def _missing(what: str, ours: list[str], theirs: list[str]) -> Iterator[str]:
    """Names that only one side has; obstacles need not have different names, so they are counted."""
    for name in dict.fromkeys(ours + theirs):
        here, there = ours.count(name), theirs.count(name)
        if here != there:
            yield f'{what} "{name}": {here} in the plan, {there} in the problem'


def _pairs(ours: Sequence[Named], theirs: Sequence[Named]) -> Iterator[tuple[Named, Named]]:
    """Those of the same name on both sides; several of one name are paired in their order."""
    waiting: dict[str, list[Named]] = {}
    for item in theirs:
        waiting.setdefault(item.name, []).append(item)
    for item in ours:
        if waiting.get(item.name):
            yield item, waiting[item.name].pop(0)


def _shape(obstacle: Obstacle) -> object:
    if isinstance(obstacle, Circle):
        return (obstacle.center, obstacle.radius)
    return [ring.tolist() for ring in obstacle.rings]


def _text(value: object) -> str:
    if isinstance(value, Footprint):
        ((kind, size),) = footprint_words(value).items()
        return f"{{ {kind} = {size} }}" + (f' with heading "{value.heading}"' if value.vertices else "")
    return f'"{value}"' if isinstance(value, str) else str(value)
