"""Names on the floor: dark beside each start, pale beside each goal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation

from coord.model.arrays import Array, Point
from coord.model.footprint import Footprint
from coord.model.problem import Problem
from coord.output.plots.footprints import posed
from coord.output.plots.labels import Clutter, Label, place
from coord.output.plots.style import GREY, INK, figure_of, halo, points, shown, text_size
from coord.output.plots.surroundings import outline

#: Directions from a disc in which its name may stand, and how far from its rim [pt]; a far one gets a thin line.
_TURNS: Final = 24
_GAPS: Final = (1.5, 4.0, 9.0, 16.0)
_FAR: Final = 8.0

#: What it costs to lie over a start or goal, a mark, and (a line as long as the letters are high) paths and walls.
_DISC, _MARK, _PATH, _WALL, _EDGE, _LINE = 25.0, 15.0, 5.0, 2.5, 20.0, 0.5


class _Body(NamedTuple):
    """What is drawn at a start or goal: its middle [m], a disc about it that it holds, and its corners from there."""

    middle: Point
    radius: float
    corners: Array


class _Spot(NamedTuple):
    text: Annotation
    body: _Body
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
    bodies = _bodies(problem, lines)
    spots = []
    for size, ink, level, at_start in ((9.0 if few else 7.0, INK, 9.1, True), (7.5 if few else 6.0, GREY, 9.0, False)):
        for k in named:
            robot, way = problem.robots[k], lines[k]
            if not at_start and robot.goal == robot.start:
                continue
            body = bodies[k][0 if at_start else 1]
            text = ax.annotate(
                shown(robot.name, 16),
                body.middle,
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
            spots.append(_Spot(text, body, _heading(way if at_start else way[::-1])))
    clutter, discs, metre = _clutter(ax, problem, lines, bodies, marks)
    labels = [_label(spot, points(ax, [spot.body.middle])[0], discs, metre) for spot in spots]
    for spot, label, chosen in zip(spots, labels, place(labels, clutter), strict=True):
        offset = label.centres[chosen] - points(ax, [spot.body.middle])[0]
        farthest = max(spot.body.radius, float(np.hypot(*spot.body.corners.T).max()))
        _move(ax, spot, offset, farthest * metre, label.size)


def _bodies(problem: Problem, lines: Sequence[Array]) -> list[tuple[_Body, _Body]]:
    """What is drawn of each robot at its start and at its goal."""
    result = []
    for robot, way in zip(problem.robots, lines, strict=True):
        last = (_heading(way[::-1]) or 0.0) + math.pi  # seen from the goal, the way leads back
        shape = robot.footprint
        result.append((_body(shape, robot.start, _heading(way) or 0.0), _body(shape, robot.goal, last)))
    return result


def _body(footprint: Footprint, at: Point, heading: float) -> _Body:
    if not footprint.vertices:
        return _Body(at, footprint.radius, np.zeros((1, 2)))
    (ring,) = posed(footprint, np.array([(*at, heading)]))
    middle = ring.mean(axis=0)
    corners = ring - middle
    along = np.roll(corners, -1, axis=0) - corners
    heights = (corners[:, 0] * along[:, 1] - corners[:, 1] * along[:, 0]) / np.hypot(*along.T)
    return _Body((float(middle[0]), float(middle[1])), float(heights.min()), corners)


def _heading(way: Array) -> float | None:
    """The direction [rad] in which a line begins; None for a point."""
    return math.atan2(*(way[1] - way[0])[::-1]) if len(way) > 1 else None


def _move(ax: Axes, spot: _Spot, offset: Array, radius: float, size: tuple[float, float]) -> None:
    spot.text.xyann = (float(offset[0]), float(offset[1]))
    outside = np.maximum(np.abs(offset) - np.array(size) / 2, 0.0)
    if np.hypot(*outside) > radius + _FAR:
        near = np.clip(0.0, offset - np.array(size) / 2, offset + np.array(size) / 2)
        ax.annotate(
            "",
            spot.body.middle,
            xytext=(float(near[0]), float(near[1])),
            textcoords="offset points",
            arrowprops={"arrowstyle": "-", "lw": 0.6, "color": GREY, "shrinkA": 0, "shrinkB": float(radius)},
            zorder=8.9,
        ).set_in_layout(False)


def _label(spot: _Spot, centre: Array, discs: Array, metre: float) -> Label:
    """All places round a robot: rather close to it, behind it than before it, and level with it or above."""
    width, height = text_size(spot.text)
    size = (width + 4, height + 1)  # some air
    own = int(np.argmin(np.hypot(*(discs[:, :2] - centre).T)))
    radius = float(discs[own, 2])
    places, costs = [], []
    for gap in _GAPS:
        for turn in np.linspace(0, 2 * math.pi, _TURNS, endpoint=False).tolist():
            c, s = math.cos(turn), math.sin(turn)
            aside = (_side(c) * size[0] / 2, _side(s) * size[1] / 2)
            corner = metre * float((spot.body.corners * (c, s)).sum(axis=1).max())
            reach = max(radius, corner) + gap
            places.append((centre[0] + reach * c + aside[0], centre[1] + reach * s + aside[1]))
            ahead = 0.0 if spot.heading is None else math.cos(turn - spot.heading)
            costs.append(0.5 * gap + ahead + 0.5 * abs(c * s) - 0.1 * c - 0.05 * s)
    return Label(np.array(places), np.array(costs), size, own)


def _side(share: float) -> float:
    """How far a box stands to one side of its anchor: fully so from a third of a right angle on."""
    return max(-1.0, min(1.0, 1.6 * share))


def _clutter(
    ax: Axes,
    problem: Problem,
    lines: Sequence[Array],
    bodies: Sequence[tuple[_Body, _Body]],
    marks: Sequence[Point],
) -> tuple[Clutter, Array, float]:
    """All that names keep off, in points; the discs among it: starts, goals, marks; and what a metre is in points."""
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    frame = points(ax, [(x0, y0), (x1, y1)])
    metre = (frame[1, 0] - frame[0, 0]) / (x1 - x0)
    ends = [*(start for start, _ in bodies), *(goal for _, goal in bodies)]
    discs = [(*points(ax, [end.middle])[0], end.radius * metre, _DISC) for end in ends]
    discs += [(*points(ax, [mark])[0], 4.0, _MARK) for mark in marks]
    xmin, ymin, xmax, ymax = problem.workspace.bounds
    edge = np.array([(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax), (xmin, ymin)])
    walls = [np.asarray(ring) for obstacle in problem.obstacles for ring in outline(obstacle).to_polygons()]
    inset = min(end.radius for end in ends) + problem.workspace.clearance
    line = edge + inset * np.array([(1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1)])
    chains = [(edge, _EDGE), (line, _LINE), *((way, _PATH) for way in lines), *((ring, _WALL) for ring in walls)]
    segments = [_segments(points(ax, chain), cost) for chain, cost in chains if len(chain) > 1]
    inner = (frame[0, 0] + 2, frame[0, 1] + 2, frame[1, 0] - 2, frame[1, 1] - 2)
    table = np.array(discs, dtype=np.float64)
    return Clutter(inner, table, np.concatenate(segments)), table, float(metre)


def _segments(chain: Array, cost: float) -> Array:
    return np.column_stack([chain[:-1], chain[1:], np.full(len(chain) - 1, cost)])
