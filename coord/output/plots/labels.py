"""Where names stand: each takes the best of its places, so that none covers, or seems to mean, something else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from coord.model.arrays import Array

#: What it costs to cover another name wholly, to leave the frame, and to stand beside a disc that is not meant.
_COVERED, _OUTSIDE, _BESIDE = 60.0, 200.0, 7.0

#: [pt] A disc this far away is no longer taken for the one that is meant.
_APART: Final = 7.0

#: Each name looks for a better place this often, the others staying where they are.
_ROUNDS: Final = 4


class Label(NamedTuple):
    """One name: ``centres`` (n, 2) [pt] it can have, ``costs`` (n,) of each, ``size`` [pt], and the disc it means."""

    centres: Array
    costs: Array
    size: tuple[float, float]
    own: int = -1


class Clutter(NamedTuple):
    """What names keep off: ``discs`` (k, 4): x, y, radius [pt], cost; ``segments`` (m, 5): x, y, x, y [pt], cost."""

    frame: tuple[float, float, float, float]
    discs: Array
    segments: Array


def place(labels: Sequence[Label], clutter: Clutter) -> list[int]:
    """Choose a place for each label: the index into its ``centres``.

    Greedy, one after the other, then a few rounds in which each may move: not the best arrangement of all,
    but one that no single name can better.
    """
    boxes = [_boxes(label) for label in labels]
    alone = [label.costs + _cost(box, label, clutter) for label, box in zip(labels, boxes, strict=True)]
    chosen: dict[int, int] = {}
    for _ in range(_ROUNDS):
        before = dict(chosen)
        for k, box in enumerate(boxes):
            others = np.array([boxes[i][c] for i, c in chosen.items() if i != k]).reshape(-1, 4)
            chosen[k] = int(np.argmin(alone[k] + _covered(box, others)))
        if chosen == before:
            break
    return [chosen[k] for k in range(len(labels))]


def _boxes(label: Label) -> Array:
    half = np.array(label.size) / 2
    return np.concatenate([label.centres - half, label.centres + half], axis=1)


def _cost(boxes: Array, label: Label, clutter: Clutter) -> Array:
    x0, y0, x1, y1 = clutter.frame
    beyond = np.maximum.reduce([x0 - boxes[:, 0], y0 - boxes[:, 1], boxes[:, 2] - x1, boxes[:, 3] - y1])
    cost = np.where(beyond > 0, _OUTSIDE + beyond, 0.0)
    if len(clutter.discs):
        x, y, radius, weight = clutter.discs.T
        dx = x - np.clip(x, boxes[:, :1], boxes[:, 2:3])
        dy = y - np.clip(y, boxes[:, 1:2], boxes[:, 3:])
        room = np.hypot(dx, dy) - radius
        others = np.arange(len(x)) != label.own
        cost += (weight * np.clip(1 - room, 0.0, 4.0) / 4).sum(axis=1)
        cost += (_BESIDE * others * (weight > 0) * np.clip(1 - room / _APART, 0.0, 1.0)).sum(axis=1)
    return cost + _struck(boxes, clutter.segments) / label.size[1]


def _struck(boxes: Array, segments: Array) -> Array:
    """Lengths (n,) [pt] of the segments within the boxes (n, 4), times what they cost (Liang & Barsky 1984)."""
    if not len(segments):
        return np.zeros(len(boxes))
    a, step, weight = segments[:, :2], segments[:, 2:4] - segments[:, :2], segments[:, 4]
    enter, leave = np.zeros((len(boxes), len(segments))), np.ones((len(boxes), len(segments)))
    for axis in (0, 1):
        flat = np.where(np.abs(step[:, axis]) < 1e-9, 1e-9, step[:, axis])
        low = (boxes[:, axis, None] - a[:, axis]) / flat
        high = (boxes[:, axis + 2, None] - a[:, axis]) / flat
        enter, leave = np.maximum(enter, np.minimum(low, high)), np.minimum(leave, np.maximum(low, high))
    inside = np.clip(leave - enter, 0.0, 1.0) * np.hypot(step[:, 0], step[:, 1])
    return np.asarray((inside * weight).sum(axis=1))


def _covered(boxes: Array, others: Array) -> Array:
    """What it costs that the boxes (n, 4) lie over those of other names (m, 4); a point of air is wanted."""
    width = np.minimum(boxes[:, 2, None], others[:, 2]) - np.maximum(boxes[:, 0, None], others[:, 0]) + 1
    height = np.minimum(boxes[:, 3, None], others[:, 3]) - np.maximum(boxes[:, 1, None], others[:, 1]) + 1
    area = np.prod(boxes[:, 2:] - boxes[:, :2], axis=1)[:, None]
    share = np.maximum(width, 0) * np.maximum(height, 0) / area
    return np.asarray((np.where(share > 0, _COVERED / 3, 0.0) + _COVERED * share).sum(axis=1))
