"""Commands that take a plan: ``coord verify``, ``coord plot``, ``coord export``."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from coord.cli.app import NOT_CERTIFIED, OK, Json, PlanFile, command, note, print_json, say
from coord.errors import BadFileError, Fault


class Picture(StrEnum):
    """What ``coord plot`` draws."""

    workspace = "workspace"
    profiles = "profiles"
    st = "st"
    path = "path"


class Target(StrEnum):
    """What ``coord export`` writes."""

    csv = "csv"


@command()
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
        from coord.output.compare_map import compare_map
        from coord.output.plan_file import parse
        from coord.reading.problem_file import read_problem

        cells = compare_map(data, problem)
        found = [*differences(parse(data, str(plan)), read_problem(problem)), *cells.differences]
        if cells.remark:
            note(cells.remark)
    certified = report.verdict == "certified"
    if as_json:
        least = report.min_clearance
        print_json(
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
        say(str(report))
        if found is not None:
            say("\n".join(["not a plan of this problem:", *found]) if found else "the plan and the problem agree")
    return OK if certified and not found else NOT_CERTIFIED


@command()
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
    note(f"written: {target}")
    return OK


@command()
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
    note(f"written: {out}")
    return OK
