"""The floor without robots: its edge, obstacles, and how close to both a robot's centre may come."""

from __future__ import annotations

from dataclasses import astuple
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path as Outline

from coord.geometry.shapes import grown_outlines
from coord.model.obstacle import Circle, Obstacle
from coord.model.problem import Problem
from coord.output.plots.footprints import compound, extents, words
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
    shapes = sorted({robot.footprint for robot in problem.robots}, key=astuple)
    clearance = problem.workspace.clearance
    for shape, style in zip(dict.fromkeys([shapes[0], shapes[-1]]), ("--", ":"), strict=False):
        # below the obstacles, which hide what lies inside others
        pen: dict[str, Any] = {"fill": False, "ec": GREY, "lw": 0.8, "ls": style, "zorder": 2.5}
        if problem.obstacles:
            rings = grown_outlines(problem.obstacles, shape.core, shape.margin + clearance)
            ax.add_patch(PathPatch(compound(rings), clip_path=ax.patch, **pen))
        left, down, right, up = (reach + clearance for reach in extents(shape))
        ax.add_patch(Rectangle((xmin + left, ymin + down), xmax - xmin - left - right, ymax - ymin - down - up, **pen))
        room = words(shape) + (f" + clearance {clearance:g} m" if clearance else "")
        label = f"no centre comes nearer\n({room.rstrip(',')})"
        handles.append(Line2D([], [], color=GREY, lw=0.8, ls=style, label=label))
    return handles


def outline(obstacle: Obstacle) -> Outline:
    """An obstacle as matplotlib draws it."""
    if isinstance(obstacle, Circle):
        return Outline.circle(obstacle.center, obstacle.radius)
    return compound(obstacle.rings)
