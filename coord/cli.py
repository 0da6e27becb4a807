"""The command line: each command reads, calls one function of the library, writes, and answers with an exit code.

Exit codes: 0 done, 1 no plan, 2 bad usage or a bad file, 4 refused by verification, 70 a defect of coord,
130 interrupted. Everything heavy is imported inside the commands, so that ``coord --help`` answers at once.
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Mapping
from enum import StrEnum
from functools import wraps
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from coord.errors import BadFileError, Fault, InvalidValueError, NoPlanError, NotCertifiedError

if TYPE_CHECKING:
    from coord.model.options import Options
    from coord.model.problem import Problem
    from coord.model.result import Result

OK: Final = 0
NO_PLAN: Final = 1
BAD_INPUT: Final = 2
NOT_CERTIFIED: Final = 4
DEFECT: Final = 70
INTERRUPTED: Final = 130

#: More faults than this are counted, not shown.
MOST_FAULTS: Final = 50

#: Commands whose names are taken and that later work brings.
RESERVED: Final = ("view", "edit", "study", "compare", "import", "new", "explain")

app = typer.Typer(
    help="Plan the motion of many robots on a floor, and certify every plan.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on standard output, nothing else.")]
PlanFile = Annotated[Path, typer.Argument(metavar="PLAN", help="A plan.json.")]


class Picture(StrEnum):
    """What ``coord plot`` draws."""

    workspace = "workspace"
    profiles = "profiles"
    st = "st"


class Target(StrEnum):
    """What ``coord export`` writes."""

    csv = "csv"


def main() -> None:
    """Run ``coord`` with the arguments of the process and end it with the exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # names may have letters that this terminal has not
            stream.reconfigure(errors="backslashreplace")
    app(prog_name="coord")


def _command(function: Callable[..., int]) -> Callable[..., None]:
    """Register a command; whatever goes wrong in it becomes a message on standard error and an exit code."""

    @app.command()
    @wraps(function)
    def command(*args: Any, **kwargs: Any) -> None:
        try:
            code = function(*args, **kwargs)
        except BadFileError as error:
            code = _complain([str(fault) for fault in error.faults], BAD_INPUT)
        except InvalidValueError as error:
            code = _complain([sentence for _, sentence in error.faults], BAD_INPUT)
        except NoPlanError as error:
            code = _complain([str(error)], NO_PLAN)
        except NotCertifiedError as error:
            code = _complain([str(error)], NOT_CERTIFIED)
        except KeyboardInterrupt:
            code = _complain(["interrupted"], INTERRUPTED)
        except Exception as error:  # noqa: BLE001  the last resort: whatever else happens is our defect
            if os.environ.get("COORD_DEBUG"):
                traceback.print_exc()
            what = " ".join(f"{type(error).__name__}: {error}".split())
            hint = "set COORD_DEBUG=1 for the traceback"
            code = _complain([f"internal error, a defect of coord, not of your files ({hint}): {what}"], DEFECT)
        raise typer.Exit(code)

    return command


@_command
def plan(
    problem: Annotated[Path, typer.Argument(metavar="PROBLEM", help="A problem file (TOML).")],
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="OUTDIR", help="Where results go; plans/<name of PROBLEM>/.")
    ] = None,
    method: Annotated[
        str | None, typer.Option(metavar="NAME", help="Who gives way, and how. velocity: the later one, by its speed.")
    ] = None,
    shape: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="How paths bend. fitted: as wide as pays (default); taut: shortest, lines and arcs."
        ),
    ] = None,
    order: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Who is planned first. priority: yours, then who needs longest alone."),
    ] = None,
    profile: Annotated[
        str | None, typer.Option(metavar="NAME", help="How robots drive. fastest: each arrives as early as it can.")
    ] = None,
    time_limit: Annotated[float | None, typer.Option(metavar="S", help="Stop searching after this long [s].")] = None,
    gap_target: Annotated[float | None, typer.Option(metavar="G", help="Not supported yet.")] = None,
    seed: Annotated[int | None, typer.Option(metavar="N", help="For everything drawn at random.")] = None,
    plots: Annotated[
        bool | None,
        typer.Option(
            "--plots/--no-plots", help="Also draw workspace.png, profiles.png, st.png; with no plan the first."
        ),
    ] = None,
    as_json: Json = False,
) -> int:
    """Plan the robots of PROBLEM.

    Writes plan.json, certified, or diagnosis.json when there is no plan.
    Options that are not given are those of the problem's [plan] table.
    """
    started = perf_counter()
    from coord.output import files, summary
    from coord.output.progress import progress
    from coord.plan import plan as make_plan
    from coord.reading.problem_file import read_problem

    read = read_problem(problem)
    options = _options(
        problem,
        read,
        method=method,
        shape=shape,
        order=order,
        profile=profile,
        time_limit=time_limit,
        gap_target=gap_target,
        seed=seed,
    )
    folder = out if out is not None else Path("plans") / problem.stem
    files.prepare(folder)
    with progress() as show:
        result = make_plan(read, options, show)
    written = [files.save(folder, result)]
    found = summary.certified_plan(result)
    if read.options.get("plots", False) if plots is None else plots:
        written += _draw(folder, result)
    seconds = perf_counter() - started
    if as_json:
        _print_json(summary.record(result, seconds))
    else:
        if result.diagnoses:
            _note(summary.paragraphs(result.diagnoses))
        if found is not None:
            _print_table(summary.table(result, found))
            _print("\n".join(f"written: {path}" for path in written))
        else:
            kind = "certified plan" if result.plan else "plan"
            _note(f"There is no {kind}; the reasons are in {' and '.join(map(str, written))}")
    return NO_PLAN if result.plan is None else OK if found is not None else NOT_CERTIFIED


@_command
def verify(
    plan: PlanFile,
    problem: Annotated[
        Path | None, typer.Option("--problem", metavar="PROBLEM", help="Also compare the plan with this problem file.")
    ] = None,
    as_json: Json = False,
) -> int:
    """Check PLAN from scratch.

    The checker shares no code with the planner. With a problem, every field that differs is listed.
    """
    from coord.output import files
    from coord.verify import verify as check

    data = files.read(plan)
    report = check(data)
    if report.verdict == "malformed":
        raise BadFileError(Fault(str(plan), None, "", fault.text) for fault in report.faults)
    found: list[str] | None = None
    if problem is not None:
        from coord.output.compare import differences
        from coord.output.plan_file import parse
        from coord.reading.problem_file import read_problem

        found = differences(parse(data, str(plan)), read_problem(problem))
    certified = report.verdict == "certified"
    if as_json:
        least = report.min_clearance
        _print_json(
            {
                "certified": certified,
                "verdict": report.verdict,
                "robots": report.robots,
                "min_clearance": least and {"value": least.value, "robots": list(least.robots), "time": least.time},
                "faults": [fault.text for fault in report.faults],
                "differences": found,
            }
        )
    else:
        _print(str(report))
        if found is not None:
            _print("\n".join(["not a plan of this problem:", *found]) if found else "the plan and the problem agree")
    return OK if certified and not found else NOT_CERTIFIED


@_command
def plot(
    plan: PlanFile,
    what: Annotated[Picture, typer.Option(help="The floor, speeds over time, or one robot between the others.")],
    robot: Annotated[str | None, typer.Option(metavar="NAME", help="The robot to show.")] = None,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="A PNG; beside PLAN if not given.")
    ] = None,
) -> int:
    """Draw PLAN as a PNG picture."""
    from coord.output import files

    target = out if out is not None else plan.with_name(f"{what.value}.png")
    if target.suffix.lower() != ".png":
        raise BadFileError([Fault(str(target), None, "", "pictures are PNG files; give a name that ends with .png")])
    found = files.read_plan(plan)
    from coord.output.plots import draw

    files.write(target, draw(found, what.value, robot))
    _note(f"written: {target}")
    return OK


@_command
def export(
    plan: PlanFile,
    to: Annotated[Target, typer.Option(help="The format.")],
    out: Annotated[Path, typer.Option("-o", "--out", metavar="FILE", help="Where to write.")],
    dt: Annotated[float, typer.Option(metavar="S", help="Time between two rows [s].")] = 0.05,
) -> int:
    """Write PLAN in another format.

    csv: t,robot,x,y,heading,s,v,a,j in SI units, from t = 0 to each robot's arrival.
    """
    from coord.output import files
    from coord.output.csv_export import write_csv

    found = files.read_plan(plan)
    with files.replacing(out) as stream:
        write_csv(found, stream, dt)
    _note(f"written: {out}")
    return OK


def _not_yet() -> None:
    raise typer.Exit(_complain(["this command is not supported yet; see coord --help"], BAD_INPUT))


for _name in RESERVED:
    app.command(
        _name,
        hidden=True,
        add_help_option=False,
        context_settings={"ignore_unknown_options": True, "allow_extra_args": True},
    )(_not_yet)


def _draw(folder: Path, result: Result) -> list[Path]:
    """Write the pictures of a plan, or that of the floor where there is none; of a refused plan there is no picture."""
    from coord.output import files
    from coord.output.plots import KINDS, draw, draw_failure

    pictures: dict[str, bytes] = {}
    if result.plan is None:
        pictures["workspace"] = draw_failure(result)
    elif result.certified:
        pictures = {kind: draw(result.plan, kind) for kind in KINDS}
    for kind, data in pictures.items():
        files.write(folder / f"{kind}.png", data)
    return [folder / f"{kind}.png" for kind in pictures]


def _options(file: Path, problem: Problem, **flags: object) -> Options:
    """The options of the file, overruled by the flags that were given; faults say which of the two is wrong."""
    from coord.model.options import Options

    given = {name: value for name, value in flags.items() if value is not None}
    table = {name: value for name, value in problem.options.items() if name != "plots"}
    unknown = table.keys() - flags.keys()
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


def _complain(lines: list[str], code: int) -> int:
    more = [f"and {len(lines) - MOST_FAULTS} more"] if len(lines) > MOST_FAULTS else []
    _note("\n".join(lines[:MOST_FAULTS] + more))
    return code


def _note(text: str) -> None:
    """A message for people, on standard error; control characters in names shall not steer the terminal."""
    sys.stderr.write("".join(c if c.isprintable() or c == "\n" else repr(c)[1:-1] for c in text) + "\n")


def _print(text: str) -> None:
    """Data, on standard output. Whoever has stopped reading it (``| head``) does not change the answer."""
    try:
        sys.stdout.write(f"{text}\n")
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _print_json(value: Mapping[str, object]) -> None:
    import json

    _print(json.dumps(value, indent=1, allow_nan=False))


def _print_table(table: object) -> None:
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False)
    with console.capture() as capture:
        console.print(table)
    _print(capture.get().rstrip("\n"))
