"""Paths that share a way, drawn side by side: otherwise the last one drawn would hide the others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from coord.model.arrays import Array
from coord.model.path import Path
from coord.output.plots.outlines import line

#: Samples along a path.
_SAMPLES: Final = 240

#: [1] Sine of the angle up to which two directions count as the same; shorter common ways, in widths, are crossings.
_PARALLEL, _SHORTEST = 0.06, 8.0

_Shared = dict[tuple[int, int], tuple[Array, float]]


def side_by_side(paths: Sequence[Path], width: float) -> list[Array]:
    """Lines (n, 2) to draw for paths: where some share a way each has a lane ``width`` [m] from the next.

    Everywhere else a line is the path itself.
    """
    samples = [path.pose(np.linspace(0.0, path.length, _SAMPLES)) for path in paths]
    shared = _shared(paths, samples, width)
    lanes: list[int] = []
    for i in range(len(paths)):
        taken = {round(shared[i, k][1]) * lanes[k] for k in range(i) if (i, k) in shared}
        lanes.append(min((lane for lane in range(-len(paths), len(paths) + 1) if lane not in taken), key=_outwards))
    return [
        _shifted(path, lane, [mask for (a, _), (mask, _) in shared.items() if a == i], width)
        for i, (path, lane) in enumerate(zip(paths, lanes, strict=True))
    ]


def _outwards(lane: int) -> tuple[int, bool]:
    return abs(lane), lane < 0


def _shared(paths: Sequence[Path], samples: list[Array], width: float) -> _Shared:
    """For each pair (i, k) that shares a way: where on i's samples, and 1 for the same direction, -1 against it."""
    found: _Shared = {}
    boxes = [(poses[:, :2].min(axis=0) - width, poses[:, :2].max(axis=0) + width) for poses in samples]
    for i, here in enumerate(samples):
        for k, there in enumerate(samples):
            apart = np.any(boxes[i][0] > boxes[k][1]) or np.any(boxes[k][0] > boxes[i][1])
            if i == k or apart or not paths[i].length or not paths[k].length:
                continue
            dx, dy = there[:, 0] - here[:, :1], there[:, 1] - here[:, 1:2]
            nearest = np.argmin(dx**2 + dy**2, axis=1)
            rows = np.arange(_SAMPLES)
            cos, sin = np.cos(here[:, 2]), np.sin(here[:, 2])
            ahead = dx[rows, nearest] * cos + dy[rows, nearest] * sin
            aside = dy[rows, nearest] * cos - dx[rows, nearest] * sin
            turn = there[nearest, 2] - here[:, 2]
            mask = (np.abs(aside) < 0.7 * width) & (np.abs(np.sin(turn)) < _PARALLEL)
            mask &= np.abs(ahead) < paths[k].length / _SAMPLES
            if mask.sum() * paths[i].length / _SAMPLES > _SHORTEST * width:
                found[i, k] = (mask, float(np.sign(np.cos(turn[mask]).sum()) or 1.0))
    return {(i, k): value for (i, k), value in found.items() if (k, i) in found}


def _shifted(path: Path, lane: int, masks: list[Array], width: float) -> Array:
    if not lane or not masks:
        return line(path)[:, :2]
    s = np.linspace(0.0, path.length, _SAMPLES)
    count = 2 * max(1, round(3 * width * _SAMPLES / path.length)) + 1
    reach = np.pad(np.logical_or.reduce(masks).astype(float), count // 2, mode="edge")
    share = np.convolve(reach, np.full(count, 1 / count), mode="valid")
    poses = path.pose(s)
    aside = np.column_stack([-np.sin(poses[:, 2]), np.cos(poses[:, 2])])
    return np.asarray(poses[:, :2] + lane * width * share[:, None] * aside)
