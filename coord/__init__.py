"""coord plans the motion of many robots on a floor, offline, and certifies every plan.

>>> import coord
>>> result = coord.plan(coord.read_problem("problem.toml"))  # doctest: +SKIP
>>> coord.verify(result.document).verdict  # doctest: +SKIP
'certified'

The names are loaded when they are first used: importing coord alone takes no time.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from coord.errors import BadFileError as BadFileError
    from coord.errors import CoordError as CoordError
    from coord.errors import InvalidValueError as InvalidValueError
    from coord.model.obstacle import Circle as Circle
    from coord.model.obstacle import Polygon as Polygon
    from coord.model.obstacle import rectangle as rectangle
    from coord.model.path import Path as Path
    from coord.model.problem import Problem as Problem
    from coord.model.problem import Workspace as Workspace
    from coord.model.profile import VelocityProfile as VelocityProfile
    from coord.model.result import Diagnosis as Diagnosis
    from coord.model.result import Plan as Plan
    from coord.model.result import Result as Result
    from coord.model.result import RobotPlan as RobotPlan
    from coord.model.robot import Footprint as Footprint
    from coord.model.robot import Limits as Limits
    from coord.model.robot import Robot as Robot
    from coord.output.files import read_plan as read_plan
    from coord.plan import Options as Options
    from coord.plan import plan as plan
    from coord.reading.problem_file import read_problem as read_problem
    from coord.verify import verify as verify

_HOMES: Final = {
    "BadFileError": "coord.errors",
    "Circle": "coord.model.obstacle",
    "CoordError": "coord.errors",
    "Diagnosis": "coord.model.result",
    "Footprint": "coord.model.robot",
    "InvalidValueError": "coord.errors",
    "Limits": "coord.model.robot",
    "Options": "coord.plan",
    "Path": "coord.model.path",
    "Plan": "coord.model.result",
    "Polygon": "coord.model.obstacle",
    "Problem": "coord.model.problem",
    "Result": "coord.model.result",
    "Robot": "coord.model.robot",
    "RobotPlan": "coord.model.result",
    "VelocityProfile": "coord.model.profile",
    "Workspace": "coord.model.problem",
    "plan": "coord.plan",
    "read_plan": "coord.output.files",
    "read_problem": "coord.reading.problem_file",
    "rectangle": "coord.model.obstacle",
    "verify": "coord.verify",
}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> object:
    """Load a public name from the module it lives in."""
    if name not in _HOMES:
        raise AttributeError(f"module 'coord' has no attribute '{name}'; it has {', '.join(__all__)}")
    module = import_module(_HOMES[name])
    value = module if isinstance(module, _Verb) else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """All public names, loaded or not."""
    return sorted({*globals(), *__all__})


class _Verb(ModuleType):
    """A module that is there for the function of its own name, and can be called like it."""

    def __call__(self, *args: object, **options: object) -> object:
        return getattr(self, self.__name__.rpartition(".")[2])(*args, **options)

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return (import_module, (self.__name__,))


class _Package(ModuleType):
    """Lets coord.plan and coord.verify be called, whoever imported them first.

    Importing a module sets it as an attribute of its package, so these two would hide the functions that
    they have their names from.
    """

    def __setattr__(self, name: str, value: object) -> None:
        if name in _HOMES and isinstance(value, ModuleType):
            value.__class__ = _Verb
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
