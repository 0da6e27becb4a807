"""The floor from above: who drives where, which floor that takes, and what stands in the way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection, PathCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coord.model.arrays import Array
from coord.model.path import Path, straight
from coord.model.problem import Problem
from coord.model.result import Diagnosis, Plan
from coord.output.plots.footprints import drawn, swept
from coord.output.plots.giving_way import GivesWay, giving_way
from coord.output.plots.lanes import side_by_side
from coord.output.plots.names import write_names
from coord.output.plots.outlines import arrowheads, line
from coord.output.plots.style import ALARM, GREY, colour, dashes, figure_of, find, halo, new_figure, shown
from coord.output.plots.surroundings import draw_surroundings

#: Above this many robots their names would cover the floor.
MOST_NAMES: Final = 60

#: Up to this many places where somebody gives way are told one by one.
MOST_TOLD: Final = 8

#: The longer side of the floor in a picture [inch], and the room round it for names [pt].
_FLOOR, _MARGIN = 8.0, 20.0

#: [pt] From one line to the next where paths share a way.
_LANE: Final = 2.1


def workspace(plan: Plan, robot: str | None = None, ax: Axes | None = None) -> Figure:
    """Draw the floor with obstacles, paths, the floor that robots sweep, starts, goals, and who gives way where.

    Parameters
    ----------
    robot : the name of a robot to bring out; all others become pale.
    ax : axes to draw into; without them a figure is made.
    """
    if robot is not None:
        find(plan, robot)
    problem = plan.problem
    ax = _axes(problem, ax)
    names = [part.robot.name for part in plan.robots]
    strength = [1.0 if robot in (None, name) else 0.2 for name in names]
    paths = [part.path for part in plan.robots]
    marks = [mark for mark in giving_way(plan) if robot in (None, mark.robot.robot.name)]
    handles = draw_surroundings(ax, problem)
    handles += [*_draw_paths(ax, problem, paths, strength), *_draw_ends(ax, problem, _headings(paths), strength)]
    handles += _draw_marks(ax, marks, names)
    count, name = len(names), shown(problem.name, 60) or "The floor"
    title = f"{name}: where {'1 robot drives' if count == 1 else f'{count} robots drive'}, seen from above"
    chosen = [k for k, name in enumerate(names) if count <= MOST_NAMES or name == robot]
    _finish(ax, problem, title, handles)
    write_names(ax, problem, [line(path)[:, :2] for path in paths], chosen, [mark.place for mark in marks])
    return figure_of(ax)


def floor(problem: Problem, diagnoses: Sequence[Diagnosis] = (), ax: Axes | None = None) -> Figure:
    """Draw what is known of a problem without a plan: starts, goals, obstacles, and where the diagnoses point to."""
    ax = _axes(problem, ax)
    strength = [1.0] * len(problem.robots)
    flights = [np.array([robot.start, robot.goal]) for robot in problem.robots]
    colours = [colour(k) for k in range(len(flights))]
    ax.add_collection(LineCollection(flights, colors=colours, linewidths=0.9, linestyles=":", zorder=4), autolim=False)
    headings = _headings([straight(robot.start, robot.goal) for robot in problem.robots])
    handles = [*draw_surroundings(ax, problem), *_draw_ends(ax, problem, headings, strength)]
    handles.append(Line2D([], [], color=GREY, lw=0.9, ls=":", label="from start to goal, not a path"))
    marks = [(diagnosis.place, diagnosis.code) for diagnosis in diagnoses if diagnosis.place is not None]
    for (x, y), _ in marks:
        ax.plot([x], [y], ls="none", marker="X", ms=9, mfc=ALARM, mec="white", mew=1.0, zorder=8)
    if marks:
        codes = ", ".join(dict.fromkeys(code for _, code in marks))
        handles.append(Line2D([], [], ls="none", marker="X", ms=9, mfc=ALARM, mec="white", label=f"reason: {codes}"))
    _finish(ax, problem, f"{shown(problem.name, 60) or 'The floor'}: there is no plan; starts and goals", handles)
    few = range(len(flights) if len(flights) <= MOST_NAMES else 0)
    write_names(ax, problem, flights, few, [place for place, _ in marks])
    return figure_of(ax)


def _axes(problem: Problem, ax: Axes | None) -> Axes:
    xmin, ymin, xmax, ymax = problem.workspace.bounds
    point = _point(problem)
    edge = _MARGIN * point
    if ax is None:
        inch = 72 * point
        width, height = (xmax - xmin + 2 * edge) / inch, (ymax - ymin + 2 * edge) / inch
        ax = new_figure(width + 3.7, max(height, 2.2) + 0.85).add_subplot()  # the legend stands beside the floor
    ax.set_xlim(xmin - edge, xmax + edge)
    ax.set_ylim(ymin - edge, ymax + edge)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    return ax


def _point(problem: Problem) -> float:
    """What a typographic point is on the floor [m], in a figure of our size."""
    xmin, ymin, xmax, ymax = problem.workspace.bounds
    return max(xmax - xmin, ymax - ymin) / (72 * _FLOOR - 2 * _MARGIN)


def _finish(ax: Axes, problem: Problem, title: str, handles: list[Artist]) -> None:
    ax.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    many = len(problem.robots) > MOST_NAMES
    ax.set_title(title + (f" (names left out above {MOST_NAMES} robots)" if many else ""))


def _draw_paths(ax: Axes, problem: Problem, paths: list[Path], strength: list[float]) -> list[Artist]:
    """The band of floor and the line of each path, with its direction."""
    metre, count = _point(problem), len(paths)
    colours = [(colour(k), strength[k]) for k in range(count)]
    fills = [(colour(k), 0.14 * strength[k]) for k in range(count)]
    bands = [swept(path, robot.footprint) for path, robot in zip(paths, problem.robots, strict=True)]
    ax.add_collection(PathCollection(bands, facecolors=fills, edgecolors="none", zorder=2), autolim=False)
    lines: list[Array] = [line(path)[:, :2] for path in paths]
    lanes = side_by_side(paths, _LANE * metre) if count <= MOST_NAMES else lines
    shared = any(len(way) != len(lane) for way, lane in zip(lines, lanes, strict=True))
    lines = lanes
    styles = [dashes(k) for k in range(count)]
    ways = LineCollection(lines, colors=colours, linewidths=1.4, linestyles=styles, zorder=4, path_effects=halo(2.4))
    ax.add_collection(ways, autolim=False)
    heads: list[Array] = []
    fills = []
    for k, way in enumerate(lines):
        found = arrowheads(way, 6 * metre, 100 * metre)
        heads += found
        fills += [colours[k]] * len(found)
    ax.add_collection(PolyCollection(heads, facecolors=fills, edgecolors="none", zorder=5), autolim=False)
    told = "path of the centre" + (" (shared: side by side)" if shared else "")
    return [
        Line2D([], [], color=GREY, lw=1.4, marker=">", ms=6, label=told),
        Patch(facecolor=(GREY, 0.25), label="floor that the robot sweeps"),
    ]


def _draw_ends(
    ax: Axes, problem: Problem, headings: Sequence[tuple[float, float]], strength: list[float]
) -> list[Artist]:
    """Starts as filled footprints, and goals as rings with a white border, so that a ring is seen on a start too.

    ``headings`` [rad] : at the start and at the goal, for footprints that turn.
    """
    robots, point = problem.robots, _point(problem)
    colours = [(colour(k), strength[k]) for k in range(len(robots))]
    turned = list(zip(robots, headings, strict=True))
    starts = [drawn(robot.footprint, robot.start, first) for robot, (first, _) in turned]
    goals = [drawn(robot.footprint, robot.goal, last) for robot, (_, last) in turned]
    widths = [min(2.0, 0.4 * robot.footprint.radius / point) for robot in robots]
    discs = PatchCollection(starts, facecolors=colours, edgecolors="white", linewidths=0.6, zorder=6)
    borders = PatchCollection(goals, facecolors="none", edgecolors="white", linewidths=[2.2 * w for w in widths])
    rings = PatchCollection(goals, facecolors="none", edgecolors=colours, linewidths=widths, zorder=7)
    borders.set(zorder=6.9, alpha=0.9)
    for collection in (discs, borders, rings):
        ax.add_collection(collection, autolim=False)
    style: dict[str, Any] = {
        "ls": "none",
        "marker": "s" if all(one.footprint.vertices for one in robots) else "o",
        "ms": 10,
    }
    return [
        Line2D([], [], mfc=GREY, mec="white", label="start, with the robot's name", **style),
        Line2D([], [], mfc="none", mec=GREY, mew=2, label="goal, its name in grey", **style),
    ]


def _headings(paths: Sequence[Path]) -> list[tuple[float, float]]:
    """The headings [rad] in which paths begin and end."""
    return [(float(path.poses[0, 2]), float(path.poses[-1, 2])) for path in paths]


def _draw_marks(ax: Axes, marks: list[GivesWay], names: list[str]) -> list[Artist]:
    """Hollow diamonds where robots give way; told one by one if they are few."""
    style: dict[str, Any] = {"ls": "none", "marker": "D", "ms": 6, "mfc": "white", "mew": 1.6}
    handles: list[Artist] = []
    for mark in marks:
        name, other = mark.robot.robot.name, mark.other.robot.name
        ink = colour(names.index(name))
        ax.plot(*mark.place, mec=ink, zorder=8, path_effects=halo(3.2), **style)
        name, other = shown(name, 16), shown(other, 16)
        told = f"here {name}{chr(10) if len(name + other) > 16 else ''} lets {other} pass"
        handles.append(Line2D([], [], mec=ink, label=told, **style))
    if len(handles) > MOST_TOLD:
        return [Line2D([], [], mec=GREY, label="here this robot lets another pass", **style)]
    return handles
