"""A path as a chain of chords, each with the largest distance between the path and its chord."""

from __future__ import annotations

import math
from dataclasses import dataclass

from coord.model.arrays import Array, frozen
from coord.model.path import Path
from coord.tolerances import CHORD_SAGITTA


@dataclass(frozen=True, slots=True, eq=False)
class Chords:
    """A chain of m chords along a path.

    ``s`` : (m+1,) arc length [m] at the ends; ``points`` : (m+1, 2) [m]; ``errors`` : (m,) [m], how far the
    point at an arc length lies at most from the point at the same share of the chord: max|curvature| h^2 / 8.
    Lines are one chord without error.
    """

    s: Array
    points: Array
    errors: Array


def chords(path: Path, sagitta: float = CHORD_SAGITTA) -> Chords:
    """Cut a path into chords whose error stays below ``sagitta`` [m]; a path without pieces has one empty chord."""
    s, errors = [0.0], []
    for start, (length, k0, k1) in zip(path.breaks.tolist(), path.pieces.tolist(), strict=False):
        bend = max(abs(k0), abs(k1))
        count = max(1, math.ceil(length * math.sqrt(bend / (8 * sagitta))))
        s += [start + length * (k + 1) / count for k in range(count)]
        errors += [bend * (length / count) ** 2 / 8] * count
    if not errors:
        s, errors = [0.0, 0.0], [0.0]
    s[-1] = path.length
    return Chords(frozen(s), frozen(path.point(s)), frozen(errors))
