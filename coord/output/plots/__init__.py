"""Pictures of plans. Only this package knows matplotlib; it is slow to import, so import this where it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from coord.errors import InvalidValueError
from coord.model.result import Plan, Result
from coord.output.plots.as_planned import longest_detour, route_of
from coord.output.plots.path import path
from coord.output.plots.profiles import profiles
from coord.output.plots.st import st
from coord.output.plots.style import find, png
from coord.output.plots.workspace import floor, workspace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["KINDS", "draw", "draw_failure", "floor", "path", "profiles", "st", "workspace"]

#: What there is to draw of a plan as a whole; "path" is drawn of one robot.
KINDS: Final = ("workspace", "profiles", "st")


def draw(plan: Plan, what: str, robot: str | None = None) -> bytes:
    """Draw a plan as a PNG file; the same plan gives the same bytes.

    Parameters
    ----------
    what : "workspace" (where everybody drives), "profiles" (speed, acceleration and jerk over time) or
        "st" (one robot's way between the robots planned earlier), or "path" (one robot's path, and the other side).
    robot : the name of the robot to show; without it each picture chooses and says so.

    Raises
    ------
    InvalidValueError
        When no robot has this name, or ``what`` is none of the kinds.
    """
    kinds = {"workspace": workspace, "profiles": profiles, "st": st, "path": _path}
    if what not in kinds:
        raise InvalidValueError([("what", f'there is no picture "{what}"; there are {", ".join(kinds)}')])
    return png(lambda: kinds[what](plan, robot))


def _path(plan: Plan, robot: str | None) -> Figure:
    name = find(plan, robot or longest_detour(plan)).robot.name
    return path(plan, name, route_of(plan, name))


def draw_failure(result: Result) -> bytes:
    """Draw the floor of a problem that has no plan as a PNG file, so that its diagnoses can be understood."""
    return png(lambda: floor(result.problem, result.diagnoses))
