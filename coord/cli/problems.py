"""Commands about problems: ``coord explain``, ``coord import``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from coord.cli.app import NO_PLAN, OK, Json, ProblemFile, command, note, print_json, say
from coord.cli.options import options_of


@command()
def explain(
    problem: ProblemFile,
    shape: Annotated[
        str | None, typer.Option(metavar="NAME", help="How paths bend: fitted, exponential, taut or follow.")
    ] = None,
    keep_paths: Annotated[
        bool | None, typer.Option("--keep-paths/--re-route", help="Let no robot go round the others' starts and goals.")
    ] = None,
    as_json: Json = False,
) -> int:
    """Tell the story of PROBLEM before it is planned.

    Each robot's way and what the other side would cost, who meets whom, who must go before whom, and which order
    follows. Exit code 1 where there will be no plan.
    """
    from coord.explain import explain as tell
    from coord.output.explanation import record, text
    from coord.output.progress import progress
    from coord.reading.problem_file import read_problem

    read = read_problem(problem)
    options = options_of(problem, read, shape=shape, keep_paths=keep_paths)
    with progress() as show:
        story = tell(read, options, show)
    if as_json:
        print_json(record(story))
    else:
        say(text(story))
    return NO_PLAN if story.diagnoses else OK


@command("import")
def import_(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="A .scen or .map (MovingAI), a ROS map or dynobench .yaml, an image, .geojson or .wkt.",
        ),
    ],
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="PROBLEM", help="The problem file; <name of FILE>.toml here.")
    ] = None,
    map_: Annotated[
        Path | None, typer.Option("--map", metavar="MAP", help="Of a scenario: the map, where it is not beside it.")
    ] = None,
    robots: Annotated[int | None, typer.Option(metavar="N", help="Of a scenario: so many robots (10).")] = None,
    resolution: Annotated[float | None, typer.Option(metavar="M", help="Of images and .map: metres a cell.")] = None,
    occupied_below: Annotated[
        float | None,
        typer.Option(metavar="SHARE", help="Of images: cells darker than this share of white are occupied."),
    ] = None,
    unknown: Annotated[str | None, typer.Option(metavar="WHAT", help="Of ROS maps: occupied or free.")] = None,
    radius: Annotated[float | None, typer.Option(metavar="M", help="Of the robots' discs.")] = None,
    simplify: Annotated[
        float, typer.Option(metavar="M", help="Of maps: polygons that are larger by this much at most, not the map.")
    ] = 0.0,
    metres: Annotated[bool, typer.Option("--metres", help="Of GeoJSON: coordinates are metres, not degrees.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace a problem file that is there.")] = False,
) -> int:
    """Turn a file of another program into a problem file that a person can read and edit."""
    from coord.importing.choose import write_import
    from coord.importing.values import ImportOptions

    target = out if out is not None else Path(f"{file.stem}.toml")
    options = ImportOptions(
        map=map_,
        robots=robots,
        resolution=resolution,
        occupied_below=occupied_below,
        unknown=unknown,
        radius=radius,
        simplify=simplify,
        metres=metres,
        force=force,
    )
    remarks = write_import(file, target, options)
    note("\n".join([*remarks, f"written: {target}"]))
    return OK
