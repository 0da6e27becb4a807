"""Turns joined by tangents: where lines and curves lie once every turn has its radius and its share of clothoids.

The tangents are those of the turns' effective discs (``turns.effective_radius``), whose radii depend on the
angles by which the turns turn, and these on the radii: a fixed point. When one turn is changed, only the turns
about it are computed anew, as far as the change can be felt.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

from coord.model.arrays import frozen
from coord.model.path import Path
from coord.paths import turns
from coord.paths.skeleton import Skeleton

#: [m] Curves keep this much more than the distance, so that their certificate needs no tiny chords.
AIR = 2e-6

#: [m] Change of an effective radius below which it has converged, for comparing and for good; rounds at most.
_ROUGHLY, _CONVERGED, _MOST_ROUNDS = 1e-6, 1e-12, 100

#: [rad] A turn this sharp is no turn round a corner any more; at a place to pass one may turn back, in a loop.
_SHARPEST, _SHARPEST_AT_PLACE = 3.1, 4.5

#: [m] Pieces shorter than this are left out.
_SHORTEST = 1e-9

Piece = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Bend:
    """How a turn is driven: radius of its sharpest curvature [m], and the clothoids' share of it."""

    radius: float
    share: float


class Bends:
    """All turns of a skeleton with their bends, and the tangents in between."""

    def __init__(self, skeleton: Skeleton, bends: list[Bend]) -> None:
        """Lay the bends out; ``fits`` tells whether that went well.

        ``vanished`` : a turn that would have to turn the other way: its neighbours lead the path past that corner.
        """
        self.skeleton, self.bends = skeleton, bends
        self._places, self._sides = skeleton.places, skeleton.sides
        # a place to pass (radius 0) is met exactly, an obstacle's corner with a little air
        self._rho = [turn.radius + AIR if turn.radius > 0 else 0.0 for turn in skeleton.turns]
        count = len(bends)
        self.radii = [0.0, *self._rho, 0.0]  # of the effective discs, start and goal included
        self.headings, self.lengths = [0.0] * (count + 1), [0.0] * (count + 1)
        self.angles = [turn.angle for turn in skeleton.turns]
        self._is_drawn, self._moved, self._loose = True, (0, count), set[int]()
        self.vanished: int | None = None
        if self._draw(range(count + 1)):
            self._iterate(set(range(count)), _CONVERGED)

    @property
    def fits(self) -> bool:
        """Whether every curve has room on its tangents, and every turn is one."""
        return self._is_drawn and all(self._line(k) >= 0 for k in range(len(self.lengths)))

    def changed(self, k: int, bend: Bend) -> Bends:
        """With another bend at turn k, roughly laid out: to be settled before it becomes a path."""
        other = object.__new__(Bends)
        other.skeleton, other._rho, other._is_drawn, other.vanished = self.skeleton, self._rho, True, None
        other._places, other._sides, other._moved = self._places, self._sides, (k, k + 1)
        other.bends = [*self.bends[:k], bend, *self.bends[k + 1 :]]
        other.radii, other.angles = self.radii.copy(), self.angles.copy()
        other.headings, other.lengths = self.headings.copy(), self.lengths.copy()
        other._iterate({k}, _ROUGHLY)
        return other

    def without(self, k: int) -> Bends:
        """Past corner k, and not round it any more."""
        turns = (*self.skeleton.turns[:k], *self.skeleton.turns[k + 1 :])
        return Bends(dataclasses.replace(self.skeleton, turns=turns), [*self.bends[:k], *self.bends[k + 1 :]])

    def settle(self) -> bool:
        """Lay out exactly what was changed; whether it still fits."""
        self._iterate(self._loose, _CONVERGED)
        return self.fits

    def pieces(self) -> list[Piece]:
        """The path as pieces of linear curvature."""
        result: list[Piece] = []
        for k in range(len(self.lengths)):
            result.append((self._line(k), 0.0, 0.0))
            if k < len(self.bends):
                bend, turn = self.bends[k], self.skeleton.turns[k]
                result += turns.pieces(bend.radius, self.angles[k], bend.share, turn.side)
        return [piece for piece in result if piece[0] > _SHORTEST]

    def path(self) -> Path:
        """The path itself."""
        return Path((*self.skeleton.start, self.headings[0]), frozen(self.pieces(), 3))

    @property
    def moved(self) -> tuple[float, float]:
        """The stretch of the path that the change moved, as arc lengths [m]; a bend more at either end."""
        at = begin = end = 0.0
        for k in range(len(self.lengths)):
            if k == self._moved[0] - 1:
                begin = at
            at += self._line(k) + (self._bend_length(k) if k < len(self.bends) else 0.0)
            if k == self._moved[1]:
                end = at
        return begin, end

    def _bend_length(self, k: int) -> float:
        bend = self.bends[k]
        return bend.radius * self.angles[k] * (1 + bend.share)

    def _line(self, k: int) -> float:
        """What the curves at both ends leave of a tangent [m]."""
        return self.lengths[k] - (self._lead(k - 1) if k else 0.0) - (self._lead(k) if k < len(self.bends) else 0.0)

    def _lead(self, k: int) -> float:
        return turns.lead_in(self.bends[k].radius, self._rho[k], self.angles[k], self.bends[k].share)

    def _iterate(self, dirty: set[int], enough: float) -> None:
        """Iterate effective radii and angles from some turns on, until none changes by more than ``enough`` [m]."""
        self._loose = set()
        for _ in range(_MOST_ROUNDS):
            moved = []
            for k in sorted(dirty):
                bend = self.bends[k]
                radius = turns.effective_radius(bend.radius, self._rho[k], self.angles[k], bend.share)
                if abs(radius - self.radii[k + 1]) > enough:
                    self.radii[k + 1] = radius
                    moved.append(k)
                    self._loose.discard(k)
                elif radius != self.radii[k + 1]:
                    self._loose.add(k)
            if not moved:
                return
            lines = sorted({line for k in moved for line in (k, k + 1)})
            self._moved = (min(self._moved[0], lines[0]), max(self._moved[1], lines[-1]))
            if not self._draw(lines):
                return
            dirty = {k for line in lines for k in (line - 1, line) if 0 <= k < len(self.bends)}
        self._is_drawn = False

    def _draw(self, lines: Sequence[int]) -> bool:
        """Draw some tangents anew; False, and no fit, where discs overlap or a turn vanishes or reverses."""
        places, sides = self._places, self._sides
        for k in lines:
            dx, dy = places[k + 1][0] - places[k][0], places[k + 1][1] - places[k][1]
            shift = sides[k] * self.radii[k] - sides[k + 1] * self.radii[k + 1]
            square = dx * dx + dy * dy - shift * shift
            if square <= 0:
                self._is_drawn = False
                return False
            self.headings[k] = math.atan2(dy, dx) + math.atan2(shift, math.sqrt(square))
            self.lengths[k] = math.sqrt(square)
        for k in {k for line in lines for k in (line - 1, line) if 0 <= k < len(self.bends)}:
            turned = sides[k + 1] * (self.headings[k + 1] - self.headings[k])
            sharpest = _SHARPEST if self._rho[k] > 0 else _SHARPEST_AT_PLACE
            least = sharpest - 2 * math.pi
            self.angles[k] = (turned - least) % (2 * math.pi) + least
            if self.angles[k] <= 0:
                self._is_drawn, self.vanished = False, k
                return False
        return True
