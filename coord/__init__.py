"""coord plans the motion of many robots on a floor, offline, and certifies every plan.

>>> from coord import read_problem
>>> from coord.plan import plan
>>> from coord.verify import verify
>>> result = plan(read_problem(path))  # doctest: +SKIP
>>> verify(result.document).verdict  # doctest: +SKIP
'certified'

The nouns and the readers can be had from here; they are loaded when they are first used, so that importing
coord alone takes no time. The two verbs live in modules of their own name, ``coord.plan`` and ``coord.verify``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from coord.errors import BadFileError as BadFileError
    from coord.errors import CoordError as CoordError
    from coord.errors import InvalidValueError as InvalidValueError
    from coord.model.footprint import Footprint as Footprint
    from coord.model.obstacle import Circle as Circle
    from coord.model.obstacle import Polygon as Polygon
    from coord.model.obstacle import rectangle as rectangle
    from coord.model.options import Options as Options
    from coord.model.path import Path as Path
    from coord.model.problem import Problem as Problem
    from coord.model.problem import Workspace as Workspace
    from coord.model.profile import VelocityProfile as VelocityProfile
    from coord.model.result import Diagnosis as Diagnosis
    from coord.model.result import Plan as Plan
    from coord.model.result import Result as Result
    from coord.model.result import RobotPlan as RobotPlan
    from coord.model.robot import Limits as Limits
    from coord.model.robot import Robot as Robot
    from coord.output.files import read_plan as read_plan
    from coord.reading.problem_file import read_problem as read_problem

_HOMES: Final = {
    "BadFileError": "coord.errors",
    "Circle": "coord.model.obstacle",
    "CoordError": "coord.errors",
    "Diagnosis": "coord.model.result",
    "Footprint": "coord.model.footprint",
    "InvalidValueError": "coord.errors",
    "Limits": "coord.model.robot",
    "Options": "coord.model.options",
    "Path": "coord.model.path",
    "Plan": "coord.model.result",
    "Polygon": "coord.model.obstacle",
    "Problem": "coord.model.problem",
    "Result": "coord.model.result",
    "Robot": "coord.model.robot",
    "RobotPlan": "coord.model.result",
    "VelocityProfile": "coord.model.profile",
    "Workspace": "coord.model.problem",
    "read_plan": "coord.output.files",
    "read_problem": "coord.reading.problem_file",
    "rectangle": "coord.model.obstacle",
}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> object:
    """Load a public name from the module it lives in."""
    if name not in _HOMES:
        raise AttributeError(f"module 'coord' has no attribute '{name}'; it has {', '.join(__all__)}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """All public names, loaded or not."""
    return sorted({*globals(), *__all__})
