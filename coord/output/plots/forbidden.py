"""Where on its path a robot must not be, and when: the definition itself, sampled, for drawing only."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from coord.alone.inverse import time_at
from coord.conflicts.core import Core, conflict_core
from coord.model.arrays import Array
from coord.model.profile import VelocityProfile
from coord.model.result import Plan, RobotPlan
from coord.output.plots.outlines import line

#: Samples along each axis, while a window is looked for and when it is drawn.
_COARSE, _FINE = 150, 400

#: [1] Windows further away in time than this share of the picture were never in the way.
_NEAR: Final = 0.12


class Window(NamedTuple):
    """One robot's part of the forbidden set: t (n,) [s], s (m,) [m], gap (m, n) [m], forbidden where negative."""

    robot: RobotPlan
    t: Array
    s: Array
    gap: Array


def windows(plan: Plan, ego: RobotPlan, until: float) -> list[Window]:
    """The windows of all robots planned earlier that ever come near, up to the time ``until`` [s]."""
    names = plan.order[: plan.order.index(ego.robot.name)]
    by_name = {robot.robot.name: robot for robot in plan.robots}
    corners = _box(ego, 0.0)
    result = []
    for other in (by_name[name] for name in names):
        reach = ego.robot.footprint.radius + other.robot.footprint.radius + plan.problem.workspace.clearance
        box = _box(other, reach)
        if np.all(box[0] <= corners[1]) and np.all(corners[0] <= box[1]):
            window = _window(plan, ego, other, until)
            if window is not None:
                result.append(window)
    return result


def matters(window: Window, motions: Sequence[VelocityProfile], end: float) -> bool:
    """Whether a window is near one of these motions in time, or between them: within ``_NEAR`` of the whole time.

    One that a motion passes long before and another long after did matter: it lies between them.
    """
    s, first, last = _taken(window)
    times = [time_at(motion, s) for motion in motions]
    if min(float(np.min(np.maximum(first - t, t - last))) for t in times) < _NEAR * end:
        return True
    return len({bool(np.all(t > last)) for t in times}) > 1


def passes(window: Window, motion: VelocityProfile) -> str:
    """On which side of a window a motion goes by, in words; with a window of several parts it may be both."""
    s, first, last = _taken(window)
    t = time_at(motion, s)
    after, before = bool(np.any(t >= last)), bool(np.any(t <= first))
    if after and before:
        return "passes after and before it" if t[0] >= last[0] else "passes before and after it"
    return "passes after it" if after else "passes before it"


def _taken(window: Window) -> tuple[Array, Array, Array]:
    """Arc lengths (k,) [m] that the window forbids at some time, and the first and last such times (k,) [s]."""
    rows = np.nonzero((window.gap < 0).any(axis=1))[0]
    inside = window.gap[rows] < 0
    first, last = np.argmax(inside, axis=1), inside.shape[1] - 1 - np.argmax(inside[:, ::-1], axis=1)
    return window.s[rows], window.t[first], window.t[last]


def _window(plan: Plan, ego: RobotPlan, other: RobotPlan, until: float) -> Window | None:
    """Sample coarsely to find where the two may come near each other, then finely there."""
    end = other.arrival if plan.problem.workspace.after_arrival == "leave" else until
    if end <= 0 or ego.path.length == 0:
        return None
    t, s = np.linspace(0.0, min(end, until), _COARSE), np.linspace(0.0, ego.path.length, _COARSE)
    # between two samples the distance changes by no more than both can move on the way to the nearer one
    slack = (s[1] + t[1] * other.robot.limits.speed) / 2
    reach = ego.robot.footprint.margin + other.robot.footprint.margin + plan.problem.workspace.clearance
    near = _gap(ego, other, t, s) < reach + slack
    if not near.any():
        return None
    t = np.linspace(*_widened(t, np.nonzero(near.any(axis=0))[0]), _FINE)
    s = np.linspace(*_widened(s, np.nonzero(near.any(axis=1))[0]), _FINE)
    gap = _gap(ego, other, t, s) - reach
    return Window(other, t, s, gap) if gap.min() < 0 else None


def _gap(ego: RobotPlan, other: RobotPlan, t: Array, s: Array) -> Array:
    """Signed distances (m, n) [m] between what planning takes for the cores: ego's at s (m,), the other's at t (n,)."""
    here, there = ego.path.point(s), other.path.point(other.profile.state(t)[:, 0])
    core = conflict_core(ego.robot.footprint.core, other.robot.footprint.core)
    return _signed(here[:, None, 0] - there[:, 0], here[:, None, 1] - there[:, 1], core)


def _signed(x: Array, y: Array, core: Core) -> Array:
    """Signed distances [m] of places x, y from a convex polygon, negative inside, or from a point."""
    if len(core) == 1:
        return np.hypot(x - core[0][0], y - core[0][1])
    deepest, nearest = np.full(x.shape, -np.inf), np.full(x.shape, np.inf)
    for (ax, ay), (bx, by) in pairwise([*core, core[0]]):
        length = np.hypot(bx - ax, by - ay)
        ux, uy = (bx - ax) / length, (by - ay) / length
        aside, along = (x - ax) * uy - (y - ay) * ux, (x - ax) * ux + (y - ay) * uy
        deepest = np.maximum(deepest, aside)
        nearest = np.minimum(nearest, np.hypot(aside, along - np.clip(along, 0.0, length)))
    return np.where(deepest < 0, deepest, nearest)


def _widened(values: Array, chosen: npt.NDArray[np.intp]) -> tuple[float, float]:
    first, last = max(int(chosen[0]) - 1, 0), min(int(chosen[-1]) + 1, len(values) - 1)
    return float(values[first]), float(values[last])


def _box(robot: RobotPlan, margin: float) -> Array:
    points = line(robot.path)[:, :2]
    return np.stack([points.min(axis=0) - margin, points.max(axis=0) + margin])
