"""The directions that turns round corners may have: from the normal of one edge to that of the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array

TURN = 2 * np.pi

#: [rad] A tangent may touch a corner this far outside its directions, by rounding.
_SLACK = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Cones:
    """Directions from ``first`` [rad] counter-clockwise over ``span``, one cone an entry.

    ``begin``, ``end`` : the unit vectors (2, n) of both ends; ``wide`` : more than half a turn; ``whole`` : all of it.
    """

    first: Array
    span: Array
    begin: Array
    end: Array
    wide: npt.NDArray[np.bool_]
    whole: npt.NDArray[np.bool_]

    @classmethod
    def of(cls, first: Array, span: Array) -> Cones:
        """From arrays (n,) of the first directions and of how far they reach."""
        last = first + span
        begin, end = np.stack([np.cos(first), np.sin(first)]), np.stack([np.cos(last), np.sin(last)])
        return cls(first, span, begin, end, span > np.pi, span >= TURN)

    def allow(self, which: int | npt.NDArray[np.intp], x: Array, y: Array) -> npt.NDArray[np.bool_]:
        """Whether unit vectors lie in one cone, or each in its own."""
        begin, end = self.begin[:, which], self.end[:, which]
        behind, ahead = begin[0] * y - begin[1] * x >= -_SLACK, x * end[1] - y * end[0] >= -_SLACK
        return np.asarray((behind & ahead) | (self.wide[which] & (behind | ahead)) | self.whole[which])

    def rest(self, which: int, side: float, direction: float) -> float:
        """How far [rad] one can turn on to a side (+1 counter-clockwise) from a direction until the cone ends."""
        span = float(self.span[which])
        if span >= TURN:
            return TURN
        turned = side * (direction - float(self.first[which])) + (0.0 if side > 0 else span)
        rest = span - turned % TURN
        # a direction a hair before the cone's first seems to be nearly a turn behind its end
        return (rest if rest >= -2 * _SLACK else min(rest + TURN, span)) + 2 * _SLACK
