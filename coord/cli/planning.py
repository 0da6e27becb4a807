"""``coord plan``: read, plan, write, report."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from coord.cli.app import (
    NO_PLAN,
    NOT_CERTIFIED,
    OK,
    Json,
    ProblemFile,
    command,
    note,
    print_json,
    print_table,
    say,
)
from coord.cli.options import options_of
from coord.errors import NotCertifiedError

if TYPE_CHECKING:
    from coord.coordination.kept import Kept
    from coord.model.problem import Problem
    from coord.model.result import Result


@command()
def plan(
    problem: ProblemFile,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="OUTDIR", help="Where results go; plans/<name of PROBLEM>/.")
    ] = None,
    method: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Who gives way, and how. velocity: the later one, by its speed (default); stop: the later one stops "
            "before the conflict and waits; nearest: who is farther from it stops, whatever the priorities.",
        ),
    ] = None,
    shape: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="How paths bend. fitted: as wide as pays (default); exponential: least-squares curves; "
            "taut: shortest, lines and arcs; follow: along the obstacles' edges.",
        ),
    ] = None,
    order: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Who is planned first. priority: yours, then who needs longest alone."),
    ] = None,
    profile: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="How robots give way. gentle: early and smoothly (default); fastest: each arrives as early as it can.",
        ),
    ] = None,
    time_limit: Annotated[float | None, typer.Option(metavar="S", help="Stop searching after this long [s].")] = None,
    gap_target: Annotated[float | None, typer.Option(metavar="G", help="Not supported yet.")] = None,
    seed: Annotated[int | None, typer.Option(metavar="N", help="For everything drawn at random.")] = None,
    keep_paths: Annotated[
        bool | None,
        typer.Option("--keep-paths/--re-route", help="Let no robot go round the others' starts and goals."),
    ] = None,
    certify: Annotated[
        bool | None,
        typer.Option(
            "--certify/--no-certify",
            help="Prove of every robot, as far as can be, that given those before it it could not be earlier.",
        ),
    ] = None,
    extend: Annotated[
        Path | None,
        typer.Option(
            metavar="PLAN",
            help="Keep the motion of all robots of PLAN that are as they were; plan the others after them.",
        ),
    ] = None,
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
    options = options_of(
        problem,
        read,
        method=method,
        shape=shape,
        order=order,
        profile=profile,
        time_limit=time_limit,
        gap_target=gap_target,
        seed=seed,
        keep_paths=keep_paths,
        certify=certify,
    )
    holding = None if extend is None else _kept(read, extend)
    folder = out if out is not None else Path("plans") / problem.stem
    files.prepare(folder)
    with progress() as show:
        result = make_plan(read, options, show) if holding is None else make_plan(read, options, show, extend=holding)
    written = [files.save(folder, result)]
    found = summary.certified_plan(result)
    if read.options.get("plots", False) if plots is None else plots:
        written += _draw(folder, result)
    seconds = perf_counter() - started
    if as_json:
        print_json(summary.record(result, seconds, holding))
    else:
        if holding is not None:
            note(summary.kept_text(holding))
        if result.diagnoses:
            note(summary.paragraphs(result.diagnoses))
        if found is not None:
            print_table(summary.table(result, found))
            say("\n".join(f"written: {path}" for path in written))
        else:
            kind = "certified plan" if result.plan else "plan"
            note(f"There is no {kind}; the reasons are in {' and '.join(map(str, written))}")
    return NO_PLAN if result.plan is None else OK if found is not None else NOT_CERTIFIED


def _kept(problem: Problem, file: Path) -> Kept:
    """What holds of a plan file; one that is not certified itself is refused."""
    from coord.coordination.kept import kept
    from coord.output import files
    from coord.output.plan_file import parse
    from coord.verify import verify

    data = files.read(file)
    plan, report = parse(data, str(file)), verify(data)
    if not report.certified:
        why = report.faults[0].text if report.faults else report.verdict
        remedy = "extend a plan that coord verify certifies, or plan all robots anew, without --extend"
        raise NotCertifiedError(f"{file}: not certified: {why}; {remedy}")
    return kept(problem, plan)


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
