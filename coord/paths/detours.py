"""Where and how far a way leaves the straight line: the detours, each with what it has to clear.

The straight line from start to goal is the x axis, y the distance to its left. A *detour* is a run of obstacles
that the way passes on one side; mirrored where needed, so that every detour rises to y > 0. Its *envelope* is
the upper edge of its grown obstacles, exact at every x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from coord.geometry.blocked import Floor
from coord.model.arrays import Array, Point
from coord.model.path import Path
from coord.paths.bends import AIR

#: [rad] A way that turns this far away from the straight line has no single height over it.
_STEEPEST = math.pi / 2 - 0.02

#: Samples of an envelope; and to find where it begins, rounds of so many cuts: 32^10 places are all that doubles tell.
_SAMPLES, _CUTS, _ROUNDS = 400, 32, 10

#: [rad] Bends of the guiding path are looked at this often.
_LOOK = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class Detour:
    """A run of grown obstacles beside or across the straight line, to be passed at y > 0 after mirroring by ``side``.

    Parameters
    ----------
    side : +1 where the way passes left of it, -1 right.
    parts : indices of the floor's parts.
    first, last : x [m] between which the envelope is above the line.
    height : of the envelope [m], h.
    x, envelope : (n,) samples [m], among them its highest places.
    least, most : x [m] that the whole detour has to stay between.
    """

    side: int
    parts: tuple[int, ...]
    first: float
    last: float
    height: float
    x: Array
    envelope: Array
    least: float = -math.inf
    most: float = math.inf

    @property
    def middle(self) -> float:
        """Where the fits are measured from: x [m]."""
        return (self.first + self.last) / 2


class Line:
    """The straight line from start to goal as a frame, and on which side of a part a guiding path passes it."""

    def __init__(self, floor: Floor, start: Point, goal: Point, guide: Path) -> None:
        """Use a path from start to goal that keeps the distances as the guide."""
        self.floor, self.start, self.goal = floor, start, goal
        self.length = math.dist(start, goal)
        self.heading = math.atan2(goal[1] - start[1], goal[0] - start[0])
        self.guide = guide

    def turned(self, points: Array) -> Array:
        """Points (n, 2) of the floor in this frame."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        dx, dy = points[:, 0] - self.start[0], points[:, 1] - self.start[1]
        return np.column_stack([c * dx + s * dy, c * dy - s * dx])

    def back(self, points: Array) -> Array:
        """Points (n, 2) of this frame on the floor."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        x, y = points.T
        return np.column_stack([self.start[0] + c * x - s * y, self.start[1] + s * x + c * y])

    def steepest(self) -> float:
        """The largest angle [rad] between the guide and the line."""
        turn = self.guide.poses[:, 2] - self.heading
        turn -= 2 * math.pi * np.round(turn[:1] / (2 * math.pi))
        return float(np.abs(turn).max(initial=0.0))

    def is_graph(self) -> bool:
        """Whether the guide has one height over every place of the line."""
        return self.steepest() < _STEEPEST

    def sides(self, parts: npt.NDArray[np.intp]) -> list[int]:
        """+1 for the parts that the guide leaves to its right, -1 for the others."""
        path = self.guide
        bends = np.abs(path.pieces[:, 1:]).max(axis=1, initial=0.0)
        s = np.concatenate(
            [
                begin
                + length * np.arange(math.ceil(bend * length / _LOOK) + 1) / (math.ceil(bend * length / _LOOK) + 1)
                for begin, length, bend in zip(
                    path.breaks.tolist(), path.pieces[:, 0].tolist(), bends.tolist(), strict=False
                )
            ]
        )
        guide = self.turned(path.point(np.append(s, path.length)))
        found = []
        for part in parts.tolist():
            x, y = self.turned(self._edges([part])[0][:, :2]).T
            aside = np.maximum(-x, x - self.length)
            k = int(np.argmin(aside))
            found.append(1 if np.interp(x[k], guide[:, 0], guide[:, 1]) > y[k] else -1)
        return found

    def detour(self, side: int, parts: tuple[int, ...]) -> Detour | None:
        """The detour past these parts; None where their envelope stays below the line."""
        edges, rho = self._edges(parts)
        a, b = self.turned(edges[:, :2]) * (1, side), self.turned(edges[:, 2:]) * (1, side)
        tops = a[:, 1] + rho
        height = float(tops.max())
        if height <= 0:
            return None
        low, high = float((a[:, 0] - rho).min()), float((a[:, 0] + rho).max())
        x = np.unique(np.concatenate([np.linspace(low, high, _SAMPLES), a[:, 0]]))
        above = np.flatnonzero(envelope(x, a, b, rho) > 0)
        if not len(above):
            return None
        first = _border(x[max(above[0] - 1, 0)], x[above[0]], a, b, rho)
        last = _border(x[min(above[-1] + 1, len(x) - 1)], x[above[-1]], a, b, rho)
        within = a[(a[:, 0] > first) & (a[:, 0] < last), 0]
        x = np.unique(np.concatenate([np.linspace(first, last, _SAMPLES), within]))
        return Detour(side, parts, first, last, height, x, np.maximum(envelope(x, a, b, rho), 0.0))

    def _edges(self, parts: tuple[int, ...] | list[int]) -> tuple[Array, Array]:
        chosen = np.isin(self.floor.grown.edge_parts, parts)
        return self.floor.grown.edges[chosen], self.floor.rho[self.floor.grown.edge_parts[chosen]]

    def short_of(self, detour: Detour, places: Array) -> float:
        """The largest share of their height that places (n, 2) along a curve of the mirrored frame lack to clear it."""
        edges, rho = self._edges(detour.parts)
        a, b = self.turned(edges[:, :2]) * (1, detour.side), self.turned(edges[:, 2:]) * (1, detour.side)
        inside = places[(places[:, 0] > detour.first) & (places[:, 0] < detour.last)]
        between = np.column_stack([detour.x, np.interp(detour.x, places[:, 0], places[:, 1])])
        all_places = np.concatenate([inside, between])
        lack = envelope(all_places[:, 0], a, b, rho) + AIR - all_places[:, 1]
        return float((lack / np.maximum(all_places[:, 1], AIR)).max(initial=0.0))


def run(line: Line, parts: set[int], closeness: float) -> list[Detour] | str:
    """The detours past these parts in the order of the line, or why they cannot be told apart.

    Neighbours on the same side are passed in one go where the gap between them is smaller than both heights
    together, times the ``closeness``; others share the room between.
    """
    known = np.array(sorted(parts), dtype=np.intp)
    single = [line.detour(side, (part,)) for side, part in zip(line.sides(known), known.tolist(), strict=True)]
    detours = sorted((one for one in single if one is not None), key=lambda one: one.first)
    k = 0
    while k + 1 < len(detours):
        one, two = detours[k : k + 2]
        gap = two.first - one.last
        if one.side == two.side and gap < closeness * (one.height + two.height):
            whole = line.detour(one.side, one.parts + two.parts)
            detours[k : k + 2] = [whole] if whole is not None else []
            k = max(k - 1, 0)
        elif gap <= 0:
            return f"at {two.first:.2f} m along the straight line obstacles are passed on both sides at once"
        else:
            k += 1
    borders = [0.0]
    for one, two in pairwise(detours):
        borders.append(one.last + (two.first - one.last) * one.height / (one.height + two.height))
    borders.append(line.length)
    return [replace(one, least=least, most=most) for one, (least, most) in zip(detours, pairwise(borders), strict=True)]


def envelope(x: Array, a: Array, b: Array, rho: Array) -> Array:
    """Height (n,) [m] at x (n,) of the upper edge of segments a-b (e, 2) grown by rho (e,); -inf: none there."""
    with np.errstate(invalid="ignore", divide="ignore"):
        rise = np.sqrt(rho**2 - (x[:, None] - a[:, 0]) ** 2)
        discs = np.where(np.isnan(rise), -np.inf, a[:, 1] + rise)
        rise = np.sqrt(rho**2 - (x[:, None] - b[:, 0]) ** 2)
        discs = np.maximum(discs, np.where(np.isnan(rise), -np.inf, b[:, 1] + rise))
        along = b - a
        length = np.hypot(along[:, 0], along[:, 1])
        up = np.where(along[:, 0] >= 0, 1.0, -1.0)  # of the two normals the one that points upwards
        ax = a[:, 0] - up * rho * along[:, 1] / length
        ay = a[:, 1] + up * rho * along[:, 0] / length
        share = (x[:, None] - ax) / along[:, 0]
        strips = np.where((share >= 0) & (share <= 1), ay + share * along[:, 1], -np.inf)
    return np.asarray(np.maximum(discs, strips).max(axis=1, initial=-np.inf))


def _border(outside: float, inside: float, a: Array, b: Array, rho: Array) -> float:
    """Where between two x the envelope rises above the line."""
    for _ in range(_ROUNDS):
        x = np.linspace(outside, inside, _CUTS + 1)
        first = int(np.argmax(envelope(x[1:], a, b, rho) > 0))
        outside, inside = float(x[first]), float(x[first + 1])
    return inside
