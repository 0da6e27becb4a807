"""Speed, acceleration and jerk over time, one small column of axes a robot."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.result import Plan, RobotPlan
from coord.output.plots.alone import alone
from coord.output.plots.style import GREY, colour, delay, find, new_figure, shown

#: The most robots that one picture can show legibly.
MOST_ROBOTS: Final = 12

_LIMIT: Final = "#BB3333"


def profiles(plan: Plan, robot: str | None = None) -> Figure:
    """Draw the velocity profiles of a plan's robots.

    Shown are all robots up to ``MOST_ROBOTS``, of more the first ones (in the order of the file) that arrive
    later than alone, or only ``robot``; the title says which. All share one axis of time.
    """
    chosen, note = _choose(plan, robot)
    columns = min(len(chosen), 4)
    rows = math.ceil(len(chosen) / columns)
    single = columns == 1
    figure = new_figure(7.6 if single else max(3.2 * columns, 7.6), 4.8 if single else 3.3 * rows + 1.0)
    end = 1.03 * max(plan.robots[k].arrival for k in chosen) or 1.0
    grid = figure.add_gridspec(rows, columns)
    for place, k in enumerate(chosen):
        cells = grid[place // columns, place % columns].subgridspec(3, 1, height_ratios=(2, 1, 1))
        axes = [figure.add_subplot(cells[0])]
        axes += [figure.add_subplot(cells[row], sharex=axes[0]) for row in (1, 2)]
        profile(plan.robots[k], axes, colour(k), end, labels=place % columns == 0)
    title = f"{shown(plan.problem.name, 60) or 'Plan'}: how the robots drive, over time"
    figure.suptitle(title + note, x=0.01, ha="left", fontsize=11)
    figure.legend(handles=_legend(), loc="outside lower left", ncols=3)
    return figure


def profile(robot: RobotPlan, axes: list[Axes], line_colour: str, end: float, labels: bool = True) -> None:
    """Draw one robot's speed, acceleration and jerk into three axes, with its limits and its motion alone.

    ``end`` [s] is where the time axis ends; ``labels`` writes the quantities beside the axes.
    """
    limits = robot.robot.limits
    axes[0].plot(*_speed_limit(robot, end), color=_LIMIT, lw=0.7, zorder=1)
    for ax, low, high in zip(
        axes[1:], (-limits.deceleration, -limits.jerk), (limits.acceleration, limits.jerk), strict=True
    ):
        ax.axhline(low, color=_LIMIT, lw=0.7, zorder=1)
        ax.axhline(high, color=_LIMIT, lw=0.7, zorder=1)
    for ax in axes:
        ax.axhline(0, color=GREY, lw=0.5, zorder=1)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(labelsize=7, labelbottom=ax is axes[-1])
    drawn: tuple[tuple[VelocityProfile, dict[str, Any]], ...] = (
        (alone(robot), {"color": GREY, "lw": 1.0, "ls": (0, (4, 2)), "zorder": 2}),
        (robot.profile, {"color": line_colour, "lw": 1.6, "zorder": 3}),
    )
    for motion, options in drawn:
        t, v, a, j = _curves(motion)
        axes[0].plot(t, v, **options)
        axes[1].plot(t, a, **options)
        axes[2].plot(t, j, **options)
    axes[0].set_xlim(0, end)
    axes[2].set_xlabel("time [s]", fontsize=8)
    late = f"{delay(robot):.2f} s later than alone" if delay(robot) > 0.005 else "as if alone"
    axes[0].set_title(f"{shown(robot.robot.name, 20)}: at its goal after {robot.arrival:.2f} s,\n{late}", fontsize=8.5)
    if labels:
        for ax, label in zip(axes, ("speed\n[m/s]", "accel.\n[m/s²]", "jerk\n[m/s³]"), strict=True):
            ax.set_ylabel(label, fontsize=8)


def _choose(plan: Plan, name: str | None) -> tuple[list[int], str]:
    """Which robots to show (their places in the plan), and what the title says about it."""
    count = len(plan.robots)
    if name is not None:
        return [plan.robots.index(find(plan, name))], f'\n("{shown(name)}" only)' if count > 1 else ""
    if count <= MOST_ROBOTS:
        return list(range(count)), ""
    late = [k for k in range(count) if delay(plan.robots[k]) > 0.005]
    if not late:
        return list(range(MOST_ROBOTS)), f"\n(the first {MOST_ROBOTS} of {count} robots; nobody is delayed)"
    first = late[:MOST_ROBOTS]
    some = f"the first {len(first)} of {len(late)}" if len(first) < len(late) else f"the {len(late)}"
    note = f"{some} delayed robots; {count} robots in all; others with --robot NAME"
    return first, f"\n({note})"


def _curves(motion: VelocityProfile) -> tuple[Array, Array, Array, Array]:
    """Times, speeds, accelerations and jerks to draw; jerks jump, so each knot stands there twice."""
    pieces = [np.array([0.0, motion.departure])]
    pieces += [np.linspace(a, b, 12) for a, b in zip(motion.times[:-1], motion.times[1:], strict=True)]
    jerks = np.concatenate([np.zeros(2), np.repeat(motion.jerks, 12), np.zeros(1)])
    t = np.concatenate([*pieces, motion.times[-1:]])
    _, v, a = motion.state(t).T
    return t, v, a, jerks


def _speed_limit(robot: RobotPlan, end: float) -> tuple[Array, Array]:
    """The highest speed allowed where the robot is, over time: in bends the lateral acceleration caps it."""
    limits, profile = robot.robot.limits, robot.profile
    t = np.linspace(profile.departure, profile.arrival, 1 if robot.path.is_straight else 1000)
    bend = np.abs(robot.path.curvature(profile.state(t)[:, 0]))
    with np.errstate(divide="ignore"):
        cap = np.minimum(limits.speed, np.sqrt(limits.lateral_acceleration / bend))
    return np.concatenate([[0.0], t, [max(end, profile.arrival)]]), np.concatenate([cap[:1], cap, cap[-1:]])


def _legend() -> list[Artist]:
    return [
        Line2D([], [], color=colour(0), lw=1.6, label="as planned (colours as on the floor)"),
        Line2D([], [], color=GREY, lw=1.0, ls=(0, (4, 2)), label="alone on the floor"),
        Line2D([], [], color=_LIMIT, lw=0.7, label="the robot's limits (slower in bends)"),
    ]
