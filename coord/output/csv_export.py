"""Plans as CSV: where every robot is, at a fixed time step, for spreadsheets, players and other programs."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from typing import BinaryIO, Final

import numpy as np

from coord.errors import InvalidValueError
from coord.model.arrays import Array
from coord.model.result import Plan, RobotPlan

COLUMNS: Final = ("t", "robot", "x", "y", "heading", "s", "v", "a", "j")

#: [s] A finer step is refused: a robot's rows would no longer fit into memory.
SMALLEST_STEP: Final = 1e-4

#: [s] A row this close before the arrival would only repeat it.
SAME_TIME: Final = 1e-9


def write_csv(plan: Plan, stream: BinaryIO, step: float = 0.05) -> None:
    """Write a plan as CSV, UTF-8, to a binary stream.

    The columns are ``t,robot,x,y,heading,s,v,a,j``; robots stand in the order of the file, each from t = 0 to
    exactly its arrival, ``step`` [s] apart. Floats are written by ``repr``; ``heading`` [rad] is the tangent of
    the path, continuous; ``j`` [m/s3] is the jerk just after t, 0 in a robot's last row.

    Raises
    ------
    InvalidValueError
        When ``step`` is not a finite number of at least ``SMALLEST_STEP``.
    """
    if not (math.isfinite(step) and step >= SMALLEST_STEP):
        raise InvalidValueError([("dt", f"the time step must be at least {SMALLEST_STEP:g} s (got {step:g} s)")])
    text = io.TextIOWrapper(stream, encoding="utf-8", newline="", write_through=True)
    try:
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        for robot in plan.robots:
            writer.writerows(_rows(robot, step))
    finally:
        text.detach()  # the stream is the caller's to close


def _rows(robot: RobotPlan, step: float) -> Iterator[tuple[str, ...]]:
    name = robot.robot.name
    for t, *values in samples(robot, step).tolist():
        yield (repr(t), name, *map(repr, values))


def samples(robot: RobotPlan, step: float) -> Array:
    """One robot's motion (n, 8): t, x, y, heading, s, v, a, j from t = 0 to exactly the arrival."""
    path, profile = robot.path, robot.profile
    times = np.arange(math.ceil(profile.arrival / step) + 1) * step
    times = np.append(times[times < profile.arrival - SAME_TIME], profile.arrival)
    states, jerks = profile.state(times), np.zeros(len(times))
    states[-1] = profile.states[-1]  # as in the plan, not integrated once more
    if len(profile.jerks):
        phase = np.searchsorted(profile.times, times, side="right") - 1
        driving = (phase >= 0) & (phase < len(profile.jerks))
        jerks[driving] = profile.jerks[phase[driving]]
    rows = np.column_stack([times, path.pose(states[:, 0]), states, jerks])
    return rows + 0.0  # turns -0.0 into 0.0
