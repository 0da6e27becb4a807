"""One robot's path, and why it is this one: the line it cannot take, the other side, and how its bends were made."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch

from coord.geometry.growth import grow
from coord.model.arrays import Array, Point
from coord.model.path import Path
from coord.model.problem import Problem
from coord.model.result import Plan, RobotPlan
from coord.model.route import Fit, Route, Way
from coord.output.plots.footprints import drawn, swept
from coord.output.plots.outlines import arrowheads, line
from coord.output.plots.style import ALARM, GREY, INK, colour, find, halo, new_figure, png, shown
from coord.output.plots.surroundings import draw_surroundings
from coord.paths.exponential import hull_points
from coord.paths.skeleton import search_floor

#: The wider side of the floor in the picture [inch]; how flat and how high it may become.
_WIDTH: Final = 6.6
_LOWEST, _HIGHEST = 1.6, 6.6

#: [inch] Room for the words on the right, and for the curvature below.
_WORDS: Final = 3.6
_BELOW: Final = 1.9

#: [1] Air round the path, as a share of its extent, and footprints.
_AIR, _FOOTPRINTS = 0.06, 3.0

#: [rad] A turn in which a path changes its heading by less is not marked.
_FAINT: Final = 1e-3

#: Letters in a line of remarks.
_LETTERS: Final = 52

_SHAPES: Final = {
    "fitted": "fitted turns",
    "exponential": "exponential detour",
    "taut": "tangents and arcs",
    "follow": "along the edge",
    "straight": "straight line",
    "given": "as given",
}


def draw_path(plan: Plan, name: str, route: Route) -> bytes:
    """Draw one robot's path as a PNG file; the same plan and route give the same bytes.

    Raises
    ------
    InvalidValueError
        When no robot has this name.
    """
    return png(lambda: path(plan, name, route))


def path(plan: Plan, name: str, route: Route) -> Figure:
    """The floor about one robot's path, its curvature below, and beside it what each way takes.

    Parameters
    ----------
    route : how the robot's path was found; its ``ways`` are the sides that were compared.
    """
    part = find(plan, name)
    ink = colour([one.robot.name for one in plan.robots].index(name))
    ends = part.robot.start, part.robot.goal
    others = [way for way in route.ways if way.path is None or not _same(way.path, route.path)]
    window = _window(plan.problem, [route.path, *(way.path for way in others if way.path is not None)], part)
    tall = min(max(_WIDTH * (window[3] - window[1]) / (window[2] - window[0]), _LOWEST), _HIGHEST)
    figure = new_figure(_WIDTH + _WORDS, tall + _BELOW + 0.5)
    grid = figure.add_gridspec(2, 2, width_ratios=(_WIDTH, _WORDS), height_ratios=(tall, _BELOW - 0.5))
    top, below, words = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0]), figure.add_subplot(grid[:, 1])
    handles = _draw_floor(top, plan.problem, part, window)
    handles += _draw_ways(top, ends, route, others, ink, part)
    handles += _draw_hulls(top, plan.problem, part, route)
    _draw_curvature(below, route.path, part, ink)
    _write(words, route, others, ends, handles)
    shape = _SHAPES.get(route.shape, route.shape)
    side = {"left": ", left of what is in the way", "right": ", right of what is in the way"}.get(route.side, "")
    figure.suptitle(f"The path of {shown(name)}: {shape}{side}", x=0.01, ha="left", fontsize=11)
    return figure


def _same(one: Path, other: Path) -> bool:
    return one.start == other.start and np.array_equal(one.pieces, other.pieces)


def _window(problem: Problem, paths: Sequence[Path], part: RobotPlan) -> tuple[float, float, float, float]:
    """What the picture shows: the paths with some air, but nothing far outside the floor."""
    places = np.concatenate([line(one)[:, :2] for one in paths])
    low, high = places.min(axis=0), places.max(axis=0)
    air = _FOOTPRINTS * part.robot.footprint.radius + _AIR * float((high - low).max())
    xmin, ymin, xmax, ymax = problem.workspace.bounds
    edge = 0.02 * max(xmax - xmin, ymax - ymin)
    x0, y0 = np.maximum(low - air, (xmin - edge, ymin - edge)).tolist()
    x1, y1 = np.minimum(high + air, (xmax + edge, ymax + edge)).tolist()
    return x0, y0, x1, y1


def _draw_floor(ax: Axes, problem: Problem, part: RobotPlan, window: tuple[float, float, float, float]) -> list[Artist]:
    alone = Problem(problem.name, problem.workspace, (part.robot,), problem.obstacles)
    ax.set_xlim(window[0], window[2])
    ax.set_ylim(window[1], window[3])
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    return draw_surroundings(ax, alone)


def _draw_ways(
    ax: Axes, ends: tuple[Point, Point], route: Route, others: Sequence[Way], ink: str, part: RobotPlan
) -> list[Artist]:
    """The straight line, the other sides, the path with its swept floor, its turns, and start and goal."""
    handles: list[Artist] = []
    robot, poses = part.robot, line(route.path)
    ax.add_patch(PathPatch(swept(route.path, robot.footprint), facecolor=(ink, 0.12), edgecolor="none", zorder=2))
    if route.shape != "straight":
        ax.plot(*np.array(ends).T, color=GREY, lw=1.0, ls=":", zorder=3.6)
        handles.append(Line2D([], [], color=GREY, lw=1.0, ls=":", label="straight line from start to goal"))
    for way in others:
        if way.path is not None:
            ax.plot(*line(way.path)[:, :2].T, color=INK, lw=1.1, ls=(0, (5, 2)), zorder=3.8, path_effects=halo(2.0))
    if any(way.path is not None for way in others):
        label = "the way on the other side" if len(others) == 1 else "other ways"
        handles.append(Line2D([], [], color=INK, lw=1.1, ls=(0, (5, 2)), label=label))
    ax.plot(*poses[:, :2].T, color=ink, lw=2.0, zorder=4, path_effects=halo(3.2))
    for head in arrowheads(poses[:, :2], *_head(ax)):
        ax.fill(*head.T, color=ink, lw=0, zorder=4.2)
    handles.append(Line2D([], [], color=ink, lw=2.0, marker=">", ms=6, label="the path of its centre"))
    marks = route.path.point(turn_ends(route.path))
    if len(marks):
        ax.plot(*marks.T, ls="none", marker="o", ms=4, mfc="white", mec=ink, mew=1.2, zorder=5)
        label = "a turn begins or ends"
        handles.append(Line2D([], [], ls="none", marker="o", ms=4, mfc="white", mec=ink, mew=1.2, label=label))
    start, goal = (drawn(robot.footprint, place, heading) for place, heading in _ends(ends, poses))
    start.set(facecolor=ink, edgecolor="white", lw=0.6, zorder=6)
    goal.set(facecolor=(ink, 0.2), edgecolor=ink, lw=1.6, zorder=6)
    for patch in (start, goal):
        ax.add_patch(patch)
    handles.append(Line2D([], [], ls="none", marker="o", ms=9, mfc=ink, mec="white", label="start"))
    handles.append(Line2D([], [], ls="none", marker="o", ms=9, mfc="none", mec=ink, mew=1.6, label="goal"))
    return handles


def _ends(ends: tuple[Point, Point], poses: Array) -> list[tuple[Point, float]]:
    return [(ends[0], float(poses[0, 2])), (ends[1], float(poses[-1, 2]))]


def _head(ax: Axes) -> tuple[float, float]:
    """Size and spacing [m] of arrowheads."""
    (x0, x1) = ax.get_xlim()
    return (x1 - x0) / 75, (x1 - x0) / 3


def turn_ends(path: Path) -> Array:
    """Arc lengths (n,) [m] at which a path leaves or regains a line; between two of them it turns to one side."""
    marks: list[float] = []
    begin, turned, sign = 0.0, 0.0, 0
    for (length, k0, k1), at in zip(path.pieces.tolist(), path.breaks.tolist(), strict=False):
        bend = length * (k0 + k1) / 2
        now = (bend > 0) - (bend < 0)
        if now != sign:
            if sign and abs(turned) > _FAINT:
                marks += [begin, at]
            begin, turned, sign = at, 0.0, now
        turned += bend
    if sign and abs(turned) > _FAINT:
        marks += [begin, path.length]
    return np.unique(np.array(marks))


def _draw_hulls(ax: Axes, problem: Problem, part: RobotPlan, route: Route) -> list[Artist]:
    """The points that the exponential flanks are fitted to."""
    if not route.fits:
        return []
    robot, workspace = part.robot, problem.workspace
    grown = grow(problem.obstacles, robot.footprint, workspace.clearance, workspace.bounds)
    groups = hull_points(search_floor(grown, [robot.start, robot.goal]), route.path, robot.limits)
    style: dict[str, Any] = {"ls": "none", "marker": ".", "ms": 3, "mfc": ALARM, "mec": "none"}
    for points in groups:
        ax.plot(*points[::2].T, zorder=4.5, **style)
    return [Line2D([], [], label="hull points: rise and fall are fitted to them", **style)]


def _draw_curvature(ax: Axes, path: Path, part: RobotPlan, ink: str) -> None:
    """Curvature along the path, and up to which curvature the robot need not slow down."""
    limits = part.robot.limits
    s = np.unique(np.concatenate([path.breaks, path.breaks[1:] - 1e-9, np.linspace(0, path.length, 400)]))
    s = s[s >= 0]
    ax.fill_between(s, path.curvature(s), color=ink, alpha=0.18, lw=0)
    ax.plot(s, path.curvature(s), color=ink, lw=1.4)
    free = limits.lateral_acceleration / limits.speed**2
    for sign in (1, -1):
        ax.axhline(sign * free, color=ALARM, lw=0.8, ls="--")
    ax.axhline(0.0, color=INK, lw=0.6)
    most = max(1.2 * free, 1.1 * float(np.abs(path.pieces[:, 1:]).max(initial=0.0)), 1e-3)
    ax.set_ylim(-most, most)
    ax.set_xlim(0.0, max(path.length, 1e-3))
    ax.set_xlabel("way along the path [m]")
    ax.set_ylabel("curvature\n[1/m]")
    ax.set_title(
        f"turns left above 0, right below; beyond the dashed lines slower than {limits.speed:g} m/s", fontsize=8.5
    )


def _write(ax: Axes, route: Route, others: Sequence[Way], ends: tuple[Point, Point], handles: Sequence[Artist]) -> None:
    """The legend, the table of ways, the fits and the remarks."""
    ax.set_axis_off()
    ax.legend(handles=list(handles), loc="upper left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.0)
    rows = table(route, others, ends)
    text = "\n".join(rows)
    fits = [_fit(fit) for fit in route.fits]
    if fits:
        text += "\n\nfits, x from the detour's middle:\n" + "\n".join(fits)
    for way in others:
        if way.reason:
            text += "\n\n" + textwrap.fill(f"{way.side}: {way.reason}", _LETTERS)
    for remark in route.remarks:
        text += "\n\n" + textwrap.fill(remark, _LETTERS)
    ax.text(0.0, 0.0, text.replace("$", r"\$"), ha="left", va="bottom", family="DejaVu Sans Mono", fontsize=7.5)


def table(route: Route, others: Sequence[Way], ends: tuple[Point, Point]) -> list[str]:
    """Lines that say how long each way is and takes; the path's own first."""
    chosen = next((way.side for way in route.ways if way.path is not None and _same(way.path, route.path)), route.side)
    rows = [f"{'':<24}{'length':>9} {'time':>9}"]
    rows.append(_row(f"this path{f' ({chosen})' if chosen else ''}", route.path.length, route.time))
    for way in others:
        if way.length is not None:
            told = f"{way.side}, at least" if way.is_bound else f"the other ({way.side})"
            rows.append(_row(told, way.length, way.time))
    rows.append(_row("least on this side", route.least_length, None))
    straight = float(np.hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]))
    rows.append(_row("straight line", straight, None))
    return rows


def _row(name: str, length: float, time: float | None) -> str:
    return f"{name:<24}{length:>7.2f} m" + (f" {time:>7.2f} s" if time is not None else "")


def _fit(fit: Fit) -> str:
    return f"{fit.flank}  y = {fit.A:.3g} exp({fit.B:+.3g} x)   R² {fit.r_squared:.3f}"
