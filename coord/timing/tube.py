"""The tube: with after or before chosen for each window, a lower and an upper bound on s over time.

Because speed is never negative, passing after means s <= U(t) with U nondecreasing up to the end of the
window, passing before means s >= W(t) with W nondecreasing from its beginning on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coord.conflicts.window import Window
from coord.model.arrays import Array


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """A nondecreasing, piecewise linear bound on s.

    As an upper bound it holds for t <= ``times[-1]`` (flat before the first time), as a lower bound for
    t >= ``times[0]`` (flat after the last). ``values`` : (n, 2) [m] at both ends of each piece; may jump up.
    """

    times: Array
    values: Array


@dataclass(frozen=True, slots=True, eq=False)
class Tube:
    """Upper bounds (from windows passed after) and lower bounds (from windows passed before)."""

    upper: Sequence[Bound]
    lower: Sequence[Bound]

    @property
    def events(self) -> list[float]:
        """When bounds from windows passed after end, and those from windows passed before begin [s]."""
        return [float(bound.times[-1]) for bound in self.upper] + [float(bound.times[0]) for bound in self.lower]

    @property
    def spans(self) -> list[tuple[float, float]]:
        """When each of the bounds begins and ends [s]."""
        return [(float(bound.times[0]), float(bound.times[-1])) for bound in (*self.upper, *self.lower)]


def after_bound(window: Window) -> Bound:
    """U(t) = least lower bound of the window from t on."""
    ends = np.minimum.accumulate(window.low.min(axis=1)[::-1])[::-1]
    later = np.concatenate([ends[1:], [np.inf]])
    return Bound(window.times, np.minimum(np.minimum(window.low, window.low[:, 1:]), later[:, None]))


def before_bound(window: Window) -> Bound:
    """W(t) = largest upper bound of the window up to t."""
    times = window.times
    if window.lasts:
        times = np.concatenate([times[:-1], [times[-2] + 1.0]])
    ends = np.maximum.accumulate(window.high.max(axis=1))
    earlier = np.concatenate([[-np.inf], ends[:-1]])
    return Bound(times, np.maximum(np.maximum(window.high, window.high[:, :1]), earlier[:, None]))


def upper_on_cells(bound: Bound, times: Array, margin: float) -> Array:
    """Bezier bounds (N, 4) [m] that keep a cubic in each cell below an upper bound; infinite where none holds.

    In each cell the line between the bound's values at the ends is lowered until it lies below the bound
    everywhere. Cells must not reach across the end of the bound.
    """
    u0, u1, drop = _chords(bound, times)
    share = np.arange(4) / 3
    values = u0[:, None] + (u1 - u0)[:, None] * share - (drop + margin)[:, None]
    return np.where((times[:-1] >= bound.times[-1])[:, None], np.inf, values)


def off_chords(tube: Tube, times: Array) -> Array:
    """By how much (N,) [m] bounds narrow the tube in the cells between knots because they are no lines there."""
    off = np.zeros(len(times) - 1)
    for bound in tube.upper:
        np.maximum(off, np.where(times[:-1] >= bound.times[-1], 0.0, _chords(bound, times)[2]), out=off)
    for bound in tube.lower:
        _, _, drop = _chords(_mirrored(bound), -times[::-1])
        np.maximum(off, np.where(times[1:] <= bound.times[0], 0.0, drop[::-1]), out=off)
    return off


def _chords(bound: Bound, times: Array) -> tuple[Array, Array, Array]:
    """Values (N,), (N,) [m] of an upper bound at both ends of cells, and how far it is below the line in between."""
    start, end = times[:-1], times[1:]
    u0, u1 = _left_value(bound, start), _left_value(bound, end)
    edges = bound.times[1:-1]
    at_edges = np.minimum(bound.values[:-1, 1], bound.values[1:, 0])
    first = (bound.times[:1], bound.values[:1, 0])
    edges, at_edges = np.concatenate([first[0], edges]), np.concatenate([first[1], at_edges])
    cell = np.searchsorted(times, edges, side="right") - 1
    inside = (cell >= 0) & (cell < len(start))
    cell, edges, at_edges = cell[inside], edges[inside], at_edges[inside]
    line = u0[cell] + (u1[cell] - u0[cell]) * (edges - start[cell]) / (end[cell] - start[cell])
    drop = np.zeros(len(start))
    np.maximum.at(drop, cell, line - at_edges)
    return u0, u1, drop


def lower_on_cells(bound: Bound, times: Array, margin: float) -> Array:
    """Bezier bounds (N, 4) [m] that keep a cubic in each cell above a lower bound: the mirror image."""
    return -upper_on_cells(_mirrored(bound), -times[::-1], margin)[::-1, ::-1]


def _mirrored(bound: Bound) -> Bound:
    return Bound(-bound.times[::-1], -bound.values[::-1, ::-1])


def _left_value(bound: Bound, t: Array) -> Array:
    """Value just before t (m,), flat before the bound begins."""
    piece = np.clip(np.searchsorted(bound.times, t, side="left") - 1, 0, len(bound.values) - 1)
    width = np.diff(bound.times)[piece]
    share = np.clip((t - bound.times[piece]) / width, 0.0, 1.0)
    return np.asarray(bound.values[piece, 0] + (bound.values[piece, 1] - bound.values[piece, 0]) * share)
