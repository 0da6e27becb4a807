"""Pictures of plans. Only this package knows matplotlib; it is slow to import, so import this where it is used."""

from __future__ import annotations

from typing import Final

from coord.errors import InvalidValueError
from coord.model.result import Plan, Result
from coord.output.plots.profiles import profiles
from coord.output.plots.st import st
from coord.output.plots.style import png
from coord.output.plots.workspace import floor, workspace

__all__ = ["KINDS", "draw", "draw_failure", "floor", "profiles", "st", "workspace"]

#: What there is to draw.
KINDS: Final = ("workspace", "profiles", "st")


def draw(plan: Plan, what: str, robot: str | None = None) -> bytes:
    """Draw a plan as a PNG file; the same plan gives the same bytes.

    Parameters
    ----------
    what : "workspace" (where everybody drives), "profiles" (speed, acceleration and jerk over time) or
        "st" (one robot's way between the robots planned earlier).
    robot : the name of the robot to show; without it each picture chooses and says so.

    Raises
    ------
    InvalidValueError
        When no robot has this name, or ``what`` is none of the kinds.
    """
    kinds = {"workspace": workspace, "profiles": profiles, "st": st}
    if what not in kinds:
        raise InvalidValueError([("what", f'there is no picture "{what}"; there are {", ".join(KINDS)}')])
    return png(lambda: kinds[what](plan, robot))


def draw_failure(result: Result) -> bytes:
    """Draw the floor of a problem that has no plan as a PNG file, so that its diagnoses can be understood."""
    return png(lambda: floor(result.problem, result.diagnoses))
