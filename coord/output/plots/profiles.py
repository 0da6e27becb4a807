"""Speed, acceleration and jerk over time, one small column of axes a robot."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.result import Plan, RobotPlan
from coord.output.plots.alone import alone
from coord.output.plots.alternative import alternative
from coord.output.plots.caps import speed_cap
from coord.output.plots.style import ALARM, GREY, INK, colour, delay, find, is_late, new_figure, shown

#: The most robots that one picture can show legibly.
MOST_ROBOTS: Final = 12

#: Robots whose limits differ by more than this factor do not share an axis: the weaker would look flat.
_ALIKE: Final = 5.0

_QUANTITIES: Final = ("speed\n[m/s]", "accel.\n[m/s²]", "jerk\n[m/s³]")


def profiles(plan: Plan, robot: str | None = None) -> Figure:
    """Draw the velocity profiles of a plan's robots.

    Shown are all robots up to ``MOST_ROBOTS``, of more the most delayed ones, or only ``robot``; the title says
    which. All share one axis of time, and the axes of speed, acceleration and jerk unless their limits are too
    different.
    """
    chosen, note = _choose(plan, robot)
    columns = _columns(len(chosen))
    rows = math.ceil(len(chosen) / columns)
    single = columns == 1
    figure = new_figure(7.6 if single else max(3.2 * columns, 7.6), 4.8 if single else 3.3 * rows + 1.0)
    end = 1.03 * max(plan.robots[k].arrival for k in chosen) or 1.0
    grid = figure.add_gridspec(rows, columns)
    panels = []
    for place, k in enumerate(chosen):
        cells = grid[place // columns, place % columns].subgridspec(3, 1, height_ratios=(2, 1, 1))
        axes = [figure.add_subplot(cells[0])]
        axes += [figure.add_subplot(cells[row], sharex=axes[0]) for row in (1, 2)]
        profile(plan.robots[k], axes, colour(k), end, labels=place % columns == 0)
        _tell_why(plan, k, axes)
        panels.append(axes)
    for panel in zip(*panels, strict=True):
        _share(list(panel))
    title = f"{shown(plan.problem.name, 60) or 'Plan'}: how the robots drive, over time"
    figure.suptitle(title + note, x=0.01, ha="left", fontsize=11)
    released = any(plan.robots[k].robot.release > 0 for k in chosen)
    figure.legend(handles=_legend(released), loc="outside lower left", ncols=min(max(columns, 2), 4))
    return figure


def profile(robot: RobotPlan, axes: list[Axes], line_colour: str, end: float, labels: bool = True) -> None:
    """Draw one robot's speed, acceleration and jerk into three axes, with its limits and its speed alone.

    ``end`` [s] is where the time axis ends; ``labels`` writes the quantities beside the axes.
    """
    limits, release = robot.robot.limits, robot.robot.release
    axes[0].plot(*speed_cap(robot, end), color=ALARM, lw=0.7, zorder=1)
    for ax, low, high in zip(
        axes[1:], (-limits.deceleration, -limits.jerk), (limits.acceleration, limits.jerk), strict=True
    ):
        ax.axhline(low, color=ALARM, lw=0.7, zorder=1)
        ax.axhline(high, color=ALARM, lw=0.7, zorder=1)
    ticks = np.asarray(MaxNLocator(nbins=6, steps=[1, 2, 5, 10]).tick_values(0.0, end))
    for ax in axes:
        ax.axhline(0, color=GREY, lw=0.5, zorder=1)
        if release > 0:
            ax.axvline(release, color=GREY, lw=0.9, ls=":", zorder=1)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(labelsize=7, labelbottom=ax is axes[-1])
        ax.set_xticks(ticks[ticks <= end])
    # only the speed: in the other two the dashes would cover what matters
    axes[0].plot(*_curves(alone(robot))[:2], color=GREY, lw=1.0, ls=(0, (4, 2)), zorder=2)
    t, *quantities = _curves(robot.profile)
    for ax, quantity in zip(axes, quantities, strict=True):
        ax.plot(t, quantity, color=line_colour, lw=1.6, zorder=3)
    axes[0].set_xlim(0, end)
    axes[2].set_xlabel("time [s]", fontsize=8)
    late = f"{delay(robot):.2f} s later than alone" if is_late(robot) else "as if alone"
    late += f"; released at {release:g} s" if release > 0 else ""
    axes[0].set_title(f"{shown(robot.robot.name, 20)}: at its goal after {robot.arrival:.2f} s,\n{late}", fontsize=8.5)
    if labels:
        for ax, label in zip(axes, _QUANTITIES, strict=True):
            ax.set_ylabel(label, fontsize=8)


def _tell_why(plan: Plan, k: int, axes: list[Axes]) -> None:
    """Shade when the robot that the delay comes from is too near, and say what passing ahead of it would mean."""
    choice = alternative(plan, plan.robots[k])
    if choice is None:
        return
    other = [one.robot.name for one in plan.robots].index(choice.other)
    for ax in axes:
        ax.axvspan(choice.first, min(choice.last, ax.get_xlim()[1]), color=colour(other), alpha=0.2, lw=0, zorder=0)
    told = axes[0].get_title("left") + f", after {shown(choice.other, 16)}\n({choice.text})"
    axes[0].set_title(told, fontsize=8.5)


def _columns(count: int) -> int:
    """Columns that leave the fewest places empty, about four; up to four robots stand in one row."""
    if count <= 4:
        return count
    return min((3, 4, 5) if count > 5 else (3,), key=lambda columns: (-count % columns, abs(columns - 4)))


def _share(axes: list[Axes]) -> None:
    """Give axes of one quantity the same limits, if that leaves all of them legible."""
    limits = [ax.get_ylim() for ax in axes]
    spans = [high - low for low, high in limits]
    if max(spans) <= _ALIKE * min(spans):
        low, high = min(low for low, _ in limits), max(high for _, high in limits)
        for ax in axes:
            ax.set_ylim(low, high)


def _choose(plan: Plan, name: str | None) -> tuple[list[int], str]:
    """Which robots to show (their places in the plan), and what the title says about it."""
    count = len(plan.robots)
    if name is not None:
        return [plan.robots.index(find(plan, name))], f'\n("{shown(name)}" only)' if count > 1 else ""
    if count <= MOST_ROBOTS:
        return list(range(count)), ""
    late = sorted((k for k in range(count) if is_late(plan.robots[k])), key=lambda k: -delay(plan.robots[k]))
    if not late:
        return list(range(MOST_ROBOTS)), f"\n(the first {MOST_ROBOTS} of {count} robots; nobody is delayed)"
    most = late[:MOST_ROBOTS]
    some = f"the {len(most)} most delayed of" if len(most) < len(late) else f"the {len(late)} delayed robots of"
    return most, f"\n({some} {count} robots, the most delayed first; others with --robot NAME)"


def _curves(motion: VelocityProfile) -> tuple[Array, Array, Array, Array]:
    """Times, speeds, accelerations and jerks to draw; jerks jump, so each knot stands there twice."""
    pieces = [np.array([0.0, motion.departure])]
    pieces += [np.linspace(a, b, 12) for a, b in zip(motion.times[:-1], motion.times[1:], strict=True)]
    jerks = np.concatenate([np.zeros(2), np.repeat(motion.jerks, 12), np.zeros(1)])
    t = np.concatenate([*pieces, motion.times[-1:]])
    _, v, a = motion.state(t).T
    return t, v, a, jerks


def _legend(released: bool) -> list[Artist]:
    handles: list[Artist] = [
        Line2D([], [], color=INK, lw=1.6, label="as planned (colours as on the floor)"),
        Line2D([], [], color=GREY, lw=1.0, ls=(0, (4, 2)), label="speed if alone on the floor"),
        Line2D([], [], color=ALARM, lw=0.7, label="the robot's limits (slower in bends)"),
        Patch(facecolor=(GREY, 0.3), label="the one it lets pass is in its way"),
    ]
    if released:
        handles.append(Line2D([], [], color=GREY, lw=0.9, ls=":", label="released: may not leave earlier"))
    return handles
