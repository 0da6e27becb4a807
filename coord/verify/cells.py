"""Whether a plan's obstacles are the cells of a map: all that are occupied, and nothing else.

Planning traces the occupied cells into outlines. Here the outlines are filled again, row by row, and compared with
cells that were read independently. Outlines of cells run along rows and columns, so this is exact.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from coord.verify.grid import Cells, MapDescription, read_cells
from coord.verify.records import Circle, Polygon
from coord.verify.report import at, who

#: [1] A corner may be this share of a cell off the corner of a cell, or what rounding far from the origin makes.
_OFF = 1e-6

#: Outlines that are no outlines of cells are told one by one up to this many.
_TOLD = 5

#: (row, first column, column after the last) of cells in an outline.
Run = tuple[int, int, int]


def map_faults(description: MapDescription, obstacles: Sequence[Circle | Polygon]) -> list[str]:
    """Say where the obstacles that stand for a map differ from its cells; an empty list if nowhere.

    Parameters
    ----------
    obstacles : those of a plan that come from the map, and no others.

    Raises
    ------
    NotReadHereError
        When the map is an image that is no PGM.
    OSError
        When a file cannot be read.
    """
    cells = read_cells(description)
    faults: list[str] = []
    filled = [bytearray(cells.columns) for _ in cells.rows]
    outside = 0
    for obstacle in obstacles:
        corners = _on_lattice(obstacle, cells)
        if corners is None:
            faults.append(f"obstacle {who(obstacle.name)} does not run along the cells of the map")
            continue
        for row, first, after in _runs(corners):
            if 0 <= row < len(filled) and first >= 0 and after <= cells.columns:
                filled[row][first:after] = b"\1" * (after - first)
            else:
                outside += after - first
    if len(faults) > _TOLD:
        faults[_TOLD:] = [f"nor do {len(faults) - _TOLD} others"]
    if outside:
        faults.append(f"the plan's obstacles of the map cover {outside} cells beyond its edge")
    return faults + _differences(cells, filled)


def _differences(cells: Cells, filled: Sequence[bytearray]) -> list[str]:
    """One sentence for cells that are occupied but free in the plan, one for the others: how many, and the first."""
    missing: list[tuple[int, int]] = []
    added: list[tuple[int, int]] = []
    for r, (row, other) in enumerate(zip(cells.rows, filled, strict=True)):
        if row != other:
            for c, (here, there) in enumerate(zip(row, other, strict=True)):
                if here != there:
                    (missing if here else added).append((r, c))
    faults = []
    for found, what in (
        (missing, "occupied on the map, but no obstacle of the plan covers it"),
        (added, "free on the map, but an obstacle of the plan covers it"),
    ):
        if found:
            others = ("", "; so is 1 other", f"; so are {len(found) - 1} others")[min(len(found) - 1, 2)]
            faults.append(f"the cell at {_place(cells, *found[0])} is {what}{others}")
    return faults


def _place(cells: Cells, row: int, column: int) -> str:
    x = cells.origin[0] + cells.resolution * (column + 0.5)
    y = cells.origin[1] + cells.resolution * (row + 0.5)
    return f"{at((x, y))}, column {column + 1} from the left, row {len(cells.rows) - row} from the top,"


def _on_lattice(obstacle: Circle | Polygon, cells: Cells) -> list[list[tuple[int, int]]] | None:
    """The rings in whole cells, or None if the outline does not run along rows and columns of cells."""
    if isinstance(obstacle, Circle):
        return None
    size, (x0, y0) = cells.resolution, cells.origin
    rings = []
    for ring in obstacle.rings:
        corners = []
        for x, y in ring:
            column, row = round((x - x0) / size), round((y - y0) / size)
            off = max(abs(x0 + size * column - x), abs(y0 + size * row - y))
            if off > _OFF * size + 1e-15 * (abs(x) + abs(y)):
                return None
            corners.append((column, row))
        if any(a[0] != b[0] and a[1] != b[1] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)):
            return None
        rings.append(corners)
    return rings


def _runs(rings: Sequence[Sequence[tuple[int, int]]]) -> Iterator[Run]:
    """The cells that rings wind round, as runs along rows; edges upwards have the inside to their left."""
    rows: dict[int, list[tuple[int, int]]] = {}
    for ring in rings:
        for (x, ya), (_, yb) in zip(ring, [*ring[1:], ring[0]], strict=True):
            turn = -1 if yb > ya else 1
            for row in range(min(ya, yb), max(ya, yb)):
                rows.setdefault(row, []).append((x, turn))
    for row, edges in rows.items():
        edges.sort()
        winding = 0
        for (x, turn), (following, _) in pairwise(edges):
            winding += turn
            if winding and following > x:
                yield row, x, following
