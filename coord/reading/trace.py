"""From the cells of a map to polygons: the outlines of the occupied cells, exactly, with holes.

The boundary of the occupied cells runs on the lattice of cell corners. With the occupied cells to the left, the
four cells round a corner say which way the boundary comes in and goes out, so all corners and all straight runs
between them are found with array operations; only the walk from corner to corner is a loop.

Where two occupied cells touch in one corner only, both boundaries turn left there: each keeps to its own cell, so
that cells joined by a corner alone belong to different polygons. A ring that still visits a corner twice is split
there, so every ring is simple. The interior of each polygon is then connected: it has one outer ring.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Ring: TypeAlias = npt.NDArray[np.int64]

_EAST, _NORTH, _WEST, _SOUTH = range(4)

#: Occupied cells round a corner (1 south-west, 2 south-east, 4 north-west, 8 north-east) -> (way in, way out).
_TURNS: dict[int, tuple[tuple[int, int], ...]] = {
    1: ((_NORTH, _WEST),),
    2: ((_WEST, _SOUTH),),
    4: ((_EAST, _NORTH),),
    8: ((_SOUTH, _EAST),),
    7: ((_WEST, _NORTH),),
    11: ((_SOUTH, _WEST),),
    13: ((_NORTH, _EAST),),
    14: ((_EAST, _SOUTH),),
    6: ((_WEST, _SOUTH), (_EAST, _NORTH)),
    9: ((_NORTH, _WEST), (_SOUTH, _EAST)),
}


def trace(occupied: npt.NDArray[np.bool_]) -> list[tuple[Ring, list[Ring]]]:
    """Polygons that cover exactly the occupied cells.

    Parameters
    ----------
    occupied : (rows, columns) array, row 0 at the bottom; cell (r, c) is the square [c, c+1] x [r, r+1].

    Returns
    -------
    (shell, holes) for each polygon: shell (n, 2) counter-clockwise, holes clockwise, whole numbers x, y, first
    vertex not repeated, no vertex on a straight stretch. Polygons meet in single corners at most.
    """
    x, y, into, out = _corners(occupied)
    if not len(x):
        return []
    node = y * (occupied.shape[1] + 1) + x
    rings = _rings(_successors(x, y, node, into, out).tolist(), node.tolist())
    sizes = np.array([len(ring) for ring in rings])
    flat = np.concatenate([np.array(ring) for ring in rings])
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    last = starts + sizes - 1
    follower = np.arange(1, len(flat) + 1)
    follower[last] = starts
    px, py = x[flat], y[flat]
    areas = np.add.reduceat(px * py[follower] - px[follower] * py, starts)
    shell_of = _shells(px, py, follower, np.repeat(np.arange(len(rings)), sizes), areas > 0)
    vertices = np.split(np.stack([px, py], axis=1), starts[1:])
    holes: dict[int, list[Ring]] = {k: [] for k in np.flatnonzero(areas > 0).tolist()}
    for k in np.flatnonzero(areas < 0).tolist():
        holes[shell_of[k]].append(vertices[k])
    return [(vertices[k], inside) for k, inside in holes.items()]


def _corners(occupied: npt.NDArray[np.bool_]) -> tuple[Ring, Ring, Ring, Ring]:
    """All turns of the boundary: x, y, way in, way out; row by row, two entries where two cells touch."""
    rows, columns = occupied.shape
    code = np.zeros((rows + 1, columns + 1), dtype=np.uint8)
    cells = occupied.astype(np.uint8)
    code[1:, 1:] += cells
    code[1:, :-1] += 2 * cells
    code[:-1, 1:] += 4 * cells
    code[:-1, :-1] += 8 * cells
    turns = np.zeros(16, dtype=bool)
    turns[list(_TURNS)] = True
    place = np.flatnonzero(turns[code])
    found = code.ravel()[place]
    first, second = np.full((16, 2), -1), np.full((16, 2), -1)
    for key, pairs in _TURNS.items():
        first[key], second[key] = pairs[0], pairs[-1]
    touching = np.isin(found, (6, 9))
    node = np.concatenate([place, place[touching]])
    ways = np.concatenate([first[found], second[found[touching]]])
    order = np.argsort(node, kind="stable")
    y, x = np.divmod(node[order], columns + 1)
    return x, y, ways[order, 0], ways[order, 1]


def _successors(x: Ring, y: Ring, node: Ring, into: Ring, out: Ring) -> Ring:
    """For each corner the one after it: in a row or column of corners, runs begin and end in turns."""
    successor = np.empty(len(x), dtype=np.int64)
    by_column = np.argsort(x * (int(y.max()) + 1) + y, kind="stable")
    by_row = np.arange(len(node))
    for way in range(4):
        order = by_row if way in (_EAST, _WEST) else by_column
        successor[order[out[order] == way]] = order[into[order] == way]
    return successor


def _rings(successor: list[int], node: list[int]) -> list[list[int]]:
    """The closed walks, each split where it meets a corner again."""
    rings: list[list[int]] = []
    seen = bytearray(len(successor))
    for first in range(len(successor)):
        if seen[first]:
            continue
        walk: list[int] = []
        position: dict[int, int] = {}
        k = first
        while not seen[k]:
            seen[k] = 1
            at = position.get(node[k])
            if at is not None:  # a loop is closed: cut it off, and go on from the corner where it began
                rings.append(walk[at:])
                for cut in walk[at + 1 :]:
                    del position[node[cut]]
                del walk[at:]
            position[node[k]] = len(walk)
            walk.append(k)
            k = successor[k]
        rings.append(walk)
    return rings


def _shells(px: Ring, py: Ring, follower: Ring, ring: Ring, is_shell: npt.NDArray[np.bool_]) -> list[int]:
    """For each ring the shell it belongs to.

    Left of a hole's leftmost edge lie occupied cells of the same polygon, up to the next boundary edge in that
    row. The ring of that edge is the shell, or another hole of it whose leftmost edge lies further left.
    """
    height = py[follower] - py
    runs = np.flatnonzero(height)
    count = np.abs(height[runs])
    low = np.minimum(py, py[follower])[runs]
    row = np.repeat(low - np.concatenate([[0], np.cumsum(count)[:-1]]), count) + np.arange(int(count.sum()))
    edge_x, edge_ring = np.repeat(px[runs], count), np.repeat(ring[runs], count)
    order = np.argsort(row * (int(px.max()) + 1) + edge_x, kind="stable")
    before = np.zeros(len(order), dtype=np.int64)
    before[order[1:]] = edge_ring[order[:-1]]
    leftmost = np.lexsort((edge_x, edge_ring))
    chosen = leftmost[np.searchsorted(edge_ring[leftmost], np.arange(len(is_shell)))]
    parent = np.where(is_shell, np.arange(len(is_shell)), before[chosen])
    while (parent != parent[parent]).any():
        parent = parent[parent]
    return [int(shell) for shell in parent]
