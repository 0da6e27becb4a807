"""A map alone, as a problem: the floor, and one robot to begin with."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from coord.errors import BadFileError, Fault
from coord.geometry.cutting import simple_parts
from coord.importing.places import two_places
from coord.importing.values import DRIVE, RADIUS, ImportOptions
from coord.model.arrays import Point
from coord.output.problem_file import Draft, Fields, outline
from coord.reading.files import UnreadableError
from coord.reading.grid_map import GridMap, read_movingai, read_picture
from coord.reading.ros_map import read_ros_map
from coord.reading.simplify import simplified
from coord.reading.trace import trace

#: [1] Radius of robots on MovingAI maps, in cells.
CELL_SHARE = 0.3

#: [m] Coordinates that were computed are written with this many decimals, far below what any tolerance sees.
_DECIMALS = 9


def ros_draft(source: Path, folder: Path, options: ImportOptions) -> Draft:
    """A ROS map; ``folder`` is where the problem file will stand."""
    unknown = options.unknown or "occupied"
    grid = read(source, lambda: read_ros_map(source, unknown))
    extra: Fields = {"unknown": unknown} if options.unknown else {}
    return _draft(source, folder, grid, extra, options.radius or RADIUS, options.simplify)


def movingai_draft(source: Path, folder: Path, options: ImportOptions) -> Draft:
    """A grid map of the Moving AI Lab."""
    size = options.resolution or 1.0
    grid = read(source, lambda: read_movingai(source, size))
    return _draft(source, folder, grid, {"resolution": size}, options.radius or CELL_SHARE * size, options.simplify)


def image_draft(source: Path, folder: Path, options: ImportOptions) -> Draft:
    """An image of a floor."""
    if options.resolution is None:
        text = "an image needs --resolution, the side of a cell in m"
        raise BadFileError([Fault(str(source), None, "", text)])
    size = options.resolution
    below = 0.5 if options.occupied_below is None else options.occupied_below
    grid = read(source, lambda: read_picture(source, size, below))
    extra = {"resolution": size, "occupied_below": below}
    return _draft(source, folder, grid, extra, options.radius or RADIUS, options.simplify)


def read(path: Path, reader: Callable[[], GridMap]) -> GridMap:
    """What a reader of maps brings; a file that it cannot read is a fault of that file."""
    try:
        return reader()
    except UnreadableError as error:
        raise BadFileError([Fault(str(path), None, "", f"the map {error}")]) from None


def relative(file: Path, folder: Path) -> str:
    """The name of a file as a problem in a folder writes it."""
    return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()


def example_robot(places: tuple[Point, Point] | None, source: Path, radius: float) -> Fields:
    """A robot to begin with, from one free place to another.

    Raises
    ------
    BadFileError
        When there is no free place.
    """
    if places is None:
        text = f"nowhere is room for a robot with a radius of {radius:g} m; give a smaller --radius"
        raise BadFileError([Fault(str(source), None, "", text)])
    start, goal = ([round(value, _DECIMALS) for value in place] for place in places)
    return {
        "#": "An example, between two free places that are far apart: move it, copy it, rename it.",
        "name": "robot 1",
        "start": start,
        "goal": goal,
    }


def floor_of(grid: GridMap, source: Path, folder: Path, extra: Fields, tolerance: float) -> tuple[Fields, list[Fields]]:
    """The tables [workspace] and [[obstacles]] of a map: its name alone, or its outlines with a tolerance [m]."""
    if not tolerance:
        return {"map": relative(source, folder), **extra, "clearance": 0.0}, []
    tables: list[Fields] = []
    x, y = grid.origin
    for k, (shell, holes) in enumerate(simplified(trace(grid.occupied), tolerance / grid.resolution), start=1):
        rings = [(ring * grid.resolution + (x, y)).round(_DECIMALS) for ring in (shell, *holes)]
        parts = [ring.tolist() for ring in (simple_parts(rings) if holes else rings)]
        names = [f"map {k}"] if len(parts) == 1 else [f"map {k}, part {n}" for n in range(1, len(parts) + 1)]
        tables += [outline(name, part) for name, part in zip(names, parts, strict=True)]
    bounds = [round(value, _DECIMALS) for value in grid.bounds]
    return {"bounds": bounds, "clearance": 0.0}, tables


def _draft(source: Path, folder: Path, grid: GridMap, extra: Fields, radius: float, tolerance: float) -> Draft:
    places = two_places(grid.occupied, grid.resolution, grid.origin, radius + tolerance)
    robot = example_robot(places, source, radius)
    workspace, obstacles = floor_of(grid, source, folder, extra, tolerance)
    rows, columns = grid.occupied.shape
    remarks = [f"Imported from {source.name}: {columns} x {rows} cells of {grid.resolution:g} m."]
    if tolerance:
        remarks.append(
            "The obstacles are the outlines of its occupied cells, simplified: "
            f"they cover all of them, and reach at most {tolerance:g} m further."
        )
    return Draft(
        name=source.stem,
        remarks=tuple(remarks),
        workspace=workspace,
        defaults={"footprint": {"disc": radius}, **DRIVE},
        robots=(robot,),
        obstacles=tuple(obstacles),
    )
