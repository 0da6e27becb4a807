"""What all formats of outlines have in common: tables of obstacles, bounds, a robot to begin with."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from coord.geometry.cutting import simple_parts
from coord.geometry.shapes import too_near
from coord.importing.maps import example_robot
from coord.importing.places import two_places
from coord.importing.values import RADIUS, ImportOptions
from coord.model.arrays import frozen
from coord.model.obstacle import Obstacle, Polygon
from coord.output.problem_file import Fields, outline

Box = tuple[float, float, float, float]

#: [m] Floor left free round obstacles where the file says nothing of the workspace.
MARGIN = 1.0

#: Free places are looked for on a lattice of this many points along the longer side.
_POINTS = 120


def obstacle_tables(name: str, polygons: Sequence[Sequence[npt.ArrayLike]]) -> list[Fields]:
    """The tables of an obstacle that is one or several polygons, each its outline and holes; parts are numbered."""
    parts = [part.tolist() for rings in polygons for part in _parts(rings)]
    names = [name] if len(parts) == 1 else [f"{name}, part {n}" for n in range(1, len(parts) + 1)]
    return [outline(called, part) for called, part in zip(names, parts, strict=True)]


def bounds_of(points: Iterable[Sequence[float]], margin: float) -> Box:
    """The box of points with a margin [m], to a whole centimetre outwards."""
    xs, ys = zip(*((point[0], point[1]) for point in points), strict=True)
    xmin, ymin = (math.floor((min(values) - margin) * 100) / 100 for values in (xs, ys))
    xmax, ymax = (math.ceil((max(values) + margin) * 100) / 100 for values in (xs, ys))
    return xmin, ymin, xmax, ymax


def robot_between(tables: Sequence[Fields], bounds: Box, source: Path, options: ImportOptions) -> Fields:
    """An example robot on a floor of outlines; BadFileError when nowhere is room."""
    radius = options.radius or RADIUS
    xmin, ymin, xmax, ymax = bounds
    step = max(xmax - xmin, ymax - ymin) / _POINTS
    columns, rows = (max(1, round(side / step)) for side in (xmax - xmin, ymax - ymin))
    x = xmin + step * (np.arange(columns) + 0.5)
    y = ymin + step * (np.arange(rows) + 0.5)
    points = np.stack(np.meshgrid(x, y), axis=2)
    # half a step more than the radius, so that the disc stays clear on its way to the next point too
    reach = radius + step / 2
    edge = np.minimum(points - [xmin, ymin], [xmax, ymax] - points).min(axis=2)
    occupied = edge < reach
    who, _, _ = too_near(_obstacles(tables), points.reshape(-1, 2), np.full(rows * columns, reach))
    occupied.ravel()[who] = True
    return example_robot(two_places(occupied, step, (xmin, ymin), 0.0), source, radius)


def _parts(rings: Sequence[npt.ArrayLike]) -> list[npt.NDArray[np.float64]]:
    return simple_parts(rings) if len(rings) > 1 else [np.asarray(rings[0], dtype=np.float64)]


def _obstacles(tables: Sequence[Fields]) -> list[Obstacle]:
    found: list[Obstacle] = []
    for table in tables:
        corners = np.array(table.get("polygon", table.get("rectangle")), dtype=np.float64)
        if corners.ndim == 1:
            corners = corners[[0, 1, 2, 1, 2, 3, 0, 3]].reshape(-1, 2)
        found.append(Polygon(str(table["name"]), frozen(corners, 2)))
    return found
