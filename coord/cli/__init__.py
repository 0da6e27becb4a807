"""The command line: each command reads, calls one function of the library, writes, and answers with an exit code.

Everything heavy is imported inside the commands, so that ``coord --help`` answers at once.
"""

from __future__ import annotations

import sys
from typing import Final

import typer

from coord.cli import planning, plans, problems
from coord.cli.app import BAD_INPUT, MOST_FAULTS, app, complain

__all__ = ["MOST_FAULTS", "RESERVED", "main", "planning", "plans", "problems"]

#: Commands whose names are taken and that later work brings.
RESERVED: Final = ("view", "edit", "study", "compare", "new")


def main() -> None:
    """Run ``coord`` with the arguments of the process and end it with the exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # names may have letters that this terminal has not
            stream.reconfigure(errors="backslashreplace")
    app(prog_name="coord")


def _not_yet() -> None:
    raise typer.Exit(complain(["this command is not supported yet; see coord --help"], BAD_INPUT))


for _name in RESERVED:
    app.command(
        _name,
        hidden=True,
        add_help_option=False,
        context_settings={"ignore_unknown_options": True, "allow_extra_args": True},
    )(_not_yet)
