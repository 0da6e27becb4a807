"""The floor from above: who drives where, which floor that takes, and what stands in the way."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle as Disc
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path as Outline
from matplotlib.patheffects import withStroke

from coord.model.obstacle import Circle, Obstacle
from coord.model.result import Plan, RobotPlan
from coord.output.plots.outlines import arrowheads, band, distance_field, line
from coord.output.plots.style import GREY, INK, OBSTACLE, colour, dashes, figure_of, find, new_figure, shown

#: Above this many robots their names would cover the floor.
MOST_NAMES = 60


def workspace(plan: Plan, robot: str | None = None, ax: Axes | None = None) -> Figure:
    """Draw the floor with obstacles, paths, the floor that robots sweep, starts and goals.

    Parameters
    ----------
    robot : the name of a robot to bring out; all others become pale.
    ax : axes to draw into; without them a figure is made.
    """
    if robot is not None:
        find(plan, robot)
    xmin, ymin, xmax, ymax = plan.problem.workspace.bounds
    if ax is None:
        # the longer side of the floor gets 8 inches, the legend has its place beside it
        scale = 8 / max(xmax - xmin, ymax - ymin)
        width, height = max((xmax - xmin) * scale, 2.0), max((ymax - ymin) * scale, 1.6)
        ax = new_figure(width + 3.4, height + 0.9).add_subplot()
    edge = 0.02 * max(xmax - xmin, ymax - ymin)
    ax.set_xlim(xmin - edge, xmax + edge)
    ax.set_ylim(ymin - edge, ymax + edge)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    handles = [*_draw_obstacles(ax, plan), *_draw_robots(ax, plan, robot)]
    ax.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    ax.set_title(_title(plan))
    return figure_of(ax)


def _title(plan: Plan) -> str:
    count, name = len(plan.robots), shown(plan.problem.name, 60) or "The floor"
    robots = "1 robot" if count == 1 else f"{count} robots"
    title = f"{name}: where {robots} drive{'s' if count == 1 else ''}, seen from above"
    return title + (f" (names left out above {MOST_NAMES} robots)" if count > MOST_NAMES else "")


def _draw_robots(ax: Axes, plan: Plan, chosen: str | None) -> list[Artist]:
    xmin, ymin, xmax, ymax = plan.problem.workspace.bounds
    size = 0.011 * max(xmax - xmin, ymax - ymin)
    names = [robot.robot.name for robot in plan.robots]
    strength = [1.0 if chosen in (None, name) else 0.2 for name in names]
    colours = [(colour(k), strength[k]) for k in range(len(names))]
    fills = [(colour(k), 0.16 * strength[k]) for k in range(len(names))]
    styles = [dashes(k) for k in range(len(names))]
    radii = [robot.robot.footprint.radius for robot in plan.robots]
    lines = [line(robot.path)[:, :2] for robot in plan.robots]
    bands = [band(robot.path, radius) for robot, radius in zip(plan.robots, radii, strict=True)]
    starts = [Disc(robot.robot.start, radius) for robot, radius in zip(plan.robots, radii, strict=True)]
    goals = [Disc(robot.robot.goal, radius) for robot, radius in zip(plan.robots, radii, strict=True)]
    heads = [
        (head, colours[k]) for k, robot in enumerate(plan.robots) for head in arrowheads(robot.path, size, 16 * size)
    ]
    ax.add_collection(PolyCollection(bands, facecolors=fills, edgecolors="none", zorder=2), autolim=False)
    ax.add_collection(LineCollection(lines, colors=colours, linewidths=1.4, linestyles=styles, zorder=4), autolim=False)
    arrows = PolyCollection([head for head, _ in heads], facecolors=[c for _, c in heads], edgecolors="none", zorder=5)
    ax.add_collection(arrows, autolim=False)
    rings = PatchCollection(goals, facecolors="none", edgecolors=colours, linewidths=2.0, zorder=6)
    ax.add_collection(rings, autolim=False)
    ax.add_collection(
        PatchCollection(starts, facecolors=colours, edgecolors="white", linewidths=0.6, zorder=7), autolim=False
    )
    for robot, name in zip(plan.robots, names, strict=True):
        if len(names) <= MOST_NAMES or name == chosen:
            _write_name(ax, robot, 9.0 if len(names) <= 20 else 6.5)
    return [
        Line2D(
            [],
            [],
            ls="none",
            marker="o",
            ms=10,
            mfc=colour(0),
            mec="white",
            label="start: the robot as it stands there",
        ),
        Line2D([], [], ls="none", marker="o", ms=10, mfc="none", mec=colour(0), mew=2, label="goal"),
        Line2D([], [], color=colour(0), marker=">", ms=6, label="path of the robot's centre"),
        Patch(facecolor=(colour(0), 0.16), label="floor that the robot sweeps"),
    ]


def _write_name(ax: Axes, robot: RobotPlan, fontsize: float) -> None:
    """Write a robot's name beside its start: behind it, off its path, or where there is room on the floor."""
    name, radius, (x, y) = shown(robot.robot.name, 16), robot.robot.footprint.radius, robot.robot.start
    (xmin, xmax), (ymin, ymax) = ax.get_xlim(), ax.get_ylim()
    metre = 8 * 72 / max(xmax - xmin, ymax - ymin)  # [points], near enough to judge whether a name fits
    width, height = 0.62 * fontsize * len(name) / metre, 1.4 * fontsize / metre
    for turn in (math.pi, math.pi / 2, -math.pi / 2, 0.0):
        c, s = math.cos(robot.path.start[2] + turn), math.sin(robot.path.start[2] + turn)
        side = 0 if abs(c) < 0.5 else math.copysign(1, c)  # the text stands above, below, left or right of its anchor
        level = 0 if side else math.copysign(1, s)
        u, v = x + radius * c, y + radius * s
        left, low = u + width * (side - 1) / 2, v + height * (level - 1) / 2
        if xmin < left < left + width < xmax and ymin < low < low + height < ymax:
            break
    ax.annotate(
        name,
        (u, v),
        xytext=(3 * c, 3 * s),
        textcoords="offset points",
        ha=("center", "left", "right")[int(side)],
        va=("center", "bottom", "top")[int(level)],
        fontsize=fontsize,
        color=INK,
        zorder=8,
        path_effects=[withStroke(linewidth=2.2, foreground="white")],
    )


def _draw_obstacles(ax: Axes, plan: Plan) -> list[Artist]:
    """Obstacles, the edge of the floor, and how close to both a robot's centre may come."""
    problem, bounds = plan.problem, plan.problem.workspace.bounds
    xmin, ymin, xmax, ymax = bounds
    ax.add_patch(Rectangle((xmin, ymin), xmax - xmin, ymax - ymin, fill=False, ec=INK, lw=1.6, zorder=3.2))
    for obstacle in problem.obstacles:
        ax.add_patch(PathPatch(_outline(obstacle), facecolor=OBSTACLE, edgecolor=INK, lw=0.8, zorder=3))
    handles: list[Artist] = [Line2D([], [], color=INK, lw=1.6, label="edge of the floor")]
    if problem.obstacles:
        handles.append(Patch(facecolor=OBSTACLE, edgecolor=INK, label="obstacle"))
    radii = sorted({robot.robot.footprint.radius for robot in plan.robots})
    for radius, style in zip(dict.fromkeys([radii[0], radii[-1]]), ("--", ":"), strict=False):
        reach = radius + problem.workspace.clearance
        if problem.obstacles:
            field = distance_field(problem.obstacles, bounds, reach)
            # below the obstacles, which hide the same line on their inside
            ax.contour(
                field.x, field.y, field.distance, [reach], colors=GREY, linewidths=0.8, linestyles=style, zorder=2.5
            )
        inset = Rectangle((xmin + reach, ymin + reach), xmax - xmin - 2 * reach, ymax - ymin - 2 * reach)
        inset.set(fill=False, ec=GREY, lw=0.8, ls=style, zorder=2.5)
        ax.add_patch(inset)
        clearance = f" + clearance {problem.workspace.clearance:g} m" if problem.workspace.clearance else ""
        label = f"no centre comes nearer\n(radius {radius:g} m{clearance})"
        handles.append(Line2D([], [], color=GREY, lw=0.8, ls=style, label=label))
    return handles


def _outline(obstacle: Obstacle) -> Outline:
    if isinstance(obstacle, Circle):
        return Outline.circle(obstacle.center, obstacle.radius)
    rings = [Outline(np.vstack([ring, ring[:1]]), closed=True) for ring in obstacle.rings]
    return Outline.make_compound_path(*rings)
