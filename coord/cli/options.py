"""Planning options: those of the problem file, overruled by the flags that were given."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coord.errors import BadFileError, Fault, InvalidValueError

if TYPE_CHECKING:
    from coord.model.options import Options
    from coord.model.problem import Problem


def options_of(file: Path, problem: Problem, **flags: object) -> Options:
    """The options of the file, overruled by the flags that were given; faults say which of the two is wrong."""
    from coord.model.options import Options

    given = {name: value for name, value in flags.items() if value is not None}
    table = {name: value for name, value in problem.options.items() if name != "plots"}
    unknown = table.keys() - {field.name for field in dataclasses.fields(Options)}
    if unknown:
        raise BadFileError(Fault(str(file), None, "[plan]", f"unknown option {name}") for name in sorted(unknown))
    merged: Mapping[str, Any] = {**table, **given}
    try:
        return Options(**merged)
    except InvalidValueError as error:
        raise BadFileError(
            Fault("coord", None, f"--{name.replace('_', '-')}", text)
            if name in given
            else Fault(str(file), None, "[plan]", text)
            for name, text in error.faults
        ) from error
