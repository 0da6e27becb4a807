"""Maps that are grids of cells, whatever file they come from; images and MovingAI maps are read here."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from coord.errors import BadFileError, Fault
from coord.model.arrays import Point
from coord.model.obstacle import Polygon
from coord.reading.files import UnreadableError, read_bytes
from coord.reading.images import LARGEST_MAP, ImageError, read_image
from coord.reading.trace import trace

#: [bytes] A map's file may be this large.
LARGEST_FILE = 2**28

#: Cells of a MovingAI map on which one can walk: ground, grass and swamp (Sturtevant 2012, movingai.com formats).
_WALKABLE = b".GS"

_MOVINGAI = re.compile(rb"type [^\n]*\n\s*height\s+(\d{1,6})\s*\n\s*width\s+(\d{1,6})\s*\n\s*map[ \t]*\n")


@dataclass(frozen=True, slots=True, eq=False)
class GridMap:
    """A map as read.

    Parameters
    ----------
    occupied : (rows, columns) array, row 0 at the bottom.
    resolution : side of a cell [m]. origin : lower left corner of the map [m].
    files : the bytes of the files it was read from.
    """

    occupied: npt.NDArray[np.bool_]
    resolution: float
    origin: Point
    files: tuple[bytes, ...]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The map's extent xmin, ymin, xmax, ymax [m]."""
        rows, columns = self.occupied.shape
        x, y = self.origin
        return (x, y, x + self.resolution * columns, y + self.resolution * rows)


def map_obstacles(grid: GridMap) -> list[Polygon]:
    """The occupied cells as polygons, exactly, named "map 1", "map 2" and so on."""
    polygons = []
    for k, (shell, holes) in enumerate(trace(grid.occupied), start=1):
        outline, *inner = (np.array(grid.origin) + grid.resolution * ring for ring in (shell, *holes))
        polygons.append(Polygon(f"map {k}", outline, tuple(inner)))
    return polygons


def read_picture(path: Path, resolution: float, occupied_below: float) -> GridMap:
    """Read an image as a floor: cells darker than ``occupied_below`` (a share of white) are occupied.

    ``resolution`` [m] is the side of a cell; the lower left corner lies at the origin.

    Raises
    ------
    UnreadableError
        When the file cannot be read at all, or is no image.
    """
    data = read_bytes(path, LARGEST_FILE)
    try:
        image = read_image(data)
    except ImageError as error:
        raise UnreadableError(str(error)) from None
    is_dark = np.arange(image.white + 1) / image.white < occupied_below
    return GridMap(np.asarray(is_dark[image.values[::-1]]), resolution, (0.0, 0.0), (data,))


def read_movingai(path: Path, resolution: float) -> GridMap:
    """Read a grid map of the Moving AI Lab; ``resolution`` [m] is the side of a cell, the origin its lower left corner.

    Raises
    ------
    UnreadableError
        When the file cannot be read at all.
    BadFileError
        When it is no such map, or its rows are not what its header says.
    """
    data = read_bytes(path, LARGEST_FILE)
    text = data.replace(b"\r\n", b"\n")
    header = _MOVINGAI.match(text)
    if header is None:
        raise BadFileError([Fault(str(path), 1, "", "a MovingAI map begins with the lines type, height, width, map")])
    height, width = int(header[1]), int(header[2])
    if not 0 < height * width <= LARGEST_MAP:
        said = f"{width} x {height} cells cannot be read; at most {LARGEST_MAP // 10**6} million, at least one"
        raise BadFileError([Fault(str(path), 2, "", said)])
    first = text.count(b"\n", 0, header.end()) + 1
    rows = text[header.end() :].rstrip(b"\n").split(b"\n")
    if len(rows) != height:
        raise BadFileError([Fault(str(path), 2, "", f"height is {height}, but the map has {len(rows)} rows")])
    faults = [
        Fault(str(path), first + k, "", f"the row has {len(row)} cells, but width is {width}")
        for k, row in enumerate(rows)
        if len(row) != width
    ]
    if faults:
        raise BadFileError(faults)
    cells = np.frombuffer(b"".join(rows), dtype=np.uint8).reshape(height, width)
    return GridMap(~np.isin(cells[::-1], np.frombuffer(_WALKABLE, dtype=np.uint8)), resolution, (0.0, 0.0), (data,))
