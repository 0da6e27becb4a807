"""A curve y(x) as pieces of linearly varying curvature, which is what paths are made of.

The curvature of the curve is taken at knots and joined by lines; knots lie closer where it bends. What that
loses is put right at the end: two small corrections, each as large as the curvature itself, bring heading and
height at the last knot back to 0, so that a straight line can follow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coord.model.arrays import Array

#: Pieces of one refit.
_PIECES = 40

#: Samples of the curve between which knots are chosen.
_SAMPLES = 801

#: Steps into which each piece is cut where places along it are wanted.
_STEPS = 6

#: [m, rad] Error left at the last knot, and rounds at most to get there.
_CLOSED, _MOST_ROUNDS = 1e-13, 40

# Nodes and weights of Gauss-Legendre quadrature on [0, 1]; a step turns by far less than a radian.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


@dataclass(frozen=True, slots=True, eq=False)
class Refit:
    """Pieces (n, 3) from the line y = 0 back to it; ``places`` (m, 2) [m] on the way; x [m] of the ends."""

    pieces: Array
    places: Array
    begin: float
    end: float


def refit(curve: Callable[[Array], tuple[Array, Array, Array]], x_from: float, x_to: float) -> Refit | None:
    """The pieces that follow a curve; None where they cannot be closed.

    Parameters
    ----------
    curve : gives y [m], y' [1] and y'' [1/m] at x (n,) [m]; all three are 0 at both ends.
    """
    x = np.linspace(x_from, x_to, _SAMPLES)
    _, slope, second = curve(x)
    stretch = np.sqrt(1 + slope**2)
    curvature = second / stretch**3
    s = np.concatenate([[0.0], np.cumsum((stretch[1:] + stretch[:-1]) / 2 * np.diff(x))])
    knots = _knots(s, curvature)
    lengths, x = np.diff(knots), np.interp(knots, s, x)
    _, slope, second = curve(x)
    bends = second / np.sqrt(1 + slope**2) ** 3
    bends[[0, -1]] = 0.0
    closed = _closed(lengths, bends, x, x_from)
    if closed is None:
        return None
    pieces = np.column_stack([lengths, closed[:-1], closed[1:]])
    places = _places(pieces, _STEPS)
    # the pieces are not exactly as long as the curve; half of the difference at either end keeps symmetry
    begin = x_from + (x_to - x_from - float(places[-1, 0])) / 2
    places[:, 0] += begin
    return Refit(pieces, places, begin, float(places[-1, 0]))


def _knots(s: Array, curvature: Array) -> Array:
    """Arc lengths between which straight lines miss the curvature by about as much everywhere.

    A line over a length l misses by l^2 |k''| / 8, so l goes with |k''|^(-1/2).
    """
    change = np.abs(np.gradient(np.gradient(curvature, s), s))
    density = np.sqrt(change + 0.02 * change.mean())
    share = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(s))])
    return np.asarray(np.interp(np.linspace(0.0, share[-1], _PIECES + 1), share, s))


def _closed(lengths: Array, bends: Array, x: Array, x_from: float) -> Array | None:
    """Curvatures at the knots, changed so that the last one has heading 0 and height 0: a Newton iteration."""
    even = np.abs(bends)
    odd = even * (x - (x[0] + x[-1]) / 2) / (x[-1] - x[0])
    amounts = [0.0, 0.0]
    step = 1e-4
    for _ in range(_MOST_ROUNDS):
        heading, height = _end(lengths, bends + amounts[0] * even + amounts[1] * odd)
        if abs(heading) < _CLOSED and abs(height) < _CLOSED * (1 + abs(x_from)):
            return np.asarray(bends + amounts[0] * even + amounts[1] * odd)
        a, c = _rates(lengths, bends, (amounts[0] + step) * even + amounts[1] * odd, heading, height, step)
        b, d = _rates(lengths, bends, amounts[0] * even + (amounts[1] + step) * odd, heading, height, step)
        determinant = a * d - b * c
        if determinant == 0:
            return None
        amounts[0] -= (d * heading - b * height) / determinant
        amounts[1] -= (a * height - c * heading) / determinant
    return None


def _rates(
    lengths: Array, bends: Array, change: Array, heading: float, height: float, step: float
) -> tuple[float, float]:
    there = _end(lengths, bends + change)
    return (there[0] - heading) / step, (there[1] - height) / step


def _end(lengths: Array, bends: Array) -> tuple[float, float]:
    """Heading [rad] and height [m] at the end of pieces that begin along the x axis."""
    pieces = np.column_stack([lengths, bends[:-1], bends[1:]])
    turns = lengths * (bends[:-1] + bends[1:]) / 2
    return float(turns.sum()), float(_places(pieces, 1)[-1, 1])


def _places(pieces: Array, steps: int) -> Array:
    """Places (n steps + 1, 2) along pieces that begin in the origin along the x axis."""
    length, k0, k1 = pieces.T
    share = np.arange(steps) / steps
    h = np.repeat(length / steps, steps)
    rate = np.repeat((k1 - k0) / length, steps)
    begin = (k0[:, None] + (k1 - k0)[:, None] * share).ravel()
    turns = h * (begin + rate * h / 2)
    heading = np.concatenate([[0.0], np.cumsum(turns)[:-1]])
    v = h[:, None] * _NODES
    angle = heading[:, None] + (begin[:, None] + rate[:, None] / 2 * v) * v
    moves = np.stack([(np.cos(angle) * _WEIGHTS).sum(axis=1) * h, (np.sin(angle) * _WEIGHTS).sum(axis=1) * h], axis=1)
    return np.vstack([np.zeros((1, 2)), np.cumsum(moves, axis=0)])
