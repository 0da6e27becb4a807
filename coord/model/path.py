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
        poses = [self.start]
        for length, k0, k1 in pieces.tolist():
            x, y, heading = poses[-1]
            dx, dy, turn = _advance(np.array([length]), length, k0, k1, heading)
            poses.append((x + float(dx[0]), y + float(dy[0]), heading + float(turn[0])))
        object.__setattr__(self, "poses", frozen(poses, 3))

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
        result = np.empty((len(s), 3))
        index = self._piece(s)
        for k in np.unique(index).tolist():
            chosen = index == k
            if not len(self.pieces):
                result[chosen] = self.start
                continue
            x, y, heading = self.poses[k].tolist()
            length, k0, k1 = self.pieces[k].tolist()
            dx, dy, turn = _advance(s[chosen] - self.breaks[k], length, k0, k1, heading)
            result[chosen] = np.stack([x + dx, y + dy, heading + turn], axis=1)
        return result

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


def _advance(u: Array, length: float, k0: float, k1: float, heading: float) -> tuple[Array, Array, Array]:
    """Displacement (dx, dy) and turn after the arc lengths u within one piece."""
    if k0 == k1:  # a line or an arc, without dividing by the curvature: the chord and its direction
        turn = k0 * u
        chord = u * np.sinc(turn / (2 * np.pi))  # numpy's sinc(x) is sin(pi x)/(pi x)
        return chord * np.cos(heading + turn / 2), chord * np.sin(heading + turn / 2), turn
    rate = (k1 - k0) / length
    v = u[:, None] * _NODES
    angle = heading + (k0 + rate / 2 * v) * v
    dx, dy = u * (np.cos(angle) * _WEIGHTS).sum(axis=1), u * (np.sin(angle) * _WEIGHTS).sum(axis=1)
    return dx, dy, (k0 + rate / 2 * u) * u
