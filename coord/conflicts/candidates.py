"""Which robots can meet at all: pairs whose paths come near each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coord.conflicts.chords import Chords
from coord.geometry.index import touching_boxes
from coord.model.arrays import Array

#: [m] Paths are cut into chunks of this length for the search, so that long diagonals do not fill the floor.
_CHUNK = 4.0


def candidate_pairs(paths: Sequence[Chords], reaches: Sequence[float]) -> list[tuple[int, int]]:
    """Pairs (i, k), i < k, of paths with chunks whose boxes, widened by both reaches [m], touch.

    Parameters
    ----------
    reaches : how far each robot reaches from its path, its share of the clearance included.
    """
    boxes, owners = [], []
    for owner, (path, reach) in enumerate(zip(paths, reaches, strict=True)):
        own = _boxes(path, reach)
        boxes.append(own)
        owners.append(np.full(len(own), owner))
    pairs = np.concatenate(owners)[touching_boxes(np.concatenate(boxes))]
    pairs = np.unique(np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1), axis=0)
    return [(int(i), int(k)) for i, k in pairs]


def _boxes(path: Chords, reach: float) -> Array:
    count = max(1, int(np.ceil(path.s[-1] / _CHUNK)))
    edges = np.linspace(0.0, path.s[-1], count + 1)
    at = np.stack([np.interp(edges, path.s, path.points[:, axis]) for axis in (0, 1)], axis=1)
    low, high = np.minimum(at[:-1], at[1:]), np.maximum(at[:-1], at[1:])
    chunk = np.clip(np.searchsorted(edges, path.s, side="right") - 1, 0, count - 1)
    np.minimum.at(low, chunk, path.points)
    np.maximum.at(high, chunk, path.points)
    pad = reach + float(path.errors.max())
    return np.concatenate([low - pad, high + pad], axis=1)
