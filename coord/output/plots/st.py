"""One robot's way between the others: how far along its path it is, over time, and when it must not be there."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.result import Plan, RobotPlan
from coord.output.plots.alone import alone
from coord.output.plots.alternative import Alternative, alternative
from coord.output.plots.forbidden import Window, matters, passes, windows
from coord.output.plots.labels import Clutter, Label, place
from coord.output.plots.style import (
    GREY,
    INK,
    colour,
    delay,
    figure_of,
    find,
    halo,
    hatch,
    is_late,
    new_figure,
    points,
    shown,
    text_size,
)

#: More robots than this are not listed one by one in the legend.
MOST_LISTED: Final = 14

#: A robot that gives way on the move is shown rather than one that waits at its start, if its delay is not much less.
_ON_THE_MOVE, _MUCH_LESS = ("splice", "program", "gentle", "stop"), 0.2

#: Shade of areas that are far from all that the robot does or would do.
_PALE: Final = "#BBBBBB"


def st(plan: Plan, robot: str | None = None, ax: Axes | None = None) -> Figure:
    """Draw the path-time diagram of one robot (Kant & Zucker 1986; Fraichard 1999).

    Time runs to the right, the way along the robot's path upwards; filled areas are forbidden because a robot
    planned earlier is too close there and then. The areas are sampled from the definition, for the eye only;
    those that are far from the robot in time, planned or alone, are grey.

    Parameters
    ----------
    robot : whose diagram; without it the most delayed one, of those that give way on the move if there are any.
    ax : axes to draw into; without them a figure is made.
    """
    ego, reason = (find(plan, robot), "") if robot is not None else _choose(plan)
    free = alone(ego)
    end = 1.12 * max(ego.arrival, free.arrival) or 1.0
    if ax is None:
        ax = new_figure(9.6, 5.2).add_subplot()
    found = windows(plan, ego, end)
    near = [matters(window, (ego.profile, free), end) for window in found]
    choice = alternative(plan, ego)
    handles = [_draw_window(ax, plan, ego, one, coloured, choice) for one, coloured in zip(found, near, strict=True)]
    ax.axhline(ego.path.length, color=INK, lw=0.8, ls=":")
    stay = plan.problem.workspace.after_arrival == "stay"
    ax.plot(*_curve(free, end if stay else free.arrival), color=GREY, lw=1.3, ls=(0, (4, 2)), zorder=4)
    own = _curve(ego.profile, end if stay else ego.arrival)
    ax.plot(*own, color=INK, lw=2.2, zorder=5, path_effects=halo(4))
    ax.plot([ego.arrival], [ego.path.length], marker="o", ms=7, mfc="white", mec=INK, mew=1.6, zorder=6)
    ax.set_xlim(0, end)
    ax.set_ylim(0, 1.08 * ego.path.length or 1.0)
    ax.set_xlabel("time [s]")
    ax.set_ylabel("distance along its path [m]")
    ax.set_title(_title(plan, ego, reason, len(found)))
    listed = _listed([handle for handle, coloured in zip(handles, near, strict=True) if coloured])
    if not all(near):
        listed.append(Patch(facecolor=_PALE, alpha=0.6, label="others, which it never comes near to"))
    ax.legend(
        handles=[*_own_handles(ego, free), *listed], loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0
    )
    _write_names(ax, ego, found, near, (own, _curve(free, end)))
    return figure_of(ax)


def _choose(plan: Plan) -> tuple[RobotPlan, str]:
    """The robot with most to show, and how the title calls it."""
    most = max(plan.robots, key=delay)
    moving = [robot for robot in plan.robots if robot.how in _ON_THE_MOVE and is_late(robot)]
    best = max(moving, key=delay, default=most)
    if best is most or delay(best) < _MUCH_LESS * delay(most):
        return most, ", the most delayed robot," if is_late(most) else ""
    return best, ", the most delayed of those that give way on the move,"


def _draw_window(
    ax: Axes, plan: Plan, ego: RobotPlan, window: Window, coloured: bool, choice: Alternative | None
) -> Artist:
    name, k = window.robot.robot.name, plan.robots.index(window.robot)
    ink = colour(k) if coloured else _PALE
    fill: dict[str, Any] = {"colors": [ink], "alpha": 0.45, "zorder": 2 if coloured else 1.5}
    if coloured:
        fill["hatches"] = [hatch(k) or None]
    ax.contourf(window.t, window.s, window.gap, [-1e9, 0.0], **fill)
    if coloured:
        ax.contour(window.t, window.s, window.gap, [0.0], colors=[ink], linewidths=1.0, linestyles="solid", zorder=3)
    label = f"too close to {shown(name)}: {passes(window, ego.profile)}"
    if choice is not None and choice.other == name:
        label += f",\nwhich costs it most; {choice.text}"
    return Patch(facecolor=(ink, 0.45), edgecolor=ink, hatch=hatch(k), label=label)


def _write_names(
    ax: Axes, ego: RobotPlan, found: list[Window], near: list[bool], curves: tuple[tuple[Array, Array], ...]
) -> None:
    """Write the robots' names into their areas, where they touch neither each other nor the lines."""
    figure_of(ax).draw_without_rendering()  # only then does the figure know where a second is
    corners = points(ax, [(ax.get_xlim()[0], ax.get_ylim()[0]), (ax.get_xlim()[1], ax.get_ylim()[1])])
    chains = [(points(ax, np.column_stack(curve)[::6]), cost) for curve, cost in zip(curves, (12.0, 4.0), strict=True)]
    segments = [np.column_stack([c[:-1], c[1:], np.full(len(c) - 1, cost)]) for c, cost in chains]
    frame = tuple(float(value) for value in (*(corners[0] + 4), *(corners[1] - 4)))
    goal = points(ax, [(0.0, ego.path.length)])[0, 1]
    line = [[corners[0, 0], goal, corners[1, 0], goal, 4.0]]
    clutter = Clutter(frame, np.empty((0, 4)), np.concatenate([*segments, line]))  # type: ignore[arg-type]
    texts, labels = [], []
    for window, coloured in zip(found, near, strict=True):
        text = ax.text(
            0.0,
            0.0,
            shown(window.robot.robot.name, 16),
            ha="center",
            va="center",
            fontsize=8 if coloured else 7,
            color=INK if coloured else GREY,
            zorder=6,
            path_effects=halo(),
        )
        text.set_in_layout(False)
        labels.append(_label(ax, window, text_size(text)))
        texts.append(text)
    for text, label, chosen in zip(texts, labels, place(labels, clutter), strict=True):
        x, y = label.centres[chosen] * figure_of(ax).dpi / 72
        text.set_position(tuple(ax.transData.inverted().transform((x, y)).tolist()))


def _label(ax: Axes, window: Window, size: tuple[float, float]) -> Label:
    """Places for a name in its area, deep inside rather than at the border; in a narrow area it may stick out."""
    rows, columns = np.nonzero(window.gap < 0.1 * window.gap.min())
    step = max(1, len(rows) // 300)
    centres = points(ax, np.column_stack([window.t[columns], window.s[rows]]))[::step]
    depth = (window.gap[rows, columns] / window.gap.min())[::step]
    aside = np.array([0.35 * size[0], 0.0])
    places = np.concatenate([centres, centres - aside, centres + aside])
    return Label(places, np.concatenate([6 * (1 - depth), 9 - 6 * depth, 9 - 6 * depth]), size)


def _own_handles(ego: RobotPlan, free: VelocityProfile) -> list[Artist]:
    planned = f"as planned: arrives at {ego.arrival:.2f} s"
    return [
        Line2D([], [], color=INK, lw=2.2, marker="o", mfc="white", mec=INK, label=planned),
        Line2D([], [], color=GREY, lw=1.3, ls=(0, (4, 2)), label=f"alone on the floor: {free.arrival:.2f} s"),
        Line2D([], [], color=INK, lw=0.8, ls=":", label=f"goal, after {ego.path.length:.2f} m"),
    ]


def _listed(handles: list[Artist]) -> list[Artist]:
    if len(handles) <= MOST_LISTED:
        return handles
    more = Line2D([], [], ls="none", label=f"and {len(handles) - MOST_LISTED} more robots, named in the picture")
    return [*handles[:MOST_LISTED], more]


def _title(plan: Plan, ego: RobotPlan, reason: str, met: int) -> str:
    name = shown(ego.robot.name)
    if ego.path.length == 0:
        return f"{name} stays where it is: its goal is its start"
    if not met:
        return f"How {name}{reason} drives along its path\n(no robot planned earlier comes near it)"
    return (
        f"How {name}{reason} drives between the others\n"
        "(flat: it waits; steep: it drives fast. The line keeps out of the coloured areas:\n"
        "there and then a robot planned earlier would be too close)"
    )


def _curve(motion: VelocityProfile, end: float) -> tuple[Array, Array]:
    t = np.concatenate([[0.0], np.linspace(motion.departure, motion.arrival, 600), [end]])
    return t, motion.state(t)[:, 0]
