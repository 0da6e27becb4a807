"""Names on the floor: dark beside each start, pale beside each goal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation

from coord.model.arrays import Array, Point
from coord.model.problem import Problem
from coord.output.plots.labels import Clutter, Label, place
from coord.output.plots.style import GREY, INK, figure_of, halo, points, shown, text_size
from coord.output.plots.surroundings import outline

#: Directions from a disc in which its name may stand, and how far from its rim [pt]; a far one gets a thin line.
_TURNS: Final = 24
_GAPS: Final = (1.5, 4.0, 9.0, 16.0)
_FAR: Final = 8.0

#: What it costs to lie over a start or goal, a mark, and (a line as long as the letters are high) paths and walls.
_DISC, _MARK, _PATH, _WALL, _EDGE, _LINE = 25.0, 15.0, 5.0, 2.5, 20.0, 0.5


class _Spot(NamedTuple):
    text: Annotation
    at: Point
    radius: float
    heading: float | None


def write_names(
    ax: Axes, problem: Problem, lines: Sequence[Array], named: Sequence[int], marks: Sequence[Point] = ()
) -> None:
    """Write the names of robots at their starts and goals, so that they hide and touch as little as can be.

    Parameters
    ----------
    lines : for each robot the line (n, 2) [m] drawn for it.
    named : which robots get their names.
    marks : centres [m] of other small marks to keep off.
    """
    figure = figure_of(ax)
    figure.draw_without_rendering()  # only after it is laid out does the figure know where a metre is
    few = len(problem.robots) <= 20
    spots = []
    for size, ink, level, at_start in ((9.0 if few else 7.0, INK, 9.1, True), (7.5 if few else 6.0, GREY, 9.0, False)):
        for k in named:
            robot, way = problem.robots[k], lines[k]
            if not at_start and robot.goal == robot.start:
                continue
            text = ax.annotate(
                shown(robot.name, 16),
                robot.start if at_start else robot.goal,
                xytext=(0, 0),
                textcoords="offset points",
                ha="center",
                va="center",
                fontsize=size,
                color=ink,
                zorder=level,
                path_effects=halo(2.0),
            )
            text.set_in_layout(False)
            ends = (way[:2] if at_start else way[::-1][:2]) if len(way) > 1 else way[:0]
            heading = math.atan2(*(ends[1] - ends[0])[::-1]) if len(ends) else None
            spots.append(_Spot(text, robot.start if at_start else robot.goal, robot.footprint.radius, heading))
    clutter, discs = _clutter(ax, problem, lines, marks)
    labels = [_label(spot, points(ax, [spot.at])[0], discs) for spot in spots]
    for spot, label, chosen in zip(spots, labels, place(labels, clutter), strict=True):
        _move(ax, spot, label.centres[chosen] - points(ax, [spot.at])[0], discs[label.own, 2], label.size)


def _move(ax: Axes, spot: _Spot, offset: Array, radius: float, size: tuple[float, float]) -> None:
    spot.text.xyann = (float(offset[0]), float(offset[1]))
    outside = np.maximum(np.abs(offset) - np.array(size) / 2, 0.0)
    if np.hypot(*outside) > radius + _FAR:
        near = np.clip(0.0, offset - np.array(size) / 2, offset + np.array(size) / 2)
        ax.annotate(
            "",
            spot.at,
            xytext=(float(near[0]), float(near[1])),
            textcoords="offset points",
            arrowprops={"arrowstyle": "-", "lw": 0.6, "color": GREY, "shrinkA": 0, "shrinkB": float(radius)},
            zorder=8.9,
        ).set_in_layout(False)


def _label(spot: _Spot, centre: Array, discs: Array) -> Label:
    """All places round a disc: rather close to it, behind the robot than before it, and level with it or above."""
    width, height = text_size(spot.text)
    size = (width + 4, height + 1)  # some air
    own = int(np.argmin(np.hypot(*(discs[:, :2] - centre).T)))
    radius = float(discs[own, 2])
    places, costs = [], []
    for gap in _GAPS:
        for turn in np.linspace(0, 2 * math.pi, _TURNS, endpoint=False).tolist():
            c, s = math.cos(turn), math.sin(turn)
            aside = (_side(c) * size[0] / 2, _side(s) * size[1] / 2)
            places.append((centre[0] + (radius + gap) * c + aside[0], centre[1] + (radius + gap) * s + aside[1]))
            ahead = 0.0 if spot.heading is None else math.cos(turn - spot.heading)
            costs.append(0.5 * gap + ahead + 0.5 * abs(c * s) - 0.1 * c - 0.05 * s)
    return Label(np.array(places), np.array(costs), size, own)


def _side(share: float) -> float:
    """How far a box stands to one side of its anchor: fully so from a third of a right angle on."""
    return max(-1.0, min(1.0, 1.6 * share))


def _clutter(ax: Axes, problem: Problem, lines: Sequence[Array], marks: Sequence[Point]) -> tuple[Clutter, Array]:
    """All that names keep off, in points, and the discs among it: starts, goals, marks."""
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    frame = points(ax, [(x0, y0), (x1, y1)])
    metre = (frame[1, 0] - frame[0, 0]) / (x1 - x0)
    radii = [robot.footprint.radius * metre for robot in problem.robots]
    discs = [(*points(ax, [robot.start])[0], r, _DISC) for robot, r in zip(problem.robots, radii, strict=True)]
    discs += [(*points(ax, [robot.goal])[0], r, _DISC) for robot, r in zip(problem.robots, radii, strict=True)]
    discs += [(*points(ax, [mark])[0], 4.0, _MARK) for mark in marks]
    xmin, ymin, xmax, ymax = problem.workspace.bounds
    edge = np.array([(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax), (xmin, ymin)])
    walls = [np.asarray(ring) for obstacle in problem.obstacles for ring in outline(obstacle).to_polygons()]
    inset = min(radii) / metre + problem.workspace.clearance
    line = edge + inset * np.array([(1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1)])
    chains = [(edge, _EDGE), (line, _LINE), *((way, _PATH) for way in lines), *((ring, _WALL) for ring in walls)]
    segments = [_segments(points(ax, chain), cost) for chain, cost in chains if len(chain) > 1]
    inner = (frame[0, 0] + 2, frame[0, 1] + 2, frame[1, 0] - 2, frame[1, 1] - 2)
    table = np.array(discs, dtype=np.float64)
    return Clutter(inner, table, np.concatenate(segments)), table


def _segments(chain: Array, cost: float) -> Array:
    return np.column_stack([chain[:-1], chain[1:], np.full(len(chain) - 1, cost)])
