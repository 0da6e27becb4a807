"""Do starts and goals have room: inside the workspace, clear of obstacles, clear of each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coord.geometry.shapes import too_near
from coord.model.arrays import Array, frozen
from coord.model.obstacle import Obstacle
from coord.reading.floor import Floor
from coord.reading.report import Report, shown
from coord.reading.robots import ReadRobot
from coord.tolerances import DISTANCE

_SIDES = ("left", "lower", "right", "upper")


@dataclass(frozen=True, slots=True, eq=False)
class Rests:
    """All starts, or all goals.

    Parameters
    ----------
    which : "start" or "goal".
    robots : (n,) places of the robots in the file, from 0.
    points : (n, 2) array [m]; radii : (n,) array [m].
    """

    which: str
    robots: npt.NDArray[np.intp]
    points: Array
    radii: Array


def check_rests(robots: Sequence[ReadRobot], floor: Floor, report: Report) -> None:
    """Report every start and goal that has too little room, of all robots whose places and radii are known.

    Touching is allowed: a distance may fall short of what is needed by ``tolerances.DISTANCE``. Each start or goal
    is reported once a kind of fault: the obstacle it is deepest in, the first robot in the file it overlaps.
    """
    clearance = floor.workspace.clearance
    for which in ("start", "goal"):
        rests = _rests(which, robots)
        if floor.bounded:
            _check_edges(rests, floor.workspace.bounds, clearance, report)
        _check_obstacles(rests, floor.obstacles, clearance, report)
        if which == "start" or floor.workspace.after_arrival == "stay":
            _check_each_other(rests, clearance, report)


def _rests(which: str, robots: Sequence[ReadRobot]) -> Rests:
    known = [
        (robot.k, *place, robot.radius)
        for robot in robots
        if (place := getattr(robot, which)) is not None and robot.radius is not None
    ]
    table = np.array(known, dtype=np.float64).reshape(-1, 4)
    return Rests(which, table[:, 0].astype(np.intp), frozen(table[:, 1:3], 2), frozen(table[:, 3]))


def _check_edges(rests: Rests, bounds: tuple[float, float, float, float], clearance: float, report: Report) -> None:
    x, y = rests.points.T
    xmin, ymin, xmax, ymax = bounds
    distances = np.stack([x - xmin, y - ymin, xmax - x, ymax - y], axis=1)
    missing = rests.radii + clearance - distances.min(axis=1)
    for n in np.flatnonzero(missing > DISTANCE).tolist():
        side = int(distances[n].argmin())
        distance = float(distances[n, side])
        if distance < 0:
            text = f"outside the workspace (x from {xmin:g} to {xmax:g} m, y from {ymin:g} to {ymax:g} m)"
        else:
            needed = _needed(rests.radii[n], clearance)
            text = f"{missing[n]:.3g} m too near to the {_SIDES[side]} edge of the workspace: "
            text += f"its centre is {distance:.3g} m from it, {needed}"
        _add(rests, n, f"is {text}", report)


def _check_obstacles(rests: Rests, obstacles: Sequence[Obstacle], clearance: float, report: Report) -> None:
    reach = rests.radii + clearance
    who, what, distances = too_near(obstacles, rests.points, reach)
    missing = reach[who] - distances
    deepest = np.lexsort((what, -missing, who))
    first = np.unique(who[deepest], return_index=True)[1]
    for pair in deepest[first].tolist():
        n, name, distance = int(who[pair]), shown(obstacles[what[pair]].name), float(distances[pair])
        where = f"{-distance:.3g} m inside" if distance < 0 else f"{distance:.3g} m from"
        needed = _needed(rests.radii[n], clearance)
        how = "deep in" if distance < 0 else "near to"
        text = f"is {missing[pair]:.3g} m too {how} obstacle {name}: its centre is {where} it, {needed}"
        _add(rests, n, text, report)


def _check_each_other(rests: Rests, clearance: float, report: Report) -> None:
    partner = first_overlaps(rests.points, rests.radii, clearance)
    for n in np.flatnonzero(partner >= 0).tolist():
        m = int(partner[n])
        distance = float(np.hypot(*(rests.points[n] - rests.points[m])))
        whose = report.subject(("robots", int(rests.robots[m])))
        needed = f"radii {rests.radii[n]:g} m + {rests.radii[m]:g} m"
        needed += f" + clearance {clearance:g} m are needed" if clearance else " are needed"
        how = "overlaps" if distance < rests.radii[n] + rests.radii[m] else "is too near to"
        _add(rests, n, f"{how} the {rests.which} of {whose}: {distance:.6g} m apart, {needed}", report)


def first_overlaps(points: Array, radii: Array, clearance: float) -> npt.NDArray[np.intp]:
    """For each disc the first in the list, before itself, that it overlaps, or -1.

    Parameters
    ----------
    points : (n, 2) array [m]. radii : (n,) array [m]. clearance : distance kept [m]; touching is no overlap.

    A sweep: sorted along one axis, each disc is compared with the next, the next but one and so on, all discs at
    once, until none is near enough along that axis. Time grows with the crowd, memory does not.
    """
    count = len(points)
    first = np.full(count, count, dtype=np.intp)
    if not count:
        return first
    axis = int(np.ptp(points, axis=0).argmax())
    order = np.argsort(points[:, axis], kind="stable")
    along, across, radius = points[order, axis], points[order, 1 - axis], radii[order]
    farthest = 2 * float(radii.max()) + clearance
    for step in range(1, count):
        ahead = along[step:] - along[:-step]
        if ahead.min() >= farthest:
            break
        limit = np.maximum(radius[step:] + radius[:-step] + clearance - DISTANCE, 0.0)
        hit = np.flatnonzero(ahead**2 + (across[step:] - across[:-step]) ** 2 < limit**2)
        a, b = order[hit], order[hit + step]
        np.minimum.at(first, np.maximum(a, b), np.minimum(a, b))
    return np.where(first < count, first, -1)


def _needed(radius: float, clearance: float) -> str:
    return f"radius {radius:g} m" + (f" + clearance {clearance:g} m are needed" if clearance else " is needed")


def _add(rests: Rests, n: int, text: str, report: Report) -> None:
    x, y = rests.points[n]
    report.add(("robots", int(rests.robots[n]), rests.which), f"{rests.which} ({x:g}, {y:g}) {text}")
