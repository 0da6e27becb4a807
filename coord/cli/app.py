"""What all commands share: the application, exit codes, and how they speak.

Exit codes: 0 done, 1 no plan, 2 bad usage or a bad file, 4 refused by verification, 70 a defect of coord,
130 interrupted.
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Mapping
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from coord.errors import BadFileError, InvalidValueError, NoPlanError, NotCertifiedError

OK: Final = 0
NO_PLAN: Final = 1
BAD_INPUT: Final = 2
NOT_CERTIFIED: Final = 4
DEFECT: Final = 70
INTERRUPTED: Final = 130

#: More faults than this are counted, not shown.
MOST_FAULTS: Final = 50

app = typer.Typer(
    help="Plan the motion of many robots on a floor, and certify every plan.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on standard output, nothing else.")]
PlanFile = Annotated[Path, typer.Argument(metavar="PLAN", help="A plan.json.")]
ProblemFile = Annotated[Path, typer.Argument(metavar="PROBLEM", help="A problem file (TOML).")]


def command(name: str | None = None) -> Callable[[Callable[..., int]], Callable[..., None]]:
    """Register a command; whatever goes wrong in it becomes a message on standard error and an exit code."""

    def register(function: Callable[..., int]) -> Callable[..., None]:
        @app.command(name)
        @wraps(function)
        def run(*args: Any, **kwargs: Any) -> None:
            raise typer.Exit(_code(lambda: function(*args, **kwargs)))

        return run

    return register


def _code(work: Callable[[], int]) -> int:
    try:
        return work()
    except BadFileError as error:
        return complain([str(fault) for fault in error.faults], BAD_INPUT)
    except InvalidValueError as error:
        return complain([sentence for _, sentence in error.faults], BAD_INPUT)
    except NoPlanError as error:
        return complain([str(error)], NO_PLAN)
    except NotCertifiedError as error:
        return complain([str(error)], NOT_CERTIFIED)
    except KeyboardInterrupt:
        return complain(["interrupted"], INTERRUPTED)
    except Exception as error:  # noqa: BLE001  the last resort: whatever else happens is our defect
        if os.environ.get("COORD_DEBUG"):
            traceback.print_exc()
        what = " ".join(f"{type(error).__name__}: {error}".split())
        hint = "set COORD_DEBUG=1 for the traceback"
        return complain([f"internal error, a defect of coord, not of your files ({hint}): {what}"], DEFECT)


def complain(lines: list[str], code: int) -> int:
    """Say what is wrong, line by line; gives back the exit code."""
    more = [f"and {len(lines) - MOST_FAULTS} more"] if len(lines) > MOST_FAULTS else []
    note("\n".join(lines[:MOST_FAULTS] + more))
    return code


def note(text: str) -> None:
    """A message for people, on standard error; control characters in names shall not steer the terminal."""
    sys.stderr.write("".join(c if c.isprintable() or c == "\n" else repr(c)[1:-1] for c in text) + "\n")


def say(text: str) -> None:
    """Data, on standard output. Whoever has stopped reading it (``| head``) does not change the answer."""
    try:
        sys.stdout.write(f"{text}\n")
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def print_json(value: Mapping[str, object]) -> None:
    """One JSON object, on standard output."""
    import json

    say(json.dumps(value, indent=1, allow_nan=False))


def print_table(table: object) -> None:
    """A table of rich, on standard output."""
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False)
    with console.capture() as capture:
        console.print(table)
    say(capture.get().rstrip("\n"))
