"""A curve y(x) as pieces of linearly varying curvature, which is what paths are made of.

The curvature of the curve is taken at knots and joined by lines; knots lie closer where it bends. What that
loses is put right at the end: two small corrections, each as large as the curvature itself, bring the height at the
last knot back to 0 and the heading to the curve's own, so that a straight line can follow. Where both ends of the
curve are fixed, the pieces are scaled to end there.
"""

from __future__ import annotations

import math
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
    """Pieces (n, 3) from the line y = 0 back to it; ``places`` (m, 2) [m] on the way; x [m] of the ends.

    ``heading`` : [rad] at the first of them.
    """

    pieces: Array
    places: Array
    begin: float
    end: float
    heading: float


def refit(
    curve: Callable[[Array], tuple[Array, Array, Array]], x_from: float, x_to: float, fixed: tuple[bool, bool]
) -> Refit | None:
    """The pieces that follow a curve; None where they cannot be closed.

    Parameters
    ----------
    curve : gives y [m], y' [1] and y'' [1/m] at x (n,) [m]; y and y'' are 0 at both ends.
    fixed : whether the pieces have to begin, and to end, exactly where the curve does; else they may move along the
        line by as much as they are not as long as the curve.
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
    heading, end_heading = math.atan(slope[0]), math.atan(slope[-1])
    closed = _closed(lengths, bends, x, x_from, heading, end_heading)
    if closed is None:
        return None
    pieces = np.column_stack([lengths, closed[:-1], closed[1:]])
    places = _places(pieces, _STEPS, heading)
    more = x_to - x_from - float(places[-1, 0])
    if all(fixed):
        scale = 1 + more / float(places[-1, 0])
        pieces, places, more = pieces * (scale, 1 / scale, 1 / scale), places * scale, 0.0
    # the pieces are not exactly as long as the curve; half of the difference at either end keeps symmetry
    begin = x_from if fixed[0] else x_from + (more if fixed[1] else more / 2)
    places[:, 0] += begin
    return Refit(pieces, places, begin, float(places[-1, 0]), heading)


def _knots(s: Array, curvature: Array) -> Array:
    """Arc lengths between which straight lines miss the curvature by about as much everywhere.

    A line over a length l misses by l^2 |k''| / 8, so l goes with |k''|^(-1/2).
    """
    change = np.abs(np.gradient(np.gradient(curvature, s), s))
    density = np.sqrt(change + 0.02 * change.mean())
    share = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(s))])
    return np.asarray(np.interp(np.linspace(0.0, share[-1], _PIECES + 1), share, s))


def _closed(
    lengths: Array, bends: Array, x: Array, x_from: float, begin_heading: float, end_heading: float
) -> Array | None:
    """Curvatures at the knots, changed so that the last one has its heading and height 0: a Newton iteration."""

    def end(bends: Array) -> tuple[float, float]:
        """Heading [rad], too much, and height [m] at the end."""
        pieces = np.column_stack([lengths, bends[:-1], bends[1:]])
        turns = float((lengths * (bends[:-1] + bends[1:]) / 2).sum())
        return begin_heading + turns - end_heading, float(_places(pieces, 1, begin_heading)[-1, 1])

    even = np.abs(bends)
    odd = even * (x - (x[0] + x[-1]) / 2) / (x[-1] - x[0])
    amounts = [0.0, 0.0]
    step = 1e-4
    for _ in range(_MOST_ROUNDS):
        heading, height = end(bends + amounts[0] * even + amounts[1] * odd)
        if abs(heading) < _CLOSED and abs(height) < _CLOSED * (1 + abs(x_from)):
            return np.asarray(bends + amounts[0] * even + amounts[1] * odd)
        a, c = _rates(end(bends + (amounts[0] + step) * even + amounts[1] * odd), heading, height, step)
        b, d = _rates(end(bends + amounts[0] * even + (amounts[1] + step) * odd), heading, height, step)
        determinant = a * d - b * c
        if determinant == 0:
            return None
        amounts[0] -= (d * heading - b * height) / determinant
        amounts[1] -= (a * height - c * heading) / determinant
    return None


def _rates(there: tuple[float, float], heading: float, height: float, step: float) -> tuple[float, float]:
    return (there[0] - heading) / step, (there[1] - height) / step


def _places(pieces: Array, steps: int, begin_heading: float) -> Array:
    """Places (n steps + 1, 2) along pieces that begin in the origin with a heading [rad]."""
    length, k0, k1 = pieces.T
    share = np.arange(steps) / steps
    h = np.repeat(length / steps, steps)
    rate = np.repeat((k1 - k0) / length, steps)
    begin = (k0[:, None] + (k1 - k0)[:, None] * share).ravel()
    turns = h * (begin + rate * h / 2)
    heading = begin_heading + np.concatenate([[0.0], np.cumsum(turns)[:-1]])
    v = h[:, None] * _NODES
    angle = heading[:, None] + (begin[:, None] + rate[:, None] / 2 * v) * v
    moves = np.stack([(np.cos(angle) * _WEIGHTS).sum(axis=1) * h, (np.sin(angle) * _WEIGHTS).sum(axis=1) * h], axis=1)
    return np.vstack([np.zeros((1, 2)), np.cumsum(moves, axis=0)])
