"""One robot's way between the others: how far along its path it is, over time, and when it must not be there."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from coord.model.profile import VelocityProfile
from coord.model.result import Plan, RobotPlan
from coord.output.plots.alone import alone
from coord.output.plots.forbidden import Window, windows
from coord.output.plots.style import GREY, INK, colour, delay, figure_of, find, hatch, new_figure, shown

#: More robots than this are not listed one by one in the legend.
MOST_LISTED = 14


def st(plan: Plan, robot: str | None = None, ax: Axes | None = None) -> Figure:
    """Draw the path-time diagram of one robot (Kant & Zucker 1986; Fraichard 1999).

    Time runs to the right, the way along the robot's path upwards; filled areas are forbidden because a robot
    planned earlier is too close there and then. The areas are sampled from the definition, for the eye only.

    Parameters
    ----------
    robot : whose diagram; without it the robot that the others delay most.
    ax : axes to draw into; without them a figure is made.
    """
    ego = find(plan, robot) if robot is not None else max(plan.robots, key=delay)
    free = alone(ego)
    end = 1.12 * max(ego.arrival, free.arrival) or 1.0
    if ax is None:
        ax = new_figure(9.6, 5.2).add_subplot()
    found = windows(plan, ego, end)
    handles = [_draw_window(ax, plan, ego, window) for window in found]
    _write_names(ax, ego, found, end)
    ax.axhline(ego.path.length, color=INK, lw=0.8, ls=":")
    stay = plan.problem.workspace.after_arrival == "stay"
    ax.plot(*_curve(free, end if stay else free.arrival), color=GREY, lw=1.3, ls=(0, (4, 2)), zorder=4)
    ax.plot(
        *_curve(ego.profile, end if stay else ego.arrival),
        color=INK,
        lw=2.2,
        zorder=5,
        path_effects=[withStroke(linewidth=4, foreground="white")],
    )
    ax.plot([ego.arrival], [ego.path.length], marker="o", ms=7, mfc="white", mec=INK, mew=1.6, zorder=6)
    ax.set_xlim(0, end)
    ax.set_ylim(0, 1.08 * ego.path.length or 1.0)
    ax.set_xlabel("time [s]")
    ax.set_ylabel("distance along its path [m]")
    ax.set_title(_title(plan, ego, robot is None, len(found)))
    ax.legend(
        handles=[*_own_handles(ego, free), *_listed(handles)],
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        borderaxespad=0.0,
    )
    return figure_of(ax)


def _draw_window(ax: Axes, plan: Plan, ego: RobotPlan, window: Window) -> Artist:
    name, k = window.robot.robot.name, plan.robots.index(window.robot)
    fill: dict[str, Any] = {"colors": [colour(k)], "hatches": [hatch(k) or None], "alpha": 0.45, "zorder": 2}
    ax.contourf(window.t, window.s, window.gap, [-1e9, 0.0], **fill)
    ax.contour(window.t, window.s, window.gap, [0.0], colors=[colour(k)], linewidths=1.0, linestyles="solid", zorder=3)
    way = ": lets it pass" if name in ego.after else ": passes ahead of it" if name in ego.before else ""
    return Patch(
        facecolor=(colour(k), 0.45), edgecolor=colour(k), hatch=hatch(k), label=f"too close to {shown(name)}{way}"
    )


def _write_names(ax: Axes, ego: RobotPlan, found: list[Window], end: float) -> None:
    """Write the robots' names into their areas, small areas first, each far from the names and curves before it."""
    length = ego.path.length
    t, s = _curve(ego.profile, end)
    taken = np.column_stack([t / end, s / length])[::20] if length else np.empty((0, 2))
    for window in sorted(found, key=lambda window: (np.ptp(window.t) * np.ptp(window.s), window.robot.robot.name)):
        rows, columns = np.nonzero(window.gap < 0.75 * window.gap.min())
        places = np.column_stack([window.t[columns] / end, window.s[rows] / length])[:: max(1, len(rows) // 500)]
        inside = np.all((places > (0.05, 0.04)) & (places < (0.95, 0.97)), axis=1)
        places = places[inside] if inside.any() else places
        room = np.hypot(*(places[:, None] - taken).transpose(2, 0, 1)).min(axis=1)
        # beyond a fifth of the picture more room is no better
        best = places[np.argmax(np.minimum(room, 0.2).round(3))]
        taken = np.vstack([taken, best])
        name = shown(window.robot.robot.name, 16)
        halo = [withStroke(linewidth=2.2, foreground="white")]
        x, y = float(best[0] * end), float(best[1] * length)
        ax.text(x, y, name, ha="center", va="center", fontsize=8, color=INK, zorder=6, path_effects=halo)


def _own_handles(ego: RobotPlan, free: VelocityProfile) -> list[Artist]:
    return [
        Line2D(
            [],
            [],
            color=INK,
            lw=2.2,
            marker="o",
            mfc="white",
            mec=INK,
            label=f"as planned: arrives at {ego.arrival:.2f} s",
        ),
        Line2D([], [], color=GREY, lw=1.3, ls=(0, (4, 2)), label=f"alone on the floor: {free.arrival:.2f} s"),
        Line2D([], [], color=INK, lw=0.8, ls=":", label=f"goal, after {ego.path.length:.2f} m"),
    ]


def _listed(handles: list[Artist]) -> list[Artist]:
    if len(handles) <= MOST_LISTED:
        return handles
    more = Line2D([], [], ls="none", label=f"and {len(handles) - MOST_LISTED} more robots, named in the picture")
    return [*handles[:MOST_LISTED], more]


def _title(plan: Plan, ego: RobotPlan, chosen_here: bool, met: int) -> str:
    name = shown(ego.robot.name)
    if ego.path.length == 0:
        return f"{name} stays where it is: its goal is its start"
    reason = ", the most delayed robot," if chosen_here and delay(ego) > 0.005 else ""
    if not met:
        return f"How {name}{reason} drives along its path\n(no robot planned earlier comes near it)"
    return (
        f"How {name}{reason} drives between the others\n"
        "(flat: it waits; steep: it drives fast. The line keeps out of the coloured areas:\n"
        "there and then a robot planned earlier would be too close)"
    )


def _curve(motion: VelocityProfile, end: float) -> tuple[np.ndarray, np.ndarray]:
    t = np.concatenate([[0.0], np.linspace(motion.departure, motion.arrival, 600), [end]])
    return t, motion.state(t)[:, 0]
