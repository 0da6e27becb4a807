"""A path: pieces of linearly varying curvature, so that lines, arcs and clothoids are one primitive."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from coord.model.arrays import Array, Point, frozen

# Nodes and weights of Gauss-Legendre quadrature on [0, 1]. Measured on a metre from curvature 0: 6 nodes leave
# 3e-10 m at a turn of 1 rad, 16 nodes stay at rounding up to a turn of 6 rad.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A curve on the floor, parametrised by arc length s from 0 to ``length``.

    Parameters
    ----------
    start : x [m], y [m], heading [rad] at s = 0.
    pieces : (n, 3) array: length [m], curvature [1/m] at the start and at the end of each piece.
        Heading is continuous by construction, curvature may jump between pieces.

    ``breaks`` : (n+1,) arc length [m] at the ends of the pieces; ``poses`` : (n+1, 3) poses there.
    """

    start: tuple[float, float, float]
    pieces: Array
    breaks: Array = field(init=False)
    poses: Array = field(init=False)

    def __post_init__(self) -> None:
        pieces = frozen(self.pieces, 3)
        object.__setattr__(self, "pieces", pieces)
        object.__setattr__(self, "breaks", frozen(np.concatenate([[0.0], np.cumsum(pieces[:, 0])])))
        length, k0, k1 = pieces.T
        x, y, heading = self.start
        headings = heading + np.concatenate([[0.0], np.cumsum((k0 + k1) / 2 * length)])
        dx, dy, _ = _advance(length, length, k0, k1, headings[:-1])
        steps = np.concatenate([[[x, y]], np.stack([dx, dy], axis=1)])
        object.__setattr__(self, "poses", frozen(np.column_stack([np.cumsum(steps, axis=0), headings]), 3))

    def __reduce__(self) -> tuple[type[Path], tuple[object, ...]]:
        return (Path, (self.start, self.pieces))

    @property
    def length(self) -> float:
        """Length of the whole path [m]."""
        return float(self.breaks[-1])

    @property
    def end(self) -> Point:
        """The point at the end of the path [m]."""
        return (float(self.poses[-1, 0]), float(self.poses[-1, 1]))

    def pose(self, s: npt.ArrayLike) -> Array:
        """Poses (m, 3): x, y [m] and heading [rad] at the arc lengths s (m,) [m], held at the ends beyond them."""
        s = np.clip(np.atleast_1d(np.asarray(s, dtype=np.float64)), 0.0, self.length)
        if not len(self.pieces):
            return np.tile(self.start, (len(s), 1))
        k = self._piece(s)
        x, y, heading = self.poses[k].T
        length, k0, k1 = self.pieces[k].T
        dx, dy, turn = _advance(s - self.breaks[k], length, k0, k1, heading)
        return np.stack([x + dx, y + dy, heading + turn], axis=1)

    def point(self, s: npt.ArrayLike) -> Array:
        """Points (m, 2) [m] at the arc lengths s (m,) [m]."""
        return self.pose(s)[:, :2]

    def curvature(self, s: npt.ArrayLike) -> Array:
        """Curvature (m,) [1/m] at the arc lengths s (m,) [m]; at a jump, that of the piece that begins there."""
        s = np.clip(np.atleast_1d(np.asarray(s, dtype=np.float64)), 0.0, self.length)
        if not len(self.pieces):
            return np.zeros(len(s))
        k = self._piece(s)
        length, k0, k1 = self.pieces[k].T
        return np.asarray(k0 + (k1 - k0) * (s - self.breaks[k]) / length)

    def _piece(self, s: Array) -> npt.NDArray[np.intp]:
        return np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, max(len(self.pieces) - 1, 0))


def straight(start: Point, goal: Point) -> Path:
    """The straight line from start to goal; a path without pieces where both are the same point."""
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    length = float(np.hypot(dx, dy))
    pose = (start[0], start[1], float(np.arctan2(dy, dx)))
    return Path(pose, frozen([(length, 0.0, 0.0)] if length > 0 else [], 3))


def _advance(u: Array, length: Array, k0: Array, k1: Array, heading: Array) -> tuple[Array, Array, Array]:
    """Displacements (dx, dy) and turns after the arc lengths u (m,), each within a piece of its own."""
    rate = (k1 - k0) / length
    turn = (k0 + rate / 2 * u) * u
    # a line or an arc, without dividing by the curvature: the chord and its direction
    chord = u * np.sinc(turn / (2 * np.pi))  # numpy's sinc(x) is sin(pi x)/(pi x)
    dx, dy = chord * np.cos(heading + turn / 2), chord * np.sin(heading + turn / 2)
    bent = np.flatnonzero(k0 != k1)
    if len(bent):
        v = u[bent, None] * _NODES
        angle = heading[bent, None] + (k0[bent, None] + rate[bent, None] / 2 * v) * v
        dx[bent] = u[bent] * (np.cos(angle) * _WEIGHTS).sum(axis=1)
        dy[bent] = u[bent] * (np.sin(angle) * _WEIGHTS).sum(axis=1)
    return dx, dy, turn
