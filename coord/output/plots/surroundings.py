"""The floor without robots: its edge, obstacles, and how close to both a robot's centre may come."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path as Outline

from coord.model.obstacle import Circle, Obstacle
from coord.model.problem import Problem
from coord.output.plots.outlines import distance_field
from coord.output.plots.style import GREY, INK, OBSTACLE


def draw_surroundings(ax: Axes, problem: Problem) -> list[Artist]:
    """Draw obstacles, the edge of the floor, and the lines that no centre crosses; what the legend shows of it."""
    bounds = problem.workspace.bounds
    xmin, ymin, xmax, ymax = bounds
    ax.add_patch(Rectangle((xmin, ymin), xmax - xmin, ymax - ymin, fill=False, ec=INK, lw=1.6, zorder=3.2))
    for obstacle in problem.obstacles:
        ax.add_patch(PathPatch(outline(obstacle), facecolor=OBSTACLE, edgecolor=INK, lw=0.8, zorder=3))
    handles: list[Artist] = [Line2D([], [], color=INK, lw=1.6, label="edge of the floor")]
    if problem.obstacles:
        handles.append(Patch(facecolor=OBSTACLE, edgecolor=INK, label="obstacle"))
    radii = sorted({robot.footprint.radius for robot in problem.robots})
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


def outline(obstacle: Obstacle) -> Outline:
    """An obstacle as matplotlib draws it."""
    if isinstance(obstacle, Circle):
        return Outline.circle(obstacle.center, obstacle.radius)
    rings = [Outline(np.vstack([ring, ring[:1]]), closed=True) for ring in obstacle.rings]
    return Outline.make_compound_path(*rings)
